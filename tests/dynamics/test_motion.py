"""Motion from turning point to turning point: conservation, known rebounds, time itself."""

import dataclasses
from math import pi, radians, sqrt

import numpy as np
import pytest

from asperity._jax import jax, jnp
from asperity.contact import ElasticContact, RigidContact, SmoothContact
from asperity.contact.profile import Sphere
from asperity.dynamics import Body, simulate
from asperity.errors import ENDS, Outcome, Tolerance
from asperity.interface.interface import Interface
from asperity.laws import Bradley, ByKelvinGap, Dmt, Hertz, Jkr, Meniscus
from asperity.results.measures import measure
from asperity.surfaces.heights import Gaussian
from in_time import next_turn

RADIUS, BETA, SIGMA, E, N = 50e-6, 0.25e-9, 10.5e-9, 56.8e9, 1.69e16
MASS = 2200.0 * 4.0 / 3.0 * pi * RADIUS**3
BY_CONTACT = Meniscus(BETA, 0.0728, radians(73.0), 1.05e-9)
KELVIN = Meniscus(BETA, 0.0728, radians(73.0), 1.05e-9, ByKelvinGap())
HERTZ, DMT = Hertz(BETA, E), Dmt(BETA, 0.03)
DROP = Body(MASS, 9.81, 200e-9)
USUAL = Tolerance()


def rough(law, sigma=SIGMA):
    return RigidContact(Interface(law, Gaussian(sigma), N), Sphere(RADIUS))


def integrate(contact, body, rest=USUAL.rest, time_limit=USUAL.time_limit):
    """Motion and measures; compiled once for each structure."""
    return _integrate(contact, body, rest, time_limit)


@jax.jit
def _integrate(contact, body, rest, time_limit):
    tolerance = Tolerance(rest=rest, time_limit=time_limit, max_impacts=3)
    motion = simulate(contact, body, tolerance=tolerance)
    return motion, measure(motion, body)


def outcome(motion):
    return ENDS[int(motion.end.outcome)]


def error_of_the_ledger(motion):
    """The largest, over the largest kinetic energy."""
    rows, made = motion.impacts, int(motion.end.made)
    return float(jnp.max(rows.energy_balance_error[:made]) / rows.maximum_kinetic[0])


WET = rough(HERTZ + DMT + BY_CONTACT)
CONSERVATIVE = {
    "rough hertz + dmt": (rough(HERTZ + DMT), DROP),
    "menisci formed at the Kelvin gap": (rough(HERTZ + KELVIN), DROP),
    "smooth hertz": (SmoothContact(Hertz(RADIUS, E)), Body(MASS, 9.81, 1e-6)),
    "rough hertz on a half-space": (
        ElasticContact(Interface(HERTZ, Gaussian(SIGMA), N), Sphere(RADIUS), E, 48),
        Body(MASS, 9.81, 100e-9, 1e-3),
    ),
}  # fmt: skip


@pytest.mark.parametrize("name", CONSERVATIVE)
def test_conservative_contact_returns_all_energy_and_oscillates(name):
    contact, body = CONSERVATIVE[name]
    motion, found = integrate(contact, body)
    assert float(found.restitution[0]) == pytest.approx(1.0, abs=1e-8)
    assert error_of_the_ledger(motion) < 1e-6
    top = float(body.release + body.kinetic / body.weight)
    assert float(motion.impacts.apex[0]) == pytest.approx(top, rel=1e-7)
    assert outcome(motion) is Outcome.OSCILLATING
    assert int(motion.end.made) == 1


def test_menisci_lose_what_they_do_beside_a_law_that_loses_nothing():
    """A faint pull by quadrature leaves the loss as it is; both scanning curves are finite."""
    faint = Dmt(BETA, 1e-7), Bradley(BETA, 1e-7, 0.2e-9)
    (alone, _), (beside, found) = (
        integrate(rough(HERTZ + pull + BY_CONTACT), DROP) for pull in faint
    )
    np.testing.assert_allclose(beside.impacts.lost, alone.impacts.lost, rtol=1e-4)
    assert error_of_the_ledger(beside) < 1e-6
    assert float(found.restitution[0]) < 1.0 - 1e-6


def test_smooth_hertz_impact_is_as_deep_strong_and_long_as_theory_says():
    """(8/15) E* sqrt(R) depth^2.5 = m V^2 / 2, and from touch to there 1.4716 depth / V.

    Johnson (1985), section 11.4 and eq. 11.24. Without gravity the rebound escapes.
    """
    motion, found = integrate(SmoothContact(Hertz(RADIUS, E)), Body(MASS, 0.0, 1e-9, 0.05))
    rows = motion.impacts
    depth = (15.0 / 16.0 * MASS * 0.05**2 / (E * sqrt(RADIUS))) ** 0.4
    assert float(rows.closest_approach[0]) == pytest.approx(-depth, rel=1e-8)
    force = 4.0 / 3.0 * E * sqrt(RADIUS) * depth**1.5
    assert float(rows.force[0]) == pytest.approx(force, rel=1e-7)
    half = float(rows.closest_approach_time[0]) - 1e-9 / 0.05
    assert half == pytest.approx(1.471638 * depth / 0.05, rel=1e-6)
    assert float(found.restitution[0]) == pytest.approx(1.0, abs=1e-8)
    assert error_of_the_ledger(motion) < 1e-6
    assert outcome(motion) is Outcome.ESCAPED


