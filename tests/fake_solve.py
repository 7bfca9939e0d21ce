"""The program with a solver that answers at once, fails, or takes its time; for tests of the rest.

``python fake_solve.py BEHAVIOUR ARGUMENTS...`` is ``asperity ARGUMENTS...`` with such a solver.
"""

from __future__ import annotations

import dataclasses
import sys
import time
import types
from pathlib import Path
from typing import Any

sys.path.insert(0, str(Path(__file__).parent))

from asperity.errors import InputError, Outcome, SimulationError
from fake_result import bounce, loading


def solver(behaviour: str = "quick") -> Any:
    """A stand-in for the module ``asperity.solver``."""
    module = types.ModuleType("asperity.solver")

    def solve(case: Any, *, name: str = "", progress: Any = None, stop: Any = None) -> Any:
        result = bounce(impacts=6, case=case, name=name or case.name)
        if behaviour == "refuse":
            rule = "`release_separation` must be above 45.9 nm; got 40 nm"
            raise InputError(rule, key="impact.release_separation")
        if behaviour == "fail":
            failed = dataclasses.replace(result, outcome=Outcome.FAILED)
            raise SimulationError("no equilibrium at 44 nm", failed)
        if behaviour == "break":
            raise SimulationError("no equilibrium at 44 nm")
        if behaviour == "bug":
            raise ZeroDivisionError("a bug")
        if behaviour in ("slow", "deaf"):
            sys.stderr.write("computing\n")
            sys.stderr.flush()
            give_up = time.monotonic() + 30.0
            while time.monotonic() < give_up and (behaviour == "deaf" or not stop.is_set()):
                time.sleep(0.01)
            return dataclasses.replace(result, outcome=Outcome.INTERRUPTED)
        if progress is not None:
            progress(0.5, "impact 3")
        return result

    def curve(case: Any, *, name: str = "", progress: Any = None, stop: Any = None) -> Any:
        return loading(case=case, name=name or case.name)

    def explore(case: Any, *, most: int | None = None, **more: Any) -> Any:
        return module.solve(case, **more), module.curve(case)

    module.solve, module.curve, module.explore = solve, curve, explore  # type: ignore[attr-defined]
    module.critical_velocity = lambda case, **more: {"critical_velocity": None}  # type: ignore[attr-defined]
    return module


if __name__ == "__main__":
    sys.modules["asperity.solver"] = solver(sys.argv.pop(1))
    from asperity.cli import main

    main()
