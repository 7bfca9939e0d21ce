"""The opponent: the same rigid rough drop as a plain SciPy script.

Heights by Gauss-Legendre quadrature at every call of the force, `solve_ivp` (DOP853) with an
event at every turning point and switch of the meniscus memory. It knows nothing of asperity.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.integrate import solve_ivp
from scipy.special import ndtr

NODES, WEIGHTS = np.polynomial.legendre.leggauss(80)


@dataclass(frozen=True)
class Drop:
    """A rough sphere on a rigid plane, in SI units."""

    radius: float
    modulus: float
    density: float
    summit_radius: float
    rms: float
    work: float
    pull: float
    interaction_range: float
    mass: float
    gravity: float
    release: float

    def force(self, d: float, threshold: float) -> float:
        """Contact force: Hertz and DMT on contacting asperities, menisci on bonded ones."""
        edge = min(max(d - threshold, 0.0), self.interaction_range)
        bonded = d - edge
        top = max(d, 0.0) + 9.0 * self.rms
        total = 0.0
        if d < top:
            half = 0.5 * (top - d)
            z = d + half * (NODES + 1.0)
            tail = ndtr(-z / self.rms) * half * WEIGHTS
            overlap = z - d
            hertz = 4.0 / 3.0 * self.modulus * np.sqrt(self.summit_radius) * overlap**1.5
            dmt = 2.0 * np.pi * self.summit_radius * self.work
            total += float(tail @ (hertz - dmt - self.pull))
        half = 0.5 * (d - bonded)
        if half > 0.0:
            z = bonded + half * (NODES + 1.0)
            tail = ndtr(-z / self.rms) * half * WEIGHTS
            total -= float(tail @ (self.pull * (1.0 - (d - z) / self.interaction_range)))
        return 2.0 * np.pi * self.radius * self.density * total


def integrate(drop: Drop, impacts: int, tolerance: float = 1e-8) -> list[float]:
    """Apex separations of the first impacts [m]."""
    apexes, place, time, threshold = [], drop.release, 0.0, np.inf
    scale = 1e-9
    for _ in range(impacts):
        for sign in (-1.0, 1.0):
            place, time = _phase(drop, place, time, threshold, sign, tolerance, scale)
            low, high = place - drop.interaction_range, place
            threshold = min(max(threshold, low), high)
        apexes.append(place)
    return apexes


def _phase(
    drop: Drop, place: float, time: float, old: float, sign: float, tolerance: float, scale: float
) -> tuple[float, float]:
    """From one turning point to the next; the state in nanometres and microseconds."""

    def rate(_: float, y: np.ndarray) -> list[float]:
        d = y[0] * scale
        acceleration = drop.force(d, old) / drop.mass - drop.gravity
        return [y[1], acceleration * 1e-12 / scale]

    def turns(_: float, y: np.ndarray) -> float:
        return float(y[1])

    turns.terminal, turns.direction = True, -sign  # type: ignore[attr-defined]
    first = rate(0.0, np.array([place / scale, 0.0]))[1]
    nudge = 1e-3
    start = [place / scale + 0.5 * first * nudge**2, first * nudge]
    answer = solve_ivp(
        rate, (0.0, 1e5), start, "DOP853", events=turns, rtol=tolerance, atol=tolerance
    )
    return float(answer.y_events[0][0][0]) * scale, time + float(answer.t[-1] + nudge) * 1e-6
