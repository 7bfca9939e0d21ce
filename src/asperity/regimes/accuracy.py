"""What a result's numbers are uncertain by, and what was not asked for."""

from __future__ import annotations

import numpy as np

from ..contact import ElasticContact
from ..contact.ring_error import ring_error
from ..dynamics import Motion
from ..dynamics.curve_table import SIZE, quantities, read_row
from ..dynamics.problem import Problem

CLOSED = 1e-6
"""Share of the impact energy to which a ledger that can be trusted closes."""

HASTENED = 0.02
"""Share of the kinetic energy given that a fall may add without a word: 1 % of the speed."""


def fall_warnings(problem: Problem, motion: Motion) -> list[str]:
    """A line where gravity hastens a body much that was launched from a release of no one's choice.

    Parameters
    ----------
    problem
        What was built from a case.
    motion
        The motion.
    """
    body = problem.body.plain
    kinetic, weight = float(body.kinetic), float(body.weight)
    if not problem.inputs.chosen_release or not weight > 0.0:
        return []
    fall = max(float(motion.release) - kinetic, weight * float(body.release))
    if fall <= HASTENED * kinetic:
        return []
    added = 100.0 * ((1.0 + fall / kinetic) ** 0.5 - 1.0)
    return [
        f"forces reach so far that the body is released at {fall / weight * 1e6:.3g} um, and "
        f"falling from there adds {added:.2g} % to its speed: give `release_separation`, or no "
        "gravity"
    ]


def ring_warnings(problem: Problem, motion: Motion) -> list[str]:
    """A line where too few rings resolve the bulk's deformation at closest approach.

    More than the tolerance asks for, or than a ledger's balance where that is less strict.

    Parameters
    ----------
    problem
        What was built from a case.
    motion
        The motion; without its curves nothing is said.
    """
    contact, table = problem.contact, motion.table
    if not isinstance(contact, ElasticContact) or table is None or problem.relaxation is not None:
        return []
    deepest = float(motion.impacts.closest_approach[0])
    row = read_row(table, 0, deepest)
    off = ring_error(contact, deepest, float(row[SIZE]), row[quantities(contact).field])
    allowed = max(problem.inputs.tolerance.relative, CLOSED)
    if not off > allowed:
        return []
    return [
        f"{contact.rings} rings leave an estimated error of {off:.1g} in the force at closest "
        f"approach, above {allowed:.0e}: raise `numerics.rings`"
    ]


def balance_error(motion: Motion) -> float:
    """Largest error of the energy balance of an impact, over the first one's kinetic energy [-]."""
    rows = motion.impacts
    errors = np.where(rows.made, rows.energy_balance_error, 0.0)
    return float(np.max(errors) / rows.maximum_kinetic[0])


def ledger_warnings(problem: Problem, motion: Motion) -> list[str]:
    """A line where the energies of a motion do not add up to what a model closes to.

    Parameters
    ----------
    problem, motion
        As for :func:`ring_warnings`.
    """
    what = "scanning curve" if problem.relaxation is None else "viscoelastic contact"
    if isinstance(problem.contact, ElasticContact) and problem.relaxation is None:
        what += f" or the deformation on {problem.contact.rings} rings"
    off = balance_error(motion)
    if off <= CLOSED:
        return []
    return [
        f"the energy ledger closes to {off:.1g} of the impact energy only, not to {CLOSED:.0e}: "
        f"the {what} is not resolved"
    ]
