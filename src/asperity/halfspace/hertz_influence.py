"""Displacement of an elastic half-space beside a Hertz contact."""

from __future__ import annotations

from math import pi

from .._jax import jax, jnp

_SMALL = 0.1  # contact radius over distance, below which the series is as good
_CLOSE = 1e-30  # m, for what lies on one axis


def hertz_influence(distance: jax.Array, radius: jax.Array) -> jax.Array:
    r"""Displacement [m] times E* beside a Hertz contact that carries 1 N, in 1/m.

    Parameters
    ----------
    distance
        Distance r from its axis [m].
    radius
        Its contact radius a [m].

    Notes
    -----
    Outside the contact (Johnson 1985, eq. 3.42a)

    .. math:: \frac{u E^*}{F} = \frac{3}{4\pi a^3}
              \left((2a^2 - r^2)\arcsin\frac{a}{r} + a\sqrt{r^2 - a^2}\right)

    which is 1.178, 1.027 and 1.012 times that of a point load, :math:`1/(\pi r)`, at r of 1, 2 and
    3 a; within it :math:`3 (2a^2 - r^2)/(8 a^3)`.
    """
    far = jnp.maximum(distance, _CLOSE)
    share = radius / far
    squared = jnp.minimum(share, _SMALL) ** 2
    point = 1.0 / (pi * far)
    series = point * (1.0 + squared * (0.1 + squared * (9.0 / 280.0 + squared * 5.0 / 336.0)))
    near = jnp.clip(share, _SMALL, 1.0)
    bracket = (2.0 * near**2 - 1.0) * jnp.arcsin(near) + near * jnp.sqrt(1.0 - near**2)
    outside = point * 0.75 / near**3 * bracket
    length = jnp.maximum(radius, _CLOSE)
    inside = 0.375 * (2.0 - (distance / length) ** 2) / length
    return jnp.where(share > 1.0, inside, jnp.where(share > _SMALL, outside, series))
