"""Synthetic surfaces: rms height, summit density and the shift of summits, after Nayak."""

import numpy as np
import pytest

from asperity.surfaces.generation.synthetic import gaussian_surface, length_for_density, summits

DENSITY, RMS = 1.69e16, 10.5e-9
LENGTH = length_for_density(DENSITY)
SPACING = 0.1 * LENGTH


@pytest.fixture(scope="module")
def heights():
    return gaussian_surface((900, 900), SPACING, RMS, LENGTH, seed=3)


def test_rms_height_and_correlation_are_the_ones_asked_for(heights):
    """Within the scatter of a piece that holds some 1500 correlation areas."""
    assert heights.std() == pytest.approx(RMS, rel=0.03)
    assert abs(heights.mean()) < 0.03 * RMS
    found = np.mean(heights * np.roll(heights, 8, axis=0)) / np.mean(heights**2)
    assert found == pytest.approx(np.exp(-((8 * SPACING / LENGTH) ** 2)), abs=0.03)


def test_summits_are_as_dense_as_asked_for_above_the_surface_and_scatter_less(heights):
    """For this correlation Nayak's breadth is 3: mean 4/sqrt(3 pi) = 1.30 rms."""
    found = summits(heights)
    assert found.size / (heights.size * SPACING**2) == pytest.approx(DENSITY, rel=0.05)
    assert found.mean() == pytest.approx(4.0 / np.sqrt(3.0 * np.pi) * RMS, rel=0.03)
    assert found.std() < RMS


def test_the_same_seed_gives_the_same_surface(heights):
    again = gaussian_surface((900, 900), SPACING, RMS, LENGTH, seed=3)
    np.testing.assert_array_equal(heights, again)
    assert not np.allclose(heights, gaussian_surface((900, 900), SPACING, RMS, LENGTH, seed=4))
