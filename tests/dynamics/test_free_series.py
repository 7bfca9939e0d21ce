"""A motion without drag as a time series: its energies, its times, its speeds."""

import numpy as np
import pytest

import asperity
from asperity import Result
from asperity.dynamics.curve_table import RATE, TIME_NODES
from asperity.dynamics.phase_time import missed_time
from asperity.dynamics.time_series import ascending


@pytest.fixture(scope="module")
def motion() -> Result:
    """A body that bounces on menisci, with scanning curves."""
    return asperity.solve(asperity.load("glass-bead"), critical=False)


def test_energies_add_up_at_every_sample(motion: Result):
    total = sum(motion.energies.values())
    initial, largest = motion.ledger["initial"], np.max(motion.energies["kinetic"])
    assert len(total) > 1000
    np.testing.assert_allclose(total, initial, rtol=0.0, atol=1e-9 * largest)


def test_samples_are_in_time_with_their_speed(motion: Result):
    """Where it changes by less than a tenth, a step takes as long as at its mean, to 1 %."""
    step, moved = np.diff(motion.time), np.diff(motion.separation)
    assert np.all(step >= 0.0)
    assert np.all(moved * (motion.speed[1:] + motion.speed[:-1]) >= 0.0)
    least = np.minimum(np.abs(motion.speed[1:]), np.abs(motion.speed[:-1]))
    most = np.maximum(np.abs(motion.speed[1:]), np.abs(motion.speed[:-1]))
    short = (least > 0.9 * most) & (np.abs(moved) > 0.0)
    assert np.sum(short) > 500
    mean = 0.5 * np.abs(motion.speed[1:] + motion.speed[:-1])[short]
    assert np.abs(moved[short]) == pytest.approx(mean * step[short], rel=1e-2)


def test_samples_lie_on_the_phases_between_the_turns(motion: Result):
    """Each turning point is a sample at its time, and speeds change their sign there alone."""
    times = np.sort(
        np.concatenate([motion.events["closest_approach_time"], motion.events["apex_time"]])
    )
    nearest = np.min(np.abs(motion.time[:, None] - times), axis=0)
    assert np.max(nearest) < 1e-6 * times[-1]
    signs = np.sign(motion.speed[np.abs(motion.speed) > 1e-6 * np.max(np.abs(motion.speed))])
    assert np.sum(np.diff(signs) != 0.0) == len(times) - 1


def test_a_fall_lasts_as_long_as_its_speeds_say(motion: Result):
    """Between samples that are close the speed changes evenly: dt = 2 dd / (v + v')."""
    first, then = motion.events["apex_time"][0], motion.events["closest_approach_time"][1]
    inside = (motion.time >= first * (1.0 - 1e-12)) & (motion.time <= then * (1.0 + 1e-12))
    fall = np.flatnonzero(inside)
    place, speed = motion.separation[fall], motion.speed[fall]
    steps = 2.0 * np.diff(place) / (speed[1:] + speed[:-1])
    assert then - first == pytest.approx(np.sum(steps), rel=1e-5)


def test_the_time_of_a_body_that_was_just_at_rest_is_that_of_its_even_acceleration():
    """With what the quadrature misses: 2/(sqrt(e + 1) + sqrt(e)), for small e and large."""
    for energy in (0.0, 1e-12, 1e-8, 1e-6, 1e-4, 1e-3, 0.02, 0.3):
        found = np.sum(RATE / np.sqrt(energy + TIME_NODES))
        missed = float(missed_time(np.array([energy]), np.array([1.0]))[0])
        exact = 2.0 / (np.sqrt(1.0 + energy) + np.sqrt(energy))
        assert found + missed == pytest.approx(exact, rel=1e-9)


def test_only_a_fall_of_a_loss_within_what_is_known_is_taken_for_rounding():
    lost = np.array([[0.0, 0.0], [1.0, 1.0], [1.0 - 1e-7, 0.9], [2.0, 2.0]])
    kept = ascending(lost, 1e-6)
    np.testing.assert_array_equal(kept[:, 0], [0.0, 1.0, 1.0, 2.0])
    np.testing.assert_array_equal(kept[:, 1], lost[:, 1])
