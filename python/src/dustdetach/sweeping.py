"""Runs many impacts into a folder: one folder a case, and a table of all of them.

A case is complete when its ``result.json`` exists; the file is written under another name and then renamed, so that
a sweep which was killed, even by ``kill -9``, picks up where it stopped and loses no more than the cases in work. A
case's folder is named by its parameters and by what computes it (version of this package, contents of LAMMPS' library,
the plugin and the deck): results of another build are never taken for one's own.
"""

from __future__ import annotations

import hashlib
import json
import multiprocessing
import os
import sys
import tempfile
import threading
import time
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import ProcessPoolExecutor, as_completed
from concurrent.futures.process import BrokenProcessPool
from dataclasses import asdict
from pathlib import Path
from typing import Any

from .errors import InvalidInput, LammpsMissing
from .files import replace_file
from .impact import Impact
from .places import find_deck, lammps_library, plugin_if_any
from .result import Result, write_csv
from .runner import DECKS, run
from .version import __version__

EXECUTORS = ("local", "mpi")
TABLE = "results.csv"
COMPLETE = "result.json"

#: seconds between two rewritings of the table while cases come in
TABLE_INTERVAL = 5.0

Progress = Callable[[int, int, float], None]
Outcome = tuple[Impact, Result | None, str]


class CasesFailed(RuntimeError):
    """Some cases of a sweep failed and the others are done; ``failures`` holds each with its message."""

    def __init__(self, failures: list[tuple[Impact, str]]) -> None:
        super().__init__(failures)
        self.failures = failures

    def __str__(self) -> str:
        return f"{len(self.failures)} cases failed; first: {self.failures[0][1]}"


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
        InvalidInput: ``out`` is not a folder, ``jobs`` or ``executor`` is out of range.
        LammpsMissing: LAMMPS, the plugin, the deck, or mpi4py for ``mpi``, is not there.
        CasesFailed: after all others are done.
    """
    folder = Path(out)
    if folder.exists() and not folder.is_dir():
        raise InvalidInput(f"--out: {folder} is a file; allowed: the name of a folder")
    if jobs < 1:
        raise InvalidInput(f"--jobs: {jobs} is out of range; allowed: 1 or more")
    if executor not in EXECUTORS:
        raise InvalidInput(f"--executor: unknown choice '{executor}'; allowed: {', '.join(EXECUTORS)}")
    if executor == "mpi" and jobs != 1:
        raise InvalidInput("--jobs: with --executor mpi the number of ranks is mpirun's; allowed: 1")

    build = Build()
    _check_writable(folder)
    cases = list(dict.fromkeys(cases))
    if executor == "mpi":
        return _sweep_on_ranks(cases, folder, build, progress)
    pending = [case for case in cases if not _is_complete(build.folder(folder, case))]
    if jobs == 1:
        outcomes: Iterator[Outcome] = (_attempt(folder, build, case) for case in pending)
    else:
        outcomes = _in_processes(folder, build, pending, jobs)
    return _collect(cases, len(pending), outcomes, folder, build, progress)


def _check_writable(folder: Path) -> None:
    """Before hours of work: whether the folder, or the one in which it will be made, takes files; leaves none."""
    there = next(place for place in (folder, *folder.absolute().parents) if place.exists())
    try:
        with tempfile.TemporaryDirectory(dir=there):
            pass
    except OSError as error:
        raise InvalidInput(f"--out: {folder}: {error.strerror}; allowed: a folder that can be written to") from None


def _collect(
    cases: list[Impact],
    pending: int,
    outcomes: Iterable[Outcome],
    folder: Path,
    build: Build,
    progress: Progress | None,
) -> list[Result]:
    table = _Table(folder, build)
    report = _Report(len(cases), pending, progress)
    failures = []
    for case, result, message in outcomes:
        if result is None:
            failures.append((case, message))
        else:
            table.add(build.name(case), result)
        report.step()
    table.write()
    if failures:
        raise CasesFailed(failures)
    return [table.rows[build.name(case)] for case in cases]


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
        digest = hashlib.sha256(json.dumps(asdict(case)).encode()).hexdigest()[:12]
        suffix = self.suffixes[case.method]
        return f"{case.method}-v{case.speed:g}-a{case.angle:g}-e{case.restitution:g}-{digest}-{suffix}"

    def folder(self, out: Path, case: Impact) -> Path:
        """The case's folder in the sweep's."""
        return out / self.name(case)


class _Table:
    """The rows of ``results.csv``: every complete case of this build in the folder, by name."""

    def __init__(self, folder: Path, build: Build) -> None:
        self._path = folder / TABLE
        self._written = time.monotonic()
        self.rows = {
            path.parent.name: Result.from_json(path.read_text())
            for method, suffix in build.suffixes.items()
            for path in folder.glob(f"{method}-*-{suffix}/{COMPLETE}")
        }

    def add(self, name: str, result: Result) -> None:
        self.rows[name] = result
        if time.monotonic() - self._written > TABLE_INTERVAL:
            self.write()

    def write(self) -> None:
        if not self.rows:
            return
        rows = self.rows.values()
        write_csv(self._path, sorted(rows, key=lambda row: (row.angle, row.restitution, row.speed, row.to_json())))
        self._written = time.monotonic()


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


def _is_complete(folder: Path) -> bool:
    return (folder / COMPLETE).is_file()


def _attempt(out: Path, build: Build, case: Impact, comm: Any = None) -> Outcome:
    """Run one case into its folder; a failure is a message, so that the others go on."""
    try:
        result = run(case, comm=comm)
    except InvalidInput as error:
        return case, None, str(error)
    folder = build.folder(out, case)
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "build.json").write_text(json.dumps(build.identity[case.method], indent=1) + "\n")
    with replace_file(folder / COMPLETE) as part:
        part.write_text(result.to_json() + "\n")
    return case, result, ""


def _in_processes(out: Path, build: Build, pending: list[Impact], jobs: int) -> Iterator[Outcome]:
    """Outcomes as they come from processes that are started afresh: LAMMPS and MPI do not survive a fork."""
    context = multiprocessing.get_context("spawn")
    with ProcessPoolExecutor(min(jobs, len(pending)) or 1, context, _die_with_parent) as pool:
        futures = {pool.submit(_attempt, out, build, case): case for case in pending}
        try:
            for future in as_completed(futures):
                try:
                    yield future.result()
                except BrokenProcessPool:
                    yield futures[future], None, "the process that ran it died"
        finally:
            pool.shutdown(wait=False, cancel_futures=True)


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
        pending = [case for case in cases if not _is_complete(build.folder(folder, case))]
        pending = world.bcast(pending)
        mine = (_attempt(folder, build, case, MPI.COMM_SELF) for case in pending[world.rank :: world.size])
        if world.rank > 0:
            world.gather(list(mine))
            answer = world.bcast(None)
        else:
            outcomes = _then_gather(mine, world)
            try:
                answer = _collect(cases, len(pending), outcomes, folder, build, progress)
            except CasesFailed as error:
                answer = error
            world.bcast(answer)
    except Exception as error:
        # the other ranks would wait for this one forever
        print(f"dustdetach sweep: rank {world.rank}: {error}", file=sys.stderr, flush=True)
        world.Abort(1)
        raise
    if isinstance(answer, CasesFailed):
        raise answer
    return answer


def _then_gather(mine: Iterable[Outcome], world: Any) -> Iterator[Outcome]:
    """Rank 0's own outcomes as they come, then those of the others."""
    yield from mine
    for outcomes in world.gather([])[1:]:
        yield from outcomes


def _plugin_digest() -> str:
    """Of every library of the plugin: the one LAMMPS loads may be a door to another beside it."""
    plugin = plugin_if_any()
    return _digest(*sorted(plugin.parent.glob("dust*.so"))) if plugin else "compiled into LAMMPS"


def _digest(*paths: Path) -> str:
    return hashlib.sha256(b"".join(path.read_bytes() for path in paths)).hexdigest()[:16]
