"""Quantities over separation, as Chebyshev polynomials on panels."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from .._jax import jax, jnp
from ..numerics.compilation import kept
from ..numerics.polynomials import NODES, chebyshev_sum, from_points, local, points_between

_TO_COEFFICIENTS = from_points(NODES)
_SQUARES = np.arange(NODES) ** 2.0  # slopes at the upper end
_SLOPE = _SQUARES * (-1.0) ** np.arange(1, NODES + 1)  # at the lower end
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
        Powers with which rows fall above the ends, shape (rows,).
    from_begin
        How far the last end is from where each row's power begins [m], shape (rows,): laws fall
        with the gap plus a length of their own.
    """

    ends: jax.Array
    coefficients: jax.Array
    tails: jax.Array
    from_begin: jax.Array

    @classmethod
    def through(
        cls, ends: jax.Array, rows: list[jax.Array], energy: int | None = None
    ) -> PanelTable:
        """Through values at :func:`places_of` the ends, each of that shape.

        The row of that number is the ``energy``; all others fall as the pressure does.
        """
        tails = jnp.asarray([_TAIL - (number == energy) for number in range(len(rows))])
        return cls._of(ends, jnp.einsum("kn,qpn->kpq", _TO_COEFFICIENTS, jnp.stack(rows)), tails)

    @classmethod
    def _of(cls, ends: jax.Array, coefficients: jax.Array, tails: jax.Array) -> PanelTable:
        """With powers that go on with the slope that rows have at the last end."""
        last, at_end = coefficients[:, -1], ends[-1]
        value, slope = jnp.sum(last, axis=0), 2.0 / (at_end - ends[-2]) * (_SQUARES @ last)
        falls = value * slope < 0.0
        begin = -tails * value / jnp.where(falls, slope, 1.0)
        begin = jnp.where(falls, jnp.clip(begin, 0.5 * at_end, 2.0 * at_end), at_end)
        return cls(ends, coefficients, tails, begin)

    def total(self) -> PanelTable:
        """The sum of all rows, as one."""
        whole = jnp.sum(self.coefficients, axis=2, keepdims=True)
        return PanelTable._of(self.ends, whole, self.tails[:1])

    def __call__(self, separation: jax.Array) -> jax.Array:
        """Values at separations [m] of any shape, rows first."""
        ends, flat = self.ends, jnp.ravel(separation)
        panel = jnp.clip(jnp.searchsorted(ends, flat) - 1, 0, len(ends) - 2)
        x = local(ends[panel], ends[panel + 1], flat)[:, None]
        found = chebyshev_sum(self.coefficients[:, panel], jnp.clip(x, -1.0, 1.0))
        slope = jnp.tensordot(_SLOPE, self.coefficients[:, 0], axes=1)
        below = jnp.minimum(flat - ends[0], 0.0) * 2.0 / (ends[1] - ends[0])
        beyond = 1.0 + jnp.maximum(flat - ends[-1], 0.0)[:, None] / self.from_begin
        found = (found + slope * below[:, None]) * beyond**-self.tails
        return found.T.reshape(-1, *jnp.shape(separation))
