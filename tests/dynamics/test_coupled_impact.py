"""Single bodies on a half-space: closed forms, a rigid bulk, and paths followed in small steps."""

import dataclasses
from math import pi

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

from asperity._jax import jax, jnp
from asperity.contact.asperity_table import asperity_table
from asperity.contact.coupled_summits import influence_between
from asperity.dynamics import Body
from asperity.dynamics.coupled_impact import Bulk, coupled_impacts
from asperity.dynamics.gas_film import SqueezeFilm
from asperity.dynamics.summit_path import Launch
from asperity.dynamics.suspension import Dashpot, Spring
from asperity.dynamics.wave_radiation import WaveRadiation
from asperity.interface.summit_field import GaussianField
from asperity.laws.law import terms
from chosen import long_but
from dynamics.test_single_impact import (
    BODY,
    FAST,
    GAP,
    HEAVY,
    LAWS,
    MASS,
    MODULUS,
    RADIUS,
    TIP,
    launched,
)
from dynamics.test_single_impact import impacts as rigid_impacts

SUMMITS, BODIES = 16, 64  # of every test: a program is compiled for each number of laws
FIELD = GaussianField(RADIUS, 2e13, 1.2e-9)
STIFFNESS = 4.0 / 3.0 * MODULUS * np.sqrt(TIP)  # N/m^1.5, of a summit by Hertz


def impacts(law, launches, offsets, positions, modulus=MODULUS, body=BODY):
    """First impacts of up to so many bodies with up to so many summits, others far away."""
    count, summits = offsets.shape
    offsets = np.pad(offsets, ((0, 0), (0, SUMMITS - summits)), constant_values=-1.0)
    away = 1.0 + np.arange(SUMMITS - summits)[:, None] * np.ones(2)
    positions = np.concatenate([positions, np.broadcast_to(away, (count, *away.shape))], axis=1)
    some = np.minimum(np.arange(BODIES), count - 1)
    launches = Launch(*(jnp.asarray(values)[some] for values in launches))
    bulk = Bulk(jnp.asarray(positions)[some], jnp.asarray([TIP]), jnp.asarray(modulus))
    kinds = jnp.zeros((BODIES, SUMMITS), jnp.int32)
    table = asperity_table([law], 1e-11)
    found = coupled_impacts(table, body, launches, jnp.asarray(offsets)[some], kinds, bulk)
    return jax.tree_util.tree_map(lambda leaf: leaf[:count], found)


def drawn(seed):
    offsets, positions = FIELD.summits(seed, 0, SUMMITS)[0], FIELD.positions(seed, 0, SUMMITS)
    return offsets[:BODIES], positions[:BODIES]


def lowered_by_each_other(positions, energy):
    """Displacement of two summits per load of one another [m/N], as wide as on a rigid bulk.

    And the indentation there [m] of one that carries half of the energy.
    """
    rigid = (energy / (0.8 * STIFFNESS)) ** 0.4
    radii = jnp.full(2, np.sqrt(TIP * rigid))
    return float(influence_between(jnp.asarray(positions), radii, MODULUS)[0, 1]), rigid


def test_two_summits_share_a_load():
    """Both carry F = k z^(3/2) at an indentation z, and each lowers the other by C F."""
    apart, energy = 150e-9, 0.5 * MASS * np.array([1e-3, FAST]) ** 2
    law = LAWS["hertz"]
    positions = np.broadcast_to([[0.0, 0.0], [apart, 0.0]], (2, 2, 2))
    found = impacts(law, launched([1e-3, FAST]), np.zeros((2, 2)), positions)
    for k in range(2):
        lowered, rigid = lowered_by_each_other(positions[k], energy[k])
        assert lowered == pytest.approx(1.0 / (pi * MODULUS * apart), rel=0.03)

        def left(z, lowered=lowered, energy=energy[k]):
            return 0.8 * STIFFNESS * z**2.5 + lowered * STIFFNESS**2 * z**3 - energy

        z = brentq(left, 0.0, rigid, xtol=1e-25)
        force = STIFFNESS * z**1.5
        assert float(found.maximum_force[k]) == pytest.approx(2.0 * force, rel=1e-7)
        approach = -z - lowered * force
        assert float(found.closest_approach[k]) == pytest.approx(approach, rel=1e-7)
    np.testing.assert_allclose(found.restitution, 1.0, rtol=1e-12)


