"""Scanning curves tabulated by their reversal, beside curves that are solved one by one."""

import dataclasses
from math import pi, radians

import equinox as eqx
import numpy as np
import pytest

from asperity._jax import jax, jnp
from asperity.contact import ElasticContact
from asperity.contact.contact import Held
from asperity.contact.profile import Sphere
from asperity.dynamics import Body, Limits, integrate_impacts, prepare, start
from asperity.dynamics.curve_table import FORCE, SIZE, all_rows, fit
from asperity.dynamics.scanning_table import CLOSE
from asperity.errors import Tolerance
from asperity.interface.interface import Interface
from asperity.laws import Hertz, Meniscus
from asperity.numerics.polynomials import chebyshev_sum
from asperity.surfaces.heights import Gaussian

RADIUS, BETA, SIGMA, E, N = 50e-6, 0.25e-9, 10.5e-9, 56.8e9, 1.69e16
MENISCUS = Meniscus(BETA, 0.0728, radians(73.0), 2e-9)
BODY = Body(2200.0 * 4.0 / 3.0 * pi * RADIUS**3, 9.81, 60e-9)
IMPACTS = 6


def contact(sigma=SIGMA, ways=10):
    layer = Interface(Hertz(BETA, E) + MENISCUS, Gaussian(sigma), N)
    found = ElasticContact(layer, Sphere(RADIUS), E, 32)
    return dataclasses.replace(found, resolved=found.resolved._replace(reversals=ways))


prepared = eqx.filter_jit(lambda contact, body: prepare(contact, body, many=True))


@eqx.filter_jit
def integrated(contact, body, table, reference):
    begun = start(contact, body, table, reference)
    limits = Limits.of(Tolerance(max_impacts=IMPACTS))
    return integrate_impacts(contact, body, begun, limits, IMPACTS)


@pytest.fixture(scope="module")
def both():
    """The motion by the table of ways, and by ways that are solved as they come."""
    here = contact()
    table, reference = prepared(here, BODY)
    solved = table._replace(reversals=())
    return table, [integrated(here, BODY, t, reference)[1] for t in (table, solved)]


def test_a_motion_by_tabulated_ways_is_that_by_solved_ones(both):
    table, (ours, judge) = both
    assert bool(jnp.all(ours.made))
    assert all(error < CLOSE for error in errors(table.reversals).values())
    energy = float(judge.maximum_kinetic[0])
    assert float(jnp.max(jnp.abs(ours.lost - judge.lost))) < IMPACTS * CLOSE * energy
    np.testing.assert_allclose(ours.apex, judge.apex, rtol=IMPACTS * CLOSE)
    np.testing.assert_allclose(ours.apex_time, judge.apex_time, rtol=IMPACTS * CLOSE)
    # Of as many rings as here the ledger has an error of its own.
    np.testing.assert_allclose(
        ours.energy_balance_error, judge.energy_balance_error, atol=IMPACTS * CLOSE * energy
    )


def errors(reversals):
    """The stated error of each range that is not empty, by its number."""
    used = np.flatnonzero(np.asarray(reversals.high > reversals.low))
    return {int(k): float(reversals.error[k]) for k in used}


def work(low, high, values):
    """Of the force over pieces [J], by quadrature of their polynomials."""
    node, weight = np.polynomial.legendre.leggauss(20)
    force = chebyshev_sum(values[:, :, FORCE].T[:, :, None], jnp.asarray(node))
    return jnp.sum(force @ weight * 0.5 * (high - low))


@eqx.filter_jit
def works(contact, table, place, unloading):
    """Of the scanning curve from a reversal [J]: from the table, and solved on the same mesh.

    Up to the same place: what is left to where the other ends lies on the branch.
    """
    ours = table.reversals.pieces(place, unloading)
    flat = jnp.zeros(contact.rings + 1)
    held = Held(jnp.asarray(True), ~unloading, ours.values[0, 0, SIZE], flat)
    curve = contact.reversals.curve(place, held, jnp.asarray(True), (table.ends[0], table.ends[-1]))
    low, high = jnp.minimum(curve.enter, curve.leave), jnp.maximum(curve.enter, curve.leave)
    values = fit(all_rows(curve.states))
    left = (ours.leave[-1] - curve.leave[-1]) * jnp.where(unloading, 1.0, -1.0)
    left = left * jnp.sum(values[-1, :, FORCE])  # at its end all polynomials are 1
    return work(ours.low, ours.high, ours.values), work(low, high, values) + left


