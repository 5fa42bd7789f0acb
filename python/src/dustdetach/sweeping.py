"""Runs many impacts into a folder: one folder a case, and a table of all of them.

A case is complete when its ``result.json`` exists; the file is written under another name and then renamed, so that
a sweep which was killed, even by ``kill -9``, picks up where it stopped and loses no more than the cases in work. A
case's folder is named by its parameters and by what computes it (version of this package, contents of LAMMPS' library,
the plugin and the deck): results of another build are never taken for one's own.
"""

from __future__ import annotations

import fcntl
import hashlib
import json
import multiprocessing
import operator
import os
import sys
import tempfile
import threading
import time
from collections.abc import Callable, Generator, Iterable, Iterator
from concurrent.futures import ProcessPoolExecutor, as_completed
from concurrent.futures.process import BrokenProcessPool
from contextlib import ExitStack, contextmanager, suppress
from dataclasses import dataclass
from multiprocessing.synchronize import Event
from pathlib import Path
from typing import Any, cast

from .errors import DustError, InvalidInput, LammpsBusy, LammpsMissing, shown
from .files import as_path, file_error, make_folder, replace_file
from .impact import Impact, as_impact
from .places import find_deck, lammps_library, plugin_if_any
from .result import Result, read_result, write_csv
from .runner import DECKS, run
from .version import __version__

EXECUTORS = ("local", "mpi")
TABLE = "results.csv"
COMPLETE = "result.json"

#: seconds between two rewritings of the table while cases come in
TABLE_INTERVAL = 5.0

#: set in the environment of the processes of a sweep
WORKER = "DUSTDETACH_WORKER"

Progress = Callable[[int, int, float], None]


class CasesFailed(DustError, RuntimeError):
    """Some cases of a sweep failed and the others are done; ``failures`` holds each with its message."""

    def __init__(self, failures: list[tuple[Impact, str]]) -> None:
        super().__init__(f"{len(failures)} cases failed; first: {failures[0][1]}")
        self.failures = failures

    def __reduce__(self) -> tuple[type[CasesFailed], tuple[list[tuple[Impact, str]]]]:
        return type(self), (self.failures,)


@dataclass(frozen=True)
class Outcome:
    """What became of a case: a result, or why it alone has none, or why none of the others will."""

    case: Impact
    result: Result | None = None
    failure: str = ""
    stop: DustError | None = None


def sweep(
    cases: Iterable[Impact],
    out: str | Path,
    *,
    jobs: int = 1,
    executor: str = "local",
    progress: Progress | None = None,
) -> list[Result]:
    """Run every case that is not complete in ``out`` yet and write ``out/results.csv``.

    Args:
        cases: the impacts; the same one twice is run once.
        out: folder of the results; made if it is not there.
        jobs: processes of the executor ``local``, from 1.
        executor: ``local``, or ``mpi`` for the ranks this process was started on (each case on one rank).
        progress: called as ``progress(done, total, seconds left)`` when a case is done.

    Returns:
        The results in the order of the cases. The table holds every complete case of this build in ``out``, those of
        earlier sweeps too.

    Raises:
        InvalidInput: ``cases`` are none, ``out`` is not a folder that takes the results, a file in it is not what its
            name says, ``jobs`` or ``executor`` is out of range, or a script calls this with several jobs outside of its
            ``if __name__ == "__main__":``.
        LammpsMissing: LAMMPS, the plugin, the deck, or mpi4py for ``mpi``, is not there.
        LammpsBusy: another thread of this process runs LAMMPS.
        MachineFault: the disk is full, or fails.
        CasesFailed: after all others are done.
    """
    folder = as_path(out, "--out")
    cases = _impacts(cases)
    jobs = _jobs(jobs)
    if executor not in EXECUTORS:
        raise InvalidInput(f"--executor: unknown choice {shown(executor)}; allowed: {', '.join(EXECUTORS)}")
    if executor == "mpi" and jobs != 1:
        raise InvalidInput("--jobs: with --executor mpi the number of ranks is mpirun's; allowed: 1")

    build = Build()
    _check_writable(folder)
    if executor == "mpi":
        return _sweep_on_ranks(cases, folder, build, progress)
    table = _Table(folder, build)
    pending = [case for case in cases if not table.has(case)]
    if jobs == 1:
        outcomes: Iterator[Outcome] = (_attempt(folder, build, case) for case in pending)
    else:
        outcomes = _in_processes(folder, build, pending, jobs)
    return _collect(cases, len(pending), outcomes, table, progress)