@pytest.mark.parametrize("name", ["dry", "jkr, wet"])
def test_a_stiff_bulk_is_a_rigid_one(name):
    offsets, positions = drawn(3)
    launches = launched(np.full(BODIES, FAST))
    rigid = rigid_impacts(LAWS[name], launches, offsets, HEAVY)
    found = impacts(LAWS[name], launches, offsets, positions, 1e20, HEAVY)
    np.testing.assert_array_equal(found.captured, rigid.captured)
    np.testing.assert_array_equal(found.bonds, rigid.bonds)
    np.testing.assert_allclose(found.closest_approach, rigid.closest_approach, rtol=1e-8)
    np.testing.assert_allclose(found.restitution, rigid.restitution, atol=1e-7)
    np.testing.assert_allclose(found.lost, rigid.lost, rtol=1e-12)
    assert np.mean(np.abs(found.pull_off / rigid.pull_off - 1.0)) < 2e-3


@pytest.mark.parametrize("name", ["dry", "hertz"])
def test_elastic_summits_lose_nothing(name):
    """DMT's attraction rises over the depth by which summits move one another."""
    found = impacts(LAWS[name], launched(np.full(BODIES, FAST)), *drawn(3), body=HEAVY)
    np.testing.assert_allclose(found.restitution, 1.0, rtol=1e-8)
    assert not np.any(found.captured)
    assert not np.any(found.interaction)


def test_a_spring_holds_a_body_on_a_half_space_too():
    """It has a potential: dry summits lose nothing; on a stiff bulk it is as on a rigid one."""
    held = Body(MASS, 9.81, 0.0, forces=(Spring(5.0, 20e-9),))
    launches, (offsets, positions) = launched(np.full(BODIES, FAST)), drawn(3)
    found = impacts(LAWS["dry"], launches, offsets, positions, body=held)
    np.testing.assert_allclose(found.restitution, 1.0, rtol=1e-8)
    stiff = impacts(LAWS["dry"], launches, offsets, positions, 1e20, held)
    rigid = rigid_impacts(LAWS["dry"], launches, offsets, held)
    np.testing.assert_allclose(stiff.closest_approach, rigid.closest_approach, rtol=1e-8)
    np.testing.assert_allclose(stiff.impact_energy, rigid.impact_energy, rtol=1e-12)
    fall = held.weight * (GAP - rigid.end)
    swung = 0.5 * 5.0 * ((GAP - 20e-9) ** 2 - (rigid.end - 20e-9) ** 2)
    brought = 0.5 * MASS * FAST**2 + fall + swung
    np.testing.assert_allclose(rigid.impact_energy, brought, rtol=1e-12)


SLOWED = Body(
    MASS, 9.81, 0.0,
    drags=(
        SqueezeFilm(RADIUS, 1.8e-6, 8e-8, 2e-9), Dashpot(1e-6),
        WaveRadiation.into(7e10, 0.17, 2200.0),
    ),
    forces=(Spring(0.5, 20e-9),),
)  # fmt: skip
"""What gas, a dashpot, waves, a spring and its weight act on."""


@pytest.mark.parametrize("name", long_but(["jkr, wet", "hertz"], "jkr, wet"))
def test_drags_slow_a_body_on_a_stiff_bulk_as_on_a_rigid_one(name):
    """There its way is cut where forces step; here it is a curve between many points."""
    launches, (offsets, positions) = launched(np.full(BODIES, FAST)), drawn(3)
    rigid = rigid_impacts(LAWS[name], launches, offsets, SLOWED)
    found = impacts(LAWS[name], launches, offsets, positions, 1e20, SLOWED)
    np.testing.assert_array_equal(found.captured, rigid.captured)
    np.testing.assert_array_equal(found.bonds, rigid.bonds)
    np.testing.assert_allclose(found.closest_approach, rigid.closest_approach, atol=1e-13)
    np.testing.assert_allclose(found.impact_energy, rigid.impact_energy, rtol=1e-12)
    np.testing.assert_allclose(found.restitution, rigid.restitution, atol=4e-5)
    film, dashpot, waves = (found.lost[:, k] / rigid.lost[:, k] for k in (-3, -2, -1))
    np.testing.assert_allclose(film, 1.0, atol=1e-5)
    np.testing.assert_allclose(dashpot, 1.0, atol=5e-6)
    assert float(jnp.mean(waves)) == pytest.approx(1.0, abs=0.02)


