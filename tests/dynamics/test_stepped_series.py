"""What is read between the samples of a motion that was stepped in time."""

import numpy as np
import pytest

from asperity.dynamics.curve_table import FORCE
from asperity.dynamics.stepped_series import Trajectory


def trajectory(time, force, phase):
    """Of a body that goes out at 1 m/s."""
    rows = np.zeros((time.size, 7))
    rows[:, FORCE] = force
    none = np.zeros((time.size, 0))
    return Trajectory(time, time, np.ones(time.size), rows, none, none, phase)


def test_the_largest_force_lies_between_samples():
    time = np.array([0.0, 0.3, 0.4, 1.0])
    force = 2.0 - (time - 0.45) ** 2
    found = trajectory(time, force, np.array([0, 0, 1, 1])).maximum_force()
    assert found == pytest.approx(2.0, rel=1e-14)


@pytest.mark.parametrize("time", [[0.0, 0.5, 1.0], [0.0, 0.5, 0.5], [0.0, 0.499, 0.5]])
def test_the_largest_force_is_a_sample_at_an_end_or_beside_an_event(time):
    for force in ([3.0, 2.0, 1.0], [2.0, 2.0, 2.0], [1.0, 3.0, 3.0]):
        found = trajectory(np.array(time), np.array(force), np.array([0, 0, 1])).maximum_force()
        assert max(force) <= found < 1.13 * max(force)


@pytest.mark.parametrize("gap", [0.0, 1e-15, 1e-4])
def test_pull_off_is_not_of_rounding_between_two_samples(gap):
    """An event puts a sample beside another, and their forces differ by an error of the solver."""
    time = np.sort(np.append(np.linspace(0.0, 3.0, 61), 1.0 + gap))
    force = np.cos(time)
    force[21] += 1e-9
    phase = np.ones(time.size, int)
    phase[0] = 0
    found = trajectory(time, force, phase).unloading(slice(6, 6), discrete=False)
    assert float(found.pull_off) == pytest.approx(-np.cos(3.0), rel=1e-6)
    assert float(found.work) == pytest.approx(1.0 - np.sin(3.0), rel=1e-5)
