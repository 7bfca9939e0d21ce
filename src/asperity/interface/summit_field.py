"""Summits under a paraboloid, from the first to touch to the last: random, or measured."""

from __future__ import annotations

import abc
from dataclasses import dataclass
from math import pi

import numpy as np
from scipy.special import ndtr, ndtri

WIDTH = 256
"""Bodies whose summits are drawn together: the numbers depend on nothing else."""

_GRID = np.linspace(9.0, -60.0, 6901)  # heights over the rms height, from where next to none is
_NEWTON = 3
_LOW = 3.0  # rms heights
_FAR = -1.0  # m, where there are no more summits


@dataclass(frozen=True)
class SummitField(abc.ABC):
    """What stands under bodies of radius R.

    A summit of height z at the distance r from the axis meets a plane when the separation has
    fallen to its *offset* x = z - r^2/(2 R).

    Parameters
    ----------
    radius
        Radius R of the bodies [m].
    density
        Summits per area n [1/m^2].
    """

    radius: float
    density: float

    def expected_above(self, offset: np.ndarray | float) -> np.ndarray:
        r"""Mean number of summits with a larger offset than one [m], any shape.

        :math:`2 \pi R n \int_x^\infty (z - x)\,\phi(z)\,\mathrm{d}z` of them.
        """
        return 2.0 * pi * self.radius * self.density * self._mean_above(np.asarray(offset))

    @property
    @abc.abstractmethod
    def base(self) -> float:
        """Height [m] below which next to no summit stands."""

    @abc.abstractmethod
    def _mean_above(self, offset: np.ndarray) -> np.ndarray:
        """Mean height [m] above an offset of a summit, cut off there."""

    @abc.abstractmethod
    def summits(self, seed: int, block: int, count: int) -> tuple[np.ndarray, np.ndarray]:
        """The highest summits under WIDTH bodies.

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
        Offsets [m], descending, and classes of tip radius, both of shape (WIDTH, count).
        """

    @abc.abstractmethod
    def positions(self, seed: int, block: int, count: int) -> np.ndarray:
        """Where the highest summits under WIDTH bodies stand.

        Parameters
        ----------
        seed, block, count
            As for :meth:`summits`.

        Returns
        -------
        Coordinates [m] from the axis of each body, shape (WIDTH, count, 2), in the order of their
        offsets.
        """


class RandomField(SummitField):
    """A Poisson field: offsets are a Poisson process too.

    From the highest down they are those of a process of rate 1, mapped by the inverse of
    :meth:`expected_above` (Kingman, Poisson Processes, 1993, section 2.3).
    """

    def summits(self, seed: int, block: int, count: int) -> tuple[np.ndarray, np.ndarray]:
        draws = np.random.default_rng([seed, block]).standard_exponential((count, WIDTH))
        number = np.cumsum(draws, axis=0).T
        offsets = self._inverse(number / (2.0 * pi * self.radius * self.density))
        return offsets, self._classes(np.random.default_rng([seed, block, 1]), offsets)

    def positions(self, seed: int, block: int, count: int) -> np.ndarray:
        """In any direction, at the distance that height and offset make."""
        offsets, _ = self.summits(seed, block, count)
        heights = self._heights(np.random.default_rng([seed, block, 1]), offsets)
        distance = np.sqrt(2.0 * self.radius * (heights - offsets))
        angle = 2.0 * pi * _shares(np.random.default_rng([seed, block, 2]), count)
        return np.stack([distance * np.cos(angle), distance * np.sin(angle)], axis=-1)

    @abc.abstractmethod
    def _heights(self, random: np.random.Generator, offsets: np.ndarray) -> np.ndarray:
        """Heights [m] of summits with some offsets: all that are higher are as likely."""

    @abc.abstractmethod
    def _inverse(self, mean: np.ndarray) -> np.ndarray:
        """The offset [m] of which a mean height above it [m] is that."""

    def _classes(self, random: np.random.Generator, offsets: np.ndarray) -> np.ndarray:
        """Class of tip radius of the summits with some offsets."""
        return np.zeros(offsets.shape, np.int32)


@dataclass(frozen=True)
class GaussianField(RandomField):
    """A Poisson field of summits with Gaussian heights and one tip radius.

    Parameters
    ----------
    rms_height, mean_height
        Of their heights [m], above the plane that separations count from.
    """

    rms_height: float
    mean_height: float = 0.0

    @property
    def base(self) -> float:
        """One summit of 740 is lower."""
        return self.mean_height - _LOW * self.rms_height

    def _mean_above(self, offset: np.ndarray) -> np.ndarray:
        return self.rms_height * _above((offset - self.mean_height) / self.rms_height)

    def _heights(self, random: np.random.Generator, offsets: np.ndarray) -> np.ndarray:
        lowest = ndtr((self.mean_height - offsets) / self.rms_height)
        shares = lowest * _shares(random, offsets.shape[1])
        return self.mean_height - self.rms_height * ndtri(shares)

    def _inverse(self, mean: np.ndarray) -> np.ndarray:
        """By Newton's method."""
        wanted = mean / self.rms_height
        x = np.interp(np.log(wanted), np.log(_above(_GRID)), _GRID)
        x = np.where(wanted > -_GRID[-1], -wanted, x)  # so far down all heights are above
        for _ in range(_NEWTON):
            share = ndtr(-x)
            x = x + (_above(x) - wanted) / np.where(share > 0.0, share, 1.0)
        return self.mean_height + self.rms_height * x


