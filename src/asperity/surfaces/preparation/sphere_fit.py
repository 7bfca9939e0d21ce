"""The sphere of least squares under a cap of heights."""

from __future__ import annotations

from dataclasses import dataclass
from math import inf, sqrt

import numpy as np

from ..topography import Topography

_BLOCK = 64
"""Rows that are summed at a time, so that no array of partial derivatives fills the memory."""

_STEPS = 60
"""Gauss-Newton steps, at most; a cap takes about five."""

_LEAST_STEP = 1e-15
"""Of a parameter, in units: a smaller change is lost in rounding."""

_SAMPLED = 256
"""Pixels a side, about, from which the first guess is made."""

_ENOUGH = 1e-12
"""Share of the sum of squares that a last step would have gained."""


@dataclass(frozen=True)
class Cap:
    """A sphere through a point above the centre of the map.

    Parameters
    ----------
    parameters
        Height z0, slopes a and b along x and y at the centre, and k = sqrt(1 + a^2 + b^2)/R with
        the sign of the second derivative; heights and k in units of ``unit``.
    unit
        Half of the map's longer side [m].

    Notes
    -----
    Points of the sphere obey zeta = Q + k zeta^2/2 with zeta = z - z0 and
    Q = a x + b y + k (x^2 + y^2)/2, so zeta = 2 Q/(1 + sqrt(1 - 2 k Q)): a plane at k = 0, and
    smooth through it.
    """

    parameters: np.ndarray
    unit: float

    @property
    def slopes(self) -> tuple[float, float]:
        """Slope (x, y) [-] at the centre of the map."""
        return float(self.parameters[1]), float(self.parameters[2])

    @property
    def radius(self) -> float:
        """Radius [m], positive where the sphere bulges up; infinite for a plane."""
        _, a, b, k = self.parameters
        return float(-sqrt(1.0 + a**2 + b**2) / k * self.unit) if k != 0.0 else inf

    def heights(self, topography: Topography) -> np.ndarray:
        """Heights [m] of the sphere at the pixels of the map; NaN where it has none."""
        x, y = _places(topography, self.unit)
        z, root, _ = _sphere(self.parameters, x, y[:, None])
        level = np.nanmean(topography.heights)
        return level + self.unit * np.where(root > 0.0, z, np.nan)


def fitted_sphere(topography: Topography) -> Cap:
    """The sphere of the least squares of vertical distance, by Gauss-Newton steps.

    Parameters
    ----------
    topography
        A cap: heights that one half of a sphere can have.

    Returns
    -------
    The sphere.

    Raises
    ------
    InputError
        If fewer than four pixels, or only pixels on a line or a circle, are left to fit, or if
        no sphere passes over all of them.
    """
    unit = 0.5 * max(topography.physical_size)
    x, y = _places(topography, unit)
    z = (topography.heights - np.nanmean(topography.heights)) / unit
    found = _first_guess(x, y, z)
    cost, gradient, normal = _sums(found, x, y, z)
    if cost == inf:
        # A plane has a height everywhere: the way from there is longer, but it exists.
        found = np.zeros(4)
        cost, gradient, normal = _sums(found, x, y, z)
    for _ in range(_STEPS):
        if np.linalg.matrix_rank(normal, hermitian=True, tol=1e-10 * normal[0, 0]) < 4:
            break
        step = np.linalg.solve(normal, gradient)
        if gradient @ step <= _ENOUGH * cost + np.finfo(float).eps ** 2 * normal[0, 0]:
            return Cap(found, unit)
        trial = _sums(found + step, x, y, z)
        while trial[0] > cost and abs(step).max() > _LEAST_STEP:
            step = 0.5 * step
            trial = _sums(found + step, x, y, z)
        if trial[0] == inf:
            break
        found, (cost, gradient, normal) = found + step, trial
    raise topography._error(
        "no sphere fits the heights, for they are too few, too steep or on a line or circle; got "
        f"{np.isfinite(z).sum()} pixels; remove 'curvature' instead"
    )


def _places(topography: Topography, unit: float) -> tuple[np.ndarray, np.ndarray]:
    """Coordinates along x and along y from the centre of the map, in units."""
    x, y = (
        (np.arange(count) - 0.5 * (count - 1)) * step / unit
        for count, step in zip(topography.heights.shape[::-1], topography.pixel_size, strict=True)
    )
    return x, y


def _sphere(
    parameters: np.ndarray, x: np.ndarray, y: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Height, what the root is taken of (no height where it is negative) and x^2 + y^2."""
    z0, a, b, k = parameters
    square = x**2 + y**2
    slanted = a * x + b * y + 0.5 * k * square
    under = 1.0 - 2.0 * k * slanted
    return z0 + 2.0 * slanted / (1.0 + np.sqrt(np.maximum(under, 0.0))), under, square


def _first_guess(x: np.ndarray, y: np.ndarray, z: np.ndarray) -> np.ndarray:
    """Parameters of the sphere of least algebraic distance, which solves a linear problem.

    It is regressed from z = c0 + c1 x + c2 y + c3 (x^2 + y^2 + z^2): exact without roughness.
    """
    every = max(1, max(z.shape) // _SAMPLED)
    z = z[::every, ::every]
    y, x = np.meshgrid(y[::every], x[::every], indexing="ij")
    seen = np.isfinite(z)
    x, y, z = x[seen], y[seen], z[seen]
    terms = np.stack([np.ones_like(x), x, y, x**2 + y**2 + z**2], axis=-1)
    level, a, b, c = np.linalg.lstsq(terms, z)[0]
    under = 1.0 - 4.0 * c * level
    z0 = 2.0 * level / (1.0 + sqrt(max(under, 0.0)))
    share = 1.0 - 2.0 * c * z0
    return np.array([z0, a / share, b / share, 2.0 * c / share]) if share > 0.0 else np.zeros(4)


def _sums(
    parameters: np.ndarray, x: np.ndarray, y: np.ndarray, z: np.ndarray
) -> tuple[float, np.ndarray, np.ndarray]:
    """Sum of squares, half its negative gradient and the normal matrix, in units.

    The sum is infinite where a pixel lies beyond the edge of the sphere.
    """
    sums = np.zeros((5, 5))
    for start in range(0, y.size, _BLOCK):
        rows = slice(start, start + _BLOCK)
        seen = np.isfinite(z[rows])
        sphere, under, square = _sphere(parameters, x, y[rows, None])
        if (under[seen] <= 0.0).any():
            return inf, np.zeros(4), np.eye(4)
        root = np.sqrt(np.where(seen, under, 1.0))
        parts = (
            np.ones_like(root),
            x / root,
            y[rows, None] / root,
            0.5 * (square + (sphere - parameters[0]) ** 2) / root,
            z[rows] - sphere,
        )
        columns = np.stack([part[seen] for part in parts])
        sums += columns @ columns.T
    return float(sums[4, 4]), sums[:4, 4], sums[:4, :4]
