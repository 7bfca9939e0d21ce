"""Heights from netCDF: one variable of two dimensions, with units and coordinates."""

from __future__ import annotations

import io
import subprocess
import sys
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from ...errors import InputError
from ...units import shown
from .content import MOST_PIXELS, cut_short, refusal
from .header import agreed_size, agreed_unit, checked_unit, in_metres
from .reading import Asked
from .scattered_points import steps_of

_CLASSIC = (b"CDF\x01", b"CDF\x02")
_NETCDF4 = b"\x89HDF\r\n\x1a\n"
_LONGEST = 120
"""Longest time for a netCDF-4 file [s]; one of 2048 x 2048 pixels takes 1 to 2 s."""
_MASK = "mask"
_LINE = ", or as coordinates with `units` in the file"


class Plane(NamedTuple):
    """A variable of two dimensions.

    Parameters
    ----------
    values
        As they are stored, rows along y.
    unit
        Their unit; None where the file states none.
    pixel_size
        Spacing (along x, along y) [m]; None where the file states none.
    """

    values: np.ndarray
    unit: str | None
    pixel_size: tuple[float, float] | None


def map_of_netcdf(
    content: bytes, file: str, asked: Asked
) -> tuple[np.ndarray, tuple[float, float]]:
    """Heights [m] and pixel size (dx, dy) [m] of a netCDF file.

    Parameters
    ----------
    content
        The file's bytes.
    file
        Its name.
    asked
        What is said of it beside.

    Raises
    ------
    InputError
        Where the file is no whole netCDF file, or does not say which heights, unit and size.
    """
    try:
        plane = _plane(_opened(content, file), file, asked.channel)
    except InputError as error:
        raise (error if error.file else refusal(file, str(error))) from None
    except Exception as error:  # damaged files make the libraries raise many kinds
        raise cut_short(file, f"a netCDF file that cannot be read ({str(error)[:80]})") from error
    rows, columns = plane.values.shape
    if not plane.values.size:
        raise cut_short(file, f"a plane of {columns} x {rows} pixels")
    heights = in_metres(plane.values, agreed_unit(plane.unit, asked.unit, file))
    step = plane.pixel_size
    stated = None if step is None else (columns * step[0], rows * step[1])
    width, length = agreed_size(stated, asked.size, file, _LINE)
    return heights, step or (width / columns, length / rows)


def _opened(content: bytes, file: str) -> Any:
    """The file, opened in memory without the C library, which a damaged file may crash."""
    from scipy.io import netcdf_file

    if content.startswith(_NETCDF4):
        content = _as_classic(content, file)
    if not content.startswith(_CLASSIC):
        raise refusal(file, "must be a netCDF file; got another; check the ending of its name")
    return netcdf_file(io.BytesIO(content), "r", mmap=False)


def _as_classic(content: bytes, file: str) -> bytes:
    """A netCDF-4 file in the classic format, made by a program that may fail alone."""
    program = [sys.executable, "-I", str(Path(__file__).with_name("classic_netcdf.py"))]
    try:
        done = subprocess.run(
            [*program, str(MOST_PIXELS)],
            input=content,
            capture_output=True,
            check=False,
            timeout=_LONGEST,
        )
    except subprocess.TimeoutExpired:
        raise cut_short(file, f"a netCDF-4 file that takes more than {_LONGEST} s") from None
    if done.returncode != 0 or not done.stdout:
        said = done.stderr.decode(errors="replace").strip().rsplit("\n", 1)[-1]
        raise cut_short(file, f"a netCDF-4 file that cannot be read ({said or 'it crashed'})")
    return done.stdout


def _plane(held: Any, file: str, channel: str | int | None) -> Plane:
    """The heights among the variables of a file, oriented, with missing ones as NaN."""
    name = _chosen(held, file, channel)
    variable = held.variables[name]
    if np.prod([float(count) for count in variable.shape]) > MOST_PIXELS:
        raise refusal(file, f"must have at most {MOST_PIXELS} pixels; got {variable.shape}")
    values = _decoded(variable)
    mask = held.variables.get(_MASK)
    if mask is not None and name != _MASK and mask.dimensions == variable.dimensions:
        values = np.where(np.asarray(mask[...]) != 0, np.nan, values)
    across, along = variable.dimensions
    if (across.lower(), along.lower()) == ("x", "y"):
        values, across, along = values.T, along, across
    spacing = [_spacing(held, one, file) for one in (along, across)]
    for axis, (_, falling) in enumerate(reversed(spacing)):
        values = np.flip(values, axis) if falling else values
    x, y = (step for step, _ in spacing)
    stated = _stated_pixel_size(variable, file)
    measured = None if x is None or y is None else (x, y)
    if stated and measured and not np.allclose(stated, measured, 1e-6, 0.0):
        raise refusal(
            file, f"`pixel_size` must be that of the coordinates, {measured} m; got {stated} m"
        )
    return Plane(values, _unit(variable), stated or measured)


