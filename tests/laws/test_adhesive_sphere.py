"""The adhesive sphere that yields: branches, losses, limits, and when it sticks."""

from math import pi

import equinox as eqx
import numpy as np
import pytest

from asperity._jax import jax, jnp
from asperity.laws.jkr import Jkr
from asperity.laws.plastic.adhesive_sphere import AdhesiveThorntonNing

R, E, W = 2.5e-6, 1.3e9, 0.05  # m, Pa, J/m^2
HARD = AdhesiveThorntonNing(R, E, W, 100e6)  # yields under load
SOFT = AdhesiveThorntonNing(2.45e-6, E, 0.2, 35.3e6)  # yields while its adhesion still pulls
both = pytest.mark.parametrize("sphere", [HARD, SOFT], ids=["hard", "soft"])


def beyond(sphere):
    return sphere.yield_overlap * jnp.geomspace(1.001, 200.0, 60)


def breaking_gap(sphere, deepest):
    """Gap at which the bond of the flattened tip breaks."""
    return sphere.tip(deepest).breaking_gap - sphere.residual(deepest)


def slopes_of(function):
    """Its derivative at many places: one compiled program."""
    return jax.jit(jax.vmap(jax.grad(function)))


@both
def test_the_central_pressure_is_the_yield_pressure_at_yield(sphere):
    r, e, w = sphere.radius, sphere.modulus, sphere.work
    a = Jkr(r, e, w).contact_radius(-sphere.yield_overlap)
    pressure = 2.0 * e * a / (pi * r) - jnp.sqrt(2.0 * w * e / (pi * a))
    assert float(pressure) == pytest.approx(float(sphere.yield_pressure), rel=1e-12)


@both
def test_it_is_jkr_below_yield(sphere):
    elastic = Jkr(sphere.radius, sphere.modulus, sphere.work)
    deepest = sphere.yield_overlap * jnp.asarray([0.0, 0.3, 0.99])
    np.testing.assert_allclose(sphere.loading_force(deepest), elastic.bonded_force(-deepest))
    np.testing.assert_allclose(sphere.loading_energy(deepest), elastic.bonded_energy(-deepest))
    gap = -0.5 * deepest
    np.testing.assert_allclose(sphere.force(gap, deepest), elastic.bonded_force(gap))
    np.testing.assert_array_equal(sphere.tip_radius(deepest), sphere.radius)
    for zero in (sphere.residual, sphere.dissipated):
        np.testing.assert_array_equal(zero(deepest), 0.0)
    touch = -8.0 / 9.0 * 1.5 * pi * sphere.work * sphere.radius
    assert float(sphere.loading_force(jnp.zeros(()))) == pytest.approx(float(touch), rel=1e-12)


@both
def test_the_loading_force_is_the_integral_of_the_truncated_pressure(sphere):
    r, e, w, cap = sphere.radius, sphere.modulus, sphere.work, sphere.yield_pressure
    overlap = 5.0 * sphere.yield_overlap
    a = Jkr(r, e, w).contact_radius(-overlap)
    s = (np.arange(100000) + 0.5) / 100000  # sqrt(1 - (radius/a)^2)
    pressure = 2.0 * e * a / (pi * r) * s - jnp.sqrt(2.0 * w * e / (pi * a)) / s
    total = 2.0 * pi * a**2 * jnp.mean(jnp.minimum(pressure, cap) * s)
    assert float(sphere.loading_force(overlap)) == pytest.approx(float(total), rel=1e-7)


@both
def test_force_and_stiffness_are_smooth_at_yield(sphere):
    at = sphere.yield_overlap * jnp.asarray([1.0 - 1e-9, 1.0 + 1e-9])
    for quantity in (sphere.loading_force, slopes_of(sphere.loading_force)):
        before, after = quantity(at)
        assert float(after) == pytest.approx(float(before), rel=1e-6)


@both
def test_force_and_contact_radius_are_continuous_at_the_turn(sphere):
    deepest = beyond(sphere)
    np.testing.assert_allclose(
        sphere.force(-deepest, deepest),
        sphere.loading_force(deepest),
        rtol=1e-9,
        atol=1e-11 * float(sphere.radius * sphere.work),
    )
    tip, shift = sphere.tip_radius(deepest), sphere.residual(deepest)
    loaded = Jkr(sphere.radius, sphere.modulus, sphere.work).contact_radius(-deepest)
    turned = Jkr(tip, sphere.modulus, sphere.work).contact_radius(-deepest + shift)
    np.testing.assert_allclose(turned, loaded, rtol=1e-12)
    assert np.all(np.diff(tip) > 0.0)
    assert np.all(np.diff(shift) > 0.0)
    close = sphere.yield_overlap * (1.0 + 1e-6)
    assert float(sphere.tip_radius(close)) == pytest.approx(float(sphere.radius), rel=1e-9)
    assert 0.0 <= float(sphere.residual(close)) < 1e-9 * float(sphere.yield_overlap)


