"""When to sample a flight."""

from __future__ import annotations

import numpy as np


def flight_times(span: float, scale: float, points: int = 16) -> np.ndarray:
    """Times within a flight of a ``span`` [s] at which to sample it, its start left out.

    Even ones, and some that close in on both ends as near as a ``scale`` [s].
    """
    near = np.geomspace(min(0.1 * scale, 0.01 * span), 0.5 * span, points) if span > 0.0 else 0.0
    even = span * np.linspace(0.0, 1.0, 2 * points + 1)[1:]
    times = np.unique(np.append(even, [near, span - near]))
    return times[times > 0.0] if span > 0.0 else np.zeros(1)
