"""A smooth body that yields: what it keeps of an impact, and whether it leaves again."""

from math import pi, radians, sqrt

import equinox as eqx
import numpy as np
import pytest

from asperity._jax import jax, jnp
from asperity.contact import SmoothContact, SmoothPlasticContact
from asperity.dynamics import Body, simulate
from asperity.errors import ENDS, InputError, Outcome, Tolerance
from asperity.laws import ByKelvinGap, Dmt, Hertz, Jkr, Meniscus
from asperity.laws.plastic import JacksonGreen, KogutEtsion, ThorntonNing
from asperity.laws.plastic.adhesive_sphere import AdhesiveThorntonNing
from asperity.results.measures import measure

# A sphere of ammonium fluorescein on silicon
RADIUS = 2.45e-6
MODULUS = 1.0 / ((1.0 - 0.3**2) / 1.2e9 + (1.0 - 0.3**2) / 182e9)
MASS = 1350.0 * 4.0 / 3.0 * pi * RADIUS**3
SPHERE = ThorntonNing(RADIUS, MODULUS, 100e6)
ADHESIVE = AdhesiveThorntonNing(RADIUS, MODULUS, 0.2, 35.3e6)
THREE = Tolerance(max_impacts=3)
ZERO = jnp.zeros(())
EARTH = jnp.full((), 9.81)
SPEEDS = np.array([0.5, 2.0, 4.0, 8.0, 20.0, 40.0])  # m/s; as many everywhere, to compile once


def meniscus(tension=0.0728, **formation):
    return Meniscus(RADIUS, tension, radians(30.0), 1e-9, **formation)


def beside(work=0.05, tension=0.0728, **formation):
    return Dmt(RADIUS, work) + meniscus(tension, **formation)


@eqx.filter_jit
def integrate(contact, speeds, gravity=ZERO):
    """Impacts at some speeds [m/s] from 10 nm away, one row a speed; losses are no energies yet."""

    def one(speed):
        body = Body(MASS, gravity, 1e-8, speed)
        motion = simulate(contact, body, tolerance=THREE)
        rows = motion.impacts
        energy_balance_error = (
            jnp.max(jnp.where(rows.made, rows.energy_balance_error, 0.0)) / rows.maximum_kinetic[0]
        )
        return (
            rows._replace(energy_balance_error=energy_balance_error),
            measure(motion, body).restitution,
            motion.end,
        )

    return jax.vmap(one)(jnp.asarray(speeds))


def test_restitution_of_a_yielding_sphere_is_that_of_thornton_and_ning():
    """Their closed form (1998); with laws beside contact that pull by nothing."""
    yielding = float(jnp.sqrt(2.0 * SPHERE.loading_work(SPHERE.yield_overlap) / MASS))
    ratios = np.array([0.3, 0.99, 1.2, 10.0, 500.0, 1000.0])
    contact = SmoothPlasticContact(SPHERE, beside(0.0, 0.0))
    rows, restitution, _ = integrate(contact, ratios * yielding)
    v = 1.0 / np.maximum(ratios, 1.0)
    closed = np.sqrt(6.0 * sqrt(3.0) / 5.0) * np.sqrt(1.0 - v**2 / 6.0)
    closed *= (v / (v + 2.0 * np.sqrt(6.0 / 5.0 - v**2 / 5.0))) ** 0.25
    np.testing.assert_allclose(restitution[:, 0], closed, rtol=1e-8)
    np.testing.assert_allclose(restitution[:2, 0], 1.0, rtol=1e-8)
    slope = np.log(restitution[-1, 0] / restitution[-2, 0]) / np.log(ratios[-1] / ratios[-2])
    assert float(slope) == pytest.approx(-0.25, abs=1e-3)
    assert np.max(rows.energy_balance_error) < 1e-12


def balance(contact, deepest):
    """Kinetic energy [J] of an impact that reaches a depth, and what is left of it."""
    formation = contact.tip(ZERO).formation_loss
    kinetic = contact.loading_energy(deepest) + formation
    lost = formation + contact.dissipated(deepest) + contact.tip(deepest).rupture_loss
    return kinetic, kinetic - lost


