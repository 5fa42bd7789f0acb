"""Runs one impact: the deck in.impact on a LAMMPS instance in this process."""

from __future__ import annotations

import math
import time
from dataclasses import asdict
from pathlib import Path
from typing import Any

from .impact import Impact
from .places import find_deck
from .result import Result
from .session import lammps_session

DECK = "in.impact"

# parameters that the deck takes as variables of the same name
_VARIABLES = (
    "speed",
    "angle",
    "restitution",
    "coverage",
    "bare",
    "grain_diameter",
    "carrier_diameter",
    "hamaker",
    "z0",
    "friction",
    "wall_friction",
    "seed",
    "tangential",
    "timestep",
)

# the outputs of fix dust/detach that are read here, counted from 0 as the library interface does
_INITIAL, _NORMAL, _TANGENTIAL, _SOUTH, _NORTH, _COLLISIONS = 0, 2, 3, 4, 5, 8
_CONTACT_TIME, _PEAK_ACCELERATION = 3, 4


def run(impact: Impact, *, comm: Any = None, events: Path | None = None) -> Result:
    """Run one impact with the detachment functions.

    Args:
        impact: the parameters.
        comm: an mpi4py communicator for LAMMPS; all ranks of the process without one.
        events: a file for every detachment of the run, as LAMMPS' dump local writes it; see `pictures`.

    Returns:
        Dispersion ratio with its shares, and the collision's time, peak acceleration and restitution.

    Raises:
        InvalidInput: what only LAMMPS can judge, for instance a coverage that cannot be placed.
        LammpsMissing: LAMMPS, the plugin or the deck is not there.
    """
    started = time.perf_counter()
    parameters = asdict(impact)
    variables = {name: parameters[name] for name in _VARIABLES}
    if events is not None:
        # quoted for the deck's command in which the name ends up
        variables["events"] = f'"{events}"'
    deck = find_deck(DECK)
    with lammps_session(variables, comm) as lmp:
        lmp.file(str(deck))
        fix = _FixOutput(lmp)
        grains = fix.vector(_INITIAL)
        finished = fix.vector(_COLLISIONS) > 0
        contact_time, peak_acceleration = fix.carrier(_CONTACT_TIME), fix.carrier(_PEAK_ACCELERATION)
        approach = impact.speed * math.sin(math.radians(impact.angle))
        return Result(
            **parameters,
            grains=int(grains),
            dispersion_ratio=fix.scalar(),
            north=fix.vector(_NORTH) / grains,
            south=fix.vector(_SOUTH) / grains,
            normal=fix.vector(_NORMAL) / grains,
            tangential_mode=fix.vector(_TANGENTIAL) / grains,
            contact_time=contact_time,
            peak_acceleration=peak_acceleration,
            restitution_realised=float(lmp.numpy.extract_atom("v")[0, 2]) / approach,
            steps=int(lmp.extract_global("ntimestep")),
            end="rebound" if finished else "step limit",
            loop_seconds=float((lmp.last_thermo() or {}).get("CPU", 0.0)),
            wall_seconds=time.perf_counter() - started,
            lammps_version=lmp.version(),
        )


class _FixOutput:
    """Reads the fix ``dust`` of a deck with one carrier."""

    def __init__(self, lmp: Any) -> None:
        from lammps import constants

        self._lmp = lmp
        self._global = constants.LMP_STYLE_GLOBAL
        self._types = constants

    def scalar(self) -> float:
        return self._lmp.extract_fix("dust", self._global, self._types.LMP_TYPE_SCALAR)

    def vector(self, index: int) -> float:
        return self._lmp.extract_fix("dust", self._global, self._types.LMP_TYPE_VECTOR, nrow=index)

    def carrier(self, column: int) -> float:
        array = self._lmp.numpy.extract_fix("dust", self._types.LMP_STYLE_ATOM, self._types.LMP_TYPE_ARRAY)
        return float(array[0, column])
