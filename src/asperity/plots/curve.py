"""Force against separation, in and out, and the energy lost between."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes

from asperity.plots import style
from asperity.plots.style import Panel, Row
from asperity.results.colours import colour
from asperity.results.result import Curve

_DWARFED = 4.0


def panels(curve: Curve) -> Row:
    """The whole curve; beside it the pull-off where contact forces dwarf it.

    Without a pull-off the difference of the branches stands there: the loss.
    """
    row = [Panel(1.0, lambda axes: _branches(axes, curve, zoomed=False))]
    push = np.nanmax(curve.force_loading, initial=0.0)
    if 0.0 < _DWARFED * curve.pull_off < push:
        row.append(Panel(1.0, lambda axes: _branches(axes, curve, zoomed=True)))
    elif curve.pull_off <= 0.0 < curve.loss:
        row.append(Panel(1.0, lambda axes: _difference(axes, curve)))
    return row


def _branches(axes: Axes, curve: Curve, *, zoomed: bool) -> None:
    metres = style.scaled_axis(axes.xaxis, "rigid separation", curve.rigid_separation, unit="m")
    size = np.array([curve.pull_off]) if zoomed else curve.force_loading
    newtons = style.scaled_axis(axes.yaxis, "force", size, unit="N")
    gap = curve.rigid_separation / metres
    inward, outward = curve.force_loading / newtons, curve.force_unloading / newtons
    axes.axhline(0.0, color=colour("quiet"), lw=0.4, zorder=0)
    axes.fill_between(gap, inward, outward, color=colour("lost"), lw=0.0, label="energy lost")
    axes.plot(gap, inward, color=colour("loading"), label="loading")
    axes.plot(gap, outward, color=colour("unloading"), ls=(0, (5, 1.5)), label="unloading")
    _jumps(axes, curve, metres, newtons)
    axes.margins(x=0.02)
    if zoomed:
        _frame(axes, curve, metres, newtons)
        axes.set_title("pull-off")
    else:
        style.legend_above(axes)


def _jumps(axes: Axes, curve: Curve, metres: float, newtons: float) -> None:
    """Jump-in and jump-out of a body on a spring, each along the spring's line.

    A soft spring may let the body jump far off the picture.
    """
    low, high = curve.rigid_separation.min(), curve.rigid_separation.max()
    found = [jump for jump in (curve.jumps or {}).values() if isinstance(jump, dict)]
    ends = [jump["landing_separation"] for jump in found]
    seen = [low, high, *(end for end in ends if low - end < high - low > end - high)]
    margin = 0.03 * (max(seen) - min(seen))
    axes.set_xlim((min(seen) - margin) / metres, (max(seen) + margin) / metres)
    for way, tint in (("in", "loading"), ("out", "unloading")):
        jump = (curve.jumps or {}).get(way)
        if jump is None:
            continue
        places = np.array([jump["separation"], jump["landing_separation"]]) / metres
        forces = np.array([jump["force"], jump["landing_force"]]) / newtons
        axes.plot(places, forces, ":", lw=0.9, color=colour(tint))
        axes.plot(places[:1], forces[:1], "o", ms=3.5, color=colour(tint), label=f"jump-{way}")
        axes.plot(places[1:], forces[1:], "o", ms=3.5, mfc="none", color=colour(tint))


def _difference(axes: Axes, curve: Curve) -> None:
    metres = style.scaled_axis(axes.xaxis, "rigid separation", curve.rigid_separation, unit="m")
    difference = curve.force_unloading - curve.force_loading
    newtons = style.scaled_axis(axes.yaxis, "unloading less loading", difference, unit="N")
    gap = curve.rigid_separation / metres
    axes.axhline(0.0, color=colour("quiet"), lw=0.4, zorder=0)
    axes.fill_between(gap, 0.0, difference / newtons, color=colour("lost"), lw=0.0)
    axes.plot(gap, difference / newtons, color=colour("unloading"))
    axes.margins(x=0.02)
    axes.set_title("energy lost")


def _frame(axes: Axes, curve: Curve, metres: float, newtons: float) -> None:
    """The part of the curve where forces are of the size of the pull-off."""
    pull = curve.pull_off
    near = np.minimum(np.abs(curve.force_loading), np.abs(curve.force_unloading)) < 1.5 * pull
    felt = np.maximum(np.abs(curve.force_loading), np.abs(curve.force_unloading)) > 0.01 * pull
    span = curve.rigid_separation[near & felt]
    if span.size > 1:
        margin = 0.08 * np.ptp(span)
        axes.set_xlim((span.min() - margin) / metres, (span.max() + margin) / metres)
    axes.set_ylim(-1.3 * pull / newtons, 1.3 * pull / newtons)
