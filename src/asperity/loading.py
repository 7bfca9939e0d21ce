"""Loading to a load or a depth without a motion: an impact that turns just there."""

from __future__ import annotations

import dataclasses

import numpy as np
from numpy.polynomial.chebyshev import chebval

from .contact import interaction_range_of
from .dynamics import Body, Table
from .dynamics.curve_table import FORCE
from .dynamics.external_forces import Load
from .dynamics.problem import CLEARANCE, Problem
from .dynamics.static_equilibrium import find_reference
from .errors import InputError, SimulationError
from .integration import over_folds, prepared
from .integration.panel_cuts import RESIDUAL, Unsolved
from .laws.law import as_float64
from .numerics.compilation import AT_ONCE, Program
from .numerics.polynomials import local

_LEAST, _FACTOR, _STEPS = 1e-24, 8.0, 40  # J: energies of curves, until they reach far enough
_HELD = 2.0  # times the largest force holds a body back that attraction draws in

_reference = Program(find_reference, AT_ONCE)


def turning_at(
    problem: Problem, *, load: float | None = None, depth: float | None = None
) -> Problem:
    """The problem with a body that turns for the first time at a load or at a depth.

    Without weight, gas and waves, from where forces begin. Where attraction alone would draw it
    in deeper a constant force holds it back.

    Parameters
    ----------
    problem
        What was built from a case.
    load
        Contact force at the turn [N], 0 or more; the gentlest approach that carries it.
    depth
        How far the rigid separation is below 0 at the turn [m]; negative for a turn above.

    Raises
    ------
    InputError
        If the load or the depth cannot be reached, or not exactly one of them is given.
    SimulationError
        If the contact cannot be solved.
    """
    if (load is None) == (depth is None):
        raise InputError("either `load` or `depth` must be given; got both or neither", key="load")
    if load is not None and not (np.isfinite(load) and load >= 0.0):
        raise InputError(f"`load` must be 0 N or more; got {load:.6g} N", key="load")
    contact, mass = problem.contact, float(problem.body.mass)
    release = float(interaction_range_of(contact)) + CLEARANCE
    if depth is not None and not -release < depth < np.inf:
        raise InputError(
            f"`depth` must lie above {-release * 1e9:.6g} nm, where forces begin; "
            f"got {depth * 1e9:.6g} nm",
            key="depth",
        )
    body = Body(mass, 0.0, release, rebounds_from=problem.body.rebounds_from)
    for step in range(_STEPS):
        speed = np.sqrt(2.0 * _LEAST * _FACTOR**step / mass)
        table = _tabulated(problem._replace(body=dataclasses.replace(body, speed=speed)))
        place = _place(table, load) if load is not None else -float(depth or 0.0)
        if place is not None and float(table.ends[0]) < place:
            return problem._replace(body=_turning(body, table, place))
    wanted = f"a load of {load:.6g} N" if depth is None else f"a depth of {1e9 * depth:.6g} nm"
    raise SimulationError(f"no approach was found that reaches {wanted}")


def _tabulated(problem: Problem) -> Table:
    """The curves of a problem, with the jumps of a contact whose equilibria fold."""

    def run(one: Problem, patience: int) -> Table:
        table, _ = prepared(one.contact, one.body)
        if not patience and not float(table.residual) <= RESIDUAL:
            raise Unsolved("no equilibrium follows from the one before")
        return table

    return over_folds(problem, run)


def _place(table: Table, load: float) -> float | None:
    """Where an approach first carries a load [m]; None where nothing in the table does."""
    place = float(_reference(table, Load(as_float64(load / (1.0 + 1e-9))), 0).equilibrium)
    return place if np.isfinite(place) else None


def _turning(body: Body, table: Table, place: float) -> Body:
    """The body with the energy and the force against it that make it turn at a place [m]."""
    release = float(body.release)
    gained = _gained(table, release) - _gained(table, place)
    looks, works = np.asarray(table.looks).ravel(), np.asarray(table.works.looks)[0].ravel()
    before = (looks > place) & (looks < release)
    force = 0.0
    if gained <= 0.0 or np.any(works[before] <= _gained(table, place)):
        passed = np.asarray(table.ends)[1:] > place
        terms = np.abs(np.asarray(table.values)[0, passed, :, FORCE])
        force = _HELD * float(np.max(np.sum(terms, axis=1)))
    speed = np.sqrt(2.0 * (gained + force * (release - place)) / float(body.mass))
    return dataclasses.replace(body, speed=speed, gravity=-force / float(body.mass))


def _gained(table: Table, place: float) -> float:
    """Work of the contact force from the top of the table to a place of its approach [J]."""
    panel = int(table.panel_at(as_float64(place)))
    low, high = np.asarray(table.ends)[panel : panel + 2]
    return float(chebval(local(low, high, place), np.asarray(table.works.integral)[0, panel, :, 0]))
