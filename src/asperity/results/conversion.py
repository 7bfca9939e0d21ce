"""A motion that was integrated, as the result that a user reads: units, names, plain numbers."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from .._jax import jax
from ..config import Case
from ..contact import Contact, SmoothContact
from ..dynamics import Body, Motion, time_series
from ..dynamics.common_shapes import common_table, filled_up, with_phases, without_curves
from ..dynamics.curve_table import CENTRAL, FORCE, STORED, Quantities, Table, quantities
from ..dynamics.problem import Problem
from ..dynamics.static_equilibrium import Reference, end_of_contact
from ..dynamics.stepped_series import Trajectory
from ..dynamics.time_series import Series, ascending, sample
from ..errors import Outcome
from ..laws.law import as_float64
from ..numerics.compilation import AT_ONCE, Program
from ..regimes.accuracy import CLOSED, balance_error, energy_at_stake
from ..regimes.few_asperities import bodies_differ
from ..regimes.plastic_validity import kept_elastic
from ..regimes.validity import (
    AtDepth,
    check_surface,
    slow_menisci,
)
from .assessment import measured_warnings, regime_of
from .first_contact import FirstContact, first_contact, least_peak, passing_at
from .measures import Measures, measure
from .realisations import Realisations
from .record_layout import EVENTS
from .result import Result

_first_contact = Program(first_contact, AT_ONCE)
_passing_at = Program(passing_at, AT_ONCE)
_measure = Program(measure, AT_ONCE)
_end_of_contact = Program(end_of_contact, AT_ONCE)


class Solution(NamedTuple):
    """A motion that was integrated, the contact it was integrated with, and how it ended.

    The body has the release that was found, where the case gives a speed alone.
    """

    motion: Motion
    contact: Contact
    body: Body
    outcome: Outcome
    trajectory: Trajectory | None = None


def contact_end(table: Table, peak: float) -> float:
    """The end of a contact whose largest force is ``peak`` [N]: a separation [m]."""
    return float(_end_of_contact(table, as_float64(peak)))


def compile_ahead(motion: Motion, body: Body) -> None:
    """Compile in threads what measures and draws a motion that is given by its shapes."""
    time_series.compile_ahead(body, motion.table, motion.impacts)
    blank = jax.tree_util.tree_map(lambda leaf: np.zeros(leaf.shape, leaf.dtype), motion)
    table, impacts = with_phases(blank, body)
    first = _first_contact.ahead(table, impacts, body)
    passing = None
    if body.damped_apart:
        passing = _passing_at.ahead(body, table, impacts, first.end)
    _measure.ahead(without_curves(blank), body, passing, first)


def measured(solution: Solution) -> Measures:
    """Measures, by programs that serve many kinds of case."""
    motion, body = solution.motion, solution.body
    plain, passing = without_curves(motion), None
    if solution.trajectory is None:
        table, impacts = with_phases(motion, body)
        first = _first_contact(table, impacts, body)
        if body.damped_apart:
            passing = _passing_at(body, table, impacts, first.end)
        return _measure(plain, body, passing, first)
    discrete = isinstance(solution.contact, SmoothContact)
    first = _stepped_contact(solution.trajectory, motion, body, discrete=discrete)
    if body.damped_apart:
        found = solution.trajectory.passing(float(first.end), float(body.mass))
        passing = jax.tree_util.tree_map(filled_up, found)
    return _measure(plain, body, passing, first)


def _stepped_contact(
    trajectory: Trajectory, motion: Motion, body: Body, *, discrete: bool
) -> FirstContact:
    """The first contact of a motion that was stepped in time."""
    bonds = Quantities(motion.impacts.bonds.shape[1], 0).bonds
    pulled = trajectory.unloading(bonds, discrete=discrete)
    peak = max(float(np.max(np.abs(motion.impacts.force))), float(pulled.pull_off))
    table = common_table(motion.table, motion.impacts.bonds.shape[1])
    end = contact_end(table, peak)
    held = float(motion.impacts.apex[0]) < end
    time = np.nan if held else trajectory.contact_time(end)
    force = trajectory.maximum_force()
    outset = contact_end(table, float(least_peak(body, pulled.pull_off, peak)))
    return FirstContact(
        as_float64(end), as_float64(time), as_float64(force), pulled, as_float64(outset)
    )


def _sampled(
    problem: Problem, solution: Solution, most: int | None
) -> tuple[Series, dict[str, np.ndarray]]:
    """A motion as a time series, and the energy lost by mechanism along it."""
    motion, contact, stepped = solution.motion, solution.contact, solution.trajectory
    body, limit = problem.body, problem.inputs.tolerance.time_limit
    impacts = motion.impacts
    cut = most is not None and most < int(np.sum(impacts.made))
    if cut:
        impacts = jax.tree_util.tree_map(lambda leaf: leaf[:most], impacts)
    series: Series
    if stepped is not None:
        series = stepped.until(min(limit, float(impacts.apex_time[-1])) if cut else limit)
    else:
        series = sample(body, motion.table, impacts).until(limit)
    return series, losses_by_name(contact, body, ascending(series.lost, _known(motion)))


def first_restitution(solution: Solution) -> float | None:
    """Restitution of a motion's first impact; None where it has none."""
    return _number(measured(solution).restitution[0])


def beside_mean(problem: Problem, solution: Solution) -> Problem:
    """The problem with single bodies, where it leaves them open and a mean is not enough.

    That is where few asperities carry the load of the first impact, or it is close to capture.

    Parameters
    ----------
    problem
        What was built from a case, with the contact that it was integrated with.
    solution
        Its motion.
    """
    inputs = problem.inputs
    if inputs.beside is None:
        return problem
    at_depth = AtDepth.of(solution.motion, solution.trajectory)
    regime = regime_of(problem, at_depth)
    if not bodies_differ(problem, regime, at_depth.central, solution.motion):
        return problem
    return problem._replace(inputs=inputs.with_bodies())


