"""A body on a spring and a dashpot: beside closed forms and integrations in time."""

from __future__ import annotations

import functools
from itertools import pairwise
from math import pi, sqrt

import numpy as np
import pytest
from scipy.integrate import quad, solve_ivp
from scipy.optimize import brentq

from asperity._jax import jax, jnp
from asperity.contact import SmoothContact
from asperity.dynamics import Body, simulate
from asperity.dynamics.external_forces import Along, Load
from asperity.dynamics.suspension import Dashpot, Spring
from asperity.errors import ENDS, Outcome, Tolerance
from asperity.laws import Hertz, Jkr
from asperity.numerics.compilation import AT_ONCE
from asperity.results.measures import measure
from jkr_spheres import jkr

RADIUS, MODULUS, WORK, GRAVITY = 5e-6, 40e9, 0.05, 9.81
MASS = 2200.0 * 4.0 / 3.0 * pi * RADIUS**3
IMPACTS = 3
HERTZ = SmoothContact(Hertz(RADIUS, MODULUS))
JKR = SmoothContact(Jkr(RADIUS, MODULUS, WORK))


@functools.partial(jax.jit, compiler_options=AT_ONCE)
def move(contact, body):
    """Motion and measures; compiled once for each structure."""
    motion = simulate(contact, body, tolerance=Tolerance(max_impacts=IMPACTS))
    return motion, measure(motion, body)


def held(stiffness, rest_gap, damping=None, release=300e-9, speed=0.0):
    """A body on a spring, with a dashpot or without."""
    drags = () if damping is None else (Dashpot(damping),)
    return Body(MASS, GRAVITY, release, speed, drags, (Spring(stiffness, rest_gap),))


def in_time(body, force, legs=2 * IMPACTS):
    """Place [m] and time [s] of each turn, and what the dashpot has taken by then [J].

    By SciPy in nm and us, stopped and begun again where the body touches. ``force`` gives that of
    the contact at a separation [m], and is told whether the body has touched before.
    """
    spring = body.forces[0]
    damping = float(body.drags[0].damping) if body.drags else 0.0
    stiffness, rest_gap = float(spring.stiffness), float(spring.rest_gap)

    def rate(_, y):
        speed = y[1] * 1e-3
        push = force(y[0] * 1e-9, touched) - MASS * GRAVITY - stiffness * (y[0] * 1e-9 - rest_gap)
        return [y[1], (push - damping * speed) / MASS * 1e-3, damping * speed**2 * 1e-6]

    def turns(_, y):
        return y[1]

    def touches(_, y):
        return y[0]

    turns.terminal = touches.terminal = True
    y, time, found = [float(body.release) * 1e9, -float(body.speed) * 1e3, 0.0], 0.0, []
    touched = False
    for leg in range(legs):
        turns.direction = 1 if leg % 2 == 0 else -1
        while True:
            whole = solve_ivp(
                rate, (time, time + 1e3), y, "DOP853", events=[turns, touches],
                rtol=1e-13, atol=[1e-13, 1e-13, 1e-26], first_step=1e-6,
            )  # fmt: skip
            time, y = whole.t[-1], list(whole.y[:, -1])
            if whole.t_events[0].size:
                break
            y[0], touched = np.sign(y[1]) * 1e-12, True
        found.append((y[0] * 1e-9, time * 1e-6, y[2]))
    return np.array(found)


def turns_of(motion):
    """The same of a motion."""
    rows = motion.impacts
    places = np.stack([rows.closest_approach, rows.apex], axis=1)
    times = np.stack([rows.closest_approach_time, rows.apex_time], axis=1)
    return places.ravel()[: 2 * IMPACTS], times.ravel()[: 2 * IMPACTS]


def outcome(motion):
    return ENDS[int(motion.end.outcome)]


def closure(motion):
    """Largest error of the ledger over the largest kinetic energy."""
    rows, made = motion.impacts, int(motion.end.made)
    return float(np.max(rows.energy_balance_error[:made]) / rows.maximum_kinetic[0])


def test_a_free_oscillation_has_the_period_of_its_spring():
    """2 pi sqrt(m/k) about where the spring carries the weight, for ever."""
    stiffness, release = 1.0, 300e-9
    still = 200e-9 - MASS * GRAVITY / stiffness
    motion, measures = move(HERTZ, held(stiffness, 200e-9))
    assert outcome(motion) is Outcome.OSCILLATING
    assert float(motion.reference.equilibrium) == pytest.approx(still, rel=1e-14)
    assert float(motion.impacts.closest_approach[0]) == pytest.approx(2.0 * still - release, 1e-14)
    period = 2.0 * pi * sqrt(MASS / stiffness)
    assert float(motion.impacts.apex_time[0]) == pytest.approx(period, rel=1e-12)
    assert closure(motion) < 1e-14
    assert not bool(measures.touched)
    assert not bool(measures.captured)
    assert np.isnan(measures.impact_speed)
    assert np.isnan(measures.restitution).all()


