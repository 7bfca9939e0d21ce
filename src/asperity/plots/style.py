"""One look for all pictures: sizes in print, colours, axes with units."""

from __future__ import annotations

import io
from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.axis import Axis
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.cm import ScalarMappable
from matplotlib.figure import Figure
from matplotlib.ticker import LogLocator, MaxNLocator, NullFormatter, NullLocator

from asperity.results.summary import scaled

COLUMN, PAGE = 85.0, 170.0
"""Widths of a picture [mm]: one column and a whole page of a journal."""

RESOLUTION = 200
"""Dots per inch of a PNG."""

INCH = 25.4
"""Millimetres."""

_MARGINS = {"left": 14.0, "right": 3.0, "top": 9.0, "bottom": 11.0}
_GAP = 17.0
_HEIGHT = 42.0
_ONE_ROW = 3
_MARKER_SCALE = 1.5
_MARKED = 40


_LOOK: Any = {
    "font.size": 8.0,
    "axes.titlesize": 8.0,
    "axes.labelsize": 8.0,
    "xtick.labelsize": 7.0,
    "ytick.labelsize": 7.0,
    "legend.fontsize": 7.0,
    "legend.frameon": False,
    "legend.handlelength": 1.4,
    "legend.columnspacing": 1.2,
    "legend.borderaxespad": 0.0,
    "axes.linewidth": 0.6,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.formatter.useoffset": False,
    "axes.formatter.limits": (-3, 4),
    "axes.titlelocation": "left",
    "lines.linewidth": 1.0,
    "lines.markersize": 2.5,
    "xtick.major.width": 0.6,
    "ytick.major.width": 0.6,
    "xtick.major.size": 2.5,
    "ytick.major.size": 2.5,
    "xtick.minor.size": 1.5,
    "ytick.minor.size": 1.5,
    "path.simplify": True,
    "agg.path.chunksize": 10000,
    "savefig.dpi": RESOLUTION,
}


class Panel(NamedTuple):
    """One pair of axes: its width relative to its neighbours', and what draws into it."""

    width: float
    draw: Callable[[Axes], None]


Row = list[Panel]


class Picture(Figure):
    """A figure that a notebook shows by itself, without a window system."""

    def _repr_png_(self) -> bytes:
        return png(self)


def look() -> Any:
    """A context within which figures take on the style."""
    return mpl.rc_context(_LOOK)


def sheet(width: float, height: float) -> Picture:
    """An empty figure of a width and a height [mm]."""
    figure = Picture(figsize=(width / INCH, height / INCH), dpi=RESOLUTION)
    FigureCanvasAgg(figure)
    return figure


def figure_of(rows: Sequence[Row]) -> Figure:
    """A figure with rows of panels at fixed distances; single panels are one column wide.

    Parameters
    ----------
    rows : sequence of Row
        The panels from top to bottom, each with its relative width and what draws it.
    """
    width = COLUMN if all(len(row) == 1 for row in rows) else PAGE
    step = _HEIGHT + _MARGINS["top"] + _MARGINS["bottom"]
    tall = step * len(rows)
    figure = sheet(width, tall)
    for number, row in enumerate(rows):
        room = width - _MARGINS["left"] - _MARGINS["right"] - _GAP * (len(row) - 1)
        left, bottom = _MARGINS["left"], tall - step * (number + 1) + _MARGINS["bottom"]
        for panel in row:
            size = room * panel.width / sum(one.width for one in row)
            place = (left / width, bottom / tall, size / width, _HEIGHT / tall)
            panel.draw(figure.add_axes(place))
            left += size + _GAP
    return figure


def scale_of(*arrays: np.ndarray, unit: str) -> tuple[float, str]:
    """What to divide arrays by, and the unit for the axis, from their largest finite value."""
    largest = 0.0
    for values in arrays:
        finite = values[np.isfinite(values)]
        largest = max(largest, float(np.max(np.abs(finite), initial=0.0)))
    factor, prefixed = scaled(largest, unit)
    return factor, prefixed.replace("u", "µ") if prefixed != unit else unit


