"""Self-affine random surfaces, Gaussian or with given heights."""

from __future__ import annotations

from math import inf, isfinite

import numpy as np
from scipy import fft

from ...errors import InputError
from ..topography import Topography
from .height_shape import standard_heights
from .self_affine import spectrum_on, times_counted, wave_vectors

_ROUNDS = 100
"""Exchanges of heights and amplitudes, at most."""

_CLOSE = 2e-4
"""Error of the amplitudes, relative to their norm, that no further round needs to lower."""

_GAIN = 2e-2
"""Share by which a round must lower the error of the amplitudes to be followed by another."""


def self_affine(
    points: tuple[int, int],
    pixel_size: tuple[float, float],
    *,
    hurst: float,
    rolloff: float | None = None,
    cutoff: float | None = None,
    rms_height: float | None = None,
    rms_slope: float | None = None,
    seed: int,
    heights: tuple[float, float] | np.ndarray | None = None,
) -> Topography:
    """A periodic self-affine random surface.

    White Gaussian noise is given the spectrum of `SelfAffine`, so that amplitudes scatter as
    those of a piece of a Gaussian surface do. It is scaled so that the map made, not the
    ensemble it is drawn from, has the rms asked for. Given heights are imposed by rank in
    turn with the amplitudes of the Gaussian surface (Perez-Rafols and Almqvist (2019), Tribol.
    Int. 131, 591-604) until neither gains, heights last: they are exact, and the spectrum is
    not. `spectrum_error` tells by how much; power beyond the cut-off raises slopes, curvatures
    and the density of summits.

    Parameters
    ----------
    points
        Pixels along x and y, at least three.
    pixel_size
        Size (dx, dy) [m] of a pixel.
    hurst
        Hurst exponent [-], above 0 and up to 1.
    rolloff
        Wavelength [m] above which the spectrum is flat; None: a power law up to the map's size.
    cutoff
        Shortest wavelength [m]; None: two pixels, of the longer side of a pixel.
    rms_height
        Rms height [m] of the map. Exactly one of this and ``rms_slope`` is given.
    rms_slope
        Rms [-] of the gradient's size, from the derivative of the Fourier series; differences
        of neighbouring pixels give less.
    seed
        Of the random numbers, a whole number from 0. The same seed gives the same surface with
        one version of NumPy.
    heights
        None: Gaussian. A pair of skewness and kurtosis (3 for a Gaussian), or an array of
        measured heights in any unit, of which the distribution is taken and not the scale.

    Returns
    -------
    The surface, of mean height zero.

    Raises
    ------
    InputError
        If a value is out of its range; the error names its key.
    """
    _require_grid(points, pixel_size, seed)
    spectrum = spectrum_on(points, pixel_size, hurst, rolloff, cutoff)
    _require_one_rms(rms_height, rms_slope)
    noise = np.random.default_rng(seed).standard_normal(points[::-1])
    surface = fft.rfft2(noise) * np.sqrt(spectrum.power(wave_vectors(points, pixel_size)))
    made = fft.irfft2(surface, s=noise.shape)
    made /= made.std()
    if heights is not None:
        made = _with_heights(made, standard_heights(heights, made.size))
    if rms_height is not None:
        return Topography(made * rms_height, pixel_size)
    steepness = _rms_slope(made, pixel_size)
    return Topography(made * (rms_slope or 0.0) / steepness, pixel_size)


def _require_grid(points: tuple[int, int], pixel_size: tuple[float, float], seed: int) -> None:
    """Refuse a grid that is none, or a seed that is no whole number from 0."""
    for key, numbers, least in (("points", points, 3), ("seed", (seed,), 0)):
        if any(
            isinstance(n, bool) or not isinstance(n, int | np.integer) or n < least for n in numbers
        ):
            raise InputError(
                f"`{key}` must be whole, {least} or more; got {', '.join(map(str, numbers))}",
                key=key,
            )
    if not all(isfinite(step) and step > 0.0 for step in pixel_size):
        raise InputError(
            f"`pixel_size` must be a positive length; got {pixel_size} m", key="pixel_size"
        )


def _require_one_rms(rms_height: float | None, rms_slope: float | None) -> None:
    """Refuse none or two of the scales, and a scale that is no positive number."""
    if (rms_height is None) == (rms_slope is None):
        given = "neither" if rms_height is None else "both"
        raise InputError(
            f"one of `rms_height` and `rms_slope` must be given; got {given}", key="rms_height"
        )
    for key, value in (("rms_height", rms_height), ("rms_slope", rms_slope)):
        if value is not None and not (isfinite(value) and value > 0.0):
            raise InputError(f"`{key}` must be positive; got {value}", key=key)


def _rms_slope(heights: np.ndarray, pixel_size: tuple[float, float]) -> float:
    """Rms of the gradient's size [m of height per m] of a periodic surface, by Parseval."""
    points = heights.shape[::-1]
    steepness = abs(fft.rfft2(heights) * wave_vectors(points, pixel_size)) ** 2
    return float(np.sqrt(np.sum(steepness * times_counted(points)))) / heights.size


def _with_heights(surface: np.ndarray, heights: np.ndarray) -> np.ndarray:
    """A surface with given sorted heights whose amplitudes come close to those of another."""
    amplitudes = abs(fft.rfft2(surface))
    enough = _CLOSE * float(np.linalg.norm(amplitudes))
    made, error = np.empty(surface.size), inf
    for _ in range(_ROUNDS):
        made[np.argsort(surface, axis=None)] = heights
        waves = fft.rfft2(made.reshape(surface.shape))
        size = abs(waves)
        before, error = error, float(np.linalg.norm(size - amplitudes))
        if error < enough or error > before * (1.0 - _GAIN):
            break
        turned = np.divide(waves, size, out=np.ones_like(waves), where=size > 0.0)
        surface = fft.irfft2(amplitudes * turned, s=surface.shape)
    return made.reshape(surface.shape)
