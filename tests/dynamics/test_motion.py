"""Motion from turning point to turning point: conservation, known rebounds, time itself."""

import dataclasses
from math import pi, radians, sqrt

import equinox as eqx
import numpy as np
import pytest
from scipy.integrate import solve_ivp

from asperity._jax import jax, jnp
from asperity.contact import ElasticContact, RigidContact, SmoothContact
from asperity.contact.profile import Sphere
from asperity.contact.resolution import resolution
from asperity.dynamics import Body, simulate
from asperity.errors import ENDS, Outcome, Tolerance
from asperity.interface.interface import Interface
from asperity.laws import Bradley, ByKelvinGap, Dmt, Hertz, Jkr, Meniscus
from asperity.results.measures import measure
from asperity.surfaces.heights import Gaussian

RADIUS, BETA, SIGMA, E, N = 50e-6, 0.25e-9, 10.5e-9, 56.8e9, 1.69e16
MASS = 2200.0 * 4.0 / 3.0 * pi * RADIUS**3
BY_CONTACT = Meniscus(BETA, 0.0728, radians(73.0), 1.05e-9)
KELVIN = Meniscus(BETA, 0.0728, radians(73.0), 1.05e-9, ByKelvinGap())
HERTZ, DMT, BRADLEY = Hertz(BETA, E), Dmt(BETA, 0.03), Bradley(BETA, 0.03, 0.2e-9)
DROP = Body(MASS, 9.81, 200e-9)
THREE = Tolerance(max_impacts=3)


def rough(law, sigma=SIGMA):
    return RigidContact(Interface(law, Gaussian(sigma), N), Sphere(RADIUS))


@eqx.filter_jit
def integrate(contact, body):
    motion = simulate(contact, body, tolerance=THREE)
    return motion, measure(motion, body)


def outcome(motion):
    return ENDS[int(motion.end.outcome)]


CONSERVATIVE = {
    "rough hertz": (rough(HERTZ), DROP),
    "rough hertz + bradley": (rough(HERTZ + BRADLEY), DROP),
    "rough hertz + dmt": (rough(HERTZ + DMT), DROP),
    "meniscus formed at the Kelvin gap": (rough(HERTZ + KELVIN), DROP),
    "smooth hertz": (SmoothContact(Hertz(RADIUS, E)), Body(MASS, 9.81, 1e-6)),
    "smooth hertz, no gravity": (
        SmoothContact(Hertz(RADIUS, E)), Body(MASS, 0.0, 1e-9, 0.05)),
    "rough hertz on a half-space": (
        ElasticContact(Interface(HERTZ, Gaussian(SIGMA), N), Sphere(RADIUS), E, 48),
        Body(MASS, 9.81, 100e-9, 1e-3),
    ),
}  # fmt: skip


@pytest.mark.parametrize("name", CONSERVATIVE)
def test_conservative_contact_returns_all_energy(name):
    contact, body = CONSERVATIVE[name]
    motion, found = integrate(contact, body)
    assert float(found.restitution[0]) == pytest.approx(1.0, abs=1e-8)
    rows = motion.impacts
    assert float(rows.energy_balance_error[0]) < 1e-6 * float(rows.maximum_kinetic[0])
    if float(body.weight) > 0.0:
        top = float(body.release + body.kinetic / body.weight)
        assert float(rows.apex[0]) == pytest.approx(top, rel=1e-7)


def test_menisci_lose_what_they_do_beside_a_law_that_loses_nothing():
    """A faint pull by quadrature leaves the loss as it is; both scanning curves are finite."""
    faint = Bradley(BETA, 1e-7, 0.2e-9)
    (alone, _), (beside, found) = (
        integrate(rough(law), DROP) for law in (HERTZ + BY_CONTACT, HERTZ + faint + BY_CONTACT)
    )
    np.testing.assert_allclose(beside.impacts.lost, alone.impacts.lost, rtol=1e-4)
    assert float(jnp.max(beside.impacts.energy_balance_error)) < 1e-6 * float(
        beside.impacts.maximum_kinetic[0]
    )
    assert float(found.restitution[0]) < 1.0 - 1e-6


def test_a_motion_that_loses_nothing_oscillates():
    motion, _ = integrate(rough(HERTZ), DROP)
    assert outcome(motion) is Outcome.OSCILLATING
    assert int(motion.end.made) == 1


def test_without_gravity_a_rebound_escapes():
    motion, _ = integrate(*CONSERVATIVE["smooth hertz, no gravity"])
    assert outcome(motion) is Outcome.ESCAPED


