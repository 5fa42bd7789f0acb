"""Both methods on the cases of impacts/*.toml: runs them, keeps the tables, compares and draws.

    . build/environment
    build/venv/bin/python benchmarks/impacts.py run --work DIR [--jobs N] [NAME ...]    hours; goes on where it stopped
    build/venv/bin/python benchmarks/impacts.py run --functions --work DIR [NAME ...]   half a minute
    build/venv/bin/python benchmarks/impacts.py compare                            seconds, from the tables in impacts/

`run` writes the table of each NAME.toml (all by default), the functions by each law of tangential lift-off, to
impacts/NAME.csv, with machine and versions in impacts/machine.json; with --functions the rows of the resolved runs stay
as they are, as does machine.json. `compare` writes impacts/comparison.md, the figures beside it, and agreement.csv,
which doc/validation.rst shows.
"""

import argparse
import csv
import json
import os
import platform
import re
import subprocess
from collections import defaultdict
from collections.abc import Callable, Iterable, Iterator
from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import dustdetach
import matplotlib.pyplot as plt
from deck import table
from dustdetach import Impact, read_cases, sweep
from dustdetach.figures import draw
from dustdetach.parameters import PARAMETERS, RINGING
from dustdetach.result import Result, read_csv, write_csv
from machine import processor

HERE = Path(__file__).resolve().parent / "impacts"
# where a table's cases have their partners: a case and its variant differ in this parameter alone
VARIANTS = {"seeds": "seed", "timestep": "timestep"}
DAMPINGS = (1.0, 0.2, 0.06)
LIMIT = "20e-6"  # of resolved runs (s), where the deck has 50 us: the ratio is final before 10 us
OTHERS = "others"  # the list that is not of the reference case
LAWS = ("impulse", "estimate", "integrate")

Pair = tuple[Result, Result]


# --- running ---------------------------------------------------------------------------------------------
def run(names: list[str], work: Path, jobs: int, functions: bool) -> None:
    machine = {
        "processor": processor(),
        "cores": os.cpu_count(),
        "python": platform.python_version(),
        "dustdetach": dustdetach.__version__,
        "commit": subprocess.run(
            ["git", "describe", "--always", "--dirty"],
            cwd=HERE,
            capture_output=True,
            text=True,
            check=True,
        ).stdout.strip(),
        "jobs": jobs,
    }
    for name in names:
        print(name, flush=True)
        cases = read_cases(HERE / f"{name}.toml")
        os.environ["DUSTDETACH_INPUTS"] = str(decks(work / "decks"))
        rows = sweep([of_law(case, law) for case in cases for law in LAWS], work / name, jobs=jobs)
        kept = HERE / f"{name}.csv"
        if functions:
            rows += [row for row in read_csv(kept) if row.method == "resolved"]
        else:
            rows += sweep([replace(case, method="resolved") for case in cases], work / name, jobs=jobs)
            (HERE / "machine.json").write_text(json.dumps(machine, indent=1) + "\n")
        write_csv(kept, sorted(rows, key=lambda row: (row.angle, row.restitution, row.speed, row.to_json())))


def of_law(case: Impact, law: str) -> Impact:
    """By the functions with a law, some of which know nothing of a grain's damping, in the resolved run's steps."""
    return replace(
        case,
        tangential=law,
        grain_damping=case.grain_damping if law in RINGING else Impact.grain_damping,
        timestep=float(replace(case, method="resolved").timestep),
    )


def decks(folder: Path) -> Path:
    """The decks with an earlier end."""
    inputs = HERE.parents[1] / "lammps-inputs"
    folder.mkdir(parents=True, exist_ok=True)
    for deck in inputs.glob("in.*"):
        text = re.sub(
            r"^(variable limit +index )50e-6",
            rf"\g<1>{LIMIT}",
            deck.read_text(),
            flags=re.MULTILINE,
        )
        (folder / deck.name).write_text(text)
    return folder


# --- reading ---------------------------------------------------------------------------------------------
def tables() -> dict[str, list[Result]]:
    paths = [path for path in sorted(HERE.glob("*.csv")) if path.with_suffix(".toml").exists()]
    return {path.stem: [as_now(row) for row in read_csv(path)] for path in paths}


def as_now(row: Result) -> Result:
    """Resolved runs follow the spin and know no law of lift-off, whatever their row says."""
    return replace(row, rotation=True, tangential=LAWS[0]) if row.method == "resolved" else row


