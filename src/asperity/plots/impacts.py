"""Where the impacts are in a motion: the window of the first contact, the largest of each."""

from __future__ import annotations

import numpy as np

from asperity.results.result import Result

_SEEN = 2e-3
_MARGIN = 0.15
_LEGIBLE = 25
_MOST = 0.6

MANY = 3
"""Impacts or rebounds from which a panel shows what each of them has."""


def times(result: Result, turn: str) -> np.ndarray:
    """Times [s] of the tops ("apex") or of the closest approaches; none where none was reached."""
    found: np.ndarray = result.events.get(f"{turn}_time", np.empty(0))
    return found


def first_contact(result: Result) -> slice | None:
    """The points of the first contact with some free flight at both ends; None without one.

    The contact lasts while a force exceeds a small share of its largest value: the contact force
    of the peak, a pull of the largest pull, so that a weak but long pull is seen too.
    """
    deepest = times(result, "closest_approach")
    if deepest.size == 0 or "contact" not in result.forces:
        return None
    tops = times(result, "apex")
    last = tops[0] if tops.size else result.time[-1]
    flight = slice(0, int(np.searchsorted(result.time, last, side="right")))
    seen = np.zeros(result.time[flight].size, dtype=bool)
    for name in ("contact", "adhesion", "capillary"):
        force = np.abs(result.forces.get(name, np.zeros_like(result.time))[flight])
        largest = force.max(initial=0.0)
        if largest > 0.0:
            seen |= force > (_SEEN if name == "contact" else 20 * _SEEN) * largest
    if not seen.any():
        return None
    at = int(np.argmin(np.abs(result.time[flight] - deepest[0])))
    before, after = np.flatnonzero(~seen[: at + 1]), np.flatnonzero(~seen[at:])
    start = result.time[before[-1] if before.size else 0]
    end = result.time[at + after[0] if after.size else seen.size - 1]
    margin = _MARGIN * (end - start)
    first = int(np.searchsorted(result.time, start - margin))
    final = int(np.searchsorted(result.time, end + margin, side="right"))
    return slice(max(first - 1, 0), min(final + 1, flight.stop))


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
