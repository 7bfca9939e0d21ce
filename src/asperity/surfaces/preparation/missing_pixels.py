"""Missing pixels of a surface: kept or filled."""

from __future__ import annotations

import numpy as np
from scipy import sparse
from scipy.sparse import linalg

from ..topography import Topography
from .step import Step

MISSING = ("refuse", "keep", "fill")
"""What can be done about missing pixels."""


def filled(topography: Topography, how: str) -> tuple[Topography, Step]:
    """A surface whose missing pixels are kept or filled.

    Filling solves Laplace's equation in the missing pixels, with the heights around them as the
    boundary and no slope across the edge of the map. A plane is restored exactly away from the
    edge. Filled heights lie between those around them, so that a hole gains no summit, but
    curvature is lost: a round hole of radius a in a paraboloid of radius R is wrong by up to
    a^2/(2 R). Roughness is not invented: the rms height falls with the share filled. The
    system is factorised; one hole of 1000 x 1000 pixels takes some 10 s and 1.5 GB, as many
    pixels in small holes less than a second.

    Parameters
    ----------
    topography
        The surface, of which pixels are missing.
    how
        ``keep``: missing pixels stay NaN; ``fill``: they take the harmonic interpolation of their
        surroundings.

    Returns
    -------
    The surface, and the step with the number of missing pixels.
    """
    count, total = topography.missing_pixels, topography.heights.size
    before = topography.rms_height
    shares = f"{count} of {total} missing pixels ({100.0 * count / total:.2g} %)"
    if how == "keep":
        return topography, Step("missing", f"{shares} kept", before, before, {"pixels": count})
    whole = topography.with_heights(_harmonic(topography))
    after = whole.rms_height
    return whole, Step("missing", f"{shares} filled", before, after, {"pixels": count})


def _harmonic(topography: Topography) -> np.ndarray:
    """Heights [m] with the missing ones from Laplace's equation in five-point differences."""
    matrix, known = _laplace(topography.heights, topography.pixel_size)
    # Symmetric and diagonally dominant: no pivots, and the ordering keeps the fill-in small.
    factors = linalg.splu(
        matrix,
        permc_spec="MMD_AT_PLUS_A",
        diag_pivot_thresh=0.0,
        options={"SymmetricMode": True},
    )
    heights = topography.heights.copy()
    heights[topography.missing] = factors.solve(known)
    return heights


def _laplace(
    heights: np.ndarray, pixel_size: tuple[float, float]
) -> tuple[sparse.csc_array, np.ndarray]:
    """Matrix of the missing pixels, in row order, and what known neighbours add [m]."""
    missing = np.isnan(heights)
    rows, columns = np.nonzero(missing)
    count = rows.size
    number = np.full(heights.shape, -1)
    number[missing] = np.arange(count)
    ratio = (pixel_size[0] / pixel_size[1]) ** 2
    diagonal, known, entries = np.zeros(count), np.zeros(count), []
    for down, right, weight in ((0, 1, 1.0), (0, -1, 1.0), (1, 0, ratio), (-1, 0, ratio)):
        row, column = rows + down, columns + right
        inside = (row >= 0) & (row < heights.shape[0]) & (column >= 0) & (column < heights.shape[1])
        here = np.flatnonzero(inside)
        diagonal[here] += weight
        place = (row[here], column[here])
        open_ = number[place] >= 0
        known[here[~open_]] += weight * heights[place][~open_]
        entries.append((np.full(open_.sum(), -weight), here[open_], number[place][open_]))
    every = np.arange(count)
    values, first, second = (
        np.concatenate(parts) for parts in zip(*entries, (diagonal, every, every), strict=True)
    )
    return sparse.csc_array((values, (first, second)), shape=(count, count)), known
