"""Probability of capture against speed: single bodies, launched at every speed."""

from __future__ import annotations

import threading
from bisect import bisect_left
from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from math import sqrt

import numpy as np

from ..config import Case
from ..config.resolve import resolve
from ..contact import RigidContact
from ..dynamics.problem import Problem
from ..dynamics.single_impact import SingleImpact
from ..dynamics.summit_path import Launch
from ..integration import Report, silently
from ..model import build
from ..results.realisations import QUANTILES, clopper_pearson, mean_and_error, quantiles_of
from ..results.result import Result
from ..single_bodies import SingleBodies

_NEARBY, _SPEEDS = 4.0, 9  # times a case's own speed; speeds that are drawn at once
_HALVINGS = 8  # of the interval between two speeds where the share falls below a half
_FEW, _FEWEST = (256, 3), (32, 0)  # bodies and halvings then: on a rigid bulk, on a half-space


@dataclass(frozen=True, eq=False, repr=False)
class CaptureProbability:
    """What single bodies do at their first impact, at each of some speeds.

    Parameters
    ----------
    bodies : int
        How many were launched at each speed.
    probability, low, high : numpy.ndarray
        Share of them that is captured, and its interval at 95 %, shape (speeds,).
    mean, mean_error : numpy.ndarray
        Mean restitution, 0 where captured, and its standard error, shape (speeds,).
    restitution : numpy.ndarray
        Quantiles of their restitution, 0 where captured, shape (speeds, 3); see
        `asperity.results.realisations.QUANTILES`.
    half_velocity : float, optional
        Speed from which less than half are captured [m/s]. None where that is none of those tried.
    half_interval : tuple of float
        Its interval at 95 % [m/s]: the speeds at which a half lies within that of the share. None
        for an end that is none of those tried.
    """

    bodies: int
    probability: np.ndarray
    low: np.ndarray
    high: np.ndarray
    mean: np.ndarray
    mean_error: np.ndarray
    restitution: np.ndarray
    half_velocity: float | None
    half_interval: tuple[float | None, float | None]

    def columns(self) -> dict[str, np.ndarray]:
        """Columns of a table over the speeds, by their headings."""
        quantiles = dict(zip(QUANTILES, self.restitution.T, strict=True))
        return {
            "captured share [-]": self.probability,
            "its lower bound [-]": self.low,
            "its upper bound [-]": self.high,
            "mean restitution [-]": self.mean,
            "its standard error [-]": self.mean_error,
            **{f"restitution, quantile {q:g} [-]": values for q, values in quantiles.items()},
        }


def capture_probability(
    problem: Problem,
    turning_point: float,
    speeds: np.ndarray,
    report: Report = silently,
    stop: threading.Event | None = None,
    *,
    most: int | None = None,
    halvings: int = _HALVINGS,
) -> CaptureProbability | None:
    """Launch the single bodies of a case at every speed; None where it has none.

    Parameters
    ----------
    problem
        What was built from a case.
    turning_point
        Separation [m] of the first turning point of the mean over all.
    speeds
        Speeds where the forces on each body begin [m/s], ascending.
    report, stop
        As for :func:`asperity.integration.integrate`.
    most
        Bodies at most; all without it.
    halvings
        Of the interval between two speeds in which less than half begin to be captured. Within
        what is left the speed is interpolated.

    Raises
    ------
    InputError, SimulationError
        As :meth:`asperity.single_bodies.SingleBodies.impacts`.
    """
    placed, body = problem.inputs.placement, problem.body
    if placed is None:
        return None
    bodies = SingleBodies(problem, turning_point)
    count = placed.realisations if most is None else min(placed.realisations, most)
    mass = float(body.mass)

    def launched(speed: float) -> SingleImpact:
        kinetic = np.full(count, 0.5 * mass * speed**2)
        launches = Launch(kinetic, np.full(count, np.inf))
        return bodies.impacts(launches, stop, with_pull_off=False)

    rows = []
    for number, speed in enumerate(speeds[::-1].tolist()):  # the table for the fastest serves all
        report(number / speeds.size, f"{count} single bodies, {number} of {speeds.size} speeds")
        found = launched(speed)
        kept = np.asarray(found.restitution)
        rows.append([np.sum(found.captured), *mean_and_error(kept), *quantiles_of(kept)])
    hits, means, errors, *quantiles = np.array(rows[::-1]).T
    low, high = np.array([clopper_pearson(int(hit), count) for hit in hits]).T

    @cache
    def captured(speed: float) -> int:
        return int(np.sum(launched(speed).captured))

    report(1.0, "where half of the single bodies are captured")
    half = [_crossing(captured, speeds, hits, level, halvings) for level in _levels(count)]
    return CaptureProbability(
        bodies=count,
        probability=hits / count,
        low=low,
        high=high,
        mean=means,
        mean_error=errors,
        restitution=np.stack(quantiles, axis=1),
        half_velocity=half[0],
        half_interval=(half[1], half[2]),
    )


def capture_nearby(
    case: Case, result: Result, stop: threading.Event | None = None
) -> tuple[np.ndarray, CaptureProbability] | None:
    """The share of single bodies captured at speeds near a case's own, by few of them.

    Parameters
    ----------
    case
        The case.
    result
        Its result.
    stop
        Set from another thread, it ends them early.

    Returns
    -------
    Speeds [m/s] and what bodies do there; None where the case has no single bodies.

    Raises
    ------
    InputError, SimulationError
        As :func:`capture_probability`.
    """
    speed = result.measures["impact_speed"]
    if result.realisations is None or not speed:
        return None
    problem = build(resolve(case).with_bodies())
    most, halvings = _FEW if isinstance(problem.contact, RigidContact) else _FEWEST
    turning_point = float(result.events["closest_approach_separation"][0])
    speeds = speed * np.geomspace(1.0 / _NEARBY, _NEARBY, _SPEEDS)
    found = capture_probability(
        problem, turning_point, speeds, stop=stop, most=most, halvings=halvings
    )
    return None if found is None else (speeds, found)


def _crossing(
    captured: Callable[[float], int],
    speeds: np.ndarray,
    hits: np.ndarray,
    level: int,
    halvings: int = _HALVINGS,
) -> float | None:
    """The speed [m/s] from which fewer bodies than a number are captured."""
    enough = np.flatnonzero(hits >= level)
    if not enough.size or enough[-1] == speeds.size - 1:
        return None
    (slower, faster), (more, fewer) = (x[enough[-1] :][:2].tolist() for x in (speeds, hits))
    for _ in range(halvings):
        middle = sqrt(slower * faster)
        if (found := captured(middle)) >= level:
            slower, more = middle, found
        else:
            faster, fewer = middle, found
    return float(slower * (faster / slower) ** ((more - level + 0.5) / (more - fewer)))


def _levels(count: int) -> tuple[int, int, int]:
    """Numbers of captured bodies: a half; the least and the most that speak for more and less."""
    more = bisect_left(range(count + 1), True, key=lambda hit: clopper_pearson(hit, count)[0] > 0.5)
    return -(-count // 2), more, count - more + 1
