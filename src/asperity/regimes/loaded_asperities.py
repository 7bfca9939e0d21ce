"""How many asperities carry the load at closest approach, effectively: enough for a mean or not."""

from __future__ import annotations

from math import pi

import numpy as np

from ..inputs import Asperities

LOADED_FOR_A_MEAN = 3.0
"""Asperities that carry the load, effectively, from which their mean may stand for single bodies.

See docs/single_bodies.md, "When the mean is enough".
"""

_POSITIONS = 16  # of a body on a map, along each side
_HIGHEST = 9.0  # rms heights above the mean: the highest asperities
_POINTS = 4001


def loaded_asperities(
    rough: Asperities, contacting: float, central: float, *, measured: bool
) -> float:
    r"""Effective number of loaded asperities in a mean [-].

    It is :math:`\langle\sum F\rangle^2/\langle\sum F^2\rangle`, by Hertz's loads at offsets that
    are a Poisson process under a paraboloid: Campbell's theorem (Kingman, Poisson Processes, 1993,
    section 3.2). With :math:`I_p = \int (z - d)^p \phi(z)\,\mathrm{d}z` over the heights above the
    plane it is :math:`\tfrac{16}{25} I_{5/2}^2 / (I_1 I_4)` of those that touch: 0.3 where only the
    highest do, 0.64 where all do. Under a half-space that has become flat it would be up to all.

    Parameters
    ----------
    rough
        The asperities.
    contacting
        Expected number that touch.
    central
        Separation d of the deformed mean planes at the axis [m].
    measured
        Whether heights and radii are those of the measured summits, or Gaussian with one radius.
    """
    sizes: np.ndarray | float
    if measured and rough.summits is not None:
        overlaps = np.maximum(rough.summits.heights - central, 0.0)
        sizes, weights = rough.summits.radii, np.full(overlaps.shape, 1.0 / overlaps.size)
    else:
        rms, mean = rough.rms_height, rough.mean_height
        lowest = max((central - mean) / rms, -_HIGHEST)
        heights, step = np.linspace(min(lowest, _HIGHEST), _HIGHEST, _POINTS, retstep=True)
        overlaps = np.maximum(mean + rms * heights - central, 0.0)
        sizes, weights = 1.0, step * np.exp(-0.5 * heights**2) / np.sqrt(2.0 * pi)
    first, load, squares = (
        float(np.sum(weights * overlaps**power * sizes**size))
        for power, size in ((1.0, 0.0), (2.5, 0.5), (4.0, 1.0))
    )
    if not first * squares > 0.0:
        return 0.0
    return max(contacting, 0.0) * 0.64 * load**2 / (first * squares)


def clustering(rough: Asperities, radius: float, separation: float) -> float:
    r"""Share of a number of loaded asperities that is independent on a map [-].

    Of independent summits the sum of loads has the variance :math:`\langle\sum F^2\rangle`
    (Campbell's theorem). It is compared with the variance over positions on the map, by Hertz's
    loads on a rigid bulk; at most 1, and 1 where the map is too small for any position.

    Parameters
    ----------
    rough
        The asperities.
    radius
        Radius of the body [m].
    separation
        Its closest approach [m].
    """
    if rough.summits is None or rough.surface is None:
        return 1.0
    some, (width, length) = rough.summits, rough.surface.physical_size
    high = some.heights > separation
    heights, radii = some.heights[high] - separation, some.radii[high]
    y, x = (some.positions[high] * some.pixel_size[::-1]).T  # in the order of their rows
    far = float(np.sqrt(2.0 * radius * np.max(heights, initial=0.0)))
    if not 0.0 < 2.0 * far < min(width, length):
        return 1.0
    sums, squares = [], []
    for at_y in np.linspace(far, length - far, _POSITIONS):
        near = slice(*np.searchsorted(y, (at_y - far, at_y + far)))
        for at_x in np.linspace(far, width - far, _POSITIONS):
            apart = (x[near] - at_x) ** 2 + (y[near] - at_y) ** 2
            overlaps = np.maximum(heights[near] - apart / (2.0 * radius), 0.0)
            sums.append(np.sum(radii[near] ** 0.5 * overlaps**1.5))
            squares.append(np.sum(radii[near] * overlaps**3))
    variance = float(np.var(sums))
    return min(1.0, float(np.mean(squares)) / variance) if variance > 0.0 else 1.0
