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

    The other axes and those of ``x`` broadcast. By Clenshaw's recurrence, degree by degree: XLA
    makes one loop of that, and three times as many steps of a table of the polynomials.
    """
    count = coefficients.shape[0]
    twice = 2.0 * x
    upper = lower = jnp.zeros(jnp.broadcast_shapes(coefficients.shape[1:], x.shape))
    for degree in range(count - 1, 0, -1):
        upper, lower = coefficients[degree] + twice * upper - lower, upper
    return coefficients[0] + x * upper - lower


def antiderivative(coefficients: jax.Array) -> jax.Array:
    """Chebyshev coefficients of the integral over x; first axis the degree."""
    return jnp.tensordot(jnp.asarray(ANTIDERIVATIVE), coefficients, axes=1)
