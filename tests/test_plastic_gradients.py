"""Derivatives through a whole impact of asperities that yield, against differences."""

from math import pi, radians

import numpy as np

from asperity._jax import jax, jnp
from asperity.contact import RigidPlasticContact
from asperity.contact.profile import Sphere
from asperity.dynamics import Body, simulate
from asperity.errors import Tolerance
from asperity.interface.plastic_interface import PlasticInterface
from asperity.laws import Dmt, Meniscus
from asperity.laws.plastic import KogutEtsion
from asperity.results.measures import measure
from asperity.surfaces.heights import Gaussian

RADIUS, TIP, E, DENSITY = 20e-6, 200e-9, 55e9, 1e14  # m, m, Pa, 1/m^2
MASS = 2200.0 * 4.0 / 3.0 * pi * RADIUS**3
BESIDE = Dmt(TIP, 0.03) + Meniscus(TIP, 0.0728, radians(50.0), 0.78e-9)
START = {"hardness": 2e9, "rms height": 5e-9, "speed": 0.03}  # Pa, m, m/s
ONE = Tolerance(max_impacts=1)


def impact(logarithms):
    """What the first impact gives, by logarithms of factors on hardness, rms height and speed.

    Its restitution, deepest point, apex, end of contact, and losses by mechanism.
    """
    hardness, rms, speed = (
        value * jnp.exp(x) for value, x in zip(START.values(), logarithms, strict=True)
    )
    contact = KogutEtsion(TIP, E, hardness, 0.25)
    interface = PlasticInterface(contact, BESIDE, Gaussian(rms), DENSITY)
    body = Body(MASS, 9.81, 40e-9, speed)
    motion = simulate(RigidPlasticContact(interface, Sphere(RADIUS)), body, tolerance=ONE)
    rows, measures = motion.impacts, measure(motion, body)
    return jnp.stack([measures.restitution[0], rows.closest_approach[0], rows.apex[0],
                      measures.contact_end, *rows.lost[0]])  # fmt: skip


@jax.jit
def along(place, way):
    """What the first impact gives at a place, and its slope there along a direction."""
    return jax.jvp(impact, (place,), (way,))


def test_derivatives_of_a_first_impact_are_those_of_differences():
    """With respect to each quantity: in one test, so that one process compiles it once."""
    step = 1e-3
    for way in jnp.eye(len(START)):
        for place in (0.0, 1e-3, 2e-3):  # rounding of the turn differs from place to place
            (restitution, *_), slopes = along(place * way, way)
            assert 0.6 < float(restitution) < 0.7
            ahead, behind, further, back = (
                along((place + n * step) * way, way)[0] for n in (1, -1, 2, -2)
            )
            near, far = (ahead - behind) / (2.0 * step), (further - back) / (4.0 * step)
            np.testing.assert_allclose(slopes, (4.0 * near - far) / 3.0, rtol=1e-7)
