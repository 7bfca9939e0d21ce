"""A motion without drag as a time series: its energies, its times, its speeds."""

import numpy as np
import pytest

import asperity
from asperity import Result


@pytest.fixture(scope="module")
def motion() -> Result:
    """A body that bounces on menisci, with scanning curves."""
    return asperity.solve(asperity.load("glass-bead"))


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
