"""Spectral moments of a surface's profiles, and the power spectral density of its profiles."""

from __future__ import annotations

from dataclasses import dataclass
from math import pi, sqrt

import numpy as np
from scipy import fft

from ..topography import Topography


@dataclass(frozen=True)
class Moments:
    """Spectral moments of profiles, the mean of the directions x and y.

    Taken from finite differences, as by McCool (1987), so they are those of a slightly smoother
    surface: of a wave of wavenumber q, m2 sees the part (2 - 2 cos k)/k^2 = 1 - k^2/12 + ... and
    m4 the square of that, k = q pixel. The relative error is -pixel^2 m4/(12 m2) of m2 and
    -pixel^2 m6/(6 m4) of m4.

    Attributes
    ----------
    m0
        Variance of the heights [m^2].
    m2
        Mean square slope [-] of profiles, over neighbouring pixels.
    m4
        Mean square curvature [1/m^2] of profiles, over three measured pixels in line, the
        outermost profiles left out.
    slopes
        Root mean square slopes [-] along x and along y.
    """

    m0: float
    m2: float
    m4: float
    slopes: tuple[float, float]

    @property
    def bandwidth(self) -> float:
        """Nayak's breadth of the spectrum m0 m4/m2^2 [-]; NaN for a flat map."""
        return self.m0 * self.m4 / self.m2**2 if self.m2 > 0.0 else float("nan")


def moments(topography: Topography) -> Moments:
    """Spectral moments m0, m2, m4 of a map, by finite differences.

    References
    ----------
    J. I. McCool (1987), Relating profile instrument measurements to the functional
    performance of rough surfaces, ASME J. Tribology 109, 264-270.
    """
    heights = topography.heights - float(np.nanmean(topography.heights))
    width, length = topography.pixel_size
    along = _mean_square(np.diff(heights, axis=1)) / width**2
    across = _mean_square(np.diff(heights, axis=0)) / length**2
    bent_along = _mean_square(np.diff(heights[1:-1], n=2, axis=1)) / width**4
    bent_across = _mean_square(np.diff(heights[:, 1:-1], n=2, axis=0)) / length**4
    return Moments(
        m0=_mean_square(heights),
        m2=0.5 * (along + across),
        m4=0.5 * (bent_along + bent_across),
        slopes=(sqrt(along), sqrt(across)),
    )


@dataclass(frozen=True, eq=False)
class ProfileSpectrum:
    """Power spectral density of the profiles along one direction.

    Attributes
    ----------
    wavenumber
        Wavenumbers q [rad/m], from 0 to that of two pixels, evenly spaced.
    density
        One-sided density [m^3]: its sum times the step of q is m0.
    """

    wavenumber: np.ndarray
    density: np.ndarray

    def moment(self, order: int) -> float:
        """Spectral moment: the integral of q^order times the density [m^(2 - order)].

        Without the loss of finite differences, but with the leakage of the window and with
        whatever noise stands at the largest wavenumbers.
        """
        step = float(self.wavenumber[1])
        return float(np.sum(self.wavenumber**order * self.density)) * step


def profile_spectrum(topography: Topography, direction: str) -> ProfileSpectrum | None:
    """Mean power spectral density of all complete profiles along x or along y.

    Profiles with a missing pixel are left out: a filled one would have a spectrum of the filling.
    Each is weighed by a Hann window, as a map does not repeat itself, and the
    mean is scaled so that its integral is the variance of those profiles about the map's mean.

    Parameters
    ----------
    topography
        The map, prepared as it is to be described.
    direction
        ``"x"`` for rows, ``"y"`` for columns.

    Returns
    -------
    The spectrum; None where no profile is complete.
    """
    heights = topography.heights - float(np.nanmean(topography.heights))
    profiles, pixel = (
        (heights, topography.pixel_size[0])
        if direction == "x"
        else (heights.T, topography.pixel_size[1])
    )
    if topography.missing_pixels:
        profiles = profiles[np.isfinite(profiles).all(axis=1)]
    if not profiles.size:
        return None
    points = profiles.shape[1]
    # SciPy's window is the same; its room of signals takes a second to import.
    window = np.sin(np.pi * np.arange(points) / points) ** 2
    power = _mean_power(profiles * window)
    power[1 : (points + 1) // 2] *= 2.0
    wavenumber = 2.0 * pi * fft.rfftfreq(points, pixel)
    whole = float(np.sum(power)) * float(wavenumber[1])
    scale = _mean_square(profiles) / whole if whole > 0.0 else 0.0
    return ProfileSpectrum(wavenumber, power * scale)


def _mean_power(profiles: np.ndarray) -> np.ndarray:
    """Mean square modulus of the transforms of many profiles, a block of profiles at a time."""
    block = max(1, 2**20 // profiles.shape[1])
    total = np.zeros(profiles.shape[1] // 2 + 1)
    for first in range(0, profiles.shape[0], block):
        wave = fft.rfft(profiles[first : first + block], axis=1)
        total += np.sum(wave.real**2 + wave.imag**2, axis=0)
    return total / profiles.shape[0]


def _mean_square(values: np.ndarray) -> float:
    """Mean square of the values that are not missing; NaN of none."""
    flat = values.ravel()
    flat = flat if np.isfinite(flat).all() else flat[np.isfinite(flat)]
    return float(np.dot(flat, flat)) / flat.size if flat.size else float("nan")