@dataclass(frozen=True)
class SampledField(RandomField):
    """A Poisson field of summits whose heights and radii are drawn from those that were measured.

    Parameters
    ----------
    heights
        Their heights [m] above the plane that separations count from, descending, shape (n,).
    classes
        Class of tip radius of each, likewise.
    """

    heights: np.ndarray
    classes: np.ndarray

    @property
    def base(self) -> float:
        return float(self.heights[-1])

    def _mean_above(self, offset: np.ndarray) -> np.ndarray:
        mean = np.interp(-offset, -self.heights, self._at_heights)
        found: np.ndarray = np.where(
            offset < self.heights[-1], np.mean(self.heights) - offset, mean
        )
        return found

    @property
    def _at_heights(self) -> np.ndarray:
        """Mean height above each of the heights; it is linear in between."""
        number = np.arange(1.0, self.heights.size + 1.0)
        found: np.ndarray = (np.cumsum(self.heights) - number * self.heights) / number.size
        return found

    def _inverse(self, mean: np.ndarray) -> np.ndarray:
        known = self._at_heights
        between = np.interp(mean, known, self.heights)
        found: np.ndarray = np.where(mean > known[-1], np.mean(self.heights) - mean, between)
        return found

    def _heights(self, random: np.random.Generator, offsets: np.ndarray) -> np.ndarray:
        return self.heights[self._which(random, offsets)]

    def _classes(self, random: np.random.Generator, offsets: np.ndarray) -> np.ndarray:
        return self.classes[self._which(random, offsets)]

    def _which(self, random: np.random.Generator, offsets: np.ndarray) -> np.ndarray:
        """Which summits they are: of all that are higher any one is as likely."""
        higher = np.maximum(np.searchsorted(-self.heights, -offsets), 1)
        return (_shares(random, offsets.shape[1]) * higher).astype(int)


@dataclass(frozen=True)
class MeasuredField(SampledField):
    """The summits of a map where they are, with the bodies put down at random centres of it.

    Parameters
    ----------
    measured
        Coordinates of the summits on the map [m], shape (n, 2), in the order of ``heights``.
    within
        Least and largest coordinates of the centres [m], shape (2, 2): as far from the edges as
        forces reach.
    """

    measured: np.ndarray
    within: np.ndarray

    def summits(self, seed: int, block: int, count: int) -> tuple[np.ndarray, np.ndarray]:
        offsets = np.full((WIDTH, count), _FAR)
        classes = np.zeros((WIDTH, count), np.int32)
        for body, centre in enumerate(self._centres(seed, block)):
            all_offsets, highest = self._highest(centre, count)
            offsets[body, : highest.size] = all_offsets[highest]
            classes[body, : highest.size] = self.classes[highest]
        return offsets, classes

    def _centres(self, seed: int, block: int) -> np.ndarray:
        """Where the axes of WIDTH bodies are put down [m], shape (WIDTH, 2)."""
        low, high = self.within
        return np.random.default_rng([seed, block]).uniform(low, high, (WIDTH, 2))

    def positions(self, seed: int, block: int, count: int) -> np.ndarray:
        found = np.zeros((WIDTH, count, 2))
        for body, centre in enumerate(self._centres(seed, block)):
            highest = self._highest(centre, count)[1]
            found[body, : highest.size] = self.measured[highest] - centre
        return found

    def _highest(self, centre: np.ndarray, count: int) -> tuple[np.ndarray, np.ndarray]:
        """Offsets [m] of all summits under a body, and which are the highest."""
        squares = np.sum((self.measured - centre) ** 2, axis=1)
        offsets = self.heights - squares / (2.0 * self.radius)
        return offsets, np.argsort(-offsets, kind="stable")[:count]


def _shares(random: np.random.Generator, count: int) -> np.ndarray:
    """Numbers from 0 to 1, shape (WIDTH, count): the first are the same for any count."""
    return random.random((count, WIDTH)).T


def _above(x: np.ndarray) -> np.ndarray:
    """Mean height above x of a standard normal distribution, cut off there."""
    density = np.exp(-0.5 * x * x) / np.sqrt(2.0 * pi)
    found: np.ndarray = density - x * ndtr(-x)
    return found