def key(row: Result, *without: str) -> tuple:
    return tuple(getattr(row, name) for name in PARAMETERS if name not in ("method", "tangential", *without))


def pairs(rows: Iterable[Result], law: str) -> list[Pair]:
    """Functions with a law of lift-off and resolved run of the same impact."""
    rows = list(rows)
    unknown = () if law in RINGING else ("grain_damping",)
    functions = {key(row, *unknown): row for row in rows if row.method == "functions" and row.tangential == law}
    resolved = [row for row in rows if row.method == "resolved" and key(row, *unknown) in functions]
    return [(functions[key(row, *unknown)], row) for row in resolved]


def reference_rows(data: dict[str, list[Result]]) -> list[Result]:
    """Of the reference case, of all lists."""
    return unique(row for name, part in data.items() if name != OTHERS for row in part)


def unique(rows: Iterable[Result]) -> list[Result]:
    """Cases that stand in several tables count once."""
    return list({(row.method, row.tangential, key(row)): row for row in rows}.values())


# --- the text --------------------------------------------------------------------------------------------
def agreement(label: str, compared: list[Pair]) -> list[object]:
    """Mean and largest difference, whole, south, north; the case of the largest."""
    row: list[object] = [label, len(compared)]
    for share in ("dispersion_ratio", "south", "north"):
        differences = [abs(getattr(f, share) - getattr(r, share)) for f, r in compared]
        row += [sum(differences) / len(differences), max(differences)]
    worst = max(
        compared,
        key=lambda pair: abs(pair[0].dispersion_ratio - pair[1].dispersion_ratio),
    )[1]
    return [*row, f"{worst.speed:g} m/s, {worst.angle:g}°, e {worst.restitution:g}"]


def groups(data: dict[str, list[Result]], law: str) -> Iterator[tuple[str, list[Pair]]]:
    """Kinds of impacts and their pairs."""
    compared = pairs(reference_rows(data), law)
    smooth, rough = ([pair for pair in compared if pair[1].wall_friction == friction] for friction in (0.05, 0.3))
    for damping in DAMPINGS:
        damped = [pair for pair in smooth if pair[1].grain_damping == damping]
        straight = [pair for pair in damped if pair[0].angle == 90]
        listed = [pair for pair in straight if pair[0].seed == 1 and pair[0].timestep == 1e-9]
        yield f"straight, zeta {damping:g}", listed
        if len(listed) < len(straight):
            yield "... with other seeds and half time steps", straight
        yield f"oblique, zeta {damping:g}", [pair for pair in damped if pair[0].angle != 90]
    yield "wall friction 0.3, zeta 1", rough
    yield "other carriers, grains, walls", pairs(data[OTHERS], law)


def agreements(data: dict[str, list[Result]]) -> Iterator[list[str]]:
    """Mean and largest difference by each law, for the documentation."""
    names = ("ratio", "south", "north")
    yield ["impacts", "cases", "law", *(cell for name in names for cell in (f"{name}: mean", "largest"))]
    for kinds in zip(*(groups(data, law) for law in LAWS), strict=True):
        for law, (kind, compared) in zip(LAWS, kinds, strict=True):
            cells = [f"{cell:.4f}" for cell in agreement(kind, compared)[2:-1] if isinstance(cell, float)]
            yield [*((kind, str(len(compared))) if law == LAWS[0] else ("", "")), law, *cells]


