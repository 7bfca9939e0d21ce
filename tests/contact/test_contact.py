"""Force between two bodies: rigid, smooth, and on an elastic half-space."""

from math import pi, radians, sqrt

import equinox as eqx
import numpy as np
import pytest
from scipy.optimize import brentq

from asperity._jax import jax, jnp
from asperity.contact import ElasticContact, RigidContact, SmoothContact
from asperity.contact.profile import Sphere
from asperity.interface.interface import Interface
from asperity.laws import Dmt, Hertz, Jkr, Meniscus
from asperity.surfaces.heights import Gaussian

RADIUS, BETA, SIGMA, E = 50e-6, 0.25e-9, 10.5e-9, 56.8e9
HERTZ = Hertz(BETA, E)


def interface(mu, law=HERTZ):
    """Mu is that of Greenwood and Tripp: (8/3) N sigma sqrt(2 R beta)."""
    density = 3.0 / 8.0 * mu / (SIGMA * sqrt(2.0 * RADIUS * BETA))
    return Interface(law, Gaussian(SIGMA), density)


def elastic(mu, law=HERTZ, rings=80, modulus=E):
    return ElasticContact(interface(mu, law), Sphere(RADIUS), modulus, rings)


@eqx.filter_jit
def state(contact, separation):
    return contact.state(separation, contact.initial_memory())


@eqx.filter_jit
def states(contact, separations, memory):
    return jax.lax.map(lambda d: contact.state(d, memory), separations)


@eqx.filter_jit
def remember(contact, separation):
    return contact.update_memory(contact.initial_memory(), separation)


@eqx.filter_jit
def force_slope(contact, separation):
    return jax.grad(lambda d: contact.state(d, contact.initial_memory()).force)(separation)


def rigid_separation(contact, central):
    """Where the deformed separation at the axis is ``central`` [m]."""

    def miss(d):
        return float(state(contact, jnp.asarray(d)).central) - central

    low = central - SIGMA
    while miss(low) > 0.0:
        low = central - 4.0 * (central - low)
    return brentq(miss, low, central + 1e-6 * SIGMA, xtol=1e-9 * SIGMA, rtol=1e-12)


@pytest.mark.parametrize("mu", [0.1, 4.0, 17.0, 200.0])
def test_force_is_converged_at_the_default_rings(mu):
    for reduced in (-20.0, -3.0, -1.0, 1.0, 3.0):
        d = jnp.asarray(reduced * SIGMA)
        coarse, fine = (float(state(elastic(mu, rings=n), d).force) for n in (80, 192))
        assert coarse == pytest.approx(fine, rel=1e-6)


@pytest.mark.parametrize("mu", [0.0, 0.001, 1.0, 17.0, 1000.0])
@pytest.mark.parametrize("central", [-10.0, -1.0, 2.0, 6.0])
def test_every_load_point_is_solved(mu, central):
    contact = elastic(mu)
    d = rigid_separation(contact, central * SIGMA)
    found = state(contact, jnp.asarray(d))
    assert float(found.central) == pytest.approx(central * SIGMA, abs=1e-6 * SIGMA)
    assert float(found.error) < 1e-6
    assert np.isfinite(float(found.force))
    assert float(found.force) > 0.0 or mu == 0.0


@pytest.mark.parametrize("reduced", [12.0, 30.0, 100.0, 1000.0])
def test_bodies_far_apart_feel_nothing_and_do_not_deform(reduced):
    found = state(elastic(4.0), jnp.asarray(reduced * SIGMA))
    assert 0.0 <= float(found.force) < 1e-20
    assert float(found.central) == pytest.approx(reduced * SIGMA, rel=1e-12)
    assert float(found.error) < 1e-6


def test_high_load_tends_to_hertz():
    """The asperity layer, some rms thick, no longer shows beside the approach."""

    def off(mu, reduced):
        force = float(state(elastic(mu), jnp.asarray(-reduced * SIGMA)).force)
        return abs(force / (4.0 / 3.0 * E * sqrt(RADIUS) * (reduced * SIGMA) ** 1.5) - 1.0)

    falling = [off(200.0, reduced) for reduced in (100.0, 1000.0, 10000.0)]
    assert falling[0] > 4.0 * falling[1] > 16.0 * falling[2]
    assert off(1000.0, 20000.0) < 3e-3


@pytest.mark.parametrize("reduced", [-2.0, 0.0, 2.0, 4.0])
def test_stiff_bulk_tends_to_the_rigid_contact(reduced):
    d = jnp.asarray(reduced * SIGMA)
    contact = elastic(4.0, modulus=1e10 * E)
    rigid = contact.rigid
    one, other = state(contact, d), state(rigid, d)
    assert float(one.force) == pytest.approx(float(other.force), rel=1e-6)
    assert float(one.stored) == pytest.approx(float(other.stored), rel=1e-6)
    assert float(one.central) == pytest.approx(float(d), abs=1e-6 * SIGMA)


