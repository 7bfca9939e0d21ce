"""Factors of the matrix by which rings settle."""

from __future__ import annotations

from typing import NamedTuple

from .._jax import jax, jnp
from ..halfspace import ring_mesh

SOFT = 0.02
"""Rates of separation this near to 1: the matrix changes too little along a path."""


class Matrix(NamedTuple):
    """I - C diag(slope), factorized; the mesh's end carries no pressure itself.

    Attributes
    ----------
    factors, order, last, slope
        The factors, the order of their rows, the row of the end, and the slope.
    rates
        Rate of the separation of the rings and of the end per rigid separation.
    """

    factors: jax.Array
    order: jax.Array
    last: jax.Array
    slope: jax.Array
    rates: jax.Array

    @classmethod
    def of(cls, rows: jax.Array, slope: jax.Array) -> Matrix:
        """The matrix of a displacement per pressure and the slope of the pressure."""
        scaled = rows * slope
        factors, order = _factors(jnp.eye(len(slope)) - scaled[:-1])
        ones = jnp.ones(len(slope) + 1)
        matrix = cls(factors, order, scaled[-1], slope, ones)
        return matrix._replace(rates=matrix.back(ones))

    @classmethod
    def blank(cls, rings: int) -> Matrix:
        """Of no known solution."""
        count = len(ring_mesh(rings).radius)
        none = jnp.zeros(count)
        rates = jnp.full(count + 1, jnp.nan)
        return cls(jnp.eye(count), jnp.arange(count, dtype=jnp.int32), none, none, rates)

    @property
    def serves(self) -> jax.Array:
        """Whether it may serve for a solution near its own: where the bulk hardly gives way."""
        return jnp.max(jnp.abs(self.rates - 1.0)) < SOFT

    def back(self, right: jax.Array) -> jax.Array:
        """Its inverse times ``right``."""
        inner = _substitute(self.factors, self.order, right[:-1])
        return jnp.append(inner, right[-1] + self.last @ inner)


# A batch of systems one after the other: XLA's batched calls are slower within a loop.


@jax.custom_batching.sequential_vmap
def _factors(matrix: jax.Array) -> tuple[jax.Array, jax.Array]:
    factors, pivots, _ = jax.lax.linalg.lu(matrix)
    rows = jnp.arange(len(pivots), dtype=pivots.dtype)
    # Next to no matrix here needs an exchange of rows, and to find their order takes as long as
    # half the factors.
    order = jax.lax.cond(
        jnp.all(pivots == rows),
        lambda: rows,
        lambda: jax.lax.linalg.lu_pivots_to_permutation(pivots, len(pivots)),
    )
    return factors, order


@jax.custom_batching.sequential_vmap
def _substitute(factors: jax.Array, order: jax.Array, right: jax.Array) -> jax.Array:
    solve = jax.lax.linalg.triangular_solve
    column = right[order][:, None]
    below = solve(factors, column, left_side=True, lower=True, unit_diagonal=True)
    return solve(factors, below, left_side=True, lower=False)[:, 0]


@jax.custom_batching.sequential_vmap
def dense_solve(matrix: jax.Array, right: jax.Array) -> jax.Array:
    """Solution of a linear system, one of a batch after the other."""
    return jnp.linalg.solve(matrix, right[:, None])[:, 0]
