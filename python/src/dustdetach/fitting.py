"""Material parameters from measured dispersion ratios: least squares on the smooth response, with intervals.

The intervals are those of the profile likelihood: for each value of a parameter the others take what fits best, and the
value belongs to the interval as long as the data do not speak against it. They hold for all parameters at once with
95 %, so that a pair of them lies in its intervals in 95 of 100 experiments.
"""

from __future__ import annotations

import csv
import math
import os
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from io import StringIO
from pathlib import Path
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

from .about import option
from .errors import InvalidInput, shown
from .files import as_path, read_text
from .impact import PARTS, Impact
from .materials import is_known
from .parameters import ABOUT, PARAMETER_TYPES
from .response import Curves, Places, Polygon
from .result import COLUMNS

Array: TypeAlias = NDArray[np.float64]

CONFIDENCE = 0.95

#: parameters of adhesion: the power with which the pull-off force goes with each
ADHESION = {"z0": -2.0, "surface_energy": 1.0, "hamaker": 1.0}
#: what may be free
FREE = (*ADHESION, "spread", "friction")

#: the ratio measured, and how uncertain it is (a standard deviation), if that is known
MEASURED, UNCERTAINTY = "dispersion_ratio", "uncertainty"

#: what a ratio may be, noise included; a share in per cent is not
LEAST_RATIO, MOST_RATIO = -0.25, 1.25

#: what the smooth response misses of the fix at most, and so the least uncertainty of a point
LEAST_ERROR = 0.002

#: of the search: ln of the pull-off force about that of the start, ln of the spread, friction
FORCE_RANGE, SPREAD_RANGE, FRICTION_RANGE = 7.0, math.log(20.0), (0.0, 2.0)

#: friction at which c* is worked out; between them by lines
FRICTIONS = np.array([0.0, 0.05, 0.1, 0.15, 0.2, 0.25, 0.3, 0.35, 0.4, 0.5, 0.6, 0.7, 0.85, 1.0, 1.25, 1.5, 2.0])

#: sizes that stand for a distribution, each with the same share of the mass
SIZES = 12

#: rms that is called good and fair where nothing is known of the uncertainty
GOOD, FAIR = 0.02, 0.05


@dataclass(frozen=True)
class Estimate:
    """A parameter that has been fitted: its value and the ends of its interval, in the parameter's unit."""

    value: float
    low: float
    high: float


@dataclass(frozen=True)
class Data:
    """Measured points.

    Attributes:
        source: where they come from, for messages.
        impacts: the parameters of each; what is free in them is where the search begins.
        ratios: measured (n,).
        uncertainties: their standard deviations (n,), or ``None``.
        varied: names of the parameters that differ between them.
    """

    source: str
    impacts: list[Impact]
    ratios: Array
    uncertainties: Array | None
    varied: tuple[str, ...]


@dataclass(frozen=True)
class Fit:
    """What the data say.

    Attributes:
        estimates: of each free parameter that they tell.
        untold: why they do not tell the others.
        at: the best values of all free parameters, told or not.
        data: what was fitted.
        predicted: by the fit (n,).
        rms: of measured less predicted.
        rms_alike: of the best fit with one pull-off force for all grains.
        words: how good it is, in sentences.
    """

    estimates: dict[str, Estimate]
    untold: dict[str, str]
    at: dict[str, float]
    data: Data
    predicted: Array
    rms: float
    rms_alike: float
    words: list[str]

    def to_mapping(self) -> dict[str, Any]:
        """What ``fit --json`` prints."""
        nothing = {"value": None, "low": None, "high": None}
        impact = self.data.impacts[0]
        fixed = {
            name: getattr(impact, name)
            for name in ABOUT
            if name not in (*self.at, *self.data.varied, *_UNUSED)
            and not (name in ADHESION and set(self.at) & set(ADHESION))
        }
        return {
            **{name: vars(estimate) for name, estimate in self.estimates.items()},
            **{name: {**nothing, "reason": reason} for name, reason in self.untold.items()},
            "confidence": CONFIDENCE,
            "points": len(self.data.ratios),
            "rms": self.rms,
            "rms_without_spread": self.rms_alike,
            "goodness": " ".join(self.words),
            "fixed": fixed,
        }


#: parameters that make no difference to a fit
_UNUSED = ("method", "seed", "coverage", "wall_hamaker", "grain_hamaker", "grain_damping", "rotation", "timestep")


