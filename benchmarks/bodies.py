"""Resolved runs against the functions where bodies turn, hit each other or carry grains of many sizes.

    . build/environment; build/venv/bin/python benchmarks/bodies.py run        an hour; goes on where it stopped
    . build/environment; build/venv/bin/python benchmarks/bodies.py compare    a minute

`run` writes the resolved runs to bodies/resolved.csv, a row for each carrier, and bodies/machine.json. `compare` runs the
functions with both tangential methods on the same inputs, and writes bodies/functions.csv and bodies/comparison.md.
"""

import argparse
import csv
import json
import os
import re
import subprocess
import tempfile
import time
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path

from machine import description

ROOT = Path(__file__).resolve().parents[1]
HERE = ROOT / "benchmarks/bodies"
BUILD = Path(os.environ.get("DUST_BUILD_DIR", ROOT / "build"))
INPUTS = ROOT / "lammps-inputs"
RESOLVED, FUNCTIONS = HERE / "resolved.csv", HERE / "functions.csv"
METHODS = ("estimate", "integrate")
LIMIT = 0.03  # largest difference
CASE = ("kind", "speed", "angle", "spin", "offset", "wall_friction", "coverage", "grain_contacts")
ROW = (*CASE, "carrier", "grains", "grains_off", "dispersion_ratio", "south", "north", "vx", "vz", "spin_after", "last_neck", "wall_seconds")


@dataclass(frozen=True)
class Kind:
    """Decks of one kind of case, and what they get besides the case's own numbers."""

    resolved: str
    functions: str
    variables: tuple[str, ...]
    resolved_variables: tuple[str, ...] = ()
    resolved_more: dict[str, str] = field(default_factory=dict)


KINDS = {
    "spin": Kind("in.impact.resolved", "in.impact.spin", ("speed", "angle", "spin", "wall_friction"), (), {"limit": "20e-6"}),
    "collision": Kind("in.collision.resolved", "in.collision", ("speed", "offset", "wall_friction")),
    # as in.impact.distribution has them
    "sizes": Kind(
        "in.impact.resolved",
        "in.impact.distribution",
        ("speed", "angle", "wall_friction", "coverage"),
        ("grain_contacts",),
        {"limit": "20e-6", "grain_diameter": "15e-6", "sigma_g": "1.5", "bare": "0.4"},
    ),
}


def cases() -> list[tuple[str, ...]]:
    usual = (0.2, "yes")  # coverage, grain_contacts
    spins = (-5000, -2000, -500, 500, 2000, 5000)
    rough = [("spin", 8, angle, spin, 0, 0.3, *usual) for angle in (90, 60) for spin in spins]
    smooth = [("spin", 8, angle, spin, 0, 0.05, *usual) for angle in (90, 60) for spin in (-5000, 5000)]
    hits = [(speed, offset, 0.05) for speed in (8, 12) for offset in (0, 0.3, 0.6)]
    hits += [(8, 0.3, 0.3), (8, 0.6, 0.3), (12, 0.6, 0.3)]
    collisions = [("collision", speed, 90, 0, offset, friction, *usual) for speed, offset, friction in hits]
    sizes = [("sizes", speed, 90, 0, 0, 0.05, coverage, "yes") for coverage in (0.02, 0.2) for speed in (8, 12)]
    sizes += [("sizes", speed, angle, 0, 0, 0.05, 0.2, "no") for speed, angle in ((8, 90), (12, 90), (12, 60))]
    return [tuple(str(value) for value in case) for case in rough + smooth + collisions + sizes]


def run_deck(deck: str, variables: dict[str, str], case: tuple[str, ...]) -> list[dict[str, str]]:
    """A row for each carrier, from what the deck prints at its end."""
    command = [str(BUILD / "bin/lmp"), "-in", str(INPUTS / deck), "-log", "none"]
    for name, value in {"plugin": str(BUILD / "plugin/dustplugin.so"), **variables}.items():
        command += ["-var", name, value]
    started = time.perf_counter()
    with tempfile.TemporaryDirectory() as folder:
        done = subprocess.run(command, capture_output=True, text=True, cwd=folder)
    if done.returncode:
        raise RuntimeError(f"{' '.join(command)} failed:\n{done.stdout[-2000:]}")
    shared = {
        **dict(zip(CASE, case, strict=True)),
        "grains": (re.findall(r"^Created (\d+) grains", done.stdout, re.MULTILINE) or [""])[0],
        "grains_off": (re.findall(r"^grains off: (\d+)", done.stdout, re.MULTILINE) or [""])[0],
        "last_neck": (re.findall(r"last neck (\d+)", done.stdout) or [""])[0],
        "wall_seconds": f"{time.perf_counter() - started:.1f}",
    }
    ends = re.findall(r"^carrier.*: (\S+) \S+ (\S+) m/s, spin (\S+) rad/s$", done.stdout, re.MULTILINE)
    # of many sizes the functions have the ratio by mass, their halves by number alone
    ratios = re.findall(r"dispersion ratio ([\d.]+)(?:: south (\S+), north (\S+))?", done.stdout)
    return [
        {
            **shared,
            "carrier": str(k),
            **dict(zip(("vx", "vz", "spin_after"), end, strict=True)),
            **dict(zip(("dispersion_ratio", "south", "north"), ratio, strict=True)),
        }
        for k, (end, ratio) in enumerate(zip(ends, ratios, strict=True), start=1)
    ]


