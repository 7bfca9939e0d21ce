"""Asperities that yield: loading, unloading and what is lost between them."""

from itertools import product
from math import pi

import numpy as np
import pytest

from asperity._jax import jax, jnp
from asperity.laws import Hertz
from asperity.laws.plastic import JacksonGreen, KogutEtsion, ThorntonNing

R, E, Y, NU = 1e-6, 1e11, 1e9, 0.3  # m, Pa, Pa
ROUNDING = 1e-13


def laws(length=1.0, pressure=1.0):
    r, e, y = R * length, E * pressure, Y * pressure
    return {
        "Kogut-Etsion": KogutEtsion(r, e, 2.8 * y, NU),
        "Jackson-Green": JacksonGreen(r, e, y, NU),
        "Jackson-Green, poisson 0": JacksonGreen(r, e, y, 0.0),
        "Thornton-Ning": ThorntonNing(r, e, 1.6 * y),
    }


LAWS = laws()
JACKSON_GREEN_BY_HAND = [2.0259 + 0.8031, 16.4667 + 9.2945, 182.094 + 230.781]  # x = 2, 10, 100
every_law = pytest.mark.parametrize("law", LAWS.values(), ids=LAWS)


def overlaps(law, low=1e-3, high=1e3, count=241):
    """Overlaps over decades, away from the kinks."""
    at = np.geomspace(low, high, count) * float(law.yield_overlap)
    clear = [np.abs(at / float(kink) - 1.0) > 1e-6 for kink in law.kinks]
    return jnp.asarray(at[np.all(clear, axis=0)])


def beyond_yield(law, count=200):
    return law.yield_overlap * (1.0 + jnp.geomspace(1e-4, 1e4, count))


def slope_of(energy, places):
    return jax.jvp(energy, (places,), (jnp.ones_like(places),))[1]


@every_law
def test_below_yield_the_contact_is_hertz_and_loses_nothing(law):
    overlap = jnp.linspace(0.0, 1.0, 21) * law.yield_overlap
    hertz = Hertz(R, E)
    np.testing.assert_allclose(law.loading_force(overlap), hertz.force(-overlap), rtol=ROUNDING)
    np.testing.assert_allclose(law.loading_work(overlap), hertz.energy(-overlap), rtol=ROUNDING)
    for deepest in (overlap, jnp.full_like(overlap, law.yield_overlap)):
        np.testing.assert_allclose(
            law.force(overlap, deepest), hertz.force(-overlap), rtol=ROUNDING
        )
        np.testing.assert_allclose(
            law.recoverable(overlap, deepest), hertz.energy(-overlap), rtol=ROUNDING
        )
    assert np.all(law.dissipated(overlap) == 0.0)
    assert np.all(law.residual(overlap) == 0.0)
    assert np.all(law.exponent(overlap) == 1.5)


@every_law
def test_loading_is_continuous_at_every_kink(law):
    kinks = [float(kink) for kink in law.kinks]
    assert kinks[0] == float(law.yield_overlap)
    assert kinks == sorted(kinks)
    for kink in kinks:
        sides = jnp.asarray([kink * (1.0 - 1e-12), kink * (1.0 + 1e-12)])
        for branch in (law.loading_force, law.loading_work, law.residual, law.exponent):
            below, above = branch(sides)
            assert float(above) == pytest.approx(float(below), rel=1e-10, abs=1e-20)


@every_law
def test_force_is_the_slope_of_the_work_of_loading(law):
    overlap = overlaps(law)
    np.testing.assert_allclose(
        slope_of(law.loading_work, overlap), law.loading_force(overlap), rtol=1e-9
    )


@every_law
def test_force_is_the_slope_of_the_recoverable_energy(law):
    for deepest in law.yield_overlap * np.array([0.4, 1.5, 8.0, 90.0, 5e3]):
        overlap = jnp.linspace(1e-3, 1.0, 200) * deepest
        slope = slope_of(lambda at, deepest=deepest: law.recoverable(at, deepest), overlap)
        scale = float(law.loading_force(deepest))
        np.testing.assert_allclose(
            slope, law.force(overlap, deepest), rtol=1e-11, atol=1e-14 * scale
        )


@every_law
def test_unloading_meets_loading_and_ends_at_what_is_left_in_the_order_of_heights(law):
    deepest = overlaps(law)
    force, loading = law.force(deepest, deepest), law.loading_force(deepest)
    np.testing.assert_allclose(force, loading, rtol=ROUNDING)
    deepest = beyond_yield(law)
    left, rate = law.residual(deepest), np.asarray(slope_of(law.residual, deepest))
    assert np.all((left > 0.0) & (left < deepest))
    assert np.all((rate > 0.0) & (rate < 1.0))
    for share in (0.0, 0.5, 1.0):
        assert np.all(law.force(share * left, deepest) == 0.0)
        assert np.all(law.recoverable(share * left, deepest) == 0.0)
    assert np.all(law.force(left + 1e-3 * (deepest - left), deepest) > 0.0)


