"""A rough body on a half-space that creeps, from one turning point to the next."""

from __future__ import annotations

from collections.abc import Callable
from math import inf, sqrt
from typing import Any

import numpy as np

from ..._jax import jax, jnp
from ...contact.elastic import ElasticContact
from ...contact.equilibrium import profile_of
from ...contact.viscoelastic import Relaxation
from ...interface.rough_planes import Memory as Thresholds
from ...numerics.compilation import Program
from ..curve_table import CENTRAL, STORED, quantities
from ..record import Body
from ..stepped_phase import AT_REST, FAILED, LEFT, TURNED, Samples, SteppedPhase
from .ring_menisci import FreeFlight
from .ring_step import RingStep, step
from .ring_system import Freed, RingState, freed
from .sample_times import flight_times

TOLERANCE = 1e-9
"""Error of a step, relative to the speed and energy of the impact, and to the separation and the
displacement of the bulk, or to the rms height where that is more."""

_MOST = 20_000  # steps of a phase
_TRIAL = 1e-6  # error of a step of a body that falls for its depth alone
_FIRST = 0.02  # rms heights: the length of the first step into the forces
_STRIDE = 0.5  # of the rms height or half the gap: by about so much the gap at the axis changes
_UNLOADING_STRIDE = 0.1  # the same on the first way out, which the pull-off force is read from
_POLISH = 12  # of the length of a step that ends at a turn
_SPENT = 1e-9  # of the energy of the fall from where a body counts as at rest

_step = Program(step)
_freed = Program(freed)
_profile_of = Program(profile_of)


