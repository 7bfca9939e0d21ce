"""Single bodies that gas, a dashpot, waves or a spring slow: against motions of smooth bodies."""

from math import pi

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

from asperity._jax import jax, jnp
from asperity.contact import SmoothContact
from asperity.contact.asperity_table import asperity_table
from asperity.dynamics import Body, damped_summits, simulate
from asperity.dynamics.damped_summits import flights
from asperity.dynamics.external_forces import Along
from asperity.dynamics.gas_film import SqueezeFilm
from asperity.dynamics.single_impact import _impacts, single_impacts
from asperity.dynamics.summit_path import Launch
from asperity.dynamics.suspension import Dashpot, Spring
from asperity.dynamics.wave_radiation import WaveRadiation
from asperity.errors import Tolerance
from asperity.interface.summit_field import GaussianField
from asperity.laws import Hertz, Jkr, Meniscus
from asperity.laws.law import Sum
from asperity.results.measures import measure

TIP, MODULUS, WORK = 450e-9, 6.6e10, 0.05  # m, Pa, J/m^2
WET = Sum([Jkr(TIP, MODULUS, WORK), Meniscus(TIP, 0.072, 0.2, 5e-10)])
RADIUS = 2e-6  # m
MASS = 4.0 / 3.0 * pi * RADIUS**3 * 2200.0  # kg
GAP = 60e-9  # m
BODIES, SUMMITS = 16, 16
FIELD = GaussianField(RADIUS, 2e14, 1.2e-9)
AIR = 1.8e-5  # Pa s


def body(viscosity=0.0, damping=0.0, stiffness=0.0, gravity=0.0, rest_gap=20e-9, **more):
    """One structure for all, so that one program is compiled."""
    drags = SqueezeFilm(RADIUS, viscosity, 8e-8, 2e-9), Dashpot(damping)
    return Body(
        MASS, gravity, more.get("release", 0.0), more.get("speed", 0.0), drags=drags,
        forces=(Spring(stiffness, rest_gap),),
    )  # fmt: skip


def impacts(moving, speeds, offsets, law=WET, release=GAP):
    count = len(offsets)
    offsets = np.pad(offsets, ((0, 0), (0, SUMMITS - offsets.shape[1])), constant_values=-1.0)
    some = np.minimum(np.arange(BODIES), count - 1)
    launches = launched(np.broadcast_to(speeds, count)[some], release)
    kinds = jnp.zeros((BODIES, SUMMITS), jnp.int32)
    found = single_impacts(
        asperity_table([law], 1e-10), moving, launches, jnp.asarray(offsets)[some], kinds
    )
    return jax.tree_util.tree_map(lambda leaf: np.asarray(leaf)[:count], found)


def launched(speeds, release=GAP):
    speeds = np.asarray(speeds, float)
    return Launch(0.5 * MASS * speeds**2, np.full(speeds.shape, release))


def drawn(seed):
    return FIELD.summits(seed, 0, SUMMITS)[0][:BODIES]


@jax.jit
def smooth_impact(law, moving):
    """Restitution, closest approach and losses of a smooth body; compiled once for each law."""
    motion = simulate(SmoothContact(law), moving, tolerance=Tolerance(max_impacts=1))
    rows = motion.impacts
    return measure(motion, moving).restitution[0], rows.closest_approach[0], rows.lost[0]


_flown = jax.jit(flights)


def flown(moving, starts, kinetic):
    """Energies and times with which bodies come back, each found alone."""
    each = (map(jnp.atleast_1d, one) for one in zip(starts, kinetic, strict=True))
    return np.squeeze([_flown(moving, *one)[:2] for one in each], axis=2).T


SLOWED = {
    "film": {"viscosity": AIR},
    "dashpot": {"damping": 2e-9},
    "spring": {"stiffness": 0.5},
    "all": {"viscosity": AIR, "damping": 2e-9, "stiffness": 0.5, "gravity": 9.81},
}


