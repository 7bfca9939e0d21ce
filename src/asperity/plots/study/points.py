"""Cases as points: a sample over its axes, and the Pareto front of two measures."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.lines import Line2D

from asperity.plots.study import outcomes
from asperity.plots.study.drawn_quantities import Quantity, axis_quantity, measure_quantity
from asperity.plots.study.panels import Block, Page
from asperity.results.colours import colour
from asperity.sweeps.analysis.pareto import Front, numbers
from asperity.sweeps.analysis.view import View, axes_of

if TYPE_CHECKING:
    import xarray

_MOST = 20_000
"""Points that are drawn; of more, so many are taken at random."""

_FEW = 500
_MARKED = 40
_SMALL, _LARGE = 1.2, 2.5
_SPREAD = 0.3


def sample_page(dataset: xarray.Dataset, view: View, title: str) -> Page:
    """A measure of a sample over each of its axes, or over one."""
    (name,) = view.measures
    values = numbers(dataset, name)
    drawn, note = _some(np.flatnonzero(np.isfinite(values)))
    keys = [view.x] if view.x else list(axes_of(dataset))
    y = measure_quantity(values, dataset[name])
    kinds = _kinds(dataset, drawn)
    blocks = [Block("", _over(axis_quantity(dataset[key]), y, drawn, kinds)) for key in keys]
    about = ", ".join(part for part in (title, note) if part)
    return Page(about, blocks, min(len(blocks), 2), _legend(kinds))


def front_page(dataset: xarray.Dataset, front: Front, title: str) -> Page:
    """All cases over two measures, with the front."""
    x, y = (
        measure_quantity(values, dataset[goal.measure])
        for goal, values in zip(front.goals, front.values, strict=True)
    )
    drawn, note = _some(np.arange(front.cases.size))
    kinds = _kinds(dataset, front.cases[drawn])
    marker = "o" if front.best.size <= _MARKED else ""

    def draw(axes: Axes) -> None:
        for index, tint, _ in kinds:
            _scatter(axes, x.values[drawn][index], y.values[drawn][index], tint)
        # In the order of the front, the first measure getting worse, whichever way that is.
        axes.plot(
            x.values[front.best], y.values[front.best], drawstyle="steps-post", marker=marker,
            ms=3.0, mew=0.8, mfc="none", color=colour("contact"), lw=0.8, zorder=3,
        )  # fmt: skip
        x.dress(axes, "x")
        y.dress(axes, "y")

    handle = Line2D([], [], marker=marker, ms=3.0, mew=0.8, mfc="none", lw=0.8,
                    color=colour("contact"))  # fmt: skip
    legend = [*_legend(kinds), (handle, f"front, {front.best.size} cases")]
    about = ", ".join(part for part in (title, note) if part)
    return Page(about, [Block("", draw)], 1, legend)


Kind = tuple[np.ndarray, str, str]


def _kinds(dataset: xarray.Dataset, cases_drawn: np.ndarray) -> list[Kind]:
    """Cases that rebound and cases that are captured: indices among those drawn, colour, name."""
    held = outcomes.captured(dataset)
    if held is None:
        return [(np.arange(cases_drawn.size), outcomes.REBOUNDS, "")]
    held = held.ravel()[cases_drawn]
    found = [
        (np.flatnonzero(held == 0), outcomes.REBOUNDS, outcomes.WORDS["rebounds"]),
        (np.flatnonzero(held == 1), outcomes.CAPTURED, outcomes.WORDS["captured"]),
        (np.flatnonzero(held < 0), colour("quiet"), "undecided"),
    ]
    return [kind for kind in found if kind[0].size]


def _legend(kinds: list[Kind]) -> list[tuple[Artist, str]]:
    return [
        (Line2D([], [], ls="", marker="o", ms=3.0, mew=0.0, color=tint), name)
        for _, tint, name in kinds
        if name
    ]


def _some(found: np.ndarray) -> tuple[np.ndarray, str]:
    """As many cases as a picture shows, and what to say where it leaves some out."""
    if found.size <= _MOST:
        return found, ""
    chosen = np.random.default_rng(0).choice(found, _MOST, replace=False)
    return np.sort(chosen), f"{_MOST} of {found.size} cases shown"


def _over(x: Quantity, y: Quantity, drawn: np.ndarray, kinds: list[Kind]) -> Callable[[Axes], None]:
    place = x.values[drawn].astype(float)
    if x.names:  # beside each other, or all would stand on one line
        place += np.random.default_rng(0).uniform(-_SPREAD, _SPREAD, place.size)

    def draw(axes: Axes) -> None:
        for index, tint, _ in kinds:
            _scatter(axes, place[index], y.values[drawn][index], tint)
        x.dress(axes, "x")
        y.dress(axes, "y")

    return draw


def _scatter(axes: Axes, x: np.ndarray, y: np.ndarray, tint: str) -> None:
    size = _LARGE if x.size <= _FEW else _SMALL
    axes.plot(x, y, "o", ms=size, mew=0.0, color=tint, alpha=0.6, rasterized=x.size > _FEW)
