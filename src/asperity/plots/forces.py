"""Forces of the first contact, and the largest of every impact."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes

from asperity.plots import impacts, style
from asperity.plots.style import Panel, Row
from asperity.results.colours import colour
from asperity.results.result import Result

_PULLS = ("adhesion", "capillary")
_SMALL = 0.2
_VISIBLE = 0.01  # of the force of contact


def panels(result: Result) -> Row:
    """First contact; its pulls on their own scale where they are small; peaks where many.

    A panel of one pull has its name on the axis, so that no name stands twice in the legends.
    """
    shown = [name for name in ("contact", "elastic", *_PULLS) if name in result.forces]
    others = [name for name in result.forces if name not in (*shown, "weight", "total")]
    others = [name for name in others if _seen(result, name)]
    if impacts.first_contact(result) is None and "weight" in result.forces:
        shown.append("weight")  # no contact acts yet
    row = [Panel(1.0, lambda axes: _contact(axes, result, [*shown, *others]))]
    pulls = [name for name in _PULLS if np.any(result.forces.get(name, 0.0))]
    peak = np.max(np.abs(result.forces.get("contact", np.zeros(1))))
    pull = max((np.max(np.abs(result.forces[name])) for name in pulls), default=0.0)
    if 0.0 < pull < _SMALL * peak:
        row.append(Panel(1.0, lambda axes: _contact(axes, result, pulls)))
    many = impacts.times(result, "closest_approach").size >= impacts.MANY
    if many and (peak > 0.0 or pull > 0.0):
        row.append(Panel(0.9, lambda axes: _peaks(axes, result)))
    return row


def _seen(result: Result, name: str) -> bool:
    """Whether a force of the first contact is more than a line at 0 beside the contact's."""
    points = impacts.first_contact(result) or slice(None)
    largest, whole = (np.max(np.abs(result.forces[key][points])) for key in (name, "contact"))
    return bool(largest >= _VISIBLE * whole)


def _contact(axes: Axes, result: Result, names: list[str]) -> None:
    points = impacts.first_contact(result)
    start = 0.0 if points is None else result.events["closest_approach_time"][0]
    points = points or slice(None)
    time = result.time[points] - start
    forces = {name: result.forces[name][points] for name in names}
    since = "time from closest approach" if start else "time since release"
    seconds = style.scaled_axis(axes.xaxis, since, time, unit="s")
    named = names[0] if len(names) == 1 else "force"
    newtons = style.scaled_axis(axes.yaxis, named, *forces.values(), unit="N")
    axes.axhline(0.0, color=colour("quiet"), lw=0.4, zorder=0)
    for name, force in forces.items():
        whole = name == "contact"
        axes.plot(
            time / seconds,
            force / newtons,
            color=colour(name),
            lw=1.8 if whole else 1.0,
            alpha=0.35 if whole else 1.0,
            label="contact, all" if whole else name,
        )
    axes.margins(x=0.0)
    if len(names) > 1:
        style.legend_above(axes)


def _peaks(axes: Axes, result: Result) -> None:
    found = {
        "push": impacts.largest(result, "contact", 1.0),
        **{name: impacts.largest(result, name, -1.0) for name in _PULLS},
    }
    found = {name: np.where(f > 0.0, f, np.nan) for name, f in found.items() if np.any(f > 0.0)}
    newtons = style.scaled_axis(axes.yaxis, "largest force", *found.values(), unit="N")
    for name, force in found.items():
        tint = colour("contact" if name == "push" else name)
        style.dots(axes, np.arange(1, force.size + 1), force / newtons, tint, name)
    style.log_axis(axes, *found.values())
    style.count_axis(axes, "impact")
    style.legend_above(axes, 2)
