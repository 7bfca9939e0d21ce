"""Synthetic rough surfaces with Gaussian heights, where no measured ones are at hand."""

from __future__ import annotations

from math import pi, sqrt

import numpy as np


def gaussian_surface(
    points: tuple[int, int], spacing: float, rms_height: float, length: float, seed: int
) -> np.ndarray:
    """Heights of an isotropic periodic surface whose correlation is exp(-(r/length)^2).

    Parameters
    ----------
    points
        Rows and columns.
    spacing
        Distance of neighbouring points [m].
    rms_height
        Root mean square height [m] of the whole surface it is a piece of.
    length
        Correlation length [m].
    seed
        Of the random numbers: the same seed gives the same surface.

    Returns
    -------
    Heights [m] above the mean plane, shape ``points``.
    """
    wave = [2.0 * pi * np.fft.fftfreq(count, spacing) for count in points]
    square = wave[0][:, None] ** 2 + wave[1][None, :] ** 2
    power = np.exp(-square * length**2 / 4.0)
    noise = np.fft.fft2(np.random.default_rng(seed).standard_normal(points))
    shaped = np.fft.ifft2(noise * np.sqrt(power)).real
    heights: np.ndarray = shaped * rms_height / sqrt(float(np.mean(power)))
    return heights


def length_for_density(density: float) -> float:
    """Correlation length [m] at which a Gaussian surface has ``density`` summits [1/m^2].

    Nayak (1971): m4/(6 pi sqrt(3) m2) with the profile's moments, here m4/m2 = 6/length^2.
    """
    return sqrt(6.0 / (6.0 * pi * sqrt(3.0) * density))


def summits(heights: np.ndarray) -> np.ndarray:
    """Heights of the points of a periodic surface that lie above their eight neighbours [m]."""
    shifts = [(i, j) for i in (-1, 0, 1) for j in (-1, 0, 1) if (i, j) != (0, 0)]
    around = np.stack([np.roll(heights, shift, axis=(0, 1)) for shift in shifts])
    found: np.ndarray = heights[heights > around.max(axis=0)]
    return found
