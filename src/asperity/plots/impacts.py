"""Where the impacts are in a motion: the window of the first contact, the largest of each."""

from __future__ import annotations

import numpy as np

from asperity.results.contact_window import contact_window
from asperity.results.result import Result

_LEGIBLE = 25
_MOST = 0.6

MANY = 3
"""Impacts or rebounds from which a panel shows what each of them has."""


def times(result: Result, turn: str) -> np.ndarray:
    """Times [s] of the tops ("apex") or of the closest approaches; none where none was reached."""
    found: np.ndarray = result.events.get(f"{turn}_time", np.empty(0))
    return found


def first_contact(result: Result) -> slice | None:
    """The points of the first contact with some free flight at both ends; None without one."""
    window = contact_window(result)
    if window is None:
        return None
    first, final = (int(index) for index in np.searchsorted(result.time, window))
    return slice(max(first - 1, 0), final + 1)


def beginning(result: Result) -> tuple[slice, str]:
    """The points that one can tell apart on a page, and what to add to the axis of time.

    All of them, unless there are many rebounds that die away slowly; then the first ones.
    """
    tops = times(result, "apex")
    if tops.size <= _LEGIBLE or tops[_LEGIBLE - 1] > _MOST * tops[-1]:
        return slice(None), ""
    end = int(np.searchsorted(result.time, tops[_LEGIBLE - 1], side="right"))
    return slice(0, end), f", first {_LEGIBLE} of {tops.size} rebounds"


def largest(result: Result, name: str, sign: float) -> np.ndarray:
    """Largest push (sign 1) or pull (sign -1) of a force in each impact [N]."""
    force = result.forces.get(name)
    deepest = times(result, "closest_approach")
    if force is None or deepest.size == 0:
        return np.empty(0)
    tops = times(result, "apex")[: deepest.size - 1]
    starts = np.concatenate([[0], np.searchsorted(result.time, tops)])
    starts = starts[: deepest.size]
    return np.maximum(np.maximum.reduceat(sign * force, starts), 0.0)


def lost(result: Result, name: str) -> np.ndarray:
    """Energy that a channel of losses took from apex to apex, per impact [J]."""
    deepest = times(result, "closest_approach")
    tops = times(result, "apex")[: max(deepest.size - 1, 0)]
    ends = np.concatenate([result.time[:1], tops, result.time[-1:]])[: deepest.size + 1]
    taken: np.ndarray = np.diff(np.interp(ends, result.time, result.energies[name]))
    return taken


def reference(result: Result) -> float | None:
    """Separation from which heights of rebound count [m]: at rest, or the conjunction's edge."""
    heights = result.measures.get("rebound_height") or []
    tops = result.events.get("apex_separation", np.empty(0))
    for height, top in zip(heights, tops, strict=False):
        if height is not None:
            return float(top) - float(height)
    return None
