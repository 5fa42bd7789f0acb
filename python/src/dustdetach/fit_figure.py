"""The figure of a fit: measured points, what was fitted, and the best of one pull-off force for all grains."""

from __future__ import annotations

from collections import defaultdict
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib import pyplot as plt

from .errors import InvalidInput
from .figures import COLOURS, MARKERS, STYLE
from .files import replace_file
from .fitting import Data, Fit, Model
from .impact import Impact
from .parameters import ABOUT, PARAMETER_TYPES

#: places along the axis at which a curve is worked out, besides those of the points
PLACES = 14


def draw_fit(found: Fit, path: Path) -> None:
    """Draw a fit as PNG (or SVG, by the name's ending)."""
    axis = _axis(found.data)
    groups: dict[tuple[Any, ...], list[int]] = defaultdict(list)
    others = [name for name in found.data.varied if name != axis]
    for index, impact in enumerate(found.data.impacts):
        groups[tuple(getattr(impact, name) for name in others)].append(index)
    with plt.rc_context(STYLE):
        figure, axes = plt.subplots(figsize=(5.6, 4.2), layout="constrained")
        factor = ABOUT[axis].factor
        for number, (values, rows) in enumerate(sorted(groups.items(), key=lambda item: str(item[0]))):
            colour, marker = COLOURS[number % len(COLOURS)], MARKERS[number % len(MARKERS)]
            places = np.array([getattr(found.data.impacts[row], axis) for row in rows])
            bars = None if found.data.uncertainties is None else found.data.uncertainties[rows]
            label = (
                ", ".join(ABOUT[name].words(value) for name, value in zip(others, values, strict=True)) or "measured"
            )
            axes.errorbar(
                places * factor, found.data.ratios[rows], bars, fmt=marker, color=colour, capsize=2.5, label=label
            )
            along, curve = _curve(found, found.data.impacts[rows[0]], axis, places)
            axes.plot(along * factor, curve, color=colour, label="fit" if not others else None)
        axes.set_xlabel(ABOUT[axis].axis)
        axes.set_ylabel("Dispersion ratio (detached / initial dust mass)")
        axes.set_ylim(-0.02, 1.02)
        axes.set_title("\n".join(_said(found)))
        axes.legend()
        with replace_file(path) as part:
            figure.savefig(part, dpi=200, format=path.suffix[1:])
        plt.close(figure)


def _axis(data: Data) -> str:
    """The parameter along which the points lie."""
    numbers = [name for name in data.varied if PARAMETER_TYPES[name] in ("float", "int")]
    return next((name for name in ("speed", "angle", "spin") if name in numbers), numbers[0] if numbers else "speed")


def _curve(found: Fit, impact: Impact, axis: str, places: np.ndarray[Any, Any]) -> tuple[Any, Any]:
    """Ratios of the fit along the axis, also between the points."""
    between = np.linspace(places.min(), places.max(), PLACES)
    impacts, along = [], []
    for place in np.unique(np.concatenate([places, between])):
        try:
            changes: dict[str, Any] = {axis: float(place), **found.at}
            impacts.append(replace(impact, **changes))
        except InvalidInput:
            continue
        along.append(place)
    return np.array(along), Model(impacts, ()).predict(np.empty(0))


def _said(found: Fit) -> list[str]:
    """The parameters with their intervals, and those that are not told."""
    lines = []
    for name, estimate in found.estimates.items():
        about = ABOUT[name]
        low, high = estimate.low * about.factor, estimate.high * about.factor
        lines.append(f"{about.words(estimate.value)}  ({low:.3g} to {high:.3g}, 95 %)")
    lines += [f"{ABOUT[name].symbol}: not told by the data" for name in found.untold]
    return [*lines, f"rms {found.rms:.2g}"]
