"""Heights of a given distribution: by skewness and kurtosis, or as they were measured."""

from __future__ import annotations

from math import sqrt
from typing import Any

import numpy as np
from scipy import optimize, special, stats

from ...errors import InputError

_LEAST = 16
"""Measured heights that a distribution takes, at least."""

_NODES = 4001
"""Heights that are computed; those in between are interpolated."""

_CLOSE = 1e-4
"""How closely skewness and kurtosis are met, as a share of kurtosis."""


def standard_heights(shape: tuple[float, float] | np.ndarray, count: int) -> np.ndarray:
    """Sorted heights of a distribution, with mean 0 and standard deviation 1.

    A pair of skewness and kurtosis is met by a beta, a beta-prime or Johnson's SU distribution,
    whichever reaches it: all pairs above kurtosis = skewness^2 + 1 can be had from one of them.
    The heights stand at the middles of ``count`` equal shares of probability, and the pair given
    to the distribution is shifted until these heights have the pair asked for, for few heights
    cut off the tails.

    Parameters
    ----------
    shape
        Skewness and kurtosis (3 for a Gaussian), or an array of measured heights in any unit.
    count
        How many heights.

    Returns
    -------
    Heights [-], ascending, shape (count,).

    Raises
    ------
    InputError
        If the kurtosis is not above skewness^2 + 1 or out of reach of ``count`` heights, or if
        measured heights are fewer than 16, not finite or all the same.
    """
    if isinstance(shape, np.ndarray):
        return _measured(shape, count)
    asked = _checked_pair(shape)
    scores = special.ndtri((np.arange(count) + 0.5) / count)
    tried, heavy = asked, _above_lognormal(*asked.tolist())
    for _ in range(60):
        heights = _of_moments(tried, scores, heavy=heavy)
        error = asked - (stats.skew(heights), stats.kurtosis(heights, fisher=False))
        if abs(error).max() <= _CLOSE * asked[1]:
            return heights
        tried = tried + error
        if tried[1] <= tried[0] ** 2 + 1.0:
            break
    raise InputError(
        f"`heights` must have a kurtosis that {count} pixels can show; got {asked[1]:g} at a "
        f"skewness of {asked[0]:g}; take more pixels or a kurtosis closer to 3",
        key="heights",
    )


def _checked_pair(shape: tuple[float, float]) -> np.ndarray:
    """Skewness and kurtosis that a distribution can have."""
    pair = np.asarray(shape, dtype=float)
    if pair.shape != (2,) or not np.isfinite(pair).all():
        raise InputError(
            f"`heights` must be skewness and kurtosis, or an array of heights; got {shape!r}",
            key="heights",
        )
    if pair[1] <= pair[0] ** 2 + 1.0:
        raise InputError(
            f"`heights` must have a kurtosis above skewness^2 + 1 = {pair[0] ** 2 + 1.0:g}; got "
            f"{pair[1]:g}",
            key="heights",
        )
    return pair


def _measured(heights: np.ndarray, count: int) -> np.ndarray:
    """Heights at equal shares of probability of measured ones."""
    known = np.sort(np.asarray(heights, dtype=float).ravel())
    if known.size < _LEAST or not np.isfinite(known).all() or known[0] == known[-1]:
        raise InputError(
            f"`heights` must hold at least {_LEAST} finite heights that differ; got {known.size} "
            f"heights, {np.isfinite(known).sum()} of them finite",
            key="heights",
        )
    middles = [(np.arange(size) + 0.5) / size for size in (count, known.size)]
    return _standard(np.interp(middles[0], middles[1], known))


def _standard(heights: np.ndarray) -> np.ndarray:
    """Heights scaled to mean 0 and standard deviation 1."""
    return (heights - heights.mean()) / heights.std()


def _of_moments(pair: np.ndarray, scores: np.ndarray, *, heavy: bool) -> np.ndarray:
    """Heights at standard normal scores (ascending, symmetric) of a distribution with a pair."""
    law = _law(abs(float(pair[0])), float(pair[1]), heavy=heavy)
    nodes = np.linspace(scores[0], scores[-1], _NODES)
    low = law.ppf(special.ndtr(nodes[nodes <= 0.0]))
    high = law.isf(special.ndtr(-nodes[nodes > 0.0]))
    heights = np.interp(scores, nodes, np.concatenate([low, high]))
    return _standard(heights if pair[0] >= 0.0 else -heights[::-1])


def _above_lognormal(skewness: float, kurtosis: float) -> bool:
    """Whether a kurtosis is above that of the lognormal distribution with a skewness."""
    spread = _lognormal_spread(kurtosis)
    return (spread - 1.0) * (spread + 2.0) ** 2 > skewness**2


def _law(skewness: float, kurtosis: float, *, heavy: bool) -> Any:
    """A distribution with a skewness of no negative sign and a kurtosis.

    Pearson's types I and VI, Elderton and Johnson, Systems of frequency curves (1969); Johnson's
    SU above the lognormal line. Where tails are cut off both differ: near that line the second
    stands for pairs with ``heavy`` tails alone, so that nothing jumps between pairs.
    """
    square = skewness**2
    distance = 6.0 + 3.0 * square - 2.0 * kurtosis
    if abs(distance) < 1e-6 * kurtosis:
        return stats.pearson3(skewness)
    r = 6.0 * (kurtosis - square - 1.0) / distance
    real = square * (r + 2.0) ** 2 + 16.0 * (r + 1.0)
    above = distance < 0.0 and _above_lognormal(skewness, kurtosis)
    if above and (heavy or real <= 0.0):
        return _johnson(square, kurtosis, _lognormal_spread(kurtosis))
    root = sqrt(square / real)
    less, more = (0.5 * r * (1.0 + sign * (r + 2.0) * root) for sign in (-1.0, 1.0))
    if distance > 0.0:
        return stats.beta(less, more)
    return stats.betaprime(max(less, more), 1.0 - r)


def _lognormal_spread(kurtosis: float) -> float:
    """exp(s^2) of the lognormal distribution with a kurtosis, s being its shape parameter."""
    return float(
        optimize.brentq(
            lambda w: w**4 + 2.0 * w**3 + 3.0 * w**2 - 3.0 - kurtosis, 1e-3, 2.0 + kurtosis
        )
    )


def _johnson(square: float, kurtosis: float, spread: float) -> Any:
    """Johnson's SU distribution by Tuenter (2001), J. Stat. Comput. Simul. 70, 325-347."""

    def twist(w: float) -> float:
        return -2.0 + sqrt(4.0 + 2.0 * (w**2 - (kurtosis + 3.0) / (w**2 + 2.0 * w + 3.0)))

    def excess(w: float) -> float:
        return (w - 1.0 - twist(w)) * (w + 2.0 + 0.5 * twist(w)) ** 2 - square

    symmetric = sqrt(sqrt(2.0 * kurtosis - 2.0) - 1.0)
    # Rounding hides a skewness too small to tell from none.
    even = excess(symmetric) >= 0.0
    w = symmetric if even else optimize.brentq(excess, spread, symmetric, xtol=1e-14)
    ratio = np.sqrt(max((w + 1.0) / (2.0 * w) * ((w - 1.0) / twist(w) - 1.0), 0.0))
    delta = 1.0 / np.sqrt(np.log(w))
    return stats.johnsonsu(-delta * np.arcsinh(ratio), delta)