@pytest.mark.parametrize("ratio", [0.05, 0.3, 0.7])
def test_a_damped_oscillation_has_the_decrement_of_its_dashpot(ratio):
    """It turns at every half period, at amplitudes that fall by the logarithmic decrement."""
    stiffness = 1.0
    natural = sqrt(stiffness / MASS)
    pace = natural * sqrt(1.0 - ratio**2)
    still = 200e-9 - MASS * GRAVITY / stiffness
    motion, measures = move(HERTZ, held(stiffness, 200e-9, 2.0 * ratio * sqrt(stiffness * MASS)))
    turns = 2 * IMPACTS if ratio < 0.1 else 2
    times = pi / pace * np.arange(1, turns + 1)
    swing = np.exp(-ratio * natural * times) * (-1.0) ** np.arange(1, turns + 1)
    places, found = turns_of(motion)
    np.testing.assert_allclose((places[:turns] - still) / (300e-9 - still), swing, rtol=1e-10)
    np.testing.assert_allclose(found[:turns], times, rtol=1e-9)
    assert closure(motion) < 1e-12
    assert not bool(measures.touched)


@pytest.mark.parametrize("ratio", [1.0001, 2.0, 20.0, 500.0])
@pytest.mark.parametrize("release", [300e-9, 100e-9])
def test_an_overdamped_body_creeps_to_where_spring_and_weight_hold_it(ratio, release):
    """Both decays of x'' + 2 z x' + x = 0, and all of its energy in the dashpot."""
    stiffness = 1.0
    natural = sqrt(stiffness / MASS)
    still = 200e-9 - MASS * GRAVITY / stiffness
    damping = 2.0 * ratio * sqrt(stiffness * MASS)
    motion, measures = move(HERTZ, held(stiffness, 200e-9, damping, release))
    assert outcome(motion) is Outcome.REST
    root = sqrt(ratio**2 - 1.0)
    slow, fast = -natural / (ratio + root), -natural * (ratio + root)

    def place(time):
        both = fast * np.exp(slow * time) - slow * np.exp(fast * time)
        return still + (release - still) * both / (fast - slow)

    rows = motion.impacts
    end, time = float(rows.apex[0]), float(rows.apex_time[0])
    assert abs(end - still) < 2e-3 * abs(release - still)
    exact = brentq(lambda t: place(t) - end, 0.9 * time, 1.1 * time, xtol=1e-300, rtol=1e-14)
    assert time == pytest.approx(exact, rel=1e-8)
    lost = 0.5 * stiffness * ((release - still) ** 2 - (end - still) ** 2)
    assert float(rows.lost[0, -1]) == pytest.approx(lost, rel=1e-9)
    assert closure(motion) < 1e-8  # of a kinetic energy that is down to a millionth of this
    assert not bool(measures.captured)


@pytest.mark.parametrize(
    ("stiffness", "rest_gap", "damping"),
    [(20.0, 100e-9, None), (20.0, 100e-9, 20e-9), (1.0, -100e-9, 20e-9)],
)
def test_a_bounce_is_that_of_an_integration_in_time(stiffness, rest_gap, damping):
    body = held(stiffness, rest_gap, damping)
    motion, measures = move(HERTZ, body)
    rigidity = 4.0 / 3.0 * MODULUS * sqrt(RADIUS)
    exact = in_time(body, lambda place, _: rigidity * max(-place, 0.0) ** 1.5)
    turns = 2 * int(motion.end.made)
    places, times = turns_of(motion)
    np.testing.assert_allclose(places[:turns], exact[:turns, 0], rtol=1e-8)
    np.testing.assert_allclose(times[:turns], exact[:turns, 1], rtol=1e-8)
    assert closure(motion) < 1e-10
    assert bool(measures.touched)
    if damping is None:
        assert outcome(motion) is Outcome.OSCILLATING
        assert float(measures.restitution[0]) == pytest.approx(1.0, abs=1e-8)
    else:
        assert turns == 2 * IMPACTS
        np.testing.assert_allclose(motion.impacts.lost[:IMPACTS, -1], exact[1::2, 2], rtol=1e-8)


LENGTH = (WORK**2 * RADIUS / MODULUS**2) ** (1.0 / 3.0)  # JKR's overlap for w = R = E* = 1
FOLD = (pi / 8.0) ** (1.0 / 3.0)


