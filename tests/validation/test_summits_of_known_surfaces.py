"""Summits of surfaces whose answer is known: lattices of paraboloids, Gaussian random fields."""

from __future__ import annotations

from itertools import pairwise
from math import pi, sqrt

import numpy as np
import pytest
from scipy import fft

from asperity.surfaces import Topography
from asperity.surfaces.description.nayak import Nayak
from asperity.surfaces.description.spectrum import moments, profile_spectrum
from asperity.surfaces.description.summits import find_summits
from figures import Figure, misses

PIXEL = 2e-9
NAYAK = "Nayak (1971), from the spectrum"


def lattice(pitch: float, radius: float, size: int = 600) -> Topography:
    """Paraboloids on a square lattice, each reaching half way to the next; pitch in pixels.

    The lattice lies askew to the pixels, so that no two of them are equally far from a top.
    """
    x, y = (
        (places - pitch * np.round(places / pitch)) * PIXEL
        for places in (np.arange(size) + 0.5 * pitch + shift for shift in (0.372, 0.219))
    )
    return Topography(-(y[:, None] ** 2 + x**2) / (2.0 * radius), (PIXEL, PIXEL))


def random_field(points: int, seed: int, power) -> tuple[Topography, Nayak]:
    """A periodic Gaussian isotropic surface of a power spectrum, and the answer for it.

    ``power`` is a function of the wavenumber [rad/pixel]. The moments are those of the
    spectrum on the grid of wavenumbers, along x; nothing is measured on the surface.
    """
    wave = 2.0 * pi * fft.fftfreq(points)
    density = power(np.hypot(wave[:, None], wave))
    density[0, 0] = 0.0
    noise = fft.fft2(np.random.default_rng(seed).standard_normal((points, points)))
    heights = fft.ifft2(noise * np.sqrt(density)).real
    shares = density.sum(axis=0) / density.sum()
    scale = 1e-9 / sqrt(float(np.mean(density)))
    known = [float(np.dot(shares, (wave / PIXEL) ** order)) * 1e-18 for order in (0, 2, 4)]
    return Topography(heights * scale, (PIXEL, PIXEL)), Nayak(*known)


def gaussian_power(length: float):
    """Of the correlation exp(-(r/length)^2); bandwidth 3."""
    return lambda wave: np.exp(-((wave * length) ** 2) / 4.0)


def ring_power(length: float):
    """Waves of nearly one length, of ``length`` pixels; bandwidth near 1.5."""
    return lambda wave: np.exp(-0.5 * ((wave * length / (2.0 * pi) - 1.0) / 0.08) ** 2)


def self_affine_power(short: float, long: float):
    """Hurst exponent 0.8 between two wavelengths in pixels, flat beyond the long one."""

    def power(wave: np.ndarray) -> np.ndarray:
        low, high = 2.0 * pi / long, 2.0 * pi / short
        return np.where(wave < high, np.maximum(wave, low) ** -3.6, 0.0)

    return power


FIELDS = {
    "Gaussian correlation": (gaussian_power(7.5), (1, 2, 3)),
    "waves of nearly one length": (ring_power(24.0), (4, 5, 6, 7)),
    "self-affine": (self_affine_power(18.0, 90.0), (8, 9, 10)),
}


def field_figures(name: str) -> tuple[Figure, ...]:
    power, seeds = FIELDS[name]
    made = [random_field(1536, seed, power) for seed in seeds]
    known = made[0][1]
    found = [find_summits(surface) for surface, _ in made]
    heights = np.concatenate([one.heights for one in found])
    curvature = np.mean(np.concatenate([one.curvatures for one in found]))
    density = float(np.mean([one.density for one in found]))
    spread = np.std(heights)
    rows = [
        ("density", known.density, density, "1/m^2", 0.02),
        ("radius", known.radius, 1.0 / curvature, "m", 0.02),
        ("mean height", known.mean_height, np.mean(heights), "m", 0.03),
        ("rms height", known.rms_height, spread, "m", 0.03),
    ]
    return tuple(
        Figure(f"summits, {name}: {what}", NAYAK, expected, float(value), unit, limit)
        for what, expected, value, unit, limit in rows
    )


def lattice_figures(pitch: float) -> tuple[Figure, ...]:
    radius = 1e-7
    found = find_summits(lattice(pitch, radius))
    name = f"paraboloids {pitch:g} pixels apart"
    return (
        Figure(f"{name}: density", "lattice", (pitch * PIXEL) ** -2, found.density, "1/m^2", 0.02),
        Figure(f"{name}: radius", "lattice", radius, found.radius, "m", 0.02),
    )


