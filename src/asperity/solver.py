"""From a case to a result: the one path that the command line, the page and studies use."""

from __future__ import annotations

import dataclasses
import math
import threading
from typing import Any, NoReturn

from .config import Case
from .config.resolve import resolve
from .critical_velocity import sought
from .dynamics import Limits
from .dynamics.problem import Problem
from .dynamics.quasi_static import quasi_static_curve
from .errors import InputError, Outcome, SimulationError
from .inputs import Inputs
from .integration import Report, cut_in_steps, first_impact, integrate, silently
from .loading import turning_at
from .model import build
from .regimes.few_asperities import pull_warnings
from .regimes.wave_limits import refuse_stopped
from .results.assessment import Assessment, assessment_of
from .results.case_source import CaseLike, case_of
from .results.conversion import Solution, beside_mean, first_restitution, result_of
from .results.result import Curve, Result
from .single_bodies import realise


def solve(
    case: CaseLike,
    *,
    name: str | None = None,
    progress: Report | None = None,
    stop: threading.Event | None = None,
    throw: bool = True,
    critical: bool = True,
    beside: bool | None = None,
) -> Result:
    """Motion of a case from its release to its end, with everything measured.

    Parameters
    ----------
    case
        A case, or the name or path of one; see :func:`asperity.load`.
    name
        What to call it; without it, the case's own name.
    progress
        Called with a fraction done and a line of text, now and then.
    stop
        Set from another thread, it ends the motion early; what was computed is returned.
    throw
        Whether a numerical failure raises, or comes back as the result's outcome.
    critical
        Whether the critical velocity is sought: that takes some twenty first impacts.
    beside
        Whether single bodies are launched where a mean is not enough and the case does not ask for
        it alone; by default where the critical velocity is sought.

    Raises
    ------
    InputError
        If it is no case, the release lies inside contact, or models count one force twice.
    SimulationError
        If the numerics fail; its ``partial`` is the result so far.
    """
    case = case_of(case)
    name = case.name if name is None else name
    _ = case.launch
    report, problem = progress or silently, build(resolve(case))
    solution = integrate(problem, report, stop)
    result = _result(
        case,
        name,
        problem,
        solution,
        report,
        stop,
        None,
        beside=critical if beside is None else beside,
    )
    if critical:
        report(0.92, "critical velocity")
        result.measures.update(sought(solution, problem, Limits.of(problem.inputs.tolerance), stop))
    report(1.0, "done")
    if solution.outcome is Outcome.FAILED and throw:
        _raise_failed(problem, solution, result)
    return result


def explore(
    case: Case,
    *,
    name: str = "case",
    most: int | None = None,
    progress: Report | None = None,
    stop: threading.Event | None = None,
) -> tuple[Result, Curve]:
    """Motion and force curve of a case, from the same tables: what somebody sees at a glance.

    Half-spaces are cut in one of a few ways, each at least as fine as :func:`solve` cuts them, so
    that cases that differ in values run the same programs.

    Parameters
    ----------
    case, name, progress, stop
        As for :func:`solve`.
    most
        Impacts whose course the result holds, at least 1; all without it. Its measures, ledger
        and events are of all impacts in any case.

    Raises
    ------
    InputError, SimulationError
        As :func:`solve`.
    """
    _ = case.launch
    report, problem = progress or silently, cut_in_steps(build(resolve(case)))
    solution = integrate(problem, report, stop, many=True)
    result = _result(case, name, problem, solution, report, stop, most)
    if solution.outcome is Outcome.FAILED:
        _raise_failed(problem, solution, result)
    if solution.trajectory is not None:  # the curve is that of menisci that have the time to form
        return result, _curve_of(case, name, problem, lambda _, text: report(0.95, text))
    motion, held = solution.motion, problem.inputs.suspension
    stiffness = None if held is None else held.stiffness
    drawn, _ = quasi_static_curve(solution.contact, motion.table, motion.impacts, stiffness)
    report(1.0, "done")
    return result, Curve(case, name, **drawn, warnings=result.warnings, surface=result.surface)


def critical_velocity(
    case: Case,
    *,
    progress: Report | None = None,
    stop: threading.Event | None = None,
) -> dict[str, Any]:
    """The critical velocity of a case, by the programs that :func:`explore` has compiled.

    Parameters
    ----------
    case, progress, stop
        As for :func:`solve`.

    Returns
    -------
    As :func:`asperity.critical_velocity.critical_measures`.

    Raises
    ------
    InputError, SimulationError
        As :func:`solve`.
    """
    _ = case.launch
    inputs = resolve(case).one_impact()
    report, problem = progress or silently, cut_in_steps(build(inputs))
    solution = integrate(problem, report, stop, many=True)
    return sought(solution, problem, Limits.of(inputs.tolerance), stop, many=True)


