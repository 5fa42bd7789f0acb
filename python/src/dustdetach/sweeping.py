"""Runs many impacts into a folder: batches of results, and a table of all of them.

A process runs one impact after another (`runner.Bench`) and keeps what it has after `BATCH_SECONDS`, or after so many
cases, in one file that is written under another name and then renamed (`batches`): a sweep which was killed, even by
``kill -9``, picks up where it stopped and loses no more than the batches in work, one a process.
"""

from __future__ import annotations

import fcntl
import operator
import os
import sys
import tempfile
import threading
import time
from collections import deque
from collections.abc import Callable, Generator, Iterable, Iterator
from contextlib import ExitStack, contextmanager, suppress
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any, cast

from .batches import Batches, Build, in_batches, parameters_of, write_batch
from .errors import DustError, InvalidInput, LammpsBusy, LammpsMissing, shown
from .files import as_path, file_error
from .impact import Impact, as_impact
from .result import Result, write_csv
from .runner import Bench

if TYPE_CHECKING:
    from multiprocessing.synchronize import Event

EXECUTORS = ("local", "mpi")
TABLE = "results.csv"

#: of a batch: the cases in it, at most, and the seconds after which what is there is kept
BATCH_CASES, BATCH_SECONDS = 200, 2.0

#: batches that each process finds prepared in a sweep of few cases, so that all end at about the same time
BATCHES_A_PROCESS = 4

#: seconds between two rewritings of the table while cases come in, and at least so many times what one takes
TABLE_INTERVAL, TABLE_SHARE = 5.0, 20.0

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


@dataclass
class Work:
    """What became of some cases: results that are kept, those that alone have none and why, those that are left.

    ``stop`` is why none of the others will have one.
    """

    results: list[Result] = field(default_factory=list)
    failures: list[tuple[Impact, str]] = field(default_factory=list)
    left: list[Impact] = field(default_factory=list)
    kept: str = ""
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
        progress: called as ``progress(done, total, seconds left)`` for each case, when its batch is kept.

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
        done = _in_this_process(folder, build, _batches(pending, 1), table)
    else:
        done = _in_processes(folder, build, _batches(pending, jobs), jobs, table)
    return _collect(cases, len(pending), done, table, progress)


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
    if number == 1:
        return number
    import multiprocessing

    if multiprocessing.current_process().daemon:
        raise InvalidInput(f"--jobs: {number} in a process that may not start others; allowed: 1")
    if getattr(multiprocessing.current_process(), "_inheriting", False):
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


