"""Quantities over separation, as Chebyshev polynomials on panels."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from .._jax import jax, jnp
from ..numerics.compilation import kept
from ..numerics.polynomials import NODES, chebyshev_sum, from_points, local, points_between

_TO_COEFFICIENTS = from_points(NODES)
_SLOPE = np.arange(NODES) ** 2 * (-1.0) ** np.arange(1, NODES + 1)  # at the lower end
_TAIL = 2.0  # power with which attraction across a gap falls: that of an asperity, beyond the table


def places_of(ends: jax.Array) -> jax.Array:
    """Separations [m] at which values are asked for, shape (panels, NODES)."""
    return ends[:-1, None] + jnp.diff(ends)[:, None] * points_between(NODES)


@kept
class PanelTable(NamedTuple):
    """Rows of quantities, read from polynomials.

    Attributes
    ----------
    ends
        Ends of the panels [m], ascending. Below them values go on along their slope.
    coefficients
        Shape (NODES, panels, rows).
    tails
        Powers of the separation with which rows fall above the ends, shape (rows,).
    """

    ends: jax.Array
    coefficients: jax.Array
    tails: jax.Array

    @classmethod
    def through(
        cls, ends: jax.Array, rows: list[jax.Array], energy: int | None = None
    ) -> PanelTable:
        """Through values at :func:`places_of` the ends, each of that shape.

        The row of that number is the ``energy``; all others fall as the pressure does.
        """
        tails = jnp.asarray([_TAIL - (number == energy) for number in range(len(rows))])
        return cls(ends, jnp.einsum("kn,qpn->kpq", _TO_COEFFICIENTS, jnp.stack(rows)), tails)

    def total(self) -> PanelTable:
        """The sum of all rows, as one."""
        whole = jnp.sum(self.coefficients, axis=2, keepdims=True)
        return PanelTable(self.ends, whole, self.tails[:1])

    def __call__(self, separation: jax.Array) -> jax.Array:
        """Values at separations [m] of any shape, rows first."""
        ends, flat = self.ends, jnp.ravel(separation)
        panel = jnp.clip(jnp.searchsorted(ends, flat) - 1, 0, len(ends) - 2)
        x = local(ends[panel], ends[panel + 1], flat)[:, None]
        found = chebyshev_sum(self.coefficients[:, panel], jnp.clip(x, -1.0, 1.0))
        slope = jnp.tensordot(_SLOPE, self.coefficients[:, 0], axes=1)
        below = jnp.minimum(flat - ends[0], 0.0) * 2.0 / (ends[1] - ends[0])
        beyond = jnp.maximum(flat / ends[-1], 1.0)
        found = (found + slope * below[:, None]) * beyond[:, None] ** -self.tails
        return found.T.reshape(-1, *jnp.shape(separation))
