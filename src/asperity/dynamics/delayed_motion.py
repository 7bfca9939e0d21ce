"""Fall, touch, rebound where menisci take time to form: the motion stepped in time.

The force is then no function of the separation on a branch, and the energy integral does not
hold. What comes out are the same records of a motion.
"""

from __future__ import annotations

import threading
from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

from .._jax import jax, jnp
from ..contact.contact import Contact
from ..contact.delayed_formation import DelayedContact
from ..errors import Outcome
from ..numerics.polynomials import NODES
from .curve_table import CONTACTING, FORCE, STORED, Pieces, Quantities, Table, quantities, read_row
from .motion import LEAST_LOSS
from .record import ENDS, Body, Impacts, Limits, Motion, Phase, Progress
from .static_equilibrium import Reference
from .stepped_phase import (
    AT_REST,
    FAILED,
    LEFT,
    STOPPED,
    TURNED,
    Course,
    Ended,
    Leg,
    Place,
    Samples,
    leg,
)
from .stepped_series import Trajectory
from .time_collocation import Here
from .time_stepping import Frame


class _Stage(NamedTuple):
    """What the impacts of a motion are judged by."""

    course: Course
    layout: Quantities
    origin: float
    resting: float
    limits: Limits

    def kinetic(self, speed: Any) -> Any:
        """Kinetic energy [J]."""
        return 0.5 * float(self.course.frame.body.mass) * speed**2

    def energy(self, samples: Samples) -> np.ndarray:
        """Mechanical energy [J] of samples."""
        above = float(self.course.frame.body.weight) * samples.separation
        whole: np.ndarray = self.kinetic(samples.speed) + above + samples.rows[:, STORED]
        return whole


class _Impact(NamedTuple):
    """One impact: what it started from, both legs, and where they start."""

    start: Place
    begin: Samples
    fall: Leg
    rise: Leg
    middle: Samples
    end: Samples


def integrate_delayed(
    contact: Contact,
    delayed: DelayedContact,
    body: Body,
    prepared: tuple[Table, Reference],
    limits: Limits,
    report: Callable[[int], None],
    stop: threading.Event | None = None,
) -> tuple[Motion, Trajectory, Outcome]:
    """Motion of a body from its release until it rests, escapes, reaches a limit or is stopped.

    Parameters
    ----------
    contact, delayed
        The contact with menisci that form at once, and with those that take time.
    body
        The body and its release, outside contact.
    prepared
        Major branches of ``contact``, and the reference separation.
    limits
        Ends of the motion.
    report
        Called with the number of impacts, after each.
    stop
        Set from another thread, it ends the motion at the last whole impact.

    Raises
    ------
    Ended
        If it is stopped before the first impact is over.
    """

    def asked() -> None:
        if stop is not None and stop.is_set():
            raise Ended

    table, reference = prepared
    frame = Frame.of(contact, delayed, body, table)
    course = Course.of(contact, frame, reference, float(limits.rest), asked)
    place, release = _released(contact, delayed, body, table)
    still = float(reference.equilibrium)
    stage = _Stage(course, quantities(contact), 0.0, still, limits)
    stage = stage._replace(origin=float(stage.energy(release)[0]))
    done: list[_Impact] = []
    outcome, last = None, release
    while outcome is None:
        try:
            impact = _impact(course, place, last)
        except Ended:
            if not done:
                raise
            outcome = Outcome.INTERRUPTED
            break
        done.append(impact)
        place, last = impact.rise.place, impact.end
        outcome = _outcome(stage, done)
        report(len(done))
    impacts = _stacked([_row(stage, impact, done[0].fall.maximum_kinetic) for impact in done])
    end = _progress(stage, done, outcome)
    motion = Motion(impacts, end, table, reference, jnp.asarray(stage.origin))
    legs = [way for impact in done for way in (impact.fall, impact.rise)]
    return motion, Trajectory.of(body, release, legs), outcome


