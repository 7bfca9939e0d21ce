"""How far heights follow a Gaussian: moments, Kolmogorov-Smirnov, quantiles, a verdict in words.

Neighbouring pixels are not independent, and the Gaussian they are compared with has their own mean
and rms. Both enter the p-value.

- *Effective number.* Once mean and rms are fitted, the sampling error of a Gaussian field's
  distribution is widest at the mean. There its variance is sum(arcsin rho - rho)/(2 pi N) for N
  pixels with the autocorrelation rho, and (pi/2 - 1)/(2 pi n) for n independent numbers: the
  probability that both of two heights are above the mean is 1/4 + arcsin(rho)/(2 pi) (Sheppard
  1899), and the fitted mean takes the part linear in rho. So
  n = N (pi/2 - 1)/sum(arcsin rho - rho).
  The variance of the skewness is 6 sum(rho^3)/N and that of the kurtosis 24 sum(rho^4)/N
  (Lomnicki 1961; Gasser 1975), so their own n are N/sum(rho^3) and N/sum(rho^4). A correlated
  field's distribution is also smoother than that of n independent numbers, which makes the p-value
  careful: at 5 % it calls 1 or 2 of 100 correlated Gaussian fields not Gaussian.
- *Fitted parameters.* The statistic follows the distribution of Lilliefors (1967), in the
  variable of Stephens (1974), D (sqrt(n) - 0.01 + 0.85/sqrt(n)).

References
----------
W. F. Sheppard (1899), Phil. Trans. R. Soc. A 192, 101-167. Z. A. Lomnicki (1961), Metrika 4,
37-62. T. Gasser (1975), Biometrika 62, 563-570. H. W. Lilliefors (1967), J. Am. Stat. Assoc. 62,
399-402. M. A. Stephens (1974), J. Am. Stat. Assoc. 69, 730-737.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import exp, pi, sqrt
from typing import NamedTuple

import numpy as np
from scipy import fft
from scipy.special import ndtr, ndtri

from ..topography import Topography

LEAST_INDEPENDENT = 10.0
"""Independent heights, at least, that a p-value is given for."""

_TOLD_APART = 80.0
"""Independent heights that nine of ten Gaussian maps of less than a wave stay below, simulated."""

SIGNIFICANT = 0.05
"""p-values below this are taken as a difference from the Gaussian."""

# 400,000 samples of 1,000 normal numbers each; the last digit scatters. Stephens's points at 10 %,
# 5 % and 1 % (0.819, 0.895, 1.035) have 0.112, 0.055 and 0.012 there: his variable is a fit.
_STEPS = np.array([0.3, 0.4, 0.45, 0.5, 0.55, 0.6, 0.65, 0.7, 0.75, 0.8, 0.85,
                   0.9, 0.95, 1.0, 1.05, 1.1, 1.15, 1.2, 1.25, 1.3])  # fmt: skip
_EXCEEDED = np.array([1.0, 0.974, 0.916, 0.814, 0.681, 0.538, 0.402, 0.289, 0.198, 0.1315, 0.0841,
                      0.0525, 0.0312, 0.0182, 0.0102, 0.00575, 0.00303, 0.00155,
                      0.00080, 0.00038])  # fmt: skip
_FALL = 1.0 / (2.0 * (0.25 - 0.5 / pi))
"""Of ln p over the statistic squared, far out: the largest variance is 1/4 - 1/(2 pi)."""

QUANTILES = 201


class Independent(NamedTuple):
    """How many independent heights some heights are worth, for the scatter of each figure [-].

    Attributes
    ----------
    distribution
        For the distribution's distance from the Gaussian.
    skewness, kurtosis
        For the third and fourth moment.
    """

    distribution: float
    skewness: float
    kurtosis: float


@dataclass(frozen=True, eq=False)
class Gaussianity:
    """Heights against the Gaussian of the same mean and rms.

    Attributes
    ----------
    subject
        What the heights are of, in the plural: ``"heights"``, ``"summit heights"``.
    count
        How many there are.
    independent
        How many independent ones they are worth.
    rms
        Standard deviation [m].
    skewness, kurtosis
        Third and fourth central moments over the powers of rms [-]; 0 and 3 for a Gaussian.
    statistic
        Largest distance [-] of the two cumulative distributions, Kolmogorov-Smirnov.
    p_value
        Probability [-] of a larger one, were the heights Gaussian; None below ten
        independent heights. Below 4e-4 it is extrapolated.
    quantiles
        Pairs, shape (201, 2): quantile of the standard Gaussian, and of the heights less their
        mean over their rms. The line y = x is the Gaussian.
    """

    subject: str
    count: int
    independent: Independent
    rms: float
    skewness: float
    kurtosis: float
    statistic: float
    p_value: float | None
    quantiles: np.ndarray

    @property
    def verdict(self) -> str:
        """What the figures say, in a sentence."""
        worth = self.independent.distribution
        if self.p_value is None and not self.departures:
            return (
                f"{self.subject}: too few to judge, the {self.count} values are worth about "
                f"{worth:.1f} independent ones: measure a larger area"
            )
        if self.p_value is None:
            return f"{self.subject} are not Gaussian: {', '.join(self.departures)}"
        chance = f"p = {self.p_value:.2g}" if self.p_value >= 1e-6 else "p below 1e-06"
        figures = (
            f"Kolmogorov-Smirnov {self.statistic:.3g}, {chance}, about {worth:.3g} independent "
            "values"
        )
        if self.p_value >= SIGNIFICANT and not self.departures:
            return f"{self.subject} are Gaussian within the sampling error ({figures})"
        how = ", ".join(self.departures) or (
            f"in the body of the distribution (skewness {self.skewness:.2g}, "
            f"kurtosis {self.kurtosis:.3g})"
        )
        return f"{self.subject} are not Gaussian: {how} ({figures})"

    @property
    def departures(self) -> list[str]:
        """Moments beyond three standard errors, sqrt(6/n) and sqrt(24/n), in words."""
        words = []
        if abs(self.skewness) > 3.0 * sqrt(6.0 / self.independent.skewness):
            side = "valleys" if self.skewness < 0.0 else "peaks"
            words.append(f"skewed to {side} (skewness {self.skewness:.2g})")
        if abs(self.kurtosis - 3.0) > 3.0 * sqrt(24.0 / self.independent.kurtosis):
            tails = "light" if self.kurtosis < 3.0 else "heavy"
            words.append(f"{tails} tails (kurtosis {self.kurtosis:.3g}, Gaussian 3)")
        return words


def gaussianity(values: np.ndarray, independent: Independent, subject: str) -> Gaussianity | None:
    """Heights against the Gaussian of their own mean and rms.

    Parameters
    ----------
    values
        Heights [m], finite, any shape.
    independent
        How many independent ones they are worth.
    subject
        What they are of, in the plural, for the verdict.

    Returns
    -------
    The figures; None for fewer than three values, or values all alike: they have no shape.
    """
    if values.size < 3:
        return None
    reduced = np.sort(values, axis=None)
    reduced -= reduced.mean()
    rms = sqrt(float(np.dot(reduced, reduced)) / reduced.size)
    # Beneath the rounding of the heights themselves there is nothing to describe.
    if rms <= 4.0 * float(np.spacing(np.abs(values).max())):
        return None
    reduced /= rms
    square = reduced**2
    statistic = _distance(reduced)
    return Gaussianity(
        subject=subject,
        count=reduced.size,
        independent=independent,
        rms=rms,
        skewness=float(np.dot(square, reduced)) / reduced.size,
        kurtosis=float(np.dot(square, square)) / reduced.size,
        statistic=statistic,
        p_value=judged(statistic, independent),
        quantiles=_quantiles(reduced),
    )


def judged(statistic: float, independent: Independent) -> float | None:
    """The p-value; None where too few independent values stand behind it."""
    worth = independent.distribution
    return p_value(statistic, worth) if worth >= LEAST_INDEPENDENT else None


def p_value(statistic: float, effective: float) -> float:
    """Probability of a larger statistic for Gaussian numbers, mean and rms fitted [-].

    Parameters
    ----------
    statistic
        Kolmogorov-Smirnov's largest distance [-].
    effective
        Number of independent values [-]. From ten up the figure is right within a tenth of
        itself; below 4e-4 it is extrapolated by the known fall of the tail.
    """
    root = sqrt(effective)
    square = (statistic * (root - 0.01 + 0.85 / root)) ** 2
    last = _STEPS[-1] ** 2
    if square > last:
        return float(_EXCEEDED[-1] * exp(-_FALL * (square - last)))
    return float(np.exp(np.interp(square, _STEPS**2, np.log(_EXCEEDED))))


def independent_heights(topography: Topography) -> Independent:
    """How many independent heights a map is worth, from its autocorrelation (module's head).

    The autocorrelation is that of the map closed upon itself, with missing pixels at the mean, and
    enters by its modulus: a number is too small rather than too large. It is trustworthy while
    the correlation length is well below the map's size. A map of less than a wave looks like one
    of up to about 80 independent heights, so below that all three numbers are 1.
    """
    heights = topography.heights - float(np.nanmean(topography.heights))
    present = float(heights.size - topography.missing_pixels)
    heights[np.isnan(heights)] = 0.0
    wave = fft.rfft2(heights, overwrite_x=True)
    power = wave.real**2 + wave.imag**2
    del wave
    rho = fft.irfft2(power, s=topography.heights.shape, overwrite_x=True).ravel()
    if not rho[0] > 0.0:
        return Independent(1.0, 1.0, 1.0)
    # The modulus: in a map of few waves the two signs would cancel and feign many heights.
    rho = np.minimum(np.abs(rho / rho[0]), 1.0)
    square = rho**2
    sums = (
        float(np.sum(np.arcsin(rho) - rho)) / (0.5 * pi - 1.0),
        float(np.dot(square, rho)),
        float(np.dot(square, square)),
    )
    # Below 1, the sum over independent pixels, is only noise.
    found = Independent(*(present / max(1.0, together) for together in sums))
    return found if found.distribution >= _TOLD_APART else Independent(1.0, 1.0, 1.0)


def independent_summits(count: int, heights: Independent) -> Independent:
    """How many independent summit heights some summits are worth, count/(1 + (count - 1)/n).

    Taken as if summits stood at random places of a surface worth n independent heights
    and were correlated as it is: never more than the count or n.
    """
    return Independent(*(count / (1.0 + (count - 1) / n) for n in heights))


def _distance(reduced: np.ndarray) -> float:
    """Kolmogorov-Smirnov distance of sorted reduced values from the standard Gaussian.

    Values that occur more than once are taken as rounded, and the distributions are compared
    midway between neighbouring ones: the step of an instrument is no departure from the Gaussian.
    """
    count = reduced.size
    last = np.flatnonzero(np.diff(reduced) > 0.0)
    if last.size + 1 < count:
        edges = 0.5 * (reduced[last] + reduced[last + 1])
        return float(np.abs((last + 1) / count - ndtr(edges)).max())
    expected = ndtr(reduced)
    expected *= count
    expected -= np.arange(count)
    return float(max(expected.max(), 1.0 - expected.min())) / count


def _quantiles(reduced: np.ndarray) -> np.ndarray:
    """Pairs of quantiles, evenly spaced on the Gaussian's axis, out to the extreme values.

    The value of rank i stands at the probability (i + 1/2)/count. Between two ranks the heights
    are linear in the Gaussian's quantile.
    """
    count = reduced.size
    end = float(ndtri(1.0 - 0.5 / count))
    expected = np.linspace(-end, end, QUANTILES)
    lower = np.clip((ndtr(expected) * count - 0.5).astype(np.intp), 0, count - 2)
    below, above = (ndtri((lower + rank) / count) for rank in (0.5, 1.5))
    part = (expected - below) / (above - below)
    found = (1.0 - part) * reduced[lower] + part * reduced[lower + 1]
    return np.stack((expected, found), axis=1)
