"""Steps in time that end where a bond is made or broken, or a body turns."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.polynomial import legendre

from .._jax import jax
from ..contact.contact import Contact, interaction_range_of
from ..contact.delayed_formation import DelayedContact
from ..contact.smooth import SmoothContact
from ..laws.law import terms
from ..numerics.compilation import Program
from .curve_table import Table
from .record import Body
from .time_collocation import NODES_IN_TIME, STAGES, BodyState, CollocationStep, step

TURN, SWITCH, MARK, BOND = "turn", "switch", "mark", "bond"
"""What ends a step: speed 0, a threshold caught up with, a separation, a smooth body's meniscus."""

_TOLERANCE = 1e-8  # of what the polynomials miss at a step's start; its end is far closer
_CLOSE = 1e-13  # relative: what counts as the same place
_LEAST = 1e-12  # of a phase's first step: a shorter one is a failure
_POLISH = 8  # steps of Newton's method towards an event
KNOTS = np.append(0.0, NODES_IN_TIME)
"""Start and points of a step, as fractions of it."""

TO_SERIES = np.linalg.inv(legendre.legvander(2.0 * KNOTS - 1.0, STAGES))
_GRID = np.linspace(0.0, 1.0, 33)[1:]
_ON_GRID = legendre.legvander(2.0 * _GRID - 1.0, STAGES) @ TO_SERIES

_step = Program(step)


class Frame(NamedTuple):
    """What does not change along a motion.

    Attributes
    ----------
    contact, body
        What moves on what.
    ends
        Separations that bound the motion [m].
    marks
        Separations at which steps end [m]: where smooth bodies have kinks, and the interaction
        range.
    forming, breaking
        Gaps by law [m].
    interaction_range
        Separation beyond which nothing is felt [m].
    """

    contact: DelayedContact
    body: Body
    ends: tuple[float, float]
    marks: np.ndarray
    forming: np.ndarray
    breaking: np.ndarray
    interaction_range: float

    @property
    def close(self) -> float:
        """Separations as near as this are the same [m]."""
        return _CLOSE * self.interaction_range

    @classmethod
    def of(cls, contact: Contact, delayed: DelayedContact, body: Body, table: Table) -> Frame:
        """The frame of a contact whose major branches are tabulated."""
        ends = float(table.ends[0]), float(table.ends[-1])
        interaction_range = float(interaction_range_of(contact))
        forming, breaking = (
            np.array([float(gap) for gap in gaps])
            for gaps in zip(
                *((law.forming_gap, law.breaking_gap) for law in delayed.laws), strict=True
            )
        )
        marks = [*ends, interaction_range]
        if isinstance(contact, SmoothContact):
            kinks = [float(gap) for law in terms(contact.law) for gap in law.kinks]
            marks += [*forming, *breaking, *kinks]
        return cls(delayed, body, ends, np.unique(marks), forming, breaking, interaction_range)

    def next_mark(self, here: BodyState, sign: int) -> float:
        """The next separation [m] at which the force changes its law."""
        place, delayed = float(here.separation), self.contact.meniscus_index
        rough = not self.contact.discrete
        gaps = self.forming if sign < 0 else self.breaking
        held = [float(b) for b in here.memory] if rough else [np.nan] * len(gaps)
        held[delayed] = float(here.threshold)
        if here.forming:
            held[delayed] = np.nan
        marks = np.concatenate([self.marks, np.array(held) + gaps])
        ahead = marks[sign * (marks - place) > self.close]
        return float(sign * np.min(sign * ahead)) if ahead.size else sign * np.inf


class AcceptedStep(NamedTuple):
    """A step that was taken.

    Attributes
    ----------
    step
        The step, as NumPy's arrays.
    span
        Its length [s].
    next_span
        How long the next one may be [s].
    event
        What ended it; empty where nothing did.
    mark
        The separation that did [m].
    """

    step: CollocationStep
    span: float
    next_span: float
    event: str
    mark: float


def go(frame: Frame, here: BodyState, span: float) -> CollocationStep:
    """One step, as NumPy's arrays."""
    # Everything as arrays: a plain number would be static, and compile anew.
    here = jax.tree_util.tree_map(np.asarray, here)
    done = _step(frame.contact, frame.body, here, np.asarray(span))
    answer: CollocationStep = jax.tree_util.tree_map(np.asarray, done)
    return answer


