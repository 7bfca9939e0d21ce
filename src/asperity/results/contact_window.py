"""The stretch of time in which a motion's first contact is shown."""

from __future__ import annotations

import numpy as np

from .result import Result

_SEEN = 2e-3
_MARGIN = 0.15


def contact_window(result: Result) -> tuple[float, float] | None:
    """From when to when [s] the first contact lasts, with some free flight; None without one.

    It lasts while a force exceeds a small share of its largest value before the first apex: the
    contact force of the peak, a pull of the largest pull, so that a weak but long pull counts too.
    """
    deepest, tops = (
        result.events.get(f"{turn}_time", np.empty(0)) for turn in ("closest_approach", "apex")
    )
    if deepest.size == 0 or "contact" not in result.forces:
        return None
    last = tops[0] if tops.size else result.time[-1]
    flight = slice(0, int(np.searchsorted(result.time, last, side="right")))
    time = result.time[flight]
    seen = np.zeros(time.size, dtype=bool)
    for name in ("contact", "adhesion", "capillary"):
        force = np.abs(result.forces.get(name, np.zeros_like(result.time))[flight])
        largest = force.max(initial=0.0)
        if largest > 0.0:
            seen |= force > (_SEEN if name == "contact" else 20 * _SEEN) * largest
    if not seen.any():
        return None
    at = int(np.argmin(np.abs(time - deepest[0])))
    before, after = np.flatnonzero(~seen[: at + 1]), np.flatnonzero(~seen[at:])
    start = time[before[-1] if before.size else 0]
    end = time[at + after[0] if after.size else -1]
    margin = _MARGIN * (end - start)
    return max(float(start - margin), float(time[0])), min(float(end + margin), float(time[-1]))
