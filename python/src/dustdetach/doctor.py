"""What this machine offers: LAMMPS, the plugin, the decks, MPI, and what is wrong with them."""

from __future__ import annotations

import os
import platform
from dataclasses import dataclass
from importlib import metadata
from pathlib import Path
from typing import Any

from .errors import DustError, LammpsMissing
from .files import read_text, scratch_folder
from .places import find_core, find_deck, find_plugin, lammps_library
from .runner import DECKS
from .session import FIX_STYLE, lammps_file, load_plugin, open_lammps
from .texture import load_core
from .version import __version__

#: oldest LAMMPS with granular sub-models that this package is tested with
OLDEST_LAMMPS = 20250204


@dataclass(frozen=True)
class Finding:
    """One thing that was looked for.

    Attributes:
        what: its name.
        found: what there is, or what is missing and what to do about it.
        ok: whether impacts can run with it.
    """

    what: str
    found: str
    ok: bool = True


def examine() -> list[Finding]:
    """Look for everything an impact needs, as far as one thing does not hang on another that is missing."""
    findings = [
        Finding("dustdetach", f"{__version__} in {Path(__file__).parent}"),
        Finding("Python", f"{platform.python_version()}, {_packages('numpy', 'matplotlib', 'mpi4py')}"),
    ]
    try:
        findings.append(Finding("LAMMPS library", str(lammps_library())))
        with open_lammps() as lmp:
            findings += _lammps(lmp)
    except DustError as error:
        findings.append(Finding("LAMMPS", f"{error}", ok=False))
    try:
        load_core()
        findings.append(Finding("texture files", f"{find_core()}, loads"))
    except LammpsMissing as error:
        findings.append(Finding("texture files", str(error), ok=False))
    try:
        folders = {find_deck(deck).parent for deck in DECKS.values()}
        findings.append(Finding("decks", ", ".join(sorted(map(str, folders)))))
    except LammpsMissing as error:
        findings.append(Finding("decks", str(error), ok=False))
    return findings


def _lammps(lmp: Any) -> list[Finding]:
    info = _info(lmp)
    version = lmp.version()
    findings = [
        Finding("LAMMPS version", f"{version}")
        if version >= OLDEST_LAMMPS
        else Finding("LAMMPS version", f"{version} is too old: {OLDEST_LAMMPS} or newer is needed", ok=False),
        Finding("MPI", _line(info, "MPI version: ")),
        Finding("FFT", _line(info, "FFT library = ")),
    ]
    if not lmp.has_package("GRANULAR"):
        findings.append(Finding("packages", "LAMMPS lacks GRANULAR; run ./bootstrap build", ok=False))
    compiled_in = lmp.has_style("fix", FIX_STYLE)
    try:
        load_plugin(lmp)
        findings.append(
            Finding(
                "plugin", "not needed, the package DUST is compiled in" if compiled_in else f"{find_plugin()}, loads"
            )
        )
    except LammpsMissing as error:
        findings.append(Finding("plugin", str(error), ok=False))
    if os.environ.get("LAMMPS_PLUGIN_PATH"):
        findings.append(Finding("LAMMPS_PLUGIN_PATH", os.environ["LAMMPS_PLUGIN_PATH"]))
    return findings


def _info(lmp: Any) -> list[str]:
    with scratch_folder(1000) as folder:
        path = folder / "info"
        lmp.command(f"info communication fft out overwrite {lammps_file(path, 'TMPDIR')}")
        return read_text(path).splitlines()


def _line(lines: list[str], start: str) -> str:
    for line in lines:
        if line.strip().startswith(start):
            return line.strip().removeprefix(start)
    return "none"


def _packages(*names: str) -> str:
    return ", ".join(f"{name} {_installed(name)}" for name in names)


def _installed(name: str) -> str:
    try:
        return metadata.version(name)
    except metadata.PackageNotFoundError:
        return "is not there"