@pytest.mark.long
def test_a_sphere_that_yields_and_adheres_leaves_as_its_energies_say():
    """The balance of energies has it stick below 1.458 m/s; that without yield is 0.567 m/s."""
    contact = SmoothPlasticContact(ADHESIVE, meniscus(0.0))
    low, high = ADHESIVE.yield_overlap, 100.0 * ADHESIVE.yield_overlap
    for _ in range(60):
        middle = 0.5 * (low + high)
        stuck = balance(ADHESIVE, middle)[1] < 0.0
        low, high = jnp.where(stuck, middle, low), jnp.where(stuck, high, middle)
    critical = float(jnp.sqrt(2.0 * balance(ADHESIVE, low)[0] / MASS))
    assert critical == pytest.approx(1.458, rel=1e-3)
    speeds = critical * np.array([0.4, 0.9999, 1.0001, 2.0, 5.0 / critical, 20.0])
    rows, restitution, _ = integrate(contact, speeds)
    assert np.all(restitution[:2, 0] == 0.0)
    kinetic, left = balance(ADHESIVE, -rows.closest_approach[2:, 0])
    np.testing.assert_allclose(kinetic, 0.5 * MASS * speeds[2:] ** 2, rtol=1e-10)
    np.testing.assert_allclose(restitution[2:, 0], np.sqrt(left / kinetic), rtol=1e-6)
    # Each loss by its name: the first touch is that of the whole tip.
    deepest = -rows.closest_approach[2:, 0]
    np.testing.assert_allclose(rows.lost[2:, 0, 0], ADHESIVE.dissipated(deepest), rtol=1e-9)
    bond = ADHESIVE.tip(ZERO).formation_loss + ADHESIVE.tip(deepest).rupture_loss
    np.testing.assert_allclose(rows.lost[2:, 0, 1], bond, rtol=1e-9)
    assert np.max(rows.energy_balance_error) < 1e-12


def test_a_second_impact_keeps_nothing_and_meets_the_flattened_tip():
    contact = SmoothPlasticContact(ADHESIVE, meniscus())
    rows, _, end = integrate(contact, SPEEDS + 3.5, EARTH)
    made = end.made
    assert np.all(made >= 2)
    assert np.max(rows.energy_balance_error) < 1e-8
    kept = np.asarray(rows.lost[..., 0])
    assert np.all(np.abs(kept[:, 1] - kept[:, 0]) < 1e-9 * np.asarray(rows.maximum_kinetic[:, 0]))
    assert np.all(rows.closest_approach[:, 1] > rows.closest_approach[:, 0])
    deepest, thrice = -rows.closest_approach[:, 0], made == 3
    bond = ADHESIVE.tip(deepest).formation_loss + ADHESIVE.tip(deepest).rupture_loss
    second = rows.lost[:, 1, 1] - rows.lost[:, 0, 1]
    assert np.any(thrice)
    np.testing.assert_allclose(second[thrice], bond[thrice], rtol=1e-9)


def test_energies_add_up_with_laws_beside_a_contact_that_yields():
    rows, restitution, end = integrate(SmoothPlasticContact(SPHERE, beside()), SPEEDS, EARTH)
    assert np.all(end.made[1:] == 3)
    assert np.max(rows.energy_balance_error) < 1e-8
    lost = np.asarray(rows.lost)
    assert np.all(
        np.abs(lost[:, 1, 0] - lost[:, 0, 0]) < 1e-9 * np.asarray(rows.maximum_kinetic[:, 0])
    )
    assert np.all(lost[1:, 1, 1] > lost[1:, 0, 1])
    assert np.all((restitution[1:, 0] > 0.0) & (restitution[1:, 0] < 1.0))
    dry = integrate(SmoothPlasticContact(SPHERE, beside(0.0, 0.0)), SPEEDS)[1]
    assert np.all(restitution[1:, 0] < dry[1:, 0])


@pytest.mark.long
def test_a_sphere_too_hard_to_yield_moves_as_one_that_cannot():
    hard = SmoothPlasticContact(ThorntonNing(RADIUS, MODULUS, 1e13), beside())
    rows, restitution, end = integrate(hard, SPEEDS, EARTH)
    theirs = integrate(SmoothContact(Hertz(RADIUS, MODULUS) + beside()), SPEEDS, EARTH)
    np.testing.assert_array_equal(end.made, theirs[2].made)
    np.testing.assert_allclose(restitution, theirs[1], rtol=1e-8)
    for ours, other in (
        (rows.closest_approach, theirs[0].closest_approach),
        (rows.apex, theirs[0].apex),
    ):
        np.testing.assert_allclose(ours, other, rtol=1e-8)
    np.testing.assert_array_equal(rows.lost[..., 0], 0.0)
    np.testing.assert_allclose(rows.lost[..., 1], theirs[0].lost[..., 0], rtol=1e-8)


@pytest.mark.long
def test_without_laws_beside_contact_the_work_that_is_kept_is_all_that_is_lost():
    sphere = JacksonGreen(RADIUS, MODULUS, 60e6, 0.3)
    rows, restitution, _ = integrate(SmoothPlasticContact(sphere), SPEEDS)
    kinetic = sphere.loading_work(-rows.closest_approach[:, 0])
    left = kinetic - sphere.dissipated(-rows.closest_approach[:, 0])
    np.testing.assert_allclose(restitution[:, 0], np.sqrt(left / kinetic), rtol=1e-8)
    assert np.max(rows.energy_balance_error) < 1e-8


