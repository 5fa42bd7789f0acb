"""Pictures of a carrier with its grains, each a sphere of its real size, drawn by LAMMPS' dump image."""

from __future__ import annotations

import tempfile
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import matplotlib

matplotlib.use("Agg")

import numpy as np
from matplotlib import pyplot as plt
from matplotlib.lines import Line2D
from numpy.typing import NDArray

from .errors import InvalidInput
from .files import replace_file
from .impact import Impact
from .result import Result
from .runner import run
from .session import lammps_session
from .texture import Texture, make_texture, read_texture

#: width and height of the drawing, pixels
SIZE = 900


@dataclass(frozen=True)
class Kind:
    """A kind of grain in a picture: how the legend calls it, and its colour (red, green, blue from 0 to 1)."""

    name: str
    colour: tuple[float, float, float]


CARRIER = (0.42, 0.46, 0.52)
GRAIN = Kind("grain", (0.96, 0.90, 0.76))

#: what an impact makes of a grain, numbered like the modes of fix dust/detach; 0 stays attached
FATES = (
    Kind("attached", GRAIN.colour),
    Kind("detached, normal lift-off", (0.84, 0.37, 0.0)),
    Kind("detached, tangential lift-off", (0.0, 0.45, 0.70)),
)

# column of the dumped events that hold the grain (from 1) and the mode, after step and carrier
_GRAIN, _MODE = 2, 3


def draw_texture(texture: Texture, path: Path) -> None:
    """Draw a carrier with its grains as PNG, seen from the side of the impact and below so that the bare cap shows."""
    kinds = np.zeros(len(texture.diameters), dtype=int)
    with tempfile.TemporaryDirectory() as folder:
        image = Path(folder) / "carrier.png"
        _render(texture, kinds, [GRAIN], image)
        _compose(image, [], path)


def draw_impact(impact: Impact, path: Path) -> Result:
    """Run an impact and draw its carrier as PNG, every grain at its place and coloured by what became of it.

    Returns:
        The impact's result.
    """
    with tempfile.TemporaryDirectory() as folder:
        events, grains, image = (Path(folder) / name for name in ("events.dump", "grains.txt", "carrier.png"))
        result = run(impact, events=events)
        make_texture(impact, grains)
        texture = read_texture(grains)
        fates = read_fates(events, len(texture.diameters))
        _render(texture, fates, FATES, image)
        _compose(image, _legend(np.bincount(fates, minlength=len(FATES))), path)
    return result


def read_fates(path: Path, grains: int) -> NDArray[np.int64]:
    """What became of each grain (0 attached, else the mode) from the events that LAMMPS' dump local wrote.

    Raises:
        InvalidInput: an event of a grain that the texture does not have.
    """
    fates = np.zeros(grains, dtype=np.int64)
    rows = False
    for line in path.read_text().splitlines():
        if line.startswith("ITEM:"):
            rows = line.startswith("ITEM: ENTRIES")
        elif rows:
            words = line.split()
            grain, mode = int(float(words[_GRAIN])), int(float(words[_MODE]))
            if not 1 <= grain <= grains:
                raise InvalidInput(f"{path}: an event of grain {grain}, but the texture has {grains}")
            fates[grain - 1] = mode
    return fates


def _render(texture: Texture, kinds: NDArray[np.int64], palette: Sequence[Kind], image: Path) -> None:
    """Let LAMMPS draw the spheres; lengths in carrier radii."""
    radius = texture.carrier_diameter / 2
    centres = np.vstack([np.zeros(3), texture.centres / radius])
    radii = np.concatenate([[1.0], texture.diameters / 2 / radius])
    half = float(1 + 2 * radii[1:].max())
    number = len(radii)
    with lammps_session() as lmp:
        lmp.commands_list(
            [
                "units lj",
                "atom_style sphere",
                "atom_modify map array sort 0 0",
                "boundary f f f",
                f"region box block -{half} {half} -{half} {half} -{half} {half}",
                f"create_box {len(palette) + 1} box",
                "pair_style zero 1.0 nocoeff",
                "pair_coeff * *",
            ]
        )
        lmp.create_atoms(number, None, [1, *(kinds + 2).tolist()], centres.ravel().tolist())
        lmp.numpy.extract_atom("radius")[:number] = radii
        colours = [f"carrier {_words(CARRIER)}", *(f"kind{i} {_words(kind.colour)}" for i, kind in enumerate(palette))]
        modify = " ".join(f"color {colour}" for colour in colours)
        modify += " acolor 1 carrier " + " ".join(f"acolor {i + 2} kind{i}" for i in range(len(palette)))
        lmp.command(
            f'write_dump all image "{image}" type diameter size {SIZE} {SIZE} view 122 25 up 0 0 1 zoom 1.62 '
            f"box no 0.0 axes no 0.0 0.0 shiny 0.15 fsaa yes ssao yes 4711 0.15 modify {modify} backcolor white"
        )


def _words(colour: tuple[float, float, float]) -> str:
    return " ".join(f"{part:g}" for part in colour)


def _legend(counts: NDArray[np.int64]) -> list[Line2D]:
    return [
        Line2D(
            [],
            [],
            linestyle="none",
            marker="o",
            markersize=9,
            markeredgecolor="0.35",
            markeredgewidth=0.5,
            color=kind.colour,
            label=f"{kind.name}: {count} ({count / counts.sum():.1%})",
        )
        for kind, count in zip(FATES, counts, strict=True)
    ]


def _compose(image: Path, handles: list[Line2D], path: Path) -> None:
    """The drawing without its margins, above a legend if there is one."""
    pixels = plt.imread(image)[:, :, :3]
    drawn = np.argwhere((pixels < 0.99).any(axis=2))
    (top, left), (bottom, right) = drawn.min(axis=0), drawn.max(axis=0)
    pixels = pixels[top : bottom + 1, left : right + 1]
    height, width = pixels.shape[0] / SIZE * 6, pixels.shape[1] / SIZE * 6
    margin, foot = 0.1, 0.27 * len(handles) + 0.1 * bool(handles)
    total = (width + 2 * margin, height + 2 * margin + foot)
    figure = plt.figure(figsize=total)
    axes = figure.add_axes((margin / total[0], (margin + foot) / total[1], width / total[0], height / total[1]))
    axes.imshow(pixels, interpolation="lanczos")
    axes.axis("off")
    if handles:
        figure.legend(handles=handles, loc="lower center", frameon=False, fontsize=11, handletextpad=0.3)
    with replace_file(path) as part:
        figure.savefig(part, dpi=SIZE / 6)
    plt.close(figure)
