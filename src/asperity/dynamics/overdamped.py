"""Phases that end without a turn: an overdamped body creeps to its equilibrium."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from equinox.internal import unvmap_any

from .._jax import jax, jnp
from ..numerics.trees import choose, zeros_of
from .curve_table import Pieces
from .damped_phase import DampedPhase, integrate_phase, slow_at, spent_at
from .drag import DampedPiece, move_on
from .phase import TurningPoint, Work, work_along
from .record import Body
from .resolved_pieces import resolved

_ATTEMPTS = 4  # to find where drag has taken the momentum
_BRAKED = 0.02  # of the energy is left: a piece on which drag takes more is too long
_COUNTS = 1e-6  # of the largest kinetic energy: less is not followed that closely
_NEAR = 0.1  # of the mean force on the way to it: more force at a place is no equilibrium


class Rest(NamedTuple):
    """What counts as rest.

    Attributes
    ----------
    equilibrium
        Static equilibrium under the weight [m], or NaN.
    share
        Share of a body's way that counts as none.
    """

    equilibrium: jax.Array
    share: jax.Array

    def outside(self, body: Body) -> jax.Array:
        """Separation, a little outside the equilibrium, that counts as there [m]."""
        return self.equilibrium + self.share * (body.release - self.equilibrium)


def come_to_rest(
    body: Body, pieces: Pieces, kinetic: jax.Array, rest: Rest, unloading: jax.Array
) -> tuple[DampedPhase, jax.Array, jax.Array]:
    """A phase of :func:`asperity.dynamics.damped_phase.integrate_phase` that may creep to rest.

    A drag that is strong enough brings a body to its equilibrium without a turn, in infinite
    time. Such a phase ends a little before, where what is left of its kinetic energy goes to that
    drag too. A drag that acts in contact alone, as waves do, is too weak for it.

    Parameters
    ----------
    body, pieces, kinetic
        As there.
    rest
        What counts as rest.
    unloading
        Whether the body moves outwards.

    Returns
    -------
    The phase, on finer pieces; which of ``pieces`` each of these is a part of; and where drag has
    taken the momentum of a body that goes on from there [m], or NaN.
    """
    pieces, part, whole, spent = _followed(body, pieces, kinetic, rest, unloading)
    if not body.damped_apart:
        return whole, part, spent
    turn, work = whole.turn, work_along(pieces, kinetic, body.load)
    if body.forces:
        goal, here, near = _before_turn(body, pieces, turn, rest)
    else:
        goal, here, near = _above_rest(body, pieces, turn, rest, unloading)
    place = jnp.where(near, goal, pieces.leave[here])
    moved = move_on(body, DampedPiece.of(work, here), whole.kinetic[here], place)
    if body.forces:
        at_rest = near & _driven(body, work, turn, (here, place), moved.kinetic)
    else:
        # Stiff bodies turn that close too, at full speed: those that are pushed back bounce.
        ends = rest.equilibrium, goal
        still = slow_at(body, moved.kinetic, turn.maximum_kinetic, ends)
        at_rest = near & (still | jnp.logical_not(whole.followed))
        at_rest = at_rest & jnp.logical_not(whole.stopped)
    stop = TurningPoint(here, goal, jnp.asarray(True), turn.maximum_kinetic, jnp.zeros(()))
    taker = [drag.acts_apart for drag in body.drags].index(True)
    lost = whole.dissipated[here] + moved.lost
    crept = (stop, whole.times[here] + moved.duration, lost.at[taker].add(moved.kinetic))
    turned = (turn, whole.duration, whole.lost)
    turn, duration, lost = choose(at_rest, crept, turned)
    followed = at_rest | whole.followed
    whole = whole._replace(
        turn=turn, duration=duration, lost=lost, at_rest=at_rest, followed=followed
    )
    return whole, part, spent


_Followed = tuple[Pieces, jax.Array, DampedPhase, jax.Array]


def _followed(
    body: Body, pieces: Pieces, kinetic: jax.Array, rest: Rest, unloading: jax.Array
) -> _Followed:
    """A phase on pieces that resolve where drag takes the body's momentum, if its weight goes on.

    There the speed falls, over far less than a piece, to that at which drag balances the weight,
    and the body seems to turn. It is followed again with pieces that narrow to that place.
    """

    @jax.jit  # traced once, for its shapes and for itself
    def attempt(spent: jax.Array) -> _Followed:
        finer, part = resolved(body, pieces, kinetic, spent)
        return finer, part, integrate_phase(body, finer, kinetic), spent

    never = jnp.asarray(jnp.nan)
    if not body.damped_apart or body.forces:
        return attempt(never)
    blank = zeros_of(jax.eval_shape(attempt, never))

    def again(carry: tuple[_Followed, jax.Array, jax.Array], _: None) -> tuple[Any, None]:
        before, spent, done = carry
        found = jax.lax.cond(unvmap_any(~done), lambda: attempt(spent), lambda: before)
        found = choose(done, before, found)
        finer, _, whole, _ = found
        near = _above_rest(body, finer, whole.turn, rest, unloading)[2]
        number, sharp = _braked(body, finer, kinetic, whole)
        coarse = ~done & (sharp | (~whole.followed & ~near))
        piece = DampedPiece.of(work_along(finer, kinetic, body.load), number)
        stop = jnp.where(sharp, piece.leave, whole.turn.place)
        place = spent_at(body, piece, whole.kinetic[number], stop)
        return (found, jnp.where(coarse, place, spent), ~coarse), None

    start = blank, never, jnp.asarray(False)
    ((pieces, part, whole, spent), _, done), _ = jax.lax.scan(again, start, length=_ATTEMPTS)
    return pieces, part, whole._replace(followed=whole.followed & done), spent


def _braked(
    body: Body, pieces: Pieces, kinetic: jax.Array, whole: DampedPhase
) -> tuple[jax.Array, jax.Array]:
    """The first piece on which drag takes nearly all of the energy of a body that is pushed on.

    And whether there is one; else the piece on which it turns.
    """
    before, after = whole.kinetic[:-1], whole.kinetic[1:]
    taken = jnp.sum(jnp.diff(whole.dissipated, axis=0), axis=-1)
    passed = np.arange(before.shape[0]) < whole.turn.piece
    counts = before > _COUNTS * jnp.max(whole.kinetic)
    most = passed & counts & (after < _BRAKED * before) & (taken > 0.5 * before)
    number = jnp.argmax(most)
    piece = DampedPiece.of(work_along(pieces, kinetic, body.load), number)
    on = piece.ahead * piece.push(piece.leave, body.load) > 0.0
    sharp = jnp.any(most) & on
    return jnp.where(sharp, number, whole.turn.piece), sharp


def _above_rest(
    body: Body, pieces: Pieces, turn: TurningPoint, rest: Rest, unloading: jax.Array
) -> tuple[jax.Array, jax.Array, jax.Array]:
    """Where a fall onto the contact would end at rest, in which piece, and whether it comes there.

    Under its weight a body rests in contact alone, and comes there from above.
    """
    goal = jnp.where(unloading, jnp.inf, rest.outside(body))
    here = jnp.argmax(pieces.leave <= goal)
    near = turn.place > rest.equilibrium - (goal - rest.equilibrium)
    return goal, here, turn.found & near & (turn.piece >= here) & (goal < pieces.enter[0])


def _before_turn(
    body: Body, pieces: Pieces, turn: TurningPoint, rest: Rest
) -> tuple[jax.Array, jax.Array, jax.Array]:
    """The same of a body on a spring, which may rest anywhere, before it seems to turn there."""
    start = pieces.enter[0]
    way = jnp.abs(turn.place - start)
    before = jnp.minimum(rest.share * jnp.maximum(way, jnp.abs(turn.place - body.release)), way / 2)
    ahead = jnp.sign(turn.place - start)
    goal = turn.place - ahead * before
    return goal, jnp.argmax(ahead * pieces.leave >= ahead * goal), turn.found & (before > 0.0)


def _driven(
    body: Body,
    work: Work,
    turn: TurningPoint,
    before: tuple[jax.Array, jax.Array],
    kinetic: jax.Array,
) -> jax.Array:
    """Whether a body is not turned back but braked until it stands at an equilibrium.

    ``before`` are the piece and the place [m] where it still has a kinetic energy [J]. On its way
    from there other forces than drag give it more than that, and they end where it stands.
    """

    def given(piece: jax.Array, place: jax.Array) -> jax.Array:
        return work.kinetic[piece] + DampedPiece.of(work, piece).energy(place, body.load)

    gained = given(turn.piece, turn.place) - given(*before)
    there = jnp.abs(DampedPiece.of(work, turn.piece).push(turn.place, body.load))
    distance = jnp.abs(turn.place - before[1])
    return (gained > 0.0) & (gained >= kinetic) & (there * distance <= _NEAR * gained)