def _chosen(held: Any, file: str, channel: str | int | None) -> str:
    found = [
        name
        for name, variable in held.variables.items()
        if len(variable.dimensions) == 2
        and np.dtype(getattr(variable, "dtype", None) or variable.data.dtype).kind in "iuf"
    ]
    heights = [name for name in found if name != _MASK or len(found) == 1]
    listed = ", ".join(heights) or "none"
    if channel is None and len(heights) == 1:
        return heights[0]
    if channel is None:
        raise refusal(
            file,
            f"must hold one variable of two dimensions with the heights; got {listed}; "
            "name one as the channel",
        )
    if isinstance(channel, int) and 0 <= channel < len(heights):
        return heights[channel]
    if channel not in heights:
        raise refusal(file, f"the channel must be one of {listed}; got {shown(channel)}")
    return str(channel)


def _decoded(variable: Any) -> np.ndarray:
    """Values as float64, unpacked (CF conventions, 8.1), NaN where they are missing."""
    stored = np.asarray(variable[...])
    missing = np.zeros(stored.shape, dtype=bool)
    for mark in (getattr(variable, "_FillValue", None), getattr(variable, "missing_value", None)):
        if mark is not None:
            missing |= np.isin(stored, np.atleast_1d(mark))
    if getattr(variable, "_FillValue", None) is None:
        missing |= stored == _unwritten(stored.dtype)
    factor, offset = (getattr(variable, name, None) for name in ("scale_factor", "add_offset"))
    values = stored.astype(np.float64)
    if factor is not None:
        values = values * float(factor)
    if offset is not None:
        values = values + float(offset)
    return np.where(missing, np.nan, values)


def _unwritten(kind: np.dtype) -> Any:
    """What netCDF stores where nothing was written; bytes have no such value."""
    from netCDF4 import default_fillvals

    code = f"{kind.kind}{kind.itemsize}"
    fill = default_fillvals.get(code) if kind.itemsize > 1 else None
    return np.nan if fill is None else np.asarray(fill).astype(kind)


def _spacing(held: Any, dimension: str, file: str) -> tuple[float | None, bool]:
    """Step [m] of a dimension's coordinate, None where it has none; whether it falls."""
    variable = held.variables.get(dimension)
    unit = None if variable is None else _unit(variable)
    if variable is None or variable.dimensions != (dimension,):
        return None, False
    stored = _decoded(variable)
    if unit is None or stored.size < 2:
        return None, bool(stored.size > 1 and stored[0] > stored[-1])
    steps, step = steps_of(in_metres(stored, checked_unit(unit)), dimension, file)
    falling = bool(steps[0] > steps[-1])
    if not np.array_equal(steps[::-1] if falling else steps, np.arange(stored.size)):
        raise refusal(file, f"`{dimension}` must rise or fall in even steps; got another order")
    return step, falling


def _stated_pixel_size(variable: Any, file: str) -> tuple[float, float] | None:
    """The attribute `pixel_size` [m], which the coordinates would give but for rounding."""
    pair = getattr(variable, "pixel_size", None)
    unit = getattr(variable, "pixel_size_units", None)
    if pair is None or unit is None:
        return None
    x, y = in_metres(np.asarray(pair, dtype=np.float64), checked_unit(_text(unit)))
    if not (0.0 < x < np.inf and 0.0 < y < np.inf):
        raise refusal(file, f"`pixel_size` must be two positive lengths; got {shown(pair)}")
    return float(x), float(y)


def _unit(variable: Any) -> str | None:
    """Unit of a variable, by CF's `units` or by the `unit` of SurfaceTopography's files."""
    found = getattr(variable, "units", None)
    found = getattr(variable, "unit", None) if found is None else found
    return None if found is None else _text(found)


def _text(value: Any) -> str:
    return value.decode() if isinstance(value, bytes) else str(value)
