"""Pictures of a carrier with its grains, each a sphere of its real size, drawn by LAMMPS' dump image.

A texture, or an impact by the functions, is one carrier seen from below. A resolved impact is four moments of it seen
from the side, as in the paper's Figs. 2 and 3.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from io import BytesIO
from pathlib import Path
from typing import Any

import matplotlib

matplotlib.use("Agg")

import numpy as np
from matplotlib import pyplot as plt
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patheffects import withStroke
from numpy.typing import NDArray
from PIL import Image

from .errors import InvalidInput, MachineFault, shown
from .files import as_path, replace_file, scratch_folder, writable_file
from .frames import Frame, frame_sizes, read_frames
from .impact import Impact, as_impact
from .result import Result
from .runner import Watch, run
from .session import MPI_ROOM, lammps_file, lammps_session
from .shares import read_fates
from .texture import Texture, make_texture, read_texture

#: width and height of the drawing of a carrier, and of each moment of an impact, pixels
SIZE = 900
MOMENT_SIZE = 600


#: bytes of the images that LAMMPS draws, and of a grain in a frame, a list of events or a texture file
IMAGE_ROOM, ROW_ROOM = 4_000_000, 100

#: how long a resolved run takes at most, s, and the steps from frame to frame, both of the deck
RESOLVED_LIMIT, FRAME_STEPS = 50e-6, 500


@dataclass(frozen=True)
class Kind:
    """A kind of grain in a picture: how the legend calls it, and its colour (red, green, blue from 0 to 1)."""

    name: str
    colour: tuple[float, float, float]


CARRIER = Kind("carrier", (0.42, 0.46, 0.52))
WALL = Kind("wall", (0.74, 0.77, 0.80))
GRAIN = Kind("grain", (0.96, 0.90, 0.76))

#: what an impact makes of a grain, numbered like the modes of fix dust/detach; 0 stays attached
FATES = (
    Kind("attached", GRAIN.colour),
    Kind("detached, normal lift-off", (0.84, 0.37, 0.0)),
    Kind("detached, tangential lift-off", (0.0, 0.45, 0.70)),
    Kind("detached by sliding", (0.0, 0.62, 0.45)),
    Kind("detached by rolling", (0.80, 0.47, 0.65)),
    Kind("knocked off by others", (0.34, 0.71, 0.91)),
)

#: what a grain is at a moment of a resolved impact
STATES = (Kind("tied to the carrier", GRAIN.colour), Kind("detached", (0.84, 0.37, 0.0)))


@dataclass(frozen=True)
class _Scene:
    """Spheres and how they are seen; lengths in carrier radii.

    Attributes:
        centres: of the spheres (N, 3).
        radii: of the spheres (N,).
        kinds: index of each sphere's kind in the palette (N,).
        palette: the kinds.
        box: lower and upper corner (2, 3) of what is drawn.
        view: polar angle and azimuth of the camera, degrees; it looks at the middle of the box, z is up.
        width: of the square drawing.
        size: width of the square drawing, pixels.
    """

    centres: NDArray[np.float64]
    radii: NDArray[np.float64]
    kinds: NDArray[np.int64]
    palette: Sequence[Kind]
    box: NDArray[np.float64]
    view: tuple[float, float]
    width: float
    size: int


def draw_texture(texture: Texture, path: str | Path) -> None:
    """Draw a carrier with its grains as PNG, seen from the side of the impact and below so that the bare cap shows."""
    if not isinstance(texture, Texture):
        raise InvalidInput(f"draw_texture: {shown(texture)} is not a Texture")
    path = writable_file(as_path(path, "picture"), "picture")
    kinds = np.zeros(len(texture.diameters), dtype=int)
    with scratch_folder(IMAGE_ROOM) as folder:
        image = folder / "carrier.png"
        scene = _carrier_scene(texture, kinds, [GRAIN])
        _render(scene, image)
        _compose(image, [], path, _Marks(scene, texture.carrier_diameter / 2))


def draw_impact(impact: Impact, path: str | Path, watch: Watch | None = None) -> Result:
    """Run an impact and draw it as PNG.

    With the functions: the carrier, every grain at its place and coloured by what became of it. Resolved: four moments.

    Args:
        impact: the parameters.
        path: the picture.
        watch: see `run`.

    Returns:
        The impact's result.

    Raises:
        InvalidInput: there can be no file of this name.
        MachineFault: the disk is full, that of temporary files included.
    """
    impact = as_impact(impact, "draw_impact")
    path = writable_file(as_path(path, "picture"), "picture")
    resolved = impact.method == "resolved"
    draw = _draw_moments if resolved else _draw_fates
    frames = RESOLVED_LIMIT / (FRAME_STEPS * impact.timestep) + 2 if resolved else 2
    with scratch_folder(MPI_ROOM + IMAGE_ROOM + round(frames * ROW_ROOM * (impact.grains + 10))) as folder:
        return draw(impact, path, folder, watch)


def _draw_fates(impact: Impact, path: Path, folder: Path, watch: Watch | None) -> Result:
    events, grains, image = (folder / name for name in ("events.dump", "grains.txt", "carrier.png"))
    result = run(impact, events=events, watch=watch)
    make_texture(impact, grains)
    with _written_by_us():
        texture = read_texture(grains)
        fates = read_fates(events, len(texture.diameters))
        masses = texture.diameters**3
        if abs(np.sum(masses[fates != 0]) / np.sum(masses) - result.dispersion_ratio) > 1e-6:
            raise InvalidInput(f"{events}: not all detachments are there")
    scene = _carrier_scene(texture, fates, FATES)
    _render(scene, image)
    marks = _Marks(scene, texture.carrier_diameter / 2, impact)
    _compose(image, _legend(np.bincount(fates, minlength=len(FATES))), path, marks)
    return result


def _draw_moments(impact: Impact, path: Path, folder: Path, watch: Watch | None) -> Result:
    dump = folder / "frames.dump"
    result = run(impact, frames=dump, watch=watch)
    with _written_by_us():
        moments = _read_moments(dump, result)
    _draw_frames(moments, result, path)
    return result


@contextmanager
def _written_by_us() -> Iterator[None]:
    """A file of ours that is not what it should be: LAMMPS does not tell when a disk is full."""
    try:
        yield
    except InvalidInput as error:
        raise MachineFault(f"{error}: the disk may be full") from None


def draw_moments(frames: str | Path, result: Result, path: str | Path) -> None:
    """Draw four moments of a resolved impact as PNG, all seen by one camera from the side.

    Args:
        frames: what `run` wrote.
        result: what it returned.
        path: the picture.
    """
    path = writable_file(as_path(path, "picture"), "picture")
    _draw_frames(_read_moments(frames, result), result, path)


def _read_moments(frames: str | Path, result: Result) -> list[Frame]:
    return read_frames(frames, _moments(frame_sizes(frames), result))


def _draw_frames(chosen: list[Frame], result: Result, path: Path) -> None:
    with scratch_folder(IMAGE_ROOM) as folder:
        images = [folder / f"{frame.step}.png" for frame in chosen]
        for frame, image in zip(chosen, images, strict=True):
            _render(_side_scene(frame), image)
        _compose_moments(chosen, images, result, path)


def _moments(sizes: dict[int, int], result: Result) -> list[int]:
    """Steps of the four moments, from the atoms in each frame by its step.

    The first frame; the first after the contact; the last in which no grain has left the box yet; one between these.
    """
    contact = [step for step in sizes if step * result.timestep > result.contact_time] or list(sizes)
    last = max((step for step in contact if sizes[step] == result.grains + 1), default=contact[-1])
    between = math.sqrt(max(contact[0], 1) * last)
    return [min(sizes), contact[0], min(contact, key=lambda step: abs(step - between)), last]


def _carrier_scene(texture: Texture, kinds: NDArray[np.int64], palette: Sequence[Kind]) -> _Scene:
    """A carrier seen from below; ``kinds`` and ``palette`` are those of its grains."""
    radius = texture.carrier_diameter / 2
    radii = np.concatenate([[1.0], texture.diameters / 2 / radius])
    half = float(1 + 2 * radii[1:].max())
    return _Scene(
        centres=np.vstack([np.zeros(3), texture.centres / radius]),
        radii=radii,
        kinds=np.concatenate([[0], kinds + 1]),
        palette=[CARRIER, *palette],
        box=np.array([[-half] * 3, [half] * 3]),
        view=(122, 25),
        width=4 * half / 1.62,
        size=SIZE,
    )


#: radius of the small spheres that make the plate of the wall, and their distance along x and y, in carrier radii
_PLATE_RADIUS, _PLATE_STEPS = 0.04, (0.01, 0.015)
#: what is drawn around the deck's box, in carrier radii
_MARGIN = 0.05


def _side_scene(frame: Frame) -> _Scene:
    """Carrier, grains and wall seen from the side, in a box that is the same for all frames of a run."""
    unit = frame.carrier_radius
    box = frame.box / unit + [[-_MARGIN], [_MARGIN]]
    plate = _plate(box)
    inside = ((frame.centres / unit > box[0]) & (frame.centres / unit < box[1])).all(axis=1)
    return _Scene(
        centres=np.vstack([frame.carrier / unit, plate, frame.centres[inside] / unit]),
        radii=np.concatenate([[1.0], np.full(len(plate), _PLATE_RADIUS), frame.radii[inside] / unit]),
        kinds=np.concatenate([[0], np.full(len(plate), 1), np.where(frame.tied[inside], 2, 3)]),
        palette=[CARRIER, WALL, *STATES],
        box=box,
        view=(84, -90),
        width=float((box[1] - box[0]).max()),
        size=MOMENT_SIZE,
    )


def _plate(box: NDArray[np.float64]) -> NDArray[np.float64]:
    """Centres (N, 3) of small spheres that together look like the wall z = 0."""
    x, y = (
        np.arange(low + _PLATE_RADIUS, high - _PLATE_RADIUS, step)
        for (low, high), step in zip(box.T[:2], _PLATE_STEPS, strict=True)
    )
    return np.array([(a, b, -_PLATE_RADIUS) for a in x for b in y])


def _render(scene: _Scene, image: Path) -> None:
    """Let LAMMPS draw the spheres, orthographically."""
    (x0, y0, z0), (x1, y1, z1) = scene.box
    number = len(scene.radii)
    with lammps_session() as lmp:
        lmp.commands_list(
            [
                "units lj",
                "atom_style sphere",
                "atom_modify map array sort 0 0",
                "boundary f f f",
                f"region box block {x0} {x1} {y0} {y1} {z0} {z1}",
                f"create_box {len(scene.palette)} box",
                "pair_style zero 1.0 nocoeff",
                "pair_coeff * *",
            ]
        )
        lmp.create_atoms(number, None, (scene.kinds + 1).tolist(), scene.centres.ravel().tolist())
        lmp.numpy.extract_atom("radius")[:number] = scene.radii
        modify = " ".join(f"color kind{i} {_words(kind.colour)}" for i, kind in enumerate(scene.palette))
        modify += "".join(f" acolor {i + 1} kind{i}" for i in range(len(scene.palette)))
        # at zoom 1 LAMMPS draws twice the longest edge of the box
        zoom = 2 * (scene.box[1] - scene.box[0]).max() / scene.width
        polar, azimuth = scene.view
        name = lammps_file(image, "TMPDIR")
        lmp.command(
            f"write_dump all image {name} type diameter size {scene.size} {scene.size} view {polar} {azimuth} "
            f"up 0 0 1 zoom {zoom} box no 0.0 axes no 0.0 0.0 shiny 0.15 fsaa yes ssao yes 4711 0.15 modify {modify} "
            "backcolor white"
        )


def _words(colour: tuple[float, float, float]) -> str:
    return " ".join(f"{part:g}" for part in colour)


def _mark(kind: Kind, label: str) -> Line2D:
    return Line2D(
        [],
        [],
        linestyle="none",
        marker="o",
        markersize=9,
        markeredgecolor="0.35",
        markeredgewidth=0.5,
        color=kind.colour,
        label=label,
    )


def _legend(counts: NDArray[np.int64]) -> list[Line2D]:
    total, usual = counts.sum(), 3
    return [
        _mark(kind, f"{kind.name}: {count} ({count / total:.1%})")
        for number, (kind, count) in enumerate(zip(FATES, counts, strict=True))
        if number < usual or count
    ]


def _drawn(pixels: NDArray[np.float64]) -> tuple[slice, slice]:
    """Rows and columns of an image without its white margins."""
    places = np.argwhere((pixels < 0.99).any(axis=2))
    (top, left), (bottom, right) = places.min(axis=0), places.max(axis=0)
    return slice(top, bottom + 1), slice(left, right + 1)


def _pixels(image: Path) -> NDArray[np.float64]:
    """Red, green and blue from 0 to 1 of an image that LAMMPS has drawn."""
    try:
        return np.asarray(plt.imread(image)[:, :, :3], dtype=np.float64)
    except (OSError, SyntaxError, ValueError) as error:
        raise MachineFault(f"{image}: {error}: the disk may be full") from None


@dataclass(frozen=True)
class _Marks:
    """What tells sizes and directions on a drawing of one carrier.

    Attributes:
        scene: what is drawn.
        unit: length of the scene's unit, the carrier's radius, m.
        impact: whose velocity is shown, or ``None``.
    """

    scene: _Scene
    unit: float
    impact: Impact | None = None

    def draw(self, axes: Axes, height: int, width: int) -> None:
        """A scale bar in the lower left corner, and an arrow along the velocity in the upper left one."""
        radius = self.scene.size / self.scene.width
        length = _round_length(0.28 * self.unit)
        pixels = length / self.unit * radius
        label = f"{length * 1e3:g} mm" if length >= 1e-4 else f"{length * 1e6:g} µm"
        left, low = 0.02 * width, 0.985 * height
        axes.plot([left, left + pixels], [low, low], color="black", linewidth=2.5, solid_capstyle="butt")
        axes.text(left + pixels / 2, low - 0.015 * height, label, ha="center", va="bottom", fontsize=9)
        if self.impact is None:
            return
        angle = math.radians(self.impact.angle)
        along = _projected((math.cos(angle), 0.0, -math.sin(angle)), self.scene.view)
        along *= 0.24 * radius / math.hypot(*along)
        middle = np.array([0.02 * width + 0.11 * radius, 0.02 * height + 0.11 * radius])
        arrow: dict[str, Any] = {"arrowstyle": "-|>,head_width=0.3,head_length=0.6", "linewidth": 2.0, "color": "black"}
        arrow |= {"shrinkA": 0, "shrinkB": 0}
        head, tail = middle + along / 2, middle - along / 2
        axes.annotate("", (head[0], head[1]), (tail[0], tail[1]), arrowprops=arrow)
        outline = [withStroke(linewidth=3, foreground="white")]
        words = f"{self.impact.speed:g} m/s\n{self.impact.angle:g}°"
        axes.text(left, 0.03 * height + 0.22 * radius, words, ha="left", va="top", fontsize=9, path_effects=outline)


def _round_length(most: float) -> float:
    """The longest of 1, 2 or 5 times a power of ten that is no longer, m."""
    power = 10.0 ** math.floor(math.log10(most))
    return max(part * power for part in (1, 2, 5) if part * power <= most)


def _projected(direction: tuple[float, float, float], view: tuple[float, float]) -> NDArray[np.float64]:
    """A direction as seen by a camera (2,), to the right and down; z is up."""
    polar, azimuth = map(math.radians, view)
    camera = np.array([math.sin(polar) * math.cos(azimuth), math.sin(polar) * math.sin(azimuth), math.cos(polar)])
    right = np.array([-math.sin(azimuth), math.cos(azimuth), 0.0])
    up = np.cross(camera, right)
    return np.array([right @ direction, -(up @ direction)])


#: of PNG files; the drawings are as wide as that makes them
DPI = 200


def _compose(image: Path, handles: list[Line2D], path: Path, marks: _Marks) -> None:
    """The drawing without its margins, with its marks, above a legend if there is one."""
    pixels = _pixels(image)
    pixels = pixels[_drawn(pixels)]
    height, width = pixels.shape[0] / DPI, pixels.shape[1] / DPI
    margin, foot = 0.1, 0.22 * len(handles) + 0.1 * bool(handles)
    total = (width + 2 * margin, height + 2 * margin + foot)
    figure = plt.figure(figsize=total)
    axes = figure.add_axes((margin / total[0], (margin + foot) / total[1], width / total[0], height / total[1]))
    axes.imshow(pixels, interpolation="lanczos")
    axes.axis("off")
    marks.draw(axes, *pixels.shape[:2])
    if handles:
        figure.legend(handles=handles, loc="lower center", frameon=False, fontsize=9, handletextpad=0.3)
    with replace_file(path) as part:
        figure.savefig(part, format="png", dpi=DPI)
    plt.close(figure)


#: width of a panel of four, the space between and around them, and below each for its words, inches
_PANEL, _GAP, _FOOT = 3.6, 0.12, 0.35


def _compose_moments(frames: list[Frame], images: list[Path], result: Result, path: Path) -> None:
    """Two rows of two panels, cut alike; below each its time and how many grains are on and off, then the legend."""
    drawings = [_pixels(image) for image in images]
    rows, columns = _drawn(np.minimum.reduce(drawings))
    height = _PANEL * (rows.stop - rows.start) / (columns.stop - columns.start)
    total = (2 * _PANEL + 3 * _GAP, 2 * (height + _FOOT + _GAP) + 0.4)
    figure = plt.figure(figsize=total)
    for index, (frame, pixels) in enumerate(zip(frames, drawings, strict=True)):
        left = _GAP + (index % 2) * (_PANEL + _GAP)
        bottom = total[1] - (1 + index // 2) * (height + _GAP) - (index // 2) * _FOOT
        axes = figure.add_axes((left / total[0], bottom / total[1], _PANEL / total[0], height / total[1]))
        axes.imshow(pixels, interpolation="lanczos")
        axes.set_xlim(columns.start - 0.5, columns.stop - 0.5)
        axes.set_ylim(rows.stop - 0.5, rows.start - 0.5)
        axes.axis("off")
        if index == 0:
            _draw_velocity(axes, frame, result)
            _draw_length(axes, frame, rows, columns)
        tied = int(np.count_nonzero(frame.tied))
        words = (
            f"({'abcd'[index]}) {frame.step * result.timestep * 1e6:.1f} µs: {tied} tied, "
            f"{result.grains - tied} detached ({1 - tied / result.grains:.1%})"
        )
        place = ((left + _PANEL / 2) / total[0], (bottom - 0.06) / total[1])
        figure.text(*place, words, ha="center", va="top", fontsize=10.5)
    handles = [_mark(kind, kind.name) for kind in STATES]
    figure.legend(handles=handles, loc="lower center", ncols=2, frameon=False, fontsize=10.5, handletextpad=0.3)
    with replace_file(path) as part:
        _save_small(figure, part, MOMENT_SIZE / _PANEL)
    plt.close(figure)


def _draw_length(axes: Axes, frame: Frame, rows: slice, columns: slice) -> None:
    """A scale bar in the upper left corner, where no grain flies before the impact."""
    scene = _side_scene(frame)
    length = _round_length(0.6 * frame.carrier_radius)
    pixels = length / frame.carrier_radius * scene.size / scene.width
    left, top = columns.start + 0.03 * scene.size, rows.start + 0.05 * scene.size
    axes.plot([left, left + pixels], [top, top], color="black", linewidth=2.5, solid_capstyle="butt")
    label = f"{length * 1e3:g} mm" if length >= 1e-4 else f"{length * 1e6:g} µm"
    axes.text(left + pixels / 2, top - 0.01 * scene.size, label, ha="center", va="bottom", fontsize=9)


def _draw_velocity(axes: Axes, frame: Frame, result: Result) -> None:
    """An arrow on the carrier along its velocity, with speed and angle; pixels count downwards."""
    scene = _side_scene(frame)
    pixels = scene.size / scene.width
    offset = frame.carrier / frame.carrier_radius - scene.box.mean(axis=0)
    middle = np.array([scene.size / 2 + offset[0] * pixels, scene.size / 2 - offset[2] * pixels])
    angle = math.radians(result.angle)
    half = 0.3 * pixels * np.array([math.cos(angle), math.sin(angle)])
    arrow = {"arrowstyle": "-|>,head_width=0.35,head_length=0.7", "linewidth": 2.2, "color": "black"}
    outline = [withStroke(linewidth=4.5, foreground="white")]
    head, tail = middle + half, middle - half
    axes.annotate("", (head[0], head[1]), (tail[0], tail[1]), arrowprops={**arrow, "path_effects": outline})
    axes.text(
        tail[0],
        tail[1] - 0.04 * pixels,
        f"{result.speed:g} m/s, {result.angle:g}°",
        ha="center",
        va="bottom",
        fontsize=11,
        path_effects=[withStroke(linewidth=3, foreground="white")],
    )


def _save_small(figure: Figure, path: Path, dpi: float) -> None:
    """Save as PNG with a table of 256 colours, a quarter of the size; this choice of them keeps the pale grains."""
    with BytesIO() as buffer:
        figure.savefig(buffer, format="png", dpi=dpi)
        image = Image.open(buffer).convert("RGB")
        image.quantize(256, Image.Quantize.MAXCOVERAGE, dither=Image.Dither.NONE).save(
            path, format="PNG", optimize=True
        )
