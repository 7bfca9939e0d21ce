"""Summits that feel one another: against boundary elements."""

import equinox as eqx
import numpy as np
import pytest

from asperity._jax import jnp
from asperity.contact.asperity_table import asperity_table
from asperity.contact.coupled_summits import CoupledSummits, influence_between
from asperity.laws import Hertz

TIP, MODULUS = 450e-9, 6.6e10  # m, Pa
CELLS = 25  # of a patch beneath a summit, along each side
DEPTH = 1e-9  # m


def love(x, y, half):
    """Displacement times E* at (x, y) under unit pressure on a square cell (Love 1929)."""

    def term(u, v):
        return u * np.arcsinh(v / np.abs(u))

    total = 0.0
    for sign_x in (1.0, -1.0):
        for sign_y in (1.0, -1.0):
            u, v = x + sign_x * half, y + sign_y * half
            total = total + sign_x * sign_y * (term(u, v) + term(v, u))
    return total / np.pi


def boundary_elements(positions, offsets):
    """Force on each summit [N] at separation 0, with pressure where it presses alone."""
    side = 2.2 * np.sqrt(TIP * offsets.max()) / CELLS
    local = side * (np.arange(CELLS) - CELLS // 2)
    x, y = (grid.ravel() for grid in np.meshgrid(local, local))
    profile = np.concatenate([offset - (x**2 + y**2) / (2.0 * TIP) for offset in offsets])
    cells = np.concatenate([position + np.stack([x, y], axis=1) for position in positions])
    apart = cells[:, None] - cells
    matrix = love(apart[..., 0], apart[..., 1], 0.5 * side) / MODULUS
    on = profile > 0.0
    while True:
        pressure = np.zeros(profile.size)
        pressure[on] = np.linalg.solve(matrix[np.ix_(on, on)], profile[on])
        less = on & ~(pressure < 0.0)
        if np.array_equal(less, on):
            return side**2 * pressure.reshape(len(offsets), -1).sum(axis=1)
        on = less


@eqx.filter_jit
def _forces(summits, positions, offsets):
    radii = jnp.sqrt(TIP * offsets)
    influence = influence_between(positions, radii, jnp.asarray(MODULUS))
    some = CoupledSummits.on(summits, offsets, influence, radii > 0.0)
    none = jnp.zeros((0, len(offsets)), bool)
    return some.equilibrium(jnp.zeros(()), none, -offsets).forces


def coupled(positions, offsets):
    """Force on each summit [N]; nothing on those without an offset."""
    table = asperity_table([Hertz(TIP, MODULUS)], 1e-12)
    summits = table.of(jnp.zeros(len(offsets), jnp.int32))
    return np.asarray(_forces(summits, jnp.asarray(positions), jnp.asarray(offsets)))


@pytest.mark.parametrize(("apart", "close"), [(8.0, 1.5e-3), (3.5, 5e-3), (2.3, 2e-2)])
def test_three_summits_take_from_one_another_what_boundary_elements_find(apart, close):
    """At distances in contact radii, each as a share of what it would carry alone."""
    offsets = DEPTH * np.array([1.0, 0.8, 0.5])
    radius = np.sqrt(TIP * DEPTH)
    positions = apart * radius * np.array([[0.0, 0.0], [1.0, 0.0], [0.3, 1.1]])
    alone = [boundary_elements(positions[[k]], offsets[[k]])[0] for k in range(3)]
    hertz = np.array([coupled(positions, offsets * (np.arange(3) == k))[k] for k in range(3)])
    np.testing.assert_allclose(hertz, 4.0 / 3.0 * MODULUS * TIP**0.5 * offsets**1.5, rtol=1e-7)
    wanted = boundary_elements(positions, offsets) / alone
    found = coupled(positions, offsets) / hertz
    assert np.all(wanted < 1.0 - 0.1 / apart)
    np.testing.assert_allclose(found, wanted, rtol=close)
