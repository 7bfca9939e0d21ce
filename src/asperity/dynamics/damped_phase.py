"""The phases of a motion with drag: one piece after the other, until the body turns."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple, TypeVar

from equinox.internal import unvmap_any

from .._jax import jax, jnp
from ..laws.law import Real
from ..numerics.compilation import kept
from ..numerics.trees import choose
from .curve_table import Pieces
from .damped_turning_point import turning_place
from .drag import POINTS, SHARES, DampedPiece, Piece, PieceMotion, move_on, whole_of
from .external_forces import Load
from .phase import TurningPoint, Work, work_along
from .phase_time import time_along
from .record import Body, Phase
from .resolved_pieces import resolved

STILL = 1e-9
"""Share of a body's energy at its release: a force that could not give it so much moves it no more
once it has stopped."""

_PUSHED = 1e-6  # of the largest force: what may push a body on that turns all the same


class PhaseProgress(NamedTuple):
    """A body on its way over pieces, until it turns.

    Attributes
    ----------
    kinetic, time, dissipated
        Kinetic energy [J], time since the start [s] and energy taken by each drag [J] where it
        entered the last piece; where it passed all, at their end.
    going
        Whether it has passed all pieces so far.
    piece
        Number of the last.
    maximum_kinetic
        Largest kinetic energy so far [J].
    """

    kinetic: jax.Array
    time: jax.Array
    dissipated: jax.Array
    going: jax.Array
    piece: jax.Array
    maximum_kinetic: jax.Array

    @classmethod
    def begun(cls, body: Body, kinetic: jax.Array) -> PhaseProgress:
        """Of a body that enters the first piece with a kinetic energy [J]."""
        none = jnp.zeros(len(body.drags))
        return cls(kinetic, jnp.zeros(()), none, jnp.asarray(True), jnp.asarray(0), kinetic)


@kept
class DampedPhase(NamedTuple):
    """A phase with drag.

    Attributes
    ----------
    turn
        Its end.
    duration
        Time that it takes [s].
    lost
        Energy taken by each drag [J].
    kinetic, times, dissipated
        Kinetic energy [J], time since the start [s] and energy taken by each drag [J] where each
        piece is entered.
    at_rest
        Whether the body came so close to rest without a turn that the phase ends there.
    followed
        Whether it turned because it was pushed back: speeds that a drag changes within a
        thousandth of a piece are too much for its points, and it seems to turn too early.
    stopped
        Whether the film alone stopped it: where nothing pushes it on or back.
    """

    turn: TurningPoint
    duration: jax.Array
    lost: jax.Array
    kinetic: jax.Array
    times: jax.Array
    dissipated: jax.Array
    at_rest: jax.Array
    followed: jax.Array
    stopped: jax.Array


def integrate_phase(body: Body, pieces: Pieces, kinetic: jax.Array) -> DampedPhase:
    """Follow the pieces of a phase, entered with a kinetic energy [J], to where the body turns.

    Parameters
    ----------
    body
        The body, with its drags.
    pieces
        The polynomials ahead of it, all that there are.
    kinetic
        Kinetic energy at the start [J].
    """
    work = work_along(pieces, kinetic, body.load)
    now, entered = _along(body, work, lambda now, *_: (now.kinetic, now.time, now.dissipated))
    piece = DampedPiece.of(work, now.piece)
    found = jnp.logical_not(now.going)
    stop = turning_place(body, piece, now.kinetic)
    stopped = found & _left_alone(body, piece, stop)
    stop = jnp.where(stopped, spent_at(body, piece, now.kinetic, stop), stop)
    moved = move_on(body, piece, now.kinetic, stop)
    turn = TurningPoint(
        piece=now.piece,
        place=jnp.where(found, stop, pieces.leave[-1]),
        found=found,
        maximum_kinetic=jnp.maximum(
            now.maximum_kinetic, jnp.where(found, moved.maximum_kinetic, 0.0)
        ),
        kinetic=jnp.where(found, 0.0, now.kinetic),
    )
    duration = now.time + jnp.where(found, moved.duration, 0.0)
    lost = now.dissipated + jnp.where(found, moved.lost, 0.0)
    followed = jnp.logical_not(found) | stopped | _pushed_back(piece, stop, body.load)
    return DampedPhase(turn, duration, lost, *entered, jnp.asarray(False), followed, stopped)


SomePiece = TypeVar("SomePiece", bound=Piece)
Seen = TypeVar("Seen")


def over_pieces(
    body: Body,
    piece_at: Callable[[jax.Array], SomePiece],
    count: int,
    kinetic: jax.Array,
    see: Callable[[PhaseProgress, SomePiece, PieceMotion], Seen],
) -> tuple[PhaseProgress, Seen]:
    """From piece to piece until the body turns, and what is seen of each on the way.

    What is seen of empty pieces, and of those beyond the turn, is as if they took no time.

    Parameters
    ----------
    body
        The body, with its drags.
    piece_at, count
        The piece of a number, and how many there are.
    kinetic
        Kinetic energy where the first is entered [J].
    see
        What to see of a piece, by the progress so far and the motion on it.
    """

    def over(now: PhaseProgress, k: jax.Array) -> tuple[PhaseProgress, Seen]:
        piece = piece_at(k)
        after, moved = over_piece(body, now, piece, k)
        return after, see(now, piece, moved)

    return jax.lax.scan(over, PhaseProgress.begun(body, kinetic), jnp.arange(count))


def over_piece(
    body: Body, now: PhaseProgress, piece: Piece, number: jax.Array
) -> tuple[PhaseProgress, PieceMotion]:
    """A body on its way over one piece more, and its motion there; one that has turned stays."""
    active = now.going & (piece.leave != piece.enter)
    end = jnp.where(active, piece.leave, piece.enter)
    still = PieceMotion.none(body, now.kinetic)
    moved = jax.lax.cond(
        unvmap_any(active), lambda: move_on(body, piece, now.kinetic, end), lambda: still
    )
    on = active & moved.passed
    after = PhaseProgress(
        kinetic=jnp.where(on, moved.kinetic, now.kinetic),
        time=now.time + jnp.where(on, moved.duration, 0.0),
        dissipated=now.dissipated + jnp.where(on, moved.lost, 0.0),
        going=jnp.where(active, on, now.going),
        piece=jnp.where(now.going, number, now.piece),
        maximum_kinetic=jnp.maximum(now.maximum_kinetic, jnp.where(on, moved.maximum_kinetic, 0.0)),
    )
    return after, choose(active, moved, still)


def _along(
    body: Body, work: Work, see: Callable[[PhaseProgress, DampedPiece, PieceMotion], Seen]
) -> tuple[PhaseProgress, Seen]:
    """The same over the pieces that work is done along."""
    count = work.pieces.low.shape[0]
    return over_pieces(body, lambda k: DampedPiece.of(work, k), count, work.kinetic[0], see)


def _pushed_back(piece: DampedPiece, place: jax.Array, load: Load) -> jax.Array:
    """Whether contact and load push a body back at a place of a piece."""
    push, press = piece.push(place, load), load.force(place)
    return piece.ahead * push <= _PUSHED * (jnp.abs(push + press) + jnp.abs(press))


def _left_alone(body: Body, piece: DampedPiece, place: jax.Array) -> jax.Array:
    """Whether nothing moves a body that drag has stopped at a place of a piece."""
    if not body.damped_apart or body.forces:
        return jnp.asarray(False)
    push = jnp.abs(piece.push(place, body.load)) * jnp.abs(body.release)
    return (body.weight == 0.0) & (push <= STILL * body.kinetic)


def spent_at(body: Body, piece: DampedPiece, kinetic: jax.Array, place: jax.Array) -> jax.Array:
    """Where on a piece, entered with a kinetic energy [J], drag has taken all momentum [m].

    By Newton's method from a place near by. Energies, which are squares of momenta, tell a place
    to half as many digits.
    """
    momentum = jnp.sqrt(2.0 * body.mass * jnp.maximum(kinetic, 0.0))
    for _ in range(2):
        places = piece.enter + (place - piece.enter) * SHARES
        drags = piece.drags(body, jnp.append(places, place), jnp.ones(POINTS + 1))
        drag = jnp.sum(drags, axis=0)
        taken = jnp.abs(place - piece.enter) * whole_of(drag[:-1])
        place = place + piece.ahead * (momentum - taken) / drag[-1]
        place = jnp.clip(place, *jnp.sort(jnp.stack([piece.enter, piece.leave])))
    return place


def slow_at(body: Body, kinetic: Real, maximum_kinetic: Real, rest: tuple[Real, Real]) -> jax.Array:
    """Whether a body comes to ``rest[1]`` too slowly to rise far from its rest again.

    Parameters
    ----------
    body
        The body.
    kinetic, maximum_kinetic
        Kinetic energy there, and the largest on the way [J].
    rest
        Separations of the equilibrium and of what counts as there [m].
    """
    height = rest[1] - rest[0]
    share = height / (body.release - rest[0])
    return kinetic < jnp.maximum(body.weight * height, share * maximum_kinetic)


def follow(body: Body, pieces: Pieces, kinetic: jax.Array) -> tuple[jax.Array, ...]:
    """A body on pieces that it passes: places, times, speeds; and by drag energy taken and drag.

    Each of shape (pieces, POINTS + 1), the last two with an axis of drags more, at SHARES of
    every piece and at its end.
    """

    def see(now: PhaseProgress, piece: DampedPiece, moved: PieceMotion) -> tuple[jax.Array, ...]:
        places = jnp.append(piece.enter + (piece.leave - piece.enter) * SHARES, piece.leave)
        last = jnp.sqrt(2.0 * jnp.maximum(moved.kinetic, 0.0) / body.mass)
        speeds = jnp.append(moved.speed, last)
        dissipated = now.dissipated + jnp.column_stack([moved.dissipated, moved.lost]).T
        times = now.time + jnp.append(moved.time, moved.duration)
        return places, times, speeds, dissipated, piece.drags(body, places, speeds).T

    return _along(body, work_along(pieces, kinetic, body.load), see)[1]


def cut(pieces: Pieces, unloading: jax.Array, place: jax.Array) -> Pieces:
    """The pieces until a place [m]; those beyond it are empty."""

    def until(end: jax.Array) -> jax.Array:
        return jnp.where(unloading, jnp.minimum(end, place), jnp.maximum(end, place))

    return pieces._replace(enter=until(pieces.enter), leave=until(pieces.leave))


def kinetic_and_time_at(
    body: Body,
    pieces: Pieces,
    phase: Phase,
    unloading: jax.Array,
    place: jax.Array,
) -> tuple[jax.Array, jax.Array]:
    """Kinetic energy [J] with which a body passes a place [m] of a phase, and when [s].

    Since the start of the phase. Without energy where it turns before.
    """
    kinetic = phase.kinetic
    if not body.damped:
        passed = cut(pieces, unloading, place)
        work = work_along(passed, kinetic, body.load)
        return work.kinetic[-1], time_along(work, (passed.enter, passed.leave), body.mass)
    passed = cut(resolved(body, pieces, kinetic, phase.spent)[0], unloading, place)
    now, _ = _along(body, work_along(passed, kinetic, body.load), lambda *_: ())
    return jnp.where(now.going, now.kinetic, 0.0), now.time
