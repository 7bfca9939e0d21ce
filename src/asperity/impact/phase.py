"""One phase of a motion: from one turning point to the next.

Where the force depends on the separation alone, turning points are roots of the kinetic
energy K(d), and the time between two places is the integral of dd / v, v = sqrt(2 K / m).
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from .._jax import jax, jnp
from .table import FORCE, Pieces, antiderivative, chebyshev_sum, local

_SEARCH = 8  # places a piece at which the kinetic energy is looked at
_POLISH = 60  # halvings and Newton steps of a turning point, at most
_GAUSS, _WEIGHT = np.polynomial.legendre.leggauss(16)
_Y = 0.5 * (_GAUSS + 1.0)
_RISE = np.sin(0.5 * np.pi * _Y) ** 2  # square-root ends become smooth
_RATE = 0.25 * np.pi * np.sin(np.pi * _Y) * _WEIGHT


class Work(NamedTuple):
    """Kinetic energy along the pieces of a phase.

    Attributes
    ----------
    pieces
        The polynomials.
    integral
        Chebyshev coefficients of the work of the contact force, shape (NODES + 1, pieces).
    kinetic
        Kinetic energy [J] where each piece is entered, shape (pieces,).
    weight
        Weight [N].
    """

    pieces: Pieces
    integral: jax.Array
    kinetic: jax.Array
    weight: jax.Array


class Turn(NamedTuple):
    """End of a phase: the piece and place where the body turns, or the end of the table."""

    piece: jax.Array
    place: jax.Array
    found: jax.Array
    fastest: jax.Array


def work_along(pieces: Pieces, kinetic: jax.Array, weight: jax.Array) -> Work:
    """Integrate the force along a phase that starts with a kinetic energy [J]."""
    half = 0.5 * (pieces.high - pieces.low)
    integral = antiderivative(pieces.values[..., FORCE].T) * half
    first = local(pieces.low, pieces.high, pieces.enter)
    last = local(pieces.low, pieces.high, pieces.leave)
    gain = chebyshev_sum(integral, last) - chebyshev_sum(integral, first)
    gain = gain - weight * (pieces.leave - pieces.enter)
    before = jnp.concatenate([jnp.zeros(1), jnp.cumsum(gain)[:-1]])
    return Work(pieces, integral, kinetic + before, weight)


def kinetic_along(work: Work, places: jax.Array) -> jax.Array:
    """Kinetic energy [J] at places [m] of every piece, shape (pieces, places)."""
    p = work.pieces
    x = local(p.low[:, None], p.high[:, None], places)
    first = local(p.low, p.high, p.enter)
    gain = chebyshev_sum(work.integral[:, :, None], x)
    gain = gain - chebyshev_sum(work.integral, first)[:, None]
    return work.kinetic[:, None] + gain - work.weight * (places - p.enter[:, None])


def one_piece(work: Work, piece: jax.Array) -> Work:
    """The work along one piece alone, as a work of one piece."""
    chosen = Pieces(*(leaf[piece][None] for leaf in work.pieces))
    return Work(chosen, work.integral[:, piece][:, None], work.kinetic[piece][None], work.weight)


def force_along(work: Work, place: jax.Array) -> jax.Array:
    """Contact force less the weight [N] at a place of a work of one piece."""
    p = work.pieces
    x = local(p.low[0], p.high[0], place)
    return chebyshev_sum(p.values[0, :, FORCE], x) - work.weight


def find_turn(work: Work) -> Turn:
    """The first place where the kinetic energy is spent."""
    p = work.pieces
    fraction = np.arange(1, _SEARCH + 1) / _SEARCH
    count = p.low.shape[0]
    places = p.enter[:, None] + (p.leave - p.enter)[:, None] * fraction
    energy = kinetic_along(work, places)
    spent = jnp.logical_and(energy < 0.0, (p.leave != p.enter)[:, None]).ravel()
    found = jnp.any(spent)
    first = jnp.argmax(spent)
    piece = jnp.where(found, first // _SEARCH, count - 1)
    step = (p.leave - p.enter)[piece] / _SEARCH
    outer = places.ravel()[first]
    place = _polish(one_piece(work, piece), outer - step, outer)
    passed = jnp.logical_or(jnp.logical_not(found), jnp.arange(spent.shape[0]) < first)
    fastest = jnp.max(jnp.where(passed, energy.ravel(), 0.0))
    return Turn(piece, jnp.where(found, place, p.leave[-1]), found, fastest)


def _polish(work: Work, inner: jax.Array, outer: jax.Array) -> jax.Array:
    """Root of the kinetic energy between two places: Newton kept inside its bracket."""
    frozen = jax.lax.stop_gradient(work)
    inner, outer = jax.lax.stop_gradient((inner, outer))

    def energy_at(work: Work, place: jax.Array) -> jax.Array:
        return kinetic_along(work, place[None, None])[0, 0]

    def go_on(carry):  # type: ignore[no-untyped-def]
        _, _, _, moved, count = carry
        return jnp.logical_and(moved, count < _POLISH)

    def step(carry):  # type: ignore[no-untyped-def]
        inside, outside, place, _, count = carry
        energy = energy_at(frozen, place)
        alive = energy >= 0.0
        inside, outside = jnp.where(alive, place, inside), jnp.where(alive, outside, place)
        slope = force_along(frozen, place)
        target = place - energy / jnp.where(slope == 0.0, 1.0, slope)
        between = (target - inside) * (target - outside) < 0.0
        following = jnp.where(between, target, 0.5 * (inside + outside))
        moved = jnp.abs(following - place) > 4e-16 * jnp.abs(place)
        return inside, outside, following, moved, count + 1

    start = (inner, outer, 0.5 * (inner + outer), jnp.asarray(True), 0)
    place = jax.lax.while_loop(go_on, step, start)[2]
    slope = jax.lax.stop_gradient(force_along(work, place))
    correction = energy_at(work, place) / jnp.where(slope == 0.0, 1.0, slope)
    # The value is polished already; the last Newton step carries the derivative.
    return place - (correction - jax.lax.stop_gradient(correction))


def travel_time(work: Work, mass: jax.Array, last: jax.Array, parting: jax.Array) -> jax.Array:
    """Time [s] spent in each piece up to the place ``last``, shape (pieces,)."""
    p = work.pieces

    def until(place: jax.Array) -> jax.Array:
        return jnp.where(parting, jnp.minimum(place, last), jnp.maximum(place, last))

    enter = until(p.enter)
    length = until(p.leave) - enter
    energy = kinetic_along(work, enter[:, None] + length[:, None] * _RISE)
    moving = jnp.logical_and(energy > 0.0, (length != 0.0)[:, None])
    speed = jnp.sqrt(jnp.where(moving, 2.0 * energy / mass, 1.0))
    return jnp.sum(jnp.where(moving, _RATE / speed, 0.0), axis=1) * jnp.abs(length)
