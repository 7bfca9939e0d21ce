"""A rigid or smooth body whose menisci take time to form, from one turning point to the next."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

from .._jax import jax, jnp
from ..contact.delayed_formation import DelayedContact
from ..numerics.compilation import Program
from .curve_table import FORCE, quantities, read_row
from .damped_phase import STILL, slow_at
from .stepped_phase import AT_REST, FAILED, LEFT, STOPPED, TURNED, Samples, SteppedPhase
from .stepped_record import Ledger
from .time_collocation import NODES_IN_TIME, BodyState
from .time_stepping import BOND, MARK, SWITCH, TURN, AcceptedStep, Frame, accepted_step

_MOST_STEPS = 10_000
_SLOW = 1e-7  # of the speed at the release: the film has stopped a body that is slower
_SPENT = 1e-9  # of the energy with which a body came close to rest: with less it creeps


def _remembered(contact: DelayedContact, here: BodyState) -> Any:
    held = contact.with_threshold(here.memory, here.threshold)
    return contact.base.update_memory(held, here.separation)


_remember = Program(_remembered)
_bond_loss = Program(DelayedContact.loss)


class _Now(NamedTuple):
    """A body between two steps: where, when [s], the next span [s], energy lost by name [J]."""

    here: BodyState
    time: float
    span: float
    lost: np.ndarray


class DelayedBounce:
    """A body that is let go in equilibrium with the vapour.

    Parameters
    ----------
    delayed
        The contact with menisci that take time.
    ledger
        What moves on what, and where it ends.
    asked
        Called before each step; it may raise to stop.
    """

    def __init__(self, delayed: DelayedContact, ledger: Ledger, asked: Callable[[], None]) -> None:
        contact, body, (table, _) = ledger.contact, ledger.body, ledger.prepared
        self._delayed, self._body, self._asked = delayed, body, asked
        self._formed, self._broken = (np.asarray(x) for x in contact.losses())
        self._still, near, _ = ledger.ends
        self._goal = self._still + near
        frame = Frame.of(contact, delayed, body, table)
        if body.damped and np.isfinite(self._goal):
            frame = frame._replace(marks=np.append(frame.marks, self._goal))
        self._frame = frame
        here = BodyState(
            separation=body.release,
            speed=-body.speed,
            acceleration=-body.gravity,
            threshold=body.release - delayed.law.forming_gap,
            memory=contact.initial_memory(),
            forming=jnp.asarray(True),
        )
        here = jax.tree_util.tree_map(np.asarray, here)
        lost = np.zeros(len(contact.mechanisms) + len(body.mechanisms))
        gravity, speed = float(body.gravity), float(body.speed)
        depth = abs(float(body.release))
        span = 0.1 * (depth / speed if speed > 0.0 else np.sqrt(2.0 * depth / gravity))
        self._now = _Now(here, 0.0, span, lost)
        row = read_row(table, 0, float(body.release))[: quantities(contact).components.stop]
        columns = (0.0, here.separation, here.speed, row, lost)
        self._release = Samples(*(np.asarray(x)[None] for x in columns))

    def start(self) -> Samples:
        """The sample of the release."""
        return self._release

    @property
    def threshold(self) -> float:
        """Threshold of the menisci that are still forming [m]."""
        return float(self._now.here.threshold)

    def phase(self, inwards: bool) -> SteppedPhase:
        """The phase until the body turns."""
        sign, work, largest = -1 if inwards else 1, 0.0, self._kinetic(self._now.here.speed)
        parts = [Samples(*(column[:0] for column in self._release))]
        near: tuple[_Now, int, float] | None = None  # where it came close to its rest
        fate = ""
        while not fate:
            self._asked()
            taken = accepted_step(self._frame, self._now.here, sign, self._now.span, largest)
            if taken is None or len(parts) > _MOST_STEPS:
                fate = FAILED
                break
            parts.append(self._drawn(taken))
            self._now, fate = self._after(taken, sign), self._fate(taken, sign)
            largest = max(largest, self._kinetic(np.max(np.abs(taken.step.speed))))
            work += float(taken.step.attraction[-1])
            if inwards and near is None and taken.event == MARK and taken.mark == self._goal:
                near = self._now, len(parts), work
            if near is not None and self._creeps(near[0], fate, largest):
                self._now, count, work = near
                return self._at_rest(AT_REST, parts[:count], work)
            if not fate and self._stands(float(parts[-1].rows[-1, FORCE])):
                return self._at_rest(STOPPED, parts, work)
        return SteppedPhase(fate, Samples.joined(parts), -work)

    def _kinetic(self, speed: Any) -> float:
        return 0.5 * float(self._body.mass) * float(speed) ** 2

    def _fate(self, taken: AcceptedStep, sign: int) -> str:
        if taken.event == TURN:
            return TURNED
        low, high = self._frame.ends
        if taken.event == MARK and taken.mark == (low if sign < 0 else high):
            return FAILED if sign < 0 else LEFT
        return ""

    def _drawn(self, taken: AcceptedStep) -> Samples:
        """The points of a step."""
        done = taken.step
        lost = self._now.lost + self._lost(taken)
        time = self._now.time + taken.span * NODES_IN_TIME
        columns = done.separation, done.speed, done.rows, lost
        return Samples(time, *(column[1:] for column in columns))

    def _lost(self, taken: AcceptedStep) -> np.ndarray:
        """Energy lost within a step, by name [J]."""
        delayed, done = self._delayed.meniscus_index, taken.step
        bonds = done.rows[:, quantities(self._delayed.base).bonds]
        gone = np.maximum(bonds[0] - bonds, 0.0) * self._broken
        by_law = np.maximum(bonds - bonds[0], 0.0) * self._formed + gone
        by_law[:, delayed] = done.delayed if self._now.here.forming else gone[:, delayed]
        dragged = [done.dissipated[:, None]] if self._body.damped else []
        return np.concatenate([by_law, *dragged], axis=1)

    def _after(self, taken: AcceptedStep, sign: int) -> _Now:
        """Where a step leaves the body, with the bonds that its end makes and breaks."""
        done, close = taken.step, self._frame.close
        form = self._frame.forming[self._delayed.meniscus_index]
        here = self._now.here._replace(
            separation=done.separation[-1],
            speed=done.speed[-1],
            acceleration=done.acceleration[-1],
            threshold=done.threshold[-1],
        )
        lost = self._now.lost + self._lost(taken)[-1]
        if taken.event == TURN:
            here = self._turned(here._replace(speed=np.zeros(())), sign)
        elif taken.event == SWITCH:
            here = here._replace(threshold=here.separation - form, forming=np.asarray(False))
        elif taken.event == MARK:
            here = here._replace(separation=np.asarray(taken.mark))
            if sign < 0 and here.separation <= here.threshold + form + close:
                here = here._replace(forming=np.asarray(True))
        if self._delayed.discrete and taken.event in (MARK, BOND):
            here, gone = self._snapped(here, taken.event, sign)
            lost = lost + gone
        return _Now(here, self._now.time + taken.span, taken.next_span, lost)

    def _turned(self, here: BodyState, sign: int) -> BodyState:
        """The memory after a turn."""
        frame, delayed = self._frame, self._delayed.meniscus_index
        memory = jax.tree_util.tree_map(np.asarray, _remember(self._delayed, here))
        goal = here.separation - frame.forming[delayed]
        breaking = here.separation - frame.breaking[delayed]
        # At the deepest point a threshold that follows at once is there already.
        behind = here.forming & ((sign > 0) | (here.threshold > goal + frame.close))
        threshold = np.maximum(here.threshold, breaking)
        return here._replace(memory=memory, threshold=threshold, forming=behind)

    def _snapped(self, here: BodyState, event: str, sign: int) -> tuple[BodyState, np.ndarray]:
        """A smooth body's bonds made or broken at a place, and the energy lost by name [J]."""
        frame, delayed = self._frame, self._delayed.meniscus_index
        place, held = here.separation, here.memory > 0.5
        made = ~held & (place <= frame.forming + frame.close) & (sign < 0)
        gone = held & (place >= frame.breaking - frame.close) & (sign > 0)
        made[delayed] = event == BOND
        lost = np.where(made, self._formed, 0.0) + np.where(gone, self._broken, 0.0)
        if made[delayed]:
            lost[delayed] = float(_bond_loss(self._delayed, place))
            here = here._replace(threshold=np.zeros(()))
        memory = np.where(made, 1.0, np.where(gone, 0.0, here.memory))
        rest = np.zeros(len(self._body.mechanisms))
        return here._replace(memory=memory), np.concatenate([lost, rest])

    def _stands(self, force: float) -> bool:
        """Whether the film has stopped a body where nothing moves it; see :data:`STILL`."""
        body = self._body
        if not body.damped or float(body.weight) > 0.0:
            return False
        released, push = float(body.kinetic), abs(force * float(body.release))
        return self._kinetic(self._now.here.speed) <= _SLOW**2 * released and (
            push <= STILL * released
        )

    def _creeps(self, near: _Now, fate: str, largest: float) -> bool:
        """Whether a body that came near its rest stays there."""
        still, goal = self._still, self._goal
        place, kinetic = float(self._now.here.separation), self._kinetic(near.here.speed)
        if fate == TURNED:
            slow = bool(slow_at(self._body, kinetic, largest, (still, goal)))
            return slow and place > still - (goal - still)
        return self._kinetic(self._now.here.speed) < _SPENT * kinetic and place > still

    def _at_rest(self, fate: str, parts: list[Samples], work: float) -> SteppedPhase:
        """A phase that ends where the body is; what is left of its motion goes to the gas."""
        now, samples = self._now, Samples.joined(parts)
        lost = now.lost.copy()
        lost[-1] += self._kinetic(now.here.speed)
        samples.speed[-1], samples.lost[-1] = 0.0, lost
        self._now = now._replace(here=now.here._replace(speed=np.zeros(())), lost=lost)
        return SteppedPhase(fate, samples, -work)
