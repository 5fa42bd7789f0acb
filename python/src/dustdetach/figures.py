"""Figures of a sweep in the manner of the paper's Figs. 4 and 5: dispersion ratio against impact speed."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Iterable, Sequence
from pathlib import Path
from typing import Any

import matplotlib

matplotlib.use("Agg")

from matplotlib import pyplot as plt
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import MaxNLocator, MultipleLocator

from .errors import InvalidInput
from .files import as_path, replace_file
from .impact import Impact, is_timestep_chosen
from .parameters import ABOUT, FASTEST, PARAMETERS
from .result import Result, read_csv
from .sweeping import TABLE

#: parameters that tell curves apart: all with a symbol, but for those that are an axis, a style or a replica
_TELLING = tuple(name for name in PARAMETERS if ABOUT[name].symbol and name not in ("speed", "seed", "tangential"))

#: colours that colour-blind readers can tell apart (Okabe and Ito 2008)
COLOURS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7")
MARKERS = ("o", "s", "^", "D", "v", "P", "X")
#: more curves than these in a figure by speed could not be told apart by a legend
MOST_CURVES = 30
#: for more curves than these: from dark to light in the order of the curves, in a map even to the eye
COLOUR_MAP = "viridis"
FORMATS = ("png", "svg")
#: a second table of a folder, of resolved runs that its sweep has not made
MORE = "resolved.csv"

STYLE: Any = {
    "font.size": 9,
    "axes.titlesize": 9,
    "axes.titlelocation": "left",
    "axes.labelsize": 9.5,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.grid": True,
    "axes.axisbelow": True,
    "axes.linewidth": 0.7,
    "grid.color": "#e6e6e6",
    "grid.linewidth": 0.6,
    "legend.frameon": False,
    "lines.linewidth": 1.6,
    "lines.markersize": 3.4,
    "svg.hashsalt": "dustdetach",
}

#: laws of tangential lift-off share the colour of their curve
_LINES: dict[str, Any] = {
    "impulse": "solid",
    "estimate": "dashed",
    "integrate": "dotted",
    "frictionless": "dashdot",
    "off": (0, (1, 3)),
}

Curve = tuple[float | str | bool, ...]
Colour = str | tuple[float, float, float, float]


def plot(folder: str | Path) -> list[Path]:
    """Draw ``figure4`` (straight impacts) and ``figure5`` (angles) from ``folder/results.csv``, what there is of them.

    Lines are the detachment functions, the mean over seeds and their band where there are several, dashed or dotted by
    other laws of tangential lift-off than the first; open markers are resolved runs. Those of ``folder/resolved.csv``,
    a table that another sweep has made, are drawn as well if it is there.

    Returns:
        The files written, PNG and SVG.

    Raises:
        InvalidInput: no table, or nothing in it that makes a curve.
    """
    path, results = table_of(folder)
    return draw_all(path, results, path.parent)


def table_of(folder: str | Path) -> tuple[Path, list[Result]]:
    """The table of a sweep's folder, and its rows with those of ``resolved.csv`` if it is there.

    Raises:
        InvalidInput: no table, or numbers in it that no impact has.
    """
    folder = as_path(folder, "plot")
    results = []
    for table in (folder / TABLE, folder / MORE):
        if table.name == MORE and not table.exists():
            continue
        rows = read_csv(table)
        for row in rows:
            _check(row, table)
        results += rows
    return folder / TABLE, results


def draw_all_of(results: list[Result]) -> dict[str, list[Result]]:
    """The figures that results make, each with its rows."""
    straight = [result for result in results if result.angle == 90]
    oblique = _with_angles(results)
    figures = {}
    if oblique:
        figures["figure5"] = oblique
    if len(_curves(straight)) > 1 or (straight and not oblique):
        figures["figure4"] = straight
    if not any(len({result.speed for result in rows}) > 1 for rows in figures.values()):
        return {}
    return figures


def draw_all(path: Path, results: list[Result], folder: Path) -> list[Path]:
    """Draw every figure that the rows of a table make into a folder, by any parameter if these make too many curves.

    Raises:
        InvalidInput: they make no curve.
    """
    figures = draw_all_of(results)
    if any(len(_curves(rows)) > MOST_CURVES for rows in figures.values()):
        from .plots import draw_by

        return draw_by(path, results, folder)
    if not figures:
        raise InvalidInput(
            f"{path}: no curve to draw: at least two speeds are needed, or --x with another parameter that varies"
        )
    return [file for name in sorted(figures) for file in draw(figures[name], folder / name)]


def _check(row: Result, table: Path) -> None:
    """Numbers that no impact has would have no place in a figure, either."""
    if not 0 < row.speed <= FASTEST:
        raise InvalidInput(f"{table}: speed: {row.speed:g} is out of range; allowed: above 0 and at most {FASTEST:g}")
    for name in ("dispersion_ratio", "north", "south"):
        if not 0 <= getattr(row, name) <= 1:
            raise InvalidInput(f"{table}: {name}: {getattr(row, name):g} is out of range; allowed: 0 to 1")


def draw(results: list[Result], stem: Path) -> list[Path]:
    """Draw one figure: the whole carrier in the large panel, each hemisphere in a small one.

    Args:
        results: the rows; one curve for each combination of parameters that differ between them, speed apart.
        stem: name of the files without their suffix.

    Returns:
        The files written.
    """
    curves = _curves(results)
    with plt.rc_context(STYLE):
        figure = plt.figure(figsize=(7.1, 3.9), layout="constrained")
        axes = figure.subplot_mosaic([["all", "north"], ["all", "south"]], width_ratios=[1.75, 1])
        panels: list[tuple[str, str, float, Callable[[Result], float]]] = [
            ("all", "Whole carrier", 1.0, lambda row: row.dispersion_ratio),
            ("north", "North, away from the wall", 0.5, lambda row: row.north),
            ("south", "South, the side of the impact", 0.5, lambda row: row.south),
        ]
        for name, title, top, share in panels:
            _panel(axes[name], curves, share)
            axes[name].set_title(title)
            axes[name].set_ylim(0, top * 1.04)
            axes[name].set_xlim(0, max(result.speed for result in results) * 1.02)
            axes[name].xaxis.set_major_locator(MaxNLocator(11 if name == "all" else 5, steps=[1, 2, 5, 10]))
            axes[name].yaxis.set_major_locator(MultipleLocator(top / 5))
        axes["all"].set_ylabel("Dispersion ratio (detached / initial dust mass)")
        axes["all"].set_xlabel("Impact speed $v_p$ (m/s)")
        axes["south"].set_xlabel("Impact speed $v_p$ (m/s)")
        axes["north"].tick_params(labelbottom=False)
        _add_legend(figure, _legend(curves, results))
        figure.supxlabel(fixed_words(results), fontsize=6.5, color="0.35")
        return save(figure, stem)


def save(figure: Figure, stem: Path) -> list[Path]:
    """Write a figure as PNG and SVG and close it; returns the files."""
    written = []
    for suffix in FORMATS:
        path = stem.with_name(f"{stem.name}.{suffix}")
        with replace_file(path) as part:
            figure.savefig(part, dpi=200, metadata={"Date": None} if suffix == "svg" else None)
        written.append(path)
    plt.close(figure)
    return written


#: of parameters that are the same everywhere these are said on a figure even if they have their default
_SAID = ("carrier", "carrier_diameter", "wall", "grain", "grain_diameter", "coverage", "restitution", "angle", "speed")


def fixed_words(results: Sequence[Result]) -> str:
    """The parameters that are the same in all rows, for the foot of a figure; others at their default are left out."""
    default = Impact(speed=1.0).values()
    always = _SAID if is_timestep_chosen(results) else (*_SAID, "timestep")
    said = []
    for name in (*always, *(name for name in PARAMETERS if name not in always)):
        values = {getattr(row, name) for row in results}
        value = next(iter(values))
        about = ABOUT[name]
        if len(values) > 1 or not about.symbol or (name not in always and (about.follows or value == default[name])):
            continue
        said.append(about.words(value))
    half = -(-len(said) // 2) if len(said) > 8 else len(said)
    return "\n".join(", ".join(line) for line in (said[:half], said[half:]) if line)


def _with_angles(results: list[Result]) -> list[Result]:
    """The rows at the coefficients of restitution that have oblique rows; none if all are straight."""
    oblique = {result.restitution for result in results if result.angle != 90}
    return [result for result in results if result.restitution in oblique]


def _curves(results: list[Result]) -> dict[Curve, list[Result]]:
    """Rows by the values that differ between them (speed, seed and method apart), in the order of these values."""
    differing = _differing(results)
    curves = defaultdict(list)
    for result in results:
        curves[tuple(getattr(result, name) for name in differing)].append(result)
    return dict(sorted(curves.items()))


def _differing(results: list[Result]) -> list[str]:
    found = [name for name in _TELLING if len({getattr(result, name) for result in results}) > 1]
    # what follows from others that differ is no word of a legend
    if is_timestep_chosen(results):
        found = [name for name in found if name != "timestep"]
    given = [name for name in found if not ABOUT[name].follows]
    return [name for name in found if name in given or not _told(results, name, given)]


def _told(results: list[Result], name: str, others: list[str]) -> bool:
    """Whether the other parameters that differ tell this one."""
    seen: dict[Curve, Any] = {}
    keys = [tuple(getattr(result, other) for other in others) for result in results]
    values = [getattr(result, name) for result in results]
    return bool(others) and all(seen.setdefault(key, value) == value for key, value in zip(keys, values, strict=True))


def _laws(results: Iterable[Result]) -> list[str]:
    """The laws of tangential lift-off of the functions; the first one's lines are solid."""
    found = {result.tangential for result in results if result.method == "functions"}
    return [law for law in _LINES if law in found]


