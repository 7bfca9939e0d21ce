"""Summits at random places under a paraboloid, from the first to touch to the last."""

from __future__ import annotations

from math import pi
from typing import NamedTuple

import numpy as np
from scipy.special import ndtr

WIDTH = 256
"""Bodies whose summits are drawn together: the numbers depend on nothing else."""

_GRID = np.linspace(9.0, -60.0, 6901)  # heights over the rms height, from where next to none is
_NEWTON = 3


class SummitField(NamedTuple):
    r"""A Poisson field of summits with Gaussian heights under a body of radius R.

    A summit of height z at the distance r from the axis meets a plane when the separation has
    fallen to its *offset* x = z - r^2/(2 R). Offsets are a Poisson process of their own: above x
    lie on average :math:`2 \pi R n \int_x^\infty (z - x)\,\phi(z)\,\mathrm{d}z` of them. From
    the highest down they are those of a process of rate 1, mapped by the inverse of that mean
    (Kingman, Poisson Processes, 1993, section 2.3).

    Attributes
    ----------
    radius
        Radius R of the body [m].
    density
        Summits per area n [1/m^2].
    rms_height, mean_height
        Of their heights [m], above the plane that separations count from.
    """

    radius: float
    density: float
    rms_height: float
    mean_height: float = 0.0

    def expected_above(self, offset: np.ndarray | float) -> np.ndarray:
        """Mean number of summits with a larger offset than one [m], any shape."""
        x = (np.asarray(offset) - self.mean_height) / self.rms_height
        found: np.ndarray = self._scale * _above(x)
        return found

    def offsets(self, seed: int, block: int, count: int) -> np.ndarray:
        """Offsets [m] of the highest summits under WIDTH bodies, descending.

        Parameters
        ----------
        seed
            Of the draw; any number from 0 on.
        block
            Which WIDTH bodies of that draw.
        count
            Summits of each. The highest are the same for any number of them.

        Returns
        -------
        Array of shape (WIDTH, count).
        """
        draws = np.random.default_rng([seed, block]).standard_exponential((count, WIDTH))
        return self.mean_height + self.rms_height * self._inverse(np.cumsum(draws, axis=0)).T

    @property
    def _scale(self) -> float:
        return 2.0 * pi * self.radius * self.density * self.rms_height

    def _inverse(self, number: np.ndarray) -> np.ndarray:
        """Offset over the rms height above which so many are expected: Newton's method."""
        wanted = number / self._scale
        x = np.interp(np.log(wanted), np.log(_above(_GRID)), _GRID)
        x = np.where(wanted > -_GRID[-1], -wanted, x)  # so far down all heights are above
        for _ in range(_NEWTON):
            share = ndtr(-x)
            x = x + (_above(x) - wanted) / np.where(share > 0.0, share, 1.0)
        return x


def _above(x: np.ndarray) -> np.ndarray:
    """Mean height above x of a standard normal distribution, cut off there."""
    density = np.exp(-0.5 * x * x) / np.sqrt(2.0 * pi)
    found: np.ndarray = density - x * ndtr(-x)
    return found