def adhesive(place):
    """JKR's force [N] on the bonded branch at a separation [m]."""
    overlap = max(-place / LENGTH, jkr(FOLD)[1])
    far = max(10.0 * FOLD, 2.0 * sqrt(abs(overlap)) + 3.0)
    radius = brentq(lambda a: jkr(a)[1] - overlap, FOLD, far, xtol=1e-15, rtol=1e-15)
    return WORK * RADIUS * jkr(radius)[0]


def _barrier(stiffness, rest_gap):
    """Energy [J] of JKR and a spring between first contact and pull-off, as the body goes there."""
    first, last = (2.0 * pi) ** (1.0 / 3.0), FOLD
    slope = lambda a: 2.0 * a - sqrt(0.5 * pi / a)  # noqa: E731
    contact = quad(lambda a: jkr(a)[0] * slope(a), last, first, epsabs=1e-13, epsrel=1e-13)[0]
    contact *= -WORK * RADIUS * LENGTH
    out = -jkr(last)[1] * LENGTH
    spring = 0.5 * stiffness * ((out - rest_gap) ** 2 - rest_gap**2)
    return contact + spring + MASS * GRAVITY * out


@pytest.mark.parametrize(("excess", "captured"), [(1.0 - 1e-6, True), (1.0 + 1e-6, False)])
def test_a_body_is_captured_against_the_pull_of_its_spring_by_their_energies(excess, captured):
    """Undamped: its energy at first contact, over what JKR and the spring ask for to pull-off."""
    stiffness, rest_gap = 100.0, 3e-9
    kinetic = excess * _barrier(stiffness, rest_gap)
    load = Load(jnp.asarray(MASS * GRAVITY), (Spring(stiffness, rest_gap),))
    release = 5e-9
    speed = sqrt(2.0 / MASS * (kinetic - float(load.potential(jnp.asarray(release)))))
    motion, measures = move(JKR, held(stiffness, rest_gap, None, release, speed))
    assert bool(measures.captured) == captured
    assert closure(motion) < 1e-10


def test_a_dashpot_captures_as_an_integration_in_time_does():
    """Bonded at first contact, and kept by what the dashpot and the bond have taken."""
    body = held(1.0, 3e-9, 20e-9, 30e-9)
    motion, measures = move(JKR, body)
    assert bool(measures.captured)
    exact = in_time(body, lambda place, touched: adhesive(place) if touched else 0.0)
    places, times = turns_of(motion)
    np.testing.assert_allclose(places, exact[:, 0], rtol=1e-8)
    np.testing.assert_allclose(times, exact[:, 1], rtol=1e-8)
    np.testing.assert_allclose(motion.impacts.lost[:IMPACTS, -1], exact[1::2, 2], rtol=1e-8)
    assert closure(motion) < 1e-10


@pytest.mark.long
def test_a_period_has_the_derivative_of_its_root():
    """d ln T/d ln k = -1/2, through the whole motion."""

    def period(stiffness):
        still = 200e-9 - MASS * GRAVITY / stiffness
        motion = simulate(
            HERTZ, held(stiffness, 200e-9, None, still + 50e-9), tolerance=Tolerance(max_impacts=1)
        )
        return motion.impacts.apex_time[0]

    both = jax.jit(jax.value_and_grad(period), compiler_options=AT_ONCE)
    value, slope = both(1.0)
    assert float(slope / value) == pytest.approx(-0.5, rel=1e-9)


def test_a_load_rises_to_where_its_energy_is_spent():
    """A quadratic in the distance; for good where the spring pushes out and its base is far."""
    stiffness, rest_gap = 3.0, 100e-9
    load = Load(jnp.asarray(1e-9), (Spring(stiffness, rest_gap),))
    for start, kinetic in ((300e-9, 0.0), (300e-9, 1e-15), (5e-9, 1e-14)):
        pull = 1e-9 + stiffness * (start - rest_gap)
        exact = (-pull + sqrt(pull**2 + 2.0 * stiffness * kinetic)) / stiffness
        found = float(load.apex_height(jnp.asarray(start), jnp.asarray(kinetic)))
        assert found == pytest.approx(max(exact, 0.0), rel=1e-12, abs=1e-22)


def test_a_spring_pulls_by_the_slope_of_its_potential():
    spring, dashpot, places = Spring(7.0, 20e-9), Dashpot(3e-9), (1e-9, 3e-9, 100e-9)
    for near, far in pairwise(places):
        work = quad(lambda d: float(spring.force(jnp.asarray(d))), near, far)[0]
        gained = spring.potential_gain(jnp.asarray(near), jnp.asarray(far - near))
        assert float(gained) == pytest.approx(work, rel=1e-12)
    found = dashpot.resistance(Along.apart(jnp.asarray(places)))
    np.testing.assert_array_equal(found, 3e-9)
