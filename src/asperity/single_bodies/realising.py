"""The single bodies of a case: their first impacts, and rebounds until they are captured."""

from __future__ import annotations

import threading

import numpy as np

from ..dynamics import Body
from ..dynamics.problem import Problem
from ..dynamics.single_impact import SingleImpact
from ..dynamics.summit_path import Launch
from ..integration import Report, silently
from ..interface.summit_field import MeasuredField
from ..results.realisations import KINDS, Realisations
from .launching import SingleBodies

INTERACTION = "interaction"
"""Loss of bonds that summits beside them add on a half-space."""

REBOUNDS = 20
"""Rebounds of a single body that are followed until it is captured."""

FOLLOWED = 4096
"""Bodies whose rebounds are followed; of more, the first impact alone."""


def realise(
    problem: Problem,
    body: Body,
    turning_point: float,
    report: Report = silently,
    stop: threading.Event | None = None,
    *,
    rebounds: bool = True,
) -> Realisations:
    """First impacts of the single bodies of a case.

    Parameters
    ----------
    problem
        What was built from a case with single bodies.
    body
        Where each is released, and how fast; it moves as the problem's does.
    turning_point
        Separation [m] of the first turning point of the mean over all.
    report, stop
        As for :func:`asperity.integration.integrate`.
    rebounds
        Whether up to `FOLLOWED` of them are followed until they are captured, which takes up to
        twenty times as long.

    Raises
    ------
    InputError, SimulationError
        As :meth:`SingleBodies.impacts`.
    """
    placed = problem.inputs.placement
    assert placed is not None
    report(0.9, f"{placed.realisations} single bodies")
    bodies = SingleBodies(problem, turning_point)
    plain = body.plain
    launch = (np.ravel(x)[0] for x in (plain.kinetic, plain.release))
    launches = Launch(*(np.full(placed.realisations, value) for value in launch))
    first = bodies.impacts(launches, stop)
    lost: dict[str, np.ndarray] = {}
    for name, energy in zip(bodies.mechanisms, np.asarray(first.lost).T, strict=True):
        lost[name] = lost.get(name, 0.0) + energy
    if np.any(first.interaction):
        lost[INTERACTION] = np.asarray(first.interaction)
    values = {name: np.asarray(getattr(first, name)) for name in KINDS if name in first._fields}
    if rebounds and placed.realisations <= FOLLOWED:
        report(0.9, "rebounds of single bodies")
        most = min(REBOUNDS, problem.inputs.tolerance.max_impacts - 1)
        followed = _until_captured(bodies, first, most, stop)
        values |= dict(zip(("rebounds", "flight_time"), followed, strict=True))
    warnings = [bodies.note] if bodies.note else []
    if isinstance(bodies.field, MeasuredField):
        warnings.append(
            "single bodies stand on one map: intervals are over positions on it, not other maps"
        )
    if sunk := int(np.sum(values["closest_approach"] < bodies.field.base)):
        warnings.append(
            f"{sunk} of {placed.realisations} single bodies come deeper than "
            f"{bodies.field.base * 1e9:.3g} nm, below which next to no summit stands: the surface "
            "between would carry them, and is not described"
        )
    captured = np.asarray(first.captured)
    return Realisations(captured, values, lost, bodies.first(first), tuple(warnings))


def _until_captured(
    bodies: SingleBodies,
    first: SingleImpact,
    most: int,
    stop: threading.Event | None,
) -> tuple[np.ndarray, np.ndarray]:
    """Rebounds of each body before it is captured, and the time [s] that they take in flight.

    Infinite where that takes more than ``most`` rebounds, and where it leaves for good. A
    rigid body falls on the same summits each time, and all their bonds are broken while it flies.
    Tips that yielded stay as the first impact left them: none that follows goes deeper.
    """
    rebounds = np.where(first.captured, 0.0, np.inf)
    flight = np.zeros(rebounds.shape)
    found, deepest = first, np.asarray(first.closest_approach)
    for made in range(1, most + 1):
        kinetic = np.asarray(found.impact_energy) * np.asarray(found.restitution) ** 2
        end = np.asarray(found.end)
        launches, time = bodies.flights(end, kinetic)
        launches = launches._replace(kinetic=np.where(np.isinf(rebounds), launches.kinetic, np.nan))
        flying = np.isfinite(launches.kinetic)
        if not np.any(flying):
            break
        flight += np.where(flying, time, 0.0)
        found = bodies.impacts(launches, stop, with_pull_off=False, before=deepest)
        rebounds[flying & np.asarray(found.captured)] = made
    return rebounds, np.where(np.isinf(rebounds), np.inf, flight)
