"""The path of a rigid body on its summits, or apart from them, that drags slow.

It is cut into pieces; on each its speed is met at Gauss's points, as in
:mod:`asperity.dynamics.drag`, with the energies of its summits as they are. Cuts lie where forces
or energies of the highest summits step.
"""

from __future__ import annotations

from typing import NamedTuple, Protocol

import numpy as np

from .._jax import jax, jnp
from ..numerics.compilation import Program
from .damped_phase import PhaseProgress, over_pieces
from .damped_turning_point import turn_on
from .drag import Piece, PieceMotion, move_on
from .external_forces import Along, Load
from .record import Body
from .summit_path import (
    Arrival,
    Departure,
    Launch,
    Outward,
    SummitPath,
    arrive,
    begin_of,
    evenly,
)

_SHARES = np.linspace(0.0, 1.0, 6)[1:-1]  # of the way through the forces: cuts
_CUT = 8  # of the highest summits: those whose steps of force are cuts
_FLIGHT = np.concatenate([[0.0], 16.0 ** -np.arange(3.0, 0.0, -1.0), 1.0 - 0.25 ** np.arange(1, 8)])
"""Cuts of a way apart from the summits, closest together at both ends, but for its end."""


class Forces(Protocol):
    """What summits do to a body."""

    def work(self, separation: jax.Array) -> jax.Array:
        """Work [J] from far away to a separation [m]."""

    def force(self, separation: jax.Array) -> jax.Array:
        """Force [N] at a separation [m], positive apart."""


class SummitPiece(NamedTuple):
    """A piece of a way between two separations [m], by the summits of a path; None apart."""

    path: Forces | None
    enter: jax.Array
    leave: jax.Array

    @property
    def ahead(self) -> jax.Array:
        return jnp.sign(self.leave - self.enter)

    def energy(self, places: jax.Array, load: Load) -> jax.Array:
        gained = -load.potential_gain(self.enter, places - self.enter)
        if self.path is None:
            return gained
        work = jax.vmap(self.path.work)(jnp.append(places, self.enter))
        return gained + work[-1] - work[:-1].reshape(jnp.shape(places))

    def push(self, place: jax.Array, load: Load) -> jax.Array:
        force = 0.0 if self.path is None else self.path.force(place)
        return force - load.force(place)

    def drags(self, body: Body, places: jax.Array, speed: jax.Array) -> jax.Array:
        if self.path is None or all(drag.acts_apart for drag in body.drags):
            return body.resistances(Along.apart(places))
        force = self.path.force

        def stiffness(place: jax.Array) -> jax.Array:
            return jax.jvp(force, (place,), (jnp.ones_like(place),))[1]

        def both(place: jax.Array) -> tuple[jax.Array, jax.Array]:
            return jax.jvp(stiffness, (place,), (jnp.ones_like(place),))

        return body.resistances(Along(places, *jax.vmap(both)(places), speed))


def damped_kinetic_apart(
    body: Body, kinetic: jax.Array, start: jax.Array, stop: jax.Array
) -> jax.Array:
    """:func:`~asperity.dynamics.summit_path.kinetic_apart` with drags; 0 where these stop it."""
    moved = move_on(body, SummitPiece(None, start, stop), kinetic, stop)
    return jnp.where(moved.passed, moved.kinetic, 0.0)


def _over(
    body: Body, path: SummitPath | None, ends: jax.Array, kinetic: jax.Array
) -> tuple[PhaseProgress, jax.Array]:
    """From one of the ``ends`` [m] to the next, with a kinetic energy [J] at the first.

    And the kinetic energy with which each piece is entered [J].
    """

    def piece_at(k: jax.Array) -> SummitPiece:
        return SummitPiece(path, ends[k], ends[k + 1])

    return over_pieces(body, piece_at, ends.size - 1, kinetic, lambda now, *_: now.kinetic)


def _turned(
    body: Body, path: SummitPath | None, ends: jax.Array, now: PhaseProgress
) -> tuple[jax.Array, PieceMotion]:
    """Where on its last piece a body stops [m], and how it gets there from where it entered."""
    return turn_on(body, SummitPiece(path, ends[now.piece], ends[now.piece + 1]), now.kinetic)


