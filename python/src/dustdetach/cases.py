"""Lists of impacts: the sweeps of the paper's Figs. 4 and 5, and sweeps described in a TOML file."""

from __future__ import annotations

import math
import os
import tomllib
from dataclasses import replace
from itertools import product
from pathlib import Path
from typing import Any

from .errors import InvalidInput, shortened, shown
from .files import as_path, read_text
from .impact import METHODS, PARAMETERS, Impact

#: impact speeds of both figures, m/s: dense where the near side lets go (1-4) and the far side begins (5-8)
SPEEDS = (
    *(0.5, 1.0, 1.5, 2.0, 2.5, 3.0, 3.5, 4.0, 4.5, 5.0, 5.5, 6.0, 6.5, 7.0, 7.5, 8.0),
    *(9.0, 10.0, 11.0, 12.0, 13.0, 14.0, 16.0, 18.0, 20.0),
)
RESTITUTIONS = (0.5, 0.7, 0.9)
ANGLES = (15.0, 30.0, 45.0, 60.0, 75.0, 90.0)
#: laws of tangential lift-off in both figures: the impulse law and the paper's
LAWS = ("impulse", "estimate")

#: the most cases that one file may ask for
MOST_CASES = 1_000_000


def figure4() -> list[Impact]:
    """Straight impacts at three coefficients of restitution (the paper's Fig. 4) by two laws of tangential lift-off."""
    return [
        Impact(speed=speed, restitution=e, tangential=law) for law in LAWS for e in RESTITUTIONS for speed in SPEEDS
    ]


def figure5() -> list[Impact]:
    """Oblique impacts at e_pw = 0.7 (the paper's Fig. 5) by two laws of tangential lift-off; 90 degrees is straight."""
    return [Impact(speed=speed, angle=angle, tangential=law) for law in LAWS for angle in ANGLES for speed in SPEEDS]


NAMED = {"figure4": figure4, "figure5": figure5}


def named_or_file(name: str) -> list[Impact]:
    """The cases of ``figure4``, ``figure5`` or of a TOML file.

    Raises:
        InvalidInput: neither a known sweep nor a readable file, or something in the file is wrong.
    """
    if name in NAMED:
        return NAMED[name]()
    return read_cases(name)


def with_methods(cases: list[Impact], method: str | None) -> list[Impact]:
    """The cases by another method, or by ``both`` (first all by functions, in seconds); as they are for ``None``.

    A resolved run stands for all laws of tangential lift-off.

    Raises:
        InvalidInput: no such method, or a case that the method does not take.
    """
    if method is None:
        return cases
    if method not in (*METHODS, "both"):
        raise InvalidInput(f"--method: unknown choice {shown(method)}; allowed: {', '.join(METHODS)}, both")
    chosen = METHODS if method == "both" else (method,)
    return list(dict.fromkeys(_by(name, case) for name in chosen for case in cases))


def _by(method: str, case: Impact) -> Impact:
    law = Impact.tangential if method == "resolved" else case.tangential
    return replace(case, method=method, tangential=law)


def read_cases(path: str | Path) -> list[Impact]:
    """Read a sweep from a TOML file.

    Each key is a parameter of `Impact` with one value or a list of values; every combination is a case. Tables
    ``[[case]]`` may follow: each replaces some of the keys above, and the sweep is what all of them make together.

        speed = [2, 4, 8]
        restitution = 0.7
        [[case]]
        angle = 90
        [[case]]
        angle = [30, 60]
        wall_friction = [0.05, 0.3]

    Raises:
        InvalidInput: no such file, not TOML, an unknown key, a value out of range; the message names file and key.
    """
    path = as_path(path, "read_cases")
    if not os.path.lexists(path):
        raise InvalidInput(f"{path}: no such file; allowed: {', '.join(NAMED)} or the name of a TOML file")
    text = read_text(path)
    try:
        content = tomllib.loads(text)
    except RecursionError:
        raise InvalidInput(f"{path}: not TOML that can be read: nested too deeply") from None
    except tomllib.TOMLDecodeError as error:
        raise InvalidInput(f"{path}: not TOML: {str(error).splitlines()[0]}") from None
    except ValueError:
        # Python takes no whole number of more than 4300 digits
        raise InvalidInput(f"{path}: a number of too many digits") from None

    tables = content.pop("case", [{}])
    if not (isinstance(tables, list) and tables and all(isinstance(table, dict) for table in tables)):
        raise InvalidInput(f"{path}: case: allowed: tables [[case]]")
    try:
        sweeps = [_lists({**content, **table}) for table in tables]
        count = sum(math.prod(map(len, lists.values())) for lists in sweeps)
        if count > MOST_CASES:
            raise InvalidInput(f"{shown(count)} cases; allowed: at most {MOST_CASES}")
        cases = [impact for lists in sweeps for impact in _combinations(lists)]
    except InvalidInput as error:
        raise InvalidInput(f"{path}: {error}") from None
    return list(dict.fromkeys(cases))


def _lists(values: dict[str, Any]) -> dict[str, list[Any]]:
    """The values of each key of a table, a single one as a list of one."""
    for name in values:
        if name not in PARAMETERS:
            raise InvalidInput(f"{shortened(name, 60)}: unknown key; allowed: {', '.join(PARAMETERS)}, case")
    lists = {name: value if isinstance(value, list) else [value] for name, value in values.items()}
    for name, entries in lists.items():
        if not entries:
            raise InvalidInput(f"{name}: empty list")
    return lists


def _combinations(lists: dict[str, list[Any]]) -> list[Impact]:
    return [Impact.from_mapping(dict(zip(lists, chosen, strict=True))) for chosen in product(*lists.values())]
