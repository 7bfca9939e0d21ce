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

    The other axes and those of ``x`` broadcast. By Clenshaw's recurrence: XLA makes one
    loop of that, and three times as many steps of a table of the polynomials. Even and odd
    degrees apart, in steps of two degrees: half as many that wait for one another.
    """
    twice = 4.0 * x * x - 2.0
    zero = jnp.zeros(jnp.broadcast_shapes(coefficients.shape[1:], x.shape))

    def run(first: int) -> tuple[jax.Array, jax.Array]:
        upper = lower = zero
        last = coefficients.shape[0] - 1
        for degree in range(last - (last - first) % 2, first, -2):
            upper, lower = (coefficients[degree] - lower) + twice * upper, upper
        return upper, lower

    (even, before), (odd, earlier) = run(0), run(1)
    total = (coefficients[0] - before) + 0.5 * twice * even
    if coefficients.shape[0] == 1:
        return total
    return total + x * ((coefficients[1] - earlier) + (twice - 1.0) * odd)


def antiderivative(coefficients: jax.Array) -> jax.Array:
    """Chebyshev coefficients of the integral over x; first axis the degree."""
    return jnp.tensordot(jnp.asarray(ANTIDERIVATIVE), coefficients, axes=1)
