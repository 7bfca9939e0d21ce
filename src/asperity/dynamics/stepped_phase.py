"""One phase of a motion in time, step by step, where menisci take time to form."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

from .._jax import jax
from ..contact.contact import Contact
from ..contact.delayed_formation import DelayedContact
from ..numerics.compilation import Program
from .curve_table import FORCE, quantities
from .damped_phase import STILL, slow_at
from .static_equilibrium import Reference
from .time_collocation import NODES_IN_TIME, BodyState
from .time_stepping import BOND, MARK, SWITCH, TURN, AcceptedStep, Frame, accepted_step

TURNED, LEFT, AT_REST, FAILED = "turned", "left", "at rest", "failed"
STOPPED = "stopped"
"""How a phase ends: by a turn, at the end of the table, at rest without a turn, not at all, or
where the film alone stops the body."""

_MOST_STEPS = 10_000
_SLOW = 1e-7  # of the speed at the release: the film has stopped a body that is slower
_SPENT = 1e-9  # of the energy with which a body came close to rest: with less it creeps


def _remembered(contact: DelayedContact, here: BodyState) -> Any:
    held = contact.with_threshold(here.memory, here.threshold)
    return contact.base.update_memory(held, here.separation)


_remember = Program(_remembered)
_bond_loss = Program(DelayedContact.loss)


class Ended(Exception):
    """The motion was asked to end."""


class MotionState(NamedTuple):
    """A body between two steps: where, when [s], the next span [s], energy lost by name [J]."""

    here: BodyState
    time: float
    span: float
    lost: np.ndarray


class Samples(NamedTuple):
    """A motion at the points of its steps; the leading axis is the sample.

    Attributes
    ----------
    time, separation, speed
        [s], [m], [m/s].
    rows
        Quantities of the contact.
    lost
        Energy lost since the release, by law, then in the gas if any [J].
    """

    time: np.ndarray
    separation: np.ndarray
    speed: np.ndarray
    rows: np.ndarray
    lost: np.ndarray

    @classmethod
    def joined(cls, parts: list[Samples]) -> Samples:
        """Samples one after the other."""
        return cls(*(np.concatenate(column) for column in zip(*parts, strict=True)))


class TimedPhase(NamedTuple):
    """The phase from one turning point to the next.

    Attributes
    ----------
    state
        Its end.
    fate
        TURNED, LEFT, AT_REST, FAILED or STOPPED.
    maximum_kinetic
        Largest kinetic energy [J].
    pull_work
        Work of the attractive forces [J].
    samples
        The phase, without its start.
    """

    state: MotionState
    fate: str
    maximum_kinetic: float
    pull_work: float
    samples: list[Samples]


class PhaseRules(NamedTuple):
    """What ends a phase, and what it is booked by.

    Attributes
    ----------
    frame
        What does not change.
    losses
        Energy lost by one bond that forms, and that breaks, by law [J].
    rest
        Separations of the equilibrium and of what counts as there [m].
    asked
        Called before each step; raises :class:`Ended` to stop.
    """

    frame: Frame
    losses: tuple[np.ndarray, np.ndarray]
    rest: tuple[float, float]
    asked: Callable[[], None]

    @classmethod
    def of(
        cls,
        contact: Contact,
        frame: Frame,
        reference: Reference,
        rest: float,
        asked: Callable[[], None],
    ) -> PhaseRules:
        """The rules on a contact; ``rest`` as in a tolerance."""
        formed, broken = (np.asarray(x) for x in contact.losses())
        still, release = float(reference.equilibrium), float(frame.body.release)
        goal = still + rest * (release - still)
        if frame.body.damped and np.isfinite(goal):
            frame = frame._replace(marks=np.append(frame.marks, goal))
        return cls(frame, (formed, broken), (still, goal), asked)


def phase_in_time(rules: PhaseRules, state: MotionState, sign: int) -> TimedPhase:
    """From a turning point, inwards (-1) or outwards (1), to the next."""
    frame = rules.frame
    mass = float(frame.body.mass)
    phase = TimedPhase(state, "", 0.5 * mass * float(state.here.speed) ** 2, 0.0, [])
    near: TimedPhase | None = None
    while not phase.fate:
        rules.asked()
        taken = accepted_step(
            frame, phase.state.here, sign, phase.state.span, phase.maximum_kinetic
        )
        if taken is None or len(phase.samples) >= _MOST_STEPS:
            return phase._replace(fate=FAILED)
        maximum_kinetic = 0.5 * mass * float(np.max(taken.step.speed**2))
        phase = TimedPhase(
            _after(rules, phase.state, taken, sign),
            _fate(frame, taken, sign),
            max(phase.maximum_kinetic, maximum_kinetic),
            phase.pull_work + float(taken.step.attraction[-1]),
            [*phase.samples, _drawn(rules, phase.state, taken)],
        )
        if taken.event == MARK and taken.mark == rules.rest[1] and sign < 0 and not near:
            near = phase
        if near is not None and _creeps(rules, near, phase):
            return _at_rest(rules, near)
        if not phase.fate and _stands(frame, phase):
            return _at_rest(rules, phase)._replace(fate=STOPPED)
    return phase


def _fate(frame: Frame, taken: AcceptedStep, sign: int) -> str:
    if taken.event == TURN:
        return TURNED
    low, high = frame.ends
    if taken.event == MARK and taken.mark == (low if sign < 0 else high):
        return FAILED if sign < 0 else LEFT
    return ""


def _drawn(rules: PhaseRules, state: MotionState, taken: AcceptedStep) -> Samples:
    """The points of a step."""
    done = taken.step
    lost = state.lost + _lost(rules, state.here, taken)
    time = state.time + taken.span * NODES_IN_TIME
    columns = done.separation, done.speed, done.rows, lost
    return Samples(time, *(column[1:] for column in columns))


def _lost(rules: PhaseRules, here: BodyState, taken: AcceptedStep) -> np.ndarray:
    """Energy lost within a step, by name [J]."""
    delayed, done = rules.frame.contact.meniscus_index, taken.step
    formed, broken = rules.losses
    bonds = done.rows[:, quantities(rules.frame.contact.base).bonds]
    gone = np.maximum(bonds[0] - bonds, 0.0) * broken
    by_law = np.maximum(bonds - bonds[0], 0.0) * formed + gone
    by_law[:, delayed] = done.delayed if here.forming else gone[:, delayed]
    dragged = [done.dissipated[:, None]] if rules.frame.body.damped else []
    return np.concatenate([by_law, *dragged], axis=1)


def _after(rules: PhaseRules, state: MotionState, taken: AcceptedStep, sign: int) -> MotionState:
    """Where a step leaves a body, with the bonds that its end makes and breaks."""
    frame, done = rules.frame, taken.step
    goal = frame.forming[frame.contact.meniscus_index]
    here = state.here._replace(
        separation=done.separation[-1],
        speed=done.speed[-1],
        acceleration=done.acceleration[-1],
        threshold=done.threshold[-1],
    )
    lost = state.lost + _lost(rules, state.here, taken)[-1]
    if taken.event == TURN:
        here = _turned(frame, here._replace(speed=np.zeros(())), sign)
    elif taken.event == SWITCH:
        here = here._replace(threshold=here.separation - goal, forming=np.asarray(False))
    elif taken.event == MARK:
        here = here._replace(separation=np.asarray(taken.mark))
        if sign < 0 and here.separation <= here.threshold + goal + frame.close:
            here = here._replace(forming=np.asarray(True))
    if frame.contact.discrete and taken.event in (MARK, BOND):
        here, gone = _snapped(rules, here, taken.event, sign)
        lost = lost + gone
    return MotionState(here, state.time + taken.span, taken.next_span, lost)


def _turned(frame: Frame, here: BodyState, sign: int) -> BodyState:
    """The memory after a turn."""
    contact = frame.contact
    memory = jax.tree_util.tree_map(np.asarray, _remember(contact, here))
    goal = here.separation - frame.forming[contact.meniscus_index]
    breaking = here.separation - frame.breaking[contact.meniscus_index]
    # At the deepest point a threshold that follows at once is there already.
    behind = here.forming & ((sign > 0) | (here.threshold > goal + frame.close))
    threshold = np.maximum(here.threshold, breaking)
    return here._replace(memory=memory, threshold=threshold, forming=behind)


def _snapped(
    rules: PhaseRules, here: BodyState, event: str, sign: int
) -> tuple[BodyState, np.ndarray]:
    """A smooth body's bonds made or broken at a place, and the energy lost by name [J]."""
    frame, delayed = rules.frame, rules.frame.contact.meniscus_index
    formed, broken = rules.losses
    place, held = here.separation, here.memory > 0.5
    made = ~held & (place <= frame.forming + frame.close) & (sign < 0)
    gone = held & (place >= frame.breaking - frame.close) & (sign > 0)
    made[delayed] = event == BOND
    lost = np.where(made, formed, 0.0) + np.where(gone, broken, 0.0)
    if made[delayed]:
        lost[delayed] = float(_bond_loss(frame.contact, place))
        here = here._replace(threshold=np.zeros(()))
    memory = np.where(made, 1.0, np.where(gone, 0.0, here.memory))
    rest = np.zeros(len(frame.body.mechanisms))
    return here._replace(memory=memory), np.concatenate([lost, rest])


