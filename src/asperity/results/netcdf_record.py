"""Results as netCDF, with provenance. The same result gives the same bytes."""

from __future__ import annotations

import hashlib
from typing import TYPE_CHECKING

import numpy as np

from asperity.results import record_layout
from asperity.results.result_data import CurveData, ResultData

if TYPE_CHECKING:
    import xarray

SEAL = "content_sha256"
"""Attribute that holds the hash of the record's content."""

_UNSEALED = "0" * 64
_SEAL_OFFSET = 24  # the name, padded to 16 bytes; type and length of its value


def encode(result: ResultData | CurveData) -> bytes:
    """A result as the content of a netCDF file.

    The classic format with 64-bit offsets: unlike netCDF-4 it holds no time of day, keeps the
    order of its variables, and every reader of netCDF knows it.
    """
    from netCDF4 import Dataset

    held = Dataset("record.nc", "w", format="NETCDF3_64BIT_OFFSET", memory=1)
    for name, value in {SEAL: _UNSEALED, **record_layout.attributes(result)}.items():
        held.setncattr(name, np.int32(value) if isinstance(value, int) else value)
    variables = [one for one in record_layout.variables(result) if one.values.size]
    for variable in variables:
        for dimension, size in zip(variable.dimensions, variable.values.shape, strict=True):
            if dimension not in held.dimensions:
                held.createDimension(dimension, size)
        made = held.createVariable(variable.name, "f8", variable.dimensions, fill_value=False)
        made.units, made.long_name = variable.units, variable.long_name
    for variable in variables:
        held[variable.name][...] = variable.values
    return sealed(bytes(held.close()))


def dataset(result: ResultData | CurveData) -> xarray.Dataset:
    """A result as a dataset: the variables of its record, with units, and its attributes."""
    import xarray

    found = {
        v.name: (v.dimensions, v.values, {"units": v.units, "long_name": v.long_name})
        for v in record_layout.variables(result)
    }
    index = "rigid_separation" if isinstance(result, CurveData) else "time"
    coordinates = {index: found.pop(index)} if index in found else {}
    return xarray.Dataset(found, coords=coordinates, attrs=record_layout.attributes(result))


def sealed(content: bytes) -> bytes:
    """The content with its own SHA-256 inside, in place of what stood there."""
    start = content.index(SEAL.encode()) + _SEAL_OFFSET
    end = start + len(_UNSEALED)
    blank = content[:start] + _UNSEALED.encode() + content[end:]
    return content[:start] + hashlib.sha256(blank).hexdigest().encode() + content[end:]
