"""A smooth sphere on a standard linear solid: Lee and Radok's loading, Ting's unloading, dents."""

import math
from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import brentq
from scipy.special import beta

from asperity.contact import SmoothContact
from asperity.contact.viscoelastic import VISCOUS, Relaxation
from asperity.dynamics import Body, Limits
from asperity.dynamics.curve_table import FORCE, STORED
from asperity.dynamics.motion import prepare
from asperity.dynamics.stepped_motion import integrate_stepped
from asperity.dynamics.stepped_phase import LEFT, TURNED
from asperity.dynamics.viscoelastic.sphere_motion import Bounce
from asperity.errors import Outcome, Tolerance
from asperity.halfspace.viscoelastic_paraboloid import Solid
from asperity.laws import Hertz
from asperity.numerics.compilation import Program

# In units of its elastic impact a sphere meets the force 5/4 depth^(3/2).
STIFFNESS = 1.25


def impact(ratio, time, weight=0.0):
    """One impact at unit speed: its restitution, and all its samples."""
    bounce = Bounce(Solid(ratio, time, weight), 0.0, 1.0, (0.0, 0.0), -1.0)
    fates, tracks = zip(*(bounce.follow(inwards) for inwards in (True, False)), strict=True)
    assert fates == (TURNED, LEFT)
    samples = [np.concatenate(c) for c in zip(*tracks[0], *tracks[1], strict=True)]
    return -float(bounce.state[1]), samples


def direct(ratio, time):
    """The same from the published integrals: Lee and Radok (1960), Ting (1966).

    Loading: F ~ k d^1.5 + (1 - k) q, q the convolution of exp(-t/time) with the rate of d^1.5.
    Unloading: F is what the loading left at t1, when the contact radius was the same, which is
    where the integral of E(t - s) dd/ds from t1 to t is 0.
    """
    tight = {"rtol": 1e-11, "atol": 1e-13, "method": "DOP853", "dense_output": True}

    def loading(t, y):
        depth, speed, q, _ = y
        stretched = max(depth, 0.0) ** 1.5
        rate = 1.5 * math.sqrt(max(depth, 0.0)) * speed
        force = STIFFNESS * (ratio * stretched + (1.0 - ratio) * q)
        return [speed, -force, rate - q / time, speed - y[3] / time]

    def stops(t, y):
        return y[1]

    stops.terminal = True
    into = solve_ivp(loading, (0.0, 20.0), [0.0, 1.0, 0.0, 0.0], events=stops, **tight)
    top = into.t[-1]

    def passed(t, depth, pulled):
        def off(s):
            then = into.sol(s)
            kept = pulled - math.exp(-(t - s) / time) * then[3]
            return ratio * (depth - then[0]) + (1.0 - ratio) * kept

        if off(top) >= 0.0:
            return top
        return brentq(off, 0.0, top, xtol=1e-15) if off(0.0) > 0.0 else 0.0

    def force(t, depth, pulled):
        s = passed(t, depth, pulled)
        then = into.sol(s)
        relaxed = math.exp(-(t - s) / time) * then[2]
        return STIFFNESS * (ratio * max(then[0], 0.0) ** 1.5 + (1.0 - ratio) * relaxed)

    def unloading(t, y):
        return [y[1], -force(t, y[0], y[2]), y[1] - y[2] / time]

    def leaves(t, y):
        return ratio * y[0] + (1.0 - ratio) * y[2]

    leaves.terminal, leaves.direction = True, -1.0
    begin = [into.y[0, -1], 0.0, into.y[3, -1]]
    out = solve_ivp(unloading, (top, top + 50.0), begin, events=leaves, **tight)
    return -out.y[1, -1], top, out.t[-1], into


@pytest.mark.parametrize(("ratio", "time"), [(0.5, 1.0), (0.1, 0.3), (0.5, 20.0), (0.01, 2.0)])
def test_an_impact_is_that_of_the_published_integrals(ratio, time):
    expected, top, end, *_ = direct(ratio, time)
    found, (times, depth, *_) = impact(ratio, time)
    assert found == pytest.approx(expected, rel=1e-8)
    assert times[np.argmax(depth)] == pytest.approx(top, rel=1e-8)
    # The surface is left at a depth: where the contact radius is 0, not the overlap.
    assert depth[times <= end * (1.0 + 1e-8)][-1] > 1e-4


