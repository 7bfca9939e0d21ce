"""Summits under bodies: their offsets against summits that are strewn over a plane."""

import numpy as np
import pytest
from scipy.stats import ks_2samp

from asperity.interface.summit_field import WIDTH, SummitField
from asperity.numerics.height_integrals import height_integral

FIELD = SummitField(radius=5e-6, density=2e13, rms_height=2e-9, mean_height=0.7e-9)


def strewn(field, bodies, lowest, rng):
    """Offsets of the three highest summits of bodies whose summits are strewn over a disc."""
    far = np.sqrt(2.0 * field.radius * (field.mean_height + 6.0 * field.rms_height - lowest))
    rows = []
    for _ in range(bodies):
        count = rng.poisson(field.density * np.pi * far**2)
        heights = rng.normal(field.mean_height, field.rms_height, count)
        squares = rng.uniform(0.0, far**2, count)
        rows.append(np.sort(heights - squares / (2.0 * field.radius))[::-1][:3])
    return np.array(rows)


def test_offsets_are_those_of_summits_strewn_over_a_plane():
    drawn = np.concatenate([FIELD.offsets(5, block, 3) for block in range(8)])
    placed = strewn(FIELD, 2000, -20e-9, np.random.default_rng(1))
    for k in range(3):
        assert ks_2samp(drawn[:, k], placed[:, k]).pvalue > 1e-3


def test_the_mean_number_is_a_height_integral():
    x = np.linspace(-20.0, 8.0, 57)
    expected = FIELD.expected_above(FIELD.mean_height + x * FIELD.rms_height)
    scale = 2.0 * np.pi * FIELD.radius * FIELD.density * FIELD.rms_height
    np.testing.assert_allclose(expected, scale * np.asarray(height_integral(1.0, x)), rtol=1e-11)


def test_numbers_above_an_offset_are_poissons():
    offsets = np.concatenate([FIELD.offsets(0, block, 64) for block in range(16)])
    above = np.sum(offsets > 0.5e-9, axis=1)
    mean = FIELD.expected_above(0.5e-9)
    scatter = np.sqrt(mean / above.size)
    assert np.mean(above) == pytest.approx(mean, abs=4.0 * scatter)
    assert np.var(above) == pytest.approx(mean, rel=4.0 * np.sqrt(2.0 / above.size))


def test_the_highest_are_the_same_for_any_number_of_summits():
    few, many = FIELD.offsets(7, 3, 8), FIELD.offsets(7, 3, 40)
    np.testing.assert_array_equal(few, many[:, :8])
    assert few.shape == (WIDTH, 8)
    assert np.all(np.diff(many, axis=1) < 0.0)
    assert not np.any(few == FIELD.offsets(8, 3, 8))


def test_far_below_all_heights_each_area_has_one():
    """There offsets are spaced evenly, as the area under a paraboloid grows with its depth."""
    offsets = SummitField(1e-6, 1e12, 1e-10).offsets(0, 0, 4096)
    spacing = 1.0 / (2.0 * np.pi * 1e-6 * 1e12)
    assert np.mean(np.diff(offsets[:, 2048:], axis=1)) == pytest.approx(-spacing, rel=0.01)