def _released(
    contact: Contact, delayed: DelayedContact, body: Body, table: Table
) -> tuple[Place, Samples]:
    """A body at its release, in equilibrium with the vapour, and its sample."""
    here = Here(
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
    row = read_row(table, 0, float(body.release))[: quantities(contact).components.stop]
    columns = (0.0, here.separation, here.speed, row, lost)
    return Place(here, 0.0, span, lost), Samples(*(np.asarray(x)[None] for x in columns))


def _impact(course: Course, place: Place, begin: Samples) -> _Impact:
    """Down to the deepest point and up to the next apex."""

    def last(way: Leg, before: Samples) -> Samples:
        if not way.samples:
            return before
        return Samples(*(column[-1:] for column in way.samples[-1]))

    fall = leg(course, place, -1)
    middle = last(fall, begin)
    rise = Leg(fall.place, fall.fate, 0.0, 0.0, [])
    if fall.fate == TURNED:
        rise = leg(course, fall.place, 1)
    return _Impact(place, begin, fall, rise, middle, last(rise, middle))


def _outcome(stage: _Stage, done: list[_Impact]) -> Outcome | None:
    """How the motion ends with its last impact; None where it goes on."""
    last, limits = done[-1], stage.limits
    height, first = (float(i.rise.place.here.separation) - stage.resting for i in (last, done[0]))
    cycle = np.sum(last.rise.place.lost - last.start.lost)
    # Menisci that are still on their way will change the cycles to come.
    waits = float(last.start.here.threshold - last.rise.place.here.threshold)
    delayed = last.rise.place.time >= limits.time
    repeats = abs(waits) <= LEAST_LOSS * stage.course.frame.interaction_range
    rules = (
        (FAILED in (last.fall.fate, last.rise.fate), Outcome.FAILED),
        (last.fall.fate == AT_REST, Outcome.REST),
        (STOPPED in (last.fall.fate, last.rise.fate) and not delayed, Outcome.STOPPED),
        (last.rise.fate == LEFT, Outcome.ESCAPED),
        (delayed, Outcome.TIME_LIMIT),
        (height < limits.rest * first, Outcome.REST),
        (repeats and cycle < LEAST_LOSS * done[0].fall.maximum_kinetic, Outcome.OSCILLATING),
        (len(done) >= limits.impacts, Outcome.MAX_IMPACTS),
    )
    return next((outcome for holds, outcome in rules if holds), None)


def _row(stage: _Stage, impact: _Impact, maximum_kinetic: float) -> Impacts:
    fall, rise = impact.fall, impact.rise
    samples = Samples.joined([impact.begin, *fall.samples, *rise.samples])
    energy = stage.energy(samples) + np.sum(samples.lost, axis=1)
    deepest = impact.middle.rows[0]
    columns: dict[str, Any] = {
        "made": np.asarray(True),
        "closest_approach": fall.place.here.separation,
        "apex": rise.place.here.separation,
        "closest_approach_time": np.asarray(fall.place.time),
        "apex_time": np.asarray(rise.place.time),
        "mechanical": stage.energy(impact.end)[0],
        "leaving": np.asarray(np.nan),
        "force": deepest[FORCE],
        "contacting": deepest[CONTACTING],
        "bonds": deepest[stage.layout.bonds],
        "lost": rise.place.lost,
        "energy_balance_error": np.max(np.abs(energy - stage.origin)),
        "pull_work": np.asarray(-rise.pull_work),
        "maximum_kinetic": np.asarray(maximum_kinetic),
        "fall": _phase(stage, impact.start, impact.begin, fall),
        "rise": _phase(stage, fall.place, impact.middle, rise),
    }
    return Impacts(**columns)


def _phase(stage: _Stage, start: Place, begin: Samples, way: Leg) -> Phase:
    """What a leg started from; it is drawn from its samples, not from pieces."""
    none: Any = np.zeros(0)
    values: Any = np.zeros((0, NODES, stage.layout.components.stop))
    columns: dict[str, Any] = {
        "start": start.here.separation,
        "stop": way.place.here.separation,
        "kinetic": np.asarray(stage.kinetic(start.here.speed)),
        "begun": np.asarray(start.time),
        "branch": np.asarray(0),
        "inner": Pieces(none, none, none, none, values),
        "lost": start.lost,
        "bonds": begin.rows[0, stage.layout.bonds],
    }
    return Phase(**columns)


def _stacked(rows: list[Any]) -> Any:
    return jax.tree_util.tree_map(lambda *leaves: np.stack(leaves), *rows)


def _progress(stage: _Stage, done: list[_Impact], outcome: Outcome) -> Progress:
    """The end of a motion."""
    last = done[-1]
    here = last.rise.place.here
    code = ENDS.index(outcome) if outcome in ENDS else -1
    end: dict[str, Any] = {
        "memory": here.memory,
        "place": here.separation,
        "kinetic": stage.kinetic(here.speed),
        "time": last.rise.place.time,
        "lost": last.rise.place.lost,
        "bonds": last.end.rows[0, stage.layout.bonds],
        "first": done[0].rise.place.here.separation - stage.resting,
        "impact_energy": done[0].fall.maximum_kinetic,
        "outcome": code,
        "made": len(done),
    }
    return Progress(**jax.tree_util.tree_map(jnp.asarray, end))
