"""A problem that is run again where its first run is not good enough: how, and in which order."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable

from ..contact import ElasticContact, RigidContact
from ..dynamics import Motion
from ..dynamics.problem import Problem
from ..errors import Outcome, Tolerance
from ..regimes.accuracy import CLOSED, balance_error
from ..results.conversion import Solution
from .clock import Report
from .finer_scanning import balanced, the_closer
from .jumping import over_folds
from .panel_cuts import Inaccurate

_DEEPER = 3  # times that curves are made to reach deeper
_FEWEST, _MOST = Tolerance().rings, 200  # rings that are doubled: fewer are asked for, to be quick


def refined(
    problem: Problem, run: Callable[[Problem, Report, int], Solution], report: Report
) -> Solution:
    """What a run of a problem gives, run again where that may answer it or close its balance.

    With curves that reach deeper where attraction draws the body out of them, with jumps where its
    equilibria fold, with another quadrature where curves of a rigid body miss the tolerance, and
    where the balance is not closed with finer scanning curves, then with twice the rings.

    Parameters
    ----------
    problem
        The problem.
    run
        What runs one, with its reports and the tries without an equilibrium before that counts.
    report
        Called with a fraction done and a line of text.

    Raises
    ------
    InputError, SimulationError
        As ``run``, where nothing else answers the problem.
    """

    def deep_enough(problem: Problem, report: Report, patience: int) -> Solution:
        found = run(problem, report, patience)
        for _ in range(_DEEPER):
            deeper = with_deeper_curves(found)
            if deeper is None:
                break
            problem = problem._replace(contact=deeper)
            found = run(problem, report, patience)
        return found

    def once(problem: Problem, report: Report) -> Solution:
        def patiently(problem: Problem, patience: int) -> Solution:
            return balanced(problem, lambda one, report: deep_enough(one, report, patience), report)

        try:
            return over_folds(problem, patiently, report)
        except Inaccurate:
            deep = _place_by_place(problem)
            if deep is None:
                raise
        return over_folds(deep, patiently, report)

    found = once(problem, report)
    finer = with_more_rings(problem, found.motion)
    return the_closer(found, finer, once, report, "twice the rings", before=1)


def with_more_rings(problem: Problem, motion: Motion) -> Problem | None:
    """The problem with twice the rings; None where its balance closes, or it is not to have them.

    A case that asks for fewer rings than usual is to be quick, and more than the largest number
    that a case may ask for are too many.

    Parameters
    ----------
    problem
        The problem.
    motion
        Its motion.
    """
    contact = problem.contact
    if problem.in_time or not isinstance(contact, ElasticContact):
        return None
    if not _FEWEST <= contact.rings <= _MOST or not balance_error(motion) > CLOSED:
        return None
    return problem._replace(contact=dataclasses.replace(contact, rings=2 * contact.rings))


def with_deeper_curves(found: Solution) -> ElasticContact | None:
    """The contact with curves as deep as attraction draws the body; None where they are.

    The depth of a half-space's curves counts what the body brings. Where attraction gives it far
    more, it may come deeper, and leaves them with the energy that it has by then.

    Parameters
    ----------
    found
        The motion of a problem.
    """
    contact, rows = found.contact, found.motion.impacts
    if not isinstance(contact, ElasticContact) or found.trajectory is not None:
        return None
    left = bool(rows.closest_approach[0] <= found.motion.table.ends[0])
    if found.outcome is not Outcome.FAILED or not left:
        return None
    drawn = max(float(rows.maximum_kinetic[0]), 2.0 * float(contact.drawn))
    return dataclasses.replace(contact, drawn=drawn)


def _place_by_place(problem: Problem) -> Problem | None:
    """The problem with another quadrature: see :meth:`RigidContact.place_by_place`."""
    if not isinstance(problem.contact, RigidContact) or problem.in_time:
        return None
    contact = problem.contact.place_by_place()
    return None if contact is None else problem._replace(contact=contact)
