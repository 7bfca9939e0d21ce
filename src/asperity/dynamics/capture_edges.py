"""Critical velocity: the speeds of approach between which a first impact captures or not."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

_POINTS = 16  # of the scan
_BELOW, _ABOVE = 1e-2, 10.0  # how far beyond the speeds that are given it looks
_STEPS = 60  # of a root, at most
_CLOSE = 1e-11  # relative: two squares of speeds so close are one
_NEARLY = 1e-4  # relative: squares of speeds so close give an edge, should one between them fail
_LEAST = 1e-10  # of the energy: less is no loss
_EDGE = 1e-5  # of the energy of approach: with less left or missing, that alone decides


class FirstImpacts(NamedTuple):
    """First impacts of bodies launched towards the surface, each array one value an impact.

    Attributes
    ----------
    speed
        Speed of approach at the end of contact [m/s]; NaN where it could not be computed.
    captured
        Whether it captures.
    excess
        Kinetic energy [J] that is left at the end of contact; negative where it is missing. With
        drag outside contact the margin of the apex [m]. NaN where that is not known.
    """

    speed: np.ndarray
    captured: np.ndarray
    excess: np.ndarray

    @classmethod
    def of(
        cls,
        speed: np.ndarray,
        captured: np.ndarray,
        excess: np.ndarray,
        mass: np.ndarray | float,
        margin: np.ndarray | None = None,
    ) -> FirstImpacts:
        """The same, with ``mass`` [kg], where capture was told by the force at the apex.

        That force ends at a millionth of the largest. Where hardly any energy is left or missing,
        its sign decides in place of that. With drag outside contact the energy at the end of
        contact is not known beforehand; the ``margin`` of the apex [m] stands for it.
        """
        if margin is not None:
            return cls(speed, captured, np.where((margin < 0.0) == captured, margin, np.nan))
        near = np.abs(excess) < _EDGE * 0.5 * mass * speed**2
        captured = np.where(near, excess < 0.0, captured).astype(bool)
        agrees = (excess < 0.0) == captured  # else something holds it nearer than the end
        return cls(speed, captured, np.where(agrees, excess, np.nan))


Launch = Callable[[np.ndarray, np.ndarray], FirstImpacts]
"""First impacts of some of several cases (their numbers) with some speeds of launch [m/s]."""


class Edges(NamedTuple):
    """Where a case's first impact begins or ceases to capture.

    Attributes
    ----------
    speeds
        Speeds of approach there [m/s], ascending.
    lowest
        Whether the lowest speed that was tried captures.
    tried
        Lowest and highest speed of approach that were tried [m/s]; NaN where none could be.
    unknown
        Number of speeds of the scan at which no first impact could be computed.
    lost
        Number of edges that lie among speeds at which none could be.
    """

    speeds: tuple[float, ...]
    lowest: bool
    tried: tuple[float, float]
    unknown: int
    lost: int

    @property
    def critical(self) -> float | None:
        """Critical velocity [m/s]: the lowest edge; None without one, or where one is lost."""
        return self.speeds[0] if self.speeds and not self.lost else None


def speeds_about(
    energy: np.ndarray, lost: np.ndarray, mass: np.ndarray | float
) -> tuple[np.ndarray, np.ndarray]:
    """The lower and the upper of two speeds [m/s]: of one impact, and of the energy that it loses.

    Parameters
    ----------
    energy
        Kinetic energy of the impact [J].
    lost
        What it loses [J], or would lose if it left; the critical velocity where every impact
        loses as much. Where it is next to nothing the first speed is both.
    mass
        Mass [kg].
    """
    lost = np.where(lost > _LEAST * energy, lost, energy)
    both = np.sqrt(2.0 / mass * np.stack([energy, lost]))
    return np.min(both, axis=0), np.max(both, axis=0)


def capture_edges(launch: Launch, low: np.ndarray, high: np.ndarray) -> list[Edges]:
    """The edges of capture of several cases at once.

    Parameters
    ----------
    launch
        Computes first impacts.
    low, high
        Speeds of launch for each case about which to look [m/s], shape (cases,).

    Notes
    -----
    A scan of sixteen speeds from a hundredth of the one to ten times the other, then a root
    between each two neighbours of which one captures: of the energy that is left, as a function
    of that of approach, by the Illinois method; by halving where that energy is not known. Edges
    closer than the scan that come in pairs are missed.
    """
    count = np.size(low)
    cases = np.repeat(np.arange(count), _POINTS)
    launched = np.geomspace(_BELOW * low, _ABOVE * high, _POINTS, axis=-1).ravel()
    scanned = launch(cases, launched)
    found: list[list[float]] = [[] for _ in range(count)]
    bracket = [_changes(scanned, cases == case) for case in range(count)]
    pairs = np.concatenate(bracket) if bracket else np.zeros((0, 2), int)
    if pairs.size:
        low = pairs[:, 0]
        speeds = _roots(launch, cases[low], launched[pairs.T], _part(scanned, pairs.T))
        for case, speed in zip(cases[low].tolist(), speeds.tolist(), strict=True):
            found[case].append(speed)
    return [_edges(scanned, cases == case, found[case]) for case in range(count)]


def _edges(scanned: FirstImpacts, of_case: np.ndarray, speeds: list[float]) -> Edges:
    known = np.flatnonzero(of_case & np.isfinite(scanned.speed))
    unknown = int(np.count_nonzero(of_case)) - known.size
    if not known.size:
        return Edges((), False, (np.nan, np.nan), unknown, 0)
    tried = float(scanned.speed[known[0]]), float(scanned.speed[known[-1]])
    sure = tuple(sorted(speed for speed in speeds if np.isfinite(speed)))
    captured = bool(scanned.captured[known[0]])
    return Edges(sure, captured, tried, unknown, len(speeds) - len(sure))


def _changes(scanned: FirstImpacts, of_case: np.ndarray) -> np.ndarray:
    """Neighbours of a scan of which one captures, shape (pairs, 2)."""
    known = np.flatnonzero(of_case & np.isfinite(scanned.speed))
    differ = np.flatnonzero(np.diff(scanned.captured[known].astype(int)))
    return np.stack([known[differ], known[differ + 1]], axis=1)


def _part(impacts: FirstImpacts, index: np.ndarray) -> FirstImpacts:
    return FirstImpacts(*(column[index] for column in impacts))


def _roots(
    launch: Launch, cases: np.ndarray, launched: np.ndarray, ends: FirstImpacts
) -> np.ndarray:
    """Speeds of approach [m/s] at which capture changes between two launches, shape (2, pairs).

    NaN where a first impact could not be computed before they were close.
    """
    x, value = launched**2, ends.excess.copy()
    below = ends.captured[0]
    speed, before = ends.speed[0].copy(), np.zeros(cases.size)
    last, going = np.full(cases.size, -1), np.ones(cases.size, bool)
    for _ in range(_STEPS):
        some = np.flatnonzero(going)
        if not some.size:
            break
        at = _between(x[:, some], value[:, some])
        tried = launch(cases[some], np.sqrt(at))
        known = np.isfinite(tried.speed)
        close = x[1, some] - x[0, some] < _NEARLY * at
        speed[some] = np.where(known, tried.speed, np.where(close, speed[some], np.nan))
        side = np.where(tried.captured == below[some], 0, 1)
        value[1 - side, some] *= np.where(side == last[some], 0.5, 1.0)
        x[side, some], value[side, some], last[some] = at, tried.excess, side
        moved = np.abs(at - before[some])
        before[some] = at
        going[some] = known & (moved > _CLOSE * at) & (x[1, some] - x[0, some] > _CLOSE * at)
    return speed


def _between(x: np.ndarray, value: np.ndarray) -> np.ndarray:
    """Where a line through two values is 0, or the middle of the logarithms."""
    with np.errstate(invalid="ignore", divide="ignore"):
        line = (x[0] * value[1] - x[1] * value[0]) / (value[1] - value[0])
        inside = (value[0] * value[1] < 0.0) & (line > x[0]) & (line < x[1])
    return np.where(inside, line, np.sqrt(x[0] * x[1]))
