"""The power spectrum of self-affine surfaces, and how close to it a surface is."""

from __future__ import annotations

from dataclasses import dataclass
from math import inf, pi
from typing import NamedTuple

import numpy as np
from scipy import fft

from ...errors import InputError
from ..preparation.step import length
from ..topography import Topography


@dataclass(frozen=True)
class SelfAffine:
    """Power spectrum of an isotropic self-affine surface.

    Flat up to the wave vector 2 pi/rolloff, proportional to q^(-2 - 2 H) from there to
    2 pi/cutoff and zero beyond. Jacobs, Junge and Pastewka (2017), Surf. Topogr.: Metrol. Prop.
    5, 013001.

    Parameters
    ----------
    hurst
        Hurst exponent H [-].
    rolloff
        Wavelength [m] above which the spectrum is flat; infinite for a power law throughout.
    cutoff
        Wavelength [m] below which there is nothing.
    """

    hurst: float
    rolloff: float
    cutoff: float

    def power(self, wave: np.ndarray) -> np.ndarray:
        """Power at wave vectors [1/m], relative; zero at wave vector zero, which is the mean."""
        bend = 2.0 * pi / self.rolloff
        known = (wave > 0.0) & (wave <= 2.0 * pi / self.cutoff * (1.0 + 1e-9))
        longest = max(bend, float(wave[known].min()))
        relative = np.maximum(np.where(known, wave, longest), bend) / longest
        power: np.ndarray = np.where(known, relative ** (-2.0 - 2.0 * self.hurst), 0.0)
        return power


class SpectrumError(NamedTuple):
    """How far a surface's power spectrum is from the one asked for.

    Parameters
    ----------
    rms
        Rms relative error [-] of the power within the cut-off, averaged over rings of equal wave
        vector and weighted with their waves.
    beyond
        Share [-] of the mean square height that lies beyond the cut-off.
    curvature_beyond
        Share [-] of the mean square curvature that does.
    """

    rms: float
    beyond: float
    curvature_beyond: float


def spectrum_on(
    points: tuple[int, ...],
    pixel_size: tuple[float, float],
    hurst: float,
    rolloff: float | None,
    cutoff: float | None,
) -> SelfAffine:
    """The spectrum of `self_affine`, where a grid can carry it.

    Raises
    ------
    InputError
        If a value is out of its range; the error names its key.
    """
    least = 2.0 * max(pixel_size)
    most = min(count * step for count, step in zip(points, pixel_size, strict=True))
    if not 0.0 < hurst <= 1.0:
        raise InputError(f"`hurst` must lie in (0, 1]; got {hurst}", key="hurst")
    cutoff = least if cutoff is None else cutoff
    for key, value in (("cutoff", cutoff), ("rolloff", rolloff)):
        # Two pixels, or the size of the map, may differ from it in the last digit.
        if value is not None and not least * (1.0 - 1e-9) <= value <= most * (1.0 + 1e-9):
            raise InputError(
                f"`{key}` must lie between two pixels, {length(least)}, and the map's shorter "
                f"side, {length(most)}; got {length(value)}",
                key=key,
            )
    if rolloff is not None and cutoff > rolloff:
        raise InputError(
            f"`cutoff` must not exceed `rolloff`, {length(rolloff)}; got {length(cutoff)}",
            key="cutoff",
        )
    return SelfAffine(hurst, inf if rolloff is None else rolloff, cutoff)


def spectrum_error(
    topography: Topography,
    *,
    hurst: float,
    rolloff: float | None = None,
    cutoff: float | None = None,
) -> SpectrumError:
    """How far the power spectrum of a periodic surface is from a self-affine one.

    Rings one smallest wave vector wide are compared; the asked spectrum is scaled to the median
    ring, for the scale of a steep spectrum hangs on a few long waves that chance rules. Chance
    alone, in a Gaussian surface, leaves an rms error of some sqrt(2 rings/waves).

    Parameters
    ----------
    topography
        A periodic surface without missing pixels.
    hurst, rolloff, cutoff
        As in `self_affine`.

    Returns
    -------
    The error within and beyond the cut-off.

    Raises
    ------
    InputError
        If a value is out of its range, or if pixels are missing.
    """
    if topography.missing_pixels:
        raise topography._error(
            f"a spectrum needs all pixels; got {topography.missing_pixels} missing; fill them first"
        )
    points = topography.heights.shape[::-1]
    spectrum = spectrum_on(points, topography.pixel_size, hurst, rolloff, cutoff)
    wave = wave_vectors(points, topography.pixel_size)
    asked, count = spectrum.power(wave), times_counted(points)
    found = abs(fft.rfft2(topography.heights - topography.heights.mean())) ** 2
    ring = np.rint(wave / (2.0 * pi / min(topography.physical_size))).astype(int)
    waves, wanted, got = (
        np.bincount(ring[asked > 0.0], (count * part)[asked > 0.0])
        for part in (np.ones_like(asked), asked, found)
    )
    there = waves > 0.0
    ratio = got[there] / wanted[there]
    error = ratio / np.median(ratio) - 1.0
    beyond = [
        float(np.sum((count * part)[asked == 0.0]) / np.sum(count * part))
        for part in (found, found * wave**4)
    ]
    return SpectrumError(float(np.sqrt(np.average(error**2, weights=waves[there]))), *beyond)


def wave_vectors(points: tuple[int, ...], pixel_size: tuple[float, float]) -> np.ndarray:
    """Size of the wave vector [1/m] of each Fourier coefficient."""
    along_x = fft.rfftfreq(points[0], pixel_size[0])
    along_y = fft.fftfreq(points[1], pixel_size[1])
    wave: np.ndarray = 2.0 * pi * np.hypot(along_y[:, None], along_x)
    return wave


def times_counted(points: tuple[int, ...]) -> np.ndarray:
    """How many waves each column of coefficients stands for: those of opposite sign are alike."""
    times = np.full(points[0] // 2 + 1, 2.0)
    times[0] = 1.0
    if points[0] % 2 == 0:
        times[-1] = 1.0
    return times
