"""Tables of the documentation, from the descriptions of parameters and columns and from the library of materials."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence

from .about import About
from .materials import PROPERTIES, materials
from .parameters import ABOUT, PARAMETER_TYPES, Parameters
from .result import COLUMNS, KEYS


def parameter_table() -> str:
    """Every parameter: its name, default, unit, range and meaning."""
    rows = [
        (f"``{name}``", _default(name, about), about.unit, about.allowed, about.help) for name, about in ABOUT.items()
    ]
    return _table(("parameter", "default", "unit", "allowed", "meaning"), rows, (18, 12, 8, 22, 40))


def _default(name: str, about: About) -> str:
    if about.follows:
        return about.follows
    default = getattr(Parameters, name, None)
    if default is None:
        return "must be given"
    return f"{default:g}" if isinstance(default, float) and PARAMETER_TYPES[name] == "float" else str(default)


def column_table() -> str:
    """Every column of ``results.csv`` in its order, and its unit."""
    rows = [(f"``{key}``", COLUMNS[key].unit or "-", COLUMNS[key].help) for key in KEYS]
    return _table(("column", "unit", "meaning"), rows, (22, 10, 68))


def material_table() -> str:
    """Every material of the library with its numbers; the sources are what ``dustdetach materials`` prints."""
    rows = []
    for material in materials():
        numbers = [getattr(material, key) for key in PROPERTIES]
        named = ", ".join((material.name, *material.also))
        rows.append((named, *("-" if number is None else f"{number:g}" for number in numbers)))
    titles = [f"{about.help} ({about.unit})" if about.unit else about.help for about in PROPERTIES.values()]
    return _table(("material", *titles), rows, (40, 15, 15, 15, 15))


TABLES: dict[str, Callable[[], str]] = {
    "parameters": parameter_table,
    "columns": column_table,
    "materials": material_table,
}


def _table(titles: Sequence[str], rows: Iterable[Sequence[str]], widths: Sequence[int]) -> str:
    """A list-table of reStructuredText."""
    lines = [".. list-table::", "   :header-rows: 1", f"   :widths: {' '.join(map(str, widths))}", ""]
    for row in (titles, *rows):
        for index, cell in enumerate(row):
            lines.append(f"   {'* -' if index == 0 else '  -'} {cell}")
    return "\n".join([*lines, ""])