def _panel(axes: Axes, curves: dict[Curve, list[Result]], share: Callable[[Result], float]) -> None:
    laws = _laws(row for rows in curves.values() for row in rows)
    for rows, (colour, marker) in zip(curves.values(), _looks(len(curves)), strict=True):
        for law in laws:
            means = defaultdict(list)
            for row in rows:
                if row.method == "functions" and row.tangential == law:
                    means[row.speed].append(share(row))
            # an unclipped line without points has no place, which upsets the layout
            if means:
                speeds = sorted(means)
                ratios = [sum(means[speed]) / len(means[speed]) for speed in speeds]
                axes.plot(speeds, ratios, color=colour, clip_on=False, **_line(law, laws, marker))
                if any(len(means[speed]) > 1 for speed in speeds):
                    low, high = ([end(means[speed]) for speed in speeds] for end in (min, max))
                    axes.fill_between(speeds, low, high, color=colour, alpha=0.2, linewidth=0)
        resolved = [row for row in rows if row.method == "resolved"]
        if resolved:
            speeds = [row.speed for row in resolved]
            axes.plot(speeds, [share(row) for row in resolved], **_POINT, color=colour, marker=marker)


def _line(law: str, laws: list[str], marker: str) -> dict[str, Any]:
    """Style of a law's line, with markers for the first law alone."""
    if law == laws[0]:
        return {"marker": marker}
    return {"linestyle": _LINES[law], "linewidth": 1.1}


