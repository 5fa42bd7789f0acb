"""Runs impacts: the deck of their method on a LAMMPS instance in this process."""

from __future__ import annotations

import math
import re
import threading
import time
from collections.abc import Callable, Iterator, Mapping
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass
from functools import cache, cached_property
from pathlib import Path
from typing import Any

from .columns import DetachAtom, DetachVector
from .errors import InvalidInput, MachineFault
from .files import as_path, read_text, replace_file, scratch_folder, writable_file
from .impact import Impact, as_impact
from .places import find_deck, lammps_module
from .result import Result
from .session import lammps_file, lammps_session

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
    with Bench(comm) as bench:
        return bench.run(impact, events=events, frames=frames, motion=motion, watch=watch)


class Bench:
    """One impact after another, in one LAMMPS instance where that is possible; a context that closes it at the end.

    The deck of method ``functions`` has a line ``label impact``: what stands above it is run once, for a carrier, and
    what stands below for each impact. An impact gives the same numbers wherever it comes in the row.

    Args:
        comm: an mpi4py communicator for LAMMPS; all ranks of the process without one.
    """

    def __init__(self, comm: Any = None) -> None:
        self._comm = comm
        self._opened = ExitStack()
        self._at_hand: _AtHand | None = None

    def __enter__(self) -> Bench:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def close(self) -> None:
        """Close LAMMPS if it is open: another one may be opened then."""
        self._at_hand = None
        self._opened.close()

    def run(
        self,
        impact: Impact,
        *,
        events: str | Path | None = None,
        frames: str | Path | None = None,
        motion: str | Path | None = None,
        watch: Watch | None = None,
    ) -> Result:
        """Run one impact; the arguments are those of `dustdetach.run`."""
        started = time.perf_counter()
        sizes = impact.method == "functions" and impact.distribution != "none"
        with ExitStack() as outer:
            extra = {}
            if sizes:
                # shares by mass need arrays, and numpy takes longer to import than all the rest
                from .shares import mass_shares
                from .texture import BYTES_A_GRAIN

                scratch = outer.enter_context(scratch_folder(2 * BYTES_A_GRAIN * impact.grains))
                events = events or scratch / "events"
                extra["write"] = lammps_file(scratch / "texture", "TMPDIR")
            with ExitStack() as stack:
                for name, variable, file in (
                    ("events", "events", events),
                    ("frames", "dump", frames),
                    ("motion", "motion", motion),
                ):
                    if file is not None:
                        extra[variable] = stack.enter_context(_dump(file, name))
                found, velocity = self._run(impact, extra, watch)
            if sizes and events is not None:
                change = [after - before for after, before in zip(velocity, _velocity(impact), strict=True)]
                found |= mass_shares(as_path(events, "events"), change, scratch / "texture")
        return Result(**impact.values(), **found, wall_seconds=time.perf_counter() - started)  # type: ignore[arg-type]

    def _run(
        self, impact: Impact, extra: Mapping[str, str], watch: Watch | None
    ) -> tuple[dict[str, Any], tuple[float, ...]]:
        """What comes of an impact whose deck has these variables, too; by functions also the last velocity, m/s."""
        variables = {**_variables(impact), **extra}
        try:
            lmp, commands = self._prepare(impact.method, variables)
            with _watched(lmp, watch):
                lmp.commands_string(commands)
            found = _read_resolved(lmp) if impact.method == "resolved" else _read_functions(lmp, impact)
            found |= {
                "loop_seconds": float(lmp.extract_variable("loop_seconds")),
                "steps": int(lmp.extract_global("ntimestep")),
                "lammps_version": lmp.version(),
            }
            velocity = tuple(lmp.extract_atom("v")[0][:3]) if impact.method == "functions" else ()
        except BaseException as error:
            # what LAMMPS has refused leaves it in any state; its message becomes one of ours on the way
            self._fail(error)
            raise
        if impact.method == "resolved" or extra:
            # files are complete when LAMMPS is closed
            self.close()
        return found, velocity

    def _prepare(self, method: str, variables: dict[str, str]) -> tuple[Any, str]:
        """LAMMPS with the carrier of these variables, and the commands of the impact."""
        at_hand = self._at_hand
        if at_hand is not None and at_hand.deck is _deck(method) and at_hand.serves(variables):
            return at_hand.lmp, at_hand.change_to(variables) + at_hand.deck.impact
        self.close()
        deck = _deck(method)
        lmp = self._opened.enter_context(lammps_session(variables, self._comm))
        lmp.commands_string(deck.setup)
        self._at_hand = _AtHand(lmp, deck, variables)
        return lmp, deck.impact

    def _fail(self, error: BaseException) -> None:
        """Close LAMMPS as the error does that left it; what LAMMPS has said becomes an error of ours on the way."""
        self._at_hand = None
        self._opened.__exit__(type(error), error, error.__traceback__)