def _result(
    case: Case,
    name: str,
    problem: Problem,
    solution: Solution,
    report: Report,
    stop: threading.Event | None,
    most: int | None,
    *,
    beside: bool = True,
) -> Result:
    """The result of a motion, and of single bodies beside it."""
    # Of a contact that folds both differ from what was built.
    problem = problem._replace(contact=solution.contact, body=solution.body)
    report(0.9, "measures")
    stopped = solution.outcome in (Outcome.FAILED, Outcome.INTERRUPTED)
    elastic = None if stopped else _kept_elastic(problem.inputs, lambda _, text: report(0.9, text))
    asked, bodies = problem.inputs.placement is not None, None
    warnings: tuple[str, ...] = ()
    placed = beside_mean(problem, solution) if beside and not stopped else problem
    if placed.inputs.placement is not None and not stopped:
        try:
            bodies = realise(
                placed, problem.body, float(solution.motion.impacts.closest_approach[0]),
                lambda _, text: report(0.9, text), stop, rebounds=asked and most is None,
            )  # fmt: skip
            problem, warnings = placed, bodies.warnings
        except (InputError, SimulationError) as error:
            if stop is not None and stop.is_set():
                solution = solution._replace(outcome=Outcome.INTERRUPTED)
            elif asked:
                raise
            else:
                alone = dataclasses.replace(problem.inputs, beside=None)
                problem = problem._replace(inputs=alone)
                warnings = (f"there are no single bodies beside this mean: {error}",)
    result = result_of(case, name, problem, solution, elastic, most, bodies)
    result.warnings.extend(warnings)
    return result


def _raise_failed(problem: Problem, solution: Solution, result: Result) -> NoReturn:
    refuse_stopped(problem, solution.motion)
    if solution.contact.sides > 1:
        raise SimulationError(
            "a scanning curve of the contact that jumps folds itself, or its contact shrinks by "
            "more than its mesh resolves",
            result,
        )
    drags = " and ".join(drag.name for drag in problem.body.drags)
    damped = f" or is damped too strongly to be followed, by {drags}" if drags else ""
    raise SimulationError(f"the motion left the tabulated separations{damped}", result)


def curve(
    case: CaseLike,
    *,
    name: str | None = None,
    load: float | None = None,
    depth: float | None = None,
    progress: Report | None = None,
    stop: threading.Event | None = None,
) -> Curve:
    """Force against separation: loading to some depth, and unloading.

    So slowly that all menisci have the time to form, whatever time they take.

    Parameters
    ----------
    case, name, progress, stop
        As for :func:`solve`; a curve is too short to be stopped half-way.
    load
        Load at which unloading begins [N]; the case needs no [impact] table then.
    depth
        Depth at which it begins [m]: how far the rigid separation is below 0, negative above. In
        place of a load. Without either it begins at the depth of the case's first impact.

    Raises
    ------
    InputError, SimulationError
        As :func:`solve`.
    """
    case = case_of(case)
    name = case.name if name is None else name
    inputs, report = resolve(case), progress or silently
    if load is None and depth is None:
        _ = case.launch
        return _curve_of(case, name, build(inputs), report)
    problem = turning_at(build(inputs.without_motion()), load=load, depth=depth)
    return _curve_of(case, name, problem, report)


def _curve_of(case: Case, name: str, problem: Problem, report: Report) -> Curve:
    """The curve of what was built from a case."""
    contact, motion = first_impact(problem, report)
    problem = problem._replace(contact=contact)
    warnings = assessment_of(name, problem, motion).warnings
    report(0.6, "unloading")
    spring = problem.inputs.suspension
    stiffness = None if spring is None else spring.stiffness
    drawn, held = quasi_static_curve(contact, motion.table, motion.impacts, stiffness)
    warnings += pull_warnings(problem.inputs, drawn["pull_off"], held)
    if problem.inputs.placement is not None:
        warnings.append("this is the mean over all bodies; `asperity run` has single ones")
    report(1.0, "done")
    return Curve(case, name, **drawn, warnings=warnings, surface=problem.inputs.surface_facts)


def assess(
    case: Case,
    *,
    progress: Report | None = None,
    stop: threading.Event | None = None,
) -> Assessment:
    """Which models hold in a case, by the depth of its first impact.

    Parameters
    ----------
    case, progress, stop
        As for :func:`solve`; one impact is too short to be stopped half-way.

    Raises
    ------
    InputError, SimulationError
        As :func:`solve`.
    """
    _, report = case.launch, progress or silently
    problem = build(resolve(case))
    contact, motion = first_impact(problem, report)
    report(1.0, "done")
    return assessment_of(case.name, problem._replace(contact=contact), motion)


def _kept_elastic(inputs: Inputs, report: Report) -> float | None:
    """Restitution of the first impact of a case that yields, were nothing in it to yield.

    NaN where it cannot be computed, None where it has none or nothing yields.
    """
    if not inputs.yields:
        return None
    problem = build(inputs.elastic())
    try:
        contact, motion = first_impact(problem, report)
    except (InputError, SimulationError):
        return math.nan  # it may be released within contact, or pull too hard to be solved
    return first_restitution(Solution(motion, contact, problem.body, Outcome.MAX_IMPACTS))
