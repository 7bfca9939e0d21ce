"""A rough sphere on a half-space that creeps, stepped in time."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from asperity._jax import jax, jnp
from asperity.contact import ElasticContact, SmoothContact
from asperity.contact.profile import Sphere
from asperity.contact.viscoelastic import VISCOUS, Relaxation
from asperity.dynamics import Body, Limits, simulate
from asperity.dynamics.motion import prepare
from asperity.dynamics.stepped_motion import integrate_stepped
from asperity.dynamics.viscoelastic import rough_phase
from asperity.dynamics.viscoelastic.ring_step import step
from asperity.dynamics.viscoelastic.ring_system import RingState
from asperity.errors import Outcome, Tolerance
from asperity.halfspace import ring_mesh
from asperity.interface.interface import Interface
from asperity.laws import Bradley, Dmt, Hertz, Meniscus
from asperity.numerics.compilation import Program
from asperity.surfaces.heights import Gaussian

RADIUS, MODULUS, MASS = 50e-6, 3.3e9, 5.5e-10
SIGMA, DENSITY, TIP = 5e-9, 1e13, 100e-9
LAW = Hertz(TIP, MODULUS) + Dmt(TIP, 0.02) + Meniscus(TIP, 0.073, 1.0, 1.5e-9)
BODY = Body(MASS, 9.81, 0.2e-6, 0.02)
ONE = Tolerance(max_impacts=1)


def contact(modulus=MODULUS, density=DENSITY, law=LAW, rings=48):
    return ElasticContact(Interface(law, Gaussian(SIGMA), density), Sphere(RADIUS), modulus, rings)


def integrated(ratio, time, body=BODY, tolerance=ONE, told=None):
    relaxation = Relaxation(told or contact(), ratio, time)
    relaxed, body = relaxation.relaxed(), replace(body, in_bulk=(VISCOUS,))
    prepared = _prepare(relaxed, body)
    return integrate_stepped(
        relaxed, relaxation, body, prepared, Limits.of(tolerance), lambda made: None
    )


_prepare = Program(prepare)
_simulate = Program(lambda told, body: simulate(told, body, tolerance=ONE))


def kept(motion):
    """Share of the energy at the first impact that the body has left after it."""
    rows = motion.impacts
    return float((rows.mechanical[0] - motion.release) / rows.maximum_kinetic[0])


@cache
def elastic(ratio=1.0):
    """Of the instantaneous or of the relaxed modulus; the asperities keep theirs."""
    return _simulate(contact(ratio * MODULUS), BODY)


@pytest.mark.parametrize(("ratio", "time"), [(1.0, 1e-6), (0.5, 1e3)])
def test_a_bulk_without_creep_is_the_elastic_half_space(ratio, time):
    found = integrated(ratio, time)[0]
    assert kept(found) == pytest.approx(kept(elastic()), abs=1e-6)
    for name in ("closest_approach", "closest_approach_time", "apex", "apex_time"):
        value, expected = getattr(found.impacts, name)[0], getattr(elastic().impacts, name)[0]
        assert float(value) == pytest.approx(float(expected), rel=1e-6)
    lost = found.impacts.lost[0]
    np.testing.assert_allclose(lost[:-1], elastic().impacts.lost[0], rtol=1e-6)
    assert lost[-1] <= 1e-6 * lost[0]


def test_a_bulk_that_creeps_at_once_is_the_relaxed_half_space():
    """The asperities on it keep the modulus that they have."""
    expected = elastic(0.5)
    off = []
    for time in (4e-9, 1e-9):
        found = integrated(0.5, time)[0]
        off.append(abs(kept(found) - kept(expected)))
        deepest = float(found.impacts.closest_approach[0])
        assert deepest == pytest.approx(float(expected.impacts.closest_approach[0]), rel=1e6 * time)
    assert off[1] == pytest.approx(0.25 * off[0], rel=0.1)


def test_ledger_closes_and_creep_is_booked_apart(monkeypatch):
    """Three impacts with as much creep as there can be, on rings as the elastic ones.

    As many menisci, within the change of depth that creep makes; none are left in flight.
    """
    motion, trajectory, outcome = integrated(0.5, 3e-7, tolerance=Tolerance(max_impacts=3))
    rows = motion.impacts
    assert outcome is Outcome.MAX_IMPACTS
    assert float(np.max(rows.energy_balance_error)) < 1e-7 * float(rows.maximum_kinetic[0])
    assert kept(motion) < -0.15
    lost = trajectory.lost
    assert np.all(np.diff(lost, axis=0) >= -1e-12 * lost[-1])
    assert lost[-1, 1] > 10.0 * lost[-1, 0] > 0.0
    assert np.all(np.diff(trajectory.time) >= 0.0)
    bonds = trajectory.rows[:, 6]
    assert float(np.max(bonds)) == pytest.approx(float(elastic().impacts.bonds[0, 0]), rel=0.3)
    tops = np.searchsorted(trajectory.time, rows.apex_time)
    np.testing.assert_allclose(bonds[np.minimum(tops, bonds.size - 1)], 0.0, atol=1e-12)
    monkeypatch.setattr(rough_phase, "TOLERANCE", 100.0 * rough_phase.TOLERANCE)
    loose = integrated(0.5, 3e-7)[0].impacts
    assert float(rows.energy_balance_error[0]) < 0.1 * float(loose.energy_balance_error[0])


def test_attraction_that_has_no_end_is_in_the_ledger_and_cut_off_from_the_pull_off(monkeypatch):
    """Of a slower creep, and of a bulk that forgets within a flight; in long steps.

    What is left at the range of forces, 2.6e-3 of the energy at half the speed, is not lost. The
    first sample of a flight is near there.
    """
    monkeypatch.setattr(rough_phase, "TOLERANCE", 1e-7)
    told = contact(law=Hertz(TIP, MODULUS) + Bradley(TIP, 0.02, 0.3e-9), rings=32)
    pulls = []
    for time in (1e-8, 1e-11):
        motion, trajectory, _ = integrated(0.5, time, told=told)
        rows = motion.impacts
        assert float(rows.energy_balance_error[0]) < 1e-6 * float(rows.maximum_kinetic[0])
        pulls.append(trajectory.unloading(slice(6, 6), discrete=False))
    slow, fast = pulls
    assert float(fast.pull_off) == pytest.approx(float(slow.pull_off), rel=0.01)
    assert float(fast.work) == pytest.approx(float(slow.work), rel=0.01)
    assert float(fast.separation) < 10.0 * SIGMA


def test_a_mesh_that_was_fitted_in_long_steps_serves_as_one_fitted_in_short_ones(monkeypatch):
    """To a body that comes some 200 rms heights deep."""
    fast = replace(BODY, speed=6.0)
    found = [integrated(0.5, 3e-7, fast, told=contact(rings=16))[0]]
    monkeypatch.setattr(rough_phase, "_TRIAL", rough_phase.TOLERANCE)
    found.append(integrated(0.5, 3e-7, fast, told=contact(rings=16))[0])
    long, short = found
    assert float(long.impacts.closest_approach[0]) < -150.0 * SIGMA
    for name in ("closest_approach", "force", "lost", "leaving"):
        value, expected = (np.asarray(getattr(one.impacts, name)[0]) for one in (long, short))
        np.testing.assert_allclose(value, expected, rtol=1e-6)


def test_pull_off_of_a_deep_body_is_read_between_steps(monkeypatch):
    """It pulls over a few rms heights, of the 200 that the body comes deep."""
    fast, found = replace(BODY, speed=6.0), []
    for stride in (0.1, 0.025):
        monkeypatch.setattr(rough_phase, "_UNLOADING_STRIDE", stride)
        trajectory = integrated(0.5, 3e-7, fast, told=contact(rings=16))[1]
        found.append(trajectory.unloading(slice(6, 7), discrete=False))
    coarse, fine = found
    assert float(coarse.pull_off) == pytest.approx(float(fine.pull_off), rel=2e-4)
    assert float(coarse.work) == pytest.approx(float(fine.work), rel=2e-4)


def test_steps_are_of_the_fourth_order():
    """Into the contact and with its bonds, against many more steps."""
    told = contact()
    relaxation = Relaxation(told, 0.4, 2e-7)
    one = Program(step)
    size, mesh = jnp.asarray(1e-6), ring_mesh(told.rings)
    rise = told.shape.profile(size * jnp.append(jnp.asarray(mesh.radius), mesh.end))
    start = jnp.asarray(7.0 * SIGMA)
    here = RingState(
        start, jnp.asarray(-0.02), start + rise, jnp.zeros(told.rings),
        told.interface.initial_memory(jnp.zeros(told.rings + 1)),
    )  # fmt: skip

    def end(parts):
        now, span = here, np.asarray(2e-6 / parts)
        for _ in range(parts):
            now = jax.tree_util.tree_map(jnp.asarray, one(relaxation, BODY, size, now, span).here)
        return float(now.speed)

    finest = end(512)
    off = [abs(end(parts) - finest) for parts in (40, 80)]
    assert off[0] > 2.0**3.5 * off[1]


@pytest.mark.long
def test_many_asperities_at_high_load_lose_what_the_smooth_sphere_does():
    """Two codes that share nothing: rings and implicit steps, and the exact foundation."""
    body = Body(MASS, 9.81, 0.2e-6, 3.0)
    dense = contact(density=1e14, law=Hertz(TIP, MODULUS))
    smooth = SmoothContact(Hertz(RADIUS, MODULUS))
    losses = []
    for told in (dense, smooth):
        motion = integrated(0.5, 5e-7, body=body, told=told)[0]
        losses.append(float(motion.impacts.lost[0, -1] / motion.impacts.maximum_kinetic[0]))
    assert losses[0] == pytest.approx(losses[1], rel=0.03)
