"""A measure of a study over two of its axes, with the line between capture and rebound."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np
from matplotlib import colormaps
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.collections import LineCollection, PolyCollection
from matplotlib.colors import Colormap, ListedColormap, LogNorm, Normalize
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from asperity.plots.study import outcomes
from asperity.plots.study.drawn_quantities import Quantity, axis_quantity, measure_quantity
from asperity.plots.study.lines import facets
from asperity.plots.study.panels import Block, Page
from asperity.results.colours import colour
from asperity.sweeps.analysis.pareto import numbers
from asperity.sweeps.analysis.view import View

if TYPE_CHECKING:
    import xarray

_PANELS = 3
_TINTS = {
    "rebounds": outcomes.REBOUNDS,
    "captured": outcomes.CAPTURED,
    "rest": colour("closest_approach"),
    "oscillating": colour("apex"),
    "escaped": colour("motion"),
    "time limit": colour("gas"),
    "max impacts": colour("capillary"),
    "stopped": colour("kinetic"),
}
"""Colours of codes by their meaning."""


def page(dataset: xarray.Dataset, view: View, title: str) -> Page:
    """A map, or one for each value of the facet, with one scale of colours."""
    (name,) = view.measures
    whole = measure_quantity(numbers(dataset, name), dataset[name])
    colours = _colours(whole)
    panels = facets(dataset, view.facet)
    blocks = [Block(text, _drawing(one, view, whole, colours)) for one, text in panels]
    made = Page(title, blocks, min(len(blocks), _PANELS), _legend(dataset, view, whole.names))
    if not whole.names:
        made.bar, made.bar_label = ScalarMappable(*colours), whole.upright
    return made


def boundary(edges: tuple[np.ndarray, np.ndarray], held: np.ndarray) -> np.ndarray:
    """The line between cells that are captured and cells that rebound, along the cells' edges.

    Parameters
    ----------
    edges
        Of the cells along x and y, shapes (columns + 1,) and (rows + 1,).
    held
        1 where the first impact captures, 0 where it does not, -1 where that is unknown; shape
        (rows, columns).

    Returns
    -------
    Pieces of the line as pairs of points, shape (pieces, 2, 2).
    """
    x, y = edges
    beside = np.abs(np.diff(held, axis=1)) * np.all([held[:, 1:] >= 0, held[:, :-1] >= 0], axis=0)
    above = np.abs(np.diff(held, axis=0)) * np.all([held[1:] >= 0, held[:-1] >= 0], axis=0)
    row, column = np.nonzero(beside)
    upright = np.stack([x[column + 1], y[row], x[column + 1], y[row + 1]], axis=1)
    row, column = np.nonzero(above)
    flat = np.stack([x[column], y[row + 1], x[column + 1], y[row + 1]], axis=1)
    return np.concatenate([upright, flat]).reshape(-1, 2, 2)


def _drawing(
    dataset: xarray.Dataset, view: View, whole: Quantity, colours: tuple[Normalize, Colormap]
) -> Callable[[Axes], None]:
    # Edges of cells need ascending values, which a list of them need not be.
    ordered = dataset.sortby([view.x, view.y]).transpose(view.y, view.x, ...)
    (name,) = view.measures
    norm, tints = colours

    def draw(axes: Axes) -> None:
        x, y = axis_quantity(ordered[view.x]), axis_quantity(ordered[view.y])
        x.dress(axes, "x")
        y.dress(axes, "y")
        lost = outcomes.failed(ordered)
        values = numbers(ordered, name).reshape(lost.shape) / whole.factor
        axes.pcolormesh(
            x.edges, y.edges, np.ma.masked_where(lost | ~np.isfinite(values), values),
            norm=norm, cmap=tints, rasterized=True,
        )  # fmt: skip
        _hatch(axes, (x.edges, y.edges), lost)
        held = outcomes.captured(ordered)
        if held is not None and name != "captured":
            pieces = boundary((x.edges, y.edges), held.astype(int))
            axes.add_collection(
                LineCollection(list(pieces), capstyle="projecting", **outcomes.BOUNDARY)
            )
        axes.set(xlim=x.edges[[0, -1]], ylim=y.edges[[0, -1]])

    return draw


def _hatch(axes: Axes, edges: tuple[np.ndarray, np.ndarray], lost: np.ndarray) -> None:
    """Hatch the cells of failed cases, each run along a row as one."""
    x, y = edges
    ends = np.diff(np.pad(lost.astype(int), ((0, 0), (1, 1))), axis=1)
    row, low = np.nonzero(ends == 1)
    _, high = np.nonzero(ends == -1)
    corners = [(x[low], y[row]), (x[high], y[row]), (x[high], y[row + 1]), (x[low], y[row + 1])]
    if row.size:
        axes.add_collection(
            PolyCollection(
                list(np.stack([np.stack(corner, axis=1) for corner in corners], axis=1)),
                **outcomes.FAILED_CELL,
            )
        )


def _colours(whole: Quantity) -> tuple[Normalize, Colormap]:
    """Which colour a value has, the same in all panels: one a name, or a scale."""
    if whole.names:
        tints = [_TINTS.get(name, outcomes.FAILED) for name in whole.names]
        return Normalize(-0.5, len(tints) - 0.5), ListedColormap(tints)
    return _norm(whole), colormaps["viridis"]


def _norm(whole: Quantity) -> Normalize:
    """Colours from the least to the largest value; a little apart where all are the same."""
    found = whole.values[np.isfinite(whole.values)]
    low, high = (float(found.min()), float(found.max())) if found.size else (0.0, 1.0)
    if whole.log:
        return LogNorm(low, high)
    return Normalize(low, high) if high > low else Normalize(low - 0.5, high + 0.5)


def _legend(
    dataset: xarray.Dataset, view: View, flags: tuple[str, ...]
) -> list[tuple[Artist, str]]:
    (name,) = view.measures
    found: list[tuple[Artist, str]] = [
        (Patch(facecolor=_TINTS[flag], lw=0.0), outcomes.WORDS.get(flag, flag))
        for code, flag in enumerate(flags)
        if flag in _TINTS and np.any(dataset[name].values == code)
    ]
    held = outcomes.captured(dataset)
    if held is not None and name != "captured" and np.any(held == 1) and np.any(held == 0):
        between = f"{outcomes.WORDS['captured']} | {outcomes.WORDS['rebounds']}"
        found.append((Line2D([], [], **outcomes.BOUNDARY), between))
    if outcomes.failed(dataset).any():
        found.append((Patch(**outcomes.FAILED_CELL), "failed"))
    return found