CONTACTS = {
    "rigid": RigidContact(interface(4.0), Sphere(RADIUS)),
    "elastic": elastic(4.0),
    "elastic with dmt": elastic(4.0, HERTZ + Dmt(BETA, 0.03)),
    "smooth": SmoothContact(Hertz(RADIUS, E)),
}


@pytest.mark.parametrize("contact", CONTACTS.values(), ids=CONTACTS)
def test_force_is_the_slope_of_the_stored_energy(contact):
    """By a difference of sixth order, so that the energy's own derivative is not trusted."""
    for reduced in (-3.0, -0.5, 1.5):
        d, step = reduced * SIGMA, 0.02 * SIGMA
        weights = {-3: -1, -2: 9, -1: -45, 1: 45, 2: -9, 3: 1}
        slope = sum(
            w * float(state(contact, jnp.asarray(d + k * step)).stored) for k, w in weights.items()
        ) / (60.0 * step)
        force = float(state(contact, jnp.asarray(d)).force)
        assert force == pytest.approx(-slope, rel=2e-6, abs=1e-15)


def test_gradient_of_the_elastic_force_is_its_difference():
    contact, d, step = elastic(4.0), 0.5 * SIGMA, 1e-3 * SIGMA
    up, down = (float(state(contact, jnp.asarray(d + s)).force) for s in (step, -step))
    found = float(force_slope(contact, jnp.asarray(d)))
    assert found == pytest.approx((up - down) / (2.0 * step), rel=1e-5)


def test_force_does_not_depend_on_the_units():
    length, energy = 1e8, 1e15
    modulus = E * energy / length**3
    law = Hertz(BETA * length, modulus)
    here = elastic(4.0)
    layer = Interface(law, Gaussian(SIGMA * length), here.interface.density / length**2)
    there = ElasticContact(layer, Sphere(RADIUS * length), modulus, here.rings)
    one = float(state(here, jnp.asarray(0.3 * SIGMA)).force)
    other = float(state(there, jnp.asarray(0.3 * SIGMA * length)).force)
    assert other == pytest.approx(one * energy / length, rel=1e-9)


def test_remembered_bonds_hold_the_elastic_contact_until_the_kelvin_gap():
    """Unloading pulls after a contact, and not before the first; a reversal is continuous."""
    meniscus = Meniscus(BETA, 0.0728, radians(73.0), 1.05e-9)
    contact = elastic(4.0, HERTZ + meniscus)
    deep = jnp.asarray(2.0 * SIGMA)

    memory = remember(contact, deep)
    places = jnp.asarray(
        [2.0 * SIGMA, 2.0 * SIGMA + 0.5 * meniscus.interaction_range, 12.0 * SIGMA]
    )
    out = states(contact, places, memory)
    first = state(contact, deep)
    assert float(out.force[0]) == pytest.approx(float(first.force), rel=1e-7)
    assert float(out.bonds[1, 0]) == pytest.approx(float(first.bonds[0]), rel=2e-2)
    assert abs(float(out.force[2])) < 1e-9 * abs(float(first.force))


def test_a_smooth_body_feels_the_law_itself():
    law = Jkr(RADIUS, E, 0.05)
    contact = SmoothContact(law)
    d = jnp.asarray(0.5 * float(law.breaking_gap))
    assert float(state(contact, d).force) == 0.0
    touched = contact.update_memory(contact.initial_memory(), jnp.asarray(-1e-9))
    held = contact.state(d, touched)
    assert float(held.force) == pytest.approx(float(law.bonded_force(d)), rel=1e-13)
    gone = contact.update_memory(touched, jnp.asarray(2.0 * float(law.breaking_gap)))
    assert float(gone[0]) == 0.0


def test_rigid_contact_is_the_integral_of_its_pressure():
    """Derjaguin: force = 2 pi R int_d^inf p(h) dh, by quadrature of the pressure."""
    layer = interface(4.0, HERTZ + Dmt(BETA, 0.03))
    node, weight = np.polynomial.legendre.leggauss(200)
    d = 1.2 * SIGMA
    h = d + 5.0 * SIGMA * (node + 1.0)
    integral = float(5.0 * SIGMA * jnp.sum(weight * layer.pressure(jnp.asarray(h), ())))
    found = float(state(RigidContact(layer, Sphere(RADIUS)), jnp.asarray(d)).force)
    assert found == pytest.approx(2.0 * pi * RADIUS * integral, rel=1e-10)
