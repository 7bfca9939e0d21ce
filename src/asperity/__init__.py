"""Impact of a small body on a rough surface: bounce or stick, how much energy goes and where.

>>> import asperity
>>> case = asperity.load("published-exact")
>>> case.body.radius
5e-05
"""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from .case import Case
    from .errors import InputError, Outcome, SimulationError, Tolerance
    from .impact import Body, simulate
    from .measures import measure
    from .records import read
    from .restitution import RestitutionCurve, restitution_curve
    from .result import Curve, Result
    from .solver import curve, solve
    from .studies.reproduce import Reproduction, reproduce
    from .studies.sweep.dataset import open_study

__version__ = "0.1.0"

_HOMES = {
    "Body": "impact",
    "Case": "case",
    "Curve": "result",
    "InputError": "errors",
    "Outcome": "errors",
    "Reproduction": "studies.reproduce",
    "RestitutionCurve": "restitution",
    "Result": "result",
    "SimulationError": "errors",
    "Tolerance": "errors",
    "curve": "solver",
    "measure": "measures",
    "open_study": "studies.sweep.dataset",
    "read": "records",
    "reproduce": "studies.reproduce",
    "restitution_curve": "restitution",
    "simulate": "impact",
    "solve": "solver",
}

__all__ = [
    "Body",
    "Case",
    "Curve",
    "InputError",
    "Outcome",
    "Reproduction",
    "RestitutionCurve",
    "Result",
    "SimulationError",
    "Tolerance",
    "curve",
    "load",
    "measure",
    "open_study",
    "read",
    "reproduce",
    "restitution_curve",
    "simulate",
    "solve",
]


def load(source: str) -> Case:
    """A built-in case by its name, or a case file by its path.

    Parameters
    ----------
    source
        Name such as ``"published-exact"``, or the path of a ``.toml`` file.

    Raises
    ------
    InputError
        If there is none, or it breaks a rule.
    """
    from . import case

    return case.builtin(source) if source in case.BUILTINS else case.load_file(source)


def __getattr__(name: str) -> Any:
    """Import a public name's room when it is first used: ``--help`` needs none of them."""
    if name not in _HOMES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(importlib.import_module(f".{_HOMES[name]}", __name__), name)