def scaled_axis(axis: Axis, quantity: str, *arrays: np.ndarray, unit: str) -> float:
    """Label an axis with a unit that suits arrays, as `scale_of`; what to divide them by."""
    factor, prefixed = scale_of(*arrays, unit=unit)
    axis.set_label_text(label(quantity, prefixed))
    return factor


def plain_numbers(axis: Axis) -> None:
    """Numbers such as 0.01 and 20 at the ticks of a logarithmic axis, not powers of ten."""
    axis.set_major_formatter(lambda value, _: f"{value:g}")


def log_ticks(axis: Axis) -> None:
    """Plain numbers at 1, 2 and 5 of each decade of a logarithmic axis."""
    axis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0), numticks=10))
    axis.set_minor_formatter(NullFormatter())
    plain_numbers(axis)


def log_axis(axes: Axes, *arrays: np.ndarray) -> None:
    """A logarithmic vertical axis with plain numbers, where values span more than a decade."""
    values = np.concatenate(arrays)
    values = values[values > 0.0]
    if values.size and values.max() > 10.0 * values.min():
        axes.set_yscale("log")
        plain_numbers(axes.yaxis)
        axes.yaxis.set_minor_locator(NullLocator())
        if values.max() < 100.0 * values.min():
            axes.yaxis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0), numticks=10))


def count_axis(axes: Axes, name: str) -> None:
    """A horizontal axis that counts."""
    axes.xaxis.set_major_locator(MaxNLocator(integer=True, nbins=6, min_n_ticks=1))
    axes.set_xlabel(name)


def dots(axes: Axes, number: np.ndarray, values: np.ndarray, tint: str, name: str = "") -> None:
    """A dot at each number that is counted, a small one where they are many."""
    size = 2.5 if number.size <= _MARKED else 1.5
    axes.plot(number, values, "o", ms=size, mew=0.0, color=tint, label=name)


def label(quantity: str, unit: str) -> str:
    """An axis label, e.g. ``separation [nm]``."""
    return f"{quantity} [{unit}]"


def legend_above(axes: Axes, rows: int | None = None) -> None:
    """A legend over the axes, where no data can be under it; there is room for two rows."""
    handles, _ = axes.get_legend_handles_labels()
    if handles:
        rows = rows or (1 if len(handles) <= _ONE_ROW else 2)
        columns = -(-len(handles) // rows)
        axes.legend(
            loc="lower left", bbox_to_anchor=(0.0, 1.02), ncols=columns, markerscale=_MARKER_SCALE
        )


def colour_bar(
    figure: Figure,
    shown: ScalarMappable,
    place: tuple[float, float, float, float],
    name: str,
    extend: str = "neither",
) -> Axes:
    """The bar of the colours that are shown, at a place in parts of the figure.

    ``extend`` is the end at which it goes on, as matplotlib has it.
    """
    bar = figure.colorbar(shown, cax=figure.add_axes(place), extend=extend)
    bar.set_label(name)
    bar.outline.set_visible(False)
    return bar.ax


def images(name: str, figure: Figure) -> dict[str, bytes]:
    """A figure as PNG and as SVG, by file name."""
    return {f"{name}.png": png(figure), f"{name}.svg": svg(figure)}


def svg(figure: Figure) -> bytes:
    """A figure as SVG with its letters as text; the same figure gives the same bytes."""
    store = io.BytesIO()
    with look(), mpl.rc_context({"svg.fonttype": "none", "svg.hashsalt": "asperity"}):
        figure.savefig(store, format="svg", metadata={"Date": None, "Creator": None})
    return store.getvalue()


def png(figure: Figure) -> bytes:
    """A figure as PNG; the same figure gives the same bytes."""
    store = io.BytesIO()
    with look():
        figure.savefig(
            store,
            format="png",
            dpi=RESOLUTION,
            metadata={"Software": None},
            pil_kwargs={"compress_level": 3},
        )
    return store.getvalue()