def test_force_of_loading_is_the_convolution_of_the_history():
    """The integral of E(t - s) d(a^3)/ds itself, by Gauss's rule over the motion that was found."""
    ratio, time = 0.3, 0.7
    _, (times, depth, _, force, *_) = impact(ratio, time)
    *_, into = direct(ratio, time)
    node, weight = np.polynomial.legendre.leggauss(80)
    loading = np.flatnonzero((force > 0.0) & (times < into.t[-1]))
    for index in loading[::8]:
        t = times[index]
        s = 0.5 * t * (1.0 + node)
        past = into.sol(s)
        modulus = ratio + (1.0 - ratio) * np.exp(-(t - s) / time)
        rate = 1.5 * np.sqrt(past[0]) * past[1]
        expected = STIFFNESS * 0.5 * t * (weight @ (modulus * rate))
        assert force[index] == pytest.approx(expected, rel=1e-6)
        assert depth[index] == pytest.approx(into.sol(t)[0], rel=1e-8)


@pytest.mark.parametrize("time", [1e-9, 1e9])
def test_what_is_too_fast_or_too_slow_to_relax_loses_nothing(time):
    assert impact(0.5, time)[0] == pytest.approx(1.0, abs=1e-8)


def test_the_loss_of_a_solid_that_relaxes_late_falls_with_the_inverse_of_the_time():
    """That of one that relaxes soon rises with the time, as the next test says."""
    long = [(1.0 - impact(0.5, time)[0]) * time for time in (1e4, 1e5)]
    assert long[0] == pytest.approx(long[1], rel=1e-3)


@pytest.mark.parametrize("ratio", [0.2, 0.8])
def test_a_weak_loss_is_that_of_the_viscoelastic_sphere(ratio):
    """1 - e = C1 A kappa^(2/5) v^(1/5), C1 = 1.15344 (Ramirez et al. 1999).

    With F = rho (d^1.5 + 1.5 A sqrt(d) dd/dt), kappa = (3/2)^(5/2) rho/m; a solid that relaxes soon
    has A = time (1 - k)/k and rho/m = k 5/4 in these units.
    """
    constant = 3.0 * 0.4 * beta(0.6, 1.5) * 1.25**0.6 / 1.5
    assert constant == pytest.approx(1.15344, rel=2e-5)
    time = 1e-6
    kappa = 1.5**2.5 * ratio * STIFFNESS
    expected = constant * time * (1.0 - ratio) / ratio * kappa**0.4
    assert 1.0 - impact(ratio, time)[0] == pytest.approx(expected, rel=2e-5)


def test_most_is_lost_where_the_contact_lasts_about_as_long_as_it_relaxes():
    """Calvit (1967): the rebound is least where the loss tangent at the impact's frequency is most.

    That of a standard linear solid is largest at an angular frequency of sqrt(k)/time.
    """
    times = np.geomspace(10.0**-0.5, 10.0**0.5, 7)
    found = [impact(0.5, time) for time in times]
    least = int(np.argmin([e for e, _ in found]))
    time, (clock, _, _, force, *_) = times[least], found[least][1]
    lasts = clock[force > 0.0][-1]
    assert time == pytest.approx(math.sqrt(0.5) * lasts / math.pi, rel=0.3)
    assert found[least][0] < 0.72


def test_energy_is_kept_stored_or_taken_and_a_dent_gives_its_own_to_creep():
    _, (_, _, speed, force, stored, dented, spent) = impact(0.2, 0.8)
    energy = 0.5 * speed**2 + stored + dented + spent
    np.testing.assert_allclose(energy, 0.5, atol=1e-10)
    assert np.all(np.diff(spent) > -1e-14)
    flight = np.flatnonzero(force > 0.0)[-1] + 2
    assert dented[flight] > 1e-4
    np.testing.assert_allclose(dented[flight:] + spent[flight:], dented[-1] + spent[-1], rtol=1e-12)


def brute(ratio, time, weight, depth, end, springs=1500, steps=12000):
    """Springs of the foundation, one by one, each in contact or free, by Runge and Kutta's rule."""
    width = 1.3 * math.sqrt(1.2)
    x = (np.arange(springs) + 0.5) * width / springs
    profile, share = x**2, 15.0 / 8.0 * width / springs

    def rates(state):
        z = state[2:]
        pressed = np.maximum(state[0] - profile, (1.0 - ratio) * z)
        force = share * np.sum(pressed - (1.0 - ratio) * z)
        return np.concatenate([[state[1], weight - force], (pressed - z) / time])

    state = np.zeros(springs + 2)
    state[0] = depth
    step, path = end / steps, [depth]
    for _ in range(steps):
        a = rates(state)
        b = rates(state + 0.5 * step * a)
        c = rates(state + 0.5 * step * b)
        d = rates(state + step * c)
        state = state + step / 6.0 * (a + 2.0 * b + 2.0 * c + d)
        path.append(state[0])
    return np.linspace(0.0, end, steps + 1), np.array(path)


