"""What the first impacts of many single bodies have in common: shares with intervals, quantiles."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

CONFIDENCE = 0.95
"""Of the intervals that are given."""

QUANTILES = (0.1, 0.5, 0.9)
"""Shares of the bodies below the quantiles that are given."""

KINDS = {
    "restitution": ("1", "coefficient of restitution, 0 where captured or stopped"),
    "contacting": ("1", "summits in contact at the turning point"),
    "loaded": ("1", "effective number of loaded summits there, (sum F)^2 / sum F^2 by Hertz"),
    "maximum_force": ("N", "contact force there"),
    "pull_off": ("N", "largest tension on retraction"),
    "unsolved": ("1", "1 where summits had no equilibrium at some separation, else 0"),
    "closest_approach": ("m", "rigid separation of the turning point"),
    "rebounds": ("1", "rebounds before the impact that captures, infinite where none is found"),
    "flight_time": ("s", "time that these rebounds take in flight, likewise"),
}
"""Unit and meaning of what is known of each body."""


@dataclass(frozen=True, eq=False, repr=False)
class Realisations:
    """First impacts of bodies on summits at random places, one by one.

    Parameters
    ----------
    captured : numpy.ndarray
        Whether each body is captured, shape (bodies,).
    values : dict of str to numpy.ndarray
        What is known of each, by the names of `KINDS`; as long as ``captured``.
    lost : dict of str to numpy.ndarray
        Energy [J] that it has lost once all bonds are broken and its forces end, by mechanism;
        likewise.
    first : dict of str to numpy.ndarray
        The summits within range of the first body at its turning point: "x" and "y", their
        coordinates from its axis, and their "gap" [m].
    warnings : tuple of str
        What to know before the numbers are used.
    """

    captured: np.ndarray
    values: dict[str, np.ndarray]
    lost: dict[str, np.ndarray]
    first: dict[str, np.ndarray]
    warnings: tuple[str, ...] = ()

    @property
    def size(self) -> int:
        """Number of bodies."""
        return int(self.captured.size)

    @property
    def capture_probability(self) -> float:
        """Share of the bodies that are captured at their first impact."""
        return float(np.mean(self.captured))

    @property
    def capture_interval(self) -> tuple[float, float]:
        """Interval of that probability at a confidence of 95 %."""
        return clopper_pearson(int(np.sum(self.captured)), self.size)

    def quantiles(self, name: str) -> list[float]:
        """The `QUANTILES` of one of the ``values`` or, by its mechanism, of an energy ``lost``."""
        return quantiles_of(self.values[name] if name in self.values else self.lost[name])

    def columns(self) -> dict[str, float]:
        """What a study can keep of them, by the names of its measures."""
        low, high = self.capture_interval
        medians = ("restitution", "contacting", "loaded", "pull_off")
        mean, error = mean_and_error(self.values["restitution"])
        return {
            "capture_probability": self.capture_probability,
            "capture_probability_low": low,
            "capture_probability_high": high,
            "mean_restitution": mean,
            "mean_restitution_error": error,
            **{f"median_{name}": self.quantiles(name)[1] for name in medians},
        }

    def plain(self) -> dict[str, Any]:
        """Numbers of all bodies together, in SI."""
        return {
            "realisations": self.size,
            "captured": int(np.sum(self.captured)),
            "capture_probability": self.capture_probability,
            "capture_interval": list(self.capture_interval),
            "shares": list(QUANTILES),
            "quantiles": {name: self.quantiles(name) for name in self.values},
            "mean_restitution": mean_and_error(self.values["restitution"])[0],
            "lost": {name: self.quantiles(name) for name in self.lost},
        }


def quantiles_of(values: np.ndarray) -> list[float]:
    """The `QUANTILES` of values, each one of them: some may be infinite."""
    return [float(x) for x in np.quantile(values, QUANTILES, method="inverted_cdf")]


def mean_and_error(values: np.ndarray) -> tuple[float, float]:
    """The mean of values, and its standard error."""
    return float(np.mean(values)), float(np.std(values)) / values.size**0.5


def clopper_pearson(hits: int, trials: int) -> tuple[float, float]:
    """Interval of a probability after some trials; it holds it at least as often as it says.

    Parameters
    ----------
    hits, trials
        How often it happened, of how many times.

    Notes
    -----
    Clopper and Pearson, Biometrika 26 (1934) 404, by quantiles of the beta distribution.
    """
    from scipy.special import betaincinv

    tail = 0.5 * (1.0 - CONFIDENCE)
    low = betaincinv(hits, trials - hits + 1, tail) if hits else 0.0
    high = betaincinv(hits + 1, trials - hits, 1.0 - tail) if hits < trials else 1.0
    return float(low), float(high)


def restitution_text(restitution: float) -> str:
    """A restitution at as many digits as tell it from 1."""
    return f"{restitution:.{3 if restitution < 0.9995 else 6}g}"


def percent(share: float) -> str:
    """A share in per cent, at as many digits as tell it from none and from all."""
    return f"{100.0 * share:.3g}"
