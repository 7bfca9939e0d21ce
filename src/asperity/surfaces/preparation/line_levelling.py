"""Levelling of scan lines: offsets between lines that the instrument made."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
from numpy.polynomial import legendre

from ..topography import Topography
from .step import Step

ALIGNMENTS = ("none", "median", "median-difference", "polynomial")
"""How the offset of a line is found, if at all."""

DIRECTIONS = ("rows", "columns")
"""What a scan line is: a row (fast axis x) or a column (fast axis y)."""


def lines_aligned(
    topography: Topography, how: str = "median", direction: str = "rows", degree: int = 1
) -> tuple[Topography, Step]:
    """A surface without the offsets that an instrument gave its scan lines.

    No method tells an instrument's offset from true roughness that is the same along a whole
    line. A wave whose crests lie along the lines is removed wholly, and so is a tilt across
    them. Of roughness with correlation function rho(x) along lines of length W, ``median``
    removes the true medians of the lines, whose rms is

        rms_height sqrt(int asin(rho) dx / W)

    for Gaussian heights and W much longer than the correlation: 1.46 rms_height sqrt(l/W) for
    rho = exp(-(x/l)^2), so a sixth of the rms height at W = 75 l. ``median-difference`` adds up
    the errors of the steps from line to line, ``polynomial`` removes more with every degree.

    Parameters
    ----------
    topography
        The surface.
    how
        ``median``: each line loses its median. ``median-difference``: each line is shifted so
        that the median of its differences to the line before vanishes; blind to features that
        fill less than half of a line. ``polynomial``: each line loses its least-squares
        polynomial.
    direction
        ``rows`` or ``columns``: what a scan line is.
    degree
        Degree of the polynomial, 0 to 5; 0 is the mean.

    Returns
    -------
    The surface, whose mean removed offset is zero, and the step. Missing pixels stay missing.

    Raises
    ------
    InputError
        If a line has too few pixels for its polynomial, or if neighbouring lines share no pixel.
    """
    lines = topography.heights if direction == "rows" else topography.heights.T
    if how == "polynomial":
        removed = _polynomials(topography, lines, degree)
        name = f"polynomial of degree {degree}"
    elif how == "median":
        removed, name = _medians(lines)[:, None], "median"
    else:
        removed, name = _summed_differences(topography, lines)[:, None], "median difference"
    removed = removed - np.nanmean(removed)
    aligned = lines - removed
    made = topography.with_heights(aligned if direction == "rows" else aligned.T)
    there = np.isfinite(removed[:, 0])
    moved = float(removed[there].mean(axis=1).std())
    return made, Step(
        "lines",
        f"{direction} levelled by their {name}",
        topography.rms_height,
        made.rms_height,
        {"rms_offset": moved},
    )


def _medians(lines: np.ndarray) -> np.ndarray:
    """Median height [m] of every line; NaN where all of it is missing."""
    medians = np.full(len(lines), np.nan)
    some = np.isfinite(lines).any(axis=1)
    medians[some] = np.nanmedian(lines[some], axis=1)
    return medians


def _summed_differences(topography: Topography, lines: np.ndarray) -> np.ndarray:
    """Offset [m] of every line, the sum of median differences from its predecessors."""
    offsets = np.full(len(lines), np.nan)
    present = np.flatnonzero(np.isfinite(lines).any(axis=1))
    offsets[present[0]] = 0.0
    for before, line in pairwise(present):
        steps = lines[line] - lines[before]
        steps = steps[np.isfinite(steps)]
        if steps.size == 0:
            raise topography._error(
                f"lines {before} and {line} share no pixel, so their offset is unknown; got a map "
                "with missing pixels; fill them first or use 'median'"
            )
        offsets[line] = offsets[before] + np.median(steps)
    return offsets


def _polynomials(topography: Topography, lines: np.ndarray, degree: int) -> np.ndarray:
    """Least-squares polynomial [m] of every line, shape of ``lines``; NaN on missing lines."""
    basis = legendre.legvander(np.linspace(-1.0, 1.0, lines.shape[1]), degree)
    fitted = np.full(lines.shape, np.nan)
    finite = np.isfinite(lines)
    whole = finite.all(axis=1)
    fitted[whole] = lines[whole] @ np.linalg.pinv(basis).T @ basis.T
    for line in np.flatnonzero(finite.any(axis=1) & ~whole):
        seen = finite[line]
        weights, _, rank, _ = np.linalg.lstsq(basis[seen], lines[line, seen])
        if rank <= degree:
            raise topography._error(
                f"a line needs {degree + 1} pixels for a polynomial of degree {degree}; line "
                f"{line} has {seen.sum()}; lower the degree or use 'median'"
            )
        fitted[line] = basis @ weights
    return fitted
