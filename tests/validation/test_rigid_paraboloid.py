"""Force on a rigid rough sphere: the integral of F_n over the paraboloid."""

from math import pi

import numpy as np
import pytest

from asperity._jax import jnp
from asperity.contact import RigidContact
from asperity.contact.profile import Sphere
from asperity.interface.interface import Interface
from asperity.laws import Dmt, Hertz
from asperity.numerics.height_integrals import height_integral
from asperity.surfaces.heights import Gaussian
from figures import Figure, misses

RADIUS, BETA, SIGMA, E, W, N = 50e-6, 0.25e-9, 10.5e-9, 56.8e9, 0.03, 1.69e16


@pytest.mark.parametrize("order", [0.0, 1.0, 1.5, 2.0])
@pytest.mark.parametrize("reduced", [-2.0, 0.0, 3.0])
def test_integral_over_the_paraboloid_raises_the_order(order, reduced):
    """int F_n(h/sigma) dA = 2 pi R sigma F_(n+1)(d/sigma)/(n+1)."""
    node, weight = np.polynomial.legendre.leggauss(200)
    end = np.sqrt(2.0 * RADIUS * SIGMA * (10.0 - reduced))
    r = 0.5 * end * (node + 1.0)
    h = reduced + r**2 / (2.0 * RADIUS * SIGMA)
    area = 2.0 * pi * r * 0.5 * end * weight
    found = float(jnp.sum(area * height_integral(order, jnp.asarray(h))))
    raised = float(height_integral(order + 1.0, reduced)) / (order + 1.0)
    assert found == pytest.approx(2.0 * pi * RADIUS * SIGMA * raised, rel=1e-9)


TABLE = {
    -1.0: (2.755502, 1.083315),
    0.0: (0.6166342, 0.3989423),
    2.0: (5.423705e-3, 8.490703e-3),
}


def forces(reduced):
    """F_5/2 and F_1 from the sourced table, each with its prefactor."""
    contact = RigidContact(
        Interface(Hertz(BETA, E) + Dmt(BETA, W), Gaussian(SIGMA), N), Sphere(RADIUS)
    )
    found = contact.state(jnp.asarray(reduced * SIGMA), contact.initial_memory())
    around = 2.0 * pi * RADIUS * SIGMA * N
    repulsion = around * 4.0 / 3.0 * E * np.sqrt(BETA) * SIGMA**1.5 * TABLE[reduced][0] / 2.5
    pull = -around * 2.0 * pi * BETA * W * TABLE[reduced][1]
    parts = dict(zip(contact.components, np.asarray(found.parts), strict=True))
    problem, source = f"rigid rough sphere at {reduced:g} rms", "height integrals tabulated apart"
    return (
        Figure(f"{problem}: elastic", source, repulsion, parts["elastic"], "N", 1e-6),
        Figure(f"{problem}: adhesion", source, pull, parts["adhesion"], "N", 1e-6),
    )


def figures():
    return [figure for reduced in TABLE for figure in forces(reduced)]


def test_known_figures_are_met():
    assert misses(figures()) == []
