"""Gas squeezed between a sphere and a plane: drag by the exact series, loss of a drop."""

from math import acosh, log, pi, sinh, sqrt

import numpy as np
import pytest

from asperity._jax import jnp
from asperity.dynamics import Body
from asperity.dynamics.damped_summits import rebound
from asperity.dynamics.gas_film import SqueezeFilm
from figures import Figure, misses
from validation.known import rows

ROWS = rows("gas_film", 4, 3)
GAPS = (1e-5, 1e-4, 1e-3, 3.9e-3)  # of the radius
RADIUS, VISCOSITY = 50e-6, 1.82e-5


def brenner(gap):
    """Drag over Stokes's at a gap in units of the radius. Brenner (1961), cosh(alpha) = 1 + gap.

    Sums and differences of hyperbolic functions over exp((2 n + 1) alpha), which has no overflow.
    """
    alpha = acosh(1.0 + gap)
    n = np.arange(1.0, 60.0 / alpha)
    m = 2.0 * n + 1.0
    fade = np.exp(-m * alpha)
    above = 1.0 - fade**2 + m * sinh(2.0 * alpha) * fade
    below = (1.0 - fade) ** 2 - (m * sinh(alpha)) ** 2 * fade
    share = n * (n + 1.0) / ((2.0 * n - 1.0) * (2.0 * n + 3.0))
    return 4.0 / 3.0 * sinh(alpha) * float(np.sum(share * (above / below - 1.0)))


def drag(gap):
    """Against the series, with a slip length of 1e-6 of the gap."""
    stokes = 6.0 * pi * VISCOSITY * RADIUS
    film = SqueezeFilm(RADIUS, VISCOSITY, 1e-6 * gap * RADIUS)
    found = float(film.drag(gap * RADIUS)) / stokes
    problem = f"gas film: drag over Stokes's, gap {gap:g} R"
    return Figure(problem, "series, Brenner (1961)", brenner(gap), found, "", 0.01)


def drop(slip, speed, decrement):
    """Loss of a drop in air, and its speed at the rebound, by slip length [nm]."""
    mass = 2200.0 * 4.0 / 3.0 * pi * RADIUS**3
    film, edge = SqueezeFilm(RADIUS, VISCOSITY, slip * 1e-9), 29.4e-9
    kinetic, apex = rebound(Body(mass, 9.81, 40e-9, drags=(film,)), jnp.asarray(edge))
    found = log((40e-9 - edge) / (float(apex) - edge)), sqrt(2.0 * float(kinetic) / mass)
    problem, source = f"drop through the gas film, slip {slip:g} nm", "independent integration"
    return (
        Figure(f"{problem}: decrement", source, decrement, found[0], "", 5e-5),
        Figure(f"{problem}: speed", source, speed, found[1] * 1e3, "mm/s", 5e-5),
    )


def figures():
    return [*map(drag, GAPS), *(row for known in ROWS for row in drop(*known))]


def test_known_figures_are_met():
    assert misses(figures()) == []


def test_the_series_tends_to_stokes_far_away():
    """With the first order of its distance: 1 + (9/8)/(1 + gap) (Lorentz 1907)."""
    assert brenner(200.0) == pytest.approx(1.0 + 9.0 / 8.0 / 201.0, rel=1e-4)


@pytest.mark.parametrize("gap", GAPS[:3])
def test_the_film_leaves_out_the_next_order_of_the_series(gap):
    """ln(R/gap)/5 + 0.9713 of Stokes's drag (Cox and Brenner 1967)."""
    missing = brenner(gap) - 1.0 / gap
    assert missing == pytest.approx(0.2 * log(1.0 / gap) + 0.9713, rel=3e-3)


def test_drag_tends_to_that_without_slip_in_proportion_to_the_slip_length():
    """A share 2 b/gap is missing."""
    whole = float(SqueezeFilm(RADIUS, VISCOSITY).drag(1e-8))
    for share in (1e-2, 1e-3, 1e-4):
        left = float(SqueezeFilm(RADIUS, VISCOSITY, share * 1e-8).drag(1e-8)) / whole
        assert 1.0 - left == pytest.approx(2.0 * share, rel=3.1 * share)