def comparison(data: dict[str, list[Result]]) -> Iterator[str]:
    rows = reference_rows(data)
    plain = [row for row in rows if row.seed == 1 and row.timestep == 1e-9]
    smooth = [row for row in plain if row.wall_friction == 0.05]

    yield "# Detachment functions against grain-resolved runs"
    yield ""
    resolved = [row for row in [*rows, *data[OTHERS]] if row.method == "resolved"]
    ends = {end: sum(row.end == end for row in resolved) for end in sorted({row.end for row in resolved})}
    version = resolved[0].lammps_version
    ended = ", ".join(f"*{end}*: {count}" for end, count in ends.items())
    yield f"{len(resolved)} resolved impacts, LAMMPS {version}, in the reference case of {rows[0].grains} grains."
    yield f"They stop at {float(LIMIT) * 1e6:g} us at the latest; ended by {ended}."
    yield "Written by `impacts.py compare`."
    yield ""

    yield "## Agreement"
    yield ""
    yield "Differences of the fraction of the initial dust mass, with the same inputs on both sides and nothing"
    yield "adjusted, for each law of tangential lift-off. *zeta*: damping ratio of the grains' contacts, which"
    yield "`estimate` does not know."
    yield ""
    head = ["impacts", "cases", "ratio: mean", "largest", "south: mean", "largest", "north: mean", "largest"]
    for law in LAWS:
        yield f"`tangential {law}`:"
        yield ""
        yield from table([*head, "largest at"], [agreement(*group) for group in groups(data, law)])
    yield "## What the paper says"
    yield ""
    yield from paper([row for row in smooth if row.method == "resolved" and row.grain_damping == 1])
    yield "## Straight impacts, zeta 1"
    yield ""
    yield from cases([row for row in smooth if row.angle == 90 and row.grain_damping == 1])
    yield "## Oblique impacts, zeta 1"
    yield ""
    yield from cases([row for row in smooth if row.angle != 90 and row.grain_damping == 1])
    yield "## Grain contacts that ring"
    yield ""
    yield from dampings(smooth)
    yield "## Rough wall, friction 0.3"
    yield ""
    rough = [row for row in plain if row.wall_friction == 0.3]
    yield from cases(rough)
    yield from best_angle(rough)
    yield "## Other carriers, grains, adhesion, friction and restitution"
    yield ""
    yield from others(data[OTHERS])
    yield "## Other influences"
    yield ""
    yield (
        "Straight, e 0.7; from `influences.py`. *Tensile tail*: LAMMPS' own `coeff_restitution` on the carrier, "
        "which pulls."
    )
    yield ""
    with (HERE / "influences.csv").open() as stream:
        head, *lines = csv.reader(stream)
    yield from table(head, lines)
    for name, parameter in VARIANTS.items():
        yield f"## {name.capitalize()}"
        yield ""
        yield from variants([row for row in rows if row.method == "resolved"], plain, parameter)


def paper(resolved: list[Result]) -> Iterator[str]:
    """The numbers and trends of the paper's text with the limits of doc/validation.rst, in the resolved runs."""
    rows = {(row.restitution, row.angle, row.speed): row for row in resolved}

    def shares(share: str, cases: Iterable[tuple[float, float, float]]) -> list[float]:
        return [getattr(rows[case], share) for case in cases]

    def falling(values: list[float]) -> bool:
        return all(a > b for a, b in pairwise(values))

    lines: list[list[object]] = []

    def check(what: str, wanted: str, found: list[float], holds: bool) -> None:
        lines.append(
            [
                what,
                wanted,
                " / ".join(f"{value:.4f}" for value in found),
                "yes" if holds else "**no**",
            ]
        )

    for speed, least in ((2, 0.43), (4, 0.46)):
        found = shares("south", [(0.7, 90, speed)])
        check(f"south, {speed} m/s, e 0.7", f">= {least}", found, found[0] >= least)
    found = shares("south", [(e, 90, 4) for e in (0.5, 0.7, 0.9)])
    check(
        "south, 4 m/s, e 0.5 / 0.7 / 0.9",
        "within 0.01",
        found,
        max(found) - min(found) <= 0.01,
    )
    found = shares("north", [(0.7, 90, 5)])
    check("north, 5 m/s, e 0.7", "0", found, found[0] == 0)
    found = shares("north", [(0.7, 90, 8)])
    check("north, 8 m/s, e 0.7", "> 0.2", found, found[0] > 0.2)
    for speed in (8, 9, 10, 12):
        found = shares("north", [(e, 90, speed) for e in (0.5, 0.7, 0.9)])
        check(
            f"north, {speed} m/s, e 0.5 / 0.7 / 0.9",
            "rising",
            found,
            falling(found[::-1]),
        )
    for speed in (4, 8, 12):
        found = shares("dispersion_ratio", [(0.7, angle, speed) for angle in (90, 75, 60, 45, 30)])
        check(
            f"ratio, {speed} m/s, 90 / 75 / 60 / 45 / 30°",
            "falling",
            found,
            falling(found),
        )
    found = shares("north", [(0.7, 60, 12)])
    check("north, 12 m/s, 60°", ">= 0.05", found, found[0] >= 0.05)
    yield from table(["quantity", "wanted", "found", "holds"], lines)


