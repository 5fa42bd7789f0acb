"""A LAMMPS instance in this process that knows the package DUST and leaves no output behind."""

from __future__ import annotations

import os
import re
import threading
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from ctypes import create_string_buffer
from functools import cache
from pathlib import Path
from typing import Any

from .errors import InvalidInput, LammpsBusy, LammpsMissing, MachineFault
from .files import MACHINE_FAULTS, check_room
from .places import find_plugin, lammps_module

FIX_STYLE = "dust/detach"

#: temporary files of Open MPI, which it makes when the first LAMMPS of a process starts: 8.2 MB, bytes
MPI_ROOM = 10 << 20

#: options that keep LAMMPS from writing to the screen or a log file
QUIET = ("-log", "none", "-screen", "none", "-nocite", "-echo", "none")


#: LAMMPS and MPI are for one thread at a time
_at_work = threading.Lock()


@contextmanager
def lammps_session(variables: Mapping[str, Any] | None = None, comm: Any = None) -> Iterator[Any]:
    """Open LAMMPS with the package DUST, close it at the end.

    Args:
        variables: command-line variables (``-var NAME VALUE``) that a deck's own defaults give way to.
        comm: an mpi4py communicator; without one LAMMPS takes all ranks of the process.

    Raises:
        LammpsMissing: LAMMPS or the plugin cannot be found or loaded.
        LammpsBusy: another thread of this process has it open.
        InvalidInput: LAMMPS refuses a command of the block; its message without the place in LAMMPS' source.
        MachineFault: it cannot write a file of the block.
    """
    arguments = list(QUIET)
    for name, value in (variables or {}).items():
        arguments += ["-var", name, f"{value!r}" if isinstance(value, float) else str(value)]
    with open_lammps(arguments, comm) as lmp:
        try:
            load_plugin(lmp)
            yield lmp
        except LammpsRefusal as error:
            text = str(error)
            fault = any(os.strerror(number) in text for number in MACHINE_FAULTS)
            raise (MachineFault if fault else InvalidInput)(text) from None


class LammpsRefusal(Exception):
    """LAMMPS' own error message on one line, without its place in the source and the echo of the input."""

    def __init__(self, message: str) -> None:
        text = re.sub(r"^ERROR( on proc \d+)?: ", "", message.strip().split("\n")[0])
        super().__init__(re.sub(r" \([\w./+-]+:\d+\)", "", text))


@contextmanager
def open_lammps(arguments: Sequence[str] = QUIET, comm: Any = None) -> Iterator[Any]:
    """Open LAMMPS without the package DUST, close it at the end; its errors come as `LammpsRefusal`.

    Raises:
        LammpsMissing: LAMMPS cannot be found or does not start.
        LammpsBusy: another thread of this process has it open.
    """
    if not _at_work.acquire(blocking=False):
        raise LammpsBusy(
            "LAMMPS runs in another thread of this process; allowed: one run at a time, or sweep with several jobs"
        )
    try:
        lammps = _lammps_class()
        try:
            lmp = lammps(cmdargs=list(arguments), comm=comm)
        except (OSError, RuntimeError, AttributeError) as error:
            raise LammpsMissing(f"LAMMPS does not start: {error}") from None
        try:
            yield lmp
        finally:
            lmp.close()
    finally:
        _at_work.release()


def lammps_file(path: Path, name: str) -> str:
    """The name of a file as a word of a LAMMPS command.

    Raises:
        InvalidInput: it holds a quote or a line break, which no word of LAMMPS can.
    """
    if re.search(r"[\"\x00-\x1f\x7f]", str(path)):
        raise InvalidInput(f"{name}: {path}: LAMMPS takes no such name; allowed: without quotes and line breaks")
    return f'"{path}"'


@cache
def _lammps_class() -> type:
    _check_room()
    # a process that no mpirun has started needs no daemon of Open MPI beside it
    os.environ.setdefault("OMPI_MCA_ess_singleton_isolated", "1")

    class Lammps(lammps_module().lammps):  # type: ignore[misc]
        """LAMMPS' class with whole error messages: 4Feb2025 cuts them after 99 characters."""

        @property
        def _lammps_exception(self) -> LammpsRefusal:
            message = create_string_buffer(4096)
            self.lib.lammps_get_last_error_message(self.lmp, message, len(message))
            return LammpsRefusal(message.value.decode())

    return Lammps


def _check_room() -> None:
    """Without room for its files Open MPI would end the process with a page of messages."""
    names = (os.environ.get(name) for name in ("TMPDIR", "TEMP", "TMP"))
    check_room(Path(next(filter(None, names), "/tmp")), MPI_ROOM)


def load_plugin(lmp: Any) -> None:
    """Load the plugin unless LAMMPS already knows the fix (compiled in, or loaded by an earlier instance).

    Raises:
        LammpsMissing: the plugin cannot be found or refuses this LAMMPS; the message is the plugin's.
    """
    if lmp.has_style("fix", FIX_STYLE):
        return
    plugin = find_plugin()
    if not lmp.has_package("PLUGIN"):
        raise LammpsMissing("this LAMMPS is built without the package PLUGIN; run ./bootstrap build")
    try:
        lmp.command(f"plugin load {lammps_file(plugin, 'DUSTDETACH_PLUGIN')}")
    except LammpsRefusal as error:
        raise LammpsMissing(f"the plugin {plugin} refuses this LAMMPS: {error}") from None
    if not lmp.has_style("fix", FIX_STYLE):
        raise LammpsMissing(
            f"the plugin {plugin} does not load into LAMMPS {lmp.version()}: it must be built for the same version; "
            "run ./bootstrap build"
        )
