"""How fast motions are computed here, the first time and after that."""

from __future__ import annotations

import time
from typing import NamedTuple

from asperity.cli.compiling import Compilation, compilation
from asperity.config import BUILTINS, builtin
from asperity.solver import solve

_REPEATS = 3


class Speed(NamedTuple):
    """Times of one motion.

    Attributes
    ----------
    case
        Name of the built-in case.
    first, warm
        From the case to its measures, the first time and after that [s].
    compiled
        What was compiled, or read from the cache, the first time.
    impacts
        Impacts of the motion.
    energy_balance_error
        Of its energy ledger, over the impact energy [-].
    """

    case: str
    first: float
    warm: float
    compiled: Compilation
    impacts: int
    energy_balance_error: float


NAMES = tuple(sorted(BUILTINS, key=len))
"""Cases that are timed: the quick one first."""


def speed(name: str) -> Speed:
    """Time a built-in case.

    Raises
    ------
    SimulationError
        Where its motion fails.
    """
    case, before, times = builtin(name), compilation(), []
    begun = time.perf_counter()
    result = solve(case, name=name, critical=False)
    first, compiled = time.perf_counter() - begun, compilation() - before
    for _ in range(_REPEATS):
        begun = time.perf_counter()
        solve(case, name=name, critical=False)
        times.append(time.perf_counter() - begun)
    impacts = len(result.measures["restitution"])
    return Speed(
        name, first, min(times), compiled, impacts, float(result.ledger["energy_balance_error"])
    )