def variables_of(case: tuple[str, ...], names: tuple[str, ...]) -> dict[str, str]:
    numbers = dict(zip(CASE, case, strict=True))
    return {name: numbers[name] for name in names}


def key(row: dict[str, str]) -> tuple[str, ...]:
    return tuple(row[name] for name in CASE)


def read(path: Path) -> list[dict[str, str]]:
    if not path.exists():
        return []
    with path.open() as stream:
        return list(csv.DictReader(stream))


def write(path: Path, columns: tuple[str, ...], rows: list[dict[str, str]]) -> None:
    part = path.with_suffix(".part")
    with part.open("w", newline="") as stream:
        writer = csv.DictWriter(stream, columns, lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)
    part.replace(path)


def run() -> None:
    HERE.mkdir(exist_ok=True)
    order = cases()
    rows = [row for row in read(RESOLVED) if key(row) in order]
    done = {key(row) for row in rows}
    for case in order:
        if case in done:
            continue
        kind = KINDS[case[0]]
        new = run_deck(kind.resolved, variables_of(case, kind.variables + kind.resolved_variables) | kind.resolved_more, case)
        print(*case, *(f"{row['dispersion_ratio']} (neck {row['last_neck']}, {row['wall_seconds']} s)" for row in new), flush=True)
        rows = sorted(rows + new, key=lambda row: (order.index(key(row)), row["carrier"]))
        write(RESOLVED, ROW, rows)
        (HERE / "machine.json").write_text(json.dumps(description(BUILD / "bin/lmp"), indent=1) + "\n")


def functions() -> list[dict[str, str]]:
    rows = []
    for case in cases():
        for method in METHODS:
            kind = KINDS[case[0]]
            new = run_deck(kind.functions, variables_of(case, kind.variables) | {"tangential": method}, case)
            rows += [{**row, "tangential": method} for row in new]
    write(FUNCTIONS, ("tangential", *(name for name in ROW if name not in ("grains", "last_neck", "wall_seconds"))), [
        {name: value for name, value in row.items() if name not in ("grains", "last_neck", "wall_seconds")} for row in rows
    ])
    return rows


def comparison(resolved: list[dict[str, str]], computed: list[dict[str, str]]) -> Iterator[str]:
    by_method = {(row["tangential"], key(row), row["carrier"]): row for row in computed}
    yield "# Spin, collisions of two carriers, and grains of many sizes: functions against resolved runs\n"
    yield "Dispersion ratios with the same inputs on both sides, nothing adjusted; e 0.7. Written by `bodies.py compare`.\n"
    titles = {
        "spin": ("A carrier that spins hits a wall", "in.impact.spin", ("speed", "angle", "wall_friction", "spin")),
        "collision": ("Two carriers, each with this speed", "in.collision", ("speed", "offset", "wall_friction", "carrier")),
        "sizes": (
            "Lognormal grains, x50,3 = 15 um, sigma_g = 1.5",
            "in.impact.distribution",
            ("speed", "angle", "coverage", "grain_contacts"),
        ),
    }
    largest: dict[str, list[str]] = {}
    for kind, (title, deck, columns) in titles.items():
        yield f"## {title} (`{deck}`)\n"
        head = [*columns, "spin after, r", "f", "resolved", *METHODS, *(f"{method} - resolved" for method in METHODS)]
        yield "| " + " | ".join(name.replace("_", " ") for name in head) + " |"
        yield "|" + "---|" * len(head)
        for row in resolved:
            if row["kind"] != kind:
                continue
            found = [by_method[method, key(row), row["carrier"]] for method in METHODS]
            ratio = float(row["dispersion_ratio"])
            differences = [float(other["dispersion_ratio"]) - ratio for other in found]
            for method, difference in zip(METHODS, differences, strict=True):
                largest.setdefault(f"{kind}, {method}", []).append(abs(difference))
            cells = [row[name] for name in columns] + [row["spin_after"], found[0]["spin_after"], f"{ratio:.4f}"]
            cells += [other["dispersion_ratio"] for other in found]
            cells += [f"{d:+.4f}" if abs(d) <= LIMIT else f"**{d:+.4f}**" for d in differences]
            yield "| " + " | ".join(cells) + " |"
        yield ""
    yield "## Differences\n"
    yield f"Wanted: at most {LIMIT} each.\n"
    yield "| cases | number | mean | largest | above the limit |\n|---|---|---|---|---|"
    for name, values in largest.items():
        above = sum(value > LIMIT for value in values)
        yield f"| {name} | {len(values)} | {sum(values) / len(values):.4f} | {max(values):.4f} | {above} |"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("what", choices=("run", "compare"))
    if parser.parse_args().what == "run":
        run()
        return
    text = "\n".join(comparison(read(RESOLVED), functions())) + "\n"
    (HERE / "comparison.md").write_text(text)
    print(text, end="")


if __name__ == "__main__":
    main()