def read_data(path: str | Path, free: Sequence[str], fixed: Mapping[str, Any]) -> Data:
    """Read measured points from a CSV file.

    Args:
        path: the file; its columns are named as in ``results.csv``: ``dispersion_ratio``, any parameters of `Impact`,
            and ``uncertainty`` if it is known.
        free: parameters that are to be fitted; a column of theirs does not count.
        fixed: values of parameters that are no column.

    Raises:
        InvalidInput: no such file, an unknown column, or a value that is none; the message names file and line.
    """
    path = as_path(path, "fit")
    if not os.path.lexists(path):
        raise InvalidInput(f"{path}: no such file; allowed: a CSV file with the columns speed and {MEASURED}")
    reader = csv.DictReader(StringIO(read_text(path), newline=""), skipinitialspace=True)
    names = [name.strip() for name in reader.fieldnames or ()]
    reader.fieldnames = names
    if MEASURED not in names:
        raise InvalidInput(f"{path}: no column {MEASURED}; allowed: {MEASURED}, {UNCERTAINTY} and parameters")
    for name in names:
        if name not in COLUMNS and name != UNCERTAINTY:
            near = ", ".join(ABOUT)
            raise InvalidInput(f"{path}: {shown(name)}: unknown column; allowed: {MEASURED}, {UNCERTAINTY}, {near}")
        if names.count(name) > 1:
            raise InvalidInput(f"{path}: {name}: two columns of this name")
        if name in fixed:
            raise InvalidInput(f"{path}: {name}: a column, and given by an option, too; allowed: one of both")
    _check_adhesion_given(free, fixed)
    taken = _columns_taken(names, free)
    impacts, ratios, uncertainties = [], [], []
    try:
        for row in reader:
            where = f"{path}: line {reader.line_num}"
            if None in row or None in row.values():
                raise InvalidInput(f"{where}: {len(names)} columns are named, and not so many fields")
            values = {name: _value(where, name, row[name]) for name in taken}
            if "lammps_version" in names:
                values = {name: value for name, value in values.items() if name not in PARTS or is_known(value)}
            try:
                impacts.append(Impact.from_mapping({"seed": 1, **fixed, **values}))
            except InvalidInput as error:
                raise InvalidInput(f"{where}: {error}") from None
            ratios.append(_number(where, MEASURED, row[MEASURED], LEAST_RATIO, MOST_RATIO, "0 to 1, noise apart"))
            if UNCERTAINTY in names:
                uncertainties.append(_number(where, UNCERTAINTY, row[UNCERTAINTY], 1e-6, 1.0, "above 0 and at most 1"))
    except csv.Error as error:
        raise InvalidInput(f"{path}: line {reader.line_num}: {error}") from None
    varied = tuple(name for name in ABOUT if len({getattr(impact, name) for impact in impacts}) > 1)
    known = np.array(uncertainties) if uncertainties else None
    return Data(str(path), impacts, np.array(ratios), known, varied)


def _check_adhesion_given(free: Sequence[str], fixed: Mapping[str, Any]) -> None:
    """What is fitted must not be given otherwise."""
    for name in set(free) & set(ADHESION):
        unlike = ("surface_energy",) if name != "surface_energy" else ("hamaker", "z0")
        for other in (*unlike, name):
            if other in fixed:
                raise InvalidInput(f"{option(other)}: given, and --free {name} is fitted; allowed: one of both")
    for name in set(free) & set(fixed) - set(ADHESION):
        raise InvalidInput(f"{option(name)}: given, and --free {name} is fitted; allowed: one of both")


def _columns_taken(names: Sequence[str], free: Sequence[str]) -> list[str]:
    """The columns that are parameters and count: a results.csv has some that follow from others."""
    whole = "lammps_version" in names
    ignored = {*free, "seed", "coverage"}
    if set(free) & set(ADHESION):
        ignored |= set(ADHESION) - ({"z0"} if "hamaker" in free else {"hamaker"} if "z0" in free else set())
    if whole:
        ignored |= {
            "surface_energy",
            "wall_hamaker",
            "grain_hamaker",
            "bare",
            "grain_damping",
        }
    return [name for name in names if name in ABOUT and name not in ignored]