@both
def test_forces_are_slopes_of_their_energies(sphere):
    overlap = sphere.yield_overlap * jnp.asarray([0.2, 0.9, 1.1, 3.0, 50.0])
    slope = slopes_of(sphere.loading_energy)(overlap)
    np.testing.assert_allclose(slope, sphere.loading_force(overlap), rtol=1e-10)
    deepest = 20.0 * sphere.yield_overlap
    breaking = breaking_gap(sphere, deepest)
    gap = jnp.linspace(-deepest, breaking - 1e-3 * (breaking + deepest), 30)
    slope = slopes_of(lambda g: sphere.energy(g, deepest))(gap)
    scale = float(jnp.max(jnp.abs(slope)))
    np.testing.assert_allclose(-slope, sphere.force(gap, deepest), rtol=1e-9, atol=1e-11 * scale)


@both
def test_values_and_slopes_are_finite_at_once_and_under_transformations(sphere):
    deepest = jnp.concatenate([jnp.asarray([0.0]), sphere.yield_overlap * jnp.asarray([0.5, 1.0])])
    deepest = jnp.concatenate([deepest, beyond(sphere)]).reshape(9, 7)

    @eqx.filter_jit
    def every(sphere, deepest):
        """All of them at one depth or many."""
        names = ("loading_force", "loading_energy", "tip_radius", "residual", "dissipated")
        return [getattr(sphere, name)(deepest) for name in names]

    at_once = every(sphere, deepest)
    one_by_one = jax.vmap(jax.vmap(lambda depth: every(sphere, depth)))(deepest)
    for ours, theirs in zip(at_once, one_by_one, strict=True):
        # just beyond yield two of them are the rounding of what they are the difference of
        floor = 1e-14 * float(jnp.max(jnp.abs(ours)))
        np.testing.assert_allclose(theirs, ours, rtol=1e-9, atol=floor)
    ones = jax.tree.map(jnp.ones_like, (sphere, deepest))
    _, slopes = eqx.filter_jvp(every, (sphere, deepest), ones)
    assert all(np.all(np.isfinite(slope)) for slope in slopes)


def test_plastic_flow_takes_more_energy_the_deeper():
    taken = HARD.dissipated(beyond(HARD))
    assert float(HARD.loading_force(HARD.yield_overlap)) > 0.0
    assert np.all(taken > 0.0)
    assert np.all(np.diff(taken) > 0.0)


def test_a_yield_helped_by_adhesion_takes_hardly_negative_energy_first():
    deepest = SOFT.yield_overlap * jnp.geomspace(1.001, 200.0, 400)
    taken = SOFT.dissipated(deepest)
    assert float(SOFT.loading_force(SOFT.yield_overlap)) < 0.0
    lowest = int(np.argmin(taken))
    assert np.all(np.diff(taken[lowest:]) > 0.0)
    assert -0.01 * float(SOFT.tip(jnp.zeros(())).formation_loss) < float(taken[lowest]) < 0.0


@both
def test_a_flattened_tip_breaks_at_its_own_pull_off(sphere):
    deepest = 10.0 * sphere.yield_overlap
    tip, breaking = sphere.tip_radius(deepest), breaking_gap(sphere, deepest)
    gap = jnp.linspace(-deepest, breaking, 20001)
    pull = jnp.min(sphere.force(gap, deepest))
    assert float(pull) == pytest.approx(float(-1.5 * pi * sphere.work * tip), rel=1e-6)
    last = float(sphere.force(breaking, deepest))
    assert last == pytest.approx(float(-5.0 / 6.0 * pi * sphere.work * tip), rel=1e-6)
    touch = float(sphere.force(-sphere.residual(deepest), deepest))
    assert touch == pytest.approx(float(-4.0 / 3.0 * pi * sphere.work * tip), rel=1e-9)
    assert float(sphere.tip(deepest).rupture_loss) == pytest.approx(
        float(sphere.energy(breaking, deepest)), rel=1e-9
    )
    assert float(-sphere.residual(deepest)) < float(breaking)


