"""Chebyshev polynomials on an interval: their sums and integrals."""

from __future__ import annotations

import numpy as np
from numpy.polynomial import chebyshev

from ._jax import jax, jnp

NODES = 16
"""Coefficients of each polynomial."""

ANTIDERIVATIVE = np.array([chebyshev.chebint(row) for row in np.eye(NODES)]).T
"""From coefficients to those of the integral over x."""

DERIVATIVE = np.array([chebyshev.chebder(row) for row in np.eye(NODES)]).T
"""From coefficients to those of the derivative with x, one fewer."""


def local(low: jax.Array, high: jax.Array, place: jax.Array) -> jax.Array:
    """Coordinate in [-1, 1] of a place in an interval; 0 where the interval is empty."""
    width = high - low
    safe = jnp.where(width > 0.0, width, 1.0)
    return jnp.where(width > 0.0, (2.0 * place - low - high) / safe, 0.0)


def chebyshev_sum(coefficients: jax.Array, x: jax.Array) -> jax.Array:
    """Sum of Chebyshev polynomials; the coefficients' first axis is the degree.

    The other axes and those of ``x`` broadcast.
    """
    count = coefficients.shape[0]
    rest = max(coefficients.ndim - 1, x.ndim)
    wide = coefficients.reshape(
        count, *(1,) * (rest - coefficients.ndim + 1), *coefficients.shape[1:]
    )
    basis = _basis(count, x.reshape(*(1,) * (rest - x.ndim), *x.shape))
    return jnp.sum(wide * basis, axis=0)


def _basis(count: int, x: jax.Array) -> jax.Array:
    """T_0 to T_(count - 1) at ``x``, first axis the degree: T_(m+j) = 2 T_m T_j - T_(m-j)."""
    basis = jnp.stack([jnp.ones_like(x), x])
    while basis.shape[0] < count:
        top = basis[-1]
        basis = jnp.concatenate([basis, 2.0 * top * basis[1:] - basis[-2::-1]])
    return basis[:count]


def antiderivative(coefficients: jax.Array) -> jax.Array:
    """Chebyshev coefficients of the integral over x; first axis the degree."""
    return jnp.tensordot(jnp.asarray(ANTIDERIVATIVE), coefficients, axes=1)
