"""Impact of a small body on a rough surface: bounce or stick, how much energy goes and where.

>>> import asperity
>>> case = asperity.load("glass-bead")
>>> case.body.radius
5e-05

A case: `load`, `Case`; its physical quantities: `resolve` -> `Inputs`.
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

    from .config import Case
    from .dynamics import Body, simulate
    from .errors import InputError, Outcome, SimulationError, Tolerance
    from .inputs import Inputs
    from .publication.reproduce import Reproduction, reproduce
    from .results.case_source import CaseLike
    from .results.measures import measure
    from .results.read_record import read
    from .results.result import Curve, Result
    from .solver import curve, solve
    from .sweeps.restitution_curve import RestitutionCurve, restitution_curve
    from .sweeps.store.dataset import open_study
    from .sweeps.sweep import sweep

__version__ = "0.1.0"

_HOMES = {
    "Body": "dynamics",
    "Case": "config",
    "Curve": "results.result",
    "InputError": "errors",
    "Inputs": "inputs",
    "Outcome": "errors",
    "Reproduction": "publication.reproduce",
    "RestitutionCurve": "sweeps.restitution_curve",
    "Result": "results.result",
    "SimulationError": "errors",
    "Tolerance": "errors",
    "curve": "solver",
    "measure": "results.measures",
    "open_study": "sweeps.store.dataset",
    "read": "results.read_record",
    "reproduce": "publication.reproduce",
    "restitution_curve": "sweeps.restitution_curve",
    "simulate": "dynamics",
    "solve": "solver",
    "sweep": "sweeps.sweep",
}

__all__ = [
    "Body",
    "Case",
    "Curve",
    "InputError",
    "Inputs",
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
    "resolve",
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
    from .results.case_source import source_of

    return source_of(source).case


def resolve(case: CaseLike) -> Inputs:
    """Every physical quantity of a case: contact modulus, mass, Kelvin radius, law in use.

    Parameters
    ----------
    case
        A case, or the name or path of one; see :func:`load`.

    Raises
    ------
    InputError
        If it is no case, a file of its surfaces cannot be used, or their asperities are as large
        as the body.
    """
    from .config.resolve import resolve as of_case
    from .results.case_source import case_of

    return of_case(case_of(case))


def __dir__() -> list[str]:
    """The public names alone, whatever was imported until now."""
    return sorted([*__all__, "__version__"])


if not TYPE_CHECKING:  # a type checker knows the names from above, and finds misspelt ones

    def __getattr__(name: str) -> Any:
        """Import a public name's room when it is first used: ``--help`` needs none of them."""
        if name not in _HOMES:
            raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
        return getattr(importlib.import_module(f".{_HOMES[name]}", __name__), name)
