"""Textures: the grains that adhere to a carrier, as directions and diameters, and the text file they are kept in.

The file, in the units of the deck that reads it (SI in the decks of this project)::

    # dust texture 1
    carrier_diameter 0.0015
    bare 0.33 0 0 -1
    grains 4500
    0.1 -0.7 0.70710678 2e-05
    ...
    end

``bare`` is the half-angle of the bare cap (rad) and its axis. Each grain has a line with the unit vector from the
carrier's centre to the grain's and the grain's diameter. Lines that start with # are comments. The last line is
``end``, so that a file cut in the middle is noticed.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from .errors import InvalidInput, MachineFault, shown
from .files import as_path, read_text, replace_file, scratch_folder, writable_file
from .impact import Impact, as_impact, finite_number
from .session import lammps_file, lammps_session

HEADER = "# dust texture 1"

#: how far a unit vector's length, or a pair's distance relative to its radii, may be off by rounding
ROUNDING = 1e-9


@dataclass(frozen=True)
class Texture:
    """The grains of one carrier.

    Attributes:
        carrier_diameter: m.
        bare: half-angle of the bare cap, rad.
        bare_axis: unit vector (3,) to the middle of the bare cap.
        directions: unit vectors (N, 3) from the carrier's centre to the grains'.
        diameters: of the grains (N,), m.
        lines: line of each grain in its file (N,), for messages.
    """

    carrier_diameter: float
    bare: float
    bare_axis: NDArray[np.float64]
    directions: NDArray[np.float64]
    diameters: NDArray[np.float64]
    lines: NDArray[np.int64]

    @property
    def centres(self) -> NDArray[np.float64]:
        """Centres of the grains (N, 3) with the carrier's at the origin, each grain touching the carrier, m."""
        return self.directions * ((self.carrier_diameter + self.diameters) / 2)[:, None]

    @property
    def coverage(self) -> float:
        """X0: summed cross-section of the grains over the carrier's surface."""
        return float(np.sum(self.diameters**2) / (4 * self.carrier_diameter**2))


#: in a texture file
BYTES_A_GRAIN = 100

DISTRIBUTIONS = ("lognormal", "rrsb")


@dataclass(frozen=True)
class Distribution:
    """Sizes of grains by volume, cut at the volume fractions 0.01 and 0.99.

    Attributes:
        kind: ``lognormal`` or ``rrsb`` (Rosin-Rammler).
        median: x_50,3, m, above 0.
        spread: geometric standard deviation, above 1, or the exponent of ``rrsb``, above 0.

    Raises:
        InvalidInput: a value outside its range.
    """

    kind: str
    median: float
    spread: float

    def __post_init__(self) -> None:
        if self.kind not in DISTRIBUTIONS:
            allowed = ", ".join(DISTRIBUTIONS)
            raise InvalidInput(f"--distribution: unknown choice {shown(self.kind)}; allowed: {allowed}")
        least = 1.0 if self.kind == "lognormal" else 0.0
        for name, value, low in (("median diameter", self.median, 0.0), ("spread", self.spread, least)):
            if not finite_number("distribution", value) > low:
                raise InvalidInput(f"--distribution: {name} {value:g} is out of range; allowed: above {low:g}")


def make_texture(impact: Impact, path: str | Path, distribution: Distribution | None = None) -> None:
    """Make the texture of an impact (its coverage, bare cap, diameters and seed) and write it to a file.

    The grains are placed by ``fix dust/detach``, so that an impact with the same parameters has the same ones.

    Args:
        impact: the parameters.
        path: the file.
        distribution: sizes of the grains, in place of the impact's grain diameter.

    Raises:
        InvalidInput: the coverage cannot be placed, or there can be no file of this name.
        MachineFault: the disk is full.
    """
    impact = as_impact(impact, "make_texture")
    path = writable_file(as_path(path, "--out"), "--out")
    sizes = f" distribution {distribution.kind} {distribution.median!r} {distribution.spread!r}" if distribution else ""
    # LAMMPS takes no quote in a name, so it writes to another place
    with scratch_folder(BYTES_A_GRAIN * impact.grains) as folder:
        grains = folder / "texture"
        try:
            with lammps_session() as lmp:
                lmp.commands_list(_placement(impact, sizes, grains))
        except InvalidInput as error:
            if str(grains) in str(error):
                raise MachineFault(str(error)) from None
            raise
        text = read_text(grains)
    with replace_file(path) as part:
        part.write_text(text)


def _placement(impact: Impact, sizes: str, grains: Path) -> list[str]:
    """The commands that place the grains of an impact and write them to a file."""
    side = f"-{impact.carrier_diameter!r} {impact.carrier_diameter!r}"
    return [
        "units si",
        "atom_style sphere",
        f"region box block {side} {side} {side}",
        "create_box 1 box",
        "create_atoms 1 single 0 0 0",
        f"set atom 1 diameter {impact.carrier_diameter!r}",
        f"fix dust all dust/detach texture monolayer {impact.grain_diameter!r} coverage {impact.coverage!r} "
        f"seed {impact.seed} bare {impact.bare!r}{sizes} write {lammps_file(grains, 'TMPDIR')}",
    ]


def read_texture(path: Path) -> Texture:
    """Read a texture file.

    Raises:
        InvalidInput: no such file, or a line that is not what the format asks for; the message names the line.
    """
    try:
        lines = path.read_text().splitlines()
    except OSError as error:
        raise InvalidInput(f"{path}: {error.strerror or error}") from None
    except UnicodeDecodeError:
        raise InvalidInput(f"{path}: not a text file") from None
    try:
        return _parse(lines)
    except _BadLine as error:
        raise InvalidInput(f"{path}: {error}") from None


