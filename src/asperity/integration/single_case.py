"""The motion of one case: a batch of one, or stepped in time where its contact asks for that."""

from __future__ import annotations

import dataclasses
import threading

import numpy as np

from ..contact import Contact, ElasticContact, interaction_range_of
from ..contact.delayed_formation import DelayedContact
from ..contact.resolution import FEW_DEFORMING, one_of_few
from ..contact.viscoelastic import Relaxation
from ..dynamics import Body, Limits, Motion, Table
from ..dynamics.problem import CLEARANCE, Problem
from ..dynamics.static_equilibrium import Reference
from ..dynamics.stepped_motion import integrate_stepped
from ..dynamics.stepped_phase import Ended
from ..errors import ENDS, InputError, Outcome, SimulationError, Tolerance
from ..results.conversion import Solution
from .batch_motion import RELEASE_KEY, BatchMotion
from .batch_records import Batch, Slice, unbatched, whole
from .clock import Clock, Report, Stopped, silently
from .panel_cuts import PATIENCE, CutPanels
from .refinements import refined
from .steps import Steps

_STOPPED = "stopped before the first impact"


def cut_in_steps(problem: Problem) -> Problem:
    """The problem with curves of one of a few resolutions, each at least as fine as its own."""
    relaxation = problem.relaxation
    if relaxation is not None:
        relaxation = dataclasses.replace(relaxation, contact=_in_steps(relaxation.contact))
    return problem._replace(contact=_in_steps(problem.contact), relaxation=relaxation)


def _in_steps(contact: Contact) -> Contact:
    if not isinstance(contact, ElasticContact):
        return contact
    return dataclasses.replace(contact, resolved=one_of_few(contact.resolved, FEW_DEFORMING))


def integrate(
    problem: Problem,
    report: Report = silently,
    stop: threading.Event | None = None,
    *,
    many: bool = False,
    drawn: bool = True,
) -> Solution:
    """The motion of what was built from a case.

    Parameters
    ----------
    problem
        What was built from a case.
    report
        Called with a fraction done and a line of text, now and then.
    stop
        Set from another thread, it ends the motion early.
    many
        Whether the scanning curves are tabulated first: that compiles longer, and pays where
        many cases follow.
    drawn
        Whether the motion is measured and drawn afterwards: that is compiled meanwhile.

    Raises
    ------
    InputError
        If the release lies inside contact, or the rough surfaces adhere as smooth ones do.
    SimulationError
        If the curves miss the tolerance, or the motion is stopped before its first impact.
    """

    def run(problem: Problem, report: Report, patience: int) -> Solution:
        return _integrated(problem, report, stop, many=many, drawn=drawn, patience=patience)

    return refined(problem, run, report)


def _integrated(
    problem: Problem,
    report: Report,
    stop: threading.Event | None,
    *,
    many: bool,
    drawn: bool,
    patience: int,
) -> Solution:
    tolerance = problem.inputs.tolerance
    motion = _of_one(
        problem, Limits.of(tolerance), tolerance.relative, Clock(stop, report), many=many,
        checked=problem.inputs.release is not None, launched=problem.inputs.chosen_release,
        drawn=drawn, patience=patience,
    )  # fmt: skip
    try:
        return _solution(problem, motion)
    except InputError as error:
        if error.key != RELEASE_KEY:
            raise
        raise InputError(f"{error}{_at_rest(problem, many)}", key=error.key) from None


def first_impact(problem: Problem, report: Report = silently) -> tuple[Contact, Motion]:
    """The contact with its curves, and the motion as far as the first impact.

    Parameters
    ----------
    problem
        What was built from a case.
    report
        As ``progress`` of :func:`solve`.

    Raises
    ------
    InputError, SimulationError
        As :func:`solve`.
    """
    # It has all the time that it needs.
    body = dataclasses.replace(problem.body, in_bulk=())
    inputs = problem.inputs.one_impact()
    problem = problem._replace(inputs=inputs, body=body, delayed=None, relaxation=None)

    def within(fraction: float, text: str) -> None:
        report(min(fraction, 0.3), "first impact" if text == "motion" else text)

    solution = integrate(problem, within, drawn=False)
    return solution.contact, solution.motion


def launch(
    problem: Problem,
    limits: Limits,
    tolerance: float,
    stop: threading.Event | None,
    *,
    many: bool,
    finer: bool,
    faster: Slice | None = None,
) -> tuple[Solution, Slice]:
    """The motion of a body wherever it is released, and that body with its curves at its release.

    Curves of a body that is launched faster serve a slower one: it comes less deep.

    Parameters
    ----------
    problem, many, stop
        As for :func:`integrate`.
    limits
        Ends of its motion.
    tolerance
        Relative error allowed to the force curves [-].
    finer
        As for :class:`~asperity.integration.batch_motion.BatchMotion`.
    faster
        The curves of such a body, if there are any; not of a contact that yields.

    Raises
    ------
    SimulationError
        As :func:`integrate`.
    """
    motion = _of_one(problem, limits, tolerance, Clock(stop), many=many, finer=finer, checked=False)
    here = _at_release(motion) if faster is None else _slower(faster, motion.batch)
    return _solution(problem, motion, here), here


