"""Load of an elastic rough sphere at a given central separation (Greenwood and Tripp 1967)."""

from math import sqrt

import equinox as eqx
from scipy.optimize import brentq

from asperity._jax import jnp
from asperity.contact import ElasticContact
from asperity.contact.profile import Sphere
from asperity.interface.interface import Interface
from asperity.laws import Hertz
from asperity.surfaces.heights import Gaussian
from figures import Figure, misses
from validation.known import rows

ROWS = rows("greenwood_tripp", 4, 3)
RADIUS, BETA, SIGMA, E = 50e-6, 0.25e-9, 10.5e-9, 56.8e9


@eqx.filter_jit
def state(contact, separation):
    return contact.state(separation, contact.initial_memory())


def figure(mu, central, load):
    density = 3.0 / 8.0 * mu / (SIGMA * sqrt(2.0 * RADIUS * BETA))
    layer = Interface(Hertz(BETA, E), Gaussian(SIGMA), density)
    contact = ElasticContact(layer, Sphere(RADIUS), E)

    def miss(reduced):
        return float(state(contact, jnp.asarray(reduced * SIGMA)).central) / SIGMA - central

    d = brentq(miss, central - 40.0, central, xtol=1e-10)
    force = float(state(contact, jnp.asarray(d * SIGMA)).force)
    unit = 2.0 * RADIUS * SIGMA * E * sqrt(SIGMA / (8.0 * RADIUS))
    problem = f"rough elastic sphere, mu {mu:g}: load at central separation {central:g} rms"
    source = "two independent programs, after Greenwood and Tripp (1967)"
    return Figure(problem, source, load, force / unit, "", 2e-4)


def figures():
    return [figure(*row) for row in ROWS]


def test_known_figures_are_met():
    assert misses(figures()) == []
