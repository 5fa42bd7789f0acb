"""Resolved runs against the functions where bodies turn, hit each other or carry grains of many sizes.

    . build/environment; build/venv/bin/python benchmarks/bodies.py run        an hour; goes on where it stopped
    . build/environment; build/venv/bin/python benchmarks/bodies.py compare    a minute

`run` writes the resolved runs to bodies/resolved.csv, a row for each carrier, and bodies/machine.json. `compare` runs
the functions with three laws of tangential lift-off on the same inputs, and writes bodies/functions.csv,
bodies/comparison.md and bodies/agreement.csv, which doc/validation.rst shows.
"""

import argparse
import json
import re
import time
from collections.abc import Iterator
from dataclasses import dataclass, field

from deck import BUILD, ROOT, run, table
from machine import description
from rows import read, write

HERE = ROOT / "benchmarks/bodies"
RESOLVED, FUNCTIONS = HERE / "resolved.csv", HERE / "functions.csv"
METHODS = ("impulse", "estimate", "integrate")
LIMIT = 0.03  # largest difference
CASE = ("kind", "speed", "angle", "spin", "offset", "wall_friction", "coverage", "grain_contacts")
ROW = (
    *CASE,
    "carrier",
    "grains",
    "grains_off",
    "dispersion_ratio",
    "south",
    "north",
    "vx",
    "vz",
    "spin_after",
    "last_neck",
    "wall_seconds",
)


@dataclass(frozen=True)
class Kind:
    """Decks of one kind of case, and what they get besides the case's own numbers."""

    resolved: str
    functions: str
    variables: tuple[str, ...]
    resolved_variables: tuple[str, ...] = ()
    resolved_more: dict[str, str] = field(default_factory=dict)


