"""What becomes of every single grain in both methods: straight impacts, e 0.7, by polar angle from the impact.

    . build/environment; build/venv/bin/python benchmarks/fates.py      a few minutes

Grain i of the texture is the same in both methods. Writes impacts/fates.csv and impacts/fates.png.
"""

import tempfile
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
from dustdetach import Impact, run
from dustdetach.frames import Frame, frame_sizes, read_frames
from dustdetach.shares import read_fates
from numpy.typing import NDArray
from rows import write
from scipy.spatial import cKDTree

HERE = Path(__file__).resolve().parent / "impacts"
SPEEDS = (5.0, 7.0, 8.0, 12.0)
BINS = np.linspace(0, 180, 37)
KEYS = (
    "speed",
    "both",
    "functions_only",
    "resolved_only",
    "neither",
    "came_back",
    "moved",
    "median_um",
    "largest_um",
)
KEYS += ("touching_before", "touching_after")


def grains(frame: Frame, number: int) -> tuple[NDArray[np.float64], NDArray[np.bool_]]:
    """Places relative to the carrier's centre (not a number where a grain has left the box), and who is tied."""
    places, tied = np.full((number, 3), np.nan), np.zeros(number, dtype=bool)
    indices = frame.ids - 2  # the carrier is atom 1
    places[indices] = frame.centres - frame.carrier
    tied[indices] = frame.tied
    return places, tied


def touching(places: NDArray[np.float64], radius: float) -> int:
    """Grains that touch another."""
    found = cKDTree(places).query_pairs(2.001 * radius)
    return len({grain for pair in found for grain in pair})


def examine(speed: float) -> tuple[dict[str, float], NDArray, NDArray, NDArray]:
    with tempfile.TemporaryDirectory() as folder:
        dump, events = Path(folder) / "frames", Path(folder) / "events"
        resolved = run(Impact(method="resolved", speed=speed), frames=dump)
        run(Impact(speed=speed, tangential="estimate"), events=events)
        number = resolved.grains
        predicted = read_fates(events, number) > 0
        first, *others = read_frames(dump, list(frame_sizes(dump)))
        start, _ = grains(first, number)
        ever_lost, came_back = np.zeros(number, dtype=bool), np.zeros(number, dtype=bool)
        for frame in others:
            end, tied = grains(frame, number)
            came_back |= ever_lost & tied
            ever_lost |= ~tied
    unit = start / np.linalg.norm(start, axis=1)[:, None]
    turned = end / np.linalg.norm(end, axis=1)[:, None]
    moved = np.arccos(np.clip((unit * turned).sum(axis=1), -1, 1))[tied] * 0.76e-3 * 1e6
    radius = 10e-6
    row = {
        "speed": speed,
        "both": int((predicted & ~tied).sum()),
        "functions_only": int((predicted & tied).sum()),
        "resolved_only": int((~predicted & ~tied).sum()),
        "neither": int((~predicted & tied).sum()),
        "came_back": int(came_back.sum()),
        "moved": int((moved > 1.0).sum()),
        "median_um": round(float(np.median(moved)), 2),
        "largest_um": round(float(moved.max()), 1),
        "touching_before": touching(start, radius),
        "touching_after": touching(end[tied], radius),
    }
    polar = np.degrees(np.arccos(-unit[:, 2]))
    return row, polar, predicted, ~tied


def main() -> None:
    figure, axes = plt.subplots(2, 2, figsize=(7.1, 5.0), layout="constrained", sharex=True, sharey=True)
    rows = []
    middle = (BINS[:-1] + BINS[1:]) / 2
    for speed, panel in zip(SPEEDS, axes.flat, strict=True):
        row, polar, predicted, detached = examine(speed)
        rows.append(row)
        print(row, flush=True)
        count = np.histogram(polar, BINS)[0]
        for who, colour, label in (
            (predicted, "0.35", "functions"),
            (detached, "#D55E00", "resolved"),
        ):
            share = np.histogram(polar[who], BINS)[0] / np.maximum(count, 1)
            panel.plot(middle[count > 0], share[count > 0], color=colour, label=label)
        panel.set_title(f"{speed:g} m/s", fontsize=9, loc="left")
        panel.axvline(90, color="0.85", linewidth=0.8)
    axes[0, 0].legend(frameon=False)
    for panel in axes[1]:
        panel.set_xlabel("Polar angle from the impact (degrees)")
    for panel in axes[:, 0]:
        panel.set_ylabel("Share detached")
    axes[1, 0].set_xticks(range(0, 181, 30))
    figure.savefig(HERE / "fates.png", dpi=150)
    write(HERE / "fates.csv", KEYS, rows)


if __name__ == "__main__":
    main()
