"""Materials by name, each number with its source: those of ``materials.toml`` beside this file, and the user's own."""

from __future__ import annotations

import difflib
import os
import tomllib
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

from .about import About, finite_number
from .errors import InvalidInput, shortened, shown
from .files import as_path, read_text

LIBRARY = Path(__file__).with_name("materials.toml")

#: the numbers of a material, in the order in which they are shown; the ranges are those of the fix
PROPERTIES = {
    "density": About(help="density", unit="kg/m3", least=10.0, most=30000.0),
    "modulus": About(help="Young's modulus", unit="Pa", least=1e6, most=1e13),
    "poisson": About(help="Poisson's ratio", above=-1.0, most=0.5),
    "hamaker": About(help="Hamaker constant of the material with its like", unit="J", least=1e-22, most=1e-17),
}
#: a material need not have one: the adhesion may be given otherwise
OPTIONAL = ("hamaker",)


@dataclass(frozen=True, kw_only=True)
class Material:
    """A material.

    Attributes:
        name: its first name.
        also: its other names.
        density: kg/m3.
        modulus: Young's modulus, Pa.
        poisson: Poisson's ratio.
        hamaker: Hamaker constant with its like, J; ``None`` if it is not known.
        sources: of each number, by its name.
    """

    name: str
    also: tuple[str, ...]
    density: float
    modulus: float
    poisson: float
    hamaker: float | None
    sources: Mapping[str, str]


#: where a number comes from whose source a user's file does not tell
USERS_OWN = "the user's file"

#: those of the user, by every name in small letters
_own: dict[str, Material] = {}


def materials() -> list[Material]:
    """All materials that are known, each once: the library's, then the user's."""
    return list({id(material): material for material in {**_library(), **_own}.values()}.values())


def is_known(name: str) -> bool:
    """Whether there is a material of this name."""
    return name.lower() in _own or name.lower() in _library()


def find_material(name: str, part: str) -> Material:
    """A material by one of its names, in capitals or small letters.

    Args:
        name: the name.
        part: the option that asks for it, for the message.

    Raises:
        InvalidInput: there is none of this name.
    """
    material = _own.get(name.lower()) or _library().get(name.lower())
    if material is None:
        known = {**_library(), **_own}
        near = difflib.get_close_matches(name.lower(), known, 1)
        meant = f" (did you mean {known[near[0]].name}?)" if near else ""
        allowed = ", ".join(each.name for each in materials())
        raise InvalidInput(f"--{part}: unknown material {shown(name)}{meant}; allowed: {allowed}")
    return material


def use_materials(path: str | Path) -> list[Material]:
    """Add the materials of a TOML file; those of known names replace them in this process.

    Raises:
        InvalidInput: no such file, not TOML, or a number that no material has; the message names file and key.
    """
    path = as_path(path, "--materials")
    if not os.path.lexists(path):
        raise InvalidInput(f"--materials: {path}: no such file; allowed: a TOML file of materials")
    found = _read(path)
    for material in found:
        _own.update(_by_names(material))
    return found


@cache
def _library() -> dict[str, Material]:
    return {name: material for material in _read(LIBRARY) for name, material in _by_names(material).items()}


def _by_names(material: Material) -> dict[str, Material]:
    return {name.lower(): material for name in (material.name, *material.also)}


def _read(path: Path) -> list[Material]:
    try:
        content = tomllib.loads(read_text(path))
    except (tomllib.TOMLDecodeError, RecursionError) as error:
        raise InvalidInput(f"{path}: not TOML: {str(error).splitlines()[0]}") from None
    try:
        return [_material(name, table) for name, table in content.items()]
    except InvalidInput as error:
        raise InvalidInput(f"{path}: {error}") from None


def _material(name: str, table: Any) -> Material:
    label = shortened(name, 60)
    if not isinstance(table, dict):
        raise InvalidInput(f"{label}: {shown(table)} is not a material; allowed: a table [{label}]")
    for key in table:
        if key not in (*PROPERTIES, "also"):
            raise InvalidInput(f"{label}: {shortened(key, 60)}: unknown key; allowed: {', '.join(PROPERTIES)}, also")
    also = table.get("also", [])
    if not (isinstance(also, list) and all(isinstance(word, str) for word in also)):
        raise InvalidInput(f"{label}: also: {shown(also)} is not a list of names")
    numbers: dict[str, float | None] = {}
    sources = {}
    for key, about in PROPERTIES.items():
        if key not in table and key in OPTIONAL:
            numbers[key] = None
            continue
        if key not in table:
            raise InvalidInput(f"{label}: {key}: missing; allowed: {about.allowed}")
        entry = table[key] if isinstance(table[key], dict) else {"value": table[key]}
        try:
            value = finite_number(key, entry.get("value"))
            about.check(key, value)
        except InvalidInput as error:
            raise InvalidInput(f"{label}: {str(error).removeprefix('--')}") from None
        numbers[key], sources[key] = value, str(entry.get("source", USERS_OWN))
    return Material(name=name, also=tuple(also), sources=sources, **numbers)  # type: ignore[arg-type]
