"""Measured heights: means over a narrow kernel against the sums over the summits themselves."""

from itertools import pairwise
from math import pi, radians

import equinox as eqx
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from asperity._jax import jax, jnp
from asperity.interface.interface import Interface
from asperity.laws import Bradley, Dmt, Hertz, Meniscus
from asperity.surfaces.heights import Sampled, Spread, spread_of

RADIUS, E, W, SIGMA = 2.5e-7, 5e9, 0.05, 4e-9
HERTZ, DMT = Hertz(RADIUS, E), Dmt(RADIUS, W)
COUNT = 2000
_RANDOM = np.random.default_rng(11)
HEIGHTS = SIGMA * (_RANDOM.gamma(6.0, size=COUNT) - 6.0) / np.sqrt(6.0)
RADII = RADIUS * np.exp(0.4 * _RANDOM.standard_normal(COUNT) - 0.02 * HEIGHTS / SIGMA)
H = np.linspace(-12.0, 5.0, 69) * SIGMA


@eqx.filter_jit
def measured(sampled, separations, integrated):
    """Parts, energy and contacting of Hertz + DMT; one compilation a lift and a number of nodes."""
    return Interface(HERTZ + DMT, sampled, 1.0).measure(separations, (), integrated)


def sums(heights, radii, separations, integrated):
    """Means over the summits one by one: elastic, adhesion, energy, contacting, four rows."""
    overlap = np.maximum(np.asarray(heights) - np.asarray(separations)[:, None], 0.0)
    stiffness, pull = 4.0 / 3.0 * E * np.sqrt(radii), -2.0 * pi * radii * W
    deep = overlap > 0.0
    if integrated == 0:
        elastic, adhesion, contacting = stiffness * overlap**1.5, pull * deep, deep
        energy = stiffness * overlap**2.5 / 2.5 + pull * overlap
    else:
        elastic, adhesion, contacting = stiffness * overlap**2.5 / 2.5, pull * overlap, overlap
        energy = stiffness * overlap**3.5 / 2.5 / 3.5 + pull * overlap**2 / 2.0
    return np.stack([np.mean(rows, axis=1) for rows in (elastic, adhesion, energy, contacting)])


def found(sampled, separations, integrated):
    """The same four rows of the means; always of as many separations, for one compilation."""
    count = len(separations)
    padded = np.append(separations, np.full(H.size - count, separations[-1]))
    means = measured(sampled, jnp.asarray(padded), integrated)
    rows = [*means.parts, means.energy, means.contacting]
    return np.stack([np.asarray(row)[:count] for row in rows])


def finer(heights, factor):
    """The default nodes, and those of steps shorter by a factor."""
    coarse = spread_of(heights)
    low, high = heights.min(), heights.max()
    step = coarse.step / factor
    return Spread(low - 4.0 * step, step, int(np.ceil((high - low) / step)) + 9)


@pytest.fixture(scope="module")
def sampled():
    return Sampled(HEIGHTS, RADII, RADIUS)


@pytest.mark.parametrize("integrated", [0, 1])
def test_deep_in_the_means_are_the_sums_over_all_summits(sampled, integrated):
    """All touch: weights with powers 0, 1/2 and 1 of the radius, to 1e-4 from 4 rms below."""
    deep = H[HEIGHTS.min() - 4.0 * SIGMA > H]
    assert deep.size > 20
    exact = sums(HEIGHTS, RADII, deep, integrated)
    np.testing.assert_allclose(found(sampled, deep, integrated), exact, rtol=1e-4)


def test_count_and_mean_height_are_exact_where_all_touch(sampled):
    """The kernels keep them: the number that touch, and their mean overlap."""
    deep = H[H + 8.0 * float(sampled.step) < HEIGHTS.min()]
    for integrated in (0, 1):
        exact = sums(HEIGHTS, RADII, deep, integrated)[3]
        np.testing.assert_allclose(found(sampled, deep, integrated)[3], exact, rtol=1e-13)


