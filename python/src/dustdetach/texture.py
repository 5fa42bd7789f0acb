"""Textures: the grains that adhere to a carrier, as directions and diameters, and the text file they are kept in.

The core of the LAMMPS package judges such a file (``doc/texture.rst`` describes it), for the fix and for Python.
"""

from __future__ import annotations

import os
from ctypes import CDLL, POINTER, c_char_p, c_double, c_int, c_longlong, c_void_p, create_string_buffer
from dataclasses import dataclass
from functools import cache
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from .errors import InvalidInput, LammpsMissing, MachineFault
from .files import as_path, check_file, read_text, replace_file, scratch_folder, writable_file
from .impact import Impact, as_impact
from .places import find_core
from .session import lammps_file, lammps_session


@dataclass(frozen=True)
class Texture:
    """The grains of one carrier.

    Attributes:
        carrier_diameter: m.
        bare: half-angle of the bare cap, rad.
        bare_axis: unit vector (3,) to the middle of the bare cap.
        directions: unit vectors (N, 3) from the carrier's centre to the grains'.
        diameters: of the grains (N,), m.
        adhesion: factors of the grains' pull-off forces (N,), 1 without a spread.
    """

    carrier_diameter: float
    bare: float
    bare_axis: NDArray[np.float64]
    directions: NDArray[np.float64]
    diameters: NDArray[np.float64]
    adhesion: NDArray[np.float64]

    @property
    def centres(self) -> NDArray[np.float64]:
        """Centres of the grains (N, 3) with the carrier's at the origin, each grain touching the carrier, m."""
        return self.directions * ((self.carrier_diameter + self.diameters) / 2)[:, None]

    @property
    def coverage(self) -> float:
        """X0: summed cross-section of the grains over the carrier's surface."""
        return float(np.sum(self.diameters**2) / (4 * self.carrier_diameter**2))


#: in a texture file
BYTES_A_GRAIN = 120


def make_texture(impact: Impact, path: str | Path) -> None:
    """Make the texture of an impact (its coverage, bare cap, sizes, spread and seed) and write it to a file.

    The grains are placed by ``fix dust/detach``, so that an impact with the same parameters has the same ones.

    Args:
        impact: the parameters.
        path: the file.

    Raises:
        InvalidInput: the coverage cannot be placed, or there can be no file of this name.
        MachineFault: the disk is full.
    """
    impact = as_impact(impact, "make_texture")
    path = writable_file(as_path(path, "--out"), "--out")
    # LAMMPS takes no quote in a name, so it writes to another place
    with scratch_folder(BYTES_A_GRAIN * impact.grains) as folder:
        grains = folder / "texture"
        try:
            with lammps_session() as lmp:
                lmp.commands_list(_placement(impact, grains))
        except InvalidInput as error:
            if str(grains) in str(error):
                raise MachineFault(str(error)) from None
            raise
        text = read_text(grains)
    with replace_file(path) as part:
        part.write_text(text)


def _placement(impact: Impact, grains: Path) -> list[str]:
    """The commands that place the grains of an impact and write them to a file."""
    sizes = ""
    if impact.distribution != "none":
        sizes = f" distribution {impact.distribution} {impact.grain_diameter!r} {impact.distribution_spread!r}"
    side = f"-{impact.carrier_diameter!r} {impact.carrier_diameter!r}"
    return [
        "units si",
        "atom_style sphere",
        f"region box block {side} {side} {side}",
        "create_box 1 box",
        "create_atoms 1 single 0 0 0",
        f"set atom 1 diameter {impact.carrier_diameter!r}",
        f"fix dust all dust/detach texture monolayer {impact.grain_diameter!r} coverage {impact.coverage!r} "
        f"seed {impact.seed} bare {impact.bare!r} spread {impact.spread!r}{sizes} "
        f"write {lammps_file(grains, 'TMPDIR')}",
    ]


def read_texture(path: str | Path) -> Texture:
    """Read a texture file as the fix does: by the core, which also checks it against all rules of the format.

    Raises:
        InvalidInput: no such file, or it breaks a rule; the message names the line, or the grains.
        LammpsMissing: the core's library is not there.
    """
    path = as_path(path, "read_texture")
    check_file(path)
    core = load_core()
    message = create_string_buffer(1024)
    texture = core.dust_texture_read(os.fsencode(path), message, len(message))
    if not texture:
        raise InvalidInput(f"{path}: {message.value.decode('ascii', 'replace')}")
    try:
        half_angle, axis = c_double(), np.empty(3)
        core.dust_texture_bare(texture, half_angle, axis.ctypes.data_as(_NUMBERS))
        table = np.empty((core.dust_texture_grains(texture), 4))
        core.dust_texture_table(texture, table.ctypes.data_as(_NUMBERS))
        adhesion = np.empty(len(table))
        core.dust_texture_adhesion(texture, adhesion.ctypes.data_as(_NUMBERS))
        carrier_diameter = core.dust_texture_carrier_diameter(texture)
        return Texture(carrier_diameter, half_angle.value, axis, table[:, :3].copy(), table[:, 3].copy(), adhesion)
    finally:
        core.dust_texture_free(texture)


_NUMBERS = POINTER(c_double)


@cache
def load_core() -> CDLL:
    """The core's functions for texture files, see ``src/core/texture_c.h``.

    Raises:
        LammpsMissing: the library is not there, or is another one.
    """
    path = find_core()
    try:
        core = CDLL(str(path))
        for name, result, arguments in (
            ("read", c_void_p, (c_char_p, c_char_p, c_int)),
            ("carrier_diameter", c_double, (c_void_p,)),
            ("bare", None, (c_void_p, _NUMBERS, _NUMBERS)),
            ("grains", c_longlong, (c_void_p,)),
            ("table", None, (c_void_p, _NUMBERS)),
            ("adhesion", None, (c_void_p, _NUMBERS)),
            ("free", None, (c_void_p,)),
        ):
            function = getattr(core, f"dust_texture_{name}")
            function.restype, function.argtypes = result, arguments
    except (OSError, AttributeError) as error:
        raise LammpsMissing(f"the library {path} does not load: {error}; run ./bootstrap build") from None
    return core
