"""Two maps added, on the area that they share."""

from __future__ import annotations

import numpy as np
from scipy import ndimage

from ..map import Topography


def added(first: Topography, second: Topography) -> Topography:
    """Sum of two maps on the area that they share, cropped about the centre of each.

    Both heights count outwards from their own body, so the sum is what a flat counterface would
    meet. How the surfaces lie to each other is not known: no map is turned or mirrored. A pixel
    is missing where either is. Where the pixels differ, see `adding_in_words`.

    Raises
    ------
    InputError
        If fewer than three pixels a side are shared.
    """
    grids = [_grid(first, second, axis) for axis in (0, 1)]
    parts = [_on(grids, surface, place) for place, surface in enumerate((first, second))]
    names = " + ".join(surface.source for surface in (first, second) if surface.source)
    return Topography(parts[0] + parts[1], (grids[1][1], grids[0][1]), names)


def adding_in_words(first: Topography, second: Topography) -> str:
    """How `added` brings two maps together, in a sentence."""
    (rows, length, _), (columns, width, _) = (_grid(first, second, axis) for axis in (0, 1))
    shared = f"added on the {columns} x {rows} pixels that both share about their centres"
    if _alike(first, second):
        return shared
    return (
        f"{shared}; the pixels differ, so the finer map was interpolated linearly at the coarser "
        f"pixels of {width:.4g} m x {length:.4g} m: its shorter waves are sampled, not averaged"
    )


def _alike(first: Topography, second: Topography) -> bool:
    """Whether two maps have the same pixel, to a millionth."""
    return bool(np.allclose(first.pixel_size, second.pixel_size, rtol=1e-6, atol=0.0))


def _grid(
    first: Topography, second: Topography, axis: int
) -> tuple[int, float, list[tuple[float, float]]]:
    """The shared grid along an axis: pixels, step [m], and in each map the first pixel and stride.

    The grid is part of the coarser map's own, which is thus only cropped.
    """
    maps = (first, second)
    counts = [surface.heights.shape[axis] for surface in maps]
    steps = [surface.pixel_size[1 - axis] for surface in maps]
    if _alike(first, second):
        points = min(counts)
        return points, steps[0], [(float((count - points) // 2), 1.0) for count in counts]
    step = max(steps)
    coarser = steps.index(step)
    span = min((count - 1) * pixel for count, pixel in zip(counts, steps, strict=True))
    points = min(int(span / step * (1.0 + 1e-12)) + 1, counts[coarser])
    points -= (counts[coarser] - points) % 2
    strides = [step / pixel for pixel in steps]
    return points, step, [
        (0.5 * (count - 1 - (points - 1) * stride), stride)
        for count, stride in zip(counts, strides, strict=True)
    ]  # fmt: skip


def _on(
    grids: list[tuple[int, float, list[tuple[float, float]]]], surface: Topography, place: int
) -> np.ndarray:
    """Heights [m] of one of the maps on the shared grid, about their mean."""
    heights = surface.heights - float(np.nanmean(surface.heights))
    starts, strides = zip(*(grid[2][place] for grid in grids), strict=True)
    rows, columns = (grid[0] for grid in grids)
    if strides == (1.0, 1.0) and all(start.is_integer() for start in starts):
        top, left = (int(start) for start in starts)
        return heights[top : top + rows, left : left + columns]
    return np.asarray(
        ndimage.affine_transform(
            heights, strides, starts, output_shape=(rows, columns), order=1, mode="nearest"
        )
    )