def _impacts(cases: Iterable[Impact]) -> list[Impact]:
    """The cases, each once."""
    try:
        listed = list(cases)
    except TypeError:
        raise InvalidInput(f"sweep: {shown(cases)} is not a list of impacts") from None
    return list(dict.fromkeys(as_impact(case, "sweep") for case in listed))


def _jobs(jobs: int) -> int:
    """Number of processes, if this process can start them."""
    try:
        number = operator.index(jobs)
    except TypeError:
        raise InvalidInput(f"--jobs: {shown(jobs)} is not a whole number; allowed: 1 or more") from None
    if isinstance(jobs, bool) or number < 1:
        raise InvalidInput(f"--jobs: {shown(jobs)} is out of range; allowed: 1 or more")
    if number > 1 and multiprocessing.current_process().daemon:
        raise InvalidInput(f"--jobs: {number} in a process that may not start others; allowed: 1")
    if number > 1 and getattr(multiprocessing.current_process(), "_inheriting", False):
        if WORKER in os.environ:
            # a process of a sweep: the one that started it says why, once for all
            raise SystemExit(1)
        raise InvalidInput(NO_GUARD)
    return number


#: each process of a sweep reads the script that started it, and would come to the same call
NO_GUARD = (
    "--jobs: the processes of a sweep ended while they read the script that called it; allowed: 1, or a call under "
    "if __name__ == '__main__':"
)


def _check_writable(folder: Path) -> None:
    """Before hours of work: whether the folder, or the one in which it will be made, takes files; leaves none."""
    if os.path.lexists(folder) and not os.path.isdir(folder):
        raise InvalidInput(f"--out: {folder} is a file; allowed: the name of a folder")
    if os.path.isdir(folder / TABLE):
        raise InvalidInput(f"--out: {folder / TABLE} is a folder; allowed: a folder in which it can be a file")
    there = next(place for place in (folder, *folder.absolute().parents) if os.path.lexists(place))
    try:
        os.lstat(folder / TABLE)
    except FileNotFoundError:
        pass
    except OSError as error:
        raise InvalidInput(f"--out: {folder}: {error.strerror}; allowed: a folder that can be written to") from None
    try:
        with tempfile.TemporaryDirectory(dir=there):
            pass
    except OSError as error:
        fault = file_error(folder, error)
        if not isinstance(fault, InvalidInput):
            raise fault from None
        raise InvalidInput(f"--out: {fault}; allowed: a folder that can be written to") from None


def _collect(
    cases: list[Impact], pending: int, outcomes: Iterable[Outcome], table: _Table, progress: Progress | None
) -> list[Result]:
    report = _Report(len(cases), pending, progress)
    failures = []
    for outcome in outcomes:
        if outcome.stop is not None:
            raise outcome.stop
        if outcome.result is None:
            failures.append((outcome.case, outcome.failure))
        else:
            table.add(outcome.case, outcome.result)
        report.step()
    table.write()
    if failures:
        raise CasesFailed(failures)
    return [table.row(case) for case in cases]


class Build:
    """What computes the results, and so belongs to the name of a case."""

    def __init__(self) -> None:
        common = {"dustdetach": __version__, "lammps": _digest(lammps_library()), "plugin": _plugin_digest()}
        self.identity = {method: {**common, "deck": _digest(find_deck(deck))} for method, deck in DECKS.items()}
        self.suffixes = {
            method: hashlib.sha256(json.dumps(identity, sort_keys=True).encode()).hexdigest()[:8]
            for method, identity in self.identity.items()
        }

    def name(self, case: Impact) -> str:
        """Name of a case's folder: what varies most, then a digest of all parameters, then one of the build."""
        digest = hashlib.sha256(json.dumps(case.values()).encode()).hexdigest()[:12]
        suffix = self.suffixes[case.method]
        return f"{case.method}-v{case.speed:g}-a{case.angle:g}-e{case.restitution:g}-{digest}-{suffix}"

    def folder(self, out: Path, case: Impact) -> Path:
        """The case's folder in the sweep's."""
        return out / self.name(case)


