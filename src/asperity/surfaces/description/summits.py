"""Summits of a measured surface: pixels above their eight neighbours."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy import ndimage

from ...errors import InputError
from ..topography import Topography

LEAST_SUMMITS = 10
"""Summits, at least, of which a distribution can be made: their rms is then known to a quarter."""

_NEIGHBOURS = [(i, j) for i in (-1, 0, 1) for j in (-1, 0, 1) if (i, j) != (0, 0)]


@dataclass(frozen=True, eq=False)
class Summits:
    """Summits of a map: pixels strictly above their eight neighbours, all nine measured.

    The pixel decides what is a summit and how round it is. On a Gaussian surface whose
    correlation is Gaussian, with theta = pixel sqrt(m4/m2), the count is low by theta^2/8 and the
    radius high by theta^2/6: both are within 2 % for theta below 0.35. White noise has
    theta = 1.7 at any pixel: its summits are the instrument's.

    Attributes
    ----------
    heights
        Heights [m] above the mean of the map, shape (count,).
    radii
        Radii of curvature [m], shape (count,): 1/curvature, the mean of the second
        differences along the row and along the column, with its sign turned.
    positions
        Row and column of each, shape (count, 2).
    area
        Area [m^2] of the map without its outermost pixels: what the density counts over.
    searched
        Share of that area where all nine pixels were measured.
    plateaus
        Flat tops of two pixels or more, all their neighbours lower. No pixel of them is strictly
        above its neighbours, so they are not among the summits.
    pixel_size
        Distance (dx, dy) [m] of the map's pixels.
    source
        Name of the map's file, for messages.
    """

    heights: np.ndarray
    radii: np.ndarray
    positions: np.ndarray
    area: float
    searched: float
    plateaus: int
    pixel_size: tuple[float, float]
    source: str = ""

    @property
    def count(self) -> int:
        """How many there are."""
        return int(self.heights.size)

    @property
    def density(self) -> float:
        """Summits per area [1/m^2], missing pixels counted as area without summits."""
        return self.count / self.area

    @property
    def curvatures(self) -> np.ndarray:
        """Curvatures [1/m], shape (count,), positive."""
        return np.asarray(1.0 / self.radii)

    @property
    def radius(self) -> float:
        """Radius [m] of the mean curvature; NaN without summits."""
        return float(1.0 / np.mean(self.curvatures)) if self.count else float("nan")

    @property
    def mean_radius(self) -> float:
        """Mean radius [m], above `radius` because flat summits weigh more; NaN without summits."""
        return float(np.mean(self.radii)) if self.count else float("nan")

    @property
    def median_radius(self) -> float:
        """Median radius [m]; NaN without summits."""
        return float(np.median(self.radii)) if self.count else float("nan")

    @property
    def mean_height(self) -> float:
        """Mean height [m] above the mean of the map; NaN without summits."""
        return float(np.mean(self.heights)) if self.count else float("nan")

    @property
    def rms_height(self) -> float:
        """Standard deviation [m] of the heights; NaN without summits."""
        return float(np.std(self.heights)) if self.count else float("nan")

    def at_least(self, count: int = LEAST_SUMMITS) -> Summits:
        """The summits themselves, refused where they are too few for a distribution.

        Raises
        ------
        InputError
            If there are fewer than ``count``.
        """
        if self.count < count:
            raise InputError(
                f"{self.source or 'surface'}: the statistics of summits need at least {count}; got "
                f"{self.count}; measure a larger area or filter less",
                file=self.source or None,
            )
        return self


def find_summits(topography: Topography) -> Summits:
    """Summits of a map by their eight neighbours.

    Nothing is levelled or filtered, and no map is taken as periodic. A pixel on the edge, or
    beside a missing one, is no summit.
    """
    heights = topography.heights
    strict, weak = _maxima(heights)
    weak &= ~strict
    rows, columns = np.nonzero(strict)
    width, length = topography.pixel_size
    inner = (heights.shape[0] - 2) * (heights.shape[1] - 2)
    return Summits(
        heights=heights[rows, columns] - float(np.nanmean(heights)),
        radii=1.0 / _curvature(heights, rows, columns, topography.pixel_size),
        positions=np.stack((rows, columns), axis=1),
        area=inner * width * length,
        searched=float(np.count_nonzero(_measured_around(heights))) / inner,
        plateaus=_plateaus(heights, weak),
        pixel_size=topography.pixel_size,
        source=topography.source,
    )


def _measured_around(heights: np.ndarray) -> np.ndarray:
    """Where all nine pixels of a block are measured: shape (rows - 2, columns - 2)."""
    found: np.ndarray = ndimage.binary_erosion(np.isfinite(heights), np.ones((3, 3)))[1:-1, 1:-1]
    return found


def _maxima(heights: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Pixels above all neighbours, and those below none; the edge and missing pixels are neither.

    A comparison with a missing pixel is false, which leaves out its neighbours.
    """
    rows, columns = heights.shape
    inside = heights[1:-1, 1:-1]
    strict, weak = np.zeros((2, rows, columns), dtype=bool)
    strict[1:-1, 1:-1] = weak[1:-1, 1:-1] = True
    for i, j in _NEIGHBOURS:
        beside = heights[1 + i : rows - 1 + i, 1 + j : columns - 1 + j]
        strict[1:-1, 1:-1] &= inside > beside
        weak[1:-1, 1:-1] &= inside >= beside
    return strict, weak


def _curvature(
    heights: np.ndarray, rows: np.ndarray, columns: np.ndarray, pixel_size: tuple[float, float]
) -> np.ndarray:
    """Curvature [1/m] of summits by second differences, positive."""
    top = heights[rows, columns]
    along = (top - heights[rows, columns - 1]) + (top - heights[rows, columns + 1])
    across = (top - heights[rows - 1, columns]) + (top - heights[rows + 1, columns])
    return np.asarray(0.5 * (along / pixel_size[0] ** 2 + across / pixel_size[1] ** 2))


def _plateaus(heights: np.ndarray, weak: np.ndarray) -> int:
    """Number of flat tops: joined pixels of ``weak`` with no pixel as high beside them.

    A joined pixel as high that is not in ``weak`` has a higher neighbour: the flat part is a
    terrace, no top. Pixels of ``weak`` that touch are equally high.
    """
    if not weak.any():
        return 0
    groups, count = ndimage.label(weak, np.ones((3, 3)))
    rows, columns = np.nonzero(weak)
    top = np.ones(count + 1, dtype=bool)
    top[0] = False
    for i, j in _NEIGHBOURS:
        level = heights[rows + i, columns + j] == heights[rows, columns]
        terrace = level & ~weak[rows + i, columns + j]
        top[groups[rows[terrace], columns[terrace]]] = False
    return int(np.count_nonzero(top))
