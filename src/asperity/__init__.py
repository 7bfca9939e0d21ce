"""Impact of a small body on a rough surface: bounce or stick, how much energy goes and where.

>>> import asperity
>>> case = asperity.load("glass-bead")
>>> case.body.radius
5e-05

A case: `load`, `Case`.
What it does: `solve` -> `Result`, `curve` -> `Curve`, `restitution_curve` -> `RestitutionCurve`.
Many cases: `sweep`, and `open_study` for the store of a study.
Files: `read` a record. The publication: `reproduce` -> `Reproduction`.
How a motion ends, and what can go wrong: `Outcome`, `InputError`, `SimulationError`, `Tolerance`.
Below the case file, for gradients and batches: `Body`, `simulate`, `measure`.

What `help` lists as package contents is internal, but for the modules on the page on Python.
"""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    import os

    from .case import Case
    from .errors import InputError, Outcome, SimulationError, Tolerance
    from .impact import Body, simulate
    from .measures import measure
    from .records.decoding import read
    from .restitution import RestitutionCurve, restitution_curve
    from .result import Curve, Result
    from .solver import curve, solve
    from .studies.reproduce import Reproduction, reproduce
    from .studies.sweep.dataset import open_study
    from .studies.sweep.grid import sweep

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
    "read": "records.decoding",
    "reproduce": "studies.reproduce",
    "restitution_curve": "restitution",
    "simulate": "impact",
    "solve": "solver",
    "sweep": "studies.sweep.grid",
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
    "sweep",
]


def load(source: str | os.PathLike[str]) -> Case:
    """A built-in case by its name, or a case by the path of its file.

    Parameters
    ----------
    source
        Name such as ``"glass-bead"``, or the path of a ``.toml`` file, or of a record
        (``.nc``), whose case it is. Text without a suffix or a folder is a name.

    Raises
    ------
    InputError
        If there is none, or it breaks a rule.
    """
    from .sources import source_of

    return source_of(source).case


def __dir__() -> list[str]:
    """The public names alone, whatever was imported until now."""
    return sorted([*__all__, "__version__"])


if not TYPE_CHECKING:  # a type checker knows the names from above, and finds misspelt ones

    def __getattr__(name: str) -> Any:
        """Import a public name's room when it is first used: ``--help`` needs none of them."""
        if name not in _HOMES:
            raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
        return getattr(importlib.import_module(f".{_HOMES[name]}", __name__), name)
