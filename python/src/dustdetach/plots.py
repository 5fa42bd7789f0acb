"""Plots of a sweep over any parameters: curves with a colour and a panel for each value, and maps over two.

Every row of the table is in a plot. A parameter that is neither axis nor colour nor panel, and has few values, makes
curves of its own (another line style); one with many values, such as an uncertain input, and the seed make a band.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib import pyplot as plt
from matplotlib.axes import Axes
from matplotlib.colors import Normalize
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from numpy.typing import NDArray

from .about import option
from .errors import InvalidInput, shown
from .figures import COLOUR_MAP, COLOURS, MARKERS, STYLE, fixed_words, save, table_of
from .impact import is_timestep_chosen
from .parameters import ABOUT, PARAMETER_TYPES, PARAMETERS
from .result import COLUMNS, MAIN_COLUMNS, Result

#: more values of a parameter than these are not told apart by line style, but make a band
MOST_STYLES = 6
#: more panels, or more values by colours of their own, could not be read
MOST_PANELS, MOST_COLOURS = 12, 7
#: more values of the colour's parameter than these are points, not curves
MOST_CURVES = 60
#: share of the rows in a band
BAND = (5, 95)

LINE_STYLES: list[Any] = ["solid", "dashed", "dotted", "dashdot", (0, (5, 1, 1, 1, 1, 1)), (0, (1, 3))]

#: columns that may be drawn upwards
DRAWN = (*MAIN_COLUMNS, "restitution_realised", "grains")


def plot_by(
    folder: str | Path,
    *,
    x: str | None = None,
    color: str | None = None,
    panel: str | None = None,
    y: str = "dispersion_ratio",
) -> list[Path]:
    """Draw curves of ``folder/results.csv``.

    Args:
        folder: of the sweep.
        x: the parameter along the axis; the speed if it varies, else the number with the most values.
        color: the parameter told by colour; by default the one with the most values of those that are left.
        panel: the parameter with a panel for each value; by default the next one, if that makes few.
        y: the column drawn.

    Returns:
        The files written, ``plot-X-….png`` and ``.svg``.

    Raises:
        InvalidInput: no table, or a parameter that does not vary or is none.
    """
    path, results = table_of(folder)
    return draw_by(path, results, Path(folder), x=x, color=color, panel=panel, y=y)


def draw_by(
    path: Path,
    results: Sequence[Result],
    out: Path,
    *,
    x: str | None = None,
    color: str | None = None,
    panel: str | None = None,
    y: str = "dispersion_ratio",
) -> list[Path]:
    """Draw curves of the rows of a table into a folder, see `plot_by`."""
    if y not in DRAWN:
        raise InvalidInput(f"--y: unknown choice {shown(y)}; allowed: {', '.join(DRAWN)}")
    differing = varied(results)
    for role, name in (("x", x), ("color", color), ("panel", panel)):
        _check_role(role, name, differing, numeric=role == "x")
    x = x or _default_axis(differing)
    if x is None:
        raise InvalidInput(f"{path}: no curve to draw: no number varies; allowed: a sweep over one")
    left = [name for name in differing if name not in (x, color, panel, "seed")]
    left.sort(key=lambda name: -len(values_of(results, name)))
    if color is None and left and (len(values_of(results, left[0])) <= MOST_CURVES or len(left) == 1):
        color = left.pop(0)
    few = [name for name in left if len(values_of(results, name)) <= MOST_STYLES]
    if panel is None and few and few[0] != "method":
        panel = few.pop(0)
    if panel is not None and len(values_of(results, panel)) > MOST_PANELS:
        raise InvalidInput(
            f"--panel: {panel} has {len(values_of(results, panel))} values; allowed: {MOST_PANELS} at most"
        )
    styled = [name for name in left if name != panel and name in few]
    stem = "-".join(("plot", *(name for name in (y, x, color, panel) if name and name != "dispersion_ratio")))
    with plt.rc_context(STYLE):
        figure = _draw_curves(results, x, color, panel, styled, y)
        return save(figure, out / stem)


def plot_map(folder: str | Path, x: str, y: str, panel: str | None = None) -> list[Path]:
    """Draw the dispersion ratio over two parameters as a map, the mean where several rows have the same place.

    Raises:
        InvalidInput: no table, parameters that do not vary or are no numbers, or others that vary and are no panel.
    """
    path, results = table_of(folder)
    differing = varied(results)
    for role, name in (("map", x), ("map", y), ("panel", panel)):
        _check_role(role, name, differing, numeric=role == "map")
    if x == y:
        raise InvalidInput(f"--map: {x},{y}; allowed: two unlike parameters")
    left = [name for name in differing if name not in (x, y, panel, "seed")]
    if panel is None and left:
        panel = left.pop(0)
    many = [name for name in left if len(values_of(results, name)) <= MOST_STYLES]
    if many:
        raise InvalidInput(
            f"{path}: {', '.join(many)} vary, too: a place of the map would have several ratios; allowed: --panel for "
            "one of them, and a sweep in which the others do not vary"
        )
    if panel is not None and len(values_of(results, panel)) > MOST_PANELS:
        raise InvalidInput(
            f"--panel: {panel} has {len(values_of(results, panel))} values; allowed: {MOST_PANELS} at most"
        )
    with plt.rc_context(STYLE):
        figure = _draw_maps(path, results, x, y, panel)
        return save(figure, Path(folder) / "-".join(("map", x, y, *([panel] if panel else []))))


def varied(results: Sequence[Result]) -> list[str]:
    """The parameters that differ between rows; not those that follow from others that do."""
    found = [name for name in PARAMETERS if ABOUT[name].symbol and len(values_of(results, name)) > 1]
    if len({row.method for row in results}) > 1:
        found.append("method")
    if is_timestep_chosen(results):
        found = [name for name in found if name != "timestep"]
    return [name for name in found if not (ABOUT[name].follows and _follows_from(results, name, found))]


def _follows_from(results: Sequence[Result], name: str, found: Sequence[str]) -> bool:
    """Whether the other parameters that differ tell this one, so that it is no axis of its own."""
    others = [other for other in found if other != name and not ABOUT[other].follows]
    seen: dict[tuple[Any, ...], Any] = {}
    return bool(others) and all(
        seen.setdefault(tuple(getattr(row, other) for other in others), getattr(row, name)) == getattr(row, name)
        for row in results
    )


def values_of(results: Sequence[Result], name: str) -> list[Any]:
    """The values of a parameter in the rows, in order."""
    return sorted({getattr(row, name) for row in results})


def _check_role(role: str, name: str | None, differing: Sequence[str], *, numeric: bool) -> None:
    if name is None:
        return
    if name not in PARAMETERS:
        raise InvalidInput(
            f"--{role}: unknown parameter {shown(name)}; allowed: {', '.join(differing) or 'none varies'}"
        )
    if name not in differing:
        raise InvalidInput(f"--{role}: {name} does not vary; allowed: {', '.join(differing) or 'none varies'}")
    if numeric and PARAMETER_TYPES[name] not in ("float", "int"):
        raise InvalidInput(f"--{role}: {option(name)} is no number; allowed: {', '.join(_numbers(differing))}")


def _numbers(names: Sequence[str]) -> list[str]:
    return [name for name in names if PARAMETER_TYPES[name] in ("float", "int")]


def _default_axis(differing: Sequence[str]) -> str | None:
    numbers = [name for name in _numbers(differing) if name != "seed"]
    return "speed" if "speed" in numbers else next(iter(numbers), None)


def _grid(count: int) -> tuple[int, int]:
    columns = min(count, 3 if count != 4 else 2)
    return -(-count // columns), columns


def _panels(results: Sequence[Result], panel: str | None) -> tuple[Figure, list[tuple[Axes, str, list[Result]]]]:
    """A figure with axes for each value of a parameter, lettered, and the rows of each."""
    values = values_of(results, panel) if panel else [None]
    rows, columns = _grid(len(values))
    size = (7.1, 4.4) if len(values) == 1 else (3.1 * columns + 0.8, 2.7 * rows + 1.0)
    figure = plt.figure(figsize=size, layout="constrained")
    grid = figure.subplots(rows, columns, squeeze=False, sharex=True, sharey=True)
    for empty in grid.flat[len(values) :]:
        empty.set_axis_off()
    found = []
    for number, value in enumerate(values):
        title = f"({'abcdefghijkl'[number]}) {ABOUT[panel].words(value)}" if panel else ""
        found.append(
            (grid.flat[number], title, [row for row in results if panel is None or getattr(row, panel) == value])
        )
    return figure, found


def _draw_curves(
    results: Sequence[Result], x: str, color: str | None, panel: str | None, styled: Sequence[str], y: str
) -> Figure:
    figure, panels = _panels(results, panel)
    colours = _colours(results, color)
    styles = {key: k for k, key in enumerate(sorted({_key(row, styled) for row in results}, key=str))}
    banded = False
    for axes, title, rows in panels:
        axes.set_title(title)
        axes.set_xlabel(ABOUT[x].axis)
        if color and len(colours) > MOST_CURVES:
            _points(axes, rows, x, y, [colours[getattr(row, color)][0] for row in rows])
            continue
        groups = defaultdict(list)
        for row in rows:
            groups[getattr(row, color) if color else None, _key(row, styled)].append(row)
        for (value, key), group in sorted(groups.items(), key=lambda item: str(item[0])):
            look = {"color": colours[value][0], "linestyle": LINE_STYLES[styles[key] % len(LINE_STYLES)]}
            banded |= _curve(axes, group, x, y, look, colours[value][1])
    panels[0][0].set_ylabel(COLUMNS[y].axis)
    _add_key(figure, results, color, colours, styled, styles)
    _add_foot(figure, results, [x, color, panel, *styled], banded)
    return figure


def _key(row: Result, names: Sequence[str]) -> tuple[Any, ...]:
    return tuple(getattr(row, name) for name in names)


def _points(axes: Axes, rows: Sequence[Result], x: str, y: str, colours: Sequence[Any]) -> None:
    """A point for each row."""
    drawn = [(row, colour) for row, colour in zip(rows, colours, strict=True) if getattr(row, y) is not None]
    along = [getattr(row, x) * ABOUT[x].factor for row, _ in drawn]
    up = [getattr(row, y) * COLUMNS[y].factor for row, _ in drawn]
    axes.scatter(along, up, s=5, c=[colour for _, colour in drawn], linewidths=0)


def _curve(axes: Axes, rows: Sequence[Result], x: str, y: str, look: dict[str, Any], marker: str) -> bool:
    """One curve: the mean over rows of the same place, and their band if there are several; whether there is one."""
    places = defaultdict(list)
    for row in rows:
        drawn = getattr(row, y)
        if drawn is not None:
            places[getattr(row, x) * ABOUT[x].factor].append(drawn * COLUMNS[y].factor)
    along = sorted(places)
    if not along:
        return False
    middle = [float(np.mean(places[place])) for place in along]
    points = "o" if len(along) == 1 else marker
    axes.plot(along, middle, marker=points, clip_on=False, **look)
    if all(len(values) == 1 for values in places.values()):
        return False
    low, high = np.array([np.percentile(places[place], BAND) for place in along]).T
    axes.fill_between(along, low, high, color=look["color"], alpha=0.2, linewidth=0)
    return True


def _colours(results: Sequence[Result], color: str | None) -> dict[Any, tuple[Any, str]]:
    """Colour and marker of each value: few that the colour-blind can tell apart, or along a map even to the eye."""
    values: list[Any] = values_of(results, color) if color else [None]
    if len(values) <= min(MOST_COLOURS, len(COLOURS)):
        return {value: (COLOURS[k], MARKERS[k]) for k, value in enumerate(values)}
    shades = plt.get_cmap(COLOUR_MAP)
    if color and PARAMETER_TYPES[color] == "float" and len(values) > MOST_COLOURS:
        low, high = float(min(values)), float(max(values))
        return {value: (shades(0.92 * (float(value) - low) / (high - low)), "") for value in values}
    return {value: (shades(0.92 * k / (len(values) - 1)), MARKERS[k % len(MARKERS)]) for k, value in enumerate(values)}


def _add_key(
    figure: Figure,
    results: Sequence[Result],
    color: str | None,
    colours: dict[Any, tuple[Any, str]],
    styled: Sequence[str],
    styles: dict[tuple[Any, ...], int],
) -> None:
    """What colours and line styles mean: a legend, or a bar for a number of many values."""
    handles = []
    if color and PARAMETER_TYPES[color] == "float" and len(colours) > MOST_COLOURS:
        factor = ABOUT[color].factor
        scale = Normalize(min(colours) * factor, min(colours) * factor + (max(colours) - min(colours)) * factor / 0.92)
        shades = plt.cm.ScalarMappable(scale, COLOUR_MAP)
        bar = figure.colorbar(shades, ax=figure.axes, label=ABOUT[color].axis)
        bar.ax.set_ylim(min(colours) * factor, max(colours) * factor)
    elif color:
        for value, (colour, marker) in colours.items():
            handles.append(Line2D([], [], color=colour, marker=marker, label=ABOUT[color].words(value)))
    if len(styles) > 1:
        for key, k in styles.items():
            label = ", ".join(ABOUT[name].words(value) for name, value in zip(styled, key, strict=True))
            handles.append(Line2D([], [], color="0.3", linestyle=LINE_STYLES[k % len(LINE_STYLES)], label=label))
    if handles:
        figure.legend(handles=handles, loc="outside upper center", ncols=min(4, len(handles)), handlelength=2.6)


def _add_foot(figure: Figure, results: Sequence[Result], drawn: Sequence[str | None], banded: bool) -> None:
    """The parameters that are the same everywhere, and what the bands are of."""
    said = ""
    if banded:
        over = [name for name in varied(results) if name not in drawn]
        counts = ", ".join(f"{len(values_of(results, name))} of {ABOUT[name].symbol}" for name in over)
        said = f"Lines: means; bands: {BAND[0]} to {BAND[1]} % of the impacts ({counts}).\n"
    figure.supxlabel(said + fixed_words(results), fontsize=6.5, color="0.35")


def _draw_maps(path: Path, results: Sequence[Result], x: str, y: str, panel: str | None) -> Figure:
    figure, panels = _panels(results, panel)
    mesh = None
    for axes, title, rows in panels:
        axes.set_title(title)
        along, up, ratios = _places(rows, x, y)
        if len(set(along)) < 2 or len(set(up)) < 2 or len(along) < 4:
            raise InvalidInput(f"{path}: too few places for a map of {x} and {y}; allowed: at least 2 values of each")
        levels = np.linspace(0, 1, 21)
        mesh = axes.tricontourf(along, up, ratios, levels, cmap=COLOUR_MAP)
        lines = axes.tricontour(along, up, ratios, levels[::2], colors="white", linewidths=0.7)
        axes.clabel(lines, fmt="%.1f", fontsize=7)
        axes.plot(along, up, ".", color="black", markersize=1.5, alpha=0.5)
        axes.set_xlabel(ABOUT[x].axis)
    panels[0][0].set_ylabel(ABOUT[y].axis)
    assert mesh is not None
    figure.colorbar(mesh, ax=figure.axes, label="Dispersion ratio", ticks=np.linspace(0, 1, 6))
    figure.supxlabel(fixed_words(results), fontsize=6.5, color="0.35")
    return figure


def _places(
    rows: Sequence[Result], x: str, y: str
) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
    """The places of a map and the mean ratio at each."""
    found = defaultdict(list)
    for row in rows:
        found[getattr(row, x) * ABOUT[x].factor, getattr(row, y) * ABOUT[y].factor].append(row.dispersion_ratio)
    places = np.array(list(found))
    return places[:, 0], places[:, 1], np.array([np.mean(ratios) for ratios in found.values()])