class _Table:
    """The rows of ``results.csv``: every complete case of this build in the folder, by name."""

    def __init__(self, folder: Path, build: Build) -> None:
        self._folder, self._build = folder, build
        self._written = time.monotonic()
        self._rows: dict[str, Result] = {}
        self._look()

    def has(self, case: Impact) -> bool:
        return self._build.name(case) in self._rows

    def row(self, case: Impact) -> Result:
        return self._rows[self._build.name(case)]

    def add(self, case: Impact, result: Result) -> None:
        self._rows[self._build.name(case)] = result
        if time.monotonic() - self._written > TABLE_INTERVAL:
            self.write()

    def write(self) -> None:
        """Write the table with what other sweeps into this folder have made, too: they may be at work now."""
        with _locked(self._folder):
            self._look()
            if self._rows:
                rows = sorted(
                    self._rows.values(), key=lambda row: (row.angle, row.restitution, row.speed, row.to_json())
                )
                write_csv(self._folder / TABLE, rows)
        self._written = time.monotonic()

    def _look(self) -> None:
        """Take in the complete cases that are not known yet."""
        for method, suffix in self._build.suffixes.items():
            for path in self._folder.glob(f"{method}-*-{suffix}/{COMPLETE}"):
                if path.parent.name not in self._rows:
                    self._rows[path.parent.name] = _complete(path)


def _complete(path: Path) -> Result:
    try:
        return read_result(path)
    except InvalidInput as error:
        raise InvalidInput(f"{error}; remove it, and its case is run again") from None


@contextmanager
def _locked(folder: Path) -> Iterator[None]:
    """One process at a time, where the folder is there and its file system has locks."""
    with ExitStack() as stack:
        with suppress(OSError):
            file = os.open(folder, os.O_RDONLY)
            stack.callback(os.close, file)
            fcntl.flock(file, fcntl.LOCK_EX)
        yield


class _Report:
    """Tells a caller how many cases are done, and how long the rest will take at the pace of this run."""

    def __init__(self, total: int, pending: int, progress: Progress | None) -> None:
        self._total, self._pending, self._progress = total, pending, progress
        self._left = pending
        self._started = time.monotonic()
        self._tell()

    def step(self) -> None:
        self._left -= 1
        self._tell()

    def _tell(self) -> None:
        if self._progress is None:
            return
        finished = self._pending - self._left
        pace = (time.monotonic() - self._started) / finished if finished else 0.0
        self._progress(self._total - self._left, self._total, pace * self._left)


def _attempt(out: Path, build: Build, case: Impact, comm: Any = None) -> Outcome:
    """Run one case into its folder unless another sweep has; a failure is a message, so that the others go on."""
    folder = build.folder(out, case)
    try:
        if os.path.exists(folder / COMPLETE):
            return Outcome(case, result=_complete(folder / COMPLETE))
        try:
            result = run(case, comm=comm)
        except LammpsBusy:
            raise
        except InvalidInput as error:
            return Outcome(case, failure=str(error))
        make_folder(folder)
        with replace_file(folder / "build.json") as part:
            part.write_text(json.dumps(build.identity[case.method], indent=1) + "\n")
        with replace_file(folder / COMPLETE) as part:
            part.write_text(result.to_json() + "\n")
        return Outcome(case, result=result)
    except DustError as error:
        return Outcome(case, stop=error)