_METHOD_NAMES = {"functions": "functions", "resolved": "dust-resolved"}
_POINT: dict[str, Any] = {
    "linestyle": "none",
    "markerfacecolor": "white",
    "markersize": 6,
    "markeredgewidth": 1.3,
    "zorder": 3,
    "clip_on": False,
}


def _looks(count: int) -> list[tuple[Colour, str]]:
    """Colour and marker of each curve."""
    colours: list[Colour] = list(COLOURS[:count])
    if count > len(COLOURS):
        colours = [plt.get_cmap(COLOUR_MAP)(0.92 * index / (count - 1)) for index in range(count)]
    return [(colour, MARKERS[index % len(MARKERS)]) for index, colour in enumerate(colours)]


def _add_legend(figure: Figure, handles: list[Line2D]) -> None:
    """A legend above the panels with as many columns as fit: one that is too wide would squeeze the panels."""
    for columns in range(6, 0, -1):
        legend = figure.legend(
            handles=handles, loc="outside upper center", ncols=columns, handlelength=2, columnspacing=1.3
        )
        if columns == 1 or legend.get_window_extent().width < figure.bbox.width:
            return
        legend.remove()


def _legend(curves: dict[Curve, list[Result]], results: list[Result]) -> list[Line2D]:
    """An entry for each curve, with an open marker if all of it is resolved, then what lines and markers mean."""
    differing = _differing(results)
    methods = {result.method for result in results}
    laws = _laws(results)
    handles = []
    for (curve, rows), (colour, marker) in zip(curves.items(), _looks(len(curves)), strict=True):
        look = _POINT if all(row.method == "resolved" for row in rows) else {}
        words = [ABOUT[name].words(value) for name, value in zip(differing, curve, strict=True)]
        label = ", ".join(words) or _METHOD_NAMES[rows[0].method]
        handles.append(Line2D([], [], color=colour, marker=marker, label=label, **look))
    if len(laws) > 1:
        handles += [Line2D([], [], color="0.3", label=law, **_line(law, laws, "")) for law in laws]
    elif len(methods) > 1:
        handles.append(Line2D([], [], color="0.3", label=_METHOD_NAMES["functions"]))
    if len(methods) > 1:
        handles.append(Line2D([], [], color="0.3", marker="o", **_POINT, label=_METHOD_NAMES["resolved"]))
    return handles
