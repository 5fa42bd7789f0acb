"""Grains that meet: dense layers of many sizes, resolved and by the fix with meet yes, over time.

    . build/environment; build/venv/bin/python benchmarks/meeting.py run        half an hour; goes on where it stopped
    . build/environment; build/venv/bin/python benchmarks/meeting.py compare    two minutes
    . build/environment; build/venv/bin/python benchmarks/meeting.py numerics   three minutes: softening and step
    . build/environment; build/venv/bin/python benchmarks/meeting.py cost       five minutes: both side by side
    . build/environment; build/venv/bin/python benchmarks/meeting.py picture    a layer before and after

`run` writes the resolved dispersion ratio of each microsecond to meeting/resolved.csv, with the processor time, and
meeting/machine.json. `compare` runs lammps-inputs/in.impact.meet on the same inputs, with nothing adjusted, and writes
meeting/functions.csv, meeting/comparison.csv and doc/images/meeting.png; `numerics` writes meeting/numerics.csv, `cost`
meeting/cost.json.
"""

import argparse
import json
import os
import re
import resource
import statistics
import subprocess
import tempfile
from pathlib import Path

from machine import description
from rows import read, write

ROOT = Path(__file__).resolve().parents[1]
HERE = ROOT / "benchmarks/meeting"
IMAGES = ROOT / "doc/images"
BUILD = Path(os.environ.get("DUST_BUILD_DIR", ROOT / "build"))
INPUTS = ROOT / "lammps-inputs"
RESOLVED, FUNCTIONS = HERE / "resolved.csv", HERE / "functions.csv"
CASE = ("sizes", "width", "coverage", "speed", "angle")
ROW = (*CASE, "microseconds", "dispersion_ratio", "cpu_seconds")
CURVE = re.compile(r"^ *\d+ +(\d+) +\S+ +\d+ +([\d.e-]+)", re.MULTILINE)  # of the resolved deck's thermo output

#: sizes, width, coverage, speed, angle, and until when (us)
CASES = [
    ("lognormal", "1.5", "0.2", "6", "90", "20"),
    ("lognormal", "1.5", "0.2", "8", "90", "60"),
    ("lognormal", "1.5", "0.2", "12", "90", "20"),
    ("lognormal", "1.5", "0.2", "8", "60", "20"),
    ("lognormal", "1.5", "0.2", "12", "60", "20"),
    ("lognormal", "1.3", "0.1", "8", "90", "20"),
    ("rrsb", "4", "0.2", "8", "90", "20"),
]


def lammps(deck: str, variables: dict[str, str]) -> tuple[str, float]:
    """What a deck prints, and its processor time in seconds."""
    command = [str(BUILD / "bin/lmp"), "-in", str(INPUTS / deck), "-log", "none"]
    for name, value in {"plugin": str(BUILD / "plugin/dustplugin.so"), **variables}.items():
        command += ["-var", name, value]
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    with tempfile.TemporaryDirectory() as folder:
        done = subprocess.run(command, capture_output=True, text=True, cwd=folder, check=False)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    if done.returncode:
        raise RuntimeError(f"{' '.join(command)} failed:\n{done.stdout[-2000:]}")
    return done.stdout, after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def resolved(case: tuple[str, ...]) -> list[dict[str, str]]:
    """A row for each microsecond of a resolved run."""
    sizes, width, coverage, speed, angle, until = case
    variables = {"grain_diameter": "15e-6", "bare": "0.4", "coverage": coverage, "speed": speed, "angle": angle}
    variables |= {"sigma_g" if sizes == "lognormal" else "rrsb": width, "limit": f"{until}e-6"}
    said, seconds = lammps("in.impact.resolved", variables)
    # a step may be printed twice, where one run ends and the next begins
    curve = {int(time): ratio for time, ratio in CURVE.findall(said) if int(time) > 0}
    start = {**dict(zip(CASE, case[:5], strict=True)), "cpu_seconds": f"{seconds:.1f}"}
    return [{**start, "microseconds": str(time), "dispersion_ratio": f"{float(r):.5f}"} for time, r in curve.items()]


def inputs(case: tuple[str, ...]) -> dict[str, str]:
    """Variables of in.impact.meet."""
    return dict(
        zip(("sizes", "width", "coverage", "speed", "angle", "limit"), (*case[:5], f"{case[5]}e-6"), strict=True)
    )


