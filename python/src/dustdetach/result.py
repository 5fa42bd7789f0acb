"""What one impact gives: one record with the keys of ``impact --json`` and of ``results.csv``, in that order."""

from __future__ import annotations

import csv
import json
from collections.abc import Iterable
from dataclasses import asdict, dataclass, fields
from pathlib import Path
from typing import Any

from .errors import InvalidInput
from .files import replace_file


@dataclass(frozen=True, kw_only=True)
class Result:
    """One finished impact. SI units; the parameters are those of `Impact`, the rest as follows.

    Attributes:
        grains: grains on the carrier before the impact.
        dispersion_ratio: detached over initial grain mass.
        north: share of it from the side away from the wall, n.(v_rebound - v_contact) > 0.
        south: share of it from the side of the impact; north + south = dispersion_ratio.
        normal: share of it by lift-off normal to the surface (Eq. 2), ``None`` in a resolved run.
        tangential_mode: share of it by tangential lift-off (Eqs. 3-6), ``None`` in a resolved run.
        contact_time: from the first step with a contact force to the first without, s.
        peak_acceleration: largest magnitude of the carrier's acceleration, m/s2.
        restitution_realised: normal speed after over normal speed before.
        steps: time steps taken.
        end: why the run stopped: ``rebound`` or ``step limit``; in a resolved run ``settled`` (no contact with the
            carrier has changed for 40 us) or ``limit``.
        loop_seconds: LAMMPS' loop time, s.
        wall_seconds: the whole impact with set-up, s.
        lammps_version: as LAMMPS counts it, yyyymmdd.
    """

    method: str
    speed: float
    angle: float
    restitution: float
    coverage: float
    bare: float
    grain_diameter: float
    carrier_diameter: float
    hamaker: float
    z0: float
    friction: float
    wall_friction: float
    grain_damping: float
    seed: int
    tangential: str
    rotation: bool
    grains: int
    dispersion_ratio: float
    north: float
    south: float
    normal: float | None
    tangential_mode: float | None
    contact_time: float
    peak_acceleration: float
    restitution_realised: float
    timestep: float
    steps: int
    end: str
    loop_seconds: float
    wall_seconds: float
    lammps_version: int

    def to_json(self) -> str:
        """One JSON object, keys in the order of the fields."""
        return json.dumps(asdict(self))

    @classmethod
    def from_json(cls, text: str) -> Result:
        """The record that `to_json` wrote."""
        return cls(**json.loads(text))


KEYS = tuple(field.name for field in fields(Result))
_TYPES = {field.name: str(field.type) for field in fields(Result)}


def write_csv(path: Path, results: Iterable[Result]) -> None:
    """Write one row a case, complete or not at all; an absent value is an empty field."""
    with replace_file(path) as part, open(part, "w", newline="") as stream:
        writer = csv.DictWriter(stream, KEYS, lineterminator="\n")
        writer.writeheader()
        writer.writerows(asdict(result) for result in results)


def read_csv(path: Path) -> list[Result]:
    """Read the rows that `write_csv` wrote.

    Raises:
        InvalidInput: no such file, a missing column, or a field that is not of its column's type.
    """
    if not path.is_file():
        raise InvalidInput(f"{path}: no such file; run 'dustdetach sweep' into this folder first")
    with open(path, newline="") as stream:
        reader = csv.DictReader(stream)
        missing = [key for key in KEYS if key not in (reader.fieldnames or ())]
        if missing:
            raise InvalidInput(f"{path}: no column {missing[0]}")
        return [_row(path, reader.line_num, row) for row in reader]


def _row(path: Path, line: int, row: dict[str, Any]) -> Result:
    try:
        return Result(**{key: _field(_TYPES[key], row[key]) for key in KEYS})
    except (TypeError, ValueError) as error:
        raise InvalidInput(f"{path}: line {line}: {error}") from None


def _field(kind: str, text: str) -> Any:
    if kind.endswith("| None") and text == "":
        return None
    if kind == "bool":
        if text not in ("True", "False"):
            raise ValueError(f"{text!r} is not True or False")
        return text == "True"
    return {"str": str, "int": int}.get(kind, float)(text)
