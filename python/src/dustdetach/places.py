"""Where LAMMPS' module, the plugin, the core and the decks are: by the environment, the checkout or an installation."""

from __future__ import annotations

import os
import sys
from functools import cache
from importlib import import_module
from pathlib import Path
from types import ModuleType

from .errors import LammpsMissing

PLUGIN = "dustplugin.so"
CORE = "libdustcore.so"


def _checkout() -> Path | None:
    """The source tree this package was installed from in editable mode, if so."""
    root = Path(__file__).resolve().parents[3]
    return root if (root / "lammps-inputs").is_dir() else None


def _shares() -> list[Path]:
    """Folders ``share/dustdetach`` of an installation, nearest first."""
    prefixes = [Path(sys.prefix), Path(os.path.expanduser("~/.local")), Path("/usr/local"), Path("/usr")]
    return [prefix / "share" / "dustdetach" for prefix in prefixes]


def plugin_places() -> list[Path]:
    """Files that may be the plugin, in the order in which they are tried."""
    places = []
    if named := os.environ.get("DUSTDETACH_PLUGIN"):
        return [Path(named)]
    for folder in os.environ.get("LAMMPS_PLUGIN_PATH", "").split(os.pathsep):
        if folder:
            places.append(Path(folder) / PLUGIN)
    if checkout := _checkout():
        places.append(checkout / "build" / "plugin" / PLUGIN)
    places += [prefix / "lib" / "lammps" / "plugins" / PLUGIN for prefix in (Path(sys.prefix), Path("/usr/local"))]
    return places


def deck_places() -> list[Path]:
    """Folders that may hold the decks, in the order in which they are tried."""
    if named := os.environ.get("DUSTDETACH_INPUTS"):
        return [Path(named)]
    places = []
    if checkout := _checkout():
        places.append(checkout / "lammps-inputs")
    return places + [share / "lammps-inputs" for share in _shares()]


@cache
def find_plugin() -> Path:
    """The plugin file.

    Raises:
        LammpsMissing: none of `plugin_places` exists.
    """
    places = plugin_places()
    for place in places:
        if place.is_file():
            return place.resolve()
    tried = ", ".join(map(str, places))
    raise LammpsMissing(f"no plugin {PLUGIN} (tried {tried}); run ./bootstrap build or set DUSTDETACH_PLUGIN")


@cache
def find_core() -> Path:
    """The library with the core's own judge of texture files, beside the plugin.

    Raises:
        LammpsMissing: it is beside none of `plugin_places`.
    """
    places = [place.resolve().with_name(CORE) for place in plugin_places()]
    for place in places:
        if place.is_file():
            return place
    tried = ", ".join(map(str, places))
    raise LammpsMissing(f"no library {CORE} (tried {tried}); run ./bootstrap build: it belongs beside {PLUGIN}")


def plugin_if_any() -> Path | None:
    """The plugin file, or ``None`` where the package is compiled into LAMMPS and there is no plugin."""
    try:
        return find_plugin()
    except LammpsMissing:
        return None


@cache
def find_deck(name: str) -> Path:
    """A deck of ``lammps-inputs``.

    Raises:
        LammpsMissing: none of `deck_places` holds it.
    """
    places = deck_places()
    for place in places:
        if (place / name).is_file():
            return (place / name).resolve()
    tried = ", ".join(map(str, places))
    raise LammpsMissing(f"no deck {name} (tried {tried}); set DUSTDETACH_INPUTS to the folder lammps-inputs")


@cache
def lammps_module() -> ModuleType:
    """LAMMPS' own Python module, which loads its library.

    Raises:
        LammpsMissing: it cannot be imported.
    """
    try:
        return import_module("lammps")
    except ImportError as error:
        raise LammpsMissing(
            f"no Python module lammps ({error}); start build/bin/dustdetach, or set PYTHONPATH to the folder "
            "'python' of the LAMMPS installation"
        ) from None


def lammps_library() -> Path:
    """The shared library that LAMMPS' Python module loads.

    Raises:
        LammpsMissing: the module is not there, or has no library beside it.
    """
    folder = Path(str(lammps_module().__file__)).parent
    for library in sorted(folder.glob("liblammps.*")):
        return library.resolve()
    raise LammpsMissing(f"no liblammps in {folder}; run ./bootstrap build, or 'make install-python' of your LAMMPS")
