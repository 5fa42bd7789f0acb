"""A report of a sweep: one HTML file that needs nothing else, to read, to sort, to turn and to pass on."""

from __future__ import annotations

import base64
import html
import json
import re
from collections.abc import Iterable, Sequence
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

import numpy as np

from .about import option
from .batches import builds_in
from .columns import DetachRow
from .errors import InvalidInput
from .files import as_path, read_text, replace_file, scratch_folder
from .impact import PARTS, Impact, is_timestep_chosen
from .parameters import ABOUT, PARAMETER_TYPES, PARAMETERS, Parameters
from .result import COLUMNS, KEYS, MAIN_COLUMNS, Result, described_materials, read_csv
from .runner import run
from .shares import event_lines, read_fates
from .sweeping import TABLE
from .texture import BYTES_A_GRAIN, make_texture, read_texture
from .version import __version__

PAGE = Path(__file__).with_name("report.html")
NAME = "report.html"

#: carriers that can be turned, and grains of all of them: 9 bytes each, a third more in base64
MOST_CARRIERS, MOST_GRAINS = 8, 100_000

#: a larger table would make a file that is too large to mail
MOST_ROWS = 3000

#: columns that are shown at first, besides the parameters that vary
SHOWN = (*MAIN_COLUMNS, "end")


def write_report(folder: str | Path, out: str | Path | None = None) -> Path:
    """Write the report of a sweep's folder.

    Args:
        folder: of the sweep.
        out: the file; ``report.html`` in the folder if ``None``.

    Returns:
        The file.

    Raises:
        InvalidInput: no table in the folder, or a place that cannot be written to.
    """
    folder = as_path(folder, "report")
    results = read_csv(folder / TABLE)
    if not results:
        raise InvalidInput(f"{folder / TABLE}: no results to report")
    if len(results) > MOST_ROWS:
        raise InvalidInput(f"{folder / TABLE}: {len(results)} results; allowed: at most {MOST_ROWS} in a report")
    path = folder / NAME if out is None else as_path(out, "--out")
    page = _page(folder, results)
    with replace_file(path) as part:
        part.write_text(page, encoding="utf-8")
    return path


def _page(folder: Path, results: list[Result]) -> str:
    varied = [name for name in PARAMETERS if len({getattr(row, name) for row in results}) > 1]
    if is_timestep_chosen(results):
        varied = [name for name in varied if name != "timestep"]
    carriers = _carriers(results)
    parts = {
        "TITLE": html.escape(_title(results)),
        "QUESTION": _paragraphs(_question(results, varied)),
        "ASSUMPTIONS": _list(_assumptions(results, varied)),
        "FIGURES": "\n".join(_figures(folder, results)) or "<p>One speed alone makes no curve.</p>",
        "WARNINGS": _list(_warnings(results)) or "<p>None.</p>",
        "PROVENANCE": _list(_provenance(folder, results)),
        "SWEEP": html.escape(sweep_file(results)),
        "DATA": _json(
            {
                "columns": [{"name": key, "unit": COLUMNS[key].unit, "help": COLUMNS[key].help} for key in KEYS],
                "shown": [*varied, *SHOWN],
                "count": len(results),
                "values": [_values(results, key) for key in KEYS],
                "carriers": carriers,
            }
        ),
    }
    text = read_text(PAGE)
    return re.sub(r"@@([A-Z]+)@@", lambda match: parts[match[1]], text)


def _values(results: list[Result], key: str) -> list[Any]:
    """A column's values; one alone if they are all the same."""
    values = [getattr(row, key) for row in results]
    return values[:1] if all(value == values[0] for value in values) else values


def _json(data: object) -> str:
    """As it may stand in a script element."""
    return json.dumps(data, separators=(",", ":"), allow_nan=False).replace("</", "<\\/").replace("<!", "<\\!")


def _paragraphs(texts: Iterable[str]) -> str:
    return "\n".join(f"<p>{html.escape(text)}</p>" for text in texts)


