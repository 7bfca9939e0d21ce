"""Phases that end without a turn: an overdamped body creeps to its equilibrium."""

from __future__ import annotations

from typing import NamedTuple

from .._jax import jax, jnp
from .curve_table import Pieces
from .damped_phase import DampedPhase, integrate_phase, slow_at
from .drag import DampedPiece, move_on
from .phase import TurningPoint, Work, work_along
from .record import Body

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
) -> DampedPhase:
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
    """
    whole = integrate_phase(body, pieces, kinetic)
    if not body.damped_apart:
        return whole
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
    turn, duration, lost = jax.tree_util.tree_map(
        lambda a, b: jnp.where(at_rest, a, b), crept, turned
    )
    followed = at_rest | whole.followed
    return whole._replace(
        turn=turn, duration=duration, lost=lost, at_rest=at_rest, followed=followed
    )


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