def test_smooth_hertz_impact_depth_and_force():
    """(8/15) E* sqrt(R) depth^2.5 = m V^2 / 2 (Johnson 1985, section 11.4)."""
    contact, body = CONSERVATIVE["smooth hertz, no gravity"]
    rows = integrate(contact, body)[0].impacts
    depth = (15.0 / 16.0 * MASS * 0.05**2 / (E * sqrt(RADIUS))) ** 0.4
    assert float(rows.closest_approach[0]) == pytest.approx(-depth, rel=1e-8)
    force = 4.0 / 3.0 * E * sqrt(RADIUS) * depth**1.5
    assert float(rows.force[0]) == pytest.approx(force, rel=1e-7)


def test_smooth_hertz_contact_lasts_as_long_as_theory_says():
    """From touch to greatest depth 1.4716 depth / V (Johnson 1985, eq. 11.24)."""
    contact, body = CONSERVATIVE["smooth hertz, no gravity"]
    rows = integrate(contact, body)[0].impacts
    depth = -float(rows.closest_approach[0])
    half = float(rows.closest_approach_time[0]) - 1e-9 / 0.05
    assert half == pytest.approx(1.471638 * depth / 0.05, rel=1e-6)


JKR = Jkr(RADIUS, E, 0.05)
STICK = sqrt(2.0 * 7.092196 * (0.05**5 * RADIUS**4 / E**2) ** (1.0 / 3.0) / MASS)


@pytest.mark.parametrize("ratio", [0.3, 0.999])
def test_jkr_sphere_sticks_below_the_sticking_speed(ratio):
    body = Body(MASS, 0.0, 2e-9, ratio * STICK)
    motion, found = integrate(SmoothContact(JKR), body)
    assert bool(found.captured)
    assert float(found.restitution[0]) == 0.0
    assert float(motion.impacts.apex[0]) < float(JKR.breaking_gap)


def test_jkr_sphere_leaves_just_above_the_sticking_speed():
    motion, found = integrate(SmoothContact(JKR), Body(MASS, 0.0, 2e-9, 1.001 * STICK))
    assert not bool(found.captured)
    assert outcome(motion) is Outcome.ESCAPED


WITH_LOSS = {
    "rough meniscus": (rough(HERTZ + BY_CONTACT), DROP),
    "rough meniscus and dmt": (rough(HERTZ + DMT + BY_CONTACT), Body(MASS, 9.81, 60e-9)),
    "smooth jkr": (SmoothContact(JKR), Body(MASS, 9.81, 1e-6, 2.0 * STICK)),
}


@pytest.mark.parametrize("name", WITH_LOSS)
def test_energies_add_up_to_the_first_one(name):
    contact, body = WITH_LOSS[name]
    motion, _ = integrate(contact, body)
    rows = motion.impacts
    made = int(motion.end.made)
    assert made >= 1
    assert float(jnp.max(rows.energy_balance_error[:made])) < 1e-6 * float(rows.maximum_kinetic[0])
    assert np.all(np.diff(np.asarray(rows.lost).sum(axis=1)[:made]) >= 0.0)


WIDE, NARROW = 40e-9, 1.05e-9


@pytest.mark.parametrize("kelvin_radius", [NARROW, WIDE], ids=["narrow", "wide"])
def test_energy_closes_on_a_half_space_with_menisci(kelvin_radius):
    """Also where they stretch over two rms heights, and rings lag behind each other.

    As finely cut as the wider ones need: one program serves both.
    """

    def layer(kelvin_radius):
        meniscus = Meniscus(BETA, 0.0728, radians(73.0), kelvin_radius)
        return Interface(HERTZ + meniscus, Gaussian(SIGMA), N)

    resolved = resolution(layer(WIDE), deforms=True)
    contact = ElasticContact(layer(kelvin_radius), Sphere(RADIUS), E, 48, resolved)
    motion, found = integrate(contact, Body(MASS, 9.81, 200e-9))
    rows = motion.impacts
    assert float(jnp.max(rows.energy_balance_error)) < 1e-6 * float(rows.maximum_kinetic[0])
    assert 0.0 < float(found.restitution[0]) < 1.0


def test_curves_twice_as_fine_give_the_same_motion():
    """The stated error of the curves, 1e-8, is more than they have: apexes move by less."""
    contact = WITH_LOSS["rough meniscus"][0]
    body = Body(MASS, 9.81, 2e-6)
    resolved = contact.resolved
    twice = dataclasses.replace(contact, resolved=resolved._replace(panels=2 * resolved.panels))
    coarse, fine = (integrate(each, body)[0] for each in (contact, twice))
    assert float(jnp.max(coarse.table.errors)) < 1e-8
    np.testing.assert_allclose(coarse.impacts.apex, fine.impacts.apex, rtol=1e-8)
    np.testing.assert_allclose(coarse.impacts.apex_time, fine.impacts.apex_time, rtol=1e-8)


