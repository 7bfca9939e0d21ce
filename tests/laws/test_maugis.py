"""Maugis-Dugdale contact: its two equations, both its ends, energy, losses and limits."""

from functools import cache
from math import pi

import equinox as eqx
import numpy as np
import pytest
from scipy.optimize import brentq

from asperity._jax import jax, jnp
from asperity.laws import Dmt, Hertz, Jkr, Maugis
from asperity.laws.maugis import RANGE_PER_SPACING
from asperity.laws.testing import check_law
from chosen import long_but

R, E, W = 2.5e-7, 5e9, 0.05  # m, Pa, J/m^2
DEPTH = (9.0 * pi**2 * W**2 * R / (16.0 * E**2)) ** (1.0 / 3.0)
WIDTH = (R * DEPTH) ** 0.5
ATTRACTION = pi * W * R
FOLDS_MEET = (9.0 * pi / (16.0 * (pi - 1.0))) ** (1.0 / 3.0)
"""Elasticity at which the fold outside contact lies where contact begins: 0.938."""

LAMBDAS = (0.005, 0.05, 0.3, 0.7, 0.9, 0.9379, 0.938, 0.95, 1.0, 1.3, 2.0, 5.0, 20.0, 50.0)
every_lambda = pytest.mark.parametrize("elasticity", LAMBDAS)


def law_of(elasticity):
    return Maugis(R, E, W, 2.0 * DEPTH / (pi * elasticity) / RANGE_PER_SPACING)


@cache
def compiled():
    def curves(law, g):
        return law.bonded_force(g), law.bonded_energy(g), jax.vmap(jax.grad(law.bonded_energy))(g)

    return eqx.filter_jit(curves)


