"""Cases that leave their group and are solved alone: those that may jump, and those too deep."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from asperity.contact import ElasticContact, RigidContact
from asperity.errors import SimulationError
from asperity.integration.jumping import likely_to_jump
from asperity.integration.panel_cuts import Inaccurate, Left, Unsolved
from asperity.sweeps.compute.building import Built, Group, Values, case_at
from asperity.sweeps.compute.integrate_batch import BatchSolution

if TYPE_CHECKING:
    from asperity.sweeps.study.study import Study


def without_jumps(study: Study, values: Values, whole: Built) -> Built:
    """The cases with those alone that are likely to jump.

    Parameters
    ----------
    study, values
        The study, and the values of its axes.
    whole
        All cases that were asked for.
    """
    groups, alone = [], [*whole.alone]
    for group in whole.groups:
        jumps = likely_to_jump(group.batch.contact, group.rows.size)
        alone += [(row, case_at(study, values, row)) for row in group.rows[jumps].tolist()]
        stay = np.flatnonzero(~jumps)
        if stay.size:
            groups.append(group if stay.size == jumps.size else group.some(stay))
    return Built(groups, alone, whole.refused)


def unfinished(group: Group, solution: BatchSolution) -> list[int]:
    """Rows of cases that failed beside others and may not alone: failures no longer.

    Those on a half-space without an equilibrium, which may jump, and those that attraction draws
    out of their curves; those of a rigid body whose curves miss the tolerance while places share a
    quadrature.

    Parameters
    ----------
    group, solution
        The cases, and what became of them.
    """
    contact = group.batch.contact
    if type(contact) is ElasticContact:
        ends: tuple[type[SimulationError], ...] = (Unsolved, Left)
    elif isinstance(contact, RigidContact) and contact.place_by_place() is not None:
        ends = (Inaccurate,)
    else:
        return []
    found = [place for place, why in solution.failures.items() if isinstance(why, ends)]
    for place in found:
        del solution.failures[place]
    return [int(group.rows[place]) for place in found]