def turning_in_time(contact, body, memory, place, speed, sign):
    """Next time and place of zero speed, by stepping m d'' = F(d) - m g in reduced units."""
    unit = SIGMA
    clock = sqrt(unit / 9.81)
    force = jax.jit(lambda d: contact.state(d, memory).force)
    weight = float(body.weight)

    def rate(_, y):
        return [y[1], float(force(jnp.asarray(y[0] * unit))) / weight - 1.0]

    def turned(_, y):
        return y[1]

    turned.terminal, turned.direction = True, -sign
    start = [place / unit, speed * clock / unit]
    found = solve_ivp(
        rate, (0.0, 1e3), start, method="DOP853", rtol=1e-12, atol=1e-13, events=turned,
        first_step=1e-3,
    )  # fmt: skip
    # One Newton step from the dense output: at the turn the speed changes at a known rate.
    t, (d, v) = found.t_events[0][0], found.y_events[0][0]
    t_turn = t - v / rate(t, [d, v])[1]
    return t_turn * clock, d * unit


@pytest.mark.parametrize("name", ["rough hertz + dmt", "rough meniscus"])
def test_energy_integral_agrees_with_integration_in_time(name):
    contact, body = {**CONSERVATIVE, **WITH_LOSS}[name]
    rows = integrate(contact, body)[0].impacts
    release = float(body.release)
    down, deepest = turning_in_time(contact, body, contact.initial_memory(), release, 0.0, -1)
    memory = contact.update_memory(contact.initial_memory(), jnp.asarray(deepest))
    up, apex = turning_in_time(contact, body, memory, deepest, 0.0, 1)
    assert float(rows.closest_approach[0]) == pytest.approx(deepest, rel=1e-7)
    assert float(rows.closest_approach_time[0]) == pytest.approx(down, rel=1e-7)
    assert float(rows.apex[0]) == pytest.approx(apex, rel=1e-7)
    assert float(rows.apex_time[0]) == pytest.approx(down + up, rel=1e-7)


def test_a_batch_of_motions_equals_single_ones():
    """The last of them oscillates after its first impact, while its neighbours go on."""
    sigmas = jnp.asarray([8e-9, 10.5e-9, 13e-9, 10.5e-9])
    releases = jnp.asarray([150e-9, 200e-9, 90e-9, 200e-9])
    pulls = jnp.asarray([0.0728, 0.0728, 0.0728, 1e-15])

    def one(sigma, release, pull):
        meniscus = Meniscus(BETA, pull, radians(73.0), 1.05e-9)
        motion, measures = integrate(rough(HERTZ + meniscus, sigma), Body(MASS, 9.81, release))
        rows = motion.impacts
        return motion.end.made, rows.apex, rows.lost, measures.log_decrement

    made, *batch = jax.jit(jax.vmap(one))(sigmas, releases, pulls)
    np.testing.assert_array_equal(made, [3, 3, 3, 1])
    for k in range(3):
        _, *single = one(sigmas[k], releases[k], pulls[k])
        for together, alone in zip(batch, single, strict=True):
            np.testing.assert_allclose(together[k], alone, rtol=1e-9)


@pytest.fixture(scope="module")
def decrement():
    """First log decrement of a rough JKR sphere dropped under gravity."""
    body = Body(MASS, 9.81, 100e-9)

    def first(rms_height):
        layer = Interface(Jkr(2e-7, E, 0.05), Gaussian(rms_height), 1e12)
        contact = RigidContact(layer, Sphere(RADIUS))
        motion = simulate(contact, body, tolerance=Tolerance(max_impacts=1))
        return measure(motion, body).log_decrement[0]

    return jax.jit(jax.value_and_grad(first))


@pytest.mark.long
def test_gradient_of_the_decrement_with_respect_to_roughness(decrement):
    """jax.grad of a JKR case against a central difference of fourth order."""
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
    contact = rough(HERTZ + BY_CONTACT)

    @jax.jit
    def ended(rest, time_limit):
        tolerance = Tolerance(rest=rest, time_limit=time_limit, max_impacts=3)
        return simulate(contact, DROP, tolerance=tolerance).end.outcome

    usual = Tolerance()
    for limits, named in (
        ((usual.rest, usual.time_limit), Outcome.MAX_IMPACTS),
        ((usual.rest, 1e-6), Outcome.TIME_LIMIT),
        ((2.0, usual.time_limit), Outcome.REST),
    ):
        assert ENDS[int(ended(*limits))] is named