def curves_of(law, gaps):
    """Force, energy and its slope at any number of gaps, by one compiled program."""
    padded = np.zeros(-(-len(gaps) // 128) * 128)
    padded[: len(gaps)] = gaps
    return [np.asarray(row)[: len(gaps)] for row in compiled()(law, jnp.asarray(padded))]


def force_of(law, gaps):
    return curves_of(law, gaps)[0]


def first_equation(angle, outer, stress):
    """Work of the adhesive stress on the gap at c, over w, and the overlap, as Maugis has them.

    SI, in the contact radius a = c cos(angle): the stress acts over a < r < c.
    """
    a, m = outer * np.cos(angle), 1.0 / np.cos(angle)
    root, arc = np.sqrt((m - 1.0) * (m + 1.0)), angle
    shape = root + (m * m - 2.0) * arc
    opening = a * a * shape / (pi * R) + 4.0 * stress * a / (pi * E) * (root * arc - m + 1.0)
    overlap = a * a / R - 2.0 * stress / E * a * root
    force = 4.0 * E * a**3 / (3.0 * R) - 2.0 * stress * a * a * (root + m * m * arc)
    return stress * opening / W, overlap, force


def in_contact(angle, stress):
    """Overlap and force where both equations are met, by bisection."""
    outer = brentq(
        lambda c: first_equation(angle, c, stress)[0] - 1.0, 1e-9 * WIDTH, 1e4 * WIDTH,
        xtol=1e-30, rtol=1e-15,
    )  # fmt: skip
    return first_equation(angle, outer, stress)[1:]


def solved(elasticity, gap):
    """Force in contact by two nested bisections, the larger contact of two at one gap."""
    stress = W / (RANGE_PER_SPACING * float(law_of(elasticity).spacing))

    def miss(angle):
        return in_contact(angle, stress)[0] + gap

    angles = 0.5 * pi * (1.0 - np.linspace(0.0, 1.0, 400)[1:-1] ** 2)
    falls = np.array([miss(angle) for angle in angles])
    k = int(np.flatnonzero(falls[1:] * falls[:-1] <= 0.0)[-1])
    angle = brentq(miss, angles[k + 1], angles[k], xtol=1e-16, rtol=1e-14)
    return in_contact(angle, stress)[1]


@pytest.mark.parametrize("elasticity", [0.05, 0.3, 0.7, 0.93, 0.945, 1.3, 3.0, 10.0])
def test_contact_solves_both_equations(elasticity):
    law = law_of(elasticity)
    random = np.random.default_rng(int(1000 * elasticity))
    end = float(law.kinks[0])
    gaps = np.append(end - DEPTH * random.uniform(0.03, 3.0, 6), -20.0 * DEPTH)
    exact = np.array([solved(elasticity, gap) for gap in gaps])
    np.testing.assert_allclose(force_of(law, gaps), exact, rtol=1e-9, atol=1e-9 * ATTRACTION)


@pytest.mark.parametrize("elasticity", [0.005, 0.05, 0.3, 0.7, 0.9])
def test_outside_contact_the_stress_fills_a_disc_that_shrinks(elasticity):
    """g = h_0 - c^2/(2 R) + 4 sigma_0 c/(pi E*) and F = -pi sigma_0 c^2."""
    law = law_of(elasticity)
    range_, first, last = (float(x) for x in (law.forming_gap, law.kinks[0], law.breaking_gap))
    stress = W / range_
    gaps = np.linspace(first, last, 52)[1:-1]
    outer = np.sqrt(-force_of(law, gaps) / (pi * stress))
    found = range_ - outer**2 / (2.0 * R) + 4.0 * stress * outer / (pi * E)
    np.testing.assert_allclose(found, gaps, rtol=1e-9, atol=1e-12 * range_)


@pytest.mark.parametrize("elasticity", long_but([0.3, 3.0], 3.0))
def test_it_is_a_law(elasticity):
    check_law(law_of(elasticity))


@every_lambda
def test_force_is_the_slope_of_the_energy_from_deep_inside_to_the_rupture(elasticity):
    law = law_of(elasticity)
    end, last = float(law.kinks[0]), float(law.breaking_gap)
    deep = -DEPTH * np.geomspace(1e-2, 1e6, 60)
    near = end + (last - end) * np.linspace(0.0, 1.0, 60)[1:-1] if last > end else []
    ladder = DEPTH * np.geomspace(1e-7, 1.0, 20)
    around = [end - ladder, (end + ladder)[end + ladder < last - 1e-7 * DEPTH]]
    gaps = np.concatenate([deep, near, *around])
    force, _, slope = curves_of(law, gaps)
    np.testing.assert_allclose(force, -slope, rtol=1e-9, atol=1e-12 * ATTRACTION)


@every_lambda
def test_work_across_the_beginning_of_contact_is_the_change_of_energy(elasticity):
    law = law_of(elasticity)
    end, last = float(law.kinks[0]), float(law.breaking_gap)
    outer = min(end + 0.3 * DEPTH, last)
    node, weight = np.polynomial.legendre.leggauss(40)
    t = 0.5 * (node + 1.0)
    total = 0.0
    for low, high in ((end - 0.3 * DEPTH, end), (end, outer)):
        gap = low + (high - low) * t * t * (3.0 - 2.0 * t)
        total += float(np.sum(3.0 * t * (1.0 - t) * weight * force_of(law, gap))) * (high - low)
    ends = jnp.asarray([end - 0.3 * DEPTH, outer])
    drop = -np.diff(np.asarray(law.bonded_energy(ends)))[0]
    assert total == pytest.approx(drop, rel=1e-7)


def test_the_branch_breaks_at_one_gap_on_both_sides_of_the_change_of_fold():
    """Continuous in lambda, and no earlier than the fold of either kind."""
    assert pytest.approx(0.9379474572, rel=1e-9) == FOLDS_MEET
    below, above = (law_of(FOLDS_MEET * (1.0 + x)) for x in (-1e-7, 1e-7))
    assert float(above.breaking_gap) == pytest.approx(float(below.breaking_gap), rel=1e-6)
    both = [float(law.bonded_force(law.breaking_gap)) for law in (below, above)]
    assert both[1] == pytest.approx(both[0], rel=1e-5)
    stress = W / float(below.forming_gap)
    outside = float(below.forming_gap) + 8.0 * stress**2 * R / (pi * E) ** 2
    assert float(below.breaking_gap) == pytest.approx(outside, rel=1e-12)


@pytest.mark.parametrize("elasticity", [0.95, 1.3, 5.0, 50.0])
def test_soft_contact_breaks_at_its_largest_gap(elasticity):
    """The gap over all angles of the contact branch, from the two equations alone."""
    law = law_of(elasticity)
    stress = W / float(law.forming_gap)
    angles = np.linspace(0.3 / elasticity, 0.5 * pi - 1e-6, 200)
    for _ in range(3):
        gaps = np.array([-in_contact(angle, stress)[0] for angle in angles])
        k = int(np.argmax(gaps))
        angles = np.linspace(angles[max(k - 1, 0)], angles[min(k + 1, len(angles) - 1)], 200)
    assert float(law.breaking_gap) == pytest.approx(float(gaps.max()), rel=1e-9)


@pytest.mark.parametrize("elasticity", [0.005, 0.02, 0.1, 0.3, 0.45])
def test_stiff_contact_loses_only_what_the_snaps_outside_contact_cost(elasticity):
    """(16/9 + 1/9) (8 lambda/(3 pi))^3 lambda^2, in pi w R and the unit of depth.

    From U = (pi lambda/2) c^2 (g - h_0 + c^2/4) - (8/9) lambda^2 c^3 at both snaps: where
    they form, c is twice the 8 lambda/(3 pi) of the fold.
    """
    law = law_of(elasticity)
    fold = 8.0 * elasticity / (3.0 * pi)
    unit = ATTRACTION * DEPTH * elasticity**2 * fold**3
    assert float(law.formation_loss) == pytest.approx(16.0 / 9.0 * unit, rel=1e-6)
    assert float(law.rupture_loss) == pytest.approx(1.0 / 9.0 * unit, rel=1e-6)


def test_loss_of_a_cycle_tends_to_that_of_jkr():
    """The shortfall goes like lambda^(-1.1): 0.31 at 2, 0.034 at 20, 0.013 at 50."""
    jkr = Jkr(R, E, W)
    whole = float(jkr.formation_loss + jkr.rupture_loss)
    assert whole == pytest.approx(7.092196 * (W**5 * R**4 / E**2) ** (1.0 / 3.0), rel=1e-6)
    laws = [law_of(elasticity) for elasticity in (20.0, 50.0, 200.0, 800.0)]
    short = np.array([1.0 - float(law.formation_loss + law.rupture_loss) / whole for law in laws])
    order = -np.diff(np.log(short)) / np.diff(np.log([20.0, 50.0, 200.0, 800.0]))
    assert np.all((order > 0.9) & (order < 1.2))
    assert short[1] < 0.014


def test_soft_contact_tends_to_jkr():
    """Within 1.3 % of pi w R at lambda = 5, and 0.014 % at 50: like 1/lambda^2."""
    jkr = Jkr(R, E, W)
    gaps = np.linspace(-5.0 * DEPTH, 0.8 * DEPTH, 60)
    exact = np.asarray(jkr.bonded_force(jnp.asarray(gaps)))
    laws = [law_of(elasticity) for elasticity in (5.0, 50.0)]
    miss = [np.max(np.abs(force_of(law, gaps) - exact)) / ATTRACTION for law in laws]
    assert miss[0] < 1.3e-2
    assert miss[1] < 1.4e-4
    assert float(laws[1].breaking_gap) == pytest.approx(float(jkr.breaking_gap), rel=1e-4)


def test_stiff_contact_tends_to_dmt():
    """Within 10 % of the pull at lambda = 0.005, where overlap is below twice the unit of depth.

    Contact begins apart by (4/3) lambda c with c about 2/sqrt(pi lambda), so the difference
    falls like the square root of lambda.
    """
    gaps = np.linspace(-2.0 * DEPTH, -0.2 * DEPTH, 40)
    dmt = np.asarray((Hertz(R, E) + Dmt(R, W)).force(jnp.asarray(gaps)))
    found = [force_of(law_of(elasticity), gaps) for elasticity in (5e-3, 5e-5, 5e-7)]
    miss = np.array([np.max(np.abs(force - dmt)) / ATTRACTION for force in found])
    assert miss[0] < 0.1 * 2.0
    np.testing.assert_allclose(-np.diff(np.log10(miss)) / 2.0, 0.5, atol=0.05)


def test_deep_overlap_is_hertz():
    for elasticity in (0.005, 1.0, 50.0):
        law = law_of(elasticity)
        gaps = -DEPTH * 10.0 ** np.arange(5.0, 9.0)
        hertz = Hertz(R, E)
        np.testing.assert_allclose(force_of(law, gaps), hertz.force(jnp.asarray(gaps)), rtol=1e-5)
        np.testing.assert_allclose(
            law.bonded_energy(jnp.asarray(gaps)), hertz.energy(jnp.asarray(gaps)), rtol=1e-5
        )


@cache
def slopes():
    """Force, energy and losses of a law, and their slopes with its values, all in parts of them."""

    def all_of(shares, law, gaps):
        values = shares * jnp.stack([law.radius, law.modulus, law.work_of_adhesion, law.spacing])
        law = Maugis(*values)
        ends = jnp.stack([law.breaking_gap / DEPTH, law.formation_loss / (ATTRACTION * DEPTH),
                          law.rupture_loss / (ATTRACTION * DEPTH)])  # fmt: skip
        energy = law.bonded_energy(gaps) / (ATTRACTION * DEPTH)
        return jnp.concatenate([law.bonded_force(gaps) / ATTRACTION, energy, ends])

    return eqx.filter_jit(all_of), eqx.filter_jit(jax.jacfwd(all_of))


@pytest.mark.parametrize("elasticity", [0.05, 0.7, 0.95, 3.0, 20.0])
def test_slopes_with_every_value_are_those_of_differences(elasticity):
    law = law_of(elasticity)
    outer = float(0.5 * (law.kinks[0] + law.breaking_gap) if elasticity < 0.9 else 0.0)
    gaps = jnp.append(jnp.asarray([-4.0, -1.0, 0.1]) * DEPTH, outer)
    value, jacobian = slopes()
    exact = np.asarray(jacobian(jnp.ones(4), law, gaps))
    for k in range(4):
        rates = []
        for step in (1e-4, 2e-4):
            ends = [np.ones(4), np.ones(4)]
            ends[0][k], ends[1][k] = 1.0 + step, 1.0 - step
            up, down = (np.asarray(value(jnp.asarray(share), law, gaps)) for share in ends)
            rates.append((up - down) / (2.0 * step))
        better = (4.0 * rates[0] - rates[1]) / 3.0
        np.testing.assert_allclose(exact[:, k], better, rtol=1e-6, atol=1e-8)


def test_a_batch_may_hold_stiff_and_soft_contacts():
    laws = jax.tree_util.tree_map(lambda *x: jnp.stack(x), *[law_of(x) for x in LAMBDAS])
    gap = jnp.asarray(-0.5 * DEPTH)
    batch = jax.jit(jax.vmap(lambda law: law.bonded_force(gap)))(laws)
    single = [float(law_of(x).bonded_force(gap)) for x in LAMBDAS]
    np.testing.assert_allclose(batch, single, rtol=1e-12)
