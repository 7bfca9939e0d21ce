"""Samples of a study: SciPy's points, whatever part of them is asked for."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.stats import qmc

from study_texts import HUMIDITY, RMS, sample


def test_samples_are_scipys_of_the_seed():
    points = sample(1024, seed=7).sample.points(0, 1024, 4)
    assert np.array_equal(points, qmc.Sobol(4, scramble=True, rng=7).random(1024))
    points = sample(1000, "latin", seed=7).sample.points(0, 1000, 4)
    assert np.array_equal(points, qmc.LatinHypercube(4, rng=7).random(1000))


@pytest.mark.parametrize("method", ["sobol", "latin"])
@given(data=st.data())
@settings(max_examples=30)
def test_part_of_a_sample_is_that_part_of_the_whole(method, data):
    found = sample(777, method)
    start = data.draw(st.integers(0, 777))
    stop = data.draw(st.integers(start, 777))
    whole, part = found.values(0, 777), found.values(start, stop)
    for key in whole:
        assert part[key].tolist() == whole[key][start:stop].tolist()


@pytest.mark.parametrize("method", ["sobol", "latin"])
def test_sample_has_each_value_and_each_part_of_a_range_equally_often(method):
    found = sample(1024, method).values(0, 1024)
    # Each column of either method has one point in each 1/1024 of its range.
    parts = np.floor(np.log(found[RMS] / 8e-9) / np.log(1.5) * 1024)
    assert sorted(parts) == pytest.approx(np.arange(1024), abs=1)
    assert sorted(np.floor((found[HUMIDITY] - 0.2) / 0.7 * 1024)) == pytest.approx(
        np.arange(1024), abs=1
    )
    assert (found["adhesion.model"] == "dmt").sum() == 512
    assert found["numerics.max_impacts"].dtype == np.int64
    counts = np.bincount(found["numerics.max_impacts"])
    assert counts[3:] == pytest.approx([204.8] * 5, abs=1)
    assert counts[:3].sum() == 0


def test_other_seed_gives_other_points():
    one, other = (sample(64, seed=seed) for seed in (1, 2))
    assert not np.array_equal(one.values(0, 64)[RMS], other.values(0, 64)[RMS])
    assert one.fingerprint != other.fingerprint


def test_start_of_a_larger_sobol_sample_is_the_smaller_one():
    small, large = (sample(size).values(0, 64) for size in (64, 4096))
    for key in small:
        assert small[key].tolist() == large[key].tolist()


def test_sobol_sample_of_an_odd_size_is_allowed_and_said():
    assert sample(64).warnings == []
    assert sample(100, "latin").warnings == []
    (warning,) = sample(100).warnings
    assert "power of two; 100 is none" in warning
