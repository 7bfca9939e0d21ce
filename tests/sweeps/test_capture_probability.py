"""The speed at which half of single bodies are captured, from counts at some speeds."""

import numpy as np
import pytest

from asperity.sweeps.capture_probability import _crossing

SPEEDS = np.geomspace(0.25, 4.0, 9)
STEP = np.sqrt(2.0)  # from one to the next
HALF = 1.3


def captured(speed):
    """Bodies out of a million, of which half are captured at `HALF`."""
    return round(1e6 / (1.0 + (speed / HALF) ** 4))


@pytest.mark.parametrize("halvings", [0, 1, 3, 8])
def test_it_is_met_the_closer_the_more_often_the_interval_is_halved(halvings):
    """A line through two points is off by the square of their distance."""
    hits = np.array([captured(speed) for speed in SPEEDS])
    found = _crossing(captured, SPEEDS, hits, 500_000, halvings)
    assert abs(np.log(found / HALF)) < 0.03 * np.log(STEP) * 4.0**-halvings


def test_a_step_is_met_within_what_the_halvings_leave():
    def step(speed):
        return 900 if speed < HALF else 100

    hits = np.array([step(speed) for speed in SPEEDS])
    for halvings in (0, 3, 8):
        found = _crossing(step, SPEEDS, hits, 500, halvings)
        assert abs(np.log(found / HALF)) < np.log(STEP) * 2.0**-halvings


@pytest.mark.parametrize("hits", [0, 1000])
def test_there_is_none_where_all_speeds_do_the_same(hits):
    assert _crossing(captured, SPEEDS, np.full(9, hits), 500, 3) is None
