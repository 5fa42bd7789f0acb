"""A LAMMPS instance in this process that knows the package DUST and leaves no output behind."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from typing import Any

from .errors import InvalidInput, LammpsMissing
from .places import find_plugin, lammps_module

FIX_STYLE = "dust/detach"

#: options that keep LAMMPS from writing to the screen or a log file
QUIET = ("-log", "none", "-screen", "none", "-nocite", "-echo", "none")


@contextmanager
def lammps_session(variables: Mapping[str, Any] | None = None, comm: Any = None) -> Iterator[Any]:
    """Open LAMMPS with the package DUST, close it at the end.

    Args:
        variables: command-line variables (``-var NAME VALUE``) that a deck's own defaults give way to.
        comm: an mpi4py communicator; without one LAMMPS takes all ranks of the process.

    Raises:
        LammpsMissing: LAMMPS or the plugin cannot be found or loaded.
        InvalidInput: LAMMPS refuses a command of the block; its message without the place in LAMMPS' source.
    """
    arguments = list(QUIET)
    for name, value in (variables or {}).items():
        arguments += ["-var", name, f"{value!r}" if isinstance(value, float) else str(value)]
    module = lammps_module()
    try:
        lmp = module.lammps(cmdargs=arguments, comm=comm)
    except (OSError, RuntimeError, AttributeError) as error:
        raise LammpsMissing(f"LAMMPS does not start: {error}") from None
    try:
        load_plugin(lmp)
        yield lmp
    except Exception as error:
        if not is_lammps_error(error):
            raise
        raise InvalidInput(error_line(error)) from None
    finally:
        lmp.close()


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
        lmp.command(f'plugin load "{plugin}"')
    except Exception as error:
        raise LammpsMissing(f"the plugin {plugin} refuses this LAMMPS: {error_line(error)}") from None
    if not lmp.has_style("fix", FIX_STYLE):
        raise LammpsMissing(
            f"the plugin {plugin} does not load into LAMMPS {lmp.version()}: it must be built for the same version; "
            "run ./bootstrap build"
        )


def is_lammps_error(error: Exception) -> bool:
    """Whether LAMMPS raised it: its module raises an ``Exception`` of no narrower kind with LAMMPS' message."""
    return type(error).__name__ in ("Exception", "MPIAbortException") and "ERROR" in str(error)


def error_line(error: Exception) -> str:
    """What LAMMPS said, on one line, without its place in the source and the echo of the input."""
    text = getattr(error, "message", str(error)).strip().split("\n")[0]
    text = re.sub(r"^ERROR( on proc \d+)?: ", "", text)
    return re.sub(r" \([\w./+-]+:\d+\)", "", text)
