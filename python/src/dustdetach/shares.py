"""Shares by mass of an impact with grains of many sizes: the fix counts grains by hemisphere and criterion."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from .columns import DetachRow, Mode
from .errors import InvalidInput, shown
from .files import as_path, read_text
from .texture import read_texture


def event_lines(path: Path) -> Iterator[str]:
    """The rows of the events that LAMMPS' dump local wrote."""
    rows = False
    for line in read_text(path).splitlines():
        if line.startswith("ITEM:"):
            rows = line.startswith("ITEM: ENTRIES")
        elif rows:
            yield line


def read_fates(path: str | Path, grains: int) -> NDArray[np.int64]:
    """What became of each grain (0 attached, else the mode) from the events that LAMMPS' dump local wrote.

    Raises:
        InvalidInput: no such file, or it is cut, or an event of a grain that the texture does not have.
    """
    path = as_path(path, "events")
    fates = np.zeros(grains, dtype=np.int64)
    for line in event_lines(path):
        words = line.split()
        try:
            grain, mode = int(float(words[DetachRow.GRAIN])), Mode(int(float(words[DetachRow.MODE])))
        except (ValueError, IndexError, OverflowError):
            raise InvalidInput(f"{path}: {shown(line)} is no event: the file is cut, or another one") from None
        if not 1 <= grain <= grains:
            raise InvalidInput(f"{path}: an event of grain {grain}, but the texture has {grains}")
        fates[grain - 1] = mode
    return fates


def mass_shares(events: Path, change: Sequence[float], texture: Path) -> dict[str, float]:
    """The detached mass of each hemisphere and criterion over the initial one.

    Args:
        events: what LAMMPS wrote of the impact.
        change: v_rebound - v_contact (3,), m/s.
        texture: the file that the fix wrote the grains to.
    """
    grains = read_texture(texture)
    fates = read_fates(events, len(grains.diameters))
    masses = grains.diameters**3 / np.sum(grains.diameters**3)
    north = grains.directions @ np.asarray(change) > 0
    off = fates != Mode.ATTACHED
    return {
        "north": float(np.sum(masses[off & north])),
        "south": float(np.sum(masses[off & ~north])),
        "normal": float(np.sum(masses[fates == Mode.NORMAL])),
        "tangential_mode": float(np.sum(masses[fates == Mode.TANGENTIAL])),
        "knocked": float(np.sum(masses[fates == Mode.KNOCKED])),
    }