@pytest.mark.parametrize("name", SLOWED)
def test_one_summit_is_a_smooth_body(name):
    """Whose motion is integrated over panels of its force."""
    speeds = np.array([0.1, 0.3, 1.0])
    found = impacts(body(**SLOWED[name]), speeds, np.zeros((3, 1)))
    for k, speed in enumerate(speeds):
        restitution, closest, _ = smooth_impact(WET, body(**SLOWED[name], release=GAP, speed=speed))
        assert float(found.restitution[k]) == pytest.approx(float(restitution), rel=2e-7)
        assert float(found.closest_approach[k]) == pytest.approx(float(closest), rel=1e-7)


def test_a_hertzian_summit_is_followed_in_time():
    """By an independent integrator, in nanometres, from where it touches until it leaves."""
    law, moving, speed = Hertz(TIP, MODULUS), body(**SLOWED["all"]), 0.3
    found = impacts(moving, [speed], np.zeros((1, 1)), law, release=0.5e-9)
    unit, rate = 1e-9, speed / 1e-9
    outer = jax.jit(lambda d: -moving.load.force(d))
    drags = jax.jit(lambda d: jnp.sum(moving.resistances(Along.apart(d))))

    def slope(_, y):
        place = jnp.asarray(y[0] * unit)
        force = float(law.force(place)) + float(outer(place)) - float(drags(place)) * y[1] * speed
        return [y[1], force / (MASS * speed * rate)]

    def touches(_, y):
        return y[0]

    def turns(_, y):
        return y[1]

    answer = solve_ivp(slope, (0.0, 60.0), [0.5, -1.0], "DOP853", events=(touches, turns),
                       rtol=1e-11, atol=1e-13)  # fmt: skip
    inwards, outwards = answer.y_events[0][:2, 1]
    assert float(found.restitution[0]) == pytest.approx(-outwards / inwards, rel=1e-9)
    turn = answer.y_events[1][0, 0] * unit
    assert float(found.closest_approach[0]) == pytest.approx(turn, rel=1e-8)


def test_a_hertzian_summit_radiates_what_a_smooth_body_does():
    law = Hertz(TIP, MODULUS)
    waves = (WaveRadiation.into(7e10, 0.17, 2200.0),)
    found = impacts(Body(MASS, 0.0, 0.0, drags=waves), [0.3, 1.0], np.zeros((2, 1)), law)
    for k, speed in enumerate((0.3, 1.0)):
        lost = float(smooth_impact(law, Body(MASS, 0.0, GAP, speed, drags=waves))[2][0])
        assert float(found.lost[k, 0]) == pytest.approx(lost, rel=1e-6)
        kept = 1.0 - lost / (0.5 * MASS * speed**2)
        assert float(found.restitution[k]) ** 2 == pytest.approx(kept, abs=1e-9)


def test_losses_and_restitution_are_one_balance():
    moving, offsets = body(**SLOWED["all"]), drawn(3)
    found = impacts(moving, 0.3, offsets)
    free = ~found.captured
    assert np.sum(free) > 8
    kept = found.impact_energy[free] * found.restitution[free] ** 2
    gained = -moving.plain.load.potential_gain(GAP, found.end[free] - GAP)
    brought = 0.5 * MASS * 0.3**2 + gained
    np.testing.assert_allclose(kept + found.lost[free].sum(axis=1), brought, rtol=1e-8)
    assert np.all(found.lost[:, 2:] > 0.0)


def test_drags_of_nothing_take_nothing():
    offsets = drawn(4)
    found = impacts(body(), 0.15, offsets)
    free = impacts(Body(MASS, 0.0, 0.0), 0.15, offsets)
    assert 0.1 < np.mean(free.captured) < 0.9
    np.testing.assert_array_equal(found.captured, free.captured)
    np.testing.assert_allclose(found.restitution, free.restitution, rtol=1e-9)
    np.testing.assert_allclose(found.pull_off, free.pull_off, rtol=1e-9)


def test_more_and_shorter_pieces_find_the_same(monkeypatch):
    offsets = jnp.asarray(drawn(5))
    arguments = asperity_table([WET], 1e-10), body(viscosity=AIR), launched(np.full(BODIES, 0.3))
    kinds = jnp.zeros(offsets.shape, jnp.int32)
    found = single_impacts(*arguments, offsets, kinds)
    monkeypatch.setattr(damped_summits, "_SHARES", np.linspace(0.0, 1.0, 18)[1:-1])
    monkeypatch.setattr(damped_summits, "_CUT", SUMMITS)
    again = jax.jit(lambda *some: _impacts(*some, False))(*arguments, offsets, kinds)
    np.testing.assert_array_equal(found.captured, again.captured)
    np.testing.assert_allclose(found.restitution, again.restitution, rtol=1e-7)