def test_impacts_on_dents_and_turns_within_contact_are_those_of_the_single_springs():
    """A heavy sphere hops out of its dents before they fill, and stays in contact at last."""
    solid, depth, end = Solid(0.4, 6.0, 0.12), -0.5, 40.0
    bounce = Bounce(solid, depth, 0.0, (1.0, 1e-3), -9.0)
    tracks = []
    while bounce._clock + bounce.time < end:
        fate, found = bounce.follow(inwards=len(tracks) % 2 == 0)
        assert fate == TURNED
        tracks.append(found)
    joined = [np.concatenate(c) for c in zip(*(t for way in tracks for t in way), strict=True)]
    energy = 0.5 * joined[2] ** 2 - solid.weight * joined[1] + joined[4] + joined[5] + joined[6]
    np.testing.assert_allclose(energy, -solid.weight * depth, atol=1e-8)
    hops = [t for way in tracks for t in way if t.force[1] == 0.0 and t.dented[0] > 0.0]
    assert any(t.dented[-1] / t.dented[0] > 0.01 for t in hops)
    assert tracks[-1][0].force.min() > 0.0
    time, path = brute(*solid, depth, end)
    found = joined[0] <= end
    there = np.interp(joined[0][found], time, path)
    np.testing.assert_allclose(joined[1][found], there, atol=2e-4)


# --- in SI units -------------------------------------------------------------------------------

RADIUS, MODULUS, MASS = 10e-6, 3e9, 4.4e-12
_prepare = Program(prepare)


def integrated(ratio, time, body, tolerance, modulus=MODULUS):
    relaxation = Relaxation(SmoothContact(Hertz(RADIUS, modulus)), ratio, time)
    contact, body = relaxation.relaxed(), replace(body, in_bulk=(VISCOUS,))
    prepared = _prepare(contact, body)
    return integrate_stepped(
        contact, relaxation, body, prepared, Limits.of(tolerance), lambda made: None
    )


def test_a_sphere_bounces_to_rest_with_a_ledger_that_closes():
    body = Body(MASS, 9.81, 5e-6)
    motion, trajectory, outcome = integrated(0.1, 5e-8, body, Tolerance(max_impacts=30))
    rows = motion.impacts
    assert outcome is Outcome.REST
    assert float(np.max(rows.energy_balance_error)) < 1e-8 * float(rows.maximum_kinetic[0])
    assert np.all(np.diff(rows.apex) < 0.0)
    series, lost = trajectory, trajectory.lost[:, 0]
    energy = (
        0.5 * MASS * series.speed**2
        + float(body.weight) * series.separation
        + series.rows[:, STORED]
        + lost
    )
    np.testing.assert_allclose(energy, energy[0], atol=1e-8 * float(rows.maximum_kinetic[0]))
    assert np.all(np.diff(lost) >= -1e-14 * lost[-1])
    assert np.all(np.diff(series.time) >= 0.0)


def test_units_do_not_matter():
    body = Body(MASS, 0.0, 1e-9, 0.05)
    motion, trajectory, outcome = integrated(0.5, 1e-7, body, Tolerance(max_impacts=1))
    assert outcome is Outcome.ESCAPED
    length = (15.0 * MASS * 0.05**2 / (16.0 * MODULUS * math.sqrt(RADIUS))) ** 0.4
    expected, _ = impact(0.5, 1e-7 / (length / 0.05))
    assert -trajectory.speed[-1] == pytest.approx(-0.05 * expected, rel=1e-8)
    peak = np.max(trajectory.rows[:, FORCE])
    assert float(motion.impacts.force[0]) == pytest.approx(peak, rel=0.2)


def test_a_heavy_sphere_on_a_soft_solid_comes_to_rest_where_it_has_relaxed():
    body = Body(MASS, 9.81, 1e-9)
    motion, _, outcome = integrated(0.1, 1e-5, body, Tolerance(max_impacts=100), 1e4)
    assert outcome is Outcome.REST
    still = (0.75 * float(body.weight) / (0.1 * 1e4 * math.sqrt(RADIUS))) ** (2.0 / 3.0)
    assert float(motion.impacts.apex[-1]) == pytest.approx(-still, rel=5e-3)
    assert float(np.max(motion.impacts.energy_balance_error)) < 1e-8 * float(
        motion.impacts.maximum_kinetic[0]
    )
