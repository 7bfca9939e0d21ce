"""What a result's numbers are uncertain by, and what was not asked for."""

from __future__ import annotations

from .case import Case
from .case.build import Problem
from .impact import Motion

HASTENED = 0.02
"""Share of the kinetic energy given that a fall may add without a word: 1 % of the speed."""


def fall_warnings(case: Case, problem: Problem, motion: Motion) -> list[str]:
    """A line where gravity hastens a body much that was launched from a release of no one's choice.

    Parameters
    ----------
    case, problem
        The case and what was built from it.
    motion
        The motion.
    """
    kinetic, weight = float(problem.body.kinetic), float(problem.body.weight)
    if case.impact.release_gap is not None or not weight > 0.0:
        return []
    fall = float(motion.release) - kinetic
    if fall <= HASTENED * kinetic:
        return []
    added = 100.0 * ((1.0 + fall / kinetic) ** 0.5 - 1.0)
    return [
        f"forces reach so far that the body is released at {fall / weight * 1e6:.3g} um, and "
        f"falling from there adds {added:.2g} % to its speed: give `release_gap`, or no gravity"
    ]
