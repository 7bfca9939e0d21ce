"""Summits under bodies: their offsets against summits that are strewn over a plane."""

import numpy as np
import pytest
from scipy.stats import ks_2samp

from asperity.interface.summit_field import WIDTH, GaussianField, MeasuredField, SampledField
from asperity.numerics.height_integrals import height_integral

FIELD = GaussianField(radius=5e-6, density=2e13, rms_height=2e-9, mean_height=0.7e-9)


def strewn(field, bodies, lowest, rng):
    """Offsets and heights of the three highest summits of bodies on a disc that is strewn."""
    far = np.sqrt(2.0 * field.radius * (field.mean_height + 6.0 * field.rms_height - lowest))
    rows = []
    for _ in range(bodies):
        count = rng.poisson(field.density * np.pi * far**2)
        heights = rng.normal(field.mean_height, field.rms_height, count)
        offsets = heights - rng.uniform(0.0, far**2, count) / (2.0 * field.radius)
        highest = np.argsort(-offsets)[:3]
        rows.append((offsets[highest], heights[highest]))
    return np.moveaxis(rows, 1, 0)


def test_offsets_are_those_of_summits_strewn_over_a_plane():
    drawn = np.concatenate([FIELD.summits(5, block, 3)[0] for block in range(8)])
    placed, _ = strewn(FIELD, 2000, -20e-9, np.random.default_rng(1))
    for k in range(3):
        assert ks_2samp(drawn[:, k], placed[:, k]).pvalue > 1e-3


def test_the_mean_number_is_a_height_integral():
    x = np.linspace(-20.0, 8.0, 57)
    expected = FIELD.expected_above(FIELD.mean_height + x * FIELD.rms_height)
    scale = 2.0 * np.pi * FIELD.radius * FIELD.density * FIELD.rms_height
    np.testing.assert_allclose(expected, scale * np.asarray(height_integral(1.0, x)), rtol=1e-11)


def test_numbers_above_an_offset_are_poissons():
    offsets = np.concatenate([FIELD.summits(0, block, 64)[0] for block in range(16)])
    above = np.sum(offsets > 0.5e-9, axis=1)
    mean = FIELD.expected_above(0.5e-9)
    scatter = np.sqrt(mean / above.size)
    assert np.mean(above) == pytest.approx(mean, abs=4.0 * scatter)
    assert np.var(above) == pytest.approx(mean, rel=4.0 * np.sqrt(2.0 / above.size))


def test_the_highest_are_the_same_for_any_number_of_summits():
    few, many = FIELD.summits(7, 3, 8)[0], FIELD.summits(7, 3, 40)[0]
    np.testing.assert_array_equal(few, many[:, :8])
    assert few.shape == (WIDTH, 8)
    assert np.all(np.diff(many, axis=1) < 0.0)
    assert not np.any(few == FIELD.summits(8, 3, 8)[0])


def test_far_below_all_heights_each_area_has_one():
    """There offsets are spaced evenly, as the area under a paraboloid grows with its depth."""
    offsets = GaussianField(1e-6, 1e12, 1e-10).summits(0, 0, 4096)[0]
    spacing = 1.0 / (2.0 * np.pi * 1e-6 * 1e12)
    assert np.mean(np.diff(offsets[:, 2048:], axis=1)) == pytest.approx(-spacing, rel=0.01)


HEIGHTS = np.sort(np.random.default_rng(3).normal(1e-9, 2e-9, 400))[::-1]
CLASSES = np.where(np.arange(400) < 40, 1, 0).astype(np.int32)  # the highest are of one class
ACROSS = np.random.default_rng(5).uniform(0.0, 4e-6, (400, 2))
INNER = np.array([[1e-6, 1e-6], [3e-6, 3e-6]])
MAPPED = MeasuredField(5e-6, 400 / 16e-12, HEIGHTS, CLASSES, ACROSS, INNER)


def test_measured_heights_give_the_field_of_their_distribution():
    """Of 400 normal heights: nearly the Gaussian field's."""
    sampled = SampledField(5e-6, 2e13, HEIGHTS, CLASSES)
    gaussian = GaussianField(5e-6, 2e13, np.std(HEIGHTS), np.mean(HEIGHTS))
    for x in np.linspace(-20e-9, 4e-9, 13):
        exact = 2.0 * np.pi * 5e-6 * 2e13 * np.mean(np.maximum(HEIGHTS - x, 0.0))
        assert sampled.expected_above(x) == pytest.approx(exact, rel=1e-12)
    few, many = (field.summits(1, 0, 8)[0] for field in (sampled, gaussian))
    assert np.mean(few[:, 3]) == pytest.approx(np.mean(many[:, 3]), abs=0.2e-9)


def test_a_summit_is_of_the_class_of_one_that_is_higher_than_its_offset():
    sampled = SampledField(5e-6, 2e13, HEIGHTS, CLASSES)
    offsets, classes = sampled.summits(1, 0, 64)
    assert np.all(classes[offsets > HEIGHTS[40]] == 1)
    # Far down all 400 are as likely.
    assert np.mean(classes[offsets < HEIGHTS[-1]]) == pytest.approx(0.1, abs=0.01)
    np.testing.assert_array_equal(classes[:, :8], sampled.summits(1, 0, 8)[1])


def test_a_map_gives_its_summits_where_they_are():
    offsets, classes = MAPPED.summits(9, 0, 5)
    places = np.random.default_rng([9, 0]).uniform(1e-6, 3e-6, (WIDTH, 2))
    squares = np.sum((ACROSS - places[7]) ** 2, axis=1)
    every = HEIGHTS - squares / (2.0 * 5e-6)
    highest = np.argsort(-every)[:5]
    np.testing.assert_allclose(offsets[7], every[highest], rtol=1e-12)
    np.testing.assert_array_equal(classes[7], CLASSES[highest])
    assert MAPPED.summits(9, 0, 512)[0].min() == -1.0  # there are no more of them
    # Strewn evenly, they are a Poisson field but for their number, which is given.
    random = SampledField(5e-6, 400 / 16e-12, HEIGHTS, CLASSES).summits(9, 0, 5)[0]
    assert np.mean(offsets[:, 0]) == pytest.approx(np.mean(random[:, 0]), abs=0.5e-9)


def test_positions_make_the_offsets():
    """With the heights that the highest of strewn summits have."""
    heights = []
    for seed in range(200):
        offsets, positions = FIELD.summits(seed, 0, 3)[0][0], FIELD.positions(seed, 0, 3)[0]
        heights.append(offsets + np.sum(positions**2, axis=1) / (2.0 * FIELD.radius))
    drawn = np.array(heights)[:, 0]
    _, placed = strewn(FIELD, 2000, -20e-9, np.random.default_rng(1))
    assert ks_2samp(drawn, placed[:, 0]).pvalue > 1e-3


def test_a_map_gives_the_positions_of_its_summits():
    offsets, positions = MAPPED.summits(9, 0, 5)[0][0], MAPPED.positions(9, 0, 5)[0]
    heights = offsets + np.sum(positions**2, axis=1) / (2.0 * 5e-6)
    assert np.all(np.min(np.abs(heights[:, None] - HEIGHTS), axis=1) < 1e-16)