def _value(where: str, name: str, text: str) -> Any:
    kind, text = PARAMETER_TYPES[name], text.strip()
    if kind == "str":
        return text
    if kind == "bool":
        if text.lower() not in ("true", "false"):
            raise InvalidInput(f"{where}: {name}: {shown(text)} is not true or false")
        return text.lower() == "true"
    try:
        return int(text) if kind == "int" else float(text)
    except ValueError:
        raise InvalidInput(f"{where}: {name}: {shown(text)} is not a number") from None


def _number(where: str, name: str, text: str, low: float, high: float, allowed: str) -> float:
    try:
        number = float(text)
    except ValueError:
        number = math.nan
    if not low <= number <= high:
        raise InvalidInput(f"{where}: {name}: {shown(text.strip())} is out of range; allowed: {allowed}")
    return number


class Model:
    """Predicts ratios from the free parameters.

    Args:
        impacts: the points' parameters.
        free: which are free.
    """

    def __init__(self, impacts: Sequence[Impact], free: Sequence[str]) -> None:
        self.free = tuple(free)
        self.impacts = list(impacts)
        self.adhesion = next((name for name in free if name in ADHESION), None)
        keys = [_unlike(impact, self.free) for impact in impacts]
        unlike = dict(zip(keys, impacts, strict=True))
        self._index = [list(unlike).index(key) for key in keys]
        self._parts = [_response(impact, "friction" in self.free) for impact in unlike.values()]
        self._holds = np.concatenate([part.holds for part in self._parts])
        self._ends = np.cumsum([len(part.holds) for part in self._parts])[:-1]
        self._curves = None if "friction" in self.free else self._side_by_side(None)

    def _side_by_side(self, friction: float | None) -> Curves:
        return Curves([polygon for part in self._parts for polygon in part.polygons(friction)])

    def predict(self, point: Array) -> Array:
        """The ratios at a point of the search, one for each impact (n,)."""
        at = dict(zip(self.free, map(float, point), strict=True))
        force = at[self.adhesion] if self.adhesion else 0.0
        spread = math.exp(at["spread"]) if "spread" in at else self.impacts[0].spread
        curves = self._curves or self._side_by_side(at["friction"])
        shares = curves.shares_below(self._holds * math.exp(force), spread)
        means = np.array([each.mean() for each in np.split(shares, self._ends)])
        return np.asarray(means[self._index])

    def bounds(self) -> Array:
        """Low and high of each free parameter in the search (p, 2)."""
        ranges = {"spread": (0.0, SPREAD_RANGE), "friction": FRICTION_RANGE}
        return np.array([ranges.get(name, (-FORCE_RANGE, FORCE_RANGE)) for name in self.free])

    def value(self, name: str, at: float) -> float:
        """A parameter at a place of the search, in its own unit."""
        if name == "friction":
            return float(at)
        if name == "spread":
            return math.exp(at)
        return float(getattr(self.impacts[0], name) * math.exp(at / ADHESION[name]))

    def starts(self) -> list[Array]:
        """A net of points over the range."""
        nets = {"spread": [0.05, 0.4, 1.0], "friction": [0.1, 0.4]}
        axes = [nets.get(name, list(np.linspace(-FORCE_RANGE, FORCE_RANGE, 29))) for name in self.free]
        return [np.array(point) for point in np.stack(np.meshgrid(*axes), -1).reshape(-1, len(axes))]


#: of an impact these do not change what its places let go
_ALIKE = (
    *ADHESION,
    "seed",
    "coverage",
    "wall_hamaker",
    "grain_hamaker",
    "spread",
    "method",
    "carrier",
    "wall",
    "grain",
)


def _unlike(impact: Impact, free: Sequence[str]) -> tuple[Any, ...]:
    """What tells two impacts of a model apart."""
    adhesion = () if set(free) & set(ADHESION) else (impact.surface_energy,)
    return (*adhesion, *(getattr(impact, name) for name in ABOUT if name not in _ALIKE and name not in free))