@every_law
def test_loss_is_never_negative_and_grows_with_the_deepest_overlap(law):
    deepest = beyond_yield(law)
    lost = np.asarray(law.dissipated(deepest))
    assert np.all(lost > 0.0)
    assert np.all(np.diff(lost) > 0.0)
    np.testing.assert_allclose(
        lost, law.loading_work(deepest) - law.recoverable(deepest, deepest), rtol=1e-10
    )
    assert lost[-1] > 0.9 * float(law.loading_work(deepest[-1]))


@pytest.mark.parametrize("make", [JacksonGreen, KogutEtsion])
def test_no_material_gives_energy_back(make):
    for strain, poisson in product((1e-5, 1e-3, 1e-2, 5e-2), (0.0, 0.1, 0.2, 0.3, 0.4, 0.5)):
        law = make(R, E, strain * E, poisson)
        lost = np.asarray(law.dissipated(beyond_yield(law, 60)))
        assert np.all(lost > 0.0)
        assert np.all(np.diff(lost) > 0.0)


@every_law
def test_derivatives_are_finite_where_nothing_touches_yet(law):
    places = jnp.repeat(jnp.asarray([0.0, -1e-9]), 3)
    deepest = jnp.tile(law.yield_overlap * jnp.asarray([0.0, 1.0, 50.0]), 2)
    touched = law.yield_overlap * jnp.asarray([0.0, 0.5, 20.0])

    def of_depth(depth):
        first = law.loading_force(depth), law.loading_work(depth), law.dissipated(depth)
        return jnp.stack([*first, law.residual(depth), law.exponent(depth)])

    @jax.jit
    def slopes(law):
        free = (jax.value_and_grad(curve, (0, 1)) for curve in (law.force, law.recoverable))
        by_values = jax.grad(lambda law, at: law.dissipated(at) + law.force(at / 2, at))
        zeros = [jax.vmap(curve)(places, deepest) for curve in free]
        return zeros, (jax.jacfwd(of_depth)(0.0), jax.vmap(by_values, (None, 0))(law, touched))

    zeros, finite = slopes(law)
    assert all(np.all(np.asarray(leaf) == 0.0) for leaf in jax.tree.leaves(zeros))
    assert all(np.all(np.isfinite(leaf)) for leaf in jax.tree.leaves(finite))


@every_law
def test_force_and_loss_do_not_depend_on_the_units(law):
    name = next(key for key, value in LAWS.items() if value is law)
    length, pressure = 1e9, 3.7e-9
    scaled = laws(length, pressure)[name]
    deepest = overlaps(law, count=61)
    here = (0.7 * deepest, deepest)
    there = tuple(length * at for at in here)
    force, energy = pressure * length**2, pressure * length**3
    np.testing.assert_allclose(scaled.force(*there), force * law.force(*here), rtol=1e-10)
    np.testing.assert_allclose(
        scaled.recoverable(*there), energy * law.recoverable(*here), rtol=1e-10
    )
    np.testing.assert_allclose(
        scaled.dissipated(there[1]), energy * law.dissipated(deepest), rtol=1e-8
    )
    np.testing.assert_allclose(
        scaled.residual(there[1]), length * law.residual(deepest), rtol=1e-10
    )


def test_kogut_etsion_has_the_values_worked_by_hand():
    """K = 0.577, d = 8.2147e-11 m and force 9.9272e-8 N there; 1.03 x^1.425 and 1.40 x^1.263."""
    law = KogutEtsion(1e-6, 1e11, 1e9, 0.3)
    critical = law.yield_overlap
    assert float(law.pressure_coefficient) == pytest.approx(0.577, rel=1e-12)
    assert float(critical) == pytest.approx(8.2147e-11, rel=1e-4)
    assert float(law.loading_force(critical)) == pytest.approx(9.9272e-8, rel=1e-4)
    reduced = law.published_force(jnp.asarray([2.0, 10.0, 100.0]) * critical)
    np.testing.assert_allclose(
        reduced / law.loading_force(critical), [2.7657, 25.652, 470.03], rtol=5e-5
    )
    reduced = law.loading_force(jnp.asarray([2.0, 10.0, 100.0]) * critical)
    np.testing.assert_allclose(
        reduced / law.loading_force(critical), [2.7336, 25.652, 470.03], rtol=5e-5
    )


