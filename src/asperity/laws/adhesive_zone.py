"""Equilibrium of an adhesive zone around a contact, in reduced units.

Lengths along the axis are in (9 pi^2 w^2 R/(16 E*^2))^(1/3), those across it in the square root
of R times that, forces in pi w R; `l` is the elasticity parameter lambda. With t the tangent of
half the angle arccos(a/c), everything but the angle itself is rational in t, and no difference
of nearly equal numbers is left.
"""

from __future__ import annotations

from collections.abc import Callable
from math import pi
from typing import Any, NamedTuple

import numpy as np
from numpy.polynomial import chebyshev, legendre

from .._jax import jax, jnp
from ..numerics.polynomials import power_sum

_X, _WEIGHT = (np.asarray(a) for a in legendre.leggauss(30))


def _slack(x: np.ndarray) -> np.ndarray:
    """(1 + t^2) (1 - arctan(t)/t)/t^2 at x = 2 t^2 - 1, as an integral: nothing cancels."""
    square, node = 0.5 * (np.asarray(x)[..., None] + 1.0), 0.25 * (_X + 1.0) ** 2
    found: np.ndarray = ((1.0 + square) * node / (1.0 + square * node)) @ (0.5 * _WEIGHT)
    return found


def _fitted(values: Callable[[np.ndarray], np.ndarray], degree: int) -> np.ndarray:
    """Coefficients of the powers of x in [-1, 1], by interpolation at Chebyshev's points."""
    x = chebyshev.chebpts1(degree + 1)
    found: np.ndarray = chebyshev.cheb2poly(chebyshev.chebfit(x, values(x), degree))
    return found


_SLACK = _fitted(_slack, 20)


class Zone(NamedTuple):
    """What the angle phi = arccos(a/c) stands for.

    Attributes
    ----------
    angle, sine, cosine
        phi and its functions.
    rise
        1 - cos.
    segment
        phi - sin cos.
    pull, gape
        sin cos - phi cos(2 phi) and phi sin + cos - 1: the parts of the first equation that
        go with c^2 and with c.
    bend
        2 (1 - cos) - phi sin.
    """

    angle: Any
    sine: Any
    cosine: Any
    rise: Any
    segment: Any
    pull: Any
    gape: Any
    bend: Any


def _zone(t: Any, sine: Any, cosine: Any) -> Zone:
    """Everything from the tangent of half the angle, its sine and its cosine."""
    square = t * t
    # A quotient is where the compiler cuts: the polynomial is evaluated once for all its uses.
    slack = power_sum(_SLACK, 2.0 * square - 1.0) / (1.0 + square)
    ratio, rise = 1.0 - square * slack, t * sine
    cubic, whole = 0.5 * sine * rise, (1.0 + square) ** 2 * slack
    return Zone(
        angle=2.0 * t * ratio,
        sine=sine,
        cosine=cosine,
        rise=rise,
        segment=cubic * (3.0 + square - whole),
        pull=cubic * (8.0 * ratio + whole - 3.0 - square),
        gape=rise * (2.0 * ratio - 1.0),
        bend=2.0 * rise * square * slack,
    )


def _of_tangent(t: Any) -> Zone:
    share = 1.0 / (1.0 + t * t)
    return _zone(t, 2.0 * t * share, (1.0 - t * t) * share)


def of_radii(inner: jax.Array, flank: jax.Array) -> tuple[jax.Array, Zone]:
    """Outer radius c, and the angle, of a and s = sqrt(c^2 - a^2)."""
    outer = jnp.sqrt(inner**2 + flank**2)
    per = 1.0 / outer
    return outer, _zone(flank / (inner + outer), flank * per, inner * per)


def _folding(t: Any) -> Any:
    """The lambda whose contact folds at this angle."""
    z = _of_tangent(t)
    outer = 4.0 / 3.0 * z.rise / (2.0 * z.angle - z.segment)
    return (0.5 * outer**2 * z.pull + 4.0 / 3.0 * outer * z.gape) ** (-1.0 / 3.0)


SOFT = float(_folding(1.0))
"""The lambda above which the branch folds in contact, below it outside: 0.938."""