def alone(case: tuple[str, ...]) -> float:
    """The ratio if grains never met."""
    said, _ = lammps("in.impact.meet", inputs(case) | {"meet": "no"})
    return float(re.findall(r"^dispersion ratio ([\d.]+)", said, re.MULTILINE)[-1])


def functions(case: tuple[str, ...], more: str = "") -> list[dict[str, str]]:
    """The same of the fix with meet yes and more keywords."""
    with tempfile.TemporaryDirectory() as folder:
        curve = Path(folder) / "curve"
        _, seconds = lammps("in.impact.meet", inputs(case) | {"curve": str(curve), "more": more})
        lines = [line.split() for line in curve.read_text().splitlines() if not line.startswith("#")]
    start = {**dict(zip(CASE, case[:5], strict=True)), "cpu_seconds": f"{seconds:.1f}"}
    whole = [(time, ratio) for time, ratio in lines if time.endswith(".0") and float(time) > 0]
    return [{**start, "microseconds": time[:-2], "dispersion_ratio": ratio} for time, ratio in whole]


def key(row: dict[str, str]) -> tuple[str, ...]:
    return tuple(row[name] for name in CASE)


def run() -> None:
    HERE.mkdir(exist_ok=True)
    rows = read(RESOLVED)
    done = {key(row) for row in rows}
    for case in CASES:
        if case[:5] in done:
            continue
        rows += resolved(case)
        print(*case, rows[-1]["dispersion_ratio"], rows[-1]["cpu_seconds"], "s", flush=True)
        write(RESOLVED, ROW, rows)
        (HERE / "machine.json").write_text(json.dumps(description(BUILD / "bin/lmp"), indent=1) + "\n")


def compare() -> None:
    expected = {(*key(row), row["microseconds"]): float(row["dispersion_ratio"]) for row in read(RESOLVED)}
    found: list[dict[str, str]] = []
    table: list[dict[str, str]] = []
    for case in CASES:
        rows = functions(case)
        found += rows
        without = alone(case)
        ratios = {row["microseconds"]: float(row["dispersion_ratio"]) for row in rows}
        for time in dict.fromkeys(("10", "20", case[5])):
            there, here = expected[(*case[:5], time)], ratios[time]
            table.append(
                {
                    **dict(zip(CASE, case[:5], strict=True)),
                    "microseconds": time,
                    "resolved": f"{there:.4f}",
                    "meet yes": f"{here:.4f}",
                    "difference": f"{here - there:+.4f}",
                    "meet no": f"{without:.4f}",
                }
            )
            print(*table[-1].values(), flush=True)
    write(FUNCTIONS, ROW, found)
    write(HERE / "comparison.csv", table[0], table)
    differences = [abs(float(row["difference"])) for row in table]
    print(f"mean {statistics.mean(differences):.4f}, largest {max(differences):.4f}")
    draw(read(RESOLVED), found)


def numerics() -> None:
    """How far softening and step move the ratio, at 8 m/s."""
    table = []
    for softening, step in (
        (10, 5),
        (30, 5),
        (30, 10),
        (30, 20),
        (100, 5),
        (100, 10),
        (100, 20),
        (300, 5),
        (300, 10),
        (300, 20),
    ):
        rows = functions(CASES[1], f"meet_softening {softening} meet_step {step}e-9")
        ratios = {row["microseconds"]: f"{float(row['dispersion_ratio']):.4f}" for row in rows}
        table.append(
            {"softening": str(softening), "step": f"{step} ns", **{f"{t} us": ratios[t] for t in ("10", "20", "60")}}
        )
        print(*table[-1].values(), flush=True)
    write(HERE / "numerics.csv", table[0], table)


def draw(resolved_rows: list[dict[str, str]], function_rows: list[dict[str, str]]) -> None:
    import matplotlib.pyplot as plt

    figure, axes = plt.subplots(1, 2, figsize=(10, 4), sharey=True, layout="constrained")
    for case, colour in zip(CASES, plt.get_cmap("viridis").resampled(len(CASES) + 1).colors, strict=False):
        sizes, width, coverage, speed, angle, _ = case
        label = f"{speed} m/s" + (f", {angle}°" if angle != "90" else "")
        if (sizes, width) != ("lognormal", "1.5"):
            label += f", {sizes} {width}, coverage {coverage}"
        for axis, until in zip(axes, (20, 60), strict=True):
            if until == 60 and case[5] != "60":
                continue
            for rows, style in ((resolved_rows, {"marker": "o", "ms": 3, "ls": "none"}), (function_rows, {"ls": "-"})):
                points = [
                    (int(row["microseconds"]), float(row["dispersion_ratio"]))
                    for row in rows
                    if key(row) == case[:5] and 4 <= int(row["microseconds"]) <= until
                ]
                axis.plot(
                    *zip(*points, strict=True), color=colour, label=label if style["ls"] == "-" else None, **style
                )
    axes[0].set_ylabel("dispersion ratio (mass)")
    for axis, letter in zip(axes, "ab", strict=True):
        axis.set_xlabel("time after first contact (µs)")
        axis.set_title(f"({letter})", loc="left")
        axis.grid(alpha=0.3)
    axes[0].legend(fontsize=7)
    axes[1].text(0.98, 0.05, "points: resolved\nlines: meet yes", transform=axes[1].transAxes, ha="right")
    figure.savefig(IMAGES / "meeting.png", dpi=200)


