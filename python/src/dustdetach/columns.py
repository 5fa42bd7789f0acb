"""The columns of every output array of ``fix dust/detach`` and ``compute dust/grain``, by name.

Counted from 0, as LAMMPS' library interface does. The names are those of ``src/detach_columns.h``; a test holds both
against each other.
"""

from __future__ import annotations

from enum import IntEnum, unique


@unique
class DetachVector(IntEnum):
    """The global vector: sums over all carriers."""

    INITIAL_GRAINS = 0
    ATTACHED_GRAINS = 1
    NORMAL = 2
    TANGENTIAL = 3
    SOUTH = 4
    NORTH = 5
    DETACHED_MASS = 6
    INITIAL_MASS = 7
    COLLISIONS = 8
    MET_SLIDING = 9
    MET_ROLLING = 10
    SLIDING = 11
    ROLLING = 12
    NO_ROOM = 13
    KNOCKED = 14
    FOLLOWED = 15


@unique
class DetachAtom(IntEnum):
    """The per-atom array."""

    ATTACHED = 0
    MASS = 1
    WINDOW_MASS = 2
    CONTACT_TIME = 3
    PEAK_ACCELERATION = 4
    QW = 5
    QX = 6
    QY = 7
    QZ = 8


@unique
class DetachRow(IntEnum):
    """The local array: a row for each detachment."""

    STEP = 0
    CARRIER = 1
    GRAIN = 2
    MODE = 3
    DIAMETER = 4
    X = 5
    Y = 6
    Z = 7
    VX = 8
    VY = 9
    VZ = 10
    TEXTURE = 11


@unique
class GrainRow(IntEnum):
    """The local array of ``compute dust/grain``: a row for each grain that is still attached."""

    CARRIER = 0
    GRAIN = 1
    DIAMETER = 2
    X = 3
    Y = 4
    Z = 5
    LOST = 6
    TEXTURE = 7


@unique
class Mode(IntEnum):
    """How a grain left, in `DetachRow.MODE`; 0 for one that is still there."""

    ATTACHED = 0
    NORMAL = 1
    TANGENTIAL = 2
    SLIDING = 3
    ROLLING = 4
    KNOCKED = 5