def test_kogut_etsion_departs_by_three_percent_where_the_published_constants_jump():
    law = LAWS["Kogut-Etsion"]
    at = law.yield_overlap * jnp.asarray([1.0, 6.0])
    jumps = law.published_force(at * (1 + 1e-12)) / law.published_force(at * (1 - 1e-12)) - 1.0
    np.testing.assert_allclose(jumps, [0.0300, 0.0168], atol=5e-5)
    overlap = law.yield_overlap * jnp.linspace(0.01, 200.0, 20_000)
    departure = np.asarray(law.loading_force(overlap) / law.published_force(overlap)) - 1.0
    between = np.asarray((overlap > law.yield_overlap) & (overlap <= 6.0 * law.yield_overlap))
    assert np.all(departure[~between] == 0.0)
    assert np.max(np.abs(departure)) < 0.0300
    assert departure[between][0] == pytest.approx(-0.029, abs=1e-3)
    assert departure[between][-1] == pytest.approx(0.0168, abs=1e-4)


@pytest.mark.parametrize(("poisson", "share"), [(0.0, 0.729), (0.3, 0.927), (0.5, 1.059)])
def test_kogut_etsion_beyond_its_range_compared_with_hardness_times_truncated_area(poisson, share):
    law = KogutEtsion(R, E, Y, poisson)
    overlap = law.yield_overlap * jnp.asarray([110.0, 1e3, 1e5])
    np.testing.assert_allclose(
        law.loading_force(overlap) / (2.0 * pi * R * overlap * Y), share, atol=5e-4
    )


def test_etsion_unloading_has_the_values_worked_by_hand():
    """At 32 times the overlap of yield, x^-0.28 = 0.378929 and x^-0.69 = 0.091505."""
    for law in (LAWS["Kogut-Etsion"], LAWS["Jackson-Green"]):
        deepest = 32.0 * law.yield_overlap
        assert float(law.residual(deepest) / deepest) == pytest.approx(
            0.621071 * 0.908495, rel=1e-5
        )
        assert float(law.exponent(deepest)) == pytest.approx(1.33743, rel=1e-5)


def test_jackson_green_has_the_values_worked_by_hand():
    """C = 1.614961, B = 0.176204; at x = 10 H/S = 2.80255 and 16.4667 + 9.2945."""
    law = LAWS["Jackson-Green"]
    critical = law.critical_overlap
    assert float(law.yield_coefficient) == pytest.approx(1.614961, rel=1e-6)
    assert float(critical) == pytest.approx(6.43522e-10, rel=1e-5)
    one = float(law.loading_force(critical))
    assert one == pytest.approx(4.0 / 3.0 * 1e8 * (6.43522e-10) ** 1.5, rel=1e-5)
    reduced = law.published_force(jnp.asarray([2.0, 10.0, 100.0]) * critical) / one
    np.testing.assert_allclose(reduced, JACKSON_GREEN_BY_HAND, rtol=3e-5)
    reduced = law.loading_force(jnp.asarray([10.0, 100.0]) * critical) / one
    np.testing.assert_allclose(reduced, JACKSON_GREEN_BY_HAND[1:], rtol=1e-5)


@pytest.mark.parametrize(
    ("poisson", "jump", "meeting"),
    [(0.0, 0.0748, 4.126), (0.3, 0.0047, 2.004), (0.5, -0.0342, 1.257)],
)
def test_jackson_green_departs_only_between_its_jump_and_where_fit_and_hertz_meet(
    poisson, jump, meeting
):
    law = JacksonGreen(R, E, Y, poisson)
    at = 1.9 * law.critical_overlap * jnp.asarray([1 - 1e-12, 1 + 1e-12])
    below, above = law.published_force(at)
    assert float(above / below - 1.0) == pytest.approx(jump, abs=5e-5)
    assert float(law.yield_overlap / law.critical_overlap) == pytest.approx(meeting, abs=5e-4)
    x = np.linspace(0.01, 50.0, 5000)
    overlap = jnp.asarray(x) * law.critical_overlap
    departure = np.asarray(law.loading_force(overlap) / law.published_force(overlap)) - 1.0
    between = (x > min(1.9, meeting - 1e-3)) & (x < max(1.9, meeting + 1e-3))
    assert np.max(np.abs(departure[~between])) < 1e-14
    assert np.max(np.abs(departure)) < abs(jump) + 1e-3