class RoughBounce:
    """A rough body that falls on a half-space that creeps.

    Parameters
    ----------
    relaxation, body
        The half-space with its contact, and what falls.
    size
        Size of the mesh of rings [m].
    ends
        Separation at which it rests, how close counts as there, and where it has left [m].
    asked
        Called before each step; it may raise to stop.
    trial
        Whether it falls for its depth alone, in long steps.
    """

    def __init__(
        self,
        relaxation: Relaxation,
        body: Body,
        size: float,
        ends: tuple[float, float, float],
        asked: Callable[[], None],
        *,
        trial: bool = False,
    ) -> None:
        base: Any = relaxation.contact
        self._contact: ElasticContact = base
        self.relaxation, self.body, self.size = relaxation, body, size
        self.ends, self._asked = ends, asked
        self._tolerance = _TRIAL if trial else TOLERANCE
        self._rms = float(base.interface.scale.rms)
        self._interaction_range = float(base.interaction_range)
        self._profile = np.asarray(_profile_of(base, np.asarray(size, float)))
        self._rate = float(relaxation.ratio / relaxation.time)
        self._gravity, self._mass = float(body.gravity), float(body.mass)
        self._columns = quantities(base).components.stop
        self._delayed = relaxation.delayed
        self.lost = np.zeros(len(base.mechanisms) + len(body.in_bulk))
        self.time, self.fit, self._phases, self._energy_at_edge = 0.0, 1.0, 0, 0.0
        gaps = float(body.release) + self._profile
        thresholds = base.interface.initial_memory(np.zeros(base.rings + 1))
        if relaxation.delayed is not None:  # in equilibrium with the vapour
            goal = gaps - float(relaxation.delayed.law.forming_gap)
            thresholds = relaxation.delayed.with_threshold(thresholds, jnp.asarray(goal))
        here = RingState(body.release, -body.speed, gaps, np.zeros(base.rings), thresholds)
        self.here: RingState = jax.tree_util.tree_map(np.asarray, here)
        # A body may be let go at rest where forces begin; a fall by a height is its first scale.
        speed = sqrt(float(body.speed) ** 2 + 2.0 * self._gravity * self._rms)
        self.maximum_kinetic = 0.5 * self._mass * speed**2
        self._span = _FIRST * self._rms / speed

    def start(self) -> Samples:
        """The sample of the release."""
        sample, edge = self._free_flight_samples(self._left(), np.zeros(1)), self._edge()
        begin = self.here._replace(separation=np.asarray(edge), gaps=edge + self._profile)
        self._energy_at_edge = float(self._try(0.0, begin).row[STORED])
        if float(self.here.separation) > edge:
            return sample
        done = self._try(0.0)  # something acts already: the rings come to their equilibrium
        self.here = done.here
        return sample._replace(rows=done.row[None])

    def phase(self, inwards: bool) -> SteppedPhase:
        """The phase until the body turns."""
        self._phases += 1
        parts: list[Samples] = [self._free_flight_samples(self._left(), np.zeros(0))]
        for _ in range(_MOST):
            self._asked()
            free = float(self.here.separation) > self._edge()
            fate, samples = (self._free_flight if free else self._go)(inwards)
            parts.append(samples)
            if fate:
                return SteppedPhase(fate, Samples.joined(parts))
        return SteppedPhase(FAILED, Samples.joined(parts))

    def _left(self) -> Freed:
        """What creep has left."""
        answer = _freed(self.relaxation, np.asarray(self.size), self.here.retarded)
        return jax.tree_util.tree_map(np.asarray, answer)

    def _edge(self) -> float:
        """Separation beyond which nothing acts [m]: the range, and what stands out of the bulk."""
        displacement = self.here.gaps - self._profile - self.here.separation
        return self._interaction_range + max(0.0, -float(np.min(displacement)))

    def _free_flight(self, inwards: bool) -> tuple[str, Samples]:
        """Without forces: to the apex, or to where they begin."""
        place, speed, g = float(self.here.separation), float(self.here.speed), self._gravity
        left = self._left()
        if inwards:
            fall = place - self._edge() * (1.0 - 1e-9)
            fast = sqrt(speed**2 + 2.0 * g * fall)
            span, fate = 2.0 * fall / (fast - speed), ""
        elif g > 0.0:
            span, fate = speed / g, TURNED
        else:
            span, fate = max(self.ends[2] - place, 0.0) / speed, LEFT
        fast = max(abs(speed), abs(speed - g * span), 1e-300)
        scale = min(1.0 / self._rate, self._rms / fast)
        samples = self._free_flight_samples(left, flight_times(span, scale))
        share = np.exp(-self._rate * span)
        thresholds = self._waited(span)
        place = float(samples.separation[-1])
        self.here = self.here._replace(
            thresholds=thresholds,
            separation=np.asarray(place),
            speed=np.asarray(0.0 if fate == TURNED else samples.speed[-1]),
            retarded=self.here.retarded * share,
            gaps=place + self._profile + left.displacement * share,
        )
        self.time, self.lost = float(samples.time[-1]), samples.lost[-1].copy()
        self._span = _FIRST * self._rms / max(abs(float(samples.speed[-1])), 1e-300)
        fast = float(np.max(np.abs(samples.speed)))
        self.maximum_kinetic = max(self.maximum_kinetic, 0.5 * self._mass * fast**2)
        return fate, samples

    def _waited(self, span: float) -> Thresholds:
        """Thresholds after a flight: those of menisci that take time go on falling, or are left.

        All others stand where they are, until the body comes back.
        """
        held, delayed, here = self.here.thresholds, self._delayed, self.here
        if delayed is None:
            return held
        form, part = float(delayed.law.forming_gap), float(delayed.law.breaking_gap)
        flight = FreeFlight(np.asarray(here.gaps) - form, float(here.speed), self._gravity)
        before, rate = np.asarray(held[delayed.meniscus_index]), 1.0 / float(delayed.time)
        after = flight.follow(before, span, rate)
        return delayed.with_threshold(
            held, np.maximum(after, flight.goal(np.asarray(span)) + form - part)
        )

    @property
    def threshold(self) -> float:
        """Threshold of the menisci that take time at the mesh's end [m], 0 where none do."""
        if self._delayed is None:
            return 0.0
        return float(self.here.thresholds[self._delayed.meniscus_index][-1])

    def _free_flight_samples(self, left: Freed, spans: np.ndarray) -> Samples:
        """Samples of a flight at times from now."""
        share = np.exp(-self._rate * spans)
        place = float(self.here.separation) + spans * (
            float(self.here.speed) - 0.5 * self._gravity * spans
        )
        rows = np.zeros((spans.size, self._columns))
        rows[:, STORED] = float(left.stored) * share**2
        rows[:, CENTRAL] = place + float(left.axis) * share
        lost = np.repeat(self.lost[None], spans.size, axis=0)
        if self._delayed is None:
            lost[:, -1] += float(left.stored) * (1.0 - share**2)
        speed = float(self.here.speed) - self._gravity * spans
        return Samples(self.time + spans, place, speed, rows, lost)

    def _go(self, inwards: bool) -> tuple[str, Samples]:
        """One step within the interaction range, that ends where the body turns."""
        done, span = self._taken(inwards)
        if done is None:
            return FAILED, self._free_flight_samples(self._left(), np.zeros(0))
        self.here, self.fit = done.here, float(done.fit)
        self.time += span
        self.lost = self.lost + done.lost
        speed = float(self.here.speed)
        self.maximum_kinetic = max(self.maximum_kinetic, 0.5 * self._mass * speed**2)
        fate = ""
        if abs(speed) <= self._still:
            fate, speed = TURNED, 0.0
            self.here = self.here._replace(speed=np.asarray(0.0))
        elif self._rests():
            fate = AT_REST
        time, place = np.array([self.time]), np.array([float(self.here.separation)])
        return fate, Samples(time, place, np.array([speed]), done.row[None], self.lost[None])

    @property
    def _still(self) -> float:
        """Speed that counts as none [m/s]."""
        return 1e-11 * sqrt(2.0 * self.maximum_kinetic / self._mass)

    def _rests(self) -> bool:
        """Whether the body is at rest, but for what is too slow to matter."""
        rest, near, _ = self.ends
        here = self.here
        if not abs(float(here.separation) - rest) <= near:
            return False
        energy = 0.5 * self._mass * float(here.speed) ** 2
        return energy <= _SPENT * self._mass * self._gravity * near

    def _taken(self, inwards: bool) -> tuple[RingStep | None, float]:
        """A step that is precise enough, and its length [s]."""
        ahead = -1.0 if inwards else 1.0
        span, least = self._span, 1e-9 * self._span
        while span > least:
            done = self._try(span)
            error = self._error(done)
            factor = 0.9 * max(error, 1e-9) ** -0.25 if np.isfinite(error) else 0.2
            if error <= 1.0:
                next_span = span * min(factor, 2.0)
                if ahead * float(done.here.speed) < -self._still:
                    turn = self._turn(done, span, ahead)
                    if turn is not None:
                        self._span = max(0.5 * turn[1], 0.1 * span)
                        return turn
                    span *= 0.5
                    continue
                # A deep body moves far while the gap at its axis hardly changes.
                before, gap = float(self.here.gaps[0]), float(done.here.gaps[0])
                share = _UNLOADING_STRIDE if self._phases == 2 else _STRIDE
                stride = share * max(self._rms, 0.5 * gap)
                self._span = min(next_span, span * stride / max(abs(gap - before), 1e-300))
                place, speed = float(done.here.separation), float(done.here.speed)
                left = self._interaction_range - place
                if left > 0.0 and speed > 0.0:  # the last step ends where forces do
                    self._span = min(self._span, max(left, 1e-3 * self._rms) / speed)
                return done, span
            span *= min(max(factor, 0.1), 0.9)
        return None, span

    def _turn(self, done: RingStep, span: float, ahead: float) -> tuple[RingStep, float] | None:
        """The step that ends where the speed is 0: a root between no step and this one."""
        low, high = 0.0, span
        at_low, at_high = ahead * float(self.here.speed), ahead * float(done.here.speed)
        if at_low <= 0.0:  # it starts from a turn, and its slope decides
            return None
        for _ in range(_POLISH):
            guess = span - float(done.here.speed) / float(done.rates[0])
            if not low < guess < high:
                guess = low + (high - low) * at_low / (at_low - at_high)
            span, done = guess, self._try(guess)
            value = ahead * float(done.here.speed)
            if not done.solved:
                return None
            if abs(value) <= self._still:
                return done, span
            low, at_low = (span, value) if value > 0.0 else (low, at_low)
            high, at_high = (high, at_high) if value > 0.0 else (span, value)
        return done, span

    def _try(self, span: float, here: RingState | None = None) -> RingStep:
        here = self.here if here is None else here
        done = _step(self.relaxation, self.body, np.asarray(self.size), here, np.asarray(span))
        answer: RingStep = jax.tree_util.tree_map(np.asarray, done)
        row = np.array(answer.row)  # forces of any range end at the edge, and their energy too
        row[STORED] -= self._energy_at_edge
        return answer._replace(row=row)

    def _error(self, done: RingStep) -> float:
        """Error of a step over what is allowed; infinite where it is not solved."""
        if not done.solved or not np.all(np.isfinite(done.row)):
            return inf
        energy = max(self.maximum_kinetic, 0.5 * self._mass * float(done.here.speed) ** 2)
        speed = sqrt(2.0 * energy / self._mass)
        separation = float(done.here.separation)
        displaced = float(np.max(np.abs(done.here.gaps - self._profile - separation)))
        lengths = np.maximum(self._rms, [abs(separation), displaced])
        scale = np.array([lengths[0], speed, lengths[1], energy])
        return float(np.max(done.error / scale)) / self._tolerance
