"""First impacts at other speeds: the critical velocity, below which a body is captured."""

from __future__ import annotations

import dataclasses
import threading
from typing import Any, NamedTuple

import numpy as np

from .contact import ElasticContact, YieldingContact, interaction_range_of
from .dynamics import Limits
from .dynamics.capture_edges import Edges, FirstImpacts, capture_edges, speeds_about
from .dynamics.problem import CLEARANCE, Problem
from .errors import SimulationError, Tolerance
from .integration import launch
from .integration.batch_records import Slice
from .results.conversion import Solution, measured
from .results.summary import amount

LAUNCH_ERROR = 1e-6
"""Relative error of the force curves: an impact on worse ones is not counted."""


SLOWER = 0.25
"""Share of a launch speed down to which the curves for it serve: they are cut for its depth."""


class Rebound(NamedTuple):
    """The first impact of a body with one speed of approach.

    Attributes
    ----------
    speed
        Speed of approach at the end of contact [m/s]; NaN where it could not be computed.
    restitution
        Coefficient of restitution; 0 where it is captured, NaN where gas alone holds it.
    captured
        Whether it is captured.
    excess
        Kinetic energy left at the end of contact [J], as in
        :class:`asperity.dynamics.capture_edges.FirstImpacts`.
    margin
        Apex, from the separation below which that is a capture [m].
    """

    speed: float
    restitution: float
    captured: bool
    excess: float
    margin: float


_SLOW = (
    "not sought: each impact on a half-space that is stepped in time, or that jumps and has bonds, "
    "takes seconds; `asperity restitution` seeks it"
)

_UNKNOWN = Rebound(np.nan, np.nan, False, np.nan, np.nan)


class Launcher:
    """First impacts of the body of a problem, launched where the forces on it begin.

    Parameters
    ----------
    problem
        What was built from a case.
    solution
        A motion of it: its contact, its curves and its forces are taken.
    limits
        Ends of its motion.
    many
        As for :func:`asperity.integration.integrate`: it names the programs that are compiled
        already.
    finer
        Whether curves that are not fine enough are cut further. That is compiled anew.
    stop
        Set from another thread, it ends the search: no impact is computed after.
    """

    def __init__(
        self,
        problem: Problem,
        solution: Solution,
        limits: Limits,
        *,
        many: bool = False,
        finer: bool = False,
        stop: threading.Event | None = None,
    ) -> None:
        contact, body = solution.contact, solution.body
        outset = np.asarray(measured(solution).outset)
        launched = launch_separation(
            np.asarray(interaction_range_of(contact)), outset, np.asarray(body.release),
            yields=isinstance(contact, YieldingContact),
        )  # fmt: skip
        body = dataclasses.replace(body, release=launched)
        self._problem = problem._replace(body=body, contact=contact)
        self._many, self._stop = many, stop
        self._finer = finer or contact.sides > 1  # folds are steep
        self._limits = Limits.of(Tolerance(rest=float(limits.rest), max_impacts=1))
        self._curves: dict[float, Slice] = {}  # by the speed up to which they serve

    def __call__(self, speed: float) -> Rebound:
        """The first impact of a body launched with a speed [m/s]."""
        if self._stop is not None and self._stop.is_set():
            return _UNKNOWN
        body = dataclasses.replace(self._problem.body, speed=speed)
        problem = self._problem._replace(body=body)
        serve = [most for most in self._curves if SLOWER * most <= speed <= most]
        try:
            solution, begun = launch(
                problem, self._limits, LAUNCH_ERROR, self._stop, many=self._many,
                finer=self._finer, faster=self._curves[min(serve)] if serve else None,
            )  # fmt: skip
        except SimulationError:
            return _UNKNOWN
        if not serve and not isinstance(problem.contact, YieldingContact):
            self._curves[speed] = begun
        measures = measured(solution)
        if not np.isfinite(measures.contact_end):  # contact reaches beyond where it was launched
            return _UNKNOWN
        leaving = float(np.asarray(solution.motion.impacts.leaving)[0])
        return Rebound(
            float(measures.impact_speed),
            float(np.asarray(measures.restitution)[0]),
            bool(measures.captured),
            leaving - float(body.plain.load.potential(float(measures.contact_end))),
            float(measures.margin),
        )

    def together(self, cases: np.ndarray, speeds: np.ndarray) -> FirstImpacts:
        """First impacts with several speeds [m/s], one after the other; there is one case.

        The fastest first: its curves serve others.
        """
        found = [_UNKNOWN] * speeds.size
        for k in np.argsort(-speeds).tolist():
            found[k] = self(float(speeds[k]))
        dragged = self._problem.body.damped_apart
        return FirstImpacts.of(
            np.array([rebound.speed for rebound in found]),
            np.array([rebound.captured for rebound in found]),
            np.array([rebound.excess for rebound in found]),
            float(self._problem.body.mass),
            np.array([rebound.margin for rebound in found]) if dragged else None,
        )

    def edges(self, solution: Solution) -> Edges | None:
        """The edges of capture about a motion; None where nothing can take energy.

        Where first impacts that could not be computed hide an edge, or no edge is found, all are
        tried again with finer curves.

        Raises
        ------
        SimulationError
            If it was stopped.
        """
        body, impacts = self._problem.body, solution.motion.impacts
        if not (solution.contact.mechanisms or body.mechanisms):
            return None
        lost = float(solution.motion.release) - float(impacts.leaving[0])
        if not np.isfinite(lost):
            lost = float(np.sum(impacts.lost[0]))
        ends = speeds_about(
            np.asarray(impacts.maximum_kinetic[:1]), np.asarray([lost]), float(body.mass)
        )
        found = capture_edges(self.together, *ends)[0]
        hidden = found.lost or (found.unknown and not found.speeds)
        if hidden and not self._finer:
            self._finer = True
            self._curves.clear()
            found = capture_edges(self.together, *ends)[0]
        if self._stop is not None and self._stop.is_set():
            raise SimulationError("stopped while the critical velocity was sought")
        return found