def _batches(pending: list[Impact], processes: int) -> list[list[Impact]]:
    share = -(-len(pending) // (processes * BATCHES_A_PROCESS))
    return list(in_batches(pending, min(BATCH_CASES, share) if processes > 1 else BATCH_CASES))


def _collect(
    cases: list[Impact], pending: int, done: Iterable[Work], table: _Table, progress: Progress | None
) -> list[Result]:
    report = _Report(len(cases), pending, progress)
    failures = []
    for work in done:
        table.add(work)
        failures += work.failures
        for _ in range(len(work.results) + len(work.failures)):
            report.step()
        if work.stop is not None:
            raise work.stop
    table.write()
    if failures:
        raise CasesFailed(failures)
    return [table.row(case) for case in cases]


class _Table:
    """The rows of ``results.csv``: every complete case of this build in the folder, by its parameters."""

    def __init__(self, folder: Path, build: Build) -> None:
        self._folder = folder
        self._batches = Batches(folder, build)
        self._write_next = time.monotonic() + TABLE_INTERVAL
        self._rows: dict[object, Result] = {}
        self.look()

    def has(self, case: Impact) -> bool:
        return parameters_of(case) in self._rows

    def row(self, case: Impact) -> Result:
        return self._rows[parameters_of(case)]

    def add(self, work: Work) -> None:
        self._batches.know(work.kept)
        self._rows.update((parameters_of(result), result) for result in work.results)
        if time.monotonic() > self._write_next:
            self.write()

    def look(self) -> None:
        """Take in what other sweeps into this folder have made."""
        for result in self._batches.new():
            self._rows.setdefault(parameters_of(result), result)

    def split(self, cases: list[Impact]) -> tuple[list[Impact], Work]:
        """The cases that another sweep has not made meanwhile, and what it has made of the others."""
        self.look()
        theirs = [self.row(case) for case in cases if self.has(case)]
        return [case for case in cases if not self.has(case)], Work(results=theirs)

    def write(self) -> None:
        """Write the table with what other sweeps into this folder have made, too: they may be at work now."""
        began = time.monotonic()
        with _locked(self._folder):
            self.look()
            if self._rows:
                rows = sorted(
                    self._rows.values(), key=lambda row: (row.angle, row.restitution, row.speed, parameters_of(row))
                )
                write_csv(self._folder / TABLE, rows)
        now = time.monotonic()
        self._write_next = now + max(TABLE_INTERVAL, TABLE_SHARE * (now - began))


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


def _work(out: Path, build: Build, cases: list[Impact], comm: Any = None) -> Work:
    """Run cases of one method until it is time to keep what is there; a failure is a message, so that others go on."""
    work = Work(left=list(cases))
    began = time.monotonic()
    try:
        with Bench(comm) as bench:
            for case in cases:
                try:
                    work.results.append(bench.run(case))
                except LammpsBusy:
                    raise
                except InvalidInput as error:
                    work.failures.append((case, str(error)))
                del work.left[0]
                if time.monotonic() - began > BATCH_SECONDS:
                    break
    except DustError as error:
        work.stop = error
    if work.results:
        try:
            work.kept = write_batch(out, build, work.results)
        except DustError as error:
            work.results, work.stop = [], work.stop or error
    return work


def _in_this_process(
    out: Path, build: Build, batches: Iterable[list[Impact]], table: _Table | None, comm: Any = None
) -> Iterator[Work]:
    """One batch after another, up to the first after which there is no point in going on."""
    for batch in batches:
        left = batch
        if table is not None:
            left, theirs = table.split(batch)
            yield theirs
        while left:
            work = _work(out, build, left, comm)
            yield work
            if work.stop is not None:
                return
            left = work.left


def _in_processes(out: Path, build: Build, batches: list[list[Impact]], jobs: int, table: _Table) -> Iterator[Work]:
    """Work as it comes from processes that are started afresh: LAMMPS and MPI do not survive a fork."""
    import multiprocessing
    from concurrent.futures import FIRST_COMPLETED, Future, ProcessPoolExecutor, wait
    from concurrent.futures.process import BrokenProcessPool

    context = multiprocessing.get_context("spawn")
    ready = context.Event()
    waiting = deque(batches)
    running: dict[Future[Work], list[Impact]] = {}
    os.environ[WORKER] = "1"
    try:
        with ProcessPoolExecutor(min(jobs, len(batches)) or 1, context, _start_worker, (ready,)) as pool:
            try:
                while waiting or running:
                    # one more than work: no process waits for its next batch
                    while waiting and len(running) < 2 * jobs:
                        batch, theirs = table.split(waiting.popleft())
                        yield theirs
                        if batch:
                            running[pool.submit(_work, out, build, batch)] = batch
                    for future in wait(running, return_when=FIRST_COMPLETED).done:
                        batch = running.pop(future)
                        work = future.result()
                        if work.left:
                            waiting.appendleft(work.left)
                        yield work
            except BrokenProcessPool:
                if not ready.is_set():
                    raise InvalidInput(NO_GUARD) from None
                lost = [case for batch in (batch, *running.values(), *waiting) for case in batch]
                yield Work(failures=[(case, "the process that ran it died") for case in lost])
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
    import multiprocessing

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
        table, plan = _plan(cases, folder, build, world.size) if world.rank == 0 else (None, None)
        plan = world.bcast(plan)
        if isinstance(plan, DustError):
            raise plan
        mine = _in_this_process(folder, build, plan[world.rank :: world.size], None, MPI.COMM_SELF)
        if table is None:
            _hand_in(mine, world, MPI.Request.testall)
            _sleep_until(lambda: world.iprobe(source=0))
            answer = world.recv(source=0)
        else:
            done = _and_of_others(mine, world)
            try:
                answer = _collect(cases, sum(map(len, plan)), done, table, progress)
            except DustError as error:
                done.close()
                answer = error
            for rank in range(1, world.size):
                world.send(answer, rank)
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


def _plan(
    cases: list[Impact], folder: Path, build: Build, ranks: int
) -> tuple[_Table | None, list[list[Impact]] | DustError]:
    """The table and the cases that are missing in it, or what is wrong in the folder."""
    try:
        table = _Table(folder, build)
    except DustError as error:
        return None, error
    return table, _batches([case for case in cases if not table.has(case)], ranks)


def _hand_in(mine: Iterable[Work], world: Any, testall: Callable[[list[Any]], tuple[bool, Any]]) -> None:
    """A rank's own work to rank 0 as it comes, then the word that this was all."""
    sent = [world.isend(work, 0) for work in mine]
    sent.append(world.isend(None, 0))
    _sleep_until(lambda: testall(sent)[0])


def _and_of_others(mine: Iterable[Work], world: Any) -> Generator[Work, None, None]:
    """Rank 0's own work as it comes, then that of the others, who are waited for also if this is closed before."""
    at_work = world.size - 1
    try:
        yield from mine
        while at_work:
            _sleep_until(world.iprobe)
            theirs = world.recv()
            if theirs is None:
                at_work -= 1
            else:
                yield theirs
    finally:
        while at_work:
            _sleep_until(world.iprobe)
            at_work -= world.recv() is None


def _sleep_until(true: Callable[[], bool]) -> None:
    """MPI itself waits with the processor busy, which others need."""
    while not true():
        time.sleep(0.01)