class _Response:
    """The polygons of an impact, one for each of its sizes, and the holds of the median grains."""

    def __init__(self, impact: Impact, friction_free: bool) -> None:
        sizes = [impact.grain_diameter]
        if impact.distribution != "none":
            sizes = [impact.quantile(0.01 + 0.98 * (k + 0.5) / SIZES) for k in range(SIZES)]
        self.holds = [impact.hold(size) for size in sizes]
        places = [Places(impact, size) for size in sizes]
        frictions = FRICTIONS if friction_free else np.array([impact.friction])
        self._states = [Polygon.alike(np.array([each.holds(mu) for mu in frictions])) for each in places]

    def polygons(self, friction: float | None) -> list[Polygon]:
        """One for each size."""
        if friction is None:
            return [states[0] for states in self._states]
        k = int(np.clip(np.searchsorted(FRICTIONS, friction) - 1, 0, len(FRICTIONS) - 2))
        part = (friction - FRICTIONS[k]) / (FRICTIONS[k + 1] - FRICTIONS[k])
        return [Polygon((1 - part) * states[k].x + part * states[k + 1].x, states[k].above) for states in self._states]


_responses: dict[tuple[Any, ...], _Response] = {}


def _response(impact: Impact, friction_free: bool) -> _Response:
    """The response of an impact, kept for others like it."""
    key = (friction_free, impact.surface_energy, *_unlike(impact, ()))
    if key not in _responses:
        _responses[key] = _Response(impact, friction_free)
    return _responses[key]


def fit(data: Data, free: Sequence[str] = ("z0", "spread")) -> Fit:
    """Fit free parameters to measured ratios.

    Args:
        data: the points.
        free: of `FREE`; one of z0, surface_energy and hamaker at most.

    Raises:
        InvalidInput: the data cannot tell any of them; the message says why, and what would.
    """
    _check_free(free)
    _check_points(data, free)
    problem, model = _problem(data, data.impacts, free)
    best, least = problem.search(model.starts())
    ends_of = _ends(problem, data, best, least)
    if problem.lowest[1] < 0.999 * least:
        # a profile has led to a deeper valley
        best, least = problem.search([problem.lowest[0]])
        ends_of = _ends(problem, data, best, least)
    estimates, untold = {}, {}
    for k, (name, ends) in enumerate(zip(free, ends_of, strict=True)):
        if reason := _left_open(model, k, ends):
            untold[name] = reason
        else:
            low, high = sorted(model.value(name, at) for at, _ in ends)
            estimates[name] = Estimate(model.value(name, float(best[k])), low, high)
    predicted = model.predict(best)
    rms = _rms(data.ratios - predicted)
    alike = _other_spread(data, free, with_spread=False)
    at = {name: model.value(name, float(best[k])) for k, name in enumerate(free)}
    spread = (rms, at["spread"]) if "spread" in at else _other_spread(data, free, with_spread=True)
    words = [_quality(data, predicted, len(free)), *_about_spread(free, rms, alike, spread)]
    words += [f"The data do not tell {name}: {reason}." for name, reason in untold.items()]
    if not estimates or set(untold) & set(ADHESION):
        # what a spread or friction is without the force that it belongs to is nothing to rely on
        raise InvalidInput(
            f"{data.source}: {' '.join(words)} allowed: fewer of --free, or data at more speeds, angles or spins"
        )
    return Fit(estimates, untold, at, data, predicted, rms, alike[0], words)


def _ends(problem: _Problem, data: Data, best: Array, least: float) -> list[list[tuple[float, bool]]]:
    """Both ends of each parameter's interval."""
    limit = _limit(data, len(best), least)
    return [[problem.end(k, side, best, limit) for side in (-1, 1)] for k in range(len(best))]


def _problem(data: Data, impacts: Sequence[Impact], free: Sequence[str]) -> tuple[_Problem, Model]:
    model = Model(impacts, free)
    weights = 1 / _uncertainties(data)
    return _Problem(lambda point: (data.ratios - model.predict(point)) * weights, model.bounds()), model


def _rms(misses: Array) -> float:
    return float(np.sqrt(np.mean(misses**2)))


def _uncertainties(data: Data) -> Array:
    if data.uncertainties is None:
        return np.ones(len(data.ratios))
    return np.sqrt(data.uncertainties**2 + LEAST_ERROR**2)


def _limit(data: Data, free: int, least: float) -> float:
    """The sum of squares that the data still allow."""
    from scipy.stats import chi2, f

    rest = len(data.ratios) - free
    if data.uncertainties is not None:
        # uncertainties that are too small for the scatter are taken as that much larger
        return least + float(chi2.ppf(CONFIDENCE, free)) * max(1.0, least / rest)
    variance = max(least / rest, LEAST_ERROR**2)
    return least + variance * free * float(f.ppf(CONFIDENCE, free, rest))


