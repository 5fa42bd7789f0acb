"""Dust detachment from carrier particles that hit a wall, with LAMMPS and its package DUST.

>>> from dustdetach import Impact, run
>>> round(run(Impact(speed=8.0, angle=60.0)).dispersion_ratio, 2)
0.69
"""

from typing import TYPE_CHECKING, Any

from .cases import figure4, figure5, read_cases
from .errors import DustError, InvalidInput, LammpsBusy, LammpsMissing, MachineFault, PackageMissing
from .impact import Impact
from .result import Result, read_csv
from .runner import run
from .sweeping import CasesFailed, sweep
from .tables import to_dataframe, write_parquet
from .version import __version__

if TYPE_CHECKING:
    from .texture import Texture

__all__ = [
    "CasesFailed",
    "DustError",
    "Impact",
    "InvalidInput",
    "LammpsBusy",
    "LammpsMissing",
    "MachineFault",
    "PackageMissing",
    "Result",
    "Texture",
    "__version__",
    "figure4",
    "figure5",
    "read_cases",
    "read_csv",
    "run",
    "sweep",
    "to_dataframe",
    "write_parquet",
]


def __getattr__(name: str) -> Any:
    """Textures are arrays, and numpy takes longer to import than all the rest: not before somebody asks for them."""
    if name == "Texture":
        from .texture import Texture

        return Texture
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
