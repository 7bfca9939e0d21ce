"""One task of a study: its cases as columns."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from asperity.config import Case
from asperity.dynamics import Impacts
from asperity.errors import ENDS, InputError, SimulationError
from asperity.integration.batch_records import taken
from asperity.integration.clock import Clock
from asperity.regimes.accuracy import balance_errors
from asperity.regimes.validity import AtDepth, check_surface
from asperity.results.conversion import losses_by_name
from asperity.results.result import Result
from asperity.solver import solve
from asperity.sweeps.compute.building import Group, Values, built, case_at, problem_at
from asperity.sweeps.compute.cases_alone import unfinished, without_jumps
from asperity.sweeps.compute.critical_velocities import critical_velocities
from asperity.sweeps.compute.integrate_batch import BatchSolution, compile_ahead, integrate_batch
from asperity.sweeps.compute.realised import realised
from asperity.sweeps.compute.study_warnings import Warned, warnings_in
from asperity.sweeps.study.columns import FAILED, REASON_SIZE

if TYPE_CHECKING:
    from asperity.sweeps.study.study import Study

Columns = dict[str, np.ndarray]


class Effort(NamedTuple):
    """What a task cost.

    Attributes
    ----------
    cases
        Number of cases.
    batch_use
        Useful share of the batch, 0 to 1: all its cases wait for the last.
    compiled
        Time in compiled code [s].
    wall
        Time in all [s].
    looked
        How many cases were looked at for the validity of their models.
    warned
        What is to be known of these.
    """

    cases: int
    batch_use: float
    compiled: float
    wall: float
    looked: int = 0
    warned: tuple[Warned, ...] = ()


def compute(study: Study, task: int, stop: threading.Event | None = None) -> tuple[Columns, Effort]:
    """The columns of one task of a study.

    Parameters
    ----------
    study
        The study.
    task
        Number of the task.
    stop
        Ends it when set, by `Stopped`.

    Returns
    -------
    tuple
        The columns, shape (cases[, values]), and what they cost. A case that cannot be computed
        has the outcome FAILED and its reason.
    """
    cases = study.task(task)
    corners = [number for number in study.corners if number in cases]
    return _computed(
        study, study.values(cases.start, cases.stop), Clock(stop), cases.start, corners
    )


def evaluate(
    study: Study,
    values: Values,
    progress: Callable[[int], None] | None = None,
    stop: threading.Event | None = None,
) -> Columns:
    """The columns of cases with any values of a study's axes, shape (cases,) each.

    Parameters
    ----------
    study
        The study.
    values
        By the axes' keys, SI.
    progress
        Told of each number of cases that are computed.
    stop
        Ends it when set, by `Stopped`.
    """
    count = next(iter(values.values())).shape[0]
    parts = []
    most = study.blocks.largest
    for begin in range(0, count, most):
        some = {key: array[begin : begin + most] for key, array in values.items()}
        columns, effort = _computed(study, some, Clock(stop))
        parts.append(columns)
        if progress is not None:
            progress(effort.cases)
    return {name: np.concatenate([part[name] for part in parts]) for name in parts[0]}


def _computed(
    study: Study, values: Values, clock: Clock, first: int = 0, corners: Sequence[int] = ()
) -> tuple[Columns, Effort]:
    """The columns of cases of which the first has a number, and what is to be known of some."""
    began = time.perf_counter()
    count = next(iter(values.values())).shape[0]
    out = {column.name: study.blank(column, count) for column in study.columns}
    whole = without_jumps(study, values, built(study, values))
    looked = [number - first for number in corners]
    lines: dict[int, list[str]] = {}
    for row, reason in whole.refused.items():
        _fail(out, row, reason)
    compile_ahead(whole.groups)
    for group in whole.groups:
        solution = integrate_batch(group, clock)
        again = unfinished(group, solution)
        whole.alone.extend((row, case_at(study, values, row)) for row in again)
        if "critical_velocity" in study.keep and solution.measures:
            solution.measures["critical_velocity"] = critical_velocities(group, solution, clock)
        solution.measures.update(realised(study, values, group, solution, clock))
        _write(study, out, group, solution)
        sound = out["outcome"][group.rows] != FAILED
        for place in np.flatnonzero(np.isin(group.rows, looked) & sound).tolist():
            row = int(group.rows[place])
            try:
                alone = problem_at(study, values, group, place)
            except InputError as error:  # a surface's file that is another one by now
                _fail(out, row, str(error))
            else:
                lines[row] = warnings_in(alone, solution, place)
    for row, case in whole.alone:
        found = _solve(study, out, row, case, clock)
        if row in looked and found is not None:
            lines[row] = found
    warned = [(first + row, line) for row, of_case in lines.items() for line in of_case]
    wall = time.perf_counter() - began
    compiled = min(clock.compiled, wall)
    return out, Effort(count, clock.batch_use, compiled, wall, len(lines), tuple(sorted(warned)))


def _fail(out: Columns, row: int, reason: str) -> None:
    """Write down that a case failed, and why; what it measured is not believed."""
    for name, array in out.items():
        if array.dtype.kind == "f":
            array[row] = np.nan
        elif name not in ("reason", "impacts"):
            array[row] = -1
    out["outcome"][row] = FAILED
    kept = reason.encode()[:REASON_SIZE].decode(errors="ignore").encode()
    out["reason"][row] = 0
    out["reason"][row, : len(kept)] = np.frombuffer(kept, np.uint8)


def _put(column: np.ndarray, rows: np.ndarray, values: np.ndarray) -> None:
    """Write the values of some cases, as many of each as the column has room for."""
    if values.ndim == 2:
        values = values[:, : column.shape[1]]
        column[rows, : values.shape[1]] = values
    else:
        column[rows] = values


def _write(study: Study, out: Columns, group: Group, solution: BatchSolution) -> None:
    """A solution's measures as columns."""
    rows, past = group.rows, solution.history
    out["outcome"][rows] = solution.outcome
    out["impacts"][rows] = solution.made
    moved = np.flatnonzero(solution.made > 0)
    if moved.size:
        found = {**solution.measures, **_totals(group, solution)}
        found |= _turns(past) if study.motions else {}
        for name in found.keys() & out.keys():
            _put(out[name], rows[moved], found[name][moved])
        none: Any = None
        impacts = Impacts(**taken(past, moved), fall=none, rise=none)
        out["energy_balance_error"][rows[moved]] = balance_errors(impacts)
    for place, failure in solution.failures.items():
        _fail(out, int(rows[place]), str(failure))
    for place, problem in enumerate(group.problems):
        if place not in solution.failures:
            at_depth = AtDepth(*solution.at_depth[place].tolist())
            try:
                check_surface(problem, at_depth)
            except InputError as error:
                _fail(out, int(rows[place]), str(error))


