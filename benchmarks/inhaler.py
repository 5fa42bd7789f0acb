"""A fine carrier with drug on an inhaler's wall: criteria of lift-off, sliding and rolling, angles and spins.

    . build/environment; build/venv/bin/python benchmarks/inhaler.py      a minute

Runs lammps-inputs/in.impact.inhaler and writes inhaler/criteria.csv, what each criterion alone would release, and
inhaler/angles.csv, the angles of largest release and what spin changes, which doc/validation.rst shows.
"""

import re

from deck import ROOT, run
from rows import write

HERE = ROOT / "benchmarks/inhaler"
SPEEDS = (1, 2, 4, 7, 9, 12, 16, 20)
ANGLES = (90, 75, 60, 45, 30, 15)
FRICTIONS = (0.05, 0.3, 0.6)
SPIN = 1e5  # rad/s


def shares(**variables: object) -> dict[str, float]:
    """Fractions of the grains that the deck prints, by name."""
    printed = run("in.impact.inhaler", **variables)
    found = {}
    for line in re.findall(r"^(?:detached|met): .*|^dispersion .*", printed, re.MULTILINE):
        kind = "met " if line.startswith("met") else ""
        found |= {kind + name: float(value) for name, value in re.findall(r"([a-z-]+(?: ratio)?) (\d\.\d+)", line)}
    return found


def criteria() -> list[dict[str, str]]:
    """Which grains lift off, and which only slide or roll, as one look at the whole collision tells."""
    rows = []
    for speed in SPEEDS:
        seen, acting = shares(speed=speed), shares(speed=speed, criteria="ibrahim")
        rows.append(
            {
                "v (m/s)": f"{speed:g}",
                "lift-off": f"{seen['lift-off']:.3f}",
                "only slide or roll": f"{seen['met rolling'] - seen['lift-off']:.3f}",
                "met sliding": f"{seen['met sliding']:.3f}",
                "met rolling": f"{seen['met rolling']:.3f}",
                "tangential": f"{seen['tangential']:.3f}",
                "ibrahim": f"{acting['dispersion ratio']:.3f}",
            }
        )
    return rows


def angles() -> list[dict[str, str]]:
    rows = []
    for friction in FRICTIONS:
        for speed in SPEEDS:
            still = {angle: shares(speed=speed, angle=angle, wall_friction=friction) for angle in ANGLES}
            ratio = {angle: found["dispersion ratio"] for angle, found in still.items()}
            changes = []
            for angle in (90, 45):
                spinning = [
                    shares(speed=speed, angle=angle, wall_friction=friction, spin=spin) for spin in (-SPIN, SPIN)
                ]
                changes += [found["dispersion ratio"] - ratio[angle] for found in spinning]
            rows.append(
                {
                    "wall friction": f"{friction:g}",
                    "v (m/s)": f"{speed:g}",
                    **{f"{angle}°": f"{value:.3f}" for angle, value in ratio.items()},
                    "best": f"{max(ANGLES, key=lambda angle: ratio[angle])}°",
                    "spin: largest change at 90°": f"{max(changes[:2], key=abs):+.3f}",
                    "at 45°": f"{max(changes[2:], key=abs):+.3f}",
                }
            )
    return rows


def main() -> None:
    HERE.mkdir(exist_ok=True)
    for name, rows in (("criteria", criteria()), ("angles", angles())):
        write(HERE / f"{name}.csv", rows[0], rows)


if __name__ == "__main__":
    main()