def test_without_adhesion_it_is_the_linear_plastic_sphere():
    cap = 100e6
    dry = AdhesiveThorntonNing(R, E, 1e-14, cap)
    at_yield = R * (pi * cap / (2.0 * E)) ** 2
    force_at_yield = 4.0 / 3.0 * E * np.sqrt(R) * at_yield**1.5
    assert float(dry.yield_overlap) == pytest.approx(at_yield, rel=1e-5)
    deepest = at_yield * np.geomspace(1.1, 100.0, 20)
    force = force_at_yield + pi * cap * R * (deepest - at_yield)
    tip = 4.0 * E / (3.0 * force) * ((2.0 * force + force_at_yield) / (2.0 * pi * cap)) ** 1.5
    np.testing.assert_allclose(dry.loading_force(jnp.asarray(deepest)), force, rtol=1e-5)
    np.testing.assert_allclose(dry.tip_radius(jnp.asarray(deepest)), tip, rtol=1e-5)
    left = deepest - (3.0 * force / (4.0 * E * np.sqrt(tip))) ** (2.0 / 3.0)
    np.testing.assert_allclose(dry.residual(jnp.asarray(deepest)), left, rtol=1e-4)
    depth = deepest - at_yield
    work = 0.4 * force_at_yield * at_yield + force_at_yield * depth + pi * cap * R * depth**2 / 2
    taken = work - 0.4 * force * (deepest - left)
    np.testing.assert_allclose(dry.dissipated(jnp.asarray(deepest)), taken, rtol=1e-3)


@both
def test_what_it_does_is_independent_of_units(sphere):
    length, pressure = 1e6, 1e-6
    other = AdhesiveThorntonNing(
        sphere.radius * length,
        sphere.modulus * pressure,
        sphere.work * pressure * length,
        sphere.yield_pressure * pressure,
    )
    deepest = 7.0 * sphere.yield_overlap
    there = other.dissipated(deepest * length) / (pressure * length**3)
    assert float(there) == pytest.approx(float(sphere.dissipated(deepest)), rel=1e-9)


@eqx.filter_jit
def impact(sphere, mass, deepest):
    """Speed of an impact that reaches a depth, and the kinetic energy left of it."""
    formation = sphere.tip(jnp.zeros(())).formation_loss
    kinetic = sphere.loading_energy(deepest) + formation
    left = kinetic - formation - sphere.dissipated(deepest) - sphere.tip(deepest).rupture_loss
    return jnp.sqrt(2.0 * kinetic / mass), left


def sticking_speed(sphere, mass, shallow, deep):
    """Speed at which nothing is left [m/s], by bisection over the deepest overlap [m]."""
    shallow, deep = jnp.asarray(shallow), jnp.asarray(deep)
    for _ in range(60):
        middle = 0.5 * (shallow + deep)
        _, left = impact(sphere, mass, middle)
        shallow, deep = (middle, deep) if left < 0.0 else (shallow, middle)
    return float(impact(sphere, mass, deep)[0])


def test_losses_of_an_impact_are_the_work_of_its_forces():
    deepest = 8.0 * HARD.yield_overlap
    nodes, weights = np.polynomial.legendre.leggauss(60)

    def integral(function, start, end):
        at = start + 0.5 * (end - start) * (1.0 + nodes)
        return float(jnp.sum(0.5 * (end - start) * weights * function(at)))

    at_yield, breaking = HARD.yield_overlap, breaking_gap(HARD, deepest)
    spent = integral(HARD.loading_force, 0.0, at_yield)
    spent += integral(HARD.loading_force, at_yield, deepest)
    # the force ends like the root of the gap left to the fold
    gained = integral(
        lambda z: 2.0 * z * HARD.force(breaking - z**2, deepest), 0.0, jnp.sqrt(breaking + deepest)
    )
    losses = (
        HARD.tip(jnp.zeros(())).formation_loss
        + HARD.dissipated(deepest)
        + HARD.tip(deepest).rupture_loss
    )
    assert float(losses) == pytest.approx(spent - gained, rel=1e-6)


def test_an_ammonium_fluorescein_sphere_that_yields_sticks_at_higher_speeds():
    """4.9 um on silicon, in vacuum, w = 0.2 J/m^2, p_y = 35.3 MPa.

    The published curve of the model ends near 1.6 m/s (read from a figure). The tolerance is
    wide because the speed is steep in the pressure: 5 % less of it gives 1.59 m/s.
    """
    modulus = 1.0 / ((1.0 - 0.3**2) / 1.2e9 + (1.0 - 0.3**2) / 182e9)
    sphere = AdhesiveThorntonNing(2.45e-6, modulus, 0.2, 35.3e6)
    mass = 1350.0 * 4.0 / 3.0 * pi * float(sphere.radius) ** 3
    at_yield = float(sphere.yield_overlap)
    speed = sticking_speed(sphere, mass, 2.0 * at_yield, 100.0 * at_yield)
    assert speed == pytest.approx(1.458, rel=1e-3)  # an independent quadrature of the same force
    assert speed == pytest.approx(1.6, rel=0.1)
    weaker = eqx.tree_at(lambda s: s.yield_pressure, sphere, 0.95 * sphere.yield_pressure)
    assert sticking_speed(weaker, mass, 2.0 * at_yield, 100.0 * at_yield) > 1.57
