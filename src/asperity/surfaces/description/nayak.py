"""Summits of a Gaussian isotropic surface from its spectral moments: Nayak and McCool.

Derivation. At a point let t1 = z_xx + z_yy, t2 = z_xx - z_yy, t3 = 2 z_xy. On an isotropic
Gaussian surface their variances are 8/3, 4/3 and 4/3 of m4, t1 alone is correlated with z
(covariance -2 m2), and the slopes are independent of all of them with density 1/(2 pi m2)
at the horizontal. A summit is a horizontal place with t1 < 0 and t2^2 + t3^2 < t1^2; the number
per area carries the determinant (t1^2 - t2^2 - t3^2)/4. As t2^2 + t3^2 is exponential, the mean of
the determinant over it is (2/3) m4 (u^2 - 1 + exp(-u^2)), u = -t1/sqrt(8 m4/3). So with the
height s = z/sqrt(m0), which is normal with u and correlated by r = sqrt(3/(2 alpha)),

    summits per area, s and u = m4/(3 pi m2) (u^2 - 1 + exp(-u^2)) normal(s, u; r),  u > 0,

and the mean curvature of such a summit is u sqrt(2 m4/3).

References
----------
P. R. Nayak (1971), Random process model of rough surfaces, ASME J. Lubrication Technology 93,
398-407. J. I. McCool (1987), ASME J. Tribology 109, 264-270.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import gamma, pi, sqrt

import numpy as np

from ...errors import InputError
from .spectrum import Moments

NARROWEST = 1.5
"""Least bandwidth of an isotropic surface: all waves of one length. Nayak (1971)."""

_PLACES, _WEIGHTS = np.polynomial.legendre.leggauss(96)
_REACH = 9.0
"""Standard deviations on either side beyond which nothing is left in double precision."""


def _curvature_moment(order: int) -> float:
    """Mean of u^order over all summits: the marginal in u is (u^2 - 1 + exp(-u^2)) normal(u)."""

    def half(power: int) -> float:
        return 2.0 ** (power / 2.0 - 1.0) * gamma((power + 1) / 2.0) / sqrt(pi)

    plain = half(order + 2) - half(order) * (1.0 - 3.0 ** (-(order + 1) / 2.0))
    return 2.0 * sqrt(3.0) * plain


_MEAN, _SQUARE, _CUBE, _FOURTH = (_curvature_moment(order) for order in (1, 2, 3, 4))
_VARIANCE = _SQUARE - _MEAN**2
_THIRD = _CUBE - 3.0 * _MEAN * _SQUARE + 2.0 * _MEAN**3
_FOURTH_CENTRAL = _FOURTH - 4.0 * _MEAN * _CUBE + 6.0 * _MEAN**2 * _SQUARE - 3.0 * _MEAN**4


@dataclass(frozen=True)
class McCool:
    """The values of Greenwood and Williamson's model that McCool (1987) takes from the moments.

    They are Nayak's density, mean height, standard deviation and mean curvature.

    Attributes
    ----------
    density
        Summits per area [1/m^2], m4/(6 pi sqrt(3) m2).
    radius
        Radius of the mean curvature [m], 3 sqrt(pi)/(8 sqrt(m4)).
    rms_height
        Standard deviation of summit heights [m], sqrt((1 - 0.8968/alpha) m0).
    mean_height
        Mean summit height [m] above the surface's mean, 4 sqrt(m0/(pi alpha)).
    """

    density: float
    radius: float
    rms_height: float
    mean_height: float


def mccool(spectral: Moments) -> McCool | None:
    """McCool's values; None of a flat map, or below a bandwidth of 1.5, which no surface has."""
    if not (spectral.m4 > 0.0 and spectral.bandwidth >= NARROWEST * (1 - 1e-9)):
        return None
    return McCool(
        density=spectral.m4 / (6.0 * pi * sqrt(3.0) * spectral.m2),
        radius=3.0 * sqrt(pi) / (8.0 * sqrt(spectral.m4)),
        rms_height=sqrt((1.0 - 0.8968 / spectral.bandwidth) * spectral.m0),
        mean_height=4.0 * sqrt(spectral.m0 / (pi * spectral.bandwidth)),
    )


_FIGURES = (
    "density", "mean_height", "rms_height", "skewness", "kurtosis",
    "mean_curvature", "radius", "curvature_correlation",
)  # fmt: skip