def _check_free(free: Sequence[str]) -> None:
    for name in free:
        if name not in FREE:
            raise InvalidInput(f"--free: unknown choice {shown(name)}; allowed: some of {', '.join(FREE)}")
    if not free or len(set(free)) < len(free):
        raise InvalidInput(f"--free: {','.join(free) or 'nothing'}; allowed: each of {', '.join(FREE)} once at most")
    adhesion = [name for name in free if name in ADHESION]
    if len(adhesion) > 1:
        raise InvalidInput(
            f"--free: {' and '.join(adhesion)} make one pull-off force, which is all that the data can tell; allowed: "
            "one of them"
        )


def _check_points(data: Data, free: Sequence[str]) -> None:
    """Whether there are enough, at conditions that are unlike enough."""
    count = len(data.ratios)
    conditions = len({tuple(getattr(impact, name) for name in data.varied) for impact in data.impacts})
    needed = max(2, len(free))
    if count == 0:
        raise InvalidInput(f"{data.source}: no points")
    if conditions < needed:
        one = data.impacts[0]
        where = f"one condition ({one.speed:g} m/s, {one.angle:g} degrees)" if conditions == 1 else "two conditions"
        raise InvalidInput(
            f"{data.source}: {where} cannot tell {' and '.join(free)}: other values would give the same ratio; "
            f"allowed: points at {needed} speeds, angles or spins or more"
        )
    for impact in data.impacts:
        if impact.grain_damping < 1:
            raise InvalidInput(
                f"--grain-damping: {impact.grain_damping:g} makes grains ring, which a fit does not know; allowed: 1 "
                "or more"
            )
        if impact.tangential not in ("impulse", "off"):
            raise InvalidInput(
                f"{data.source}: tangential: {impact.tangential} is not the law of a fit; allowed: impulse, off"
            )
    if count <= len(free):
        raise InvalidInput(
            f"{data.source}: {count} points for {len(free)} parameters leave nothing to judge them by; allowed: "
            f"{len(free) + 1} points or more"
        )


def _left_open(model: Model, k: int, ends: Sequence[tuple[float, bool]]) -> str:
    """Why the data do not tell a parameter: its interval ends with the search, but for no spread and no friction."""
    name = model.free[k]
    (low, low_found), (high, high_found) = ends
    if (low_found or name in ("spread", "friction")) and high_found:
        return ""
    if not low_found and not high_found:
        return "any value agrees with them"
    unit = f" {ABOUT[name].unit}" if ABOUT[name].unit else ""
    end, other = (low, high) if low_found else (high, low)
    value = model.value(name, end)
    return f"any value {'above' if model.value(name, other) > value else 'below'} {value:.3g}{unit} agrees with them"


class _Problem:
    """Least squares with bounds, and how the least sum rises when one parameter is held."""

    #: of the derivatives: wider than the lines of the polygons
    STEP = 2e-3

    def __init__(self, misses: Callable[[Array], Array], bounds: Array) -> None:
        self._misses, self._bounds = misses, bounds
        # what a profile came across
        self.lowest: tuple[Array, float] = (np.empty(0), math.inf)

    def _least(self, start: Array, held: int | None = None) -> tuple[Array, float]:
        """The best point from a start, one parameter held or none, and its sum of squares."""
        from scipy.optimize import least_squares

        moves = [k for k in range(len(start)) if k != held]
        if not moves:
            return start, float(np.sum(self._misses(start) ** 2))
        low, high = self._bounds[moves].T

        def whole(part: Array) -> Array:
            point = start.copy()
            point[moves] = part
            return point

        def slopes(part: Array) -> Array:
            columns = []
            for k in range(len(moves)):
                up, down = part.copy(), part.copy()
                up[k], down[k] = min(part[k] + self.STEP, high[k]), max(part[k] - self.STEP, low[k])
                columns.append((self._misses(whole(up)) - self._misses(whole(down))) / (up[k] - down[k]))
            return np.column_stack(columns)

        inside = np.clip(start[moves], low + 1e-9, high - 1e-9)
        found = least_squares(
            lambda part: self._misses(whole(part)), inside, slopes, (low, high), xtol=1e-7, ftol=1e-9, max_nfev=60
        )
        return whole(found.x), float(2 * found.cost)

    def search(self, starts: Sequence[Array]) -> tuple[Array, float]:
        """The best point of all, from the best of a net."""
        sums = [float(np.sum(self._misses(point) ** 2)) for point in starts]
        chosen = [starts[index] for index in np.argsort(sums)[:4]]
        return min((self._least(point) for point in chosen), key=lambda found: found[1])

    def end(self, k: int, side: int, best: Array, limit: float) -> tuple[float, bool]:
        """Where a parameter's profile comes to the limit on one side, and whether it does before its bound."""
        bound = float(self._bounds[k, 0 if side < 0 else 1])
        warm = best.copy()

        def above(at: float) -> float:
            nonlocal warm
            start = warm.copy()
            start[k] = at
            warm, least_there = self._least(start, k)
            if least_there < self.lowest[1]:
                self.lowest = warm, least_there
            return least_there - limit

        inside, step = float(best[k]), 0.02
        while True:
            outside = inside + side * step
            if (outside - bound) * side >= 0:
                outside = bound
            if above(outside) > 0:
                break
            if outside == bound:
                return bound, False
            inside, step = outside, step * 1.6
        # by halves: a start from the other side may find another valley, so that no sign is certain
        while abs(outside - inside) > 2e-4:
            middle = 0.5 * (inside + outside)
            if above(middle) > 0:
                outside = middle
            else:
                inside = middle
        return inside, True