def _kinetic(frame: Frame, state: MotionState) -> float:
    return 0.5 * float(frame.body.mass) * float(state.here.speed) ** 2


def _stands(frame: Frame, phase: TimedPhase) -> bool:
    """Whether the film has stopped a body where nothing moves it; see :data:`STILL`."""
    body = frame.body
    if not body.damped or float(body.weight) > 0.0:
        return False
    released = float(body.kinetic)
    push = abs(float(phase.samples[-1].rows[-1, FORCE]) * float(body.release))
    return _kinetic(frame, phase.state) <= _SLOW**2 * released and push <= STILL * released


def _creeps(rules: PhaseRules, near: TimedPhase, phase: TimedPhase) -> bool:
    """Whether a body that came near its rest stays there."""
    still, goal = rules.rest
    place = float(phase.state.here.separation)
    kinetic = _kinetic(rules.frame, near.state)
    if phase.fate == TURNED:
        slow = bool(slow_at(rules.frame.body, kinetic, phase.maximum_kinetic, rules.rest))
        return slow and place > still - (goal - still)
    slow = _kinetic(rules.frame, phase.state) < _SPENT * kinetic
    return slow and place > still


def _at_rest(rules: PhaseRules, near: TimedPhase) -> TimedPhase:
    """A phase that ends where the body came near its rest; what is left goes to the gas."""
    state = near.state
    lost = state.lost.copy()
    lost[-1] += _kinetic(rules.frame, state)
    last = near.samples[-1]
    speed, losses = last.speed.copy(), last.lost.copy()
    speed[-1], losses[-1] = 0.0, lost
    state = state._replace(here=state.here._replace(speed=np.zeros(())), lost=lost)
    samples = [*near.samples[:-1], last._replace(speed=speed, lost=losses)]
    return near._replace(state=state, fate=AT_REST, samples=samples)
