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
from .impact import Impact
from .parameters import ABOUT, METHODS, PARAMETER_TYPES, PARAMETERS
from .ranges import RANGE_SCHEMAS, SAMPLING_SCHEMA, Sampling, is_distribution, listed, take_sampling

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
    if (method, law) == (case.method, case.tangential):
        return case
    return replace(case, method=method, tangential=law)


def read_cases(path: str | Path) -> list[Impact]:
    """Read a sweep from a TOML file.

    Each key is a parameter of `Impact` with one value, a list, a range, replicas or a distribution; all combinations
    are cases. Tables ``[[case]]`` may follow: each replaces some of the keys above, and the sweep is what all of them
    make together.

        speed = { from = 2, to = 8, steps = 4 }
        restitution = 0.7
        seed = { replicas = 3 }
        [[case]]
        angle = 90
        [[case]]
        angle = [30, 60]
        wall_friction = [0.05, 0.3]

    Keys with a distribution, such as ``z0 = { uniform = [0.3e-9, 0.5e-9] }``, are drawn together, ``samples`` times,
    for each combination of the others; see `dustdetach.ranges`.

    Raises:
        InvalidInput: no such file, not TOML, an unknown key, a value out of range; the message names file and key.
    """
    path = as_path(path, "read_cases")
    return _cases_of(path, read_toml(path, f"{', '.join(NAMED)} or the name of a TOML file"))


def read_toml(path: Path, allowed: str) -> dict[str, Any]:
    """The content of a TOML file.

    Raises:
        InvalidInput: no such file, or not TOML; the message names it.
    """
    if not os.path.lexists(path):
        raise InvalidInput(f"{path}: no such file; allowed: {allowed}")
    text = read_text(path)
    try:
        return tomllib.loads(text)
    except RecursionError:
        raise InvalidInput(f"{path}: not TOML that can be read: nested too deeply") from None
    except tomllib.TOMLDecodeError as error:
        raise InvalidInput(f"{path}: not TOML: {str(error).splitlines()[0]}") from None
    except ValueError:
        # Python takes no whole number of more than 4300 digits
        raise InvalidInput(f"{path}: a number of too many digits") from None


def _cases_of(path: Path, content: dict[str, Any]) -> list[Impact]:
    tables = content.pop("case", [{}])
    if not (isinstance(tables, list) and tables and all(isinstance(table, dict) for table in tables)):
        raise InvalidInput(f"{path}: case: allowed: tables [[case]]")
    try:
        sampling = take_sampling(content)
        sweeps = [_Sweep({**content, **table}, sampling) for table in tables]
        count = sum(sweep.count for sweep in sweeps)
        if count > MOST_CASES:
            raise InvalidInput(f"{shown(count)} cases; allowed: at most {MOST_CASES}")
        cases = [impact for sweep in sweeps for impact in sweep.impacts()]
    except InvalidInput as error:
        raise InvalidInput(f"{path}: {error}") from None
    return list(dict.fromkeys(cases))


class _Sweep:
    """What one table makes: all combinations of the lists, each with all samples of the distributions."""

    def __init__(self, values: dict[str, Any], sampling: Sampling) -> None:
        for name in values:
            if name not in PARAMETERS:
                allowed = ", ".join((*PARAMETERS, "samples", "sampling", "sampling_seed", "case"))
                raise InvalidInput(f"{shortened(name, 60)}: unknown key; allowed: {allowed}")
        self._drawn = {name: value for name, value in values.items() if is_distribution(value)}
        self._lists = {name: listed(name, value) for name, value in values.items() if name not in self._drawn}
        self._sampling = sampling
        self.count = math.prod(map(len, self._lists.values())) * (sampling.number if self._drawn else 1)

    def impacts(self) -> list[Impact]:
        """All of them."""
        samples: list[dict[str, float]] = self._sampling.draw(self._drawn) if self._drawn else [{}]
        return [
            Impact.from_mapping({**dict(zip(self._lists, chosen, strict=True)), **sample})
            for chosen in product(*self._lists.values())
            for sample in samples
        ]


def json_schema() -> dict[str, Any]:
    """JSON Schema of the TOML files that `read_cases` reads, from the descriptions of the parameters."""
    keys = {name: _schema_of(name) for name in PARAMETERS}
    table = {"type": "object", "properties": keys, "additionalProperties": False}
    return {
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "title": "sweep of dustdetach",
        "type": "object",
        "properties": {**keys, **SAMPLING_SCHEMA, "case": {"type": "array", "minItems": 1, "items": table}},
        "additionalProperties": False,
    }


def _schema_of(name: str) -> dict[str, Any]:
    """A value, a list of them, or, of a number, a range or a distribution."""
    about, kind = ABOUT[name], PARAMETER_TYPES[name]
    types = {"float": "number", "int": "integer", "str": "string", "bool": "boolean"}
    one: dict[str, Any] = {"type": types[kind]}
    if about.choices:
        one["enum"] = list(about.choices)
    ends = {"minimum": about.least, "exclusiveMinimum": about.above, "maximum": about.most}
    one |= {key: end for key, end in {**ends, "exclusiveMaximum": about.below}.items() if end is not None}
    unit = f", {about.unit}" if about.unit else ""
    forms = [one, {"type": "array", "minItems": 1, "items": one}, *(RANGE_SCHEMAS if kind in ("float", "int") else ())]
    return {"description": about.help + unit, "anyOf": forms}
