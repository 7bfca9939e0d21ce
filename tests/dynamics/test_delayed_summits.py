"""Single bodies on summits whose menisci take time to form."""

from math import pi

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from asperity._jax import jax, jnp
from asperity.contact import SmoothContact
from asperity.contact.asperity_table import asperity_table
from asperity.contact.delayed_formation import DelayedContact
from asperity.dynamics import Body, Limits, delayed_summits, prepare
from asperity.dynamics.delayed_path import Delay
from asperity.dynamics.external_forces import Along
from asperity.dynamics.gas_film import SqueezeFilm
from asperity.dynamics.single_impact import _impacts, single_impacts
from asperity.dynamics.stepped_motion import integrate_stepped
from asperity.dynamics.summit_path import Launch
from asperity.errors import Tolerance
from asperity.interface.summit_field import GaussianField
from asperity.laws import ConstantVolume, Hertz, Jkr, Meniscus
from asperity.laws.law import Sum
from asperity.numerics.compilation import Program

TIP, MODULUS = 450e-9, 6.6e10  # m, Pa
WET = Sum([Jkr(TIP, MODULUS, 0.05), Meniscus(TIP, 0.072, 0.2, 5e-10)])
BRIDGED = Sum([Hertz(TIP, MODULUS), ConstantVolume(TIP, 0.0728, 0.3, 1e-9, edge=False)])
RADIUS = 2e-6  # m
MASS = 4.0 / 3.0 * pi * RADIUS**3 * 2200.0  # kg
GAP = 60e-9  # m
AIR = 1.8e-5  # Pa s
BODIES, SUMMITS = 16, 16
FIELD = GaussianField(RADIUS, 2e14, 1.2e-9)
LAWS = {"wet": (WET, 1), "bridged": (BRIDGED, 0)}
"""With the number of the meniscus among the laws that remember."""

_prepare = Program(prepare)


def body(viscosity=0.0, **more):
    """One structure for all, so that one program is compiled."""
    film = SqueezeFilm(RADIUS, viscosity, 8e-8, 2e-9)
    return Body(MASS, 9.81, more.get("release", 0.0), more.get("speed", 0.0), drags=(film,))


def impacts(moving, speeds, offsets, time, name="wet", release=GAP):
    """First impacts; ``time`` is None for menisci that form at once."""
    count, (law, number) = len(offsets), LAWS[name]
    offsets = np.pad(offsets, ((0, 0), (0, SUMMITS - offsets.shape[1])), constant_values=-1.0)
    some = np.minimum(np.arange(BODIES), count - 1)
    kinetic = 0.5 * MASS * np.broadcast_to(np.asarray(speeds, float), count)[some] ** 2
    launches = Launch(kinetic, np.broadcast_to(np.asarray(release, float), count)[some])
    kinds = jnp.zeros((BODIES, SUMMITS), jnp.int32)
    delay = None if time is None else Delay(np.asarray(time), number)
    found = single_impacts(
        asperity_table([law], 1e-10), moving, launches, jnp.asarray(offsets)[some], kinds, True,
        None, delay,
    )  # fmt: skip
    return jax.tree_util.tree_map(lambda leaf: np.asarray(leaf)[:count], found)


@pytest.mark.parametrize("name", LAWS)
@pytest.mark.parametrize("viscosity", [0.0, AIR])
def test_one_summit_is_a_smooth_body(name, viscosity):
    """Which is stepped in time, impact by impact: the second begins at the first apex."""
    law, number = LAWS[name]
    contact, speed = SmoothContact(law), 0.5
    for time in (1e-10, 3e-9, 1e-8):
        thrown = body(viscosity, release=GAP, speed=speed)
        rows = integrate_stepped(
            contact, DelayedContact(contact, time), thrown, _prepare(contact, thrown),
            Limits.of(Tolerance(max_impacts=2)), lambda count: None,
        )[0].impacts  # fmt: skip
        found = impacts(body(viscosity), [speed], np.zeros((1, 1)), time, name)
        assert float(found.closest_approach[0]) == pytest.approx(
            float(rows.closest_approach[0]), rel=1e-8
        )
        np.testing.assert_allclose(found.lost[0, :-1], rows.lost[0, :-1], rtol=2e-8, atol=1e-24)
        apex = np.asarray(rows.apex)[:1]
        again = impacts(body(viscosity), [0.0], np.zeros((1, 1)), time, name, release=apex)
        assert not found.captured[0]
        if viscosity and again.captured[0]:
            continue  # the motion in time ends with its bond
        lost = np.diff(rows.lost[:, number])[0]
        assert again.lost[0, number] == pytest.approx(lost, rel=1e-6, abs=1e-24)