def _folds(x: np.ndarray) -> np.ndarray:
    """Value of t lambda/SOFT at the fold, at x = 2 SOFT/lambda - 1, by bisection."""
    share = 0.5 * (np.asarray(x) + 1.0)
    low, high = np.zeros_like(share), np.ones_like(share)
    for _ in range(60):
        middle = 0.5 * (low + high)
        tight = _folding(middle) * share > SOFT
        low, high = np.where(tight, middle, low), np.where(tight, high, middle)
    return 0.5 * (low + high) / share


_FOLDS = _fitted(_folds, 40)


Radii = tuple[jax.Array, jax.Array]
"""Inner radius a, and s = sqrt(c^2 - a^2)."""


class End(NamedTuple):
    """Where the contact ends on unloading: at its fold, or where its radius a is 0.

    Attributes
    ----------
    overlap, inner, outer
        Overlap, a and c there.
    curvature
        Half the second derivative of the overlap with a; its first is 0.
    last
        Overlap at which the bonded branch ends: there, or at its fold outside contact.
    """

    overlap: jax.Array
    inner: jax.Array
    outer: jax.Array
    curvature: jax.Array
    last: jax.Array


@jax.jit
def contact_end(l: jax.Array) -> End:
    """The end of the contact; the table of its angle spans all lambda above :data:`SOFT`."""
    stiff = jnp.minimum(SOFT / l, 1.0)
    soft = stiff < 1.0
    tangent = jnp.where(soft, stiff * power_sum(_FOLDS, 2.0 * stiff - 1.0), 1.0)
    z = _of_tangent(tangent)
    linear = 4.0 / 3.0 * l**2 * z.gape
    outer = 2.0 / (linear + jnp.sqrt(linear**2 + 2.0 * l * z.pull))
    inner, flank = outer * jnp.where(soft, z.cosine, 0.0), outer * z.sine
    hold, hold_slope = _hold(inner, outer, z, l)
    curvature = (flank + 2.0 / 3.0 * l) * (inner * hold_slope + hold)
    curvature = curvature / (flank * hold + 4.0 / 3.0 * l * outer * z.angle)
    overlap = inner**2 - 4.0 / 3.0 * l * flank
    outside = -2.0 / (pi * l) - 0.5 * falling_apart(l) ** 2
    return End(overlap, inner, outer, curvature, jnp.where(l < SOFT, outside, overlap))


def falling_apart(l: jax.Array) -> jax.Array:
    """Outer radius at the fold outside contact."""
    return 8.0 / (3.0 * pi) * l


def _hold(inner: jax.Array, outer: jax.Array, z: Zone, l: jax.Array) -> tuple[jax.Array, jax.Array]:
    """Stability of the outer radius, 0 at the fold, and its slope with a at one overlap.

    The first equation's slope with c, all else kept, is lambda times it.
    """
    chord = 2.0 * z.angle - z.segment
    spread = 1.5 / l * inner
    turn = (spread * z.cosine - z.sine) / outer
    hold = outer * chord - 4.0 / 3.0 * l * z.rise
    bent = 2.0 * outer * z.cosine**2 - 4.0 / 3.0 * l * z.sine
    return hold, (z.cosine + z.sine * spread) * chord + turn * bent


def _excess(overlap: jax.Array, end: jax.Array) -> jax.Array:
    """How far an overlap lies beyond an end of a branch; 0 within rounding of it.

    There the radii change like its square root: rounding alone would move them by 1e-8.
    """
    excess = overlap - end
    return jnp.where(excess > 2e-15 * jnp.abs(end), excess, 0.0)


def _first(overlap: jax.Array, end: End, l: jax.Array) -> Radii:
    """First guess of a and s = sqrt(c^2 - a^2), to a fifth or better, by single precision.

    Near its end a - a_end grows like the square root of the overlap, by the curvature; deep
    inside, s^3 + lambda s^2 = 3 a/(2 lambda). Both guess too large an s in between.
    """
    excess = _excess(overlap, end.overlap)
    flank = 0.75 / l * (end.inner**2 - end.overlap)
    bend = 0.7 * end.outer
    wane, load = bend * (1.0 - end.curvature), 1.2 * flank**2 * (flank + l)
    rough = (jnp.sqrt(excess), bend, end.curvature, wane, load, flank, end.inner, l)
    integrated = _lift(*(x.astype(jnp.float32) for x in rough)).astype(jnp.float64)
    inner = jnp.sqrt(end.inner**2 + excess + 4.0 / 3.0 * l * integrated)
    return inner, flank + integrated


