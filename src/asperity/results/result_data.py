"""What a run and a curve hold: plain numbers, arrays and text, which records and pictures read."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from asperity.errors import Outcome
from asperity.results.realisations import Realisations

if TYPE_CHECKING:
    from asperity.config import Case

Arrays = dict[str, np.ndarray]


@dataclass(frozen=True, eq=False, repr=False)
class ResultData:
    """A motion from release to its end, with its measures.

    Parameters
    ----------
    case : Case
        The resolved case.
    name : str
        What the case is called.
    outcome : Outcome
        How the motion ended.
    time : numpy.ndarray
        Time since the release [s].
    separation, central_separation : numpy.ndarray
        Rigid separation, and with the bodies' deformation [m]; as long as ``time``.
    speed : numpy.ndarray
        d(separation)/dt [m/s], positive apart; as long as ``time``.
    forces : dict of str to numpy.ndarray
        "weight", "elastic", "adhesion", "capillary", "contact" (all but the weight), "total" [N],
        positive apart; those that the case has, as long as ``time``.
    energies : dict of str to numpy.ndarray
        "kinetic", "potential", "stored" and "lost_MECHANISM" [J]; as long as ``time``.
    regime, measures, ledger : dict
        Plain numbers, lists and text in SI, None where one does not apply; see ``asperity run
        --json``.
    warnings : list of str
        What to know before the numbers are used.
    events : dict of str to numpy.ndarray
        "closest_approach_time", "apex_time" [s], "closest_approach_separation",
        "apex_separation" [m], per impact.
    input_sha256 : str, optional
        SHA-256 of the text that the case was read from; without it, of the resolved case's.
    case_file : str, optional
        Path of the case's file, or which built-in case it is; None of a case made in Python.
    surface : dict, optional
        Measured surfaces: files with their SHA-256, what was done to them, and what was found,
        in SI; None for a case of numbers.
    realisations : Realisations, optional
        First impacts of single bodies, each on summits of its own; None where the mean stands
        alone.
    """

    case: Case
    name: str
    outcome: Outcome
    time: np.ndarray
    separation: np.ndarray
    central_separation: np.ndarray
    speed: np.ndarray
    forces: Arrays
    energies: Arrays
    regime: dict[str, Any]
    measures: dict[str, Any]
    ledger: dict[str, Any]
    warnings: list[str]
    events: Arrays
    input_sha256: str | None = None
    case_file: str | None = None
    surface: dict[str, Any] | None = None
    realisations: Realisations | None = None


@dataclass(frozen=True, eq=False, repr=False)
class CurveData:
    """Force against separation, on the way in and on the way out, without motion.

    Parameters
    ----------
    case : Case
        The resolved case.
    name : str
        What the case is called.
    rigid_separation, central_separation : numpy.ndarray
        Rigid separation, and with the bodies' deformation on the way in [m].
    force_loading, force_unloading : numpy.ndarray
        Contact force [N], positive apart; as long as ``rigid_separation``.
    components_loading, components_unloading : dict of str to numpy.ndarray
        The forces taken apart by mechanism [N].
    minimum_separation : float
        Closest rigid separation [m].
    pull_off : float
        Largest tension while unloading [N].
    pull_off_separation : float, optional
        Rigid separation there [m]; None where nothing pulls.
    work_of_separation : float
        Work against tension while unloading, from the separation of zero force on [J].
    preload : float, optional
        Load at closest approach [N] where these three depend on it; None where any larger load
        gives the same.
    loss : float
        Energy lost over in and out [J].
    jumps : dict, optional
        Where a body on a spring jumps in and out while the spring's base is moved slowly: "in" and
        "out", each None or "separation", "force", "landing_separation", "landing_force" and the
        "energy" that is lost, in SI, and a "note" where one is missing. None without a spring.
    warnings : list of str
        What to know before the numbers are used.
    input_sha256 : str, optional
        SHA-256 of the text that the case was read from; without it, of the resolved case's.
    case_file : str, optional
        Path of the case's file, or which built-in case it is; None of a case made in Python.
    surface : dict, optional
        Measured surfaces, as a result has them.
    """

    case: Case
    name: str
    rigid_separation: np.ndarray
    central_separation: np.ndarray
    force_loading: np.ndarray
    force_unloading: np.ndarray
    components_loading: Arrays
    components_unloading: Arrays
    minimum_separation: float
    pull_off: float
    pull_off_separation: float | None
    work_of_separation: float
    preload: float | None
    loss: float
    warnings: list[str]
    jumps: dict[str, Any] | None = None
    input_sha256: str | None = None
    case_file: str | None = None
    surface: dict[str, Any] | None = None