def accepted_step(
    frame: Frame, here: BodyState, sign: int, span: float, maximum_kinetic: float
) -> AcceptedStep | None:
    """The next step of a phase, at most ``span`` [s] long; None where there is none.

    ``maximum_kinetic`` is the largest kinetic energy of the phase so far [J].
    """
    least = _LEAST * span
    while span > least:
        done = go(frame, here, span)
        error = _error(frame, done, maximum_kinetic)
        factor = 0.9 * max(error, 1e-12) ** (-1.0 / STAGES) if np.isfinite(error) else 0.1
        if error <= 1.0:
            mark = frame.next_mark(here, sign)
            event = _first_event(frame, here, done, sign, mark)
            if event is None:
                return AcceptedStep(done, span, span * min(factor, 5.0), "", mark)
            name, share = event
            found = _polished(frame, here, name, share * span, sign, mark)
            if found is not None:
                return AcceptedStep(*found, span, name, mark)
            factor = 0.5 * share
        span *= min(max(factor, 0.1), 0.9)
    return None


def _error(frame: Frame, done: CollocationStep, maximum_kinetic: float) -> float:
    """Error of a step over what is allowed; infinite where it is not solved."""
    if not done.solved or not np.all(np.isfinite(done.rows)):
        return np.inf
    mass = float(frame.body.mass)
    energy = max(maximum_kinetic, 0.5 * mass * float(np.max(done.speed**2)))
    scale = np.array([np.sqrt(2.0 * energy / mass), energy])
    return float(np.max(done.defect / scale)) / _TOLERANCE


def _functions(
    frame: Frame, here: BodyState, sign: int, mark: float
) -> dict[str, Callable[..., np.ndarray]]:
    """What rises to 0 at each event, of separation, speed and threshold."""
    goal = frame.forming[frame.contact.meniscus_index]
    events: dict[str, Callable[..., np.ndarray]] = {
        TURN: lambda d, v, b: -sign * v,
        MARK: lambda d, v, b: sign * (d - mark),
    }
    if here.forming and sign > 0:
        events[SWITCH] = lambda d, v, b: d - goal - b
    bonds = here.memory
    if frame.contact.discrete and here.forming and not bonds[frame.contact.meniscus_index]:
        events[BOND] = lambda d, v, b: -b
    return events


def _first_event(
    frame: Frame, here: BodyState, done: CollocationStep, sign: int, mark: float
) -> tuple[str, float] | None:
    """The first event of a step and where in it, by its polynomials."""
    from scipy.optimize import brentq

    values = np.stack([done.separation, done.speed, done.threshold], axis=1)
    series, on_grid = TO_SERIES @ values, _ON_GRID @ values
    found = []
    for name, function in _functions(frame, here, sign, mark).items():
        reached = np.flatnonzero(function(*on_grid.T) >= 0.0)
        if not reached.size:
            continue
        last = _GRID[reached[0]]
        first = last - _GRID[0]

        def along(share: float, function=function) -> float:  # type: ignore[no-untyped-def]
            return float(function(*legendre.legval(2.0 * share - 1.0, series)))

        within = along(first) < 0.0 <= along(last)
        found.append((brentq(along, first, last, xtol=1e-15) if within else last, name))
    return min(found)[::-1] if found else None


def _polished(
    frame: Frame, here: BodyState, name: str, span: float, sign: int, mark: float
) -> tuple[CollocationStep, float] | None:
    """The step that ends at an event, by Newton's method on its length."""
    function = _functions(frame, here, sign, mark)[name]
    for _ in range(_POLISH):
        done = go(frame, here, span)
        if not done.solved:
            return None
        at = done.separation[-1], done.speed[-1], done.threshold[-1]
        slope = {
            TURN: -sign * done.acceleration[-1],
            MARK: sign * done.speed[-1],
            SWITCH: done.speed[-1] - done.rate[-1],
            BOND: -done.rate[-1],
        }[name]
        change = -float(function(*at)) / float(slope) if slope > 0.0 else np.inf
        if abs(change) <= _CLOSE * span:
            return done, span
        if not 0.0 < span + change < 2.0 * span:
            return None
        span += change
    return done, span
