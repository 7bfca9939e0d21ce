"""Where the energy is: kinetic, potential, stored, and what each mechanism took."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes

from asperity.plots import impacts, style
from asperity.plots.style import Panel, Row
from asperity.results.colours import colour
from asperity.results.result import Result

_LEAST = 1e-9  # of the largest loss of an impact; less is rounding
_FLOATING = ("potential", "stored")


def panels(result: Result) -> Row:
    """The motion as far as one can tell it apart, the first contact, the losses of each impact."""
    points, shown = impacts.beginning(result)
    row = [Panel(1.7, lambda axes: _stack(axes, result, points, shown))]
    contact = impacts.first_contact(result)
    if contact is not None:
        row.append(Panel(1.0, lambda axes: _contact(axes, result, contact)))
    many = impacts.times(result, "closest_approach").size >= impacts.MANY
    losses = [values for name, values in result.energies.items() if name.startswith("lost_")]
    if many and any(np.any(values > 0.0) for values in losses):
        row.append(Panel(1.0, lambda axes: _losses(axes, result)))
    return row


def _stack(axes: Axes, result: Result, points: slice, shown: str) -> None:
    time_unit = _stacked(axes, result, points, 0.0)
    axes.set_xlabel(style.label("time since release", time_unit) + shown)
    style.legend_above(axes)


def _contact(axes: Axes, result: Result, points: slice) -> None:
    time_unit = _stacked(axes, result, points, result.events["closest_approach_time"][0])
    axes.set_xlabel(style.label("time from closest", time_unit))
    axes.set_title("first contact")


def _stacked(axes: Axes, result: Result, points: slice, start: float) -> str:
    """Energies on top of each other: with the losses lowest, the top edge stays level."""
    energies = _above_lowest(result)
    names = [name for name in energies if name.startswith("lost_")]
    names += [name for name in energies if name not in names]
    time = result.time[points] - start
    seconds, time_unit = style.scale_of(time, unit="s")
    total = np.sum(list(energies.values()), axis=0)
    joules = style.scaled_axis(axes.yaxis, "energy above lowest", total, unit="J")
    axes.stackplot(
        time / seconds,
        [energies[name][points] / joules for name in names],
        colors=[colour(name) for name in names],
        labels=[name.replace("lost_", "lost to ") for name in names],
        lw=0.0,
    )
    axes.margins(x=0.0, y=0.0)
    return time_unit


def _losses(axes: Axes, result: Result) -> None:
    """What each mechanism took in each impact, the flights on either side of it included."""
    found = {
        name: impacts.lost(result, name) for name in result.energies if name.startswith("lost_")
    }
    least = _LEAST * max(float(np.max(energy)) for energy in found.values())
    found = {n: np.where(e > least, e, np.nan) for n, e in found.items() if np.any(e > least)}
    joules = style.scaled_axis(axes.yaxis, "energy lost", *found.values(), unit="J")
    for name, energy in found.items():
        style.dots(axes, np.arange(1, energy.size + 1), energy / joules, colour(name))
    style.log_axis(axes, *found.values())
    if axes.get_yscale() == "linear":
        axes.set_ylim(bottom=0.0)
    style.count_axis(axes, "impact")
    axes.set_title("each impact")


def _above_lowest(result: Result) -> dict[str, np.ndarray]:
    """Energies with those whose zero is free counted from their lowest value of the motion."""
    return {
        name: values - values.min() if name in _FLOATING else values
        for name, values in result.energies.items()
    }
