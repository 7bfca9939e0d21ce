"""Gas squeezed between sphere and plane: slip, limits, and the loss of a drop."""

from math import pi
from pathlib import Path

import numpy as np
import pytest

from asperity.film import AIR_FREE_PATH, AIR_VISCOSITY, gas_decrement, slip_factor, squeeze_drag

ROWS = np.genfromtxt(Path(__file__).parent / "data" / "gas_film.csv", delimiter=",")[1:]


@pytest.mark.parametrize("row", ROWS, ids=str)
def test_loss_of_a_drop_in_air(row):
    slip, speed, decrement = row
    mass = 2200.0 * 4.0 / 3.0 * pi * (50e-6) ** 3
    found = gas_decrement(
        release=40e-9, rebound=29.4e-9, mass=mass, gravity=9.81, radius=50e-6, viscosity=1.82e-5,
        slip_length=slip * 1e-9,
    )  # fmt: skip
    assert found[0] == pytest.approx(decrement, rel=5e-5)
    assert found[1] == pytest.approx(speed * 1e-3, rel=5e-5)


def test_free_path_of_air_follows_from_its_viscosity():
    """eta/(0.499 rho c): ideal gas of 28.97 g/mol at 293.15 K and 101 325 Pa."""
    per_kilogram = 8.314462618 / 0.028966 * 293.15
    density, speed = 101325.0 / per_kilogram, np.sqrt(8.0 / pi * per_kilogram)
    assert pytest.approx(AIR_VISCOSITY / (0.499 * density * speed), rel=2e-3) == AIR_FREE_PATH


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
    assert float(squeeze_drag(10e-9, 1e-6, 2e-5)) == pytest.approx(6.0 * pi * 2e-5 * 1e-12 / 10e-9)