def result_of(
    case: Case,
    name: str,
    problem: Problem,
    solution: Solution,
    elastic: float | None = None,
    most: int | None = None,
    realisations: Realisations | None = None,
) -> Result:
    """The result of a motion that was integrated.

    Parameters
    ----------
    case, name
        The case, and what to call it.
    problem
        What was built from it.
    solution
        The motion.
    elastic
        Restitution of the first impact were nothing to yield, for a case in which it does.
    most
        Impacts whose course is drawn, at least 1; all without it. What is measured is of all.
    realisations
        First impacts of single bodies, where the case asks for them.
    """
    problem = problem._replace(body=solution.body)
    motion, body, inputs = solution.motion, solution.body, problem.inputs
    made = int(np.sum(motion.impacts.made))
    measures = measured(solution)
    series, lost = _sampled(problem, solution, most)
    at_depth = AtDepth.of(motion, solution.trajectory)
    check_surface(problem, at_depth)
    regime = regime_of(problem, at_depth)
    forces, energies = _histories(solution.contact, motion, body, series, lost)
    impacts = motion.impacts
    return Result(
        case=case,
        name=name,
        outcome=solution.outcome,
        time=series.time,
        separation=series.separation,
        central_separation=series.rows[:, CENTRAL],
        speed=series.speed,
        forces=forces,
        energies=energies,
        regime=regime._asdict(),
        measures=_plain(measures, made),
        realisations=realisations,
        ledger=_ledger(solution.contact, motion, body, made),
        surface=inputs.surface_facts,
        warnings=[
            *measured_warnings(problem, regime, at_depth, motion, measures._asdict()),
            *slow_menisci(problem, motion, solution.trajectory),
            *kept_elastic(inputs, float(np.asarray(measures.restitution)[0]), elastic),
        ],
        events={
            name: np.asarray(getattr(impacts, name.removesuffix("_separation")))[:made]
            for name in EVENTS
        },
    )


def _histories(
    contact: Contact,
    motion: Motion,
    body: Body,
    series: Series,
    losses: dict[str, np.ndarray],
) -> tuple[dict[str, np.ndarray], dict[str, np.ndarray]]:
    """Forces and energies along the motion."""
    layout = quantities(contact)
    rows: np.ndarray = series.rows
    parts = rows[:, layout.components]
    forces: dict[str, np.ndarray] = {name: parts[:, k] for k, name in enumerate(contact.components)}
    forces["contact"] = rows[:, FORCE]
    forces["weight"] = np.full(len(rows), -float(body.plain.weight))
    forces["total"] = rows[:, FORCE] + forces["weight"]
    load = body.plain.load
    for force in load.forces:
        forces[force.name] = -np.asarray(force.force(series.separation))
        forces["total"] = forces["total"] + forces[force.name]
    for k, drag in enumerate(body.drags):
        forces[drag.name] = -series.drag[:, k] * series.speed
        forces["total"] = forces["total"] + forces[drag.name]
    zero = _zero_height(motion.reference)
    energies = {
        "kinetic": 0.5 * float(body.mass) * series.speed**2,
        "potential": np.asarray(load.potential_gain(zero, series.separation - zero)),
        "stored": rows[:, STORED],
    }
    for name, lost in losses.items():
        energies[f"lost_{name}"] = lost
    return forces, energies


def _known(motion: Motion) -> float:
    """Energy [J] to which losses are known: by the ledger, or as well as it is to close."""
    share = max(2.0 * balance_error(motion), CLOSED)
    return share * float(np.max(energy_at_stake(motion.impacts)))


def losses_by_name(contact: Contact, body: Body, lost: np.ndarray) -> dict[str, np.ndarray]:
    """Losses by mechanism, along the last axis, with those of one name together."""
    out: dict[str, np.ndarray] = {}
    for k, name in enumerate((*contact.mechanisms, *body.mechanisms)):
        out[name] = out.get(name, 0.0) + lost[..., k]
    return out


def _zero_height(ground: Reference) -> float:
    """Separation at which the potential energy is 0: the static equilibrium, if any."""
    at_rest = float(ground.equilibrium)
    return at_rest if np.isfinite(at_rest) else 0.0


def _ledger(contact: Contact, motion: Motion, body: Body, made: int) -> dict[str, Any]:
    """Energy at the release, lost by mechanism, and how well all of it adds up."""
    by_name = losses_by_name(contact, body, np.asarray(motion.impacts.lost[made - 1]))
    lost = {name: float(energy) for name, energy in by_name.items()}
    zero = _zero_height(motion.reference)
    initial = float(motion.release) - float(body.plain.load.potential_gain(0.0, zero))
    return {"initial": initial, "lost": lost, "energy_balance_error": balance_error(motion)}


def _plain(measures: Measures, made: int) -> dict[str, Any]:
    """Measures as plain numbers and lists, None where one does not apply."""
    out: dict[str, Any] = {}
    for name, value in measures._asdict().items():
        if name in ("contact_end", "touched", "outset", "margin", "held_at_pull_off"):
            continue
        array = np.asarray(value)
        if array.ndim == 0:
            out[name] = bool(array) if array.dtype == bool else _number(array)
        else:
            out[name] = [_number(x) for x in array[:made]]
    return out


def _number(value: Any) -> float | None:
    return float(value) if np.isfinite(value) else None