def test_where_jackson_green_yields_has_the_right_derivative():
    def yields(poisson):
        return JacksonGreen(R, E, Y, poisson).yield_overlap

    step = 1e-4
    by_steps = float(yields(0.3 + step) - yields(0.3 - step)) / (2.0 * step)
    assert float(jax.grad(yields)(0.3)) == pytest.approx(by_steps, rel=1e-6)


@pytest.mark.parametrize("poisson", [0.0, 0.3, 0.5])
@pytest.mark.parametrize("strain", [1e-4, 1e-2])
def test_work_of_jackson_green_is_the_integral_of_its_force(poisson, strain):
    law = JacksonGreen(R, E, strain * E, poisson)
    nodes, weights = np.polynomial.legendre.leggauss(20)
    for x in (1.01, 2.0, 30.0, 1e3, 1e5):
        edges = np.geomspace(1.0, x, 201)
        half = np.diff(edges)[:, None] / 2.0
        at = edges[:-1, None] + half * (1.0 + nodes)
        force = np.asarray(law.loading_force(at * law.yield_overlap))
        beyond = float(law.yield_overlap) * np.sum(half * force * weights)
        work = float(law.loading_work(law.yield_overlap)) + beyond
        assert float(law.loading_work(x * law.yield_overlap)) == pytest.approx(work, rel=1e-10)


def test_thornton_ning_yields_where_hertz_pressure_reaches_the_yield_pressure():
    law = LAWS["Thornton-Ning"]
    contact_radius = float(jnp.sqrt(R * law.yield_overlap))
    assert 2.0 * E * contact_radius / (pi * R) == pytest.approx(1.6 * Y, rel=1e-12)
    force = float(law.loading_force(law.yield_overlap))
    assert force == pytest.approx(pi**3 * (1.6 * Y) ** 3 * R**2 / (6.0 * E**2), rel=1e-12)
    slopes = slope_of(law.loading_force, law.yield_overlap * jnp.asarray([1 - 1e-9, 1 + 1e-9, 40]))
    np.testing.assert_allclose(slopes, pi * 1.6 * Y * R, rtol=1e-8)


def test_thornton_ning_unloads_as_hertz_with_the_flattened_radius():
    law = LAWS["Thornton-Ning"]
    deepest = beyond_yield(law)
    force, first = law.loading_force(deepest), law.loading_force(law.yield_overlap)
    radius = 4 * E / (3 * force) * ((2 * force + first) / (2 * pi * 1.6 * Y)) ** 1.5
    residual = deepest - (3.0 * force / (4.0 * E * jnp.sqrt(radius))) ** (2.0 / 3.0)
    np.testing.assert_allclose(
        law.residual(deepest), residual, rtol=1e-10, atol=1e-14 * float(deepest[0])
    )
    at = 0.5 * (deepest + residual)
    np.testing.assert_allclose(
        law.force(at, deepest), 4 / 3 * E * jnp.sqrt(radius) * (at - residual) ** 1.5, rtol=1e-10
    )


def impacts(law, ratios):
    """Deepest overlaps of impacts at these speeds over that at which yield begins."""
    energies = law.loading_work(law.yield_overlap) * ratios**2
    deepest = law.yield_overlap * ratios
    for _ in range(60):
        deepest = deepest - (law.loading_work(deepest) - energies) / law.loading_force(deepest)
    return deepest


def test_thornton_ning_rebounds_as_in_closed_form():
    """Restitution by speed, Thornton and Ning (1998); yield at 3.194 sqrt(p^5 R^3/(E*^4 m))."""
    law, mass = LAWS["Thornton-Ning"], 3e-14
    slowest = float(jnp.sqrt(2.0 * law.loading_work(law.yield_overlap) / mass))
    published = 3.194 * float(np.sqrt((1.6 * Y) ** 5 * R**3 / (E**4 * mass)))
    assert slowest == pytest.approx(published, rel=1e-4)
    ratio = jnp.geomspace(1.0, 1e3, 61)
    deepest = impacts(law, ratio)
    measured = jnp.sqrt(law.recoverable(deepest, deepest) / law.loading_work(deepest))
    u = 1.0 / ratio
    closed = jnp.sqrt(6.0 * np.sqrt(3.0) / 5.0 * (1.0 - u**2 / 6.0))
    closed = closed * (u / (u + 2.0 * jnp.sqrt(6.0 / 5.0 - u**2 / 5.0))) ** 0.25
    np.testing.assert_allclose(measured, closed, rtol=1e-12)
    slope = np.diff(np.log(measured))[-1] / np.diff(np.log(ratio))[-1]
    assert slope == pytest.approx(-0.25, abs=2e-4)