def _list(texts: Sequence[str]) -> str:
    items = "\n".join(f"<li>{html.escape(text)}</li>" for text in texts)
    return f"<ul>\n{items}\n</ul>" if items else ""


def _title(results: list[Result]) -> str:
    first = results[0]
    return f"Dust from {first.carrier} carriers that hit {first.wall}"


def _short(name: str) -> str:
    """A parameter's help up to its first comma or bracket."""
    return re.split("[;,(:]", ABOUT[name].help)[0].strip()


def _span(results: list[Result], name: str) -> str:
    """The values of a parameter in words."""
    about = ABOUT[name]
    values = sorted({getattr(row, name) for row in results})
    unit = about.figure_unit if "$" not in about.figure_unit else ""
    factor = about.factor if unit else 1.0
    unit = unit or about.unit
    shown = [f"{value * factor:.4g}" if isinstance(value, float) else str(value) for value in values]
    gap = "" if unit == "°" else " "
    words, number = ", ".join(shown), ""
    if len(shown) > 6:
        words, number = f"{shown[0]} to {shown[-1]}", f" ({len(shown)} values)"
    return f"{words}{gap + unit if unit else ''}{number}"


def _question(results: list[Result], varied: Sequence[str]) -> list[str]:
    first = results[0]
    ratios = [row.dispersion_ratio for row in results]
    said = [
        f"How much of its dust does a carrier of {first.carrier_diameter * 1e3:g} mm lose when it hits a wall? It is "
        f"covered to {first.coverage:.3g} of its surface with grains of {first.grain_diameter * 1e6:g} um."
    ]
    if varied:
        spans = "; ".join(f"{_short(name)}: {_span(results, name)}" for name in varied)
        said.append(f"Asked in {len(results)} impacts: {spans}.")
    low, high = (results[ratios.index(end)] for end in (min(ratios), max(ratios)))
    if len(results) > 1:
        said.append(
            f"The dispersion ratio, detached over initial dust mass, is {low.dispersion_ratio:.3f} at the least "
            f"({low.speed:.4g} m/s, {low.angle:.4g} degrees) and {high.dispersion_ratio:.3f} at the most "
            f"({high.speed:.4g} m/s, {high.angle:.4g} degrees)."
        )
    else:
        said.append(f"The dispersion ratio, detached over initial dust mass, is {first.dispersion_ratio:.3f}.")
    return said


def _assumptions(results: list[Result], varied: Sequence[str]) -> list[str]:
    made = sorted({tuple(described_materials(row)) for row in results})
    lines = [re.sub(" +", " ", line) for line in (made[0] if len(made) == 1 else ())]
    if len(made) > 1:
        lines = [f"{len(made)} combinations of materials and sizes: see the table's columns."]
    fixed = [name for name in PARAMETERS if name not in varied and ABOUT[name].symbol]
    numbers = "; ".join(
        f"{_short(name)} {_span(results, name)}"
        for name in fixed
        if PARAMETER_TYPES[name] in ("float", "int") and not ABOUT[name].follows
        if name != "distribution_spread" or results[0].distribution != "none"
    )
    methods = {row.method for row in results}
    if "functions" in methods:
        laws = ", ".join(sorted({row.tangential for row in results if row.method == "functions"}))
        lines.append(
            "By detachment functions: grains are rigidly attached until the carrier's acceleration lifts them off "
            f"(normal) or they slide or roll off its far side (tangential; law: {laws}). They do not hit each other."
        )
    if "resolved" in methods:
        lines.append("Resolved: every grain is an atom with an adhesive contact that slides, rolls and breaks.")
    return [*lines, f"The same in all impacts: {numbers}."]


