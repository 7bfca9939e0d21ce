"""Points in any order -> heights on a regular grid."""

from __future__ import annotations

import numpy as np

from .content import MOST_PIXELS, refusal

_JITTER = 0.05
"""How far a point may lie from its place on the grid, in pixels: coordinates are rounded."""

_FILLED = 0.25
"""Least part of the grid that must have a point; scattered points fill far less."""

_ADVICE = "interpolate the points to a regular grid"


def gridded(points: np.ndarray, file: str) -> tuple[np.ndarray, tuple[float, float]]:
    """Heights on the grid of their points.

    Parameters
    ----------
    points
        Columns x, y, z in any unit, shape (points, 3).
    file
        Name of the file, for messages.

    Returns
    -------
    Heights, shape (rows, columns), row 0 at the least y and column 0 at the least x, NaN where
    no point is; and the spacings (along x, along y) in the unit of x and y.

    Raises
    ------
    InputError
        Where the points are on no regular grid, two share a place, or the last scan line ends
        early as in a file cut short.
    """
    column, width = steps_of(points[:, 0], "x", file)
    row, length = steps_of(points[:, 1], "y", file)
    columns, rows = int(column.max()) + 1, int(row.max()) + 1
    if rows * columns > MOST_PIXELS or len(points) < _FILLED * rows * columns:
        raise refusal(
            file,
            f"must fill a regular grid; got {len(points)} points for {columns} x {rows} places; "
            f"{_ADVICE}",
        )
    place = row * columns + column
    if np.bincount(place, minlength=1).max() > 1:
        raise refusal(file, "must have one height a place; got two points at one; delete one")
    _refuse_broken_scan(column, row, file)
    heights = np.full(rows * columns, np.nan)
    heights[place] = points[:, 2]
    return heights.reshape(rows, columns), (width, length)


def steps_of(coordinate: np.ndarray, axis: str, file: str) -> tuple[np.ndarray, float]:
    """Number of the step on which each coordinate stands, from the least, and the step.

    Parameters
    ----------
    coordinate
        Coordinates in any order, repeated or not.
    axis
        Its name, for messages.
    file
        Name of the file, for messages.

    Raises
    ------
    InputError
        Where the coordinates do not stand on even steps, or there is one alone.
    """
    if not np.isfinite(coordinate).all():
        raise refusal(file, f"every {axis} must be finite; got nan or inf; drop those points")
    values = np.unique(coordinate)
    with np.errstate(over="ignore", invalid="ignore"):
        gaps = np.diff(values)
        wide = gaps > 0.1 * np.median(gaps[gaps > 1e-3 * gaps.max()]) if gaps.size else gaps > 0
        if not wide.any() or not np.isfinite(gaps).all():
            raise refusal(
                file, f"must have points at several {axis}; got {len(values)}; check the columns"
            )
        # Summed from gap to gap: rounding of the coordinates does not add up along the row.
        counts = np.round(gaps / np.median(gaps[wide])) * wide
        if counts.sum() > MOST_PIXELS:
            raise refusal(file, f"{axis} must stand on even steps; got a wide gap; {_ADVICE}")
        steps = np.concatenate([[0.0], np.cumsum(counts)]).astype(np.int64)
        step = float((values[-1] - values[0]) / steps[-1])
        off = float(np.abs(values - values[0] - step * steps).max()) / step
    if not off < _JITTER:
        raise refusal(
            file, f"{axis} must stand on even steps; got one off by {off:.2g} of a step; {_ADVICE}"
        )
    return steps[np.searchsorted(values, coordinate)], step


def _refuse_broken_scan(column: np.ndarray, row: np.ndarray, file: str) -> None:
    """Refuse points written scan line by scan line of which the last line ends early."""
    for fast, slow in ((column, row), (row, column)):
        along, across = (axis if axis[0] == 0 else axis.max() - axis for axis in (fast, slow))
        length = int(along.max()) + 1
        whole = len(fast) % length == 0
        if not whole and np.array_equal(across * length + along, np.arange(len(fast))):
            raise refusal(
                file,
                "the last scan line must be whole; got one that ends early, as in a file cut "
                "short; copy the file again, or write the missing heights as nan",
            )
