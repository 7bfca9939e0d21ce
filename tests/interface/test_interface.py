"""Many asperities: means over heights, energies, and the memory of every bond."""

from functools import cache
from itertools import pairwise
from math import pi, radians

import equinox as eqx
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.integrate import quad

from asperity._jax import jax, jnp
from asperity.interface.interface import Interface
from asperity.laws import Bradley, ByKelvinGap, Dmt, Hertz, Jkr, Meniscus
from asperity.surfaces.heights import Gaussian
from asperity.surfaces.heights.distribution import Heights

BETA, E, W, SIGMA, N = 2.5e-7, 5e9, 0.05, 4e-9, 1e14
HERTZ, DMT, JKR = Hertz(BETA, E), Dmt(BETA, W), Jkr(BETA, E, W)
MENISCUS = Meniscus(BETA, 0.0728, radians(40.0), 1.3e-9)
KELVIN = Meniscus(BETA, 0.0728, radians(40.0), 1.3e-9, ByKelvinGap())


class WithoutPowers(Hertz):
    """Hertz contact that hides its closed form."""

    def force(self, gap):
        return Hertz(self.radius, self.modulus).force(gap)

    def energy(self, gap):
        return Hertz(self.radius, self.modulus).energy(gap)

    def powers(self, bond_gap):
        return None


class MeniscusWithoutPowers(Meniscus):
    """A meniscus that hides its closed form."""

    def powers(self, bond_gap):
        return None


class Points(Heights):
    """A finite set of asperities, each with its own height: means are sums over them."""

    heights: jax.Array

    @property
    def rms(self):
        return jnp.sqrt(jnp.mean(self.heights**2))

    @property
    def top(self):
        return jnp.max(self.heights)

    @property
    def bottom(self):
        return jnp.min(self.heights)

    def highest_beside(self, height):
        return jnp.maximum(height, self.top)

    def tail(self, order, height, size=0.0):
        if order == 0:
            raise ValueError("a set of points has no density")
        above = jnp.maximum(self.heights - height[..., None], 0.0)
        return jnp.mean(jnp.where(above > 0.0, above ** (order - 1), 0.0), axis=-1)

    def mean_powers(self, terms, order, separation, sizes=None):
        assert order == 0
        gap = separation[..., None] - self.heights
        return jnp.stack([jnp.mean(jnp.broadcast_to(t(gap), gap.shape), axis=-1) for t in terms])


def means(law, heights=None):
    return Interface(law, heights or Gaussian(SIGMA), N)


H = jnp.linspace(-3.0, 5.0, 17) * SIGMA


@pytest.mark.parametrize("integrated", [0, 1])
@pytest.mark.parametrize(
    ("closed", "hidden"),
    [
        (HERTZ, WithoutPowers(BETA, E)),
        (MENISCUS, MeniscusWithoutPowers(BETA, 0.0728, radians(40.0), 1.3e-9)),
    ],
    ids=["hertz", "meniscus"],
)
def test_quadrature_over_heights_equals_the_closed_form(closed, hidden, integrated):
    memory = tuple(jnp.full(H.shape, 1.0e-9) for _ in means(closed).hysteretic)

    @eqx.filter_jit
    def both(law):
        interface = means(law)
        found = interface.measure(H, memory, integrated)
        return found.parts.sum(axis=0), found.energy, interface.pressure(H, memory, integrated)

    for exact, found in zip(both(closed), both(hidden), strict=True):
        np.testing.assert_allclose(found, exact, rtol=1e-9, atol=1e-13 * float(jnp.max(abs(exact))))


def scipy_mean(branch, h, low, high):
    """N int branch(h - z) phi(z) dz between two gaps, by adaptive quadrature."""

    def integrand(x):
        z = (h - (low + x * (high - low))) / SIGMA
        return float(branch(low + x * (high - low))) * np.exp(-0.5 * z * z)

    value = quad(integrand, 0.0, 1.0, epsabs=0.0, epsrel=1e-10, limit=200)[0]
    return N * value * (high - low) / (np.sqrt(2.0 * pi) * SIGMA)


def jkr_branch(gap):
    """JKR force at a gap from the two equations in the contact radius, by bisection."""
    low = (pi * W * BETA**2 / (8.0 * E)) ** (1.0 / 3.0)
    high = 1e-6
    for _ in range(80):
        a = 0.5 * (low + high)
        too_far = a * a / BETA - np.sqrt(2.0 * pi * a * W / E) > -gap
        low, high = (low, a) if too_far else (a, high)
    return 4.0 * E * a**3 / (3.0 * BETA) - np.sqrt(8.0 * pi * W * E * a**3)


