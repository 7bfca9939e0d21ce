"""The path of a rigid body on summits whose menisci take time to form.

As in :mod:`asperity.contact.delayed_formation` a meniscus forms where a separation that lags behind
the body's comes to its gap. The lagging separation D follows the body's d by dD/dt = (d - D)/time.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.polynomial import chebyshev

from .._jax import jax, jnp
from ..numerics.polynomials import chebyshev_sum
from ..numerics.roots import root_between
from ..numerics.trees import choose
from .damped_phase import PhaseProgress
from .damped_summits import (
    SummitPiece,
    Within,
    arrived,
    departed,
    ends_inwards,
    ends_outwards,
)
from .damped_turning_point import turn_on
from .delayed_path import Delay, DelayedPath, Formation, prompt_path
from .drag import GAUSS, PACE, POINTS, SHARES, UNTIL, WHOLE, PieceMotion, move_on
from .record import Body
from .summit_path import Arrival, Departure, Launch, Outward, SummitPath, arrive

_TO_SERIES = np.linalg.inv(chebyshev.chebvander(2.0 * GAUSS - 1.0, POINTS - 1))
_FINE = np.linspace(0.0, 1.0, 33)
_GROWTH = 64.0  # times as much kinetic energy at the end of a step as at its start, at most
_MOST_STEPS = 400  # of a phase beside two for each summit


class _Now(NamedTuple):
    """A body between two steps: its separation [m], and the menisci there.

    ``event`` is the separation [m] at which the next meniscus forms; NaN where none is known to.
    ``halted`` is whether the body turns before it comes to the end of its piece. ``before`` is the
    kinetic energy [J] with which it entered the first piece on its summits.
    """

    progress: PhaseProgress
    separation: jax.Array
    menisci: Formation
    event: jax.Array
    halted: jax.Array
    before: jax.Array
    steps: jax.Array


class _Phase(NamedTuple):
    """What does not change along a phase, over pieces between the ``ends`` [m].

    ``gaps`` are those at which menisci form [m], ``first`` is the first piece on summits.
    """

    body: Body
    delay: Delay
    prompt: SummitPath
    gaps: jax.Array
    ends: jax.Array
    first: int = 0
    outwards: bool = False

    def piece(self, now: _Now) -> SummitPiece:
        """What is left of the piece that a body is on."""
        path = DelayedPath(self.prompt, now.menisci.formed, self.delay.law)
        return SummitPiece(path, now.separation, self.ends[now.progress.piece + 1])

    def lagging(
        self, piece: SummitPiece, moved: PieceMotion, lag: jax.Array, stop: jax.Array
    ) -> tuple[jax.Array, jax.Array]:
        """The lag [m] as Chebyshev coefficients over the course to ``stop``, and at its end.

        By collocation at the points of the motion.
        """
        span = stop - piece.enter
        pace = jnp.abs(span) * PACE / (jnp.where(moved.speed > 0.0, moved.speed, jnp.inf))
        rate = pace / self.delay.time
        system = jnp.eye(POINTS) + UNTIL * rate
        lags = jnp.linalg.solve(system, (lag - span * SHARES)[:, None])[:, 0]
        return _TO_SERIES @ lags, lag - span - WHOLE @ (rate * lags)

    def awaited(self, menisci: Formation) -> jax.Array:
        """The lagging separation [m] at which each summit's meniscus forms, if it has none."""
        return jnp.where(menisci.formed, -jnp.inf, self.prompt.offsets + self.gaps)

    def next_event(
        self, now: _Now, piece: SummitPiece, series: jax.Array, stop: jax.Array
    ) -> jax.Array:
        """Where on the course to ``stop`` the next meniscus forms [m]; NaN where none does."""
        goal, span = jnp.max(self.awaited(now.menisci)), stop - piece.enter

        def separation_at(y: jax.Array) -> jax.Array:
            return piece.enter + span * jnp.sin(0.5 * np.pi * y) ** 2

        def above(y: jax.Array) -> jax.Array:
            return separation_at(y) + chebyshev_sum(series, 2.0 * y - 1.0) - goal

        fine = above(jnp.asarray(_FINE)).at[0].set(piece.enter + now.menisci.lag - goal)
        first = jnp.argmax(fine <= 0.0)
        inner = jnp.asarray(_FINE)[jnp.maximum(first - 1, 0)]
        y = root_between(above, inner, jnp.asarray(_FINE)[first], 1e-15)
        separation = jnp.where(first == 0, piece.enter, separation_at(y))
        follows = (now.menisci.lag > 0.0) if self.outwards else True
        return jnp.where(jnp.any(fine <= 0.0) & follows, separation, jnp.nan)

    def step(self, now: _Now) -> _Now:
        """On to the next meniscus, if it is known where it forms, or towards the piece's end."""
        piece, kinetic, known = self.piece(now), now.progress.kinetic, ~jnp.isnan(now.event)
        push = piece.ahead * piece.push(piece.enter, self.body.load)
        far = _GROWTH * kinetic / jnp.where(push > 0.0, push, 1.0)
        within = (push > 0.0) & (kinetic > 0.0) & (far < jnp.abs(piece.leave - piece.enter))
        limit = jnp.where(within, piece.enter + piece.ahead * far, piece.leave)
        stop = jnp.where(known, now.event, limit)
        moved = move_on(self.body, piece, kinetic, stop)
        series, lag = self.lagging(piece, moved, now.menisci.lag, stop)
        event = self.next_event(now, piece, series, stop)
        event = jnp.where(moved.passed & ~known, event, jnp.nan)
        there = moved.passed & jnp.isnan(event)
        through = there & (stop == piece.leave) & ~known
        menisci = now.menisci._replace(lag=jnp.maximum(lag, 0.0) if self.outwards else lag)
        menisci = choose(known, self.formed(now, stop), menisci)
        # On to the next piece that is not empty.
        passed = jnp.where(self.outwards, self.ends <= stop, self.ends >= stop)
        number = jnp.where(through, jnp.sum(passed) - 1, now.progress.piece)
        begins = (now.progress.piece < self.first) & (number >= self.first)
        progress = now.progress._replace(
            kinetic=jnp.where(there, moved.kinetic, kinetic),
            dissipated=now.progress.dissipated + jnp.where(there, moved.lost, 0.0),
            going=now.progress.going & moved.passed,
            piece=number,
        )
        return _Now(
            progress,
            jnp.where(there, stop, now.separation),
            choose(there, menisci, now.menisci),
            event,
            ~moved.passed,
            jnp.where(begins, moved.kinetic, now.before),
            now.steps + 1,
        )

    def formed(self, now: _Now, separation: jax.Array) -> Formation:
        """The menisci with the next one, which forms at a separation [m]."""
        before, law = now.menisci, self.delay.law
        awaited = self.awaited(before)
        number = jnp.argmax(awaited)
        formed = before.formed.at[number].set(True)
        both = jnp.stack([before.formed, formed])
        work = jax.vmap(lambda some: DelayedPath(self.prompt, some, law).work(separation))(both)
        taken = self.prompt.pressed.summits.lost[law, number] - (work[1] - work[0])
        return Formation(awaited[number] - separation, formed, before.lost.at[number].set(taken))

    def follow(self, now: _Now) -> _Now:
        """On to the end of the last piece, or to the piece on which the body turns.

        Without a kinetic energy where that takes too many steps.
        """
        most = _MOST_STEPS + self.ends.size + 2 * self.gaps.size

        def unfinished(now: _Now) -> jax.Array:
            return (now.progress.piece < self.ends.size - 1) & ~now.halted

        end = jax.lax.while_loop(lambda now: unfinished(now) & (now.steps < most), self.step, now)
        kinetic = jnp.where(unfinished(end), jnp.nan, end.progress.kinetic)
        return end._replace(progress=end.progress._replace(kinetic=kinetic))

    def begin(self, menisci: Formation, kinetic: jax.Array) -> _Now:
        """A body at the first end, with a kinetic energy [J]."""
        nowhere, at_once = jnp.asarray(jnp.nan), jnp.asarray(False)
        progress = PhaseProgress.begun(self.body, kinetic)
        return _Now(progress, self.ends[0], menisci, nowhere, at_once, kinetic, jnp.asarray(0))