def _other_spread(data: Data, free: Sequence[str], *, with_spread: bool) -> tuple[float, float]:
    """The best fit of one pull-off force for all grains, or of a spread: its rms, and the adhesion or the spread."""
    adhesion = next((name for name in free if name in ADHESION), "z0")
    impacts = [replace(impact, spread=1.0) for impact in data.impacts]
    problem, model = _problem(data, impacts, (adhesion, "spread") if with_spread else (adhesion,))
    best, _ = problem.search(model.starts())
    return _rms(data.ratios - model.predict(best)), model.value(model.free[-1], float(best[-1]))


def _quality(data: Data, predicted: Array, free: int) -> str:
    """How good the fit is, in a sentence or two."""
    misses = data.ratios - predicted
    rms = _rms(misses)
    if data.uncertainties is not None:
        words = _against_uncertainty(misses / _uncertainties(data), rms, len(misses) - free)
    else:
        quality = "good" if rms <= GOOD else "fair" if rms <= FAIR else "poor"
        words = f"The fit is {quality}: it misses the {len(misses)} points by {rms:.2g} (rms)."
    if rms > GOOD and _systematic(data, misses):
        words += " The misses are no scatter: neighbours go together, so the model bends unlike the data."
    return words


def _about_spread(
    free: Sequence[str], rms: float, alike: tuple[float, float], spread: tuple[float, float]
) -> list[str]:
    """How bad one pull-off force for all grains is, and how far a spread mends it."""
    adhesion = next((name for name in free if name in ADHESION), "z0")
    about = ABOUT[adhesion]
    one = f"{alike[1] * about.factor:.3g} {about.figure_unit}".replace("$^{-20}$", "^-20").replace("²", "2")
    worst = max(alike[0], rms)
    mended = 1 - min(spread[0], worst) / worst if worst > 0 else 0.0
    return [
        f"One {adhesion} for all grains, {one}, misses them by {alike[0]:.2g} (rms); a spread of {spread[1]:.3g} mends "
        f"{mended:.0%} of that, to {spread[0]:.2g}."
    ]


def _against_uncertainty(scaled: Array, rms: float, rest: int) -> str:
    from scipy.stats import chi2

    total = float(np.sum(scaled**2))
    chance = float(chi2.sf(total, rest))
    says = f"misses {rms:.2g} (rms), chi2 {total:.3g} at {rest} degrees of freedom"
    if chance >= 0.05:
        return f"The fit agrees with the data within their uncertainty: {says}."
    return (
        f"The fit does not agree with the data within their uncertainty: {says}, which chance gives in {chance:.1g} of "
        "all experiments; the intervals are widened accordingly."
    )


def _systematic(data: Data, misses: Array) -> bool:
    """Whether misses of neighbours go together, in the order of what varies most."""
    if len(misses) < 5 or not data.varied:
        return False
    name = "speed" if "speed" in data.varied else data.varied[0]
    if PARAMETER_TYPES[name] == "str":
        return False
    ordered = misses[np.argsort([getattr(impact, name) for impact in data.impacts], kind="stable")]
    return bool(np.sum(ordered[1:] * ordered[:-1]) > 0.5 * np.sum(ordered**2))