def cases(rows: list[Result]) -> Iterator[str]:
    """A line for each impact: all laws, then the first one's halves."""
    compared = {law: {key(r): f for f, r in pairs(rows, law)} for law in LAWS}
    lines = []
    for f, r in sorted(pairs(rows, LAWS[0]), key=lambda pair: (pair[0].restitution, -pair[0].angle, pair[0].speed)):
        ratios = [compared[law][key(r)].dispersion_ratio for law in LAWS]
        halves = [f.south, r.south, f.north, r.north]
        which = (f"{f.restitution:g}", f"{f.angle:g}", f"{f.speed:g}")
        lines.append([*which, *ratios, r.dispersion_ratio, *halves, r.end, f"{r.wall_seconds:.0f}"])
    names = [f"{half} {who}" for half in ("south", "north") for who in (LAWS[0], "resolved")]
    yield from table(["e", "angle", "v (m/s)", *LAWS, "resolved", *names, "end", "s"], lines)


def others(rows: list[Result]) -> Iterator[str]:
    compared = {law: {key(r): f for f, r in pairs(rows, law)} for law in LAWS}
    lines = []
    for r in (row for row in rows if row.method == "resolved"):
        of_law = [compared[law][key(r)] for law in LAWS]
        sizes = [f"{r.carrier_diameter * 1e3:g}", f"{r.grain_diameter * 1e6:g}", f"{r.hamaker:g}", f"{r.friction:g}"]
        impact = [f"{r.wall_friction:g}", f"{r.restitution:g}", f"{r.angle:g}", f"{r.speed:g}"]
        halves = [of_law[0].south, r.south, of_law[0].north, r.north]
        lines.append([*sizes, *impact, *(f.dispersion_ratio for f in of_law), r.dispersion_ratio, *halves])
    names = [f"{half} {who}" for half in ("south", "north") for who in (LAWS[0], "resolved")]
    head = ["carrier (mm)", "grains (um)", "A (J)", "mu_f", "wall mu", "e", "angle", "v (m/s)"]
    yield from table([*head, *LAWS, "resolved", *names], lines)


def dampings(smooth: list[Result]) -> Iterator[str]:
    laws = [law for law in LAWS if law != "estimate"]
    followed = {key(r): f for f, r in pairs(smooth, laws[1])}
    by_case: dict[tuple, dict[float, tuple[Result, ...]]] = defaultdict(dict)
    for f, r in pairs(smooth, laws[0]):
        by_case[key(r, "grain_damping")][r.grain_damping] = (f, followed[key(r)], r)
    complete = [found for found in by_case.values() if all(damping in found for damping in DAMPINGS)]
    complete.sort(key=lambda found: (found[1.0][0].restitution, -found[1.0][0].angle, found[1.0][0].speed))
    lines = []
    for found in complete:
        f = found[1.0][0]
        ratios = [row.dispersion_ratio for damping in DAMPINGS for row in found[damping]]
        lines.append([f"{f.restitution:g}", f"{f.angle:g}", f"{f.speed:g}", *ratios])
    head = [cell for damping in DAMPINGS for cell in (*(f"zeta {damping:g}: {law}" for law in laws), "resolved")]
    yield from table(["e", "angle", "v (m/s)", *head], lines)


def best_angle(rough: list[Result]) -> Iterator[str]:
    yield "Angle of largest release:"
    yield ""
    tellers = [*(("functions", law) for law in LAWS), ("resolved", LAWS[0])]
    lines = []
    for speed in sorted({row.speed for row in rough}):
        line = [f"{speed:g}"]
        for teller in tellers:
            at = [row for row in rough if row.speed == speed and (row.method, row.tangential) == teller]
            best = max(at, key=lambda row: row.dispersion_ratio)
            line.append(f"{best.angle:g}° ({best.dispersion_ratio:.4f})")
        lines.append(line)
    yield from table(["v (m/s)", *LAWS, "resolved"], lines)


def variants(resolved: list[Result], plain: list[Result], parameter: str) -> Iterator[str]:
    base = {key(row, parameter): row for row in plain if row.method == "resolved"}
    lines = []
    for row in resolved:
        partner = base.get(key(row, parameter))
        if partner and getattr(row, parameter) != getattr(partner, parameter):
            difference = row.dispersion_ratio - partner.dispersion_ratio
            where = [
                f"{row.restitution:g}",
                f"{row.speed:g}",
                f"{getattr(row, parameter):g}",
            ]
            lines.append([*where, partner.dispersion_ratio, row.dispersion_ratio, difference])
    lines.sort(key=lambda line: [float(cell) for cell in line[:3]])
    head = [
        "e",
        "v (m/s)",
        parameter,
        f"ratio at {getattr(plain[0], parameter):g}",
        "ratio",
        "difference",
    ]
    yield from table(head, lines)
    if lines:
        yield f"Largest difference: {max(abs(line[-1]) for line in lines):.4f}."
        yield ""


