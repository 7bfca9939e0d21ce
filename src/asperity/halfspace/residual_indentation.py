"""What a viscoelastic half-space remembers of where it was pressed, along a radius.

The Maxwell springs of the foundation (see :mod:`.viscoelastic_paraboloid`) are extended by z(x).
Between two radii at which the edge of contact has turned, z is smooth in an angle psi,
x = low + (high - low) sin^2(psi/2), since the edge passes each radius but the turns at a speed.
"""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Callable, Sequence
from math import asin, pi, sqrt

import numpy as np
from numpy.polynomial import chebyshev

from ..numerics.polynomials import from_points

_NODES = 14
_POINTS = chebyshev.chebpts1(_NODES)
_TO_SERIES = from_points(_NODES)
_UNTIL = chebyshev.chebvander(_POINTS, _NODES) @ chebyshev.chebint(_TO_SERIES, lbnd=-1, axis=0)
_WHOLE = chebyshev.chebvander(np.ones(1), _NODES) @ chebyshev.chebint(_TO_SERIES, lbnd=-1, axis=0)
_TO_POWERS = np.stack(
    [np.append(p, np.zeros(_NODES - len(p))) for p in map(chebyshev.cheb2poly, np.eye(_NODES))],
    axis=1,
)
_COARSEST = pi / 6.0  # of an angle's panels


class ResidualIndentation:
    """Extension z(x) of the Maxwell springs with its integrals, from the axis to an outer radius.

    All in units of one length.

    Parameters
    ----------
    radii
        Ascending radii between which z is smooth; the first is 0, beyond the last z is 0.
    finest
        Smallest panel of the angle at both ends of each interval.
    extension
        z at an array of radii.
    """

    def __init__(
        self,
        radii: Sequence[float] = (0.0,),
        finest: float = 1.0,
        extension: Callable[[np.ndarray], np.ndarray] | None = None,
    ) -> None:
        self.radii = list(radii)
        self.whole = 0.0, 0.0
        if extension is None:
            return
        ends = _graded(finest)
        middle, half = 0.5 * (ends[1:] + ends[:-1]), 0.5 * np.diff(ends)
        angle = middle[:, None] + half[:, None] * _POINTS
        low, width = np.array(radii[:-1]), np.diff(radii)
        radius = low[:, None, None] + width[:, None, None] * np.sin(0.5 * angle) ** 2
        z = extension(radius.ravel()).reshape(radius.shape)
        weight = 0.5 * width[:, None, None] * (np.sin(angle) * half[:, None])
        once, first = _integrated(z * weight)
        twice, second = _integrated(z**2 * weight)
        self.whole = first, second
        self._ends = ends.tolist()
        powers = [(c @ _TO_SERIES.T @ _TO_POWERS.T)[..., ::-1] for c in (z, once, twice)]
        self._pieces = list(zip(*(c.reshape(-1, _NODES).tolist() for c in powers), strict=True))

    @property
    def outer(self) -> float:
        """Radius beyond which nothing was pressed."""
        return self.radii[-1]

    def at(self, radius: float) -> tuple[float, float]:
        """Extension z and its slope dz/dx at a radius."""
        if radius >= self.outer:
            return 0.0, 0.0
        (z, _, _), local, stretch = self._find(radius)
        value = slope = 0.0
        for c in z:
            slope = slope * local + value
            value = value * local + c
        return value, slope * stretch

    def integrals(self, radius: float) -> tuple[float, float]:
        """Integrals of z and of z^2 from the axis to a radius."""
        if radius >= self.outer:
            return self.whole
        (_, first, second), local, _ = self._find(radius)
        once = twice = 0.0
        for c, d in zip(first, second, strict=True):
            once = once * local + c
            twice = twice * local + d
        return once, twice

    def over(self, radius: np.ndarray) -> np.ndarray:
        """Extension z at many radii."""
        return np.array([self.at(each)[0] for each in radius.tolist()])

    def _find(self, radius: float) -> tuple[tuple[list[float], ...], float, float]:
        """Polynomials at a radius, the place on their panel, and the slope of that place."""
        number = min(max(bisect_right(self.radii, radius) - 1, 0), len(self.radii) - 2)
        low, high = self.radii[number], self.radii[number + 1]
        share = min(max((radius - low) / (high - low), 0.0), 1.0)
        rest = min(max((high - radius) / (high - low), 0.0), 1.0)
        angle = 2.0 * asin(sqrt(share)) if share < 0.5 else pi - 2.0 * asin(sqrt(rest))
        ends = self._ends
        panel = min(max(bisect_right(ends, angle) - 1, 0), len(ends) - 2)
        begin, end = ends[panel], ends[panel + 1]
        local = (2.0 * angle - begin - end) / (end - begin)
        turn = max((high - low) * sqrt(share * rest), 1e-300)  # dx/dpsi
        return self._pieces[number * (len(ends) - 1) + panel], local, 2.0 / ((end - begin) * turn)


def _integrated(rate: np.ndarray) -> tuple[np.ndarray, float]:
    """Integral of a rate from the first panel on, at the points of all panels, and the whole."""
    each = (rate @ _WHOLE.T)[..., 0]
    until = np.cumsum(each.ravel())
    begun = np.append(0.0, until[:-1]).reshape(each.shape)
    return rate @ _UNTIL.T + begun[..., None], float(until[-1])


def _graded(finest: float) -> np.ndarray:
    """Ends of panels of an angle from 0 to pi that narrow to ``finest`` at both ends."""
    ends = [0.0]
    step = min(finest, _COARSEST)
    while ends[-1] + step < 0.5 * pi - 0.5 * step:
        ends.append(ends[-1] + step)
        step = min(2.0 * step, _COARSEST)
    half = np.array(ends)
    return np.unique(np.concatenate([half, [0.5 * pi], pi - half]))
