"""What one impact gives: one record with the keys of ``impact --json`` and of ``results.csv``, in that order."""

from __future__ import annotations

import csv
import json
import math
import os
import sys
from collections.abc import Iterable
from dataclasses import dataclass, field, fields
from html import escape
from io import StringIO
from operator import attrgetter
from pathlib import Path
from typing import Any, cast

from .about import about, described
from .errors import InvalidInput, shown
from .files import as_path, read_text, replace_file
from .impact import Impact
from .parameters import MEETING, SPREAD, Parameters


@dataclass(frozen=True, kw_only=True)
class Result(Parameters):
    """One finished impact: its parameters, then what came of it. SI units."""

    grains: int = field(metadata=about("grains on the carrier before the impact"))
    dispersion_ratio: float = field(
        metadata=about("dispersion ratio (detached over initial mass of the grains)", least=0.0, most=1.0)
    )
    north: float = field(
        metadata=about(
            "share of the north, away from the wall: n.(v_rebound - v_contact) > 0 (of the initial mass)",
            least=0.0,
            most=1.0,
        )
    )
    south: float = field(
        metadata=about(
            "share of the south, the side of the impact (of the initial mass); with north it makes the ratio",
            least=0.0,
            most=1.0,
        )
    )
    normal: float | None = field(
        metadata=about("share by lift-off normal to the surface (Eq. 2); empty in a resolved run", least=0.0, most=1.0)
    )
    tangential_mode: float | None = field(
        metadata=about("share by tangential lift-off (Eqs. 3-6); empty in a resolved run", least=0.0, most=1.0)
    )
    knocked: float | None = field(
        metadata=about(
            "share that others knocked off, with --meet; empty in a resolved run",
            least=0.0,
            most=1.0,
            since=MEETING,
        )
    )
    contact_time: float = field(
        metadata=about(
            "contact time (from the first step with a contact force to the first without)",
            unit="s",
            figure_unit="µs",
            factor=1e6,
        )
    )
    peak_acceleration: float = field(metadata=about("peak acceleration of the carrier", unit="m/s2"))
    restitution_realised: float = field(metadata=about("restitution realised (normal speed after over before)"))
    steps: int = field(metadata=about("time steps taken"))
    end: str = field(
        metadata=about(
            "why the run stopped: rebound or step limit; in a resolved run settled (no contact with the carrier has "
            "changed for 40 us) or limit"
        )
    )
    loop_seconds: float = field(metadata=about("LAMMPS' loop time", unit="s"))
    wall_seconds: float = field(metadata=about("time of the whole impact with set-up", unit="s"))
    lammps_version: int = field(metadata=about("version of LAMMPS (yyyymmdd)"))

    def _repr_html_(self) -> str:
        """For notebooks: what matters most."""
        rows = [line.split(maxsplit=1) for line in described_materials(self)]
        rows.insert(0, ["impact", f"{self.speed:g} m/s, {self.angle:g} degrees, restitution {self.restitution:g}"])
        rows.append(
            ["dispersion ratio", f"{self.dispersion_ratio:.4f}: south {self.south:.4f}, north {self.north:.4f}"]
        )
        cells = "".join(f"<tr><th>{escape(name)}</th><td>{escape(text)}</td></tr>" for name, text in rows)
        return f"<table>{cells}</table>"

    def columns(self) -> dict[str, str | bool | int | float | None]:
        """Every column by name, in order."""
        return {key: getattr(self, key) for key in KEYS}

    def to_json(self) -> str:
        """One JSON object, keys in the order of the fields."""
        return json.dumps(self.columns())

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
        return _filled({key: _value(key, values) for key in KEYS if key in values or key not in _NEWER})


#: what is known of each column
COLUMNS = described(Result)
#: those that are looked at first: on figures and in a report
MAIN_COLUMNS = (
    "dispersion_ratio",
    "north",
    "south",
    "normal",
    "tangential_mode",
    "knocked",
    "contact_time",
    "peak_acceleration",
)
#: in the order of the table: the time step beside the steps, and what is newer at the end
_PLACES = list(COLUMNS)
KEYS = tuple(
    sorted(
        COLUMNS,
        key=lambda key: (max(0, COLUMNS[key].since - SPREAD), _PLACES.index("steps" if key == "timestep" else key)),
    )
)
TYPES = {of.name: str(of.type) for of in fields(Result)}
#: of parameters that are newer than some records: they have the reference case's
_NEWER = frozenset(name for name, known in COLUMNS.items() if known.since)


def _filled(values: dict[str, Any]) -> Result:
    """A record with what it lacks, as it was when that was no parameter yet."""
    if not values.keys() >= _NEWER:
        reference = Impact(speed=1.0).values()
        made = values["hamaker"] / (18 * math.pi * values["z0"] ** 2)
        knocked = 0.0 if values["method"] == "functions" else None
        older = {**reference, "knocked": knocked, "wall_hamaker": values["hamaker"], "surface_energy": made}
        values = {**{name: older[name] for name in _NEWER}, **values}
    return Result(**values)


def _value(key: str, values: dict[str, Any]) -> str | bool | int | float | None:
    """The value of a key, if it is of the type that `Result` asks for."""
    if key not in values:
        raise InvalidInput(f"not a result: no key {key}")
    value, kind = values[key], TYPES[key]
    if value is None and kind.endswith("| None"):
        return None
    if kind.startswith("float") and type(value) in (int, float) and abs(value) <= sys.float_info.max:
        return float(value)
    if type(value).__name__ == kind and kind != "float":
        return cast("str | bool | int", value)
    raise InvalidInput(f"not a result: {key}: {shown(value)} is not of the type {kind}")


def described_materials(case: Parameters) -> list[str]:
    """What carrier, wall and grains are made of and how they adhere, a line each."""
    sizes = ""
    if case.distribution != "none":
        sizes = f" ({case.distribution}, {case.distribution_spread:g})"
    return [
        f"carrier            {case.carrier} of {case.carrier_diameter * 1e3:g} mm: {case.carrier_density:g} kg/m3, "
        f"{case.carrier_modulus / 1e9:.4g} GPa, Poisson {case.carrier_poisson:g}",
        f"wall               {case.wall}: {case.wall_modulus / 1e9:.4g} GPa, Poisson {case.wall_poisson:g}",
        f"grains             {case.grain} of {case.grain_diameter * 1e6:g} um{sizes}: {case.grain_density:g} kg/m3, "
        f"{case.grain_modulus / 1e9:.4g} GPa, Poisson {case.grain_poisson:g}",
        f"adhesion           surface energy {case.surface_energy * 1e3:.4g} mJ/m2 (A_12 {case.hamaker:.5g} J, "
        f"z0 {case.z0 * 1e9:g} nm), spread {case.spread:g}",
    ]


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
        missing = [key for key in KEYS if key not in (*(reader.fieldnames or ()), *_NEWER)]
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
        if key in _NEWER and key not in row:
            continue
        try:
            values[key] = _field(TYPES[key], row[key])
        except ValueError as error:
            raise InvalidInput(f"{path}: line {line}: {key}: {error}") from None
    return _filled(values)


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
