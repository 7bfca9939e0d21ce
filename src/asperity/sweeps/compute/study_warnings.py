"""Where a few cases of a study leave the validity of their models."""

from __future__ import annotations

from typing import Any

from asperity.dynamics import Impacts, Motion
from asperity.dynamics.problem import Problem
from asperity.regimes.validity import AtDepth
from asperity.results.assessment import measured_warnings, regime_of
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
    measures = {name: array[place] for name, array in solution.measures.items()}
    return measured_warnings(problem, regime_of(problem, at_depth), at_depth, motion, measures)