def test_losses_on_a_half_space_and_restitution_are_one_balance():
    law, launches = LAWS["jkr, wet"], launched(np.full(BODIES, FAST))
    found = impacts(law, launches, *drawn(3), body=SLOWED)
    free = ~np.asarray(found.captured)
    assert np.sum(free) > BODIES // 2
    assert np.all(found.lost[:, 2:] > 0.0)
    kept = found.impact_energy * found.restitution**2
    gained = -SLOWED.plain.load.potential_gain(GAP, np.asarray(found.end) - GAP)
    ledger = kept + np.sum(found.lost, axis=1) + found.interaction
    np.testing.assert_allclose(ledger[free], (launches.kinetic + gained)[free], rtol=1e-12)


def test_a_slowed_body_on_two_summits_is_followed_in_time():
    """By an independent integrator, with the force on both in closed form."""
    apart, law = 150e-9, LAWS["hertz"]
    positions = np.array([[[0.0, 0.0], [apart, 0.0]]])
    film, dashpot, waves = SLOWED.drags
    silent = dataclasses.replace(waves, coefficient=0.0)
    loose = dataclasses.replace(SLOWED, drags=(film, dashpot, silent))
    found = impacts(law, launched([FAST], 0.5e-9), np.zeros((1, 2)), positions, body=loose)
    unloaded = impacts(law, launched([FAST], 0.5e-9), np.zeros((1, 2)), positions)
    lowered, _ = lowered_by_each_other(positions[0], 0.5 * MASS * FAST**2)
    unit, rate = 1e-9, FAST / 1e-9

    def contact(place):
        if place >= 0.0:
            return 0.0

        def left(z):
            return z + lowered * STIFFNESS * z**1.5 + place

        return 2.0 * STIFFNESS * brentq(left, 0.0, -place, xtol=1e-26) ** 1.5

    def slope(_, y):
        place = y[0] * unit
        outer = -float(loose.plain.load.force(place))
        drag = float(film.drag(place) + 1e-6) * y[1] * FAST
        return [y[1], (contact(place) + outer - drag) / (MASS * FAST * rate)]

    def touches(_, y):
        return y[0]

    def turns(_, y):
        return y[1]

    answer = solve_ivp(slope, (0.0, 60.0), [0.5, -1.0], "DOP853", events=(touches, turns),
                       rtol=1e-9, atol=1e-11)  # fmt: skip
    inwards, outwards = answer.y_events[0][:2, 1]
    assert float(found.restitution[0]) == pytest.approx(-outwards / inwards, rel=1e-6)
    turn = answer.y_events[1][0, 0] * unit
    assert float(found.closest_approach[0]) == pytest.approx(turn, rel=1e-6)
    assert float(unloaded.closest_approach[0]) < turn


def test_a_body_that_gas_stops_above_a_half_space_stays():
    """One stops in the film, one meets summits that hold it, and one comes out again."""
    thick = (SqueezeFilm(RADIUS, 1.8e-4, 8e-8, 2e-9), *SLOWED.drags[1:])
    body = Body(MASS, 0.0, 0.0, drags=thick, forces=(Spring(0.0, 20e-9),))
    offsets, positions = (some[2:3].repeat(3, axis=0) for some in drawn(3))
    found = impacts(LAWS["jkr, wet"], launched([1e-3, 0.01, 0.8]), offsets, positions, body=body)
    np.testing.assert_array_equal(found.captured, [False, True, False])
    np.testing.assert_array_equal(found.restitution == 0.0, [True, True, False])
    np.testing.assert_array_equal(found.contacting, [0.0, 2.0, 16.0])
    assert found.closest_approach[0] == found.end[0]
    assert not np.any(found.lost[0, :2])
    brought = 0.5 * MASS * 1e-3**2
    assert float(jnp.sum(found.lost[0, 2:])) == pytest.approx(brought, rel=1e-6)