@pytest.mark.parametrize("release", [200e-9, 60e-9])
def test_energies_add_up_to_the_first_one(release):
    motion, _ = integrate(WET, Body(MASS, 9.81, release))
    made = int(motion.end.made)
    assert made >= 1
    assert error_of_the_ledger(motion) < 1e-6
    assert float(jnp.max(motion.table.errors)) < 1e-8
    assert np.all(np.diff(np.asarray(motion.impacts.lost).sum(axis=1)[:made]) >= 0.0)


def test_energy_closes_on_a_half_space_with_wide_menisci():
    """They stretch over two rms heights, and rings lag behind each other."""
    meniscus = Meniscus(BETA, 0.0728, radians(73.0), 40e-9)
    layer = Interface(HERTZ + meniscus, Gaussian(SIGMA), N)
    motion, found = integrate(ElasticContact(layer, Sphere(RADIUS), E, 48), DROP)
    assert error_of_the_ledger(motion) < 1e-6
    assert 0.0 < float(found.restitution[0]) < 1.0


@pytest.mark.long
def test_curves_twice_as_fine_give_the_same_motion():
    """The stated error of the curves, 1e-8, is more than they have: apexes move by less."""
    body, resolved = Body(MASS, 9.81, 2e-6), WET.resolved
    twice = dataclasses.replace(WET, resolved=resolved._replace(panels=2 * resolved.panels))
    coarse, fine = (integrate(each, body)[0] for each in (WET, twice))
    assert float(jnp.max(coarse.table.errors)) < 1e-8
    np.testing.assert_allclose(coarse.impacts.apex, fine.impacts.apex, rtol=1e-8)
    np.testing.assert_allclose(coarse.impacts.apex_time, fine.impacts.apex_time, rtol=1e-8)


@pytest.mark.parametrize("contact", [rough(HERTZ + DMT), WET], ids=["dmt", "dmt and menisci"])
def test_energy_integral_agrees_with_integration_in_time(contact):
    rows, memory = integrate(contact, DROP)[0].impacts, contact.initial_memory()
    deepest, down, _ = next_turn(contact, DROP, memory, float(DROP.release), -1)
    memory = contact.update_memory(memory, jnp.asarray(deepest))
    apex, up, _ = next_turn(contact, DROP, memory, deepest, 1)
    assert float(rows.closest_approach[0]) == pytest.approx(deepest, rel=1e-7)
    assert float(rows.closest_approach_time[0]) == pytest.approx(down, rel=1e-7)
    assert float(rows.apex[0]) == pytest.approx(apex, rel=1e-7)
    assert float(rows.apex_time[0]) == pytest.approx(down + up, rel=1e-7)


@pytest.mark.long
def test_gradient_of_the_decrement_with_respect_to_roughness():
    """jax.grad of a rough JKR sphere's first one against a central difference of fourth order."""
    body = Body(MASS, 9.81, 100e-9)

    @jax.jit
    @jax.value_and_grad
    def decrement(rms_height):
        layer = Interface(Jkr(2e-7, E, 0.05), Gaussian(rms_height), 1e12)
        contact = RigidContact(layer, Sphere(RADIUS))
        motion = simulate(contact, body, tolerance=Tolerance(max_impacts=1))
        return measure(motion, body).log_decrement[0]

    step = 2e-12
    value, gradient = decrement(SIGMA)
    at = {k: float(decrement(SIGMA + k * step)[0]) for k in (-2, -1, 1, 2)}
    difference = (8.0 * (at[1] - at[-1]) - (at[2] - at[-2])) / (12.0 * step)
    assert float(value) > 0.0
    assert float(gradient) == pytest.approx(difference, rel=1e-5)


def test_gravity_and_hertz_set_the_time_of_a_long_fall():
    """sqrt(2 H / g) to the surface, and half a Hertz contact, 1.4716 depth / speed.

    Depth (15 m v^2 / (16 E* sqrt(R)))^(2/5): Johnson (1985), eqs. 11.20 to 11.24.
    """
    rows = integrate(SmoothContact(Hertz(RADIUS, E)), Body(MASS, 9.81, 1e-3))[0].impacts
    speed = sqrt(2.0 * 1e-3 * 9.81)
    depth = (15.0 * MASS * speed**2 / (16.0 * E * sqrt(RADIUS))) ** 0.4
    half = speed / 9.81 + 1.4716 * depth / speed
    assert float(rows.closest_approach_time[0]) == pytest.approx(half, rel=1e-7)
    assert float(rows.apex_time[0]) == pytest.approx(2.0 * half, rel=1e-7)


def test_limits_end_a_motion_and_are_named():
    for limits, named in (
        ({}, Outcome.MAX_IMPACTS),
        ({"time_limit": 1e-6}, Outcome.TIME_LIMIT),
        ({"rest": 2.0}, Outcome.REST),
    ):
        assert outcome(integrate(WET, DROP, **limits)[0]) is named
