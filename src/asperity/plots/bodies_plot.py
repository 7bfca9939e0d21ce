"""How single bodies differ at their first impact, with the mean field's value beside them."""

from __future__ import annotations

from functools import partial
from typing import Any

import numpy as np
from matplotlib.axes import Axes

from asperity.plots import style
from asperity.plots.style import Panel, Row
from asperity.results.colours import colour
from asperity.results.realisations import Realisations
from asperity.results.result import Result

_BINS = 25
_MEAN: Any = {"color": colour("contact"), "lw": 1.2, "label": "mean field"}


def panels(result: Result, found: Realisations) -> Row:
    """Restitution, the summits that touch and the pull-off force: shares of the bodies."""
    first = (result.measures.get("restitution") or [None])[0]
    kept = np.histogram_bin_edges(found.values["restitution"], _BINS, (0.0, 1.0))
    touching = found.values["contacting"]
    counts = np.arange(touching.min(), touching.max() + 2.0) - 0.5
    newtons, unit = style.scale_of(found.values["pull_off"], unit="N")
    pull = result.measures.get("pull_off")
    return [
        Panel(1.0, partial(_shares, values=found.values["restitution"], bins=kept, mean=first,
                           label="restitution (0: captured) [-]", legend=True)),
        Panel(1.0, partial(_shares, values=touching, bins=counts, whole=True,
                           mean=result.regime.get("contacting_asperities"),
                           label="summits that touch [-]")),
        Panel(1.0, partial(_shares, values=found.values["pull_off"] / newtons, bins=_BINS,
                           mean=None if pull is None else pull / newtons,
                           label=style.label("pull-off force", unit))),
    ]  # fmt: skip


def _shares(
    axes: Axes,
    *,
    values: np.ndarray,
    bins: Any,
    mean: float | None,
    label: str,
    whole: bool = False,
    legend: bool = False,
) -> None:
    """A histogram of shares of the bodies."""
    weights = np.full(values.size, 1.0 / values.size)
    axes.hist(values, bins=bins, weights=weights, color=colour("gas"), label="single bodies")
    if mean is not None:
        axes.axvline(mean, **_MEAN)
    axes.set(xlabel=label, ylabel="share of the bodies [-]")
    if whole:
        style.count_axis(axes, label)
    if legend:
        style.legend_above(axes)


def summits(found: Realisations) -> Row:
    """The first body seen from above at its turning point, on its summits."""
    return [Panel(1.0, lambda axes: _from_above(axes, **found.first))]


def _from_above(axes: Axes, x: np.ndarray, y: np.ndarray, gap: np.ndarray) -> None:
    metres = style.scaled_axis(axes.xaxis, "x", x, y, unit="m")
    style.scaled_axis(axes.yaxis, "y", x, y, unit="m")
    near = gap < 0.0
    for chosen, tint, label in (
        (near, colour("gas"), "summits in contact"),
        (~near, "none", "within the range of their forces"),
    ):
        axes.plot(
            x[chosen] / metres, y[chosen] / metres, "o", ms=4.0, mec=colour("gas"), mfc=tint,
            mew=0.8, label=label,
        )  # fmt: skip
    axes.plot([0.0], [0.0], "+", ms=5.0, mew=0.8, color=colour("contact"), label="axis")
    farthest = 1.1 * max(float(np.max(np.hypot(x, y))), 1e-30) / metres
    axes.set_aspect("equal", adjustable="datalim")
    axes.set(xlim=(-farthest, farthest), ylim=(-farthest, farthest))
    style.legend_above(axes, rows=2)
