"""Pictures of the decks of beds, doc/images/drum.png, drop.png, sieve.png, pour.png and chute.png: runs the decks in a
folder, unless done, and draws.

    . build/environment; build/venv/bin/python benchmarks/bed_pictures.py --work WORK [drum drop sieve pour chute]
"""

import argparse
import re
from io import BytesIO
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import numpy as np
from deck import ROOT, run
from matplotlib import pyplot as plt
from matplotlib.collections import EllipseCollection
from matplotlib.colors import LogNorm
from PIL import Image

GRAINS = 4500
EXTRA = {
    "drum": {"turns": 0.5, "timestep": 3e-6},
    "drop": {"field": "field", "timestep": 2e-6},
    "sieve": {"timestep": 1.5e-6},
    "pour": {"timestep": 2e-6},
    "chute": {"timestep": 2e-6},
}
WALL = {"color": "0.35", "linewidth": 1.2}


def run_bed(deck: str, folder: Path) -> None:
    """Write the deck's dump and log (and the drop's source field) into a folder; nothing if they are there."""
    if (folder / "log").is_file():
        return
    folder.mkdir(parents=True, exist_ok=True)
    run(f"in.{deck}", folder, log="part", dump="dump", **EXTRA[deck])
    (folder / "part").rename(folder / "log")


def frames(folder: Path) -> dict[int, np.ndarray]:
    """Rows of the dump (carriers, columns) by step: id x y z radius vx vy vz grains, from the front to the back."""
    found = {}
    for block in (folder / "dump").read_text().split("ITEM: TIMESTEP\n")[1:]:
        lines = block.splitlines()
        if rows := [line.split() for line in lines[8:]]:
            rows = np.array(rows, dtype=float)
            found[int(lines[0])] = rows[rows[:, 2].argsort()[::-1]]
    return found


def table(folder: Path) -> dict[str, np.ndarray]:
    """Columns of the last run's thermo output."""
    text = (folder / "log").read_text()
    last = text[text.rindex("\n   Step") : text.rindex("Loop time")]
    names, *rows = [line.split() for line in last.splitlines() if re.match(r" +(Step|\d)", line)]
    return dict(zip(names, np.array(rows, dtype=float).T, strict=True))


def draw_carriers(axes, rows: np.ndarray):
    """All carriers seen along y, those in front over those behind, coloured by the dust they have lost; mm."""
    carriers = EllipseCollection(
        *[2e3 * rows[:, 4]] * 2,
        0,
        units="xy",
        offsets=1e3 * rows[:, [1, 3]],
        offset_transform=axes.transData,
        cmap="YlOrBr_r",
        edgecolor="0.25",
        linewidth=0.15,
    )
    # mass lost and brought, where carriers bring unequally much
    carriers.set_array(rows[:, 9] / rows[:, 10] if rows.shape[1] > 10 else 1 - rows[:, 8] / GRAINS)
    carriers.set_clim(0, 1)
    axes.add_collection(carriers)
    axes.set_aspect("equal")
    axes.axis("off")
    return carriers


def save(figure, name: str) -> None:
    """As PNG with 128 colours."""
    with BytesIO() as buffer:
        figure.savefig(buffer, format="png", dpi=150)
        image = Image.open(buffer).convert("RGB").quantize(128, Image.Quantize.MAXCOVERAGE, dither=Image.Dither.NONE)
    image.save(ROOT / f"doc/images/{name}.png", optimize=True)
    plt.close(figure)


def bar(figure, axes, carriers) -> None:
    figure.colorbar(carriers, ax=axes, shrink=0.7, pad=0.01, label="share of its dust\nthat a carrier has lost")
    figure.get_layout_engine().set(wspace=0.06)  # between the bar and the curve


def curve(axes, folder: Path, words: str) -> None:
    columns = table(folder)
    axes.plot(columns["Time"], columns["f_dust"], color="#a04000")
    axes.set_xlabel(words)
    axes.set_ylabel("dispersion ratio")
    axes.set_ylim(bottom=0)
    axes.grid(alpha=0.3)


