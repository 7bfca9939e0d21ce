"""`Topography` -> a file that `asperity.surfaces.files.read_surface` reads back."""

from __future__ import annotations

import gzip
import io
import os
from collections.abc import Callable
from pathlib import Path

import numpy as np

from ...writing import aside, check_file, ending_of
from ..topography import Topography
from .content import suffix_of


def write_topography(
    topography: Topography, path: str | os.PathLike[str], *, force: bool = False
) -> None:
    """Write a surface to a file, whole or not at all.

    Parameters
    ----------
    topography
        The surface.
    path
        The file; its ending chooses the format: ``.npy .csv .txt .dat .xyz .nc``, each also packed
        as ``.gz``. Heights are written in metres, to the last digit. An ``.npy`` holds heights
        alone: reading it needs its size, and ``unit="m"``. The others state both.
    force
        Whether a file of that name may be replaced.

    Raises
    ------
    InputError
        Where the ending is of no format that can be written, or the file is there and ``force`` is
        not set.
    OutputError
        Where it cannot be written.
    """
    target = Path(path)
    content = _ENCODERS[_format_of(target)](topography)
    if target.name.lower().endswith(".gz"):
        content = gzip.compress(content, compresslevel=6, mtime=0)
    with aside(target, force=force) as place:
        place.write_bytes(content)


def check_target(target: Path, *, force: bool = False) -> None:
    """See to it, before a surface is made, that it can be written.

    Parameters
    ----------
    target, force
        As `write_topography`.

    Raises
    ------
    InputError, OutputError
        As `write_topography`.
    """
    _format_of(target)
    check_file(target, force=force)


def _format_of(target: Path) -> str:
    return ending_of(target, _ENCODERS, suffix_of(target.name))


def _array(topography: Topography) -> bytes:
    held = io.BytesIO()
    np.save(held, topography.heights, allow_pickle=False)
    return held.getvalue()


def _matrix(topography: Topography) -> bytes:
    width, length = topography.physical_size
    rows, columns = topography.heights.shape
    head = [f"# size[m] {width!r} {length!r}", "# unit m", f"# pixels {columns} {rows}"]
    lines = [",".join(map(repr, row.tolist())) for row in topography.heights]
    return ("\n".join([*head, *lines]) + "\n").encode("ascii")


def _points(topography: Topography) -> bytes:
    rows, columns = topography.heights.shape
    along, across = topography.pixel_size
    x = [f"{number * along!r}" for number in range(columns)]
    lines = ["# x[m] y[m] z[m]", f"# pixels {columns} {rows}"]
    for number, row in enumerate(topography.heights):
        y = f"{number * across!r}"
        lines += [f"{one} {y} {z!r}" for one, z in zip(x, row.tolist(), strict=True)]
    return ("\n".join(lines) + "\n").encode("ascii")


def _netcdf(topography: Topography) -> bytes:
    """The classic format with 64-bit offsets: it keeps no time of day, and all readers know it."""
    from scipy.io import netcdf_file

    held = io.BytesIO()
    made = netcdf_file(held, "w", version=2)
    spacing = dict(zip("yx", topography.pixel_size[::-1], strict=True))
    for (name, step), count in zip(spacing.items(), topography.heights.shape, strict=True):
        made.createDimension(name, count)
        axis = made.createVariable(name, "f8", (name,))
        axis[:] = step * np.arange(count)
        axis.units = "m"
    heights = made.createVariable("heights", "f8", ("y", "x"))
    heights[:] = topography.heights
    heights.units, heights.long_name = "m", "height"
    heights._FillValue = np.nan
    # The coordinates give it too, but for rounding.
    heights.pixel_size, heights.pixel_size_units = np.array(topography.pixel_size), "m"
    made.flush()
    return held.getvalue()


_ENCODERS: dict[str, Callable[[Topography], bytes]] = {
    ".npy": _array,
    ".csv": _matrix,
    ".txt": _matrix,
    ".dat": _matrix,
    ".xyz": _points,
    ".nc": _netcdf,
}
