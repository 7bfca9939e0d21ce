"""Where a contact carries a weight, and where it ends: against NumPy's roots of the same series."""

from itertools import pairwise
from types import SimpleNamespace

import numpy as np
import pytest
from numpy.polynomial import Chebyshev

from asperity._jax import jax, jnp
from asperity.dynamics.curve_table import FORCE, STORED
from asperity.dynamics.external_forces import Load
from asperity.dynamics.static_equilibrium import _outermost, end_of_contact, find_reference

ENDS = np.array([0.0, 1.0, 2.5, 4.0])


def series(function):
    """Chebyshev coefficients of a function on each panel."""
    return np.stack([Chebyshev.interpolate(function, 15, pair).coef for pair in pairwise(ENDS)])


def table(function, stored=lambda x: 0.0 * x):
    values = np.zeros((1, 3, 16, STORED + 1))
    values[0, :, :, FORCE], values[0, :, :, STORED] = series(function), series(stored)
    return SimpleNamespace(ends=jnp.asarray(ENDS), values=jnp.asarray(values))


def wave(x):
    return np.exp(-0.7 * x) * np.cos(3.0 * x) - 0.02 * x


def outermost(function, level):
    """The largest root at which a series falls through a level outwards."""
    ends = zip(series(function), ENDS[:-1], ENDS[1:], strict=True)
    falls = [
        root.real
        for row, *panel in ends
        for root in (Chebyshev(row, panel) - level).roots()
        if abs(root.imag) < 1e-12 and panel[0] <= root.real <= panel[1]
        if Chebyshev(row, panel).deriv()(root.real) < 0.0
    ]
    return max(falls)


def found(rows, level):
    return _outermost(jnp.asarray(ENDS), jnp.asarray(rows), lambda force, _: force - level)


@pytest.mark.parametrize("level", [0.0, 0.01, 0.1, 0.5, 0.99])
def test_the_outermost_place_is_the_root_of_the_series(level):
    place, panel, holds = found(series(wave), level)
    assert bool(holds)
    assert float(place) == pytest.approx(outermost(wave, level), rel=1e-13)
    assert ENDS[int(panel)] <= float(place) <= ENDS[int(panel) + 1]


def test_a_root_at_the_end_of_a_panel_is_found():
    place, *_ = found(series(lambda x: 2.5 - x), 0.0)
    assert float(place) == pytest.approx(2.5, rel=1e-14)


def test_a_force_that_jumps_between_panels_ends_there():
    rows = series(lambda x: 1.0 + 0.0 * x)
    rows[2] = 0.0
    place, panel, holds = found(rows, 0.5)
    assert (float(place), int(panel), bool(holds)) == (2.5, 1, True)


def test_where_it_holds_at_the_outer_end_that_is_the_place():
    place, _, holds = found(series(np.cosh), 1.0)
    assert (float(place), bool(holds)) == (4.0, True)


def test_nowhere_is_said():
    assert not bool(found(series(wave), 2.0)[2])


def test_a_batch_finds_what_each_alone_does():
    levels = jnp.asarray([0.0, 0.1, 2.0, 0.99])
    rows = jnp.asarray(series(wave))
    together = jax.vmap(lambda level: found(rows, level))(levels)
    for n, level in enumerate(levels):
        alone = found(rows, level)
        assert bool(together[2][n]) == bool(alone[2])
        if bool(alone[2]):
            assert float(together[0][n]) == pytest.approx(float(alone[0]), rel=1e-14)


@pytest.mark.parametrize("derivative", [jax.jacfwd, jax.jacrev])
def test_the_reference_has_derivatives_in_both_modes(derivative):
    """With respect to the weight and to the force: -F_theta / F_d at the root."""
    here = table(wave, stored=np.sin)

    def place(weight, more):
        values = here.values.at[..., 0, FORCE].add(more)
        found = find_reference(SimpleNamespace(ends=here.ends, values=values), Load(weight), 0)
        return jnp.stack([found.equilibrium, found.stored])

    root = outermost(wave, 0.1)
    slope = (wave(root + 1e-6) - wave(root - 1e-6)) / 2e-6
    by_weight, by_force = derivative(place, (0, 1))(0.1, 0.0)
    np.testing.assert_allclose(by_weight, [1.0 / slope, np.cos(root) / slope], rtol=1e-6)
    np.testing.assert_allclose(by_force, -np.asarray(by_weight), rtol=1e-12)


@pytest.mark.parametrize("derivative", [jax.jacfwd, jax.jacrev])
def test_the_end_of_contact_has_derivatives_in_both_modes(derivative):
    """By the peak: the place where a force exp(-4 x) is a millionth of it."""
    here = table(lambda x: np.exp(-4.0 * x))
    place = float(end_of_contact(here, jnp.asarray(2.0)))
    assert place == pytest.approx(-0.25 * np.log(2e-6), rel=1e-6)
    slope = derivative(lambda peak: end_of_contact(here, peak))(2.0)
    assert float(slope) == pytest.approx(-0.125, rel=1e-3)
