r"""Special functions of rough contact, in JAX.

The *height integral* of order :math:`n > -1` of a standard normal distribution,

.. math:: F_n(\lambda) = \frac{1}{\sqrt{2\pi}} \int_\lambda^\infty
          (s-\lambda)^n e^{-s^2/2}\,\mathrm{d}s ,

gives every mean over Gaussian heights (Greenwood and Williamson 1966). It is a
parabolic cylinder function, :math:`\Gamma(n+1)\,e^{-\lambda^2/4}
D_{-n-1}(\lambda)/\sqrt{2\pi}` (DLMF 12.5.1).
"""

from __future__ import annotations

from functools import cache, partial
from math import gamma, pi, sqrt

import numpy as np
from numpy.polynomial import chebyshev

from .._jax import jax, jnp
from .polynomials import clenshaw

__all__ = ["height_integral", "height_integrals", "integrals_at", "normal_density"]

_SPLIT = -1.0  # left of it the integral grows like |l|^n, right of it it decays like exp(-l^2/2)
_STRETCH = 4.0
_PANELS = 20  # on each side, uniform in y = x/(x + _STRETCH), x = |l - _SPLIT|
_DEGREE = 9
_INV_SQRT_2PI = 1.0 / sqrt(2.0 * pi)


def normal_density(x: jax.Array) -> jax.Array:
    """Standard normal density, 1/sqrt(2 pi) exp(-x^2/2)."""
    return _INV_SQRT_2PI * jnp.exp(-0.5 * x * x)


def height_integral(order: float, separation: jax.Array | float) -> jax.Array:
    r"""Height integral :math:`F_n(\lambda)` of a standard normal distribution.

    Parameters
    ----------
    order
        :math:`n`, any real number above -1; static (not traced).
    separation
        :math:`\lambda = h/\sigma`, any shape, any real value.

    Returns
    -------
    Array of the shape of ``separation``. Relative error below 1e-12 for orders -1/2
    to 3 and separations -8 to 12, and 1e-8 to 37, where it is below 1e-32 (tests). The
    derivative is :math:`-n F_{n-1}`, for order 0 minus the density.
    """
    x = jnp.asarray(separation, dtype=jnp.float64)
    return height_integrals((float(order),), x[None])[0]


def height_integrals(orders: tuple[float, ...], separations: jax.Array) -> jax.Array:
    """Height integrals of several orders at once: row k of ``separations`` has ``orders[k]``.

    One evaluation for all rows costs XLA a fraction of one call each, to compile and to run.
    """
    return integrals_at(tuple((order,) for order in orders), separations)


@partial(jax.custom_jvp, nondiff_argnums=(0,))
def integrals_at(groups: tuple[tuple[float, ...], ...], separations: jax.Array) -> jax.Array:
    """The same for several different orders at each row of ``separations``.

    Row k has the orders ``groups[k]``; the answer has one row for each, group after group.
    """
    if len(groups) != separations.shape[0]:
        raise ValueError(f"{len(groups)} groups of orders for {separations.shape[0]} rows")
    rows = [k for k, orders in enumerate(groups) for _ in orders]
    orders = tuple(order for group in groups for order in group)
    if rows != list(range(separations.shape[0])):
        separations = separations[np.asarray(rows)]
    return _batched_first(_evaluate(orders, separations))


def _batched_first(rows: jax.Array) -> jax.Array:
    """The same, whose batch axis under ``vmap`` comes first.

    In a loop JAX takes it to be where it is in the value when it asks for the derivative.
    """
    return jax.lax.squeeze(jax.lax.broadcast(rows, (1,)), (0,))


@partial(jax.jit, static_argnums=0)
def _evaluate(orders: tuple[float, ...], separations: jax.Array) -> jax.Array:
    """One order a row, traced once for all its callers."""
    known = [row for row, order in enumerate(orders) if order == 0.0]
    if known:
        # The tail of the Gaussian, for which XLA has a function: a fifth of the time.
        tail = 0.5 * jax.lax.erfc(separations[np.asarray(known)] * np.sqrt(0.5))
        others = [row for row, order in enumerate(orders) if order != 0.0]
        if not others:
            return tail
        rest = _evaluate(tuple(orders[row] for row in others), separations[np.asarray(others)])
        place = np.argsort([*known, *others])
        return jnp.concatenate([tail, rest])[place]
    table = np.concatenate([np.concatenate(_tables(order)) for order in orders])
    rows = (len(orders),) + (1,) * (separations.ndim - 1)
    base = 2 * _PANELS * np.arange(len(orders)).reshape(rows)
    is_right = separations >= _SPLIT
    distance = jnp.abs(separations - _SPLIT)
    falls = 1.0 / (distance + _STRETCH)
    position = distance * falls * _PANELS
    index = jnp.clip(jnp.floor(position).astype(int), 0, _PANELS - 1)
    panel = jnp.asarray(base) + jnp.where(is_right, index, index + _PANELS)
    here = jnp.asarray(table).at[panel].get(mode="promise_in_bounds")
    smooth = clenshaw(jnp.moveaxis(here, -1, 0), 2.0 * (position - index) - 1.0)
    # Right of the split the density falls off, left of it the integral grows.
    bounded = jnp.where(is_right, separations, 0.0)
    size = jnp.sqrt(1.0 + jnp.minimum(separations, 0.0) ** 2)
    grown = _powers(size, np.asarray(orders).reshape(rows))
    return smooth * jnp.where(is_right, falls, grown) * jnp.exp(-0.5 * bounded * bounded)


