"""Effect of the pixel size: the same map at every second, fourth, eighth pixel."""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence
from dataclasses import dataclass
from math import sqrt

from ..topography import Topography
from .spectrum import Moments, moments
from .summits import Summits, find_summits

RESOLVED = 0.02
"""Relative error up to which summits count as resolved by the pixel."""

_SMALLEST = 16
"""Pixels a side, at least, of a thinned map: below, the edge is a tenth of it and more."""


@dataclass(frozen=True)
class PixelEffect:
    """What a map says when only every so-many-th pixel of it is used.

    Attributes
    ----------
    every
        Which pixels are used: 1 for all, 2 for every second along x and y.
    pixel_size
        Distance (dx, dy) [m] of those pixels.
    count
        Summits found.
    density
        Summits per area [1/m^2].
    radius
        Radius of the mean summit curvature [m]; NaN without summits.
    rms_slope
        Root mean square slope [-] of profiles, the mean of both directions.
    bandwidth
        m0 m4/m2^2 [-]; NaN for a flat map.
    """

    every: int
    pixel_size: tuple[float, float]
    count: int
    density: float
    radius: float
    rms_slope: float
    bandwidth: float


def pixel_effect(
    topography: Topography, summits: Summits | None = None, spectral: Moments | None = None
) -> tuple[PixelEffect, ...]:
    """Summits and slopes of a map at its own pixel, at every second, fourth, eighth pixel.

    Pixels are left out, not averaged: it is what a measurement with a larger step would have
    given. A quantity that changes from row to row is one of the step and not of the surface.

    Parameters
    ----------
    topography
        The map.
    summits, spectral
        Its summits and moments, where they are known already.

    Returns
    -------
    One record a step, the map's own first, as long as 16 pixels a side remain.
    """
    own = _effect(1, summits or find_summits(topography), spectral or moments(topography))
    found = [own]
    every = 2
    while min(topography.heights.shape) // every >= _SMALLEST:
        part = topography.heights[::every, ::every]
        width, length = topography.pixel_size
        thinned = dataclasses.replace(
            topography, heights=part, pixel_size=(every * width, every * length)
        )
        found.append(_effect(every, find_summits(thinned), moments(thinned)))
        every *= 2
    return tuple(found)


def discretisation_error(effects: Sequence[PixelEffect]) -> tuple[float, float] | None:
    """Relative errors of density and radius that the map's own pixel makes, an estimate [-].

    A third of the relative change from every second pixel to all: exact in the limit where
    the error grows with the pixel squared. Positive = the figure is too large. Where the summits
    are not resolved at all the true error is larger.

    Returns
    -------
    The two errors; None where the map is too small to be thinned, or has no summits.
    """
    if len(effects) < 2 or effects[0].count == 0 or effects[1].count == 0:
        return None
    own, double = effects[:2]
    return (
        (double.density / own.density - 1.0) / 3.0,
        (double.radius / own.radius - 1.0) / 3.0,
    )


def _effect(every: int, summits: Summits, spectral: Moments) -> PixelEffect:
    """The record of one step."""
    return PixelEffect(
        every=every,
        pixel_size=summits.pixel_size,
        count=summits.count,
        density=summits.density,
        radius=summits.radius,
        rms_slope=sqrt(spectral.m2),
        bandwidth=spectral.bandwidth,
    )