@dataclass(frozen=True)
class _Deck:
    """A deck in two parts: what is run once for a carrier, and what is run for each impact."""

    setup: str
    impact: str

    @cached_property
    def asked(self) -> frozenset[str]:
        """The variables whose values the first part takes."""
        code = re.sub(r"#.*", "", self.setup)
        return frozenset(re.findall(r"(?:\$\{|\bv_|variable,)(\w+)", code))


@cache
def _deck(method: str) -> _Deck:
    deck = read_text(find_deck(DECKS[method]))
    label = re.search(r"^label\s+impact\b.*\n", deck, re.MULTILINE)
    return _Deck(deck[: label.start()], _bare(deck[label.end() :])) if label else _Deck("", deck)


def _bare(commands: str) -> str:
    """Commands without lines of comments, each on one line: LAMMPS takes them apart again for each impact."""
    lines = re.sub(r"&[ \t]*\n\s*", "", commands).splitlines()
    return "".join(line + "\n" for line in lines if line.strip() and not line.startswith("#"))


@dataclass
class _AtHand:
    """An open LAMMPS instance that has run an impact, and the variables of that impact."""

    lmp: Any
    deck: _Deck
    variables: dict[str, str]

    def serves(self, variables: dict[str, str]) -> bool:
        """Whether an impact with these variables may follow in this instance."""
        changed = dict(variables.items() ^ self.variables.items())
        words = all(re.fullmatch(r"[\w.+-]+", value) for value in changed.values())
        return self.deck.setup != "" and words and self.deck.asked.isdisjoint(changed)

    def change_to(self, variables: dict[str, str]) -> str:
        """The commands that give the variables their new values."""
        changed = dict(variables.items() ^ self.variables.items())
        # also those that have not been given yet: the deck has a value of its own for some, and what is there stays
        gone = [f"variable {name} delete\n" for name in changed]
        new = [f"variable {name} index {variables[name]}\n" for name in changed if name in variables]
        self.variables = variables
        return "".join(gone + new)


def _velocity(impact: Impact) -> tuple[float, float, float]:
    """Of the carrier before the impact, m/s."""
    angle = math.radians(impact.angle)
    return impact.speed * math.cos(angle), 0.0, -impact.speed * math.sin(angle)


def _variables(impact: Impact) -> dict[str, str]:
    """The variables of the method's deck, as text that loses no digit."""
    values = impact.deck_variables()
    return {name: repr(value) if isinstance(value, float) else str(value) for name, value in values.items()}


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
        "knocked": fix.total(DetachVector.KNOCKED) / grains,
        "contact_time": fix.of_carrier(DetachAtom.CONTACT_TIME),
        "peak_acceleration": fix.of_carrier(DetachAtom.PEAK_ACCELERATION),
        "restitution_realised": float(lmp.extract_atom("v")[0][2])
        / (impact.speed * math.sin(math.radians(impact.angle))),
        "end": _end(fix, impact),
    }


def _end(fix: _FixOutput, impact: Impact) -> str:
    """Why a run of the functions has stopped."""
    if fix.total(DetachVector.COLLISIONS) == 0 or fix.total(DetachVector.FOLLOWED) > 0:
        return "step limit"
    return "settled" if impact.meet else "rebound"


def _read_resolved(lmp: Any) -> dict[str, Any]:
    names = ("dispersion_ratio", "north", "south", "contact_time", "peak_acceleration", "restitution_realised")
    return {
        **{name: float(lmp.extract_variable(name)) for name in names},
        "grains": int(lmp.extract_variable("grains")),
        "normal": None,
        "tangential_mode": None,
        "knocked": None,
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
        table = self._lmp.extract_fix("dust", self._constants.LMP_STYLE_ATOM, self._constants.LMP_TYPE_ARRAY)
        return float(table[0][column])

    def _global(self, kind: int, **place: int) -> Any:
        return self._lmp.extract_fix("dust", self._constants.LMP_STYLE_GLOBAL, kind, **place)