def _apart(body: Body, start: jax.Array, stop: jax.Array) -> jax.Array:
    """Ends of the pieces of a way apart from the summits [m]."""
    ends = jnp.concatenate([start + (stop - start) * np.sort(_FLIGHT), stop[None]])
    return _with_cuts(ends, [], body)


def _with_cuts(ends: jax.Array, cuts: list[jax.Array], body: Body) -> jax.Array:
    """Ends of pieces, descending or ascending, and besides ``cuts`` where a film thins no more."""
    thinnest = [drag.thinnest for drag in body.drags if drag.thinnest is not None]
    more = jnp.concatenate([ends, *cuts, jnp.asarray(thinnest)])
    low, high = jnp.minimum(ends[0], ends[-1]), jnp.maximum(ends[0], ends[-1])
    ahead = jnp.where(ends[-1] < ends[0], -1.0, 1.0)
    return ahead * jnp.sort(ahead * jnp.clip(more, low, high))


def fly(body: Body, launch: Launch, top: jax.Array) -> tuple[PhaseProgress, jax.Array]:
    """From where a body is released to its ``top`` [m], or to where it stops before [m]."""
    ends = _apart(body, begin_of(launch, top), top)
    now, _ = _over(body, None, ends, jnp.asarray(launch.kinetic))
    place, moved = _turned(body, None, ends, now)
    taken = now.dissipated + jnp.where(now.going, 0.0, moved.lost)
    return now._replace(dissipated=taken), jnp.where(now.going, top, place)


def arrive_damped(body: Body, path: SummitPath, launch: Launch, top: jax.Array) -> Arrival:
    """The way in of a body that drags slow, by the summits of ``path``."""
    # No drag brings it deeper than it comes without one.
    deepest = arrive(body, path, launch, top).turning_point
    ends, first = ends_inwards(body, path, launch, (deepest, top))
    now, entered = _over(body, path, ends, launch.kinetic)
    turned = _turned(body, path, ends, now)
    return arrived(body, path, now, turned, Within(entered[first], first, deepest, top))


class Within(NamedTuple):
    """What a way in lies within.

    Attributes
    ----------
    before, first
        Kinetic energy [J] with which the first piece on the summits is entered, and its number.
    deepest, top
        The deepest turning point and the top of the summits [m].
    """

    before: jax.Array
    first: int
    deepest: jax.Array
    top: jax.Array


def arrived(
    body: Body,
    path: Forces,
    now: PhaseProgress,
    turned: tuple[jax.Array, PieceMotion],
    within: Within,
) -> Arrival:
    """The way in, by its progress, and where it stops on its last piece [m] and how."""
    (place, moved), unknown = turned, jnp.isnan(within.deepest)
    met = now.going | (now.piece >= within.first) | unknown
    back = SummitPiece(path, within.top, place).push(place, body.load) > 0.0
    back = jnp.where(met, back, body.load.force(place) < 0.0)
    return Arrival(
        before=jnp.where(met, within.before, 0.0),
        turning_point=jnp.where(now.going | unknown, within.deepest, place),
        kinetic=jnp.zeros(()),
        taken=now.dissipated + jnp.where(now.going, 0.0, moved.lost),
        met=met,
        stays=~back & ~unknown,
    )


def ends_inwards(
    body: Body, path: SummitPath, launch: Launch, within: tuple[jax.Array, jax.Array]
) -> tuple[jax.Array, int]:
    """Ends of the pieces of a way in [m], and the number of the first that is on summits.

    ``within`` are the deepest turning point and the top of the summits [m].
    """
    summits, standing = path.pressed.summits, path.offsets - path.pressed.residual
    even = _between(within[0], evenly(summits, *within, standing, _SHARES), within[1])
    steps = jnp.concatenate([summits.forming, jnp.zeros((1, standing.size))])
    flight = _apart(body, begin_of(launch, within[1]), within[1])
    ends = _with_cuts(even[::-1], _steps_at(standing, steps, even), body)
    return jnp.concatenate([flight[:-1], ends]), flight.size - 1


