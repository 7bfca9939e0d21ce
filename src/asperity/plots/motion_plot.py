"""Separation against time, and how the rebounds die away."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes

from asperity.plots import impacts, style
from asperity.plots.style import Panel, Row
from asperity.results.colours import colour
from asperity.results.result import Result

_TURNS = (("apex", "^", "top of rebound"), ("closest_approach", "v", "closest approach"))


def panels(result: Result) -> Row:
    """The whole motion; beside it the heights of rebound, or the first contact if they are few."""
    row = [Panel(2.0, lambda axes: _whole(axes, result))]
    heights = _heights(result)
    if np.count_nonzero(heights > 0.0) >= impacts.MANY:
        row.append(Panel(1.0, lambda axes: _rebounds(axes, result, heights)))
    elif impacts.first_contact(result) is not None:
        row.append(Panel(1.0, lambda axes: _first(axes, result)))
    return row


def _heights(result: Result) -> np.ndarray:
    """Heights of release and rebounds above the static equilibrium [m]; NaN where below it.

    A body that is launched counts with the height v^2/2g that its speed is worth, since the
    rebounds are to be compared with its energy; without gravity there is no such height.
    """
    base = impacts.reference(result)
    if base is None:
        return np.empty(0)
    tops = [h if h is not None else np.nan for h in result.measures.get("rebound_height") or []]
    release = result.separation[0] - base
    if _launched(result):
        weight = abs(float(result.forces.get("weight", np.zeros(1))[0]))
        release += result.energies["kinetic"][0] / weight if weight > 0.0 else np.nan
    found = np.array([release, *tops], dtype=float)
    return np.where(found > 0.0, found, np.nan)


def _launched(result: Result) -> bool:
    """Whether the body is released with a speed."""
    return bool(result.speed[0] != 0.0)


def _whole(axes: Axes, result: Result) -> None:
    points, shown = impacts.beginning(result)
    time, gap = result.time[points], result.separation[points]
    seconds, time_unit = style.scale_of(time, unit="s")
    metres = style.scaled_axis(axes.yaxis, "separation", gap, unit="m")
    _central(axes, result, points, time / seconds, metres)
    axes.plot(time / seconds, gap / metres, color=colour("motion"), label="rigid separation")
    for turn, sign, text in _TURNS:
        found = impacts.times(result, turn)
        seen = found <= time[-1]
        if seen.any():
            place = result.events[f"{turn}_separation"][seen] / metres
            axes.plot(
                found[seen] / seconds, place, sign, ms=3.0, mew=0.0, color=colour(turn), label=text
            )
    base = impacts.reference(result)
    if base is not None:
        axes.axhline(
            base / metres, color=colour("quiet"), lw=0.6, ls=(0, (4, 3)), zorder=0,
            label=_reference_name(result),
        )  # fmt: skip
    axes.set_xlabel(style.label("time since release", time_unit) + shown)
    axes.set_xlim(0.0, time[-1] / seconds)
    style.legend_above(axes)


def _reference_name(result: Result) -> str:
    """What rebounds are counted from."""
    if result.case.publication is None:
        return "static equilibrium"
    return "edge of the conjunction"


def _central(axes: Axes, result: Result, points: slice, time: np.ndarray, metres: float) -> None:
    """The central separation, where one can tell it from the rigid one."""
    rigid, central = result.separation[points], result.central_separation[points]
    if np.nanmax(np.abs(central - rigid)) > 5e-3 * np.ptp(rigid):
        axes.plot(time, central / metres, color=colour("central"), label="with deformation", lw=0.8)


def _rebounds(axes: Axes, result: Result, heights: np.ndarray) -> None:
    above = "rest" if result.case.publication is None else "the edge"
    metres = style.scaled_axis(axes.yaxis, f"height above {above}", heights, unit="m")
    number = np.arange(heights.size)
    axes.plot(number, heights / metres, "-", lw=0.5, color=colour("quiet"))
    style.dots(axes, number, heights / metres, colour("apex"))
    style.log_axis(axes, heights)
    release = "release + v²/2g" if _launched(result) else "release"
    style.count_axis(axes, f"rebound (0: {release})" if np.isfinite(heights[0]) else "rebound")


def _first(axes: Axes, result: Result) -> None:
    points = impacts.first_contact(result)
    assert points is not None
    time = result.time[points] - result.events["closest_approach_time"][0]
    gap = result.separation[points]
    seconds = style.scaled_axis(axes.xaxis, "time from closest approach", time, unit="s")
    both = (gap, result.central_separation[points])
    metres = style.scaled_axis(axes.yaxis, "separation", *both, unit="m")
    _central(axes, result, points, time / seconds, metres)
    axes.plot(time / seconds, gap / metres, color=colour("motion"))
    axes.margins(x=0.0)
    axes.set_title("first contact")
