"""What one impact gives: one record with the keys of ``impact --json`` and of ``results.csv``, in that order."""

from __future__ import annotations

import csv
import json
import math
import os
import sys
from collections.abc import Iterable
from dataclasses import MISSING, dataclass, fields
from io import StringIO
from operator import attrgetter
from pathlib import Path
from typing import Any, cast

from .errors import InvalidInput, shown
from .files import as_path, read_text, replace_file


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
    spread: float = 1.0
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
        return json.dumps({key: getattr(self, key) for key in KEYS})

    @classmethod
    def from_json(cls, text: str) -> Result:
        """The record that `to_json` wrote.

        Raises:
            InvalidInput: the text is cut, or is another one.
        """
        try:
            values = json.loads(text)
        except (ValueError, RecursionError):
            raise InvalidInput("not a result: cut, or no JSON") from None
        if not isinstance(values, dict):
            raise InvalidInput(f"not a result: {shown(values)} is not an object")
        checked: dict[str, Any] = {key: _value(key, values) for key in KEYS if key in values or key not in _DEFAULTS}
        return cls(**checked)


KEYS = tuple(field.name for field in fields(Result))
_TYPES = {field.name: str(field.type) for field in fields(Result)}
#: of parameters that are newer than some records
_DEFAULTS = {field.name: field.default for field in fields(Result) if field.default is not MISSING}


def _value(key: str, values: dict[str, Any]) -> str | bool | int | float | None:
    """The value of a key, if it is of the type that `Result` asks for."""
    if key not in values:
        raise InvalidInput(f"not a result: no key {key}")
    value, kind = values[key], _TYPES[key]
    if value is None and kind.endswith("| None"):
        return None
    if kind.startswith("float") and type(value) in (int, float) and abs(value) <= sys.float_info.max:
        return float(value)
    if type(value).__name__ == kind and kind != "float":
        return cast("str | bool | int", value)
    raise InvalidInput(f"not a result: {key}: {shown(value)} is not of the type {kind}")


def write_csv(path: Path, results: Iterable[Result]) -> None:
    """Write one row a case, complete or not at all; an absent value is an empty field."""
    with replace_file(path) as part, open(part, "w", newline="", encoding="utf-8") as stream:
        writer = csv.writer(stream, lineterminator="\n")
        writer.writerow(KEYS)
        writer.writerows(map(attrgetter(*KEYS), results))


def read_csv(path: str | Path) -> list[Result]:
    """Read the rows that `write_csv` wrote.

    Raises:
        InvalidInput: no such file, a missing column, or a field that is not of its column's type.
    """
    path = as_path(path, "read_csv")
    if not os.path.lexists(path):
        raise InvalidInput(f"{path}: no such file; run 'dustdetach sweep' into this folder first")
    reader = csv.DictReader(StringIO(read_text(path), newline=""))
    try:
        missing = [key for key in KEYS if key not in (*(reader.fieldnames or ()), *_DEFAULTS)]
        if missing:
            raise InvalidInput(f"{path}: no column {missing[0]}")
        return [_row(path, reader.line_num, row) for row in reader]
    except csv.Error as error:
        raise InvalidInput(f"{path}: line {reader.reader.line_num}: {error}") from None


def _row(path: Path, line: int, row: dict[Any, Any]) -> Result:
    if None in row:
        raise InvalidInput(f"{path}: line {line}: more fields than columns")
    values = {}
    for key in KEYS:
        if key in _DEFAULTS and key not in row:
            continue
        try:
            values[key] = _field(_TYPES[key], row[key])
        except ValueError as error:
            raise InvalidInput(f"{path}: line {line}: {key}: {error}") from None
    return Result(**values)


def _field(kind: str, text: str | None) -> Any:
    if text is None:
        raise ValueError("the line is cut")
    if kind.endswith("| None") and text == "":
        return None
    if kind == "str":
        return text
    if kind == "bool":
        if text not in ("True", "False"):
            raise ValueError(f"{shown(text)} is not True or False")
        return text == "True"
    try:
        number = int(text) if kind == "int" else float(text)
        finite = math.isfinite(number)
    except (ValueError, OverflowError):
        finite = False
    if not finite:
        raise ValueError(f"{shown(text)} is not a {'whole' if kind == 'int' else 'finite'} number")
    return number
