"""Runs one impact: the deck of its method on a LAMMPS instance in this process."""

from __future__ import annotations

import math
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .columns import DetachAtom, DetachVector
from .errors import InvalidInput, MachineFault
from .files import as_path, replace_file, scratch_folder, writable_file
from .impact import Impact, as_impact
from .places import find_deck, lammps_module
from .result import Result
from .session import lammps_file, lammps_session
from .shares import mass_shares
from .texture import BYTES_A_GRAIN

#: the deck of each method
DECKS = {"functions": "in.impact", "resolved": "in.impact.resolved"}

Watch = Callable[[float], None]


def run(
    impact: Impact,
    *,
    comm: Any = None,
    events: str | Path | None = None,
    frames: str | Path | None = None,
    motion: str | Path | None = None,
    watch: Watch | None = None,
) -> Result:
    """Run one impact with the method it names.

    Args:
        impact: the parameters.
        comm: an mpi4py communicator for LAMMPS; all ranks of the process without one.
        events: a file for every detachment, as LAMMPS' dump local writes it (method ``functions``); see `pictures`.
        frames: a file for all grains every half microsecond, as LAMMPS' dump custom writes it (method ``resolved``).
        motion: a file for the carrier's motion, a line a step, as LAMMPS' dump custom writes it (method
            ``functions``); see `response`.
        watch: called about once a second, from another thread, with the time that has been simulated, s.

    Returns:
        Dispersion ratio with its shares, and the collision's time, peak acceleration and restitution.

    Raises:
        InvalidInput: ``events``, ``frames`` or ``motion`` that the method does not write or that can be no file, or
            what only LAMMPS can judge, for instance a coverage that cannot be placed.
        MachineFault: the disk is full, or fails.
        LammpsMissing: LAMMPS, the plugin or the deck is not there.
        LammpsBusy: another thread of this process is at it: LAMMPS runs one at a time in a process.
    """
    impact = as_impact(impact, "run")
    for name, file in (("events", events), ("motion", motion)):
        if file is not None and impact.method != "functions":
            raise InvalidInput(f"{name}: a resolved run has none; allowed: with method functions")
    if frames is not None and impact.method != "resolved":
        raise InvalidInput("frames: without grains as atoms there are none; allowed: with method resolved")
    started = time.perf_counter()
    variables = impact.deck_variables()
    deck = find_deck(DECKS[impact.method])
    sizes = impact.method == "functions" and impact.distribution != "none"
    with ExitStack() as outer:
        if sizes:
            scratch = outer.enter_context(scratch_folder(2 * BYTES_A_GRAIN * impact.grains))
            events = events or scratch / "events"
        with ExitStack() as stack:
            for name, variable, file in _files(events, frames, motion):
                if file is not None:
                    variables[variable] = stack.enter_context(_dump(file, name))
            lmp = stack.enter_context(lammps_session(variables, comm))
            with _watched(lmp, watch):
                lmp.file(str(deck))
            read = _read_resolved if impact.method == "resolved" else _read_functions
            found = read(lmp, impact)
            found |= {"steps": int(lmp.extract_global("ntimestep")), "lammps_version": lmp.version()}
            change = lmp.numpy.extract_atom("v")[0] - _velocity(impact) if sizes else None
        if change is not None and events is not None:
            found |= mass_shares(impact, as_path(events, "events"), change, scratch / "texture")
        return Result(**impact.values(), **found, wall_seconds=time.perf_counter() - started)  # type: ignore[arg-type]


def _files(
    events: str | Path | None, frames: str | Path | None, motion: str | Path | None
) -> tuple[tuple[str, str, str | Path | None], ...]:
    """What messages call each file, the deck's variable of it, and its name."""
    return (("events", "events", events), ("frames", "dump", frames), ("motion", "motion", motion))


