"""What is known of each number that goes into an impact or comes out of it, told once.

`Impact` and `Result` are made of fields that carry an `About`. From it follow the check of a value, the option of the
command and its help, the keys of a sweep's TOML file and their JSON Schema, the variables of the decks, the columns of
``results.csv``, the words of plots, and the tables of the documentation.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import Field, dataclass, field, fields
from typing import Any

from .errors import InvalidInput, shown

#: below it products of parameters are too small for floating-point numbers
SMALLEST = 1e-60

_KEY = "about"


class Derived(float):
    """A number that nobody has given and that follows from others; `dataclasses.replace` lets it follow again."""

    __slots__ = ()


class DerivedWord(str):
    """A word that nobody has given."""

    __slots__ = ()


#: the default of a number that follows from others
FOLLOWS = Derived(math.nan)


def given(value: object) -> bool:
    """Whether a value comes from the user, and not from other parameters."""
    return not isinstance(value, (Derived, DerivedWord))


@dataclass(frozen=True, kw_only=True)
class About:
    """What is known of a number or word.

    Attributes:
        help: what it is, in a line.
        unit: as users read it; empty for a ratio or a word.
        above, least, most, below: the ends of its range; at most one of each pair.
        limit: what the upper end is, where a number alone would not tell.
        choices: of a word.
        follows: how its default follows from others; empty if the default is a value.
        methods: the methods that use it.
        deck: whether the decks take it as a variable as it is; under its own name but for those in `variables`, which
            are by method.
        title: of an axis, where the help is too long for one.
        symbol: in figures, in matplotlib's mathematics; empty if it does not stand in figures.
        figure_unit: in figures, if not `unit`, and ``factor`` to it.
        since: 0 if it is in all records; records before this version of theirs had its default.
    """

    help: str
    unit: str = ""
    above: float | None = None
    least: float | None = None
    most: float | None = None
    below: float | None = None
    limit: str = ""
    choices: tuple[str, ...] = ()
    follows: str = ""
    methods: tuple[str, ...] = ("functions", "resolved")
    deck: bool = True
    variables: Mapping[str, str] = field(default_factory=dict)
    title: str = ""
    symbol: str = ""
    figure_unit: str = ""
    factor: float = 1.0
    since: int = 0

    @property
    def allowed(self) -> str:
        """The range in words."""
        if self.choices:
            return ", ".join(self.choices)
        unit = f"{self.unit}{', ' if self.unit and self.limit else ''}{self.limit}"
        high = self.most if self.most is not None else self.below
        if self.above is not None and high is not None:
            end = "at most" if self.most is not None else "below"
            return f"above {self.above:g} and {end} {high:g} {unit}".rstrip()
        if self.least is not None and high is not None:
            return f"{self.least:g} {'to' if self.most is not None else 'to below'} {high:.9g} {unit}".rstrip()
        if self.least is not None or self.above is not None:
            return f"{f'at least {self.least:g}' if self.above is None else f'above {self.above:g}'} {unit}".rstrip()
        return f"any{' number' if not self.unit else ''} {unit}".rstrip()

    def check(self, name: str, value: float | str) -> None:
        """Refuse a value out of its range.

        Raises:
            InvalidInput: the message names the option and the range.
        """
        if isinstance(value, str):
            if self.choices and value not in self.choices:
                raise InvalidInput(f"{option(name)}: unknown choice {shown(value)}; allowed: {self.allowed}")
            return
        low = -math.inf if self.least is None else self.least
        high = math.inf if self.most is None else self.most
        inside = low <= value <= high
        if self.above is not None:
            inside = inside and value > self.above
        if self.below is not None:
            inside = inside and value < self.below
        if not inside:
            number = f"{value:g}" if self.above is not None else f"{value:.10g}"
            raise InvalidInput(f"{option(name)}: {number} is out of range; allowed: {self.allowed}")
        if self.above == 0 and value < SMALLEST:
            raise InvalidInput(
                f"{option(name)}: {value:g} is too small to compute with; allowed: at least {SMALLEST:g}"
            )

    def words(self, value: object) -> str:
        """The value as a figure's legend writes it: with symbol and unit."""
        if isinstance(value, bool):
            text = "yes" if value else "no"
        elif isinstance(value, float):
            text = f"{value * self.factor:.4g}"
        else:
            text = str(value)
        unit = self.figure_unit or self.unit
        gap = "" if unit == "°" else " "
        return f"{self.symbol} = {text}{gap + unit if unit else ''}" if "$" in self.symbol else f"{self.symbol} {text}"

    @property
    def axis(self) -> str:
        """The title of an axis: what it is, symbol, unit."""
        unit = self.figure_unit or self.unit
        symbol = f" {self.symbol}" if "$" in self.symbol else ""
        text = self.title or self.help.split(";")[0].split(" (")[0]
        return f"{text[0].upper()}{text[1:]}{symbol}" + (f" ({unit})" if unit else "")


def about(help: str, **known: Any) -> dict[str, About]:
    """Metadata of a dataclass' field."""
    return {_KEY: About(help=help, **known)}


def about_field(of: Field[Any]) -> About:
    """What a field was told with `about`."""
    known = of.metadata[_KEY]
    assert isinstance(known, About)
    return known


def described(record: type) -> dict[str, About]:
    """The fields of a dataclass that carry an `About`, in their order."""
    return {of.name: about_field(of) for of in fields(record) if _KEY in of.metadata}


def option(name: str) -> str:
    """The command-line option of a parameter: ``grain_diameter`` -> ``--grain-diameter``."""
    return "--" + name.replace("_", "-")


def converted(name: str, kind: str, value: Any) -> str | bool | int | float:
    """The value as its field's type; numbers may come as any kind of number, numpy's included.

    Args:
        name: of the parameter.
        kind: ``str``, ``bool``, ``int`` or ``float``.
        value: what was given.

    Raises:
        InvalidInput: it is of another kind, or not finite.
    """
    if kind == "str":
        if not isinstance(value, str):
            raise InvalidInput(f"{option(name)}: {shown(value)} is not a word")
        return value if isinstance(value, DerivedWord) else str(value)
    if kind == "bool":
        if not _is_truth(value):
            raise InvalidInput(f"{option(name)}: {shown(value)} is not true or false")
        return bool(value)
    number = finite_number(name, value)
    if kind == "int":
        if int(value) != number:
            raise InvalidInput(f"{option(name)}: {number:g} is not a whole number")
        return int(value)
    return number


def _is_truth(value: object) -> bool:
    """Whether it is true or false, numpy's included (whose name has changed)."""
    return isinstance(value, bool) or type(value).__name__ in ("bool_", "bool")


def finite_number(name: str, value: Any) -> float:
    """A number of any kind as a plain one.

    Raises:
        InvalidInput: it is none, or not finite.
    """
    if type(value) is float and math.isfinite(value):
        return value
    listed = getattr(value, "ndim", 0) > 0
    if listed or isinstance(value, (str, bytes, bytearray)) or _is_truth(value):
        raise InvalidInput(f"{option(name)}: {shown(value)} is not a number")
    try:
        number = float(value)
    except (TypeError, ValueError, OverflowError):
        raise InvalidInput(f"{option(name)}: {shown(value)} is not a finite number") from None
    if not math.isfinite(number):
        raise InvalidInput(f"{option(name)}: {number} is not a finite number")
    return number
