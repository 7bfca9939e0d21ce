"""The half-space over all of Greenwood and Tripp's parameters: minutes, so `make validate`."""

from __future__ import annotations

from math import sqrt

import equinox as eqx
import jax
import pytest
from scipy.optimize import brentq

from asperity._jax import jnp
from asperity.contact import ElasticContact, State
from asperity.contact.profile import Sphere
from asperity.interface.interface import Interface
from asperity.laws import Hertz
from asperity.surfaces.heights import Gaussian

RADIUS = 1e8  # in units of the rms height and of E*
MU = (0.001, 0.03, 1.0, 4.0, 17.0, 100.0, 1000.0)
CENTRAL = (-10.0, -5.0, -1.0, 0.0, 1.0, 3.0, 6.0)


def contact(mu: float, rings: int) -> ElasticContact:
    density = mu / (8.0 / 3.0 * sqrt(2.0 * RADIUS))
    layer = Interface(Hertz(1.0, 1.0), Gaussian(1.0), density)
    return ElasticContact(layer, Sphere(RADIUS), 1.0, rings)


@eqx.filter_jit
def state(elastic: ElasticContact, separation: jax.Array) -> State:
    return elastic.state(separation, elastic.initial_memory())


@pytest.mark.long
@pytest.mark.parametrize("mu", MU)
@pytest.mark.parametrize("central", CENTRAL)
def test_force_at_a_separation_is_exact_to_a_millionth_everywhere(mu, central):
    """80 rings against 192, at the rigid separation of each central separation."""
    default, fine = contact(mu, 80), contact(mu, 192)

    def off(separation: float) -> float:
        return float(state(default, jnp.asarray(separation)).central) - central

    low = -1.0
    while off(low) > 0.0:
        low *= 4.0
    place = jnp.asarray(brentq(off, low, central + 1e-9, xtol=1e-12, rtol=1e-14))
    ours, judge = state(default, place), state(fine, place)
    assert float(ours.force) == pytest.approx(float(judge.force), rel=1e-6)
    assert float(ours.error) < 1e-6
