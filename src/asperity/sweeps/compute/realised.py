"""Single bodies of the cases of a study, beside their mean."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from asperity.errors import InputError, SimulationError
from asperity.integration.batch_records import taken
from asperity.integration.clock import Clock
from asperity.single_bodies import realise
from asperity.sweeps.compute.building import Group, Values, problem_at
from asperity.sweeps.compute.integrate_batch import BatchSolution
from asperity.sweeps.study.columns import OF_BODIES

if TYPE_CHECKING:
    from asperity.sweeps.study.study import Study


def realised(
    study: Study, values: Values, group: Group, solution: BatchSolution, clock: Clock
) -> dict[str, np.ndarray]:
    """The measures `OF_BODIES` of a group whose mean is known; none where none is kept.

    A case whose single bodies cannot be launched is put among the failures of the ``solution``.

    Parameters
    ----------
    study, values
        The study, and the values of its axes.
    group, solution
        Some of its cases, and what became of them.
    clock
        Ends it, by `Stopped`.
    """
    if not any(column in OF_BODIES for column in study.columns):
        return {}
    found = {column.name: np.full(group.rows.size, np.nan) for column in OF_BODIES}
    for index in np.flatnonzero(solution.made > 0).tolist():
        problem = problem_at(study, values, group, index)
        if problem.inputs.placement is None:
            continue
        clock.look()
        body = taken(solution.body, np.array([index]))
        turning_point = float(solution.history["closest_approach"][index, 0])
        try:
            bodies = clock.timed(
                partial(realise, problem, body, turning_point, stop=clock.stop, rebounds=False)
            )
        except (InputError, SimulationError) as error:
            clock.look()
            solution.failures[index] = error
            continue
        for name, value in bodies.columns().items():
            found[name][index] = value
    return found
