"""Gas squeezed between sphere and plane: slip and limits."""

from math import pi

import numpy as np
import pytest

from asperity.dynamics.gas_film import SqueezeFilm, slip_factor


def test_no_slip_is_the_limit_of_little_slip():
    assert float(slip_factor(1e-6, 1e-13)) == pytest.approx(1.0, abs=1e-6)
    assert float(slip_factor(1e-6, 0.0)) == 1.0


def test_the_series_joins_the_formula():
    """At 6 b/h = 1e-4 from both sides, with the slope -1/3."""
    x = np.array([0.99e-4, 1.01e-4])
    near = slip_factor(1e-6 / x, 1e-6 / 6.0)
    assert near[0] - near[1] == pytest.approx(0.02e-4 / 3.0, rel=1e-2)


def test_much_slip_makes_the_force_logarithmic():
    """f tends to (h/3b) (ln(6b/h) - 1)."""
    h, b = 1e-9, 1e-3
    limit = h / (3.0 * b) * (np.log(6.0 * b / h) - 1.0)
    assert float(slip_factor(h, b)) == pytest.approx(limit, rel=1e-5)


def test_drag_without_slip_is_that_of_two_spheres_at_a_plane():
    """6 pi eta R^2/h (Brenner 1961)."""
    drag = float(SqueezeFilm(1e-6, 2e-5).drag(10e-9))
    assert drag == pytest.approx(6.0 * pi * 2e-5 * 1e-12 / 10e-9)
