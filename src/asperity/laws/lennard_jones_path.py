"""The path of all equilibria of two bodies under the Lennard-Jones pressure, read from a table.

In reduced units: gaps in spacings, forces in w R, energies in w R eps, with w the work of adhesion,
R the radius and eps the spacing. ``tools/lennard_jones.py`` solves them and makes the table.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from functools import cache
from pathlib import Path
from typing import NamedTuple

import numpy as np

from .._jax import jax, jnp
from ..numerics.polynomials import chebyshev_sum, local

TABLE = Path(__file__).with_name("lennard_jones.npy")
"""Chebyshev coefficients of all equilibria, from ``tools/lennard_jones.py``.

Their axes: panel of ln mu, its degree, panel of the measure, its degree, and the row: gap, force,
force where the pressure presses, energy.
"""

NODES = 10
"""Coefficients along a panel of the measure."""

DEGREES = 8
"""Coefficients along a panel of ln mu."""

TABOR_NUMBERS = np.array([0.01, 0.03, 0.1, 0.3, 0.7, 1.0, 1.4, 2.0, 3.0, 5.0])
"""Tabor numbers at which the panels of the table end."""

MEASURES = np.concatenate(
    [
        np.linspace(-22.0, -2.0, 9)[:-1],
        np.linspace(-2.0, 0.0, 5)[:-1],
        np.linspace(0.0, 2.5, 21)[:-1],
        np.linspace(2.5, 4.0, 7)[:-1],
        np.linspace(4.0, 12.2, 13),
    ]
)
"""Where the panels end along a path. The measure grows along it, from far apart to deep contact."""

GAP, FORCE, PRESSED, ENERGY = range(4)
"""Rows of the table."""


class Equilibria(NamedTuple):
    """All equilibria at one Tabor number, in reduced units.

    Attributes
    ----------
    coefficients
        Of the rows of the table, and of their slopes with the measure; shape (NODES, panels, 8).
    """

    coefficients: jax.Array

    def read(self, measure: jax.Array) -> tuple[jax.Array, jax.Array]:
        """All rows at measures, and their slopes, rows first; outside the table at its ends."""
        at = self._rows(measure, range(8))(measure)
        return jnp.stack(at[:4]), jnp.stack(at[4:])

    def gap(self, measure: jax.Array) -> tuple[jax.Array, ...]:
        """The gap at measures, and its slope."""
        return self.gap_within(measure)(measure)

    def gap_within(self, near: jax.Array) -> Callable[[jax.Array], tuple[jax.Array, ...]]:
        """The same at measures, each of the panel that the one of ``near`` beside it is on."""
        return self._rows(near, (GAP, 4 + GAP))

    def _rows(
        self, near: jax.Array, numbers: Iterable[int]
    ) -> Callable[[jax.Array], tuple[jax.Array, ...]]:
        """Some rows at measures, each of the panel that the one of ``near`` beside it is on.

        Each by itself: that takes half the time of all in one array.
        """
        ends = jnp.asarray(MEASURES)
        panel = jnp.clip(jnp.searchsorted(ends, near) - 1, 0, len(MEASURES) - 2)
        low, high = ends[panel], ends[panel + 1]
        chosen = [self.coefficients[:, panel, number] for number in numbers]

        def at(measure: jax.Array) -> tuple[jax.Array, ...]:
            x = jnp.clip(local(low, high, measure), -1.0, 1.0)
            return tuple(chebyshev_sum(row, x) for row in chosen)

        return at

    def energy_over_gaps(self, measure: jax.Array) -> jax.Array:
        """Integral of the energy over the gap, from a measure outwards to the path's begin.

        Exact for the polynomials of a panel.
        """
        ends = jnp.asarray(MEASURES)
        panel = jnp.clip(jnp.searchsorted(ends, measure) - 1, 0, len(MEASURES) - 2)
        whole = self._energy_on_panels(jnp.arange(len(MEASURES) - 1), ends[1:])
        before = jnp.append(0.0, jnp.cumsum(whole))
        return before[panel] + self._energy_on_panels(panel, measure)

    def _energy_on_panels(self, panel: jax.Array, measure: jax.Array) -> jax.Array:
        """From the begin of each one's panel to a measure on it."""
        low = jnp.asarray(MEASURES)[panel]
        node, weight = (x.reshape(-1, *(1,) * panel.ndim) for x in _ON_PANEL)
        places = low + (measure - low) * node
        energy, slope = self._rows(places, (ENERGY, 4 + GAP))(places)
        return -(measure - low) * jnp.sum(weight * energy * slope, axis=0)


def _nodes_on_panel() -> tuple[np.ndarray, np.ndarray]:
    """Nodes and weights on [0, 1] that integrate the product of a row and a slope exactly."""
    node, weight = np.polynomial.legendre.leggauss(NODES)
    return 0.5 * (node + 1.0), 0.5 * weight


_ON_PANEL = _nodes_on_panel()

_SLOPE = np.array([np.polynomial.chebyshev.chebder(row) for row in np.eye(NODES)]).T
"""From coefficients to those of the slope with x, one fewer."""


@cache
def _table() -> np.ndarray:
    return np.asarray(np.load(TABLE, allow_pickle=False))


@cache
def largest_gap() -> float:
    """A reduced gap that all paths begin beyond, where bodies hardly deform each other."""
    return 0.99 * float(np.polynomial.chebyshev.chebval(-1.0, _table()[0, 0, 0, :, GAP]))


@cache
def smallest_gap() -> float:
    """A reduced gap which all paths reach."""
    ends = np.polynomial.chebyshev.chebval(1.0, _table()[:, 0, -1, :, GAP].T)
    return 0.999 * float(np.max(ends))


@jax.jit
def path_at(log_tabor: jax.Array) -> Equilibria:
    """All equilibria at one Tabor number."""
    ends = jnp.asarray(np.log(TABOR_NUMBERS))
    panel = jnp.clip(jnp.searchsorted(ends, log_tabor) - 1, 0, len(TABOR_NUMBERS) - 2)
    chosen = jnp.asarray(_table())[panel]

    found = chebyshev_sum(chosen, local(ends[panel], ends[panel + 1], log_tabor))
    slope = np.concatenate([_SLOPE, np.zeros((1, NODES))])
    slopes = jnp.einsum("kn,xnr,x->xkr", slope, found, 2.0 / np.diff(MEASURES))
    return Equilibria(jnp.swapaxes(jnp.concatenate([found, slopes], axis=-1), 0, 1))