@pytest.mark.parametrize("integrated", [0, 1])
def test_the_kernel_moves_the_means_by_less_than_the_choice_of_the_summits(sampled, integrated):
    """Down to where ten touch: a twentieth of the sampling error; counts by it and one summit."""
    places = H[np.array([np.count_nonzero(h < HEIGHTS) >= 10 for h in H])]
    pairs = zip(HEIGHTS, RADII, strict=True)
    each = np.stack([sums(np.array([z]), np.array([r]), places, integrated) for z, r in pairs])
    mean = each.mean(axis=0)
    error = each.std(axis=0) / np.sqrt(COUNT)
    share = np.full((4, 1), 0.05) if integrated else np.array([[0.05], [1.0], [0.05], [1.0]])
    one = np.max(abs(each), axis=0) / COUNT * (share == 1.0)
    off = abs(found(sampled, places, integrated) - mean)
    assert np.max(off - share * error - one - 1e-12 * abs(mean)) <= 0.0


@pytest.mark.parametrize("integrated", [0, 1])
def test_no_mean_leaves_those_of_heights_moved_by_the_width_of_the_kernel(sampled, integrated):
    """A bound at the top too, where a few summits touch: each is spread by at most four steps."""
    step = float(sampled.step)
    drawn = 1.0 - np.sqrt(1.0 - 2.0 / 3.0 * (step / HEIGHTS.std()) ** 2)
    moved = 4.0 * step + drawn * np.max(abs(HEIGHTS - HEIGHTS.mean()))
    sign = np.array([1.0, -1.0, 1.0])[:, None]
    rows = [0, 1, 3]
    ours = sign * found(sampled, H, integrated)[rows]
    least = sign * sums(HEIGHTS, RADII, H + moved, integrated)[rows]
    most = sign * sums(HEIGHTS, RADII, H - moved, integrated)[rows]
    slack = 1e-12 * np.max(abs(most), axis=1, keepdims=True)
    assert (ours >= least - slack).all()
    assert (ours <= most + slack).all()


def test_above_the_top_nothing_touches_and_nothing_pulls(sampled):
    above = float(sampled.top) + np.array([1e-12, 1e-9, 1e-6])
    assert float(sampled.top) < HEIGHTS.max() + 7.0 * float(sampled.step)
    for integrated in (0, 1):
        np.testing.assert_array_equal(found(sampled, above, integrated), 0.0)


def test_finer_nodes_converge_to_the_sums_with_the_square_of_their_step():
    """Of smooth means: the second difference that the kernel leaves behind."""
    separations = np.linspace(-2.5, 1.0, 57) * SIGMA
    exact = sums(HEIGHTS, RADII, separations, 1)[[0, 2]]
    errors = []
    for factor in (0.5, 1.0, 2.0, 4.0):
        fine = Sampled(HEIGHTS, RADII, RADIUS, finer(HEIGHTS, factor))
        off = found(fine, separations, 1)[[0, 2]] / exact - 1.0
        errors.append(np.sqrt(np.mean(off**2)))
    orders = [np.log2(a / b) for a, b in pairwise(errors)]
    assert min(orders) > 1.7
    assert np.mean(orders) == pytest.approx(2.0, abs=0.5)


def test_mean_and_variance_of_the_density_are_those_of_the_heights(sampled):
    """As stated; and by quadrature on the cells, on which the density is a cubic."""
    assert float(sampled.mean) == pytest.approx(HEIGHTS.mean(), rel=1e-13, abs=1e-22)
    assert float(sampled.rms) == pytest.approx(HEIGHTS.std(), rel=1e-13)
    node, weight = np.polynomial.legendre.leggauss(4)
    cells = float(sampled.first) + float(sampled.step) * np.arange(-2, sampled.nodes + 1)
    places = (cells[:, None] + float(sampled.step) * 0.5 * (node + 1.0)).ravel()
    density = np.asarray(jax.jit(lambda z: sampled.tail(0, z))(jnp.asarray(places)))
    share = density * np.tile(0.5 * float(sampled.step) * weight, cells.size)
    assert density.min() >= -1e-9 * density.max()
    assert share.sum() == pytest.approx(1.0, rel=1e-12)
    mean = float(share @ places)
    assert mean == pytest.approx(HEIGHTS.mean(), abs=1e-12 * SIGMA)
    assert float(share @ (places - mean) ** 2) == pytest.approx(HEIGHTS.var(), rel=1e-11)


