"""Where a few cases of a study leave the validity of their models."""

from __future__ import annotations

from typing import Any

from asperity.dynamics import Impacts, Motion
from asperity.dynamics.problem import Problem
from asperity.regimes.few_asperities import pull_warnings
from asperity.regimes.validity import AtDepth, release_warnings, warnings_of
from asperity.results.assessment import regime_of
from asperity.sweeps.compute.integrate_batch import BatchSolution

Warned = tuple[int, str]
"""The number of a case, and a line on where it leaves the validity of its models."""


def warnings_in(problem: Problem, solution: BatchSolution, place: int) -> list[str]:
    """One line for each way in which a case of a solution leaves the validity of its models.

    Parameters
    ----------
    problem
        What was built from the case.
    solution
        The solution, in which it made an impact.
    place
        Its place in the solution.
    """
    at_depth = AtDepth(*solution.at_depth[place].tolist())
    rows: Any = {name: array[place] for name, array in solution.history.items()}
    none: Any = None
    release: Any = solution.release[place]
    motion = Motion(Impacts(**rows, fall=none, rise=none), none, none, none, release)
    pull_off, held, contact_end = (
        float(solution.measures[name][place])
        for name in ("pull_off", "held_at_pull_off", "contact_end")
    )
    return [
        *warnings_of(problem, regime_of(problem, at_depth), at_depth, motion),
        *pull_warnings(problem.inputs, pull_off, held),
        *release_warnings(contact_end),
    ]
