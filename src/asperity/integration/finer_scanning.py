"""Finer scanning curves, where the energies of a motion do not add up."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable

import numpy as np

from ..contact import ElasticContact, RigidContact
from ..contact.contact import YieldingContact
from ..dynamics import Motion
from ..dynamics.problem import Problem
from ..errors import Outcome, SimulationError
from ..regimes.accuracy import CLOSED, balance_error, branches_miss_it, energy_at_stake
from ..results.conversion import Solution
from .clock import Report

_SOON, _LATER = 5, 24  # pieces for each law, at least; 3 leave 2e-3 on a soft bulk, these 1e-7
_RUN, _AGAIN = 0.85, 0.025  # share of the work that a run is, and that another one counts as
_STORED = 1e3  # times what bonds can lose; curves of 3 nodes miss more than that itself
_RIGID = 4  # times the even pieces without a bulk; 8 leave 3e-6 of some menisci, 32 1e-13
_NARROWING = 6  # besides; without them 16 even ones leave 1.5e-5 of menisci narrower than these


def balanced(
    problem: Problem, run: Callable[[Problem, Report], Solution], report: Report
) -> Solution:
    """What a run of a problem gives, run again where finer scanning curves may close its balance.

    Parameters
    ----------
    problem
        The problem.
    run
        What runs it, and reports.
    report
        Called with a fraction done and a line of text.

    Raises
    ------
    SimulationError
        As ``run``, the first time.
    """
    found = run(problem, report)
    finer = with_finer_scanning(problem, found.motion)
    return the_closer(found, finer, run, report, "finer scanning curves")


def the_closer(
    found: Solution,
    finer: Problem | None,
    run: Callable[[Problem, Report], Solution],
    report: Report,
    why: str,
    before: int = 0,
) -> Solution:
    """What was found, or what a run of a finer problem gives where its energies add up better.

    Parameters
    ----------
    found
        The motion of a problem.
    finer
        The finer problem, None without one.
    run, report
        As for :func:`balanced`.
    why
        What is finer.
    before
        How many kinds of finer runs may have come before.
    """
    if finer is None or found.outcome is Outcome.INTERRUPTED:
        return found
    begin = _RUN + before * _AGAIN
    report(begin, why)
    try:
        again = run(finer, lambda share, text: report(begin + _AGAIN * share, text))
    except SimulationError:  # stopped, or not to be had: the first answer says what it misses
        return found
    if not again.outcome.ok:
        return found
    return min(found, again, key=lambda one: balance_error(one.motion))


def with_finer_scanning(problem: Problem, motion: Motion) -> Problem | None:
    """The problem with scanning curves of more pieces; None where that would change nothing.

    Curves are cut as the width of bonds asks for. On a soft bulk that adhesion draws out, the
    innermost rings pass from branch to branch many rms heights later, and forces of wide bonds may
    bend within a piece. Where the bonds at closest approach can lose far less than what is missing
    of the balance, their scanning curves are not why; nor where branches miss half of it.

    Parameters
    ----------
    problem
        What was built from a case.
    motion
        Its motion.
    """
    contact = problem.contact
    cut = isinstance(contact, ElasticContact | RigidContact)
    cut = cut and not isinstance(contact, YieldingContact)  # its pieces are those of its heights
    if problem.in_time or not cut or not contact.mechanisms:
        return None
    rows = motion.impacts
    losable = np.asarray(rows.bonds) @ np.sum(motion.table.losses, axis=0)
    by_bonds = _STORED * np.max(np.where(rows.made, losable, 0.0) / energy_at_stake(rows))
    if contact.resolved.later or not CLOSED < balance_error(motion) < by_bonds:
        return None
    if branches_miss_it(motion):
        return None
    if isinstance(contact, ElasticContact):
        pieces = max(_SOON, contact.resolved.pieces) + _LATER
        resolved = contact.resolved._replace(nodes=16, pieces=pieces, later=_LATER)
    else:
        pieces = _RIGID * contact.resolved.pieces + _NARROWING
        resolved = contact.resolved._replace(nodes=16, pieces=pieces, later=_NARROWING)
    return problem._replace(contact=dataclasses.replace(contact, resolved=resolved))
