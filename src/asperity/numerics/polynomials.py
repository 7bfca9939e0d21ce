"""Polynomials: Chebyshev sums and their integrals, quintics by their ends, sums of powers."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.polynomial import chebyshev

from .._jax import jax, jnp

NODES = 16
"""Coefficients of each polynomial."""

ANTIDERIVATIVE = chebyshev.chebint(np.eye(NODES))
"""From coefficients to those of the integral over x."""

DERIVATIVE = chebyshev.chebder(np.eye(NODES))
"""From coefficients to those of the derivative with x, one fewer."""


def points_between(nodes: int) -> np.ndarray:
    """So many Chebyshev points between 0 and 1."""
    points: np.ndarray = 0.5 * (1.0 + chebyshev.chebpts1(nodes))
    return points


def from_points(nodes: int) -> np.ndarray:
    """From values at so many Chebyshev points in [-1, 1] to as many coefficients."""
    return np.linalg.inv(chebyshev.chebvander(chebyshev.chebpts1(nodes), nodes - 1))


def quintic(
    start: tuple[jax.Array, jax.Array, jax.Array], end: tuple[jax.Array, jax.Array, jax.Array]
) -> jax.Array:
    """Coefficients of powers of t, last axis, from value, slope and curvature at t = 0 and 1."""
    (f0, d0, c0), (f1, d1, c1) = start, end
    rise = f1 - f0
    rows = (
        f0,
        d0,
        0.5 * c0,
        10.0 * rise - 6.0 * d0 - 4.0 * d1 - 1.5 * c0 + 0.5 * c1,
        -15.0 * rise + 8.0 * d0 + 7.0 * d1 + 1.5 * c0 - c1,
        6.0 * rise - 3.0 * (d0 + d1) - 0.5 * (c0 - c1),
    )
    return jnp.stack(rows, axis=-1)


def local(low: Any, high: Any, place: Any) -> Any:
    """Coordinate in [-1, 1] of a place in an interval; 0 where the interval is empty.

    Of arrays of either library.
    """
    width, twice = high - low, 2.0 * place - low - high
    where = jnp.where if isinstance(twice, jax.Array) else np.where
    return where(width > 0.0, twice / where(width > 0.0, width, 1.0), 0.0)


@jax.jit  # traced once for each shape
def chebyshev_sum(coefficients: jax.Array, x: jax.Array) -> jax.Array:
    """Sum of Chebyshev polynomials; the coefficients' first axis is the degree.

    The other axes and those of ``x`` broadcast. By Clenshaw's recurrence: XLA makes one
    loop of that, and three times as many steps of a table of the polynomials. Even and odd
    degrees side by side, in steps of two degrees: half as many that wait for one another, and
    half as many to compile.
    """
    count, shape = coefficients.shape[0], jnp.broadcast_shapes(coefficients.shape[1:], x.shape)
    if count == 1:
        return jnp.broadcast_to(coefficients[0], shape)
    odd = count % 2  # then the first goes alone, and each odd degree with the even one above
    alike = (1,) * (len(shape) + 1 - coefficients.ndim)
    pairs = coefficients[odd:].reshape(count // 2, 2, *alike, *coefficients.shape[1:])
    twice = 4.0 * x * x - 2.0
    upper = lower = jnp.zeros((1, 2, *shape))
    for k in range(count // 2 - 1, -odd, -1):
        upper, lower = (pairs[k : k + 1] - lower) + twice * upper, upper
    if odd:
        even = (coefficients[0] - lower[0, 1]) + 0.5 * twice * upper[0, 1]
        return even + x * (upper[0, 0] - lower[0, 0])
    first = pairs[:1] - lower
    even = first[0, 0] + 0.5 * twice * upper[0, 0]
    return even + x * (first[0, 1] + (twice - 1.0) * upper[0, 1])


def clenshaw(coefficients: jax.Array, x: jax.Array) -> jax.Array:
    """The same degree by degree, which XLA fuses with coefficients that are gathered."""
    above, here = jnp.zeros_like(x), jnp.zeros_like(x)
    for k in range(coefficients.shape[0] - 1, 0, -1):
        above, here = here, coefficients[k] + 2.0 * x * here - above
    return coefficients[0] + x * here - above


def antiderivative(coefficients: jax.Array) -> jax.Array:
    """Chebyshev coefficients of the integral over x; first axis the degree."""
    return jnp.tensordot(jnp.asarray(ANTIDERIVATIVE), coefficients, axes=1)


def power_sum(coefficients: np.ndarray, x: Any) -> Any:
    """Sum of powers of x, from the constant on, by Horner's rule; of arrays of either library."""
    value = coefficients[-1]
    for coefficient in coefficients[-2::-1]:
        value = value * x + coefficient
    return value
