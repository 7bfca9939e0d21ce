"""Finer scanning curves, where the energies of a motion do not add up."""

from __future__ import annotations

import dataclasses

import numpy as np

from ..contact import ElasticContact
from ..dynamics import Motion
from ..dynamics.problem import Problem
from ..regimes.accuracy import CLOSED, balance_error

_SOON, _LATER = 5, 24  # pieces of a curve for each law; 3 leave 2e-3 on a soft bulk, these 1e-7


def with_finer_scanning(problem: Problem, motion: Motion) -> Problem | None:
    """The problem with scanning curves of more pieces; None where that would change nothing.

    Bonds that stretch little are cut as their width asks for. On a soft bulk that adhesion draws
    out, the innermost rings pass from branch to branch many rms heights later. Where bonds lose
    less than what is missing of the balance, their scanning curves are not why.

    Parameters
    ----------
    problem
        What was built from a case.
    motion
        Its motion.
    """
    contact = problem.contact
    in_time = problem.delayed is not None or problem.relaxation is not None
    if in_time or not isinstance(contact, ElasticContact) or not contact.mechanisms:
        return None
    rows = motion.impacts
    lost = np.sum(rows.lost[:, : len(contact.mechanisms)], axis=1)
    by_bonds = np.max(np.where(rows.made, lost, 0.0)) / rows.maximum_kinetic[0]
    if contact.resolved.later or not CLOSED < balance_error(motion) < by_bonds:
        return None
    resolved = contact.resolved._replace(nodes=16, pieces=_SOON + _LATER, later=_LATER)
    return problem._replace(contact=dataclasses.replace(contact, resolved=resolved))