def cost(repeat: int) -> None:
    """Processor times of both, one after the other, in pairs."""
    case = (*CASES[1][:5], "20")
    pairs = [
        (float(resolved(case)[-1]["cpu_seconds"]), float(functions(case)[-1]["cpu_seconds"])) for _ in range(repeat)
    ]
    result = {
        "case": dict(zip((*CASE, "microseconds"), case, strict=True)),
        "resolved_seconds": [there for there, _ in pairs],
        "meet_seconds": [here for _, here in pairs],
        "ratio": round(statistics.median(there / here for there, here in pairs), 1),
        **description(BUILD / "bin/lmp"),
    }
    (HERE / "cost.json").write_text(json.dumps(result, indent=1) + "\n")
    print(json.dumps(result, indent=1))


#: what became of a grain: colours that the colour-blind tell apart
FATES = {"stays": "0.72", "leaves by itself": "#0072b2", "knocked off": "#e69f00"}


def picture() -> None:
    """The far side of a carrier from above, 8 m/s: the layer with what becomes of it, and what is left."""
    import matplotlib.pyplot as plt
    from matplotlib.collections import PatchCollection
    from matplotlib.patches import Circle

    with tempfile.TemporaryDirectory() as folder:
        texture, events = Path(folder) / "texture", Path(folder) / "events"
        lammps("in.impact.meet", {"more": f"write {texture}", "events": str(events)})
        grains = [
            [float(word) for word in line.split()[:4]]
            for line in texture.read_text().splitlines()
            if line[:1] in "-0123456789"
        ]
        left = [
            line.split()
            for line in events.read_text().splitlines()
            if re.fullmatch(r"[-\d.e+]+( [-\d.e+]+){11} ?", line)
        ]
    mode = {int(float(row[2])): int(float(row[3])) for row in left}
    figure, axes = plt.subplots(1, 2, figsize=(10, 5.2), layout="constrained")
    for axis, title, shown in zip(axes, ("(a) before", "(b) after"), (tuple(FATES), ("stays",)), strict=True):
        axis.add_patch(Circle((0, 0), 750, facecolor="0.93", edgecolor="0.5"))
        for fate in shown:
            circles = []
            for number, (x, y, z, diameter) in enumerate(grains, start=1):
                is_fate = {None: "stays", 5: "knocked off"}.get(mode.get(number), "leaves by itself")
                if is_fate == fate and z > 0:
                    shell = 750 + diameter * 5e5
                    circles.append(Circle((x * shell, y * shell), diameter * 5e5))
            axis.add_collection(PatchCollection(circles, facecolor=FATES[fate], edgecolor="0.3", linewidth=0.15))
        axis.plot([-720, -520], [-745, -745], color="black", lw=2)
        axis.text(-620, -735, "200 µm", ha="center", va="bottom", fontsize=8)
        axis.set(xlim=(-790, 790), ylim=(-790, 790), aspect="equal")
        axis.axis("off")
        axis.set_title(title, loc="left")
    handles = [Circle((0, 0), facecolor=colour, edgecolor="0.3") for colour in FATES.values()]
    axes[0].legend(handles, FATES, loc="lower right", fontsize=8, framealpha=1)
    figure.savefig(IMAGES / "layer.png", dpi=130)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("what", choices=("run", "compare", "numerics", "cost", "picture"))
    parser.add_argument("--repeat", type=int, default=3)
    arguments = parser.parse_args()
    if arguments.what == "cost":
        cost(arguments.repeat)
    else:
        {"run": run, "compare": compare, "numerics": numerics, "picture": picture}[arguments.what]()


if __name__ == "__main__":
    main()