CONTACTS = {
    "thornton-ning, dmt, meniscus": SmoothPlasticContact(SPHERE, beside()),
    "kogut-etsion, dmt, meniscus at the Kelvin gap": SmoothPlasticContact(
        KogutEtsion(RADIUS, MODULUS, 160e6, 0.3), beside(formation=ByKelvinGap())
    ),
    "adhesive, meniscus": SmoothPlasticContact(ADHESIVE, meniscus()),
}


def energy(contact, separation, memory):
    """Energy that is stored and, since the bonds began, lost [J]."""
    state = contact.state(separation, memory)
    return state.stored + state.bonds @ contact.losses()[0]


@pytest.mark.parametrize("name", CONTACTS)
def test_force_is_the_slope_of_what_is_stored_and_kept(name):
    contact = CONTACTS[name]
    slope = eqx.filter_jit(jax.vmap(jax.grad(energy, 1), (None, 0, None)))
    force = eqx.filter_jit(jax.vmap(lambda d, m: contact.state(d, m).force, (0, None)))
    begin = contact.contact.yield_overlap
    pressed = -begin * jnp.asarray([0.4, 0.95, 1.05, 3.0, 20.0])
    loading = slope(contact, pressed, contact.initial_memory())
    scale = float(jnp.max(jnp.abs(loading)))
    np.testing.assert_allclose(
        -loading, force(pressed, contact.initial_memory()), atol=1e-9 * scale
    )
    memory = contact.update_memory(contact.initial_memory(), -30.0 * begin)
    left = contact.contact.residual(30.0 * begin)
    unloading = jnp.linspace(-29.9 * begin, -left + 0.9e-9, 21)
    way = slope(contact, unloading, memory)
    np.testing.assert_allclose(-way, force(unloading, memory), atol=1e-9 * scale)
    # The parts add up, and nothing is felt out of reach.
    for d, before in ((-3.0 * begin, contact.initial_memory()), (-15.0 * begin, memory)):
        state = contact.state(d, before)
        assert state.parts.shape == (len(contact.components),)
        assert state.bonds.shape == (len(contact.mechanisms),)
        assert float(jnp.sum(state.parts)) == pytest.approx(float(state.force), rel=1e-12)
    out = contact.state(1.01 * contact.interaction_range, contact.initial_memory())
    assert float(out.force) == float(out.stored) == 0.0
    np.testing.assert_array_equal(out.bonds, 0.0)


def test_branches_are_the_first_approach_and_then_every_combination_of_bonds():
    contact = SmoothPlasticContact(ADHESIVE, meniscus())
    assert len(contact.branches()) == 1
    pressed = contact.update_memory(contact.initial_memory(), jnp.asarray(-1e-7))
    worn = contact.after(contact.left_by(pressed, jnp.asarray(-1e-7)))
    assert len(worn.branches()) == 4
    assert int(worn.branch_of(worn.initial_memory(), jnp.asarray(False))) == 0
    for k, memory in enumerate(worn.branches()):
        assert int(worn.branch_of(memory, jnp.asarray(True))) == 1 + k
        assert float(memory[0]) == -1e-7
    assert int(worn.branch_of(pressed, jnp.asarray(True))) == 4
    apart = worn.update_memory(pressed, jnp.asarray(1e-6))
    assert int(worn.branch_of(apart, jnp.asarray(False))) == 1


def test_a_law_that_would_count_a_force_twice_is_refused():
    with pytest.raises(InputError, match="elastic"):
        SmoothPlasticContact(SPHERE, Jkr(RADIUS, MODULUS, 0.05))
    with pytest.raises(InputError, match="adhesion"):
        SmoothPlasticContact(ADHESIVE, Dmt(RADIUS, 0.05))


def test_a_tip_pressed_flat_that_pulls_by_more_than_it_presses_rests_where_it_turned():
    """DMT's pull grows by the tip's flatness as soon as the bodies would part."""
    soft = SmoothPlasticContact(ThorntonNing(RADIUS, MODULUS, 5e6), beside(tension=0.0))
    rows, restitution, end = integrate(soft, np.linspace(0.02, 0.07, SPEEDS.size), EARTH)
    assert {ENDS[int(outcome)] for outcome in end.outcome} == {Outcome.REST}
    np.testing.assert_array_equal(end.made, 1)
    np.testing.assert_array_equal(rows.apex[:, 0], rows.closest_approach[:, 0])
    np.testing.assert_array_equal(restitution[:, 0], 0.0)