def _velocity(impact: Impact) -> NDArray[np.float64]:
    """Of the carrier before the impact (3,), m/s."""
    angle = math.radians(impact.angle)
    return impact.speed * np.array([math.cos(angle), 0.0, -math.sin(angle)])


@contextmanager
def _dump(file: str | Path, name: str) -> Iterator[str]:
    """A file of text that LAMMPS' command dump writes, complete or not at all, as a word of that command."""
    path = writable_file(as_path(file, name), name)
    if "*" in str(path) or "%" in str(path) or path.suffix in (".bin", ".gz", ".zst"):
        raise InvalidInput(
            f"{name}: {path}: LAMMPS writes no single file of text by this name; allowed: without * and %, and not "
            "ending in .bin, .gz or .zst"
        )
    with replace_file(path) as part:
        try:
            yield lammps_file(part, name)
        except MachineFault as error:
            # LAMMPS says what it was writing, but not where
            raise MachineFault(f"{path}: {error}" if "dump" in str(error) else str(error)) from None


@contextmanager
def _watched(lmp: Any, watch: Watch | None) -> Iterator[None]:
    """Tell ``watch`` how far the run is while LAMMPS holds this thread."""
    if watch is None:
        yield
        return
    over = threading.Event()

    def tell() -> None:
        while not over.wait(1.0):
            watch(lmp.extract_global("ntimestep") * lmp.extract_global("dt"))

    thread = threading.Thread(target=tell, daemon=True)
    thread.start()
    try:
        yield
    finally:
        over.set()
        thread.join()


def _read_functions(lmp: Any, impact: Impact) -> dict[str, Any]:
    fix = _FixOutput(lmp)
    grains = fix.total(DetachVector.INITIAL_GRAINS)
    return {
        "grains": int(grains),
        "dispersion_ratio": fix.dispersion_ratio(),
        "north": fix.total(DetachVector.NORTH) / grains,
        "south": fix.total(DetachVector.SOUTH) / grains,
        "normal": fix.total(DetachVector.NORMAL) / grains,
        "tangential_mode": fix.total(DetachVector.TANGENTIAL) / grains,
        "contact_time": fix.of_carrier(DetachAtom.CONTACT_TIME),
        "peak_acceleration": fix.of_carrier(DetachAtom.PEAK_ACCELERATION),
        "restitution_realised": float(lmp.numpy.extract_atom("v")[0, 2])
        / (impact.speed * math.sin(math.radians(impact.angle))),
        "end": "rebound" if fix.total(DetachVector.COLLISIONS) > 0 else "step limit",
        "loop_seconds": float((lmp.last_thermo() or {}).get("CPU", 0.0)),
    }


def _read_resolved(lmp: Any, _: Impact) -> dict[str, Any]:
    names = ("dispersion_ratio", "north", "south", "contact_time", "peak_acceleration", "restitution_realised")
    return {
        **{name: float(lmp.extract_variable(name)) for name in (*names, "loop_seconds")},
        "grains": int(lmp.extract_variable("grains")),
        "normal": None,
        "tangential_mode": None,
        "end": lmp.extract_variable("end"),
    }


class _FixOutput:
    """Reads the fix ``dust`` of a deck with one carrier."""

    def __init__(self, lmp: Any) -> None:
        self._lmp = lmp
        self._constants: Any = lammps_module()

    def dispersion_ratio(self) -> float:
        return float(self._global(self._constants.LMP_TYPE_SCALAR))

    def total(self, column: DetachVector) -> float:
        return float(self._global(self._constants.LMP_TYPE_VECTOR, nrow=column))

    def of_carrier(self, column: DetachAtom) -> float:
        table = self._lmp.numpy.extract_fix("dust", self._constants.LMP_STYLE_ATOM, self._constants.LMP_TYPE_ARRAY)
        return float(table[0, column])

    def _global(self, kind: int, **place: int) -> Any:
        return self._lmp.extract_fix("dust", self._constants.LMP_STYLE_GLOBAL, kind, **place)
