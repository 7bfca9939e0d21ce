"""First impacts of single bodies: against a smooth body's, and against energies summed finely."""

from math import pi

import numpy as np
import pytest

from asperity._jax import jax, jnp
from asperity.contact import SmoothContact
from asperity.contact.asperity_table import asperity_table
from asperity.dynamics import Body, simulate
from asperity.dynamics.single_impact import single_impacts
from asperity.dynamics.summit_path import Launch
from asperity.errors import Tolerance
from asperity.interface.summit_field import GaussianField
from asperity.laws import Bradley, Dmt, Hertz, Jkr, Maugis, Meniscus
from asperity.laws.law import Sum, terms
from chosen import long_but

TIP, MODULUS, WORK = 450e-9, 6.6e10, 0.05  # m, Pa, J/m^2
LAWS = {
    "hertz": Hertz(TIP, MODULUS),
    "dry": Sum([Hertz(TIP, MODULUS), Dmt(TIP, WORK)]),
    "jkr": Jkr(TIP, MODULUS, WORK),
    "maugis": Maugis(TIP, MODULUS, WORK, 3e-10),
    "jkr, wet": Sum([Jkr(TIP, MODULUS, WORK), Meniscus(TIP, 0.072, 0.2, 5e-10)]),
}
SLOW, FAST = 2e-3, 8e-3  # m/s
RADIUS = 25e-6  # m
MASS = 4.0 / 3.0 * pi * RADIUS**3 * 2200.0  # kg
GAP = 60e-9  # m


BODY, HEAVY = Body(MASS, 0.0, 0.0), Body(MASS, 9.81, 0.0)


def launched(speeds, release=GAP, mass=MASS):
    speeds = np.asarray(speeds, float)
    return Launch(0.5 * mass * speeds**2, np.full(speeds.shape, release))


BODIES, SUMMITS = 256, 16  # of every test: one program is compiled for each number of laws


def impacts(law, launches, offsets, body=BODY):
    """First impacts of up to so many bodies with up to so many summits, others far away."""
    count = len(offsets)
    offsets = np.pad(offsets, ((0, 0), (0, SUMMITS - offsets.shape[1])), constant_values=-1.0)
    some = np.minimum(np.arange(BODIES), count - 1)
    launches, offsets = Launch(*(values[some] for values in launches)), offsets[some]
    found = all_impacts(law, launches, offsets, body)
    return jax.tree_util.tree_map(lambda leaf: leaf[:count], found)


def all_impacts(law, launches, offsets, body=BODY):
    kinds, table = jnp.zeros(offsets.shape, jnp.int32), asperity_table([law], 1e-11)
    return single_impacts(table, body, launches, jnp.asarray(offsets), kinds)


@jax.jit
def smooth_impact(law, body):
    """Energy that a smooth body leaves with, and its closest approach."""
    motion = simulate(SmoothContact(law), body, tolerance=Tolerance(max_impacts=1))
    return motion.impacts.leaving[0], motion.impacts.closest_approach[0]


@pytest.mark.parametrize("name", long_but(LAWS, "jkr, wet"))
def test_one_summit_is_a_smooth_body(name):
    """Whose motion is integrated over panels of its force."""
    law, mass = LAWS[name], MASS * (2.0 / 25.0) ** 3
    speeds = np.array([0.03, 0.1, 0.3, 1.0])
    found = impacts(law, launched(speeds, mass=mass), np.zeros((4, 1)))
    for k, speed in enumerate(speeds):
        leaving, closest = smooth_impact(law, Body(mass, 0.0, GAP, speed))
        left = float(leaving) / (0.5 * mass * speed**2)
        assert bool(found.captured[k]) == (left < 0.0)
        assert float(found.restitution[k]) == pytest.approx(max(left, 0.0) ** 0.5, rel=1e-9)
        assert float(found.closest_approach[k]) == pytest.approx(float(closest), rel=1e-9)


def summed(law, offsets, speed, weight, end):
    """Capture and restitution from energies of every summit at 20,000 separations.

    The restitution at the ``end`` of forces [m].
    """
    gaps = np.linspace(-12e-9, 4e-9, 400_001)
    free = np.asarray(sum(one.energy(jnp.asarray(gaps)) for one in terms(law)))
    top = offsets[0] + float(asperity_table([law], 1e-11).interaction_range[0])
    places = np.linspace(top, offsets[0] - 11e-9, 20_001)
    each = places[:, None] - offsets
    left = 0.5 * MASS * speed**2 + weight * (GAP - places)
    left = left - np.interp(each, gaps, free).sum(axis=1)
    bonds = []
    for one in (one for one in terms(law) if one.hysteretic):
        held = one.bonded_energy(jnp.asarray(gaps)) - one.energy(jnp.asarray(gaps))
        held = np.where(gaps < float(one.breaking_gap), held, float(one.rupture_loss))
        bonds.append((one, np.interp(each, gaps, np.asarray(held) + float(one.formation_loss))))
    inward = left - sum(
        np.where(each <= float(one.forming_gap), held, 0.0).sum(axis=1) for one, held in bonds
    )
    turn = int(np.argmax(inward < 0.0))
    outward = left - sum(
        held[:, each[turn] <= float(one.forming_gap)].sum(axis=1) for one, held in bonds
    )
    at = int(np.argmin(np.abs(places - end)))
    captured = outward[at : turn - 5].min() < 0.0
    kept = 0.0 if captured else np.sqrt(max(outward[at], 0.0) / inward[at])
    return captured, kept, places[turn]