@pytest.mark.parametrize("size", [0.0, 0.5, 1.0])
def test_tails_are_integrals_of_one_another(sampled, size):
    """-dT_k/dz is T_(k-1), for every weight of the radius."""
    places = jnp.asarray(np.linspace(-2.3, 3.7, 41)) * SIGMA

    @jax.jit
    def slopes(z):
        rows = [jax.vmap(jax.grad(lambda x, k=k: sampled.tail(k, x, size)))(z) for k in (1, 2, 3)]
        return jnp.stack(rows), jnp.stack([sampled.tail(k, z, size) for k in (0, 1, 2)])

    slope, value = slopes(places)
    scale = np.max(abs(np.asarray(value)), axis=1, keepdims=True)
    # Powers up to the second are quintics on a cell: exact. The third is a sextic.
    off = np.max(abs(np.asarray(-slope - value)) / scale, axis=1)
    assert max(off[:2]) < 1e-12
    assert off[2] < 1e-6


@pytest.mark.parametrize("integrated", [0, 1])
def test_pressure_is_the_slope_of_the_energy(sampled, integrated):
    """To 1e-6 of the largest: energy and pressure are tables of their own."""
    law = HERTZ + DMT + Meniscus(RADIUS, 0.0728, radians(40.0), 1.3e-9)
    interface = Interface(law, sampled, 1.0)
    places = jnp.asarray(np.linspace(-3.0, 3.0, 25)) * SIGMA
    memory = tuple(places - 0.5 * law.breaking_gap for law in interface.hysteretic)

    @eqx.filter_jit
    def both(interface):
        energy = lambda h, b: interface.energy(h[None], tuple(x[None] for x in b), integrated)[0]  # noqa: E731
        return interface.pressure(places, memory, integrated), jax.vmap(jax.grad(energy))(
            places, memory
        )

    pressure, slope = both(interface)
    scale = float(jnp.max(jnp.abs(pressure)))
    np.testing.assert_allclose(pressure, -slope, rtol=0, atol=1e-6 * scale)


def test_bradley_by_quadrature_is_the_sum_over_the_summits(sampled):
    """A law without powers: its mean is a quadrature over the density, weighted by the radii."""
    law = Bradley(RADIUS, W, 3e-9)
    places = np.linspace(-1.0, 6.0, 15) * SIGMA
    gap = places[:, None] - HEIGHTS
    exact = np.mean(np.asarray(law.force(jnp.asarray(gap))) * RADII / RADIUS, axis=1)
    pressure = eqx.filter_jit(lambda h: Interface(law, sampled, 1.0).pressure(h, ()))
    np.testing.assert_allclose(pressure(jnp.asarray(places)), exact, rtol=2e-3)


def test_means_do_not_depend_on_the_unit_of_length(sampled):
    unit = 1e9
    scaled = Sampled(HEIGHTS * unit, RADII * unit, RADIUS * unit)
    places = np.linspace(-3.0, 4.0, 29) * SIGMA
    ratio = jax.jit(lambda s, z: jnp.stack([s.tail(k, z, 0.5) for k in (0, 1, 2)]))
    here, there = ratio(sampled, jnp.asarray(places)), ratio(scaled, jnp.asarray(places * unit))
    for k in range(3):
        kept, other = np.asarray(here[k]), np.asarray(there[k]) * unit ** (1 - k)
        np.testing.assert_allclose(other, kept, rtol=0, atol=1e-9 * np.max(abs(kept)))


@pytest.mark.parametrize("height", [3e-9, -3e-9, 0.0])
def test_heights_that_are_all_equal_are_one_asperity(height):
    flat = Sampled(np.full(50, height), np.full(50, RADIUS), RADIUS)
    separations = height + np.array([-9e-9, -1e-9, -1e-12, 1e-12, 5e-9])
    exact = sums(np.array([height]), np.array([RADIUS]), separations, 0)
    ours = found(flat, separations, 0)
    np.testing.assert_allclose(ours, exact, rtol=1e-5, atol=0)
    assert float(flat.rms) == pytest.approx(0.0, abs=1e-18)


