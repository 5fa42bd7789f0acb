"""Results as tables of other packages: a DataFrame of pandas, a file of Parquet, with the columns' units."""

from __future__ import annotations

from collections.abc import Iterable
from importlib import import_module
from pathlib import Path
from types import ModuleType
from typing import Any

from .errors import InvalidInput, PackageMissing, shown
from .files import as_path, replace_file, writable_file
from .result import COLUMNS, KEYS, TYPES, Result

#: unit of each column that has one
UNITS = {key: COLUMNS[key].unit for key in KEYS if COLUMNS[key].unit}

PARQUET = "results.parquet"


def to_dataframe(results: Iterable[Result]) -> Any:
    """The results as a ``pandas.DataFrame``, a row each, columns as in ``results.csv``.

    Its ``attrs["units"]`` has the unit of each column that has one, its ``attrs["help"]`` what each is.

    Raises:
        PackageMissing: pandas is not there.
    """
    pandas = _package("pandas")
    frame = pandas.DataFrame([result.columns() for result in _checked(results)], columns=list(KEYS))
    frame.attrs["units"] = dict(UNITS)
    frame.attrs["help"] = {key: COLUMNS[key].help for key in KEYS}
    return frame


def write_parquet(path: str | Path, results: Iterable[Result]) -> Path:
    """Write the results as Parquet; each column's unit and meaning are in the metadata of its field.

    Returns:
        The file.

    Raises:
        PackageMissing: pyarrow is not there.
    """
    path = writable_file(as_path(path, "--parquet"), "--parquet")
    arrow = _package("pyarrow")
    rows = [result.columns() for result in _checked(results)]
    kinds = {"float": arrow.float64(), "int": arrow.int64(), "str": arrow.string(), "bool": arrow.bool_()}
    types = {key: kinds[TYPES[key].removesuffix(" | None")] for key in KEYS}
    fields = [
        arrow.field(key, types[key], metadata={"unit": COLUMNS[key].unit, "description": COLUMNS[key].help})
        for key in KEYS
    ]
    table = arrow.Table.from_pylist(rows, schema=arrow.schema(fields))
    with replace_file(path) as part:
        import_module("pyarrow.parquet").write_table(table, part)
    return path


def _checked(results: Iterable[Result]) -> list[Result]:
    listed = list(results)
    for result in listed:
        if not isinstance(result, Result):
            raise InvalidInput(f"{shown(result)} is not a Result")
    return listed


def _package(name: str) -> ModuleType:
    try:
        return import_module(name)
    except ImportError:
        raise PackageMissing(f"no Python package {name}; pip install 'dustdetach[tables]'") from None