class _Turned(NamedTuple):
    """A body where it turns [m], and its motion on the last piece; ``done`` if it does turn."""

    now: _Now
    separation: jax.Array
    moved: PieceMotion
    done: jax.Array


def arrive_delayed(
    body: Body, path: SummitPath, launch: Launch, top: jax.Array, delay: Delay
) -> tuple[Arrival, Formation]:
    """The way in by the summits of ``path``, and the menisci where it ends."""
    # Menisci that form at once draw a body deeper.
    deepest = arrive(body, path, launch, top).turning_point
    ends, first = ends_inwards(body, path, launch, (deepest, top))
    gaps = path.pressed.summits.forming[delay.law]
    phase = _Phase(body, delay, prompt_path(path, delay), gaps, ends, first)
    none = Formation(jnp.zeros(()), jnp.zeros(gaps.shape, bool), jnp.zeros(gaps.shape))

    def turn(so_far: _Turned) -> _Turned:
        """On until the body turns, or a meniscus is known to form before."""
        now = phase.follow(so_far.now)
        piece = phase.piece(now)
        separation, moved = turn_on(body, piece, now.progress.kinetic)
        series, lag = phase.lagging(piece, moved, now.menisci.lag, separation)
        event = jnp.where(now.halted, phase.next_event(now, piece, series, separation), jnp.nan)
        done = jnp.isnan(event)
        menisci = now.menisci._replace(lag=jnp.where(now.halted, lag, now.menisci.lag))
        progress = now.progress._replace(going=now.progress.going | ~done)
        now = now._replace(
            progress=progress,
            menisci=choose(done, menisci, now.menisci),
            event=event,
            halted=now.halted & done,
        )
        return _Turned(now, separation, moved, done)

    still = PieceMotion.none(body, jnp.zeros(()))
    begun = _Turned(phase.begin(none, launch.kinetic), top, still, jnp.asarray(False))
    end = jax.lax.while_loop(lambda so_far: ~so_far.done, turn, begun)
    now, turned = end.now, (end.separation, end.moved)
    at_turn = DelayedPath(phase.prompt, now.menisci.formed, delay.law)
    lost_track = ~now.halted & jnp.isnan(now.progress.kinetic)
    within = Within(now.before, first, jnp.where(lost_track, jnp.nan, deepest), top)
    return arrived(body, at_turn, now.progress, turned, within), now.menisci


def leave_delayed(
    body: Body, outward: Outward, kinetic: jax.Array, menisci: Formation, delay: Delay
) -> tuple[Departure, Formation]:
    """The way out with the menisci where it begins, and those at its end."""
    summits = outward.path.pressed.summits
    prompt = prompt_path(outward.path, delay)
    branch = prompt.pressed.summits.branch(outward.start - outward.recovered)
    prompt = prompt._replace(branch=branch)
    ends = ends_outwards(body, outward)
    phase = _Phase(body, delay, prompt, summits.forming[delay.law], ends, outwards=True)
    now = phase.follow(phase.begin(menisci, kinetic))
    departure = departed(body, now.progress, phase.piece(now))
    if not body.drags:  # nothing makes it creep out
        departure = departure._replace(captured=~now.progress.going)
    return departure, now.menisci