def test_two_summits_are_two_asperities():
    """Not spread into one another: between them one touches, below them both do."""
    heights, radii = np.array([0.0, 10e-9]), np.array([RADIUS, 4.0 * RADIUS])
    two = Sampled(heights, radii, RADIUS)
    assert float(two.step) < 0.05 * (heights[1] - heights[0])
    separations = np.array([-6e-9, 4e-9, 5e-9, 12e-9])
    exact = sums(heights, radii, separations, 0)
    np.testing.assert_allclose(found(two, separations, 0), exact, rtol=0.01, atol=0)
    np.testing.assert_allclose(found(two, separations, 0)[3], [1.0, 0.5, 0.5, 0.0], atol=1e-12)


def test_one_summit_far_above_all_others_keeps_its_height():
    """25 rms up: it alone touches, with its own force, and the others keep theirs.

    Its height over the mean is less by (step/rms)^2/3 of it: here less than a step.
    """
    heights = np.append(HEIGHTS, 25.0 * SIGMA)
    radii = np.append(RADII, RADIUS)
    spread = spread_of(heights)
    assert spread.step < 0.1 * SIGMA
    tall = Sampled(heights, radii, RADIUS, spread)
    alone = np.array([8.0, 15.0, 22.0]) * SIGMA
    exact, ours = sums(heights, radii, alone, 0), found(tall, alone, 0)
    np.testing.assert_allclose(ours[3], exact[3], rtol=1e-9)
    drawn = 25.0 * SIGMA / 3.0 * (spread.step / heights.std()) ** 2
    assert drawn < spread.step
    moved = sums(heights, radii, alone + drawn, 0)
    np.testing.assert_allclose(ours[:3], moved[:3], rtol=2e-3)
    rest = np.array([-3.0, -1.0, 0.0]) * SIGMA
    np.testing.assert_allclose(found(tall, rest, 0)[0], sums(heights, radii, rest, 0)[0], rtol=2e-3)


@settings(max_examples=10)
@given(st.integers(2, 400), st.integers(0, 2**32 - 1), st.floats(0.5, 40.0))
def test_any_heights_keep_their_number_mean_and_rms(count, seed, freedom):
    """Heavy tails too: Student's t of any number of degrees of freedom."""
    heights = SIGMA * np.clip(np.random.default_rng(seed).standard_t(freedom, count), -1e3, 1e3)
    spread = spread_of(heights)
    assert 32 <= spread.nodes <= 1024
    assert spread.first + 4.0 * spread.step == pytest.approx(heights.min())
    assert spread.first + (spread.nodes - 5) * spread.step >= heights.max() - 1e-9 * SIGMA
    laid = Sampled(heights, np.full(count, RADIUS), RADIUS, spread)
    share = np.asarray(laid.share[0])
    places = spread.first + spread.step * np.arange(spread.nodes)
    assert share.sum() == pytest.approx(1.0, rel=1e-12)
    assert (share >= 0.0).all()
    assert share @ places == pytest.approx(heights.mean(), abs=1e-9 * heights.std())
    spare = share @ (places - heights.mean()) ** 2 + spread.step**2 / 3.0
    assert spare == pytest.approx(heights.var(), rel=1e-9)


def test_derivatives_by_heights_and_radii_are_those_of_the_sum():
    """Of Hertz's pressure where all touch: 2 E sqrt(R) overlap^1/2 and its like, a summit each."""
    h = jnp.asarray(-6.0 * SIGMA)
    spread = spread_of(HEIGHTS)

    @jax.jit
    def slopes(heights, radii):
        def pressure(heights, radii):
            return Interface(HERTZ, Sampled(heights, radii, RADIUS, spread), 1.0).pressure(h, ())

        return jax.grad(pressure, (0, 1))(heights, radii)

    by_height, by_radius = slopes(jnp.asarray(HEIGHTS), jnp.asarray(RADII))
    overlap = HEIGHTS - float(h)
    np.testing.assert_allclose(by_height, 2.0 * E * np.sqrt(RADII * overlap) / COUNT, rtol=3e-3)
    np.testing.assert_allclose(
        by_radius, 2.0 / 3.0 * E * overlap**1.5 / np.sqrt(RADII) / COUNT, rtol=3e-3
    )