def test_several_summits_are_followed_in_time():
    """By an independent integrator, in nanometres, from one event to the next."""
    law, moving = BRIDGED, body(AIR)
    heights = np.array([0.0, -0.35, -0.8, -1.1, -2.9]) * 1e-9
    speed, release, time = 0.6, 30e-9, 2e-9
    found = impacts(moving, [speed], heights[None], time, "bridged", release=release)
    hertz, bridge = law.parts
    unit, rate = 1e-9, speed / 1e-9
    film, force = moving.drags[0], jax.jit(lambda d: hertz.force(d - heights))
    pull = jax.jit(lambda d: bridge.bonded_force(d - heights))
    drag = jax.jit(lambda d: film.resistance(Along.apart(d)))
    forming, breaking = float(bridge.forming_gap), float(bridge.breaking_gap)
    bonded, lost = np.zeros(heights.size, bool), 0.0

    def slope(_, y):
        d = y[0] * unit
        total = np.sum(force(d)) - moving.weight - float(drag(d)) * y[1] * speed
        near = bonded & (d - heights < breaking)
        total = total + np.sum(np.where(near, pull(d), 0.0))
        return [y[1], float(total) / (MASS * speed * rate), (y[0] - y[2]) / (time * rate)]

    def forms(_, y):
        rest = heights[~bonded]
        return y[2] * unit - (rest.max() + forming) if rest.size else 1.0

    def turns(_, y):
        return y[1]

    def leaves(_, y):
        return y[0] * unit - float(found.end[0])

    def caught_up(_, y):
        return y[2] - y[0]

    forms.terminal, forms.direction = True, -1.0
    leaves.terminal, leaves.direction = True, 1.0
    turns.terminal, turns.direction = True, 1.0
    caught_up.terminal, caught_up.direction = True, -1.0
    state, begun, closest, follows = np.array([release, 0.0, release]) / unit, 0.0, None, True
    state[1] = -1.0
    while True:
        events = [leaves, turns, forms, caught_up] if follows else [leaves, turns]
        answer = solve_ivp(slope, (begun, begun + 500.0), state, "DOP853", events=events,
                           rtol=1e-11, atol=1e-13, max_step=0.1)  # fmt: skip
        state, begun = answer.y[:, -1], answer.t[-1]
        hit = next(k for k, times in enumerate(answer.t_events) if times.size)
        if hit == 0:
            break
        if hit == 1:
            closest, state[1] = state[0] * unit, 1e-12
        elif hit == 2:
            number = np.flatnonzero(~bonded)[0]
            gap = state[0] * unit - heights[number]
            lost -= float(bridge.bonded_energy(jnp.asarray(gap)))
            bonded[number] = True
        else:
            follows = False
    assert 2 <= np.sum(bonded) < heights.size
    assert float(found.closest_approach[0]) == pytest.approx(closest, rel=1e-7)
    assert float(found.lost[0, 0]) == pytest.approx(lost, rel=1e-7)
    after = 0.5 * MASS * (state[1] * speed) ** 2
    kept = float(found.impact_energy[0] * found.restitution[0] ** 2)
    assert kept == pytest.approx(after, rel=1e-7)


def test_a_body_that_takes_too_many_steps_has_no_closest_approach(monkeypatch):
    """A launch of bodies without one ends with an error."""
    monkeypatch.setattr(delayed_summits, "_MOST_STEPS", -1000)
    launch = Launch(np.full(1, 0.5 * MASS * 0.3**2), np.full(1, GAP))
    table, summits = asperity_table([WET], 1e-10), (jnp.zeros((1, 1)), jnp.zeros((1, 1), jnp.int32))
    delay = Delay(np.asarray(3e-9), 1)
    found = jax.jit(lambda: _impacts(table, body(), launch, *summits, False, None, delay))()
    assert np.isnan(found.closest_approach[0])


def test_short_formation_is_formation_at_once_and_long_formation_is_none():
    offsets, speed = FIELD.summits(3, 0, SUMMITS)[0][:BODIES], 0.1
    prompt = impacts(body(), speed, offsets, None)
    short, shorter, long = (impacts(body(), speed, offsets, t) for t in (1e-12, 1e-13, 1.0))
    assert 0.0 < np.mean(prompt.captured) < 1.0
    np.testing.assert_array_equal(short.captured, prompt.captured)
    np.testing.assert_array_equal(short.bonds, prompt.bonds)
    off = [np.abs(found.lost[:, 1] / prompt.lost[:, 1] - 1.0) for found in (short, shorter)]
    assert np.max(off[0]) < 0.1
    np.testing.assert_allclose(off[1], 0.1 * off[0], rtol=0.1, atol=1e-7)
    assert not np.any(long.lost[:, 1])
    np.testing.assert_allclose(shorter.pull_off, prompt.pull_off, rtol=1e-6)
    assert np.all(long.pull_off < 0.5 * prompt.pull_off)
    assert np.max(long.maximum_force) < np.max(prompt.maximum_force)


@pytest.mark.parametrize("time", [1e-10, 3e-9, 1e-8])
def test_losses_and_restitution_are_one_balance(time):
    offsets, moving = FIELD.summits(3, 0, SUMMITS)[0][:BODIES], body(AIR)
    found = impacts(moving, 0.3, offsets, time)
    free = ~found.captured
    assert np.sum(free) > 8
    kept = found.impact_energy[free] * found.restitution[free] ** 2
    gained = -moving.plain.load.potential_gain(GAP, found.end[free] - GAP)
    brought = 0.5 * MASS * 0.3**2 + gained
    np.testing.assert_allclose(kept + found.lost[free].sum(axis=1), brought, rtol=1e-8)