def _in_processes(out: Path, build: Build, pending: list[Impact], jobs: int) -> Iterator[Outcome]:
    """Outcomes as they come from processes that are started afresh: LAMMPS and MPI do not survive a fork."""
    context = multiprocessing.get_context("spawn")
    ready = context.Event()
    os.environ[WORKER] = "1"
    try:
        with ProcessPoolExecutor(min(jobs, len(pending)) or 1, context, _start_worker, (ready,)) as pool:
            futures = {pool.submit(_attempt, out, build, case): case for case in pending}
            try:
                for future in as_completed(futures):
                    try:
                        yield future.result()
                    except BrokenProcessPool:
                        if not ready.is_set():
                            raise InvalidInput(NO_GUARD) from None
                        yield Outcome(futures[future], failure="the process that ran it died")
            finally:
                pool.shutdown(wait=False, cancel_futures=True)
    finally:
        os.environ.pop(WORKER, None)


def _start_worker(ready: Event) -> None:
    """Tell that this process has come past the script that started the sweep, and end it with the sweep."""
    ready.set()
    _die_with_parent()


def _die_with_parent() -> None:
    """End this worker when the sweep is killed: it would wait for work forever."""
    parent = multiprocessing.parent_process()

    def wait() -> None:
        if parent is not None:
            parent.join()
        os._exit(1)

    threading.Thread(target=wait, daemon=True).start()


def _sweep_on_ranks(cases: list[Impact], folder: Path, build: Build, progress: Progress | None) -> list[Result]:
    """The cases dealt out to all ranks, which all return the same; rank 0 alone writes the table and reports."""
    try:
        from mpi4py import MPI
    except ImportError as error:
        raise LammpsMissing(f"--executor mpi needs mpi4py ({error}); pip install 'dustdetach[mpi]'") from None
    world = MPI.COMM_WORLD
    try:
        table, plan = _plan(cases, folder, build) if world.rank == 0 else (None, None)
        plan = world.bcast(plan)
        if isinstance(plan, DustError):
            raise plan
        mine = _until_stop(_attempt(folder, build, case, MPI.COMM_SELF) for case in plan[world.rank :: world.size])
        if table is None:
            world.gather(list(mine))
            answer = world.bcast(None)
        else:
            outcomes = _then_gather(mine, world)
            try:
                answer = _collect(cases, len(plan), outcomes, table, progress)
            except DustError as error:
                outcomes.close()
                answer = error
            world.bcast(answer)
    except DustError:
        raise
    except Exception as error:
        # the other ranks would wait for this one forever
        print(f"dustdetach sweep: rank {world.rank}: {error}", file=sys.stderr, flush=True)
        world.Abort(1)
        raise
    if isinstance(answer, DustError):
        raise answer
    return cast("list[Result]", answer)


def _plan(cases: list[Impact], folder: Path, build: Build) -> tuple[_Table | None, list[Impact] | DustError]:
    """The table and the cases that are missing in it, or what is wrong in the folder."""
    try:
        table = _Table(folder, build)
    except DustError as error:
        return None, error
    return table, [case for case in cases if not table.has(case)]


def _until_stop(outcomes: Iterable[Outcome]) -> Iterator[Outcome]:
    """The outcomes up to the first after which there is no point in going on."""
    for outcome in outcomes:
        yield outcome
        if outcome.stop is not None:
            return


def _then_gather(mine: Iterable[Outcome], world: Any) -> Generator[Outcome, None, None]:
    """Rank 0's own outcomes as they come, then those of the others, who wait for this also if it is closed before."""
    try:
        yield from mine
    finally:
        others = world.gather([])[1:]
    for outcomes in others:
        yield from outcomes


def _plugin_digest() -> str:
    """Of every library of the plugin: the one LAMMPS loads may be a door to another beside it."""
    plugin = plugin_if_any()
    return _digest(*sorted(plugin.parent.glob("dust*.so"))) if plugin else "compiled into LAMMPS"


def _digest(*paths: Path) -> str:
    try:
        return hashlib.sha256(b"".join(path.read_bytes() for path in paths)).hexdigest()[:16]
    except OSError as error:
        raise LammpsMissing(f"{error.filename}: {error.strerror}") from None