def figures() -> list[Figure]:
    lattices = [row for pitch in (12.5, 25.0, 6.25) for row in lattice_figures(pitch)]
    return [*lattices, *(row for name in FIELDS for row in field_figures(name))]


def test_known_figures_are_met():
    assert misses(figures()) == []


def narrow_summits(length: float, fields: int) -> tuple[np.ndarray, Nayak]:
    """Reduced summit heights of several fields of nearly one wavelength, in pixels."""
    made = (random_field(2048, seed, ring_power(length)) for seed in range(20, 20 + fields))
    found = [(find_summits(surface).heights, known) for surface, known in made]
    heights = np.concatenate([one for one, _ in found])
    return (heights - heights.mean()) / heights.std(), found[0][1]


def test_a_narrow_spectrum_skews_the_summit_heights_as_nayak_says():
    """Where the skewness is largest: within 3 % and twice its scatter, 3.5 % of it."""
    reduced, known = narrow_summits(24.0, 4)
    assert known.bandwidth < 1.55
    scatter = sqrt(6.0 / reduced.size)
    assert np.mean(reduced**3) == pytest.approx(
        known.skewness, abs=0.03 * known.skewness + 2.0 * scatter
    )
    assert np.mean(reduced**4) == pytest.approx(known.kurtosis, rel=0.03)


@pytest.mark.long
def test_the_skewness_of_summits_is_nayaks_within_three_percent():
    """With 270,000 summits, which leave a scatter of 1.1 %."""
    reduced, known = narrow_summits(24.0, 40)
    assert np.mean(reduced**3) == pytest.approx(known.skewness, rel=0.03)
    assert np.mean(reduced**4) == pytest.approx(known.kurtosis, rel=0.01)


def test_higher_summits_are_sharper_as_nayak_says():
    surface, known = random_field(2048, 30, gaussian_power(7.0))
    found = find_summits(surface)
    edges = np.linspace(0.0, 2.8e-9, 8)
    for low, high in pairwise(edges):
        inside = (found.heights >= low) & (found.heights < high)
        expected = known.curvature_at(found.heights[inside]).mean()
        scatter = found.curvatures[inside].std() / sqrt(np.count_nonzero(inside)) / expected
        measured = found.curvatures[inside].mean()
        assert measured == pytest.approx(expected, rel=0.03 + 2.0 * scatter)


def test_counted_density_and_radius_err_with_the_pixel_as_stated():
    """In theta = pixel sqrt(m4/m2): -theta^2/8 of the density, +theta^2/6 of the radius."""
    for length in (5.0, 3.5, 2.5):
        surface, known = random_field(1536, 40, gaussian_power(length))
        found = find_summits(surface)
        theta = PIXEL * sqrt(known.m4 / known.m2)
        scatter = 2.0 / sqrt(found.count)
        assert found.density / known.density - 1.0 == pytest.approx(
            -(theta**2) / 8.0, rel=0.25, abs=scatter
        )
        assert found.radius / known.radius - 1.0 == pytest.approx(
            theta**2 / 6.0, rel=0.1, abs=scatter
        )


def test_a_lattice_finer_than_three_pixels_cannot_be_counted():
    """A summit and its eight neighbours need three pixels: beyond that the count is wrong."""
    found = find_summits(lattice(1.5, 1e-7))
    assert found.density * (1.5 * PIXEL) ** 2 < 0.8


def test_finite_differences_lose_what_is_stated_of_the_moments():
    """-pixel^2 m4/(12 m2) of m2 and -pixel^2 m6/(6 m4) of m4; the spectrum loses neither."""
    length = 6.0
    surface, known = random_field(2048, 50, gaussian_power(length))
    measured = moments(surface)
    theta = 6.0 / length**2  # m4/m2 of the spectrum; m6/m4 is 10/length^2
    assert measured.m2 / known.m2 == pytest.approx(1.0 - theta / 12.0, rel=0.01)
    assert measured.m4 / known.m4 == pytest.approx(1.0 - 10.0 / length**2 / 6.0, rel=0.01)
    spectrum = profile_spectrum(surface, "x")
    assert spectrum is not None
    assert spectrum.moment(2) == pytest.approx(known.m2, rel=0.01)
    assert spectrum.moment(4) == pytest.approx(known.m4, rel=0.01)