def test_a_body_that_gas_stops_stays():
    """One stops in the film, one meets a summit that then holds it, and one comes out again."""
    speeds = np.array([1e-3, 0.08, 1.0])
    found = impacts(body(viscosity=AIR), speeds, np.zeros((3, 1)), release=1e-6)
    np.testing.assert_array_equal(found.captured, [False, True, False])
    np.testing.assert_array_equal(found.restitution == 0.0, [True, True, False])
    np.testing.assert_array_equal(found.contacting, [0.0, 1.0, 1.0])
    heavy = impacts(body(viscosity=AIR, gravity=0.1), speeds, np.zeros((3, 1)), release=1e-6)
    np.testing.assert_array_equal(heavy.captured, [True, True, False])


def test_a_body_that_its_spring_holds_back_meets_nothing():
    """Far above the summit, or between where a meniscus would break and where it forms."""
    moving, end = body(stiffness=0.5, rest_gap=200e-9), 0.3e-9
    needed = float(moving.load.potential_gain(GAP, jnp.asarray(end - GAP)))
    speeds = np.array([1e-3, np.sqrt(2.0 * needed / MASS), 1.0])
    found = impacts(moving, speeds, np.zeros((3, 1)))
    np.testing.assert_array_equal(found.captured, False)
    np.testing.assert_array_equal(found.restitution[:2], 1.0)
    np.testing.assert_array_equal(found.contacting, [0.0, 0.0, 1.0])
    np.testing.assert_array_equal(found.impact_energy[:2], 0.0)
    assert found.closest_approach[1] == pytest.approx(end, rel=1e-6)
    assert found.restitution[2] < 1.0
    free = impacts(Body(MASS, 0.0, 0.0, forces=moving.forces), speeds, np.zeros((3, 1)))
    np.testing.assert_array_equal(free.captured, False)
    np.testing.assert_array_equal(free.restitution[:2], 1.0)
    back, time = flown(moving, found.end, found.impact_energy)
    np.testing.assert_array_equal(np.isnan(back), [True, True, False])
    np.testing.assert_array_equal(np.isinf(time), [True, True, False])


def test_flights_are_those_of_closed_forms():
    start, speed = 5e-9, 3e-3
    kinetic = 0.5 * MASS * speed**2
    back, time = flown(body(gravity=9.81), [start], [kinetic])
    assert back[0] == pytest.approx(kinetic, rel=1e-9)
    assert time[0] == pytest.approx(2.0 * speed / 9.81, rel=1e-6)

    rate = 4e-9 / MASS  # 1/s, of a dashpot: x = (v + g/k)(1 - exp(-k t))/k - g t/k
    back, time = flown(body(damping=4e-9, gravity=9.81), [start], [kinetic])

    def height(t):
        return (speed + 9.81 / rate) * -np.expm1(-rate * t) / rate - 9.81 * t / rate

    lands = brentq(height, 1e-3 * speed / 9.81, 2.0 * speed / 9.81, xtol=1e-16)
    falls = (speed + 9.81 / rate) * np.exp(-rate * lands) - 9.81 / rate
    assert time[0] == pytest.approx(lands, rel=1e-6)
    assert back[0] == pytest.approx(0.5 * MASS * falls**2, rel=1e-8)

    # A spring of which it is half a period away from coming back, started where it is relaxed.
    back, time = flown(body(stiffness=0.5, rest_gap=start), [start], [kinetic])
    assert back[0] == pytest.approx(kinetic, rel=1e-9)
    assert time[0] == pytest.approx(pi * np.sqrt(MASS / 0.5), rel=1e-6)

    back, time = flown(body(viscosity=AIR), [start], [kinetic])
    assert np.isnan(back[0])
    assert np.isinf(time[0])
