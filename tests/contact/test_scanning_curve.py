"""Panels of a curve: they narrow to what is not smooth, and none lies across it."""

import numpy as np
import pytest

from asperity._jax import jnp
from asperity.contact.scanning_curve import STEPS, panels_around
from asperity.numerics.polynomials import points_between

ROUNDED = 1e-14
"""Of a separation: as far as two compilations of one residual overlap differ, with a margin."""


@pytest.mark.parametrize("kink", [-2.9617508392569e-8, -1e-9, 3.3e-10, 2.5e-7])
def test_no_panel_lies_across_a_kink_that_is_rounded(kink):
    """Else its polynomial rings about a jump of the force, and finds a pull-off that is none."""
    ends = np.asarray(panels_around(jnp.asarray([0.0, kink]), -2e-7, 3e-7, STEPS))
    low, width = ends[:-1], np.diff(ends)
    assert kink in ends
    points = (low + points_between(16)[:, None] * width)[:, width > 0.0]
    for rounded in kink * (1.0 + ROUNDED * np.array([-1.0, 1.0])):
        beyond = points > rounded
        assert np.all(np.all(beyond, axis=0) == np.any(beyond, axis=0))


def test_panels_narrow_to_a_kink_from_both_sides():
    kink = 2.5e-8
    ends = np.asarray(panels_around(jnp.asarray([kink]), -2e-7, 3e-7, STEPS))
    away = np.abs(ends - kink)
    assert np.all(np.diff(ends) >= 0.0)
    for side in (ends < kink, ends > kink):
        assert 1e-10 < np.min(away[side]) / kink < 1e-9
