"""Liquid bridge of constant volume between a sphere and a plane: force, energy, rupture.

Functions only: a law says when a bridge forms and which volume it then keeps. Arguments:

gap
    From the sphere to the plane [m]. Where it is negative they overlap; the force keeps its
    value at touch, and the energy goes on in a straight line.
volume
    Of the liquid [m^3], above 0.
radius
    Of the sphere [m]. Half of it serves two equal spheres, except in `rupture_distance`.
tension
    Surface tension of the liquid [N/m].
contact_angle
    With both solids [rad], from 0 to below pi/2.

Arrays of any shapes that broadcast. Everything works under ``jit``, ``vmap`` and ``grad``. The
errors quoted are found by the Young-Laplace equation in ``tests/validation``, for contact angles
from 0 to 80 degrees, volumes from 1e-4 to 0.1 radius^3, and gaps up to 0.9 of rupture.
"""

from __future__ import annotations

from math import pi

from ..._jax import jax, jnp
from ..law import Real


def rupture_distance(volume: Real, radius: Real, contact_angle: Real) -> jax.Array:
    """Largest gap [m] at which a bridge of this volume is stable.

    Notes
    -----
    With s = sin(contact angle) and v = V^(1/3)/radius it is

        V^(1/3) (1 + 0.396 s + 0.089 s^2)/(1 + 0.23 v + 0.195 s v^(2/3)).

    The form is physical: a small bridge sees two planes, so its one length is V^(1/3). Between
    planes a bridge of a contact angle above 31 degrees gives way to one side, up or down
    (Vogel 2005); the curvature of the sphere takes that side, and shortens the bridge by the
    power 2/3 of a branching that is disturbed. The four numbers are fitted to solutions of the
    Young-Laplace equation. Largest error, for contact angles from 0 to 80 degrees: 2.0 % for
    V/radius^3 from 1e-4 to 0.1; 2.3 % from 1e-9 to 0.1. At V = radius^3 it is up to 9 % short.
    """
    width = jnp.cbrt(jnp.asarray(volume, dtype=jnp.float64))
    sine, relative = jnp.sin(jnp.asarray(contact_angle)), width / radius
    small = width * (1.0 + 0.396 * sine + 0.089 * sine**2)
    return small / (1.0 + 0.23 * relative + 0.195 * sine * jnp.cbrt(relative) ** 2)


def force(gap: Real, volume: Real, radius: Real, tension: Real, contact_angle: Real) -> jax.Array:
    """Force [N] of the bridge, negative where it pulls.

    Notes
    -----
    The slope of `energy`. With the height H = sqrt(g^2 + V/(pi R)) and the radius
    x = sqrt(2 R (H - g)) of the liquid's edge, and its `edge_energy` per tension and area, e:

        F = -2 pi x tension (cos(angle) x/H + e (g/H - 1/2)).

    The first term is `leading_force`; the second is smaller by H/x, and is what the pull loses
    at touch and gains when the bridge is long. Largest error 2.7 % of the leading pull at touch,
    4 pi R tension cos(angle), where the leading force is wrong by up to 87 % of that. Of itself
    the force is wrong by 22 % near rupture, where little of it is left. A liquid that bulges
    may push, as it should: at touch and 80 degrees from V = 0.18 radius^3.
    """
    apart = jnp.maximum(jnp.asarray(gap, dtype=jnp.float64), 0.0)
    height, width = _edge(apart, volume, radius)
    leading = jnp.cos(jnp.asarray(contact_angle)) * width / height
    of_edge = edge_energy(contact_angle) * (apart / height - 0.5)
    return -2.0 * pi * tension * width * (leading + of_edge)


def energy(gap: Real, volume: Real, radius: Real, tension: Real, contact_angle: Real) -> jax.Array:
    """Energy [J] spent on drawing the bodies apart from touch to this gap.

    Notes
    -----
    Of the surface energy -2 pi tension cos(angle) x^2 + 2 pi x H e tension, the change since
    g = 0; letters as in `force`. Largest error 2 %, of `leading_energy` 36 %.
    """
    gap = jnp.asarray(gap, dtype=jnp.float64)
    values = (volume, radius, tension, contact_angle)
    touch = jnp.zeros_like(gap)
    change = _surface_energy(jnp.maximum(gap, 0.0), *values) - _surface_energy(touch, *values)
    return change - jnp.minimum(gap, 0.0) * force(touch, *values)


def edge_energy(contact_angle: Real) -> jax.Array:
    """Surface energy of the liquid's edge, over the tension and the area of an upright edge.

    Notes
    -----
    (pi - 2 angle + sin(2 angle))/(4 cos(angle)): the arc between two parallel walls, less the
    wetting of both walls out to it from an upright edge that holds the same liquid. From pi/4
    at complete wetting to 1 at a right angle.
    """
    angle = jnp.asarray(contact_angle, dtype=jnp.float64)
    return (pi - 2.0 * angle + jnp.sin(2.0 * angle)) / (4.0 * jnp.cos(angle))


def leading_force(
    gap: Real, volume: Real, radius: Real, tension: Real, contact_angle: Real
) -> jax.Array:
    """Force [N] of a bridge much thinner than wide, negative where it pulls.

    Notes
    -----
    -4 pi R tension cos(angle) (1 - g/sqrt(g^2 + V/(pi R))): the pressure 2 cos(angle) tension/H
    of an edge of height H, over the wetted disc (Rabinovich, Esayanur and Moudgil 2005, without
    their term of the ring of tension, which makes it worse).
    """
    apart = jnp.maximum(jnp.asarray(gap, dtype=jnp.float64), 0.0)
    height, width = _edge(apart, volume, radius)
    return -2.0 * pi * tension * jnp.cos(jnp.asarray(contact_angle)) * width**2 / height


def leading_energy(
    gap: Real, volume: Real, radius: Real, tension: Real, contact_angle: Real
) -> jax.Array:
    """Energy [J] spent against `leading_force` from touch to this gap."""
    gap = jnp.asarray(gap, dtype=jnp.float64)
    touch = jnp.zeros_like(gap)
    _, width = _edge(jnp.maximum(gap, 0.0), volume, radius)
    _, widest = _edge(touch, volume, radius)
    change = 2.0 * pi * tension * jnp.cos(jnp.asarray(contact_angle)) * (widest**2 - width**2)
    at_touch = leading_force(touch, volume, radius, tension, contact_angle)
    return change - jnp.minimum(gap, 0.0) * at_touch


def _edge(gap: jax.Array, volume: Real, radius: Real) -> tuple[jax.Array, jax.Array]:
    """Height and radius [m] of an upright edge that holds the volume, at a gap not below 0."""
    height = jnp.sqrt(gap**2 + volume / (pi * radius))
    # 2 R (H - g), but not as a difference: of a small bridge H and g are nearly equal
    return height, jnp.sqrt(2.0 * volume / (pi * (height + gap)))


def _surface_energy(
    gap: jax.Array, volume: Real, radius: Real, tension: Real, contact_angle: Real
) -> jax.Array:
    height, width = _edge(gap, volume, radius)
    wetting = jnp.cos(jnp.asarray(contact_angle)) * width**2
    return 2.0 * pi * tension * (width * height * edge_energy(contact_angle) - wetting)