def _powers(base: jax.Array, exponents: np.ndarray) -> jax.Array:
    """Each row of ``base`` to its power: of halves by roots, which cost a third of a logarithm."""
    twice = np.round(2.0 * exponents).astype(int)
    if np.any(twice != 2.0 * exponents):
        return jnp.exp(exponents * jnp.log(base))
    square, power = jnp.sqrt(base), jnp.ones_like(base)
    for bit in range(int(np.max(np.abs(twice))).bit_length()):
        power = jnp.where(np.abs(twice) >> bit & 1, power * square, power)
        square = square * square
    return jnp.where(twice < 0, 1.0 / power, power)


@integrals_at.defjvp
def _integrals_jvp(groups, primals, tangents):  # type: ignore[no-untyped-def]
    (x,), (change,) = primals, tangents
    # F_n' = -n F_(n-1); F_0' = -density; below order 0 from F_(n+1) = n F_(n-1) - l F_n.
    beside = tuple(
        tuple(dict.fromkeys((*group, *(n - 1.0 if n > 0.0 else n + 1.0 for n in group if n))))
        for group in groups
    )
    flat = [(k, order) for k, group in enumerate(beside) for order in group]
    known = dict(zip(flat, integrals_at(beside, x), strict=True))
    here, slopes = [], []
    for k, group in enumerate(groups):
        for n in group:
            value = known[k, n]
            if n > 0.0:
                slope = -n * known[k, n - 1.0]
            elif n < 0.0:
                slope = -(known[k, n + 1.0] + x[k] * value)
            else:
                slope = -normal_density(x[k])
            here.append(value)
            slopes.append(slope * change[k])
    return _batched_first(jnp.stack(here)), _batched_first(jnp.stack(slopes))


@cache
def _tables(order: float) -> tuple[np.ndarray, ...]:
    """Coefficients [panel, degree] of the scaled integral, right and left of the split."""
    if order <= -1:
        raise ValueError(f"`order` must be above -1; got {order}")
    nodes = chebyshev.chebpts1(_DEGREE + 1)
    y = ((np.arange(_PANELS)[:, None] + 0.5 * (nodes + 1.0)) / _PANELS).ravel()
    distance = _STRETCH * y / (1.0 - y)
    right = _quadrature(order, _SPLIT + distance) * (distance + _STRETCH)
    left = _SPLIT - distance
    growth = _quadrature(order, left) * (1.0 + left * left) ** (-0.5 * order)
    shape = (_PANELS, _DEGREE + 1)
    return tuple(
        chebyshev.chebfit(nodes, values.reshape(shape).T, _DEGREE).T for values in (right, growth)
    )


def _quadrature(order: float, separation: np.ndarray) -> np.ndarray:
    """F_n(l), times exp(l^2/2) where l >= -1, by the trapezoidal rule.

    Right side: t = s exp(x - exp(-x)), doubly exponential at 0 (Takahasi and Mori
    1974). Left side, where the density sits far from the singular end: the same with
    the step cut to the width of the density.
    """
    near = separation >= -40.0
    out = np.empty_like(separation)
    # Further left: moments of the density about -x.
    out[~near] = [_moments(order, x) / _INV_SQRT_2PI for x in separation[~near]]
    # Resolve a bump of width 1 at t = depth: its width in y is about 1/(1 + depth).
    depth = np.maximum(-separation[near], 0.0)
    fine = 2.0 ** np.ceil(np.log2(1.0 + depth))  # few step sizes, so that many places share one
    values = np.empty_like(depth)
    for share in np.unique(fine):
        chosen = fine == share
        x = separation[near][chosen][:, None]
        y = np.arange(-4.2, 4.0 + (share > 7.0), min(0.03, 0.25 / share))
        t = 2.0 / (x + np.sqrt(x * x + 4.0)) * np.exp(y - np.exp(-y))
        exponent = -0.5 * t * t - x * t - np.where(x >= _SPLIT, 0.0, 0.5 * x * x)
        terms = np.exp(exponent) * t ** (order + 1.0) * (1.0 + np.exp(-y))
        values[chosen] = (y[1] - y[0]) * np.sum(terms, axis=1)
    out[near] = values
    return out * _INV_SQRT_2PI


def _moments(order: float, separation: float) -> float:
    """E[(Z - l)^n] for l << 0: the binomial series in even moments of Z."""
    total, term = 0.0, 1.0
    for k in range(8):
        total += term
        term *= (order - 2 * k) * (order - 2 * k - 1) / (2.0 * (k + 1)) / separation**2
    return total * abs(separation) ** order


def order_ratio(order: float, lifts: int) -> float:
    r"""Gamma(n+1)/Gamma(n+k+1): the factor of k integrations of t^n over its edge."""
    return gamma(order + 1.0) / gamma(order + lifts + 1.0)
