"""Shares with intervals and quantiles of single bodies."""

import numpy as np
import pytest

from asperity.results.realisations import Realisations, clopper_pearson, percent


def test_intervals_of_few_trials():
    """Of none in ten 1 - 0.025^(1/10); the others by Newcombe, Statistics in Medicine 17 (1998)."""
    assert clopper_pearson(0, 10) == (0.0, pytest.approx(1.0 - 0.025**0.1, rel=1e-12))
    assert clopper_pearson(10, 10) == (pytest.approx(0.025**0.1, rel=1e-12), 1.0)
    assert clopper_pearson(81, 263) == pytest.approx((0.2527, 0.3676), abs=5e-5)
    assert clopper_pearson(15, 148) == pytest.approx((0.0578, 0.1617), abs=5e-5)


@pytest.mark.parametrize("probability", [0.03, 0.3, 0.5])
def test_intervals_hold_the_probability_as_often_as_they_say(probability):
    hits = np.random.default_rng(0).binomial(60, probability, 2000)
    intervals = np.array([clopper_pearson(int(hit), 60) for hit in hits])
    held = (intervals[:, 0] <= probability) & (probability <= intervals[:, 1])
    assert np.mean(held) >= 0.95 - 3.0 * np.sqrt(0.95 * 0.05 / 2000)


def test_numbers_of_all_bodies_together():
    captured = np.array([True, False, False, False])
    values = {"restitution": np.array([0.0, 0.5, 0.6, 0.7]), "contacting": np.arange(4.0)}
    found = Realisations(captured, values, {"capillary": np.full(4, 2e-18)}, {})
    plain = found.plain()
    assert (plain["realisations"], plain["captured"]) == (4, 1)
    assert plain["capture_probability"] == 0.25
    assert plain["quantiles"]["contacting"] == [0.0, 1.0, 3.0]
    assert plain["mean_restitution"] == pytest.approx(0.45)
    assert plain["lost"]["capillary"] == pytest.approx([2e-18] * 3)


def test_shares_in_per_cent():
    assert [percent(x) for x in (0.0, 0.0036824, 0.6359, 1.0)] == ["0", "0.368", "63.6", "100"]