def prepared(contact: Contact, body: Body, *, many: bool = False) -> tuple[Table, Reference]:
    """Force curves over all that a body can reach, and the static equilibrium.

    Parameters
    ----------
    contact, body
        What moves on what.
    many
        As for :func:`integrate`.
    """
    steps = Steps.of_one(contact, body, many=many)
    here = Batch.of_one(contact, body, Limits.of(Tolerance()))
    cuts = CutPanels().padded(steps.most_cuts(contact, steps.refinements[0]))
    begun, _checks = unbatched(steps.curves(here, cuts[None], many))
    return begun.table, begun.reference


def _of_one(
    problem: Problem,
    limits: Limits,
    tolerance: float,
    clock: Clock,
    *,
    many: bool,
    finer: bool = True,
    checked: bool,
    launched: bool = False,
    drawn: bool = False,
    patience: int = PATIENCE,
) -> BatchMotion:
    contact, body = problem.contact, problem.body
    return BatchMotion(
        Batch.of_one(contact, body, limits), np.array([tolerance]),
        Steps.of_one(contact, body, many=many and not problem.in_time, drawn=drawn), clock,
        finer=finer, checked=checked, launched=launched, patience=patience,
    )  # fmt: skip


def _slower(faster: Slice, batch: Batch) -> Slice:
    """A body at its release, with the curves of one that was faster there."""
    begun, body = faster.begun, batch.body
    kinetic = 0.5 * np.asarray(body.mass) * np.asarray(body.speed) ** 2
    origin = np.asarray(begun.origin) + (kinetic - np.asarray(begun.progress.kinetic))
    progress = begun.progress._replace(kinetic=kinetic)
    begun = begun._replace(origin=origin, progress=progress)
    return faster._replace(batch=batch, begun=begun)


def _at_release(motion: BatchMotion) -> Slice:
    """The one case of a batch at its release, with curves that hold."""
    try:
        here = next(motion.curves(), None)
    except Stopped:
        raise SimulationError(_STOPPED) from None
    _raise_failure(motion)
    assert here is not None
    return here


def _solution(problem: Problem, motion: BatchMotion, here: Slice | None = None) -> Solution:
    """The motion of the one case of a batch, which is not integrated yet."""
    if problem.in_time:
        return _integrate_in_time(problem, motion, here or _at_release(motion))
    outcome = None
    try:
        motion.integrate(here)
    except Stopped:
        outcome = Outcome.INTERRUPTED
    _raise_failure(motion)
    count, made = motion.steps.together, int(motion.made[0])
    ends, rows = motion.ends(), motion.history(-(-made // count) * count)
    if ends is None or rows is None:
        raise SimulationError(_STOPPED)
    moved = whole(unbatched(ends[0]), unbatched(rows))
    outcome = outcome or ENDS[int(moved.end.outcome)]
    return Solution(moved, problem.contact, _body(problem, motion), outcome)


def _integrate_in_time(problem: Problem, motion: BatchMotion, here: Slice) -> Solution:
    """The motion on a bulk that creeps, or with menisci that take time to form, step by step."""
    clock = motion.clock
    begun, limits = unbatched(here.begun), unbatched(motion.batch.limits)
    contact, body = problem.contact, _body(problem, motion)
    mechanism: Relaxation | DelayedContact | None = problem.relaxation or problem.delayed
    if isinstance(mechanism, DelayedContact) and isinstance(contact, ElasticContact):
        mechanism = Relaxation.none(mechanism)
    assert mechanism is not None
    clock.report(0.1, "motion")

    def made(count: int) -> None:
        clock.report(0.1 + 0.75 * min(count / int(limits.impacts), 1.0), f"impact {count}")

    curves = begun.table, begun.reference
    try:
        moved, trajectory, outcome = integrate_stepped(
            contact, mechanism, body, curves, limits, made, clock.stop
        )
    except Ended as error:
        raise SimulationError(_STOPPED) from error
    return Solution(moved, contact, body, outcome, trajectory)


def _raise_failure(motion: BatchMotion) -> None:
    for failure in motion.failures.values():
        raise failure


def _body(problem: Problem, motion: BatchMotion) -> Body:
    """The body with the release that was found, where the case gives a speed alone."""
    if not problem.inputs.chosen_release:
        return problem.body
    return dataclasses.replace(problem.body, release=motion.batch.body.release[0])


def _at_rest(problem: Problem, many: bool) -> str:
    """Where the body would rest, seen from outside contact; empty where nothing holds it."""
    release = float(interaction_range_of(problem.contact)) + CLEARANCE
    clear = dataclasses.replace(problem.body, release=release)
    _, reference = prepared(problem.contact, clear, many=many and not problem.in_time)
    at_rest = float(reference.equilibrium)
    return f"; at rest the separation is {at_rest * 1e9:.4g} nm" if np.isfinite(at_rest) else ""