def _totals(group: Group, solution: BatchSolution) -> Columns:
    """What is read off the impacts themselves."""
    lost = losses_by_name(group.batch.contact, group.batch.body, solution.lost)
    return {
        "last_apex_time": solution.last_apex_time,
        "minimum_separation": solution.history["closest_approach"][:, 0],
        "energy_lost": solution.lost.sum(axis=1),
        **{f"lost_{name}": values for name, values in lost.items()},
    }


def _turns(past: Columns) -> Columns:
    """Separations and times of the turning points, in order of time."""
    out = {}
    for name, what in (("turning_separation", ""), ("turning_time", "_time")):
        both = np.stack([past[f"closest_approach{what}"], past[f"apex{what}"]], axis=2)
        both = np.where(past["made"][..., None], both, np.nan)
        out[name] = both.reshape(both.shape[0], -1)
    return out


def _solve(study: Study, out: Columns, row: int, case: Case, clock: Clock) -> list[str] | None:
    """A case that is solved by itself; its warnings, None where it cannot be."""
    clock.look()
    try:
        critical = "critical_velocity" in study.keep
        result = solve(case, stop=clock.stop, critical=critical, beside=False)
    except (InputError, SimulationError) as error:
        clock.look()
        _fail(out, row, str(error))
        return None
    clock.look()  # a case that was cut short is not one that ended
    found = _read(result)
    out["outcome"][row] = ENDS.index(result.outcome)
    for name in found.keys() & out.keys():
        if found[name] is not None:
            _put(out[name], np.array([row]), np.array([found[name]], out[name].dtype))
    return result.warnings


def _read(result: Result) -> dict[str, Any]:
    """The columns of a result."""
    ledger = result.ledger
    events = result.events
    bodies = {} if result.realisations is None else result.realisations.columns()
    places, times = (
        np.stack([events[f"{at}_{what}"] for at in ("closest_approach", "apex")], axis=1).ravel()
        for what in ("separation", "time")
    )
    return {
        **result.measures,
        **bodies,
        "impacts": len(result.measures["restitution"]),
        "energy_balance_error": ledger["energy_balance_error"],
        "energy_lost": sum(ledger["lost"].values()),
        **{f"lost_{name}": value for name, value in ledger["lost"].items()},
        "last_apex_time": times[-1],
        "minimum_separation": places[0],
        "turning_separation": places,
        "turning_time": times,
    }