@pytest.mark.parametrize("reduced", [-1.0, 0.5, 2.0, 3.5])
def test_jkr_pressure_is_the_mean_of_the_bonded_branch_alone(reduced):
    h = reduced * SIGMA
    interface = means(JKR)
    memory = (jnp.asarray(h - 0.5 * float(JKR.breaking_gap)),)
    found = float(interface.pressure(jnp.asarray(h), memory))
    edge, deepest = 0.5 * float(JKR.breaking_gap), min(h, 0.0) - 8.5 * SIGMA
    exact = scipy_mean(jkr_branch, h, deepest, edge)
    assert found == pytest.approx(exact, rel=1e-8)


def test_bradley_pressure_is_the_mean_of_the_law():
    law, h = Bradley(BETA, W, 3e-10), 1.3 * SIGMA

    def force(gap):
        y = 3e-10 / (max(gap, 0.0) + 3e-10)
        return -2.0 * pi * BETA * W * (4.0 * y**2 - y**8) / 3.0

    ends = [-8.5 * SIGMA, 0.0, 3e-10, 3e-9, h + 8.5 * SIGMA]
    pieces = [scipy_mean(force, h, a, b) for a, b in pairwise(ends)]
    found = float(means(law).pressure(jnp.asarray(h), ()))
    assert found == pytest.approx(sum(pieces), rel=1e-8)


SUMS = {
    "hertz + dmt": HERTZ + DMT,
    "hertz + bradley + kelvin": HERTZ + Bradley(BETA, W, 3e-10) + KELVIN,
    "hertz + meniscus": HERTZ + MENISCUS,
    "jkr": JKR,
    "jkr + meniscus": JKR + MENISCUS,
}


@pytest.mark.parametrize("integrated", [0, 1])
@pytest.mark.parametrize("law", SUMS.values(), ids=SUMS)
def test_pressure_is_the_slope_of_the_energy_while_bonds_are_frozen(law, integrated):
    """Frozen: within the width of the memory no bond forms or breaks."""
    interface = means(law)
    widths = [float(law.breaking_gap - law.forming_gap) for law in interface.hysteretic]
    memory = tuple(H - law.forming_gap - 0.5 * min(widths) for law in interface.hysteretic)

    @eqx.filter_jit
    def both(interface, memory):
        energy = lambda h, b: interface.energy(h[None], tuple(x[None] for x in b), integrated)[0]  # noqa: E731
        return interface.pressure(H, memory, integrated), jax.vmap(jax.grad(energy))(H, memory)

    pressure, slope = both(interface, memory)
    scale = float(jnp.max(jnp.abs(pressure)))
    np.testing.assert_allclose(pressure, -slope, rtol=1e-8, atol=1e-11 * scale)


@pytest.mark.parametrize("name", ["hertz + meniscus", "jkr"])
def test_work_over_a_cycle_is_the_change_of_energy_and_the_losses(name):
    """First law along in, part of the way out, in again, and out to the end."""
    interface = means(SUMS[name])
    formation, rupture = interface.losses()
    turns = np.array([8.5, 1.0, 2.2, 0.3, 9.0]) * SIGMA
    (law,) = interface.hysteretic
    width = float(law.breaking_gap - law.forming_gap)
    node, weight = np.polynomial.legendre.leggauss(24)

    @eqx.filter_jit
    def phase(memory, ends):
        span = jnp.diff(ends)[:, None]
        place = ends[:-1, None] + span * 0.5 * (node + 1.0)
        pressure = interface.pressure(place.ravel(), memory).reshape(place.shape)
        both = ends[jnp.asarray([0, -1])]
        state = interface.measure(both, tuple(jnp.broadcast_to(b, (2,)) for b in memory))
        work = jnp.sum(0.5 * span * pressure * weight)
        return work, state, interface.remember(memory, ends[-1])

    memory, lost, work = interface.initial_memory(), 0.0, 0.0
    for first, last in pairwise(turns):
        # Bonds begin to change where the play is used up: no panel spans that kink.
        kink = first + np.sign(last - first) * width
        ends = np.concatenate([np.linspace(first, kink, 3), np.linspace(kink, last, 41)[1:]])
        done, state, memory = phase(memory, jnp.asarray(ends))
        made = np.asarray(state.bonds[:, 1] - state.bonds[:, 0])
        lost += float(np.maximum(made, 0) @ formation + np.maximum(-made, 0) @ rupture)
        work += float(done)
    assert lost > 0.0
    assert -work == pytest.approx(float(state.energy[1]) + lost, rel=1e-8)


HEIGHTS = SIGMA * np.random.default_rng(7).standard_normal(400)
BRUTE = HERTZ + DMT + MENISCUS