def _between(start: jax.Array, inner: jax.Array, end: jax.Array) -> jax.Array:
    return jnp.concatenate([start[None], inner, end[None]])


def _steps_at(offsets: jax.Array, gaps: jax.Array, even: jax.Array) -> list[jax.Array]:
    """Separations [m] where forces of the highest summits step, by their gaps, shape (steps, n).

    None within the piece next to the turning point, where the body hardly moves.
    """
    highest = jax.lax.top_k(offsets, min(_CUT, offsets.size))[1]
    cuts = (offsets + gaps)[:, highest].ravel()
    return [jnp.where(cuts < even[1], even[1], cuts)]


def leave_damped(body: Body, outward: Outward, kinetic: jax.Array) -> Departure:
    """The way out of a body that drags slow, with a kinetic energy [J] where it turns."""
    ends = ends_outwards(body, outward)
    now, _ = _over(body, outward.path, ends, kinetic)
    last = SummitPiece(outward.path, ends[now.piece], ends[now.piece + 1])
    return departed(body, now, last)


def ends_outwards(body: Body, outward: Outward) -> jax.Array:
    """Ends of the pieces of a way out [m]."""
    even = _between(outward.start, outward.even(_SHARES), outward.end)
    touching = jnp.zeros((1, outward.recovered.size))
    broken = jnp.concatenate([outward.ends - outward.recovered, touching])
    return _with_cuts(even, _steps_at(outward.recovered, broken, even), body)


def departed(body: Body, now: PhaseProgress, last: Piece) -> Departure:
    """The way out of a body, by its progress and the last piece that it entered."""
    # A body that forces still push out creeps out of them where drag takes its speed.
    pushes = [last.push(place, body.load) for place in (last.enter, last.leave)]
    held = jnp.minimum(*pushes) <= 0.0
    return Departure(~now.going & held, jnp.where(now.going, now.kinetic, 0.0), now.dissipated)


def _rise(body: Body, start: jax.Array, kinetic: jax.Array) -> tuple[jax.Array, jax.Array]:
    """Apex [m] of a body that leaves with a kinetic energy [J], and when it is there [s]."""
    height = body.load.apex_height(start, kinetic)
    ends = _apart(body, start, start + jnp.where(jnp.isfinite(height), height, 0.0))
    up, _ = _over(body, None, ends, kinetic)
    apex, moved = _turned(body, None, ends, up)
    return jnp.where(up.going, ends[-1], apex), up.time + jnp.where(up.going, 0.0, moved.duration)


def _rebound(body: Body, place: jax.Array) -> tuple[jax.Array, jax.Array]:
    down, _ = _over(body, None, _apart(body, body.release, place), body.kinetic)
    return down.kinetic, _rise(body, place, down.kinetic)[0]


rebound = Program(_rebound)
"""Kinetic energy [J] of a body that falls to a place [m], and its apex [m] where it comes back from
there with all of it."""


def _flight(
    body: Body, start: jax.Array, kinetic: jax.Array
) -> tuple[jax.Array, jax.Array, jax.Array]:
    load = body.load
    apex, rising = _rise(body, start, kinetic)
    down, _ = _over(body, None, _apart(body, apex, start), jnp.zeros(()))
    # Where drag stops it on its way down, weight or spring bring it to its summits all the same.
    still = jnp.where(load.force(start) > 0.0, 0.0, jnp.nan)
    back = jnp.where(down.going, down.kinetic, still)
    returns = jnp.isfinite(load.apex_height(start, kinetic)) & (kinetic > 0.0)
    time = rising + down.time
    return jnp.where(returns, back, jnp.nan), jnp.where(returns, time, jnp.inf), apex


flights = Program(jax.vmap(_flight, (None, 0, 0)))
"""Kinetic energies [J] with which bodies come back, times [s] and apices [m]: by body, starts [m],
energies.

NaN and infinite for one that does not come back, 0 where drag stops one on its way back, with the
time until there. Arrays of shape (bodies,)."""
