"""Where a body that drag slows turns back."""

from __future__ import annotations

from typing import Any

import equinox as eqx

from .._jax import jax, jnp
from ..numerics.roots import fixed_point, root_between
from ..numerics.trees import choose
from .drag import Piece, PieceMotion, move_on
from .record import Body

_MEAN = 0.75  # of the speed, on the way to nothing: 2/3 by a constant force
_NEARLY = 0.9  # of the way to where no speed is left
_SEARCH = 80  # steps towards a turning point, at most


@eqx.filter_custom_jvp
def turning_place(body: Body, piece: Piece, kinetic: jax.Array) -> jax.Array:
    """Where on a piece, entered with a kinetic energy [J], that energy is spent [m]."""
    return turn_on(body, piece, kinetic)[0]


def turn_on(body: Body, piece: Piece, kinetic: jax.Array) -> tuple[jax.Array, PieceMotion]:
    """The same, and the motion until there.

    From a place before it, where the body still moves, by the forces' energy, which is known
    beyond, and the drag's, as it would be if the speed fell to nothing by a constant force, and
    somewhat more. So the next place lies before the root too.
    """
    ahead = piece.ahead
    close = 4e-15 * jnp.maximum(jnp.abs(piece.enter), jnp.abs(piece.leave))

    def step(carry: Any) -> Any:
        inside, outside, place, until = carry
        moved = move_on(body, piece, kinetic, place)
        alive = moved.passed
        inside, outside = jnp.where(alive, place, inside), jnp.where(alive, outside, place)
        speed = jnp.sqrt(2.0 * jnp.maximum(moved.kinetic, 0.0) / body.mass)
        taken = _MEAN * speed * jnp.sum(piece.drags(body, place[None], speed[None]))
        begun = moved.kinetic - piece.energy(place, body.load)

        def left(there: jax.Array) -> jax.Array:
            return begun + piece.energy(there, body.load) - taken * ahead * (there - place)

        turns = alive & (left(outside) <= 0.0)
        target = root_between(left, place, jnp.where(turns, outside, place), close)
        there = turns & (jnp.abs(target - place) <= close)
        target = target - 0.05 * ahead * close  # before it by a hair: rounding may end it there
        part = jnp.where(alive, _NEARLY, 0.5)  # it moves on nearly to the end, or there by halves
        target = jnp.where(turns, target, inside + part * (outside - inside))
        outside = jnp.where(there, inside, outside)
        until = choose(alive, moved, until)
        return (inside, outside, target, until), jnp.abs(outside - inside)

    middle = 0.5 * (piece.enter + piece.leave)
    start = piece.enter, piece.leave, middle, PieceMotion.none(body, kinetic)
    (inside, _, _, until), _ = fixed_point(step, start, close, _SEARCH)
    return inside, until


@turning_place.def_jvp
def _turning_place_jvp(primals: Any, tangents: Any) -> tuple[jax.Array, jax.Array]:
    """By the implicit function theorem: the kinetic energy stays zero there."""
    body, piece, _ = primals
    place = turning_place(*primals)

    def spent(body: Body, piece: Piece, kinetic: jax.Array) -> jax.Array:
        return move_on(body, piece, kinetic, place).kinetic

    _, change = eqx.filter_jvp(spent, primals, tangents)
    falls = piece.ahead * piece.push(place, body.load)
    moved = -piece.ahead * change / jnp.where(falls < 0.0, falls, -1.0)
    return place, jnp.where(falls < 0.0, moved, 0.0)
