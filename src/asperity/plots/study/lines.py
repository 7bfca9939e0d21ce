"""Measures of a study along one of its axes."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from asperity.plots.study import outcomes
from asperity.plots.study.drawn_quantities import Quantity, axis_quantity, measure_quantity
from asperity.plots.study.panels import Block, Page
from asperity.results.colours import colour
from asperity.sweeps.analysis.pareto import numbers
from asperity.sweeps.analysis.view import View, words

if TYPE_CHECKING:
    import xarray

_DOTTED = 40
_PANELS = 3


def page(dataset: xarray.Dataset, view: View, title: str) -> Page:
    """Lines along `View.x`: a colour for each value of the series, a panel for each of the rest."""
    whole = {
        name: measure_quantity(numbers(dataset, name), dataset[name]) for name in view.measures
    }
    blocks = [
        Block(text, _drawing(one, view, (measure, quantity)))
        for one, text in facets(dataset, view.facet)
        for measure, quantity in whole.items()
    ]
    across = min(len(blocks), _PANELS if view.facet or len(blocks) == _PANELS else 2)
    return Page(title, blocks, across, _legend(dataset, view))


def facets(dataset: xarray.Dataset, key: str) -> list[tuple[xarray.Dataset, str]]:
    """The results at each value of an axis, with the value in words."""
    if not key:
        return [(dataset, "")]
    return [
        (dataset.isel({key: number}), text) for number, text in enumerate(_in_words(dataset[key]))
    ]


def _in_words(axis: xarray.DataArray) -> list[str]:
    """The values of an axis, each after its name."""
    unit, label = str(axis.attrs.get("units", "1")), axis.attrs["long_name"]
    return [f"{label} {words(value, unit)}" for value in axis.values]


def _drawing(
    dataset: xarray.Dataset, view: View, measured: tuple[str, Quantity]
) -> Callable[[Axes], None]:
    """What draws one panel: some of a measure's values, the quantity being all of them."""
    measure, whole = measured
    along = (view.series, view.x) if view.series else (view.x,)
    ordered = dataset.transpose(*along, ...)
    shape = tuple(ordered.sizes[key] for key in along)
    values = numbers(ordered, measure).reshape(-1, shape[-1])
    lost = outcomes.failed(ordered).reshape(values.shape)
    held = outcomes.captured(ordered) if not view.series else None

    def draw(axes: Axes) -> None:
        x = axis_quantity(ordered[view.x])
        x.dress(axes, "x")
        whole.dress(axes, "y")
        if held is not None:
            _shade(axes, x, held == 1)
        for number, (row, gone) in enumerate(zip(values / whole.factor, lost, strict=True)):
            _line(axes, x, (row, gone), colour(outcomes.SERIES[number]), joined=not whole.names)
        if not x.names:  # the same in all panels, whichever values are known
            axes.set_xlim(*x._replace(values=np.sort(x.values)).edges[[0, -1]])
        if view.facet and not whole.names:
            found = whole.values[np.isfinite(whole.values)]
            axes.update_datalim(np.column_stack([np.full(found.size, x.values[0]), found]))

    return draw


def _line(
    axes: Axes, x: Quantity, row: tuple[np.ndarray, np.ndarray], tint: str, *, joined: bool
) -> None:
    """One line, with a cross at the foot of the panel for each failed case."""
    y, gone = row
    style = "o" if x.names or not joined else "-o" if y.size <= _DOTTED else "-"
    order = np.argsort(x.values, kind="stable")
    axes.plot(x.values[order], y[order], style, color=tint, mew=0.0)
    if style == "-":
        single = _alone(y[order])
        axes.plot(x.values[order][single], y[order][single], "o", color=tint, mew=0.0)
    if gone.any():
        axes.plot(
            x.values[gone], np.full(np.count_nonzero(gone), 0.02), "x", color=colour("quiet"),
            ms=3.0, mew=0.6, transform=axes.get_xaxis_transform(), clip_on=False,
        )  # fmt: skip


def _alone(values: np.ndarray) -> np.ndarray:
    """Which values have none on either side, where no line would show them."""
    known = np.concatenate([[False], np.isfinite(values), [False]])
    found: np.ndarray = known[1:-1] & ~known[:-2] & ~known[2:]
    return found


def _shade(axes: Axes, x: Quantity, held: np.ndarray) -> None:
    """Shade the cells of the cases whose first impact captures."""
    order = np.argsort(x.values, kind="stable")
    ends = x._replace(values=x.values[order]).edges
    steps = np.flatnonzero(np.diff(np.concatenate([[0], held[order].astype(int), [0]])))
    for low, high in steps.reshape(-1, 2):
        axes.axvspan(ends[low], ends[high], color=outcomes.SHADE, lw=0.0, zorder=0)


def _legend(dataset: xarray.Dataset, view: View) -> list[tuple[Artist, str]]:
    found: list[tuple[Artist, str]] = []
    if view.series:
        for number, text in enumerate(_in_words(dataset[view.series])):
            found.append((Line2D([], [], color=colour(outcomes.SERIES[number])), text))
    else:
        held = outcomes.captured(dataset)
        if held is not None and np.any(held == 1):
            found.append((Patch(facecolor=outcomes.SHADE, lw=0.0), outcomes.WORDS["captured"]))
    if outcomes.failed(dataset).any():
        cross = Line2D([], [], ls="", marker="x", ms=3.0, mew=0.6, color=colour("quiet"))
        found.append((cross, "failed"))
    return found
