"""Frames of a resolved impact: the carrier and its grains at one time, as LAMMPS' dump custom wrote them."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import TextIO

import numpy as np
from numpy.typing import NDArray

from .errors import InvalidInput, shortened
from .files import as_path, check_file, file_error

#: what a frame must hold of each atom, and the type of the carrier
COLUMNS = ("id", "type", "x", "y", "z", "radius", "c_tied")
CARRIER_TYPE = 1


@dataclass(frozen=True)
class Frame:
    """A carrier and the grains that are still in the box.

    Attributes:
        step: the time step.
        box: lower and upper corner of the box (2, 3), m.
        carrier: centre of the carrier (3,), m.
        carrier_radius: m.
        ids: of the grains (N,), ascending; a grain keeps its own.
        centres: of the grains (N, 3), m.
        radii: of the grains (N,), m.
        tied: whether a chain of necks ties the grain to the carrier (N,).
    """

    step: int
    box: NDArray[np.float64]
    carrier: NDArray[np.float64]
    carrier_radius: float
    ids: NDArray[np.int64]
    centres: NDArray[np.float64]
    radii: NDArray[np.float64]
    tied: NDArray[np.bool_]


def frame_sizes(path: str | Path) -> dict[int, int]:
    """Number of atoms, the carrier among them, by the step of each frame in a file.

    Raises:
        InvalidInput: no such file, or no frame in it, or it is cut.
    """
    path = as_path(path, "frames")
    sizes: dict[int, int] = {}
    with _open(path) as stream:
        for line in stream:
            if line.startswith("ITEM: TIMESTEP"):
                try:
                    step = int(next(stream))
                    next(stream)
                    sizes[step] = int(next(stream))
                except (ValueError, StopIteration):
                    raise InvalidInput(f"{path}: the file is cut, or holds no frames") from None
    if not sizes:
        raise InvalidInput(f"{path}: the file is cut, or holds no frames")
    return sizes


@contextmanager
def _open(path: Path) -> Iterator[TextIO]:
    check_file(path)
    try:
        with open(path, encoding="utf-8", errors="replace") as stream:
            yield stream
    except OSError as error:
        raise file_error(path, error) from None


def read_frames(path: str | Path, steps: list[int]) -> list[Frame]:
    """The frames of some steps, in the order of ``steps``.

    Necks form with the first contact forces, after the frame of step 0 is written: its grains are all tied.

    Raises:
        InvalidInput: no frame of one of the steps, or a frame that is cut or lacks a column.
    """
    path = as_path(path, "frames")
    found = {}
    with _open(path) as stream:
        for line in stream:
            if line.startswith("ITEM: TIMESTEP"):
                number = next(stream, "").strip()
                try:
                    step = int(number)
                    if step in steps:
                        found[step] = _read_frame(stream, step)
                except (ValueError, IndexError, StopIteration) as error:
                    reason = str(error).splitlines() or ["the file is cut"]
                    raise InvalidInput(f"{path}: frame of step {shortened(number, 20)}: {reason[0]}") from None
    for step in steps:
        if step not in found:
            raise InvalidInput(f"{path}: no frame of step {step}")
    return [found[step] for step in steps]


def _read_frame(stream: Iterator[str], step: int) -> Frame:
    next(stream)
    count = int(next(stream))
    next(stream)
    box = np.array([next(stream).split() for _ in range(3)], dtype=float).T
    names = next(stream).split()[2:]
    missing = [name for name in COLUMNS if name not in names]
    if missing:
        raise ValueError(f"no column {missing[0]}")
    rows = np.array([next(stream).split() for _ in range(count)], dtype=float)
    rows = rows[rows[:, names.index("id")].argsort()]
    column = {name: rows[:, names.index(name)] for name in COLUMNS}
    places = np.column_stack([column[name] for name in "xyz"])
    carriers = column["type"] == CARRIER_TYPE
    if np.count_nonzero(carriers) != 1:
        raise ValueError(f"{np.count_nonzero(carriers)} carriers where one is expected")
    grains = ~carriers
    return Frame(
        step,
        box,
        places[carriers][0],
        float(column["radius"][carriers][0]),
        column["id"][grains].astype(np.int64),
        places[grains],
        column["radius"][grains],
        (column["c_tied"][grains] > 0) | (step == 0),
    )