def check_texture(texture: Texture) -> None:
    """Check what `read_texture` cannot see in one line.

    Raises:
        InvalidInput: a direction that is not a unit vector, a grain wider than its carrier, a grain centred in the bare
            cap, or two grains that overlap; the message names the lines.
    """
    lengths = np.linalg.norm(texture.directions, axis=1)
    for index in np.flatnonzero(np.abs(lengths - 1) > ROUNDING)[:1]:
        raise InvalidInput(f"line {texture.lines[index]}: direction of length {lengths[index]:.9g}, not a unit vector")
    for index in np.flatnonzero(texture.diameters > texture.carrier_diameter)[:1]:
        raise InvalidInput(
            f"line {texture.lines[index]}: grain of {texture.diameters[index]:g} m is larger than the carrier of "
            f"{texture.carrier_diameter:g} m"
        )
    along = texture.directions @ texture.bare_axis
    for index in np.flatnonzero(along > math.cos(texture.bare) + ROUNDING)[:1]:
        angle = math.acos(min(1.0, along[index]))
        raise InvalidInput(
            f"line {texture.lines[index]}: grain {angle:.4g} rad from the axis of the bare cap of {texture.bare:g} rad"
        )
    overlap = find_overlap(texture)
    if overlap is not None:
        first, second, gap = overlap
        raise InvalidInput(f"lines {first} and {second}: grains overlap by {-gap:.3g} m")


def find_overlap(texture: Texture) -> tuple[int, int, float] | None:
    """The lines of two grains that overlap the most, and their gap (negative, m); ``None`` if no two do.

    Grains are ordered by height, so that only those of similar height need comparing.
    """
    order = np.argsort(texture.centres[:, 2], kind="stable")
    centres, radii = texture.centres[order], texture.diameters[order] / 2
    widest = 2 * radii.max(initial=0.0)
    worst = None
    for shift in range(1, len(centres)):
        if np.min(centres[shift:, 2] - centres[:-shift, 2]) > widest:
            break
        reach = radii[shift:] + radii[:-shift]
        gaps = np.linalg.norm(centres[shift:] - centres[:-shift], axis=1) - reach
        index = int(np.argmin(gaps / reach))
        if gaps[index] < -ROUNDING * reach[index] and (worst is None or gaps[index] < worst[2]):
            pair = sorted(int(texture.lines[order[index + side]]) for side in (0, shift))
            worst = (pair[0], pair[1], float(gaps[index]))
    return worst


class _BadLine(ValueError):
    pass


def _parse(lines: list[str]) -> Texture:
    if not lines or lines[0].strip() != HEADER:
        raise _BadLine(f"line 1: not a texture file: its first line must be '{HEADER}'")
    content = [(number, line.split()) for number, line in enumerate(lines, 1) if line.strip() and line[0] != "#"]
    entries = iter(content)

    (diameter,) = _keyword(entries, "carrier_diameter", 1)
    if not diameter > 0:
        raise _BadLine(f"carrier_diameter: {diameter:g} is not above 0")
    bare, *axis = _keyword(entries, "bare", 4)
    if not 0 <= bare < math.pi:
        raise _BadLine(f"bare: {bare:g} rad is out of range; allowed: 0 to below pi")
    length = math.hypot(*axis)
    if not length > 0:
        raise _BadLine("bare: its axis has no length")
    (count,) = _keyword(entries, "grains", 1)
    if not (count >= 1 and count == int(count)):
        raise _BadLine(f"grains: {count:g} is not a positive whole number")

    grains, numbers = [], []
    for number, words in entries:
        if words == ["end"]:
            break
        grains.append(_numbers(number, words, 4))
        numbers.append(number)
        if not grains[-1][3] > 0:
            raise _BadLine(f"line {number}: grain diameter {grains[-1][3]:g} is not above 0")
    else:
        raise _BadLine(f"line {len(lines)}: the file is cut: no line 'end'")
    for number, words in entries:
        raise _BadLine(f"line {number}: '{words[0]}' after the end")
    if len(grains) != count:
        raise _BadLine(f"{len(grains)} grains, but the line 'grains' says {int(count)}")
    table = np.array(grains)
    return Texture(diameter, bare, np.array(axis) / length, table[:, :3], table[:, 3], np.array(numbers))


def _keyword(entries: Iterator[tuple[int, list[str]]], keyword: str, count: int) -> list[float]:
    entry = next(entries, None)
    if entry is None:
        raise _BadLine(f"the file is cut: no line '{keyword}'")
    number, words = entry
    if words[0] != keyword:
        raise _BadLine(f"line {number}: '{words[0]}' where '{keyword}' is expected")
    return _numbers(number, words[1:], count)


def _numbers(number: int, words: list[str], count: int) -> list[float]:
    if len(words) != count:
        raise _BadLine(f"line {number}: {len(words)} numbers where {count} are expected")
    try:
        values = [float(word) for word in words]
    except ValueError as error:
        raise _BadLine(
            f"line {number}: {str(error).replace('could not convert string to float: ', 'not a number: ')}"
        ) from None
    if not all(map(math.isfinite, values)):
        raise _BadLine(f"line {number}: a number that is not finite")
    return values