class Path:
    """Summits on a half-space at small steps of the separation, each solved by iteration."""

    def __init__(self, law, offsets, influence, energy):
        self.offsets, self.influence = offsets, influence
        self.gaps = np.linspace(-8e-9, 2e-9, 100_001)
        some = [one for one in terms(law) if one.hysteretic]
        self.bonded = [np.asarray(one.bonded_force(jnp.asarray(self.gaps))) for one in some]
        edges = [(float(one.forming_gap), float(one.breaking_gap)) for one in some]
        self.forming, self.breaking = np.array(edges).T[:, :, None]
        self.held = np.zeros((len(some), offsets.size), bool)
        self.separation = offsets[0] + 1.1e-9
        self.h, self.kinetic, self.force = self.separation - offsets, energy, 0.0

    def forces(self, h):
        bonds = [np.interp(h, self.gaps, bond) for bond in self.bonded]
        return np.sum(np.where(self.held, bonds, 0.0), axis=0)

    def settle(self):
        """Whether a bond has changed."""
        before = self.held.copy()
        while True:
            for _ in range(200):
                new = self.separation - self.offsets + self.influence @ self.forces(self.h)
                change, self.h = np.max(np.abs(new - self.h)), new
                if change < 1e-17:
                    break
            forms = ~self.held & (self.h <= self.forming)
            changes = forms | (self.held & (self.h >= self.breaking))
            if not changes.any():
                return bool(np.any(before != self.held))
            self.held ^= changes

    def go(self, step, fine):
        """By a step; where a bond changes on the way, by fine ones."""
        kept = self.separation, self.h, self.held.copy(), self.kinetic, self.force
        self.separation += step
        if self.settle() and abs(step) > fine:
            self.separation, self.h, self.held, self.kinetic, self.force = kept
            for _ in range(round(abs(step) / fine)):
                self.go(np.sign(step) * fine, fine)
            return
        new = float(np.sum(self.forces(self.h)))
        self.kinetic += 0.5 * step * (self.force + new)
        self.force = new


def followed(law, offsets, influence, energy, step, fine):
    """Restitution of a body that is not captured, and its turning point."""
    path = Path(law, offsets, influence, energy)
    while path.kinetic > 0.0:
        path.go(-step, fine)
    turn, over = path.separation, path.kinetic
    while path.held.any():
        path.go(step, fine)
        assert path.kinetic > over
    return np.sqrt(path.kinetic / energy), turn


def test_a_path_in_small_steps_gives_the_same():
    """Each bond that forms or breaks moves the others, whatever order they come in."""
    law, step = LAWS["jkr, wet"], 2e-12
    offsets, positions = drawn(7)
    energy = 0.5 * MASS * FAST**2
    found = impacts(law, launched(np.full(BODIES, FAST)), offsets, positions)
    assert np.max(np.abs(found.interaction)) > 1e-3 * np.max(found.lost)
    for k in np.flatnonzero(np.asarray(found.contacting) > 3.0)[:2]:
        radii = jnp.sqrt(TIP * jnp.maximum(offsets[k] - rigid_turn(law, offsets[k]), 0.0))
        influence = np.asarray(influence_between(jnp.asarray(positions[k]), radii, MODULUS))
        restitution, turn = followed(law, offsets[k], influence, energy, step, 0.02 * step)
        assert not found.captured[k]
        assert float(found.restitution[k]) == pytest.approx(restitution, abs=1e-4)
        assert float(found.closest_approach[k]) == pytest.approx(turn, abs=1.1 * step)


def test_bonds_of_summits_that_overlap_break_where_these_lose_their_equilibrium():
    """Two tips 25 nm apart, of which one is lower by up to 4 pm, beside a third."""
    law, step = LAWS["jkr, wet"], 2e-12
    lower = np.linspace(0.0, 4e-12, BODIES)
    offsets = np.stack([np.full(BODIES, 3e-10), np.zeros(BODIES), -lower], axis=1)
    positions = np.array([[0.0, 200e-9], [0.0, 0.0], [25e-9, 0.0]])
    found = impacts(
        law, launched(np.full(BODIES, FAST)), offsets, np.broadcast_to(positions, (BODIES, 3, 2))
    )
    assert not np.any(found.unsolved)
    radii = jnp.sqrt(TIP * (offsets[-1] - rigid_turn(law, offsets[-1])))
    influence = np.asarray(influence_between(jnp.asarray(positions), radii, MODULUS))
    energy = 0.5 * MASS * FAST**2
    restitution, turn = followed(law, offsets[-1], influence, energy, step, 0.02 * step)
    assert float(found.restitution[-1]) == pytest.approx(restitution, abs=3e-5)
    assert float(found.closest_approach[-1]) == pytest.approx(turn, abs=1.1 * step)


def rigid_turn(law, offsets):
    """Where such a body turns on a rigid bulk [m]."""
    return float(rigid_impacts(law, launched([FAST]), offsets[None]).closest_approach[0])