def _warnings(results: list[Result]) -> list[str]:
    said = []
    for end, words in (
        ("step limit", "did not end by the rebound but at the step limit: their ratios may be too low"),
        (
            "limit",
            "ended at 50 us with contacts that still changed: usual in resolved runs, whose ratio rests by 10 us",
        ),
    ):
        count = sum(row.end == end for row in results)
        if count:
            said.append(f"{count} of {len(results)} impacts {words}.")
    few = sum(row.contact_time / row.timestep < 100 for row in results)
    if few:
        said.append(f"{few} impacts have fewer than 100 time steps in their contact: a smaller time step is safer.")
    if any(abs(row.restitution_realised - row.restitution) > 0.01 * row.restitution for row in results):
        said.append("In some impacts the restitution realised is not that asked for by more than 1 %.")
    if len({row.seed for row in results}) == 1:
        grains = min(row.grains for row in results)
        said.append(
            f"One texture (seed {results[0].seed}) in all impacts: another one moves a ratio by about "
            f"{0.5 / grains**0.5:.1g}."
        )
    crushed = sum(row.bare < Impact.from_mapping(_sizes(row)).bare - 1e-9 for row in results)
    if crushed:
        said.append(f"In {crushed} impacts the bare cap is so small that grains reach the wall, which crushes them.")
    if len({row.lammps_version for row in results}) > 1:
        said.append("The results are by several versions of LAMMPS.")
    return said


def _sizes(row: Result) -> dict[str, Any]:
    names = ("carrier_diameter", "grain_diameter", "distribution", "distribution_spread", "timestep", "speed", "angle")
    given = {name: getattr(row, name) for name in (*names, "carrier_density", "carrier_modulus", "wall_modulus")}
    return {**given, "coverage": row.coverage, "surface_energy": row.surface_energy, "grain_density": row.grain_density}


def _provenance(folder: Path, results: list[Result]) -> list[str]:
    versions = ", ".join(str(version) for version in sorted({row.lammps_version for row in results}))
    lines = [
        f"dustdetach {__version__}, LAMMPS {versions}; report written {datetime.now(UTC):%Y-%m-%d %H:%M} UTC.",
        f"Seeds of textures: {', '.join(str(seed) for seed in sorted({row.seed for row in results}))}.",
    ]
    lines += [
        "Digests: " + ", ".join(f"{key} {value}" for key, value in build.items()) + "." for build in builds_in(folder)
    ]
    lines.append("To repeat one impact: " + command_of(results[0]))
    lines.append("To repeat all: dustdetach sweep sweep.toml --out DIR, with the file below.")
    return lines


def given_values(row: Parameters) -> dict[str, Any]:
    """The parameters that must be given to get those of a row, the others follow."""
    values = {name: getattr(row, name) for name in PARAMETERS}
    given = {name: value for name, value in values.items() if not ABOUT[name].follows}
    for part in PARTS:
        try:
            Impact.from_mapping({"speed": 1.0, part: str(values[part]), "surface_energy": 0.01})
        except InvalidInput:
            # "own numbers", or a material of the user's
            del given[part]
    for _ in ABOUT:
        made = Impact.from_mapping(given).values()
        unlike = [name for name in PARAMETERS if made[name] != values[name] and name not in (*given, *PARTS)]
        if not unlike:
            break
        name = unlike[0]
        if name == "hamaker":
            energy = {**given, "surface_energy": values["surface_energy"]}
            if Impact.from_mapping(energy).hamaker == values["hamaker"]:
                name = "surface_energy"
        given[name] = values[name]
    default = Impact(speed=values["speed"]).values()
    slim = {name: value for name, value in given.items() if name == "speed" or value != default[name]}
    return slim if Impact.from_mapping(slim).values() == values else given


def command_of(row: Parameters) -> str:
    """The command that repeats an impact."""
    given = given_values(row)
    words = ["dustdetach impact"]
    if given.get("distribution", "none") != "none":
        words.append(f"--distribution {row.distribution} {row.grain_diameter!r} {row.distribution_spread!r}")
        given.pop("grain_diameter", None)
    for name, value in given.items():
        if name in ("distribution", "distribution_spread"):
            continue
        if name == "rotation":
            words.append("--rotation" if value else "--no-rotation")
        else:
            words.append(f"{option(name)} {json.dumps(value) if isinstance(value, str) else repr(value)}")
    return " ".join(words)


