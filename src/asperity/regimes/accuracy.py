"""What a result's numbers are uncertain by, and what was not asked for."""

from __future__ import annotations

import numpy as np
from numpy.polynomial.chebyshev import chebval

from ..contact import ElasticContact
from ..contact.ring_error import ring_error
from ..dynamics import Impacts, Motion
from ..dynamics.curve_table import SIZE, STORED, Quantities, quantities, read_row
from ..dynamics.problem import Problem

CLOSED = 1e-6
"""Energy balance error of a ledger that can be trusted, at most."""

_HALF = 0.5  # of what is missing of an energy balance: its cause

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


def energy_at_stake(impacts: Impacts) -> np.ndarray:
    """The energy over which the balance of each impact is told [J], shape (..., impacts).

    The larger of the impact energy and the energy lost since the release. Where attraction gives a
    slow body far more than it brought, and all of that is lost, the impact energy is a small part
    of what the balance adds up.

    Parameters
    ----------
    impacts
        One row an impact, arrays of shape (..., impacts[, mechanisms]).
    """
    kinetic = np.asarray(impacts.maximum_kinetic)[..., :1]
    return np.maximum(kinetic, np.sum(impacts.lost, axis=-1))


def balance_errors(impacts: Impacts) -> np.ndarray:
    """Energy balance errors of motions [-], shape (...): of each its largest of an impact.

    Over :func:`energy_at_stake`.

    Parameters
    ----------
    impacts
        As there.
    """
    errors = np.asarray(impacts.energy_balance_error) / energy_at_stake(impacts)
    return np.asarray(np.max(np.where(impacts.made, errors, 0.0), axis=-1))


def balance_error(motion: Motion) -> float:
    """Energy balance error of one motion [-]: see :func:`balance_errors`."""
    return float(balance_errors(motion.impacts))


def branches_miss_it(motion: Motion) -> bool:
    """Whether major branches miss half of the energy that is missing of the first impact.

    Between its closest approach and the end of forces, on the branch of approach or on that of
    retreat. No scanning curve has a part in it: rings miss it, on a mesh whose size changes. Where
    branches fold, a jump takes energy on the way, and nothing is told.

    Parameters
    ----------
    motion
        A motion with its curves.
    """
    table, rows = motion.table, motion.impacts
    ends, values, looks = (np.asarray(x) for x in (table.ends, table.values, table.works.looks))
    laws = rows.bonds.shape[-1]
    if values.shape[0] > (2 if laws else 1):
        return False
    panel = int(np.sum(ends[:-1] < float(rows.closest_approach[0])))
    panel, bonds = min(panel, ends.size - 2), Quantities(laws, 0).bonds
    missed = []
    for branch, losses in ((0, np.asarray(table.losses[0])), (-1, -np.asarray(table.losses[1]))):
        inner, outer = chebval(-1.0, values[branch, panel]), chebval(1.0, values[branch, -1])
        change = inner - outer
        missed.append(abs(change[STORED] + looks[branch, panel, 0] + change[bonds] @ losses))
    return bool(max(missed) > _HALF * float(rows.energy_balance_error[0]))


def ledger_warnings(problem: Problem, motion: Motion) -> list[str]:
    """A line where the energies of a motion do not add up to what a model closes to.

    Parameters
    ----------
    problem, motion
        As for :func:`ring_warnings`.
    """
    off = balance_error(motion)
    if off <= CLOSED:
        return []
    what = "scanning curve" if problem.relaxation is None else "viscoelastic contact"
    if isinstance(problem.contact, ElasticContact) and problem.relaxation is None:
        bulk = f"deformation on {problem.contact.rings} rings"
        rings = motion.table is not None and branches_miss_it(motion)
        what = bulk if rings else f"{what} or the {bulk}"
    return [
        f"the energy ledger closes to {off:.1g} of the impact energy or of that lost, not to "
        f"{CLOSED:.0e}: the {what} is not resolved"
    ]