def _lift(
    root: Any, bend: Any, curvature: Any, wane: Any, load: Any, flank: Any, inner: Any, l: Any
) -> jax.Array:
    """Growth of s from the end, from the x of root^2 = x^2 (x + curvature bend)/(x + bend).

    By repeated substitution; its mean converges for a curvature of 0 too, where it would swing.
    """
    grown = root
    for _ in range(2):
        better = root * jnp.sqrt((grown + bend) / (grown + curvature * bend))
        grown = (grown + 2.0 * better) / 3.0
    grown = root * jnp.sqrt((grown + bend) / (grown + curvature * bend))
    near = 0.75 / l * grown * (2.0 * inner + grown * wane / (grown + bend))
    load = load + 1.5 / l * grown
    deep = jax.lax.rsqrt(jnp.exp(jnp.log(load) * (-2.0 / 3.0)) + l / load) - flank
    return jnp.minimum(near, deep)


def _closer(inner: jax.Array, flank: jax.Array, least: jax.Array, l: jax.Array) -> Radii:
    """One of Halley's steps in a, at one overlap."""
    outer, z = of_radii(inner, flank)
    miss = outer * (0.5 * l * outer * z.pull + 4.0 / 3.0 * l**2 * z.gape) - 1.0
    hold, hold_slope = _hold(inner, outer, z, l)
    wide, spread = flank + 2.0 / 3.0 * l, 1.5 / l * inner
    # Both slopes of `miss` times 2 c/3.
    slope = inner * wide * hold
    widening = spread - wide * (z.cosine + z.sine * spread) / outer
    second = wide * (hold + inner * hold_slope) + inner * hold * widening
    miss = miss * outer / 1.5
    below = slope**2 - 0.5 * miss * second
    regular = below > 0.0
    step = miss * slope / jnp.where(regular, below, 1.0)
    step = jnp.where(regular, jnp.minimum(step, inner - least), 0.0)
    return inner - step, flank - 0.75 / l * step * (2.0 * inner - step)


@jax.custom_jvp
@jax.jit
def radii(overlap: jax.Array, l: jax.Array, end: End) -> Radii:
    """Equilibrium on the bonded branch, not beyond its :func:`contact_end`."""

    def closer(_: int, at: Radii) -> Radii:
        return _closer(at[0], at[1], end.inner, l)

    inner, flank = jax.lax.fori_loop(0, 3, closer, _first(overlap, end, l))
    apart = jnp.logical_and(overlap < end.overlap, l < SOFT)
    outside = falling_apart(l) + jnp.sqrt(2.0 * _excess(overlap, end.last))
    return jnp.where(apart, 0.0, inner), jnp.where(apart, outside, flank)


def slopes(
    overlap: jax.Array, l: jax.Array, found: Radii, change: tuple[jax.Array, jax.Array]
) -> tuple[jax.Array, jax.Array]:
    """Changes of c^2/2 and of a^2/2, by both equations; 0 at the end of the branch."""
    inner, flank = found
    by_overlap, by_l = change
    outer, z = of_radii(inner, flank)
    hold, _ = _hold(inner, outer, z, l)
    touching = inner > 0.0
    beyond = jnp.where(touching, 0.0, overlap + 4.0 / 3.0 * l * flank)
    growth = 0.5 * outer**2 * z.pull - 4.0 / 3.0 * l * outer * z.bend - beyond * z.angle
    regular = hold > 1e-9
    per = jnp.where(regular, outer / jnp.where(regular, hold, 1.0), 0.0)
    outer_change = per * (z.angle * by_overlap - growth / l * by_l)
    inner_change = flank * by_overlap + 4.0 / 3.0 * (flank**2 * by_l + l * outer_change)
    inner_change = inner_change / (2.0 * flank + 4.0 / 3.0 * l)
    held = jnp.logical_and(regular, touching)
    return outer_change, jnp.where(held, inner_change, 0.0)


@radii.defjvp
@jax.jit
def _radii_jvp(primals, tangents):  # type: ignore[no-untyped-def]
    inner, flank = radii(*primals)
    overlap, l, _ = primals
    outer_change, inner_change = slopes(overlap, l, (inner, flank), tangents[:2])
    touching = inner > 0.0
    # Where the contact begins a grows like a square root; what is made of it does not.
    inner_rate = jnp.where(touching, inner_change / jnp.where(touching, inner, 1.0), 0.0)
    return (inner, flank), (inner_rate, (outer_change - inner_change) / flank)
