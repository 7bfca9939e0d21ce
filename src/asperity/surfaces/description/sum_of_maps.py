"""Two maps added, on the area that they share."""

from __future__ import annotations

import numpy as np
from scipy import ndimage

from ..preparation.form_removal import levelled
from ..topography import Topography

_Grid = tuple[int, float, list[tuple[float, float]]]
"""Along an axis: pixels, step [m], and in each map the first pixel and the stride."""

_LEVEL = 0.02  # share by which a map may be cropped and still count as level


def added(first: Topography, second: Topography) -> Topography:
    """Sum of two maps on the area that they share, cropped about the centre of each.

    Both heights count outwards from their own body, so the sum is what a flat counterface would
    meet. How the surfaces lie to each other is not known: no map is turned or mirrored. A pixel
    is missing where either is. Where a map is cropped, its tilt on the shared area is removed: a
    body that sits there meets none. Where the pixels differ, see `adding_in_words`.

    Raises
    ------
    InputError
        If fewer than three pixels a side are shared.
    """
    grids = _grids(first, second)
    names = " + ".join(surface.source for surface in (first, second) if surface.source)
    pixel_size = grids[1][1], grids[0][1]
    parts = [
        Topography(_on(grids, surface, place), pixel_size, names)
        for place, surface in enumerate((first, second))
    ]
    if _cropped(first, second):
        parts = [levelled(part, "tilt")[0] for part in parts]
    return Topography(parts[0].heights + parts[1].heights, pixel_size, names)


def adding_in_words(first: Topography, second: Topography) -> str:
    """How `added` brings two maps together, in a sentence."""
    (rows, length, _), (columns, width, _) = _grids(first, second)
    shared = f"added on the {columns} x {rows} pixels that both share about their centres"
    if _cropped(first, second):
        shared += ", the tilt of each removed there"
    if _alike(first, second):
        return shared
    coarser = f"pixels of {width * 1e9:.4g} nm x {length * 1e9:.4g} nm"
    strides = [stride for grid in _grids(first, second) for _, stride in grid[2]]
    if all(float(stride).is_integer() for stride in strides):
        return f"{shared}; the pixels differ: the finer map was taken at the coarser {coarser}"
    return (
        f"{shared}; the pixels differ: the finer map was interpolated linearly at the coarser "
        f"{coarser}, which smooths waves of two or three of its own pixels"
    )


def _grids(first: Topography, second: Topography) -> list[_Grid]:
    return [_grid(first, second, axis) for axis in (0, 1)]


def _cropped(first: Topography, second: Topography) -> bool:
    """Whether a map is cropped so far that what was level on the whole of it may tilt."""
    shared = [grid[0] * grid[1] for grid in _grids(first, second)]
    sizes = [surface.physical_size[::-1] for surface in (first, second)]
    return any(
        whole > (1.0 + _LEVEL) * part
        for size in sizes
        for whole, part in zip(size, shared, strict=True)
    )


def _alike(first: Topography, second: Topography) -> bool:
    """Whether two maps have the same pixel, to a millionth."""
    return bool(np.allclose(first.pixel_size, second.pixel_size, rtol=1e-6, atol=0.0))


def _grid(first: Topography, second: Topography, axis: int) -> _Grid:
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
    places = []
    for count, pixel in zip(counts, steps, strict=True):
        stride = step / pixel
        start = 0.5 * (count - 1 - (points - 1) * stride)
        whole = float(round(stride))
        # Of whole ratios the pixels themselves are taken, half a fine pixel off the centre.
        places.append((float(int(start)), whole) if abs(stride - whole) < 1e-6 else (start, stride))
    return points, step, places


def _on(grids: list[_Grid], surface: Topography, place: int) -> np.ndarray:
    """Heights [m] of one of the maps on the shared grid, about their mean."""
    heights = surface.heights - float(np.nanmean(surface.heights))
    starts, strides = zip(*(grid[2][place] for grid in grids), strict=True)
    rows, columns = (grid[0] for grid in grids)
    if all(float(each).is_integer() for each in (*strides, *starts)):
        (top, left), (down, along) = (map(int, pair) for pair in (starts, strides))
        return heights[top::down, left::along][:rows, :columns]
    return np.asarray(
        ndimage.affine_transform(
            heights, strides, starts, output_shape=(rows, columns), order=1, mode="nearest"
        )
    )