@cache
def brute_tools():
    """Compiled: the memory's step on the sampled heights, and each asperity's branches.

    With the gap at which bonds break, what one loses, and its pull.
    """
    interface = means(BRUTE, Points(jnp.asarray(HEIGHTS)))

    @jax.jit
    def step(memory, h):
        found = interface.measure(h, memory)
        return found, interface.remember(memory, h)

    @jax.jit
    def single(gap, bonded):
        force, energy = HERTZ.force(gap) + DMT.force(gap), HERTZ.energy(gap) + DMT.energy(gap)
        held = jnp.where(bonded, MENISCUS.bonded_force(gap), 0.0)
        kept = jnp.where(bonded, MENISCUS.bonded_energy(gap), 0.0)
        return jnp.mean(force + held), jnp.mean(energy + kept)

    one = MENISCUS.breaking_gap, MENISCUS.formation_loss, MENISCUS.rupture_loss, MENISCUS.pull
    return interface, step, single, [float(x) for x in one], np.concatenate(interface.losses())


@settings(max_examples=60)
@given(st.lists(st.floats(-3.0, 4.5), min_size=2, max_size=25))
def test_memory_is_the_bonds_of_all_asperities_over_random_reversals(path):
    """Brute force: 400 asperities, each with its own bond, against one threshold."""
    interface, step, single, (c, at_formation, at_rupture, pull), (made, broken) = brute_tools()
    bonded, memory = np.zeros(400, bool), interface.initial_memory()
    lost = brute_lost = bonds = 0.0
    for reduced in path:
        h = reduced * SIGMA
        gap = h - HEIGHTS
        now = (gap <= 0.0) | (bonded & (gap < c))
        brute_lost += (now & ~bonded).sum() / 400 * at_formation
        brute_lost += (bonded & ~now).sum() / 400 * at_rupture
        bonded = now
        found, memory = step(memory, jnp.asarray(h))
        change, bonds = float(found.bonds[0]) - bonds, float(found.bonds[0])
        lost += max(change, 0.0) * made + max(-change, 0.0) * broken
        pressure, energy = (N * float(x) for x in single(jnp.asarray(gap), jnp.asarray(bonded)))
        size = N * pull
        assert np.sum(found.parts) == pytest.approx(pressure, rel=1e-10, abs=1e-10 * size)
        assert float(found.energy) == pytest.approx(energy, rel=1e-10, abs=1e-10 * size * c)
        assert lost == pytest.approx(N * brute_lost, rel=1e-10, abs=1e-12 * size * c)


@settings(max_examples=60)
@given(st.lists(st.floats(-3.0, 4.5), min_size=1, max_size=25))
def test_threshold_of_jkr_bonds_is_that_of_single_relays(path):
    breaking = float(JKR.breaking_gap)
    bonded, threshold = np.zeros(400, bool), np.inf
    for reduced in path:
        h = reduced * SIGMA
        gap = h - HEIGHTS
        bonded = (gap <= 0.0) | (bonded & (gap < breaking))
        threshold = float(means(JKR).remember((jnp.asarray(threshold),), jnp.asarray(h))[0])
        np.testing.assert_array_equal(bonded, threshold < HEIGHTS)


def test_pressure_of_contact_is_that_of_greenwood_and_williamson():
    """p = (4/3) N sqrt(beta) sigma^1.5 E* F_3/2, F_3/2 from the sourced table."""
    table = {-1.0: 1.404597, 0.0: 0.4300200, 2.0: 6.648178e-3, 4.0: 4.439156e-6}
    for reduced, integral in table.items():
        found = float(means(HERTZ).pressure(jnp.asarray(reduced * SIGMA), ()))
        exact = 4.0 / 3.0 * N * np.sqrt(BETA) * SIGMA**1.5 * E * integral
        assert found == pytest.approx(exact, rel=1e-6)


def test_bonds_and_contacting_asperities_are_counted_by_the_normal_tail():
    interface, h = means(HERTZ + MENISCUS), jnp.asarray(2.0 * SIGMA)
    found = interface.measure(h, interface.initial_memory())
    assert float(found.contacting) == pytest.approx(N * 2.2750131948e-2, rel=1e-9)
    assert float(found.bonds[0]) == pytest.approx(float(found.contacting), rel=1e-12)
    torn = interface.measure(h, interface.saturated_memory())
    tail = float(jax.scipy.stats.norm.sf((2.0 * SIGMA - float(MENISCUS.interaction_range)) / SIGMA))
    assert float(torn.bonds[0]) == pytest.approx(N * tail, rel=1e-10)


def test_means_do_not_depend_on_the_units():
    length, energy = 1e9, 1e17
    scaled = Interface(
        Hertz(BETA * length, E * energy / length**3)
        + Meniscus(BETA * length, 0.0728 * energy / length**2, radians(40.0), 1.3e-9 * length),
        Gaussian(SIGMA * length),
        N / length**2,
    )
    here = means(HERTZ + MENISCUS)
    p, q = here.pressure(H, (0.5 * H,)), scaled.pressure(H * length, (0.5 * H * length,))
    np.testing.assert_allclose(q, p * energy / length**3, rtol=1e-10)