def drum(folder: Path) -> None:
    """The bed in the middle and at the end of half a turn, and the curve."""
    all_frames = frames(folder)
    steps = sorted(all_frames)
    figure, axes = plt.subplots(1, 3, figsize=(12, 4), layout="constrained", width_ratios=(1, 1, 1.1))
    for place, step in zip(axes, (steps[len(steps) // 2], steps[-1]), strict=False):
        turned = 2 * np.pi * 0.5 * (step - steps[0]) / (steps[-1] - steps[0])
        carriers = draw_carriers(place, all_frames[step])
        carriers.set_clim(0, 0.25)
        place.add_patch(plt.Circle((0, 0), 50, fill=False, **WALL))
        for angle in turned + np.pi / 2 * np.arange(4):  # the bars; about y, z turns towards x
            along = np.array([np.cos(angle), -np.sin(angle)])
            place.plot(*np.outer(along, (45, 50)), color="0.35", linewidth=3, solid_capstyle="butt")
        place.set(xlim=(-51, 51), ylim=(-51, 51), title=f"{turned / 2 / np.pi:.2f} turns")
    bar(figure, axes[:2], carriers)
    curve(axes[2], folder, "time, s")
    save(figure, "drum")


def drop(folder: Path) -> None:
    """The heap just before, while and after it hits the plate, and where the dust came off."""
    all_frames = frames(folder)
    steps = sorted(all_frames)
    figure, axes = plt.subplots(2, 2, figsize=(11, 6.2), layout="constrained")
    for place, step in zip(axes.flat, (steps[0], steps[4], steps[-1]), strict=False):
        carriers = draw_carriers(place, all_frames[step])
        place.set_title(f"{(step - steps[0]) * 2e-3:.1f} ms")
    bar(figure, axes[0], carriers)
    field = sum(read_field(file) for file in folder.glob("field.*.vtr")).sum(axis=1)  # over time and y
    edges = [np.linspace(-60, 60, 25), np.arange(len(field) + 1) * 5.0]
    shown = axes[1, 1].pcolormesh(*edges, np.where(field > 0, field * 1e9, np.nan), cmap="viridis", norm=LogNorm())
    figure.colorbar(shown, ax=axes[1, 1], label="dust that came off, ug")
    axes[1, 1].set_aspect("equal")
    axes[1, 1].axis("off")
    for place in axes.flat:
        place.axhline(0, **WALL)
        place.set(xlim=(-60, 60), ylim=(-1, 60))
    save(figure, "drop")


def read_field(file: Path) -> np.ndarray:
    """Values of dump grid/vtk (nz, ny, nx)."""
    text = file.read_text()
    nx, ny, nz = (int(word) for word in re.search(r'WholeExtent="0 (\d+) 0 (\d+) 0 (\d+)"', text).groups())
    cells = re.search(r"<CellData>\s*<DataArray[^>]*>(.*?)</DataArray>", text, re.DOTALL)[1].split()
    return np.array(cells, dtype=float).reshape(nz, ny, nx)


def sieve(folder: Path) -> None:
    """The heap before and after it has hit the plate, with a scale, and what each fraction loses."""
    all_frames = frames(folder)
    steps = sorted(all_frames)
    figure, axes = plt.subplots(1, 3, figsize=(12.5, 3.9), layout="constrained", width_ratios=(1, 1, 1.1))
    for letter, place, step in zip("ab", axes, (steps[0], steps[30]), strict=False):
        carriers = draw_carriers(place, all_frames[step])
        place.axhline(0, **WALL)
        place.set(xlim=(-17, 17), ylim=(-3, 22))
        place.set_title(f"{letter}) {(step - steps[0]) * 1.5e-3:.1f} ms after the fall", loc="left")
    axes[0].plot((10, 15), (-1.5, -1.5), color="black", linewidth=2)
    axes[0].text(12.5, -2.9, "5 mm", ha="center")
    bar(figure, axes[:2], carriers)
    columns = table(folder)
    time = 1e3 * (columns["Time"] - columns["Time"][0])
    for k, (name, colour) in enumerate((("1.0 mm", "#d98880"), ("1.2 mm", "#c0392b"), ("1.5 mm", "#641e16")), start=1):
        axes[2].plot(time, columns[f"v_off{k}"], label=name, color=colour)
    axes[2].plot(time, columns["f_dust"], "k--", label="all")
    axes[2].set(xlabel="time after the fall, ms", ylabel="dispersion ratio", ylim=(0, 1.02))
    axes[2].grid(alpha=0.3)
    axes[2].legend(loc="lower right")
    axes[2].set_title("c) share that each fraction has lost", loc="left")
    save(figure, "sieve")


def pour(folder: Path) -> None:
    """The stream on the chute, and the curve."""
    all_frames = frames(folder)
    figure, axes = plt.subplots(1, 2, figsize=(10, 4.6), layout="constrained")
    step = min(all_frames, key=lambda step: abs(step * 2e-6 - 0.09))
    carriers = draw_carriers(axes[0], all_frames[step])
    x = np.array([-20, 80])
    axes[0].plot(x, -np.tan(np.radians(35)) * x, **WALL)
    axes[0].set(xlim=(-20, 80), ylim=(-60, 40), title=f"{step * 2e-6:.3f} s")
    bar(figure, axes[0], carriers)
    curve(axes[1], folder, "time, s")
    save(figure, "pour")


def chute(folder: Path) -> None:
    """The stream on the triangles of the STL file, and the curve."""
    all_frames = frames(folder)
    figure, axes = plt.subplots(1, 2, figsize=(11, 4.4), layout="constrained", width_ratios=(1.5, 1))
    step = min(all_frames, key=lambda step: abs(step * 2e-6 - 0.25))
    carriers = draw_carriers(axes[0], all_frames[step])
    corners = re.findall(r"vertex (\S+) \S+ (\S+)", (folder / "chute.stl").read_text())
    for triangle in 1e3 * np.array(corners, dtype=float).reshape(-1, 3, 2):
        axes[0].plot(*triangle.T, **WALL)
    axes[0].plot((100, 110), (-8, -8), color="black", linewidth=2)
    axes[0].text(105, -6.5, "10 mm", ha="center")
    axes[0].set(xlim=(-3, 140), ylim=(-76, 12))
    axes[0].set_title(f"a) {step * 2e-6:.2f} s", loc="left")
    bar(figure, axes[0], carriers)
    curve(axes[1], folder, "time, s")
    axes[1].set_title("b) of all carriers", loc="left")
    save(figure, "chute")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--work", type=Path, required=True)
    parser.add_argument("decks", nargs="*", default=["drum", "drop", "sieve", "pour", "chute"])
    args = parser.parse_args()
    for deck in args.decks:
        run_bed(deck, args.work / deck)
        {"drum": drum, "drop": drop, "sieve": sieve, "pour": pour, "chute": chute}[deck](args.work / deck)


if __name__ == "__main__":
    main()