KINDS = {
    "spin": Kind(
        "in.impact.resolved", "in.impact.spin", ("speed", "angle", "spin", "wall_friction"), (), {"limit": "20e-6"}
    ),
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
    alone = [(8, 90, 0.02), (8, 90, 0.2), (12, 90, 0.2), (12, 60, 0.2)]
    sizes += [("sizes", speed, angle, 0, 0, 0.05, coverage, "no") for speed, angle, coverage in alone]
    return [tuple(str(value) for value in case) for case in rough + smooth + collisions + sizes]


def run_deck(deck: str, variables: dict[str, str], case: tuple[str, ...]) -> list[dict[str, str]]:
    """A row for each carrier, from what the deck prints at its end."""
    started = time.perf_counter()
    printed = run(deck, **variables)
    shared = {
        **dict(zip(CASE, case, strict=True)),
        "grains": (re.findall(r"^Created (\d+) grains", printed, re.MULTILINE) or [""])[0],
        "grains_off": (re.findall(r"^grains off: (\d+)", printed, re.MULTILINE) or [""])[0],
        "last_neck": (re.findall(r"last neck (\d+)", printed) or [""])[0],
        "wall_seconds": f"{time.perf_counter() - started:.1f}",
    }
    ends = re.findall(r"^carrier.*: (\S+) \S+ (\S+) m/s, spin (\S+) rad/s$", printed, re.MULTILINE)
    # of many sizes the functions have the ratio by mass, their halves by number alone
    ratios = re.findall(r"dispersion ratio ([\d.]+)(?:: south (\S+), north (\S+))?", printed)
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


def run_all() -> None:
    HERE.mkdir(exist_ok=True)
    order = cases()
    rows = [row for row in read(RESOLVED) if key(row) in order]
    done = {key(row) for row in rows}
    for case in order:
        if case in done:
            continue
        kind = KINDS[case[0]]
        new = run_deck(
            kind.resolved, variables_of(case, kind.variables + kind.resolved_variables) | kind.resolved_more, case
        )
        print(
            *case,
            *(f"{row['dispersion_ratio']} (neck {row['last_neck']}, {row['wall_seconds']} s)" for row in new),
            flush=True,
        )
        rows = sorted(rows + new, key=lambda row: (order.index(key(row)), row["carrier"]))
        write(RESOLVED, ROW, rows)
        (HERE / "machine.json").write_text(json.dumps(description(BUILD / "bin/lmp"), indent=1) + "\n")


def functions() -> list[dict[str, str]]:
    rows = []
    for case in cases():
        kind = KINDS[case[0]]
        for method in METHODS:
            law = {"tangential": method}
            if method == "integrate":  # the resolved decks' default
                law["grain_damping"] = "1"
            new = run_deck(kind.functions, variables_of(case, kind.variables) | law, case)
            rows += [{**row, "tangential": method} for row in new]
    # what the functions do not tell; their times would change the file each time
    left_out = ("grains", "last_neck", "wall_seconds")
    columns = ("tangential", *(name for name in ROW if name not in left_out))
    write(FUNCTIONS, columns, [{name: row[name] for name in columns} for row in rows])
    return rows


TITLES = {
    "spin": ("A carrier that spins hits a wall", ("speed", "angle", "wall_friction", "spin"), ("spin_after",)),
    "collision": (
        "Two carriers hit each other, each with this speed",
        ("speed", "offset", "wall_friction"),
        ("spin_after",),
    ),
    "sizes": (
        "Lognormal grains, x50,3 = 15 um, sigma_g = 1.5",
        ("speed", "angle", "coverage", "grain_contacts"),
        ("grains_off",),
    ),
}


def comparison(resolved: list[dict[str, str]], computed: list[dict[str, str]]) -> Iterator[str]:
    by_method = {(row["tangential"], key(row), row["carrier"]): row for row in computed}
    yield "# Spin, two carriers, many sizes: functions against resolved runs"
    yield ""
    yield "Dispersion ratios with the same inputs on both sides and nothing adjusted; e 0.7, 20 us. Functions with"
    yield f"`rotation yes`. Differences are functions - resolved, bold above {LIMIT}. Written by `bodies.py compare`."
    yield ""
    largest: dict[str, list[float]] = {}
    for kind, (title, columns, more) in TITLES.items():
        yield f"## {title}"
        yield ""
        # half a turn about y brings two carriers to each other's places: the second's row is the first's
        found = [row for row in resolved if row["kind"] == kind]
        tellers = METHODS if kind == "sizes" else ("functions",)  # carriers spin the same with both
        rows = []
        for row in (row for row in found if row["carrier"] == "1"):
            others = [by_method[method, key(row), "1"] for method in METHODS]
            ratio = float(row["dispersion_ratio"])
            differences = [float(other["dispersion_ratio"]) - ratio for other in others]
            label = f"{kind}, grains pass through each other" if row["grain_contacts"] == "no" else kind
            for method, difference in zip(METHODS, differences, strict=True):
                largest.setdefault(f"{label}: {method}", []).append(abs(difference))
            cells = [row[name] for name in columns]
            cells += [cell for name in more for cell in (row[name], *(other[name] for other in others[: len(tellers)]))]
            cells += [row["dispersion_ratio"], *(other["dispersion_ratio"] for other in others)]
            cells += [f"{d:+.4f}" if abs(d) <= LIMIT else f"**{d:+.4f}**" for d in differences]
            rows.append(cells)
        head = [*columns, *(f"{name}: {who}" for name in more for who in ("resolved", *tellers))]
        head += ["ratio: resolved", *METHODS, *(f"difference: {method}" for method in METHODS)]
        yield from table((name.replace("_", " ") for name in head), rows)
        if kind == "collision":
            ratios = [float(row["dispersion_ratio"]) for row in found]
            apart = max(abs(first - second) for first, second in zip(ratios[::2], ratios[1::2], strict=True))
            yield "Of the first carrier. The other has the same texture turned with it; its resolved ratio differs by"
            yield f"{apart:.4f} at most."
            yield ""
    yield "## Differences"
    yield ""
    summary = []
    for name, values in largest.items():
        above = sum(value > LIMIT for value in values)
        mean = sum(values) / len(values)
        summary.append([name, str(len(values)), f"{mean:.4f}", f"{max(values):.4f}", str(above)])
    yield from table(["cases", "number", "mean", "largest", f"above {LIMIT}"], summary)


def agreements(text: str) -> Iterator[str]:
    """The last table of the comparison with a column for each law, for the documentation."""
    kinds: dict[str, list[str]] = {}
    for line in text[text.index("## Differences") :].splitlines():
        name, *cells = (cell.strip() for cell in line.strip("|").split("|"))
        if ":" in name:
            kind = name.rpartition(":")[0]
            kinds.setdefault(kind, [f'"{kind}"', cells[0]]).extend(cells[1:3])
    yield ",".join(["cases", "number", *(cell for law in METHODS for cell in (f"{law}: mean", "largest"))])
    yield from (",".join(cells) for cells in kinds.values())


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("what", choices=("run", "compare"))
    if parser.parse_args().what == "run":
        run_all()
        return
    text = "\n".join(comparison(read(RESOLVED), functions()))
    (HERE / "comparison.md").write_text(text)
    (HERE / "agreement.csv").write_text("\n".join(agreements(text)) + "\n")
    print(text, end="")


if __name__ == "__main__":
    main()
