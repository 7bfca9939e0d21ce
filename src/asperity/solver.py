"""From a case to a result: the one path that the command line, the page and studies use."""

from __future__ import annotations

import dataclasses
import math
import threading
from collections.abc import Callable

import numpy as np

from ._jax import jax
from .case import Case
from .case.build import CLEARANCE, Problem, build
from .contact import Contact
from .conversion import Assessment, Flight, assessment_of, first_restitution, result_of
from .errors import InputError, Outcome, SimulationError
from .impact import Body, Impacts, Limits, Motion, Table, fly, prepare, start
from .impact.creeping import fly_creeping
from .impact.datum import Datum
from .impact.delayed import fly as fly_late
from .impact.history import ENDS, FLYING
from .impact.legs import Ended
from .impact.sampling import compile_ahead
from .impact.table import FORCE, read_row
from .program import Program
from .result import Curve, Result
from .trace import trace
from .validity import AtDepth, check_surface

Report = Callable[[float, str], None]

_CHUNK = 10  # impacts a compiled call: short enough for Ctrl-C
_REFINEMENTS = (1, 2, 4, 8)  # of the panels, until the curves meet the tolerance
_RESIDUAL = 1e-6  # relative force error of a contact that counts as solved


def solve(
    case: Case,
    *,
    name: str = "case",
    progress: Report | None = None,
    stop: threading.Event | None = None,
    throw: bool = True,
) -> Result:
    """Motion of a case from its release to its end, with everything measured.

    Parameters
    ----------
    case
        A case; see :func:`asperity.load`.
    name
        What to call it.
    progress
        Called with a fraction done and a line of text, now and then.
    stop
        Set from another thread, it ends the motion early; what was computed is returned.
    throw
        Whether a numerical failure raises, or comes back as the result's outcome.

    Raises
    ------
    InputError
        If the release lies inside contact, or models count one force twice.
    SimulationError
        If the numerics fail; its ``partial`` is the result so far.
    """
    tell = progress or (lambda fraction, text: None)
    problem = build(case)
    tell(0.02, "force curves")
    limits = Limits.of(case.tolerance)
    contact, table, datum = _prepared(problem, case.numerics.tolerance, limits, drawn=True)
    _check_release(problem, table)
    if problem.late is None and problem.creep is None:
        flight = _fly(problem.body, contact, table, datum, limits, tell, stop)
    else:
        flight = _fly_stepped(problem, contact, (table, datum), limits, tell, stop)
    tell(0.9, "measures")
    stopped = flight.outcome in (Outcome.FAILED, Outcome.INTERRUPTED)
    result = result_of(case, name, problem, flight, None if stopped else _kept_elastic(case))
    tell(1.0, "done")
    if flight.outcome is Outcome.FAILED and throw:
        damped = " or the gas film damps it too strongly to be followed" * (case.gas is not None)
        raise SimulationError(f"the motion left the tabulated separations{damped}", result)
    return result


def curve(
    case: Case,
    *,
    name: str = "case",
    progress: Report | None = None,
    stop: threading.Event | None = None,
) -> Curve:
    """Force against separation, approaching to the depth of the case's first impact and back.

    So slowly that all menisci have the time to form, whatever time they take.

    Parameters
    ----------
    case, name, progress, stop
        As for :func:`solve`; a curve is too short to be stopped half-way.

    Raises
    ------
    InputError, SimulationError
        As :func:`solve`.
    """
    tell = progress or (lambda fraction, text: None)
    tell(0.1, "force curves")
    problem = build(case)
    contact, motion = _first_impact(case, problem)
    check_surface(case, problem, AtDepth.of(contact, motion))
    tell(0.6, "parting")
    drawn = trace(contact, motion.table, motion.impacts)
    tell(1.0, "done")
    return Curve(case, name, **drawn)


def assess(
    case: Case,
    *,
    name: str = "case",
    progress: Report | None = None,
    stop: threading.Event | None = None,
) -> Assessment:
    """Which models hold in a case, by the depth of its first impact.

    Parameters
    ----------
    case, name, progress, stop
        As for :func:`solve`; one impact is too short to be stopped half-way.

    Raises
    ------
    InputError, SimulationError
        As :func:`solve`.
    """
    tell = progress or (lambda fraction, text: None)
    tell(0.1, "first impact")
    problem = build(case)
    contact, motion = _first_impact(case, problem)
    tell(1.0, "done")
    return assessment_of(case, name, problem, contact, motion)


def _kept_elastic(case: Case) -> float | None:
    """Restitution of the first impact of a case that yields, were nothing in it to yield.

    NaN where it cannot be computed, None where it has none or nothing yields.
    """
    if case.plasticity_model == "none":
        return None
    elastic = case.model_copy(update={"plasticity": None})
    problem = build(elastic)
    try:
        contact, motion = _first_impact(elastic, problem)
    except (InputError, SimulationError):
        return math.nan  # it may be released within contact, or pull too hard to be solved
    return first_restitution(Flight(motion, contact, Outcome.MAX_IMPACTS), problem.body)