@dataclass(frozen=True)
class Nayak:
    """Statistics of the summits of a Gaussian isotropic surface, exact (module's head).

    Parameters
    ----------
    m0, m2, m4
        Spectral moments of its profiles [m^2], [-], [1/m^2].

    Raises
    ------
    InputError
        If a moment is not positive, or the bandwidth m0 m4/m2^2 is below 1.5: no isotropic
        surface has such moments.
    """

    m0: float
    m2: float
    m4: float

    def __post_init__(self) -> None:
        if not (min(self.m0, self.m2, self.m4) > 0.0 and self.bandwidth >= NARROWEST * (1 - 1e-9)):
            raise InputError(
                "Nayak's statistics need positive moments with m0 m4/m2^2 of at least "
                f"{NARROWEST}; got {self.m0:g} m^2, {self.m2:g}, {self.m4:g} 1/m^2"
            )

    @property
    def bandwidth(self) -> float:
        """Breadth of the spectrum alpha = m0 m4/m2^2 [-]."""
        return self.m0 * self.m4 / self.m2**2

    @property
    def correlation(self) -> float:
        """Correlation [-] of height and curvature over the whole surface, sqrt(3/(2 alpha))."""
        return min(1.0, sqrt(1.5 / self.bandwidth))

    @property
    def density(self) -> float:
        """Summits per area [1/m^2]."""
        return self.m4 / (6.0 * sqrt(3.0) * pi * self.m2)

    @property
    def mean_height(self) -> float:
        """Mean summit height [m] above the surface's mean."""
        return self.correlation * _MEAN * sqrt(self.m0)

    @property
    def rms_height(self) -> float:
        """Standard deviation of summit heights [m]."""
        return sqrt(self.m0 * self._variance)

    @property
    def skewness(self) -> float:
        """Skewness of summit heights [-]: 0.47 at a bandwidth of 1.5, to 0 as it grows."""
        return self.correlation**3 * _THIRD / self._variance**1.5

    @property
    def kurtosis(self) -> float:
        """Kurtosis of summit heights [-], 3 for a Gaussian."""
        r, rest = self.correlation, 1.0 - self.correlation**2
        fourth = r**4 * _FOURTH_CENTRAL + 6.0 * r**2 * rest * _VARIANCE + 3.0 * rest**2
        return fourth / self._variance**2

    @property
    def mean_curvature(self) -> float:
        """Mean curvature of summits [1/m], 8 sqrt(m4)/(3 sqrt(pi))."""
        return sqrt(2.0 * self.m4 / 3.0) * _MEAN

    @property
    def radius(self) -> float:
        """Radius of the mean curvature [m]."""
        return 1.0 / self.mean_curvature

    @property
    def curvature_correlation(self) -> float:
        """Correlation [-] of height and curvature over the summits: radii are tied to heights."""
        return self.correlation * sqrt(_VARIANCE / self._variance)

    def probability(self, heights: np.ndarray) -> np.ndarray:
        """Probability density of summit heights [1/m] at ``heights`` [m], any shape."""
        s = np.asarray(heights, dtype=np.float64) / sqrt(self.m0)
        short = np.maximum(-self.correlation * s, 0.0) / self._width
        fall = np.exp(-0.5 * (s**2 + short**2)) / (2.0 * pi * self._width)
        return np.asarray(self._integral(s, 0) * fall * 2.0 * sqrt(3.0) / sqrt(self.m0))

    def curvature_at(self, heights: np.ndarray) -> np.ndarray:
        """Mean curvature [1/m] of the summits at ``heights`` [m]: higher ones are sharper."""
        s = np.asarray(heights, dtype=np.float64) / sqrt(self.m0)
        mean = self._integral(s, 1) / self._integral(s, 0)
        return np.asarray(mean * sqrt(2.0 * self.m4 / 3.0))

    def as_json(self) -> dict[str, float]:
        """The figures in SI units, by the names of the properties."""
        return {name: float(getattr(self, name)) for name in _FIGURES}

    @property
    def _variance(self) -> float:
        """Variance of summit heights over m0."""
        return 1.0 - self.correlation**2 * (1.0 - _VARIANCE)

    @property
    def _width(self) -> float:
        """Standard deviation of u at a given height; its floor stands for u = s at 1.5."""
        return max(sqrt(1.0 - self.correlation**2), 1e-6)

    def _integral(self, s: np.ndarray, order: int) -> np.ndarray:
        """Integral over u > 0 of u^order (u^2 - 1 + exp(-u^2)) normal(u; r s), by Gauss's rule.

        The rule covers the peak of the normal, cut at zero. The normal is divided by its
        largest value there, so that summits far below the mean do not vanish in rounding.
        """
        middle = (self.correlation * s)[..., None]
        top = np.maximum(middle, 0.0)
        low = np.maximum(middle - _REACH * self._width, 0.0)
        high = top + _REACH * self._width
        u = low + 0.5 * (high - low) * (1.0 + _PLACES)
        fall = ((u - middle) ** 2 - (top - middle) ** 2) / self._width**2
        weight = (u**2 + np.expm1(-(u**2))) * u**order * np.exp(-0.5 * fall)
        return np.asarray(0.5 * (high - low)[..., 0] * np.sum(weight * _WEIGHTS, axis=-1))
