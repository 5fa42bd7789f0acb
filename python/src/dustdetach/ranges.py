"""Values of a parameter in a sweep: lists, ranges, replicas over seeds, and distributions of uncertain inputs.

========================================  =====================================================================
``[2, 4, 8]``                             these
``{ from = 2, to = 8, steps = 4 }``       2, 4, 6, 8; with ``scale = "log"`` by equal factors
``{ from = 2, to = 8, by = 2 }``          2, 4, 6, 8
``{ replicas = 5 }``                      1 to 5, of ``seed``; ``first = 11`` begins there
``{ uniform = [low, high] }``             evenly between both
``{ normal = [mean, deviation] }``        normal
``{ lognormal = [median, deviation] }``   log-normal by its geometric standard deviation
========================================  =====================================================================

The keys with a distribution are drawn together: ``samples`` times (64) by ``sampling = "latin hypercube"`` or
``"sobol"`` from ``sampling_seed`` (1).
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from .about import finite_number
from .errors import InvalidInput, shown

if TYPE_CHECKING:
    from numpy import float64
    from numpy.typing import NDArray

DISTRIBUTIONS = ("uniform", "normal", "lognormal")
SAMPLINGS = ("latin hypercube", "sobol")

#: the most values of one range, and the most samples
MOST = 100_000

FORMS = (
    "a value, a list, {from, to, steps}, {from, to, by}, {replicas}, {uniform = [low, high]}, "
    "{normal = [mean, deviation]} or {lognormal = [median, deviation]}"
)

_PAIR = {"type": "array", "items": {"type": "number"}, "minItems": 2, "maxItems": 2}
_NUMBER = {"type": "number"}

#: of a parameter that is a number
RANGE_SCHEMAS: list[dict[str, Any]] = [
    {
        "type": "object",
        "properties": {
            "from": _NUMBER,
            "to": _NUMBER,
            "steps": {"type": "integer", "minimum": 1},
            "by": _NUMBER,
            "scale": {"enum": ["linear", "log"]},
        },
        "required": ["from", "to"],
        "additionalProperties": False,
    },
    {
        "type": "object",
        "properties": {"replicas": {"type": "integer", "minimum": 1}, "first": {"type": "integer"}},
        "required": ["replicas"],
        "additionalProperties": False,
    },
    *(
        {"type": "object", "properties": {kind: _PAIR}, "required": [kind], "additionalProperties": False}
        for kind in DISTRIBUTIONS
    ),
]
#: of the keys that say how distributions are drawn
SAMPLING_SCHEMA: dict[str, Any] = {
    "samples": {"type": "integer", "minimum": 1, "maximum": MOST},
    "sampling": {"enum": list(SAMPLINGS)},
    "sampling_seed": {"type": "integer", "minimum": 0},
}


def is_distribution(value: Any) -> bool:
    """Whether a value of a key is to be drawn."""
    return isinstance(value, dict) and len(value) == 1 and next(iter(value)) in DISTRIBUTIONS


def listed(name: str, value: Any) -> list[Any]:
    """The values of a key, a single one as a list of one.

    Raises:
        InvalidInput: none, or a range that is wrong.
    """
    if isinstance(value, dict):
        if "replicas" in value:
            return _replicas(name, value)
        if "from" in value or "to" in value:
            return _range(name, value)
        if set(value) & {"steps", "by", "scale", "first", *DISTRIBUTIONS}:
            raise InvalidInput(f"{name}: {shown(value)}; allowed: {FORMS}")
        # what else is no number says so where it is checked
        return [value]
    values = value if isinstance(value, list) else [value]
    if not values:
        raise InvalidInput(f"{name}: empty list")
    return values


def _number(name: str, key: str, value: Any) -> float:
    try:
        return finite_number(name, value)
    except InvalidInput as error:
        raise InvalidInput(f"{name}: {key}: {str(error).split(': ', 1)[1]}") from None


def _whole(name: str, key: str, value: Any, least: int) -> int:
    if not isinstance(value, int) or isinstance(value, bool) or not least <= value <= MOST:
        raise InvalidInput(
            f"{name}: {key}: {shown(value)} is out of range; allowed: whole numbers from {least} to {MOST}"
        )
    return value


def _known(name: str, value: Mapping[str, Any], keys: tuple[str, ...]) -> None:
    for key in value:
        if key not in keys:
            raise InvalidInput(f"{name}: {shown(key)}: unknown key; allowed: {', '.join(keys)}")


def _replicas(name: str, value: Mapping[str, Any]) -> list[int]:
    _known(name, value, ("replicas", "first"))
    if name != "seed":
        raise InvalidInput(f"{name}: replicas are over seeds; allowed: seed = {{ replicas = N }}")
    first = value.get("first", 1)
    if not isinstance(first, int) or isinstance(first, bool):
        raise InvalidInput(f"{name}: first: {shown(first)} is not a whole number")
    return [first + k for k in range(_whole(name, "replicas", value["replicas"], 1))]


def _range(name: str, value: Mapping[str, Any]) -> list[float]:
    _known(name, value, ("from", "to", "steps", "by", "scale"))
    for key in ("from", "to"):
        if key not in value:
            raise InvalidInput(
                f"{name}: {key}: missing in a range; allowed: {{ from, to, steps }} or {{ from, to, by }}"
            )
    low, high = (_number(name, key, value[key]) for key in ("from", "to"))
    if ("steps" in value) == ("by" in value):
        raise InvalidInput(f"{name}: a range has steps (how many values) or by (how far apart); allowed: one of both")
    scale = value.get("scale", "linear")
    if scale not in ("linear", "log") or (scale == "log" and ("by" in value or min(low, high) <= 0)):
        raise InvalidInput(f"{name}: scale: {shown(scale)}; allowed: linear, or log with steps and ends above 0")
    if "by" in value:
        by = _number(name, "by", value["by"])
        if by * (high - low) < 0 or by == 0 or (high - low) / by > MOST:
            raise InvalidInput(f"{name}: by: {by:g} does not lead from {low:g} to {high:g} in {MOST} steps")
        return [_neat(low + k * by) for k in range(math.floor((high - low) / by * (1 + 1e-12) + 1e-9) + 1)]
    steps = _whole(name, "steps", value["steps"], 1)
    if steps == 1:
        return [low]
    shares = [k / (steps - 1) for k in range(steps)]
    if scale == "log":
        return [_neat(low * (high / low) ** share) for share in shares]
    return [_neat(low + share * (high - low)) for share in shares]


def _neat(value: float) -> float:
    """Without the last digits of a sum, so that 0.1 + 2*0.1 is 0.3."""
    return float(f"{value:.12g}")


@dataclass(frozen=True)
class Sampling:
    """How distributions are drawn.

    Attributes:
        number: samples.
        method: of `SAMPLINGS`.
        seed: of the samples.
    """

    number: int = 64
    method: str = SAMPLINGS[0]
    seed: int = 1

    def draw(self, distributions: Mapping[str, Mapping[str, Any]]) -> list[dict[str, float]]:
        """Samples of several distributions at once.

        Raises:
            InvalidInput: a distribution whose numbers make none.
        """
        kinds = {name: checked(name, value) for name, value in distributions.items()}
        from scipy.stats import qmc

        if self.method == "sobol":
            engine = qmc.Sobol(len(kinds), rng=self.seed)
            # a power of 2 is drawn, as the sequence is even over such only
            shares = engine.random_base2(max(0, math.ceil(math.log2(self.number))))[: self.number]
        else:
            shares = qmc.LatinHypercube(len(kinds), rng=self.seed).random(self.number)
        shares = shares.clip(1e-12, 1 - 1e-12)
        columns = {
            name: values_at(column, *kind).tolist()
            for (name, kind), column in zip(kinds.items(), shares.T, strict=True)
        }
        return [dict(zip(columns, row, strict=True)) for row in zip(*columns.values(), strict=True)]


def values_at(shares: NDArray[float64], kind: str, a: float, b: float) -> NDArray[float64]:
    """The values of a distribution below which there are these shares of it."""
    from numpy import asarray
    from scipy.stats import norm

    if kind == "uniform":
        return asarray(a + (b - a) * shares)
    deviations = norm.ppf(shares)
    return asarray(a + b * deviations if kind == "normal" else a * b**deviations)


def checked(name: str, value: Mapping[str, Any]) -> tuple[str, float, float]:
    """Kind and numbers of a distribution.

    Raises:
        InvalidInput: numbers that make none.
    """
    ((kind, pair),) = value.items()
    if not (isinstance(pair, list) and len(pair) == 2):
        raise InvalidInput(f"{name}: {kind}: {shown(pair)} is not two numbers")
    a, b = (_number(name, kind, number) for number in pair)
    good = {"uniform": a < b, "normal": b > 0, "lognormal": a > 0 and b > 1}[kind]
    if not good:
        allowed = {
            "uniform": "[low, high]",
            "normal": "[mean, deviation above 0]",
            "lognormal": "[median above 0, geometric standard deviation above 1]",
        }[kind]
        raise InvalidInput(f"{name}: {kind}: {shown(pair)}; allowed: {allowed}")
    return kind, a, b


def take_sampling(content: dict[str, Any]) -> Sampling:
    """The keys that say how distributions are drawn, taken out of a file's content.

    Raises:
        InvalidInput: a value out of range.
    """
    number = _whole("samples", "number", content.pop("samples", Sampling.number), 1)
    method = content.pop("sampling", Sampling.method)
    if method not in SAMPLINGS:
        raise InvalidInput(f"sampling: unknown choice {shown(method)}; allowed: {', '.join(SAMPLINGS)}")
    return Sampling(number, method, _whole("sampling_seed", "number", content.pop("sampling_seed", Sampling.seed), 0))