def launch_separation(
    interaction_range: np.ndarray, outset: np.ndarray, release: np.ndarray, *, yields: bool
) -> np.ndarray:
    """Separation [m] from which a body is launched, outside contact even at the gentlest impact.

    Parameters
    ----------
    interaction_range
        Where any force ends [m].
    outset
        Where that of the gentlest impact does [m], by the curves of a motion.
    release
        Where that motion began [m]: its curves do not tell of what lies beyond.
    yields
        Whether the curves are those after one impact.
    """
    ends = np.minimum(interaction_range, outset)
    unknown = yields | ~(np.asarray(outset) < release)
    return np.where(unknown, interaction_range, ends) + CLEARANCE


def critical_measures(edges: Edges | None) -> dict[str, Any]:
    """The critical velocity as measures of a result.

    Parameters
    ----------
    edges
        The edges of capture; None where nothing can take energy.

    Returns
    -------
    ``critical_velocity`` [m/s] or None; ``capture_edges``, all that were found; and
    ``critical_velocity_note``: why there is none, or which speeds are captured where they are not
    just those below it.
    """
    note: str | None = None
    if edges is None:
        note = "every speed rebounds: nothing takes energy"
    elif not np.isfinite(edges.tried[0]):
        note = "not known: no first impact at another speed could be computed"
    elif edges.lost:
        note = "not all known: an edge of capture lies where no first impact could be computed"
    elif not edges.speeds:
        low, high = (amount(speed, "m/s") for speed in edges.tried)
        note = f"every speed tried {'is captured' if edges.lowest else 'rebounds'}, {low} to {high}"
        if edges.unknown:
            note += f"; at {edges.unknown} others no first impact could be computed"
    elif len(edges.speeds) > 1 or not edges.lowest:
        note = _intervals(edges)
    return {
        "critical_velocity": None if edges is None else edges.critical,
        "capture_edges": [] if edges is None else list(edges.speeds),
        "critical_velocity_note": note,
    }


def _intervals(edges: Edges) -> str:
    """Which speeds are captured."""
    ends = [""] * edges.lowest + [amount(speed, "m/s") for speed in edges.speeds]
    parts = []
    for low, high in zip(ends[::2], [*ends[1::2], ""], strict=False):
        both = f"from {low} to {high}" if low and high else ""
        parts.append(both or (f"below {high}" if high else f"above {low}"))
    return "captured " + ", ".join(parts)


def sought(
    solution: Solution,
    problem: Problem,
    limits: Limits,
    stop: threading.Event | None,
    *,
    many: bool = False,
) -> dict[str, Any]:
    """The critical velocity beside a motion, as :func:`critical_measures` says it.

    Parameters
    ----------
    solution, problem, limits, stop, many
        As for :class:`Launcher`.
    """
    if not solution.outcome.ok:
        return _without("not sought: the motion did not come to its end")
    contact = solution.contact
    jumps_with_bonds = contact.sides > 1 and bool(contact.mechanisms)
    stepped = solution.trajectory is not None and isinstance(contact, ElasticContact)
    if stepped or jumps_with_bonds:
        return _without(_SLOW)
    try:
        launcher = Launcher(problem, solution, limits, many=many, stop=stop)
        return critical_measures(launcher.edges(solution))
    except SimulationError as error:
        return _without(f"not known: {error}")


def _without(note: str) -> dict[str, Any]:
    return {"critical_velocity": None, "capture_edges": [], "critical_velocity_note": note}