@pytest.mark.long
def test_more_ways_give_a_smaller_error_and_none_more_than_stated(both):
    impact = float(both[1][0].maximum_kinetic[0])
    stated, real = [], []
    for count in (4, 10):
        here = contact(ways=count)
        table, _ = prepared(here, BODY)
        known = table.reversals
        assert list(errors(known)) == [0, 1]
        for k, unloading in enumerate((True, False)):
            low, high = float(known.low[k]), float(known.high[k])
            place = jnp.asarray(low + 0.37 * (high - low))
            ours, judge = works(here, table, place, jnp.asarray(unloading))
            stated.append(float(known.error[k]))
            real.append(abs(float(ours - judge)) / impact)
    for k in range(2):
        assert stated[k] > 100.0 * stated[2 + k]
    assert all(error < limit for error, limit in zip(real, stated, strict=True))


@pytest.mark.parametrize("shrunk", [8.0, 6.0, 4.5])
def test_wide_falls_have_ranges_side_by_side_each_as_good_as_it_says(shrunk):
    """Smoother bodies rest nearer to the plane, and so fall through more rms heights."""
    here = contact(sigma=shrunk * 1e-9)
    table, reference = prepared(here, BODY)
    known = table.reversals
    stated = errors(known)
    assert len(stated) > 2
    outside = sorted(set(stated) - {0})
    np.testing.assert_allclose(known.low[outside[0]], reference.equilibrium, rtol=1e-12)
    np.testing.assert_array_equal(
        known.high[outside[0] : outside[-1]], known.low[outside[1] : outside[-1] + 1]
    )
    top = min(float(table.ends[-1]), float(here.interaction_range))
    np.testing.assert_allclose(known.high[outside[-1]], top, rtol=1e-12)
    impact = 9.81 * BODY.mass * BODY.release
    for k in outside:
        low, high = float(known.low[k]), float(known.high[k])
        place = jnp.asarray(low + 0.37 * (high - low))
        assert bool(known.cover(place, jnp.asarray(False)))
        ours, judge = works(here, table, place, jnp.asarray(False))
        assert abs(float(ours - judge)) < max(stated[k], 1e-13) * impact
    beyond = jnp.asarray(np.nextafter(top, 1.0))
    assert not bool(known.cover(beyond, jnp.asarray(False)))


def test_reversals_far_apart_are_solved_as_they_come():
    """Menisci as long as the heights: no few ways stand for all."""
    here = contact(sigma=1e-9)
    body = Body(BODY.mass, 9.81, 8e-9)
    reversals = prepared(here, body)[0].reversals
    low, high = float(reversals.low[0]), float(reversals.high[0])
    assert not bool(reversals.cover(jnp.asarray(0.5 * (low + high)), jnp.asarray(True)))


@pytest.mark.long
def test_derivatives_pass_through_tabulated_ways():
    """Energy lost in three impacts by the rms height, against a central difference."""

    @jax.jit
    def lost(sigma):
        here = contact()
        here = eqx.tree_at(lambda c: c.interface.heights.rms_height, here, sigma)
        begun = start(here, BODY, *prepare(here, BODY, many=True))
        limits = Limits.of(Tolerance(max_impacts=3))
        return jnp.sum(integrate_impacts(here, BODY, begun, limits, 3)[0].lost)

    sigma, step = jnp.asarray(SIGMA), 2e-3 * SIGMA
    slope = jax.jit(lambda s: jax.jvp(lost, (s,), (jnp.ones(()),))[1])(sigma)
    weights = {-2: 1.0, -1: -8.0, 1: 8.0, 2: -1.0}
    judge = sum(w * float(lost(sigma + k * step)) for k, w in weights.items()) / (12.0 * step)
    assert float(slope) == pytest.approx(judge, rel=1e-4)