# --- the figures -----------------------------------------------------------------------------------------
def figures(data: dict[str, list[Result]]) -> None:
    rows = reference_rows(data)
    plain = [row for row in rows if row.seed == 1 and row.timestep == 1e-9]
    damped = [row for row in plain if row.grain_damping == 1]
    smooth = [row for row in damped if row.wall_friction == 0.05]

    def with_curves(chosen: list[Result], belongs: Callable[[Result], bool], name: str) -> None:
        # what is followed would lie on the impulse law's lines
        shown = [row for row in chosen if belongs(row) and row.tangential != "integrate"]
        for path in draw(shown, HERE / name):
            if path.suffix == ".svg":
                path.unlink()

    with_curves(smooth, lambda row: row.angle == 90, "figure4")
    with_curves(smooth, lambda row: row.restitution == 0.7, "figure5")
    with_curves(damped, lambda row: row.wall_friction == 0.3, "friction")
    scatter([*damped, *data[OTHERS]])
    ringing([row for row in plain if row.wall_friction == 0.05 and row.angle == 90 and row.restitution == 0.7])


def scatter(rows: list[Result]) -> None:
    figure, axes = plt.subplots(figsize=(4.2, 4.0), layout="constrained")
    axes.plot([0, 1], [0, 1], color="0.7", linewidth=0.8)
    for law, colour, marker in (("estimate", "#D55E00", "s"), ("impulse", "#0072B2", "o")):
        x, y = zip(*((f.dispersion_ratio, r.dispersion_ratio) for f, r in pairs(rows, law)), strict=True)
        axes.plot(x, y, marker, color=colour, markerfacecolor="white", markersize=4.5, label=law)
    axes.set(
        xlabel="Dispersion ratio, detachment functions",
        ylabel="Dispersion ratio, dust-resolved",
        aspect="equal",
    )
    axes.legend(frameon=False)
    save(figure, "agreement")


def ringing(rows: list[Result]) -> None:
    figure, axes = plt.subplots(figsize=(5.0, 3.6), layout="constrained")

    def curve(**chosen: object) -> list[list[float]]:
        found = sorted(
            (row.speed, row.dispersion_ratio)
            for row in rows
            if all(getattr(row, name) == value for name, value in chosen.items())
        )
        return [list(values) for values in zip(*found, strict=True)]

    estimate = curve(method="functions", tangential="estimate", grain_damping=1.0)
    axes.plot(*estimate, color="0.6", linestyle=":", label="estimate")
    for damping, colour, marker in zip(DAMPINGS, ("#0072B2", "#D55E00", "#009E73"), "os^", strict=True):
        label = f"$\\zeta$ = {damping:g}"
        law = curve(method="functions", tangential="impulse", grain_damping=damping)
        axes.plot(*law, color=colour, label=f"impulse, {label}")
        resolved = curve(method="resolved", grain_damping=damping)
        axes.plot(*resolved, marker, color=colour, markerfacecolor="white", label=f"resolved, {label}")
    axes.set(
        xlabel="Impact speed $v_p$ (m/s)",
        ylabel="Dispersion ratio",
        ylim=(0, 1.03),
        xlim=(0, None),
    )
    axes.legend(frameon=False)
    save(figure, "damping")


def save(figure: plt.Figure, name: str) -> None:
    figure.savefig(HERE / f"{name}.png", dpi=150)
    plt.close(figure)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    commands = parser.add_subparsers(required=True, dest="command")
    running = commands.add_parser("run")
    running.add_argument("names", nargs="*", metavar="NAME")
    running.add_argument("--work", type=Path, required=True, help="folder of the sweeps")
    running.add_argument("--jobs", type=int, default=2)
    running.add_argument("--functions", action="store_true", help="only them; the resolved rows stay")
    commands.add_parser("compare")
    options = parser.parse_args()
    if options.command == "run":
        known = sorted(path.stem for path in HERE.glob("*.toml"))
        if unknown := [name for name in options.names if name not in known]:
            parser.error(f"{unknown[0]}: no such list of cases; allowed: {', '.join(known)}")
        run(options.names or known, options.work, options.jobs, options.functions)
    else:
        data = tables()
        (HERE / "comparison.md").write_text("\n".join(comparison(data)))
        with (HERE / "agreement.csv").open("w", newline="") as stream:
            csv.writer(stream, lineterminator="\n").writerows(agreements(data))
        figures(data)


if __name__ == "__main__":
    main()