def sweep_file(results: Iterable[Parameters]) -> str:
    """A TOML file of a sweep that makes the same impacts."""
    groups: dict[tuple[tuple[str, Any], ...], list[float]] = {}
    for row in results:
        given = given_values(row)
        speed = given.pop("speed")
        groups.setdefault(tuple(given.items()), []).append(speed)
    blocks = []
    for given_items, speeds in groups.items():
        lines = ["[[case]]", f"speed = {json.dumps(list(dict.fromkeys(speeds)))}"]
        lines += [f"{name} = {json.dumps(value)}" for name, value in given_items]
        blocks.append("\n".join(lines))
    return "\n\n".join(blocks) + "\n"


def _figures(folder: Path, results: list[Result]) -> list[str]:
    """The plots of the folder as SVG elements."""
    from .figures import draw_all

    with scratch_folder(1 << 24) as scratch:
        try:
            paths = draw_all(folder / TABLE, results, scratch)
        except InvalidInput:
            # one speed alone
            return []
        texts = [path.read_text() for path in paths if path.suffix == ".svg"]
        return [f"<figure>{text[text.index('<svg') :]}</figure>" for text in texts]


def _carriers(results: list[Result]) -> list[dict[str, Any]]:
    """Carriers to turn: how and when each of their grains left, by the functions."""
    chosen: list[Result] = []
    grains = 0
    for row in _spread_out(results):
        if grains + row.grains > MOST_GRAINS and chosen:
            continue
        chosen.append(row)
        grains += row.grains
        if len(chosen) == MOST_CARRIERS:
            break
    return [_carrier(row) for row in sorted(chosen, key=lambda row: (row.angle, row.restitution, row.speed))]


def _spread_out(results: list[Result]) -> list[Result]:
    """The results in an order that begins with some that are far from each other in their ratio."""
    rows = sorted(results, key=lambda row: row.dispersion_ratio)
    places = dict.fromkeys(np.linspace(0, len(rows) - 1, MOST_CARRIERS).round().astype(int).tolist())
    return [rows[place] for place in places]


def _carrier(row: Result) -> dict[str, Any]:
    values = {**given_values(row), "method": "functions"}
    impact = Impact.from_mapping(values)
    room = 3 * BYTES_A_GRAIN * impact.grains
    with scratch_folder(room) as folder:
        result = run(impact, events=folder / "events")
        make_texture(impact, folder / "texture")
        texture = read_texture(folder / "texture")
        fates = read_fates(folder / "events", len(texture.diameters))
        times = _times(folder / "events", len(texture.diameters), impact.timestep)
    note = "" if row.method == "functions" else " (resolved; shown: the functions of the same impact)"
    return {
        "label": f"{row.speed:.4g} m/s, {row.angle:.4g} degrees, restitution {row.restitution:.4g}: ratio "
        f"{result.dispersion_ratio:.3f}{note}",
        "angle": row.angle,
        "contact": result.contact_time * 1e6,
        "grain": _packed(texture.diameters / texture.carrier_diameter * 65535 * 2, "<u2"),
        "n": _packed(texture.directions * 32767, "<i2"),
        "fate": _packed(fates, "u1"),
        "time": _packed(np.minimum(65535, times * 1e9), "<u2"),
    }


def _times(path: Path, grains: int, timestep: float) -> Any:
    """When each grain left, s after the first contact; 0 for those that did not (N,)."""
    times = np.zeros(grains)
    for line in event_lines(path):
        words = line.split()
        times[int(float(words[DetachRow.GRAIN])) - 1] = max(0.0, float(words[DetachRow.STEP]) - 5) * timestep
    return times


def _packed(numbers: Any, kind: str) -> str:
    return base64.b64encode(np.ascontiguousarray(np.round(numbers).astype(kind)).tobytes()).decode()