def _first_impact(case: Case, problem: Problem) -> tuple[Contact, Motion]:
    """The contact with its curves, and the motion as far as the first impact."""
    limits = Limits.of(dataclasses.replace(case.tolerance, max_impacts=1))
    contact, table, datum = _prepared(problem, case.numerics.tolerance, limits, drawn=False)
    _check_release(problem, table)
    body = problem.body
    first, origin = _start(contact, body, table)
    progress, rows = _fly_some(contact, body, table, datum, origin, first, limits, _CHUNK)
    impacts = jax.tree_util.tree_map(np.asarray, rows)
    return contact, Motion(impacts, progress, table, datum, origin)


def _prepared(
    problem: Problem, tolerance: float, limits: Limits, *, drawn: bool
) -> tuple[Contact, Table, Datum]:
    """Tables whose interpolation error meets the tolerance, by more panels where needed.

    Meanwhile the motion compiles, with its drawing where it is to be drawn.
    """
    for factor in _REFINEMENTS:
        contact = problem.contact.refined(factor)
        if not drawn or (problem.late is None and problem.creep is None):
            _compile(contact, problem.body, limits, drawn=drawn)
        table, datum = _prepare(contact, problem.body)
        if float(table.error) <= max(tolerance, contact.blur):
            break
    else:
        raise SimulationError(
            f"force curves reach a relative error of {float(table.error):.1e}, "
            f"not `numerics.tolerance` = {tolerance:.1e}"
        )
    if not float(table.residual) <= _RESIDUAL:
        raise SimulationError(
            "pressure and deformation do not agree: relative force error "
            f"{float(table.residual):.1e}. The contact has no equilibrium that follows "
            "from the one before (strong adhesion on soft bodies folds it)"
        )
    return contact, table, datum


def _compile(contact: Contact, body: Body, limits: Limits, *, drawn: bool) -> None:
    """Compile the curves, the motion and, where wanted, its drawing side by side."""
    table, datum = _prepare.ahead(contact, body)
    progress, origin = _start.ahead(contact, body, table)
    _, impacts = _fly_some.ahead(contact, body, table, datum, origin, progress, limits, _CHUNK)
    if drawn:
        compile_ahead(body, table, impacts)


_prepare = Program(prepare)
_start = Program(start)
_fly_some = Program(fly)


def _check_release(problem: Problem, table: Table) -> None:
    """A release within contact is refused: it would not be a fall."""
    body = problem.body
    release, weight = float(body.release), float(body.weight)
    force = abs(float(read_row(table, 0, release)[FORCE]))
    largest = float(np.max(np.abs(np.asarray(table.values)[..., 0, FORCE])))
    limit = 1e-3 * weight if weight > 0.0 else 1e-6 * largest
    if force <= limit:
        return
    share = "1e-3 of the weight" if weight > 0.0 else "1e-6 of its peak"
    raise InputError(
        f"`release_gap` must lie outside contact: the contact force there must be below {share} "
        f"({limit:.3g} N), and is {force:.3g} N; {_at_rest(problem)}got {release * 1e9:.6g} nm",
        key="impact.release_gap",
    )


def _at_rest(problem: Problem) -> str:
    """Where the body would rest, seen from outside contact; empty where nothing holds it."""
    body = problem.body
    clear = Body(body.mass, body.gravity, problem.contact.reach + CLEARANCE, body.speed)
    place = float(_prepare(problem.contact, clear)[1].equilibrium)
    return f"at rest the separation is {place * 1e9:.4g} nm; " if np.isfinite(place) else ""


def _fly(
    body: Body,
    contact: Contact,
    table: Table,
    datum: Datum,
    limits: Limits,
    tell: Report,
    stop: threading.Event | None,
) -> Flight:
    """The motion in chunks of impacts, so that it can be watched and stopped."""
    progress, origin = _start(contact, body, table)
    chunks: list[Impacts] = []
    while int(progress.outcome) == FLYING and not (stop is not None and stop.is_set()):
        progress, rows = _fly_some(contact, body, table, datum, origin, progress, limits, _CHUNK)
        chunks.append(jax.tree_util.tree_map(np.asarray, rows))
        count = int(progress.made)
        tell(0.1 + 0.75 * min(count / int(limits.impacts), 1.0), f"impact {count}")
    if not chunks:
        raise SimulationError("stopped before the first impact")
    impacts = jax.tree_util.tree_map(lambda *parts: np.concatenate(parts), *chunks)
    code = int(progress.outcome)
    outcome = Outcome.INTERRUPTED if code == FLYING else ENDS[code]
    return Flight(Motion(impacts, progress, table, datum, origin), contact, outcome)


def _fly_stepped(
    problem: Problem,
    contact: Contact,
    prepared: tuple[Table, Datum],
    limits: Limits,
    tell: Report,
    stop: threading.Event | None,
) -> Flight:
    """The motion on a bulk that creeps, or with menisci that take time to form, step by step."""
    body, creep, late = problem.body, problem.creep, problem.late

    def made(count: int) -> None:
        tell(0.1 + 0.75 * min(count / int(limits.impacts), 1.0), f"impact {count}")

    try:
        if creep is not None:
            flown = fly_creeping(contact, creep, body, prepared, limits, made, stop)
        else:
            assert late is not None
            flown = fly_late(contact, late, body, prepared, limits, made, stop)
    except Ended as error:
        raise SimulationError("stopped before the first impact") from error
    motion, trajectory, outcome = flown
    return Flight(motion, contact, outcome, trajectory)
