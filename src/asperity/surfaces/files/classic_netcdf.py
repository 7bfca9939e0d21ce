"""A netCDF-4 file -> a classic one with what a map needs; run as a program of its own.

On a damaged file the C library may crash or never return: here it takes only this program with
it. It reads standard input, writes standard output, and imports nothing of this package.
"""

from __future__ import annotations

import sys
from typing import Any

import numpy as np

_KEPT = (
    "units", "unit", "missing_value", "scale_factor", "add_offset",
    "pixel_size", "pixel_size_units",
)  # fmt: skip
_CLASSIC = ("i1", "i2", "i4", "f4", "f8")


def converted(content: bytes, most_pixels: int) -> bytes:
    """The planes of numbers of a netCDF-4 file, and their axes, as a classic file.

    Parameters
    ----------
    content
        The file's bytes.
    most_pixels
        Largest plane read.

    Raises
    ------
    ValueError
        Where a plane is larger.
    """
    from netCDF4 import Dataset

    held = Dataset("surface.nc", "r", memory=content)
    held.set_auto_maskandscale(False)
    made = Dataset("classic.nc", "w", format="NETCDF3_64BIT_OFFSET", memory=1)
    numbers = {n: v for n, v in held.variables.items() if getattr(v.dtype, "kind", "") in "iuf"}
    planes = {name: v for name, v in numbers.items() if v.ndim == 2}
    sides = {side for plane in planes.values() for side in plane.dimensions}
    axes = {name: v for name, v in numbers.items() if v.dimensions == (name,) and name in sides}
    for side in sides:
        made.createDimension(side, held.dimensions[side].size)
    for name, variable in {**planes, **axes}.items():
        if variable.size > most_pixels:
            raise ValueError(f"a plane of more than {most_pixels} pixels")
        _copy(variable, made, name)
    return bytes(made.close())


def _copy(variable: Any, made: Any, name: str) -> None:
    """One variable with its attributes; what was never written is marked as such."""
    from netCDF4 import default_fillvals

    kind = variable.dtype.newbyteorder("=")
    # The classic format has no integers without sign or of 64 bits.
    stored = kind if kind.str[1:] in _CLASSIC else np.dtype("f8")
    fill = getattr(variable, "_FillValue", None)
    if fill is None and kind.itemsize > 1:
        fill = np.asarray(default_fillvals[kind.str[1:]]).astype(kind)
    copied = made.createVariable(
        name, stored, variable.dimensions, fill_value=False if fill is None else fill
    )
    copied.set_auto_maskandscale(False)
    for key in _KEPT:
        if key in variable.ncattrs():
            value = variable.getncattr(key)
            copied.setncattr(key, value if isinstance(value, str) else np.asarray(value, "f8"))
    copied[...] = variable[...].astype(stored)


if __name__ == "__main__":
    sys.stdout.buffer.write(converted(sys.stdin.buffer.read(), int(sys.argv[1])))
