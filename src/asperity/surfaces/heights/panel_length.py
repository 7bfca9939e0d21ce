"""How finely the curves of a distribution of heights are cut, by trial where it was measured."""

from __future__ import annotations

from collections.abc import Callable
from math import ceil
from typing import NamedTuple

import numpy as np
from numpy.polynomial import chebyshev
from scipy.interpolate import BSpline

from ...numerics.polynomials import from_points

PANEL_NODES = 16
"""Nodes of a panel of a curve."""

SCANNING_NODES = (6, 8, 12, 16)
"""Nodes of a piece of the way from a reversal to the major branch, one of these."""

MEASURED_FLOOR = 1e-3
"""Relative error of curves of measured heights below which nothing is gained."""

_PANEL = 2.2  # rms heights
_SCANNING = (0.1, 0.5, 2.0, 4.5)
_SCANNING_OF_MEASURED = (0.05, 0.1, 2.0, 4.5)  # many may be as high as the highest
_CLOSE = 4e-6  # of the trial at the mean height: its error, on panels
_CLOSE_ON_SCANNING = 2e-5  # a scanning curve is a small part of a motion
_TRIED = 0.85 ** np.arange(24.0)
_BEGINS = 3  # places in a piece where others begin
_LEAST = 0.1  # nodes; a single height has no rms height


class PanelLengths(NamedTuple):
    """Longest pieces on which polynomials read the curves of heights, in rms heights.

    Attributes
    ----------
    panel
        Of a panel.
    scanning
        Of a piece of a scanning curve, for each of :data:`SCANNING_NODES`.
    error_floor
        Relative error of the curves below which nothing is gained: of what is known of the heights.
    """

    panel: float = _PANEL
    scanning: tuple[float, ...] = _SCANNING
    error_floor: float = 0.0

    @property
    def grain(self) -> float:
        """Length of a panel, over that for Gaussian heights."""
        return self.panel / _PANEL

    def along(self, share: float) -> tuple[int, int]:
        """Nodes of a piece, and pieces, on a way of so many rms heights: the fewest in all."""
        each = zip(SCANNING_NODES, self.scanning, strict=True)
        choices = [(nodes, max(ceil(share / longest), 1)) for nodes, longest in each]
        return min(choices, key=lambda choice: (choice[0] * choice[1], choice[1]))

    def and_of(self, other: PanelLengths) -> PanelLengths:
        """What both ask for."""
        scanning = zip(self.scanning, other.scanning, strict=True)
        return PanelLengths(
            min(self.panel, other.panel),
            tuple(min(pair) for pair in scanning),
            max(self.error_floor, other.error_floor),
        )


def fineness_of(share: np.ndarray, rms: float) -> PanelLengths:
    """What a measured density needs, by trial.

    Parameters
    ----------
    share
        Share of the heights at each of even nodes, of cubic B-splines one node apart.
    rms
        Their rms height, in nodes.

    Notes
    -----
    Tried on the load of a rigid paraboloid whose asperities push with one force each, the least
    smooth part of any curve: it is read at Chebyshev's points of pieces from end to end. Pieces are
    never longer than for Gaussian heights; where none is short enough they are the shortest tried,
    a fortieth of those, and the ledger of a run shows what that leaves.
    """
    load = _load(share)
    within = -3.0, share.size + 2.0
    mean = share @ np.arange(share.size) / np.sum(share)
    unit = max(rms, _LEAST)
    scale = float(load(np.array([mean]))[0])

    def longest(nodes: int, most: float, close: float) -> float:
        for length in most * _TRIED:
            if _error(load, within, length * unit, nodes) <= close * scale:
                break
        return float(length)

    scanning = zip(SCANNING_NODES, _SCANNING_OF_MEASURED, strict=True)
    return PanelLengths(
        longest(PANEL_NODES, _PANEL, _CLOSE),
        tuple(longest(nodes, most, _CLOSE_ON_SCANNING) for nodes, most in scanning),
        MEASURED_FLOOR,
    )


def _error(
    load: Callable[[np.ndarray], np.ndarray],
    within: tuple[float, float],
    length: float,
    nodes: int,
) -> float:
    """Largest error of polynomials at so many nodes of pieces of a length, wherever they begin."""
    low, high = within
    begins = low + length * np.arange(-1.0, ceil((high - low) / length), 1.0 / _BEGINS)
    middle, half = begins[:, None] + 0.5 * length, 0.5 * length
    points, looks = chebyshev.chebpts1(nodes), np.linspace(-1.0, 1.0, 4 * nodes + 1)
    read = chebyshev.chebvander(looks, nodes - 1) @ from_points(nodes)
    found = load(middle + half * points) @ read.T
    return float(np.max(np.abs(found - load(middle + half * looks))))


def _load(share: np.ndarray) -> Callable[[np.ndarray], np.ndarray]:
    """Second integral of the density, from above all heights down to places in nodes."""
    # Mirrored, so that both integrals begin where the density does.
    mirrored = np.concatenate([np.zeros(4), share[::-1], np.zeros(4)])
    knots = np.arange(mirrored.size + 4.0) - (share.size + 5.0)
    twice = BSpline(knots, mirrored, 3).antiderivative(2)
    return lambda place: np.asarray(twice(-place))