@pytest.mark.parametrize("name", long_but([*LAWS][2:], "jkr, wet"))
@pytest.mark.parametrize("speed", [SLOW, FAST])
def test_many_summits_are_the_sum_of_all(name, speed):
    """Some captured and some not; a bond more or less would be a hundred times what is allowed."""
    law, weight = LAWS[name], float(HEAVY.weight)
    offsets = GaussianField(RADIUS, 2e13, 1.2e-9).summits(1, 0, 16)[0][:16]
    found = impacts(law, launched(np.full(16, speed)), offsets, HEAVY)
    assert np.all(np.asarray(found.within_range) < 16)
    for k, row in enumerate(offsets):
        captured, restitution, turn = summed(law, row, speed, weight, float(found.end[k]))
        assert bool(found.captured[k]) == captured
        assert float(found.restitution[k]) == pytest.approx(restitution, abs=1e-6)
        assert float(found.closest_approach[k]) == pytest.approx(turn, abs=8e-13)


def test_dry_elastic_summits_lose_nothing():
    offsets = GaussianField(RADIUS, 2e13, 1.2e-9).summits(2, 0, 16)[0]
    found = impacts(LAWS["dry"], launched(np.full(256, FAST)), offsets, HEAVY)
    np.testing.assert_allclose(found.restitution, 1.0, rtol=1e-8)
    assert not np.any(found.captured)
    assert found.lost.shape == (256, 0)


def test_a_body_released_within_range_has_the_energy_that_it_has_there():
    law = Sum([Hertz(TIP, MODULUS), Bradley(TIP, WORK, 3e-10)])
    for gap in (2e-10, 1e-6):
        found = impacts(law, launched([SLOW, FAST], release=gap), np.zeros((2, 1)))
        energy = 0.5 * MASS * np.array([SLOW, FAST]) ** 2
        np.testing.assert_allclose(found.impact_energy, energy, rtol=1e-9)
        np.testing.assert_allclose(found.restitution, 1.0, rtol=1e-8)


def test_losses_and_restitution_are_one_balance():
    """What a body keeps and what its bonds took are what it came with, for every body."""
    law = LAWS["jkr, wet"]
    offsets = GaussianField(RADIUS, 2e13, 1.2e-9).summits(3, 0, 16)[0]
    found = impacts(law, launched(np.full(256, FAST)), offsets)
    energy = 0.5 * MASS * FAST**2
    free = ~np.asarray(found.captured)
    kept = energy * np.asarray(found.restitution)[free] ** 2
    np.testing.assert_allclose(kept + np.sum(found.lost, axis=1)[free], energy, rtol=1e-6)


def test_pull_off_of_one_summit_is_its_laws():
    law = LAWS["jkr, wet"]
    found = impacts(law, launched([0.1, 0.2]), np.full((2, 1), 1e-9))
    gaps = jnp.linspace(-1e-9, 1e-9, 200_001)
    bonded = [jnp.where(gaps < o.breaking_gap, o.bonded_force(gaps), 0.0) for o in terms(law)]
    np.testing.assert_allclose(found.pull_off, -np.min(sum(bonded)), rtol=1e-4)
    np.testing.assert_allclose(found.contacting, 1.0)
    np.testing.assert_allclose(found.loaded, 1.0)


def test_like_summits_are_as_many_loaded_ones():
    found = impacts(LAWS["jkr, wet"], launched([0.1]), np.zeros((1, 5)))
    assert float(found.loaded[0]) == pytest.approx(5.0, rel=1e-12)
    assert float(found.contacting[0]) == 5.0


def test_a_body_with_as_many_summits_as_were_given_says_so():
    offsets = GaussianField(RADIUS, 2e13, 1.2e-9).summits(1, 0, SUMMITS)[0]
    found = impacts(LAWS["jkr, wet"], launched(np.full(256, 0.2)), offsets)
    assert np.all(np.asarray(found.within_range) == SUMMITS)


def test_twice_as_many_separations_find_the_same(monkeypatch):
    """Neither a turning point nor the least energy is missed."""
    from asperity.dynamics import single_impact, summit_path

    law, table = LAWS["jkr, wet"], asperity_table([LAWS["jkr, wet"]], 1e-11)
    offsets = jnp.asarray(GaussianField(RADIUS, 2e13, 1.2e-9).summits(4, 0, 16)[0])
    launches = launched(np.full(256, SLOW))
    found = impacts(law, launches, offsets, HEAVY)
    monkeypatch.setattr(summit_path, "_SHARES", np.linspace(0.0, 1.0, 257))
    finer = single_impact.Program(single_impact._impacts, {"xla_cpu_use_fusion_emitters": True})
    again = finer(table, HEAVY, launches, offsets, jnp.zeros(offsets.shape, jnp.int32))
    assert 0.05 < np.mean(found.captured) < 0.95
    np.testing.assert_array_equal(found.captured, again.captured)
    np.testing.assert_allclose(found.restitution, again.restitution, rtol=1e-12)
    np.testing.assert_allclose(found.pull_off, again.pull_off, rtol=1e-4)


@pytest.mark.long
def test_bonds_of_low_summits_need_not_each_be_looked_at():
    """With as many far away, of half of those that touch only some are."""
    offsets = GaussianField(RADIUS, 2e16, 1.2e-9).summits(5, 0, 2048)[0][:8]
    launches, law = launched(np.geomspace(0.035, 0.3, 8)), LAWS["jkr, wet"]
    each = all_impacts(law, launches, offsets)
    some = all_impacts(law, launches, np.pad(offsets, ((0, 0), (0, 2048)), constant_values=-1.0))
    assert np.sum(each.contacting > 1100.0) > 3
    assert 0 < np.sum(each.captured) < 4
    np.testing.assert_array_equal(some.captured, each.captured)
    np.testing.assert_allclose(some.restitution, each.restitution, rtol=1e-9)
    np.testing.assert_allclose(some.pull_off, each.pull_off, rtol=1e-6)
