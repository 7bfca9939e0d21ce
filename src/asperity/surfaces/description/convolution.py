"""Distribution of the sum of two independent heights, and that against the Gaussian."""

from __future__ import annotations

from dataclasses import dataclass
from math import sqrt

import numpy as np
from scipy.special import ndtr, ndtri

from ...errors import InputError
from .gaussianity import QUANTILES, Gaussianity, Independent, judged

_CELLS_PER_RMS = 200
_MOST_CELLS = 2**17


@dataclass(frozen=True, eq=False)
class HeightDistribution:
    """Probability density of heights about their mean, on an even grid.

    Attributes
    ----------
    heights
        Middles of the cells [m], evenly spaced; the mean height is 0.
    density
        Probability density [1/m], one value a cell; its sum times the step is 1.
    """

    heights: np.ndarray
    density: np.ndarray

    @property
    def step(self) -> float:
        """Width of a cell [m]."""
        return float(self.heights[1] - self.heights[0])

    def moment(self, order: int) -> float:
        """Central moment [m^order]."""
        share = self.density * self.step
        mean = float(np.dot(share, self.heights))
        return float(np.dot(share, (self.heights - mean) ** order))

    @property
    def rms(self) -> float:
        """Standard deviation [m]."""
        return sqrt(self.moment(2))

    @property
    def skewness(self) -> float:
        """Third central moment over rms^3 [-]."""
        return self.moment(3) / self.rms**3

    @property
    def kurtosis(self) -> float:
        """Fourth central moment over rms^4 [-], 3 for a Gaussian."""
        return self.moment(4) / self.rms**4

    @property
    def cumulative(self) -> np.ndarray:
        """Probability [-] of a height below the upper edge of each cell."""
        return np.asarray(np.cumsum(self.density)) * self.step

    def in_bins(self, edges: np.ndarray) -> np.ndarray:
        """Mean density [1/m] in each bin, from the cumulative one.

        Parameters
        ----------
        edges
            Edges [m] of the bins, ascending, shape (bins + 1,).
        """
        upper = self.heights + 0.5 * self.step
        below = np.interp(edges, upper, self.cumulative, left=0.0, right=1.0)
        return np.asarray(np.diff(below) / np.diff(edges))


def convolved(first: np.ndarray, second: np.ndarray) -> HeightDistribution:
    """Distribution of the sum of two independent heights, as in the publication's figure 2.

    Variances and third cumulants add up, whatever the distributions are.

    Parameters
    ----------
    first, second
        Heights [m] of either surface, or of its summits, measured outwards from it; any shape,
        missing ones NaN. Their means drop out.

    Returns
    -------
    The distribution about its mean. The cells are 1/200 of the narrower rms wide, unless the
    range would then need more than 131,072 of them.

    Raises
    ------
    InputError
        If both surfaces are flat.
    """
    samples = [values[np.isfinite(values)] for values in (first, second)]
    samples = [values - values.mean() for values in samples]
    span = sum(float(np.ptp(values)) for values in samples)
    if span == 0.0:
        raise InputError("a composite distribution needs a rough surface; got two flat ones")
    narrow = min(s for s in (float(np.std(values)) for values in samples) if s > 0.0)
    step = max(narrow / _CELLS_PER_RMS, span / _MOST_CELLS)
    starts, shares = zip(*(_shares(values, step) for values in samples), strict=True)
    both = np.maximum(_folded(*shares), 0.0)
    both /= both.sum()
    heights = (sum(starts) + np.arange(both.size)) * step
    return HeightDistribution(heights - float(np.dot(both, heights)), both / step)


def _folded(one: np.ndarray, other: np.ndarray) -> np.ndarray:
    # Here, since it takes a second to import, and one surface alone needs none of it.
    from scipy.signal import fftconvolve

    return np.asarray(fftconvolve(one, other))


def _shares(values: np.ndarray, step: float) -> tuple[int, np.ndarray]:
    """Share of the values in each cell, split between the two nearest so that means hold."""
    place = values / step
    below = np.floor(place)
    start = int(below.min())
    cell = (below - start).astype(np.intp)
    part = place - below
    cells = int(cell.max()) + 2
    counts = np.bincount(cell, 1.0 - part, cells) + np.bincount(cell + 1, part, cells)
    return start, counts / values.size


def distribution_against_gaussian(
    distribution: HeightDistribution, independent: Independent, subject: str
) -> Gaussianity:
    """A composite distribution against the Gaussian of its rms; see `gaussianity`.

    Parameters
    ----------
    distribution
        The distribution.
    independent
        How many independent values it is worth.
    subject
        What it is of, in the plural.
    """
    rms, edges = distribution.rms, distribution.heights + 0.5 * distribution.step
    statistic = float(np.abs(distribution.cumulative - ndtr(edges / rms)).max())
    end = max(1.0, float(-ndtri(0.5 / max(independent.distribution, 2.0))))
    expected = np.linspace(-end, end, QUANTILES)
    found = np.interp(ndtr(expected), distribution.cumulative, edges / rms)
    return Gaussianity(
        subject=subject,
        count=int(independent.distribution),
        independent=independent,
        rms=rms,
        skewness=distribution.skewness,
        kurtosis=distribution.kurtosis,
        statistic=statistic,
        p_value=judged(statistic, independent),
        quantiles=np.stack((expected, found), axis=1),
    )


def independent_sums(
    rms: tuple[float, float], independent: tuple[Independent, Independent]
) -> Independent:
    """How many independent values the convolution of two samples is worth.

    From the scatter of its third cumulant, 6 rms^6/n of either sample, and of its
    fourth, 24 rms^8/n. The distribution's distance from the Gaussian begins with the third.
    """
    whole = sum(s**2 for s in rms)
    scatter = (
        sum(
            (s**2 / whole) ** power / worth[place]
            for s, worth in zip(rms, independent, strict=True)
        )
        for place, power in enumerate((3, 3, 4))
    )
    return Independent(*(1.0 / part for part in scatter))
