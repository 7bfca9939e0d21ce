"""netCDF -> results: a record is read whole, checked by its own hash."""

from __future__ import annotations

import json
import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from asperity.config import load
from asperity.errors import InputError, Outcome
from asperity.results import record_layout
from asperity.results.netcdf_record import SEAL, sealed
from asperity.results.realisations import KINDS, Realisations
from asperity.results.result import Curve, Result

_MAYBE = ("pull_off_separation", "preload")  # of a curve's numbers
_MAGIC = b"CDF\x02"


def read(path: str | os.PathLike[str]) -> Result | Curve:
    """A result from its record.

    Parameters
    ----------
    path : path
        A ``record.nc`` or ``curve.nc``.

    Raises
    ------
    InputError
        Where the file cannot be read or is no whole record of this program.
    """
    name = os.fspath(path)
    content = _content(name)
    try:
        return _decode(content, name)
    except InputError as error:
        told = str(error) if name in str(error) else f"{name}: {error}"
        raise InputError(told, file=name, key=error.key) from None


def _content(name: str) -> bytes:
    try:
        if not Path(name).exists():
            raise InputError(f"{name}: no such file", file=name)
        if not Path(name).is_file():
            raise InputError(f"{name}: a record must be a regular file", file=name)
        content = Path(name).read_bytes()
    except OSError as error:
        reason = error.strerror or error
        raise InputError(f"{name}: cannot be read: {reason}", file=name) from None
    if not content.startswith(_MAGIC) or SEAL.encode() not in content:
        raise InputError(f"{name}: must be a record of asperity; got another file", file=name)
    if sealed(content) != content:  # found here, since the C library may crash on such a file
        raise InputError(
            f"{name}: must be a whole record of asperity; got one cut short or changed", file=name
        )
    return content


def _decode(content: bytes, name: str) -> Result | Curve:
    from netCDF4 import Dataset

    with Dataset("record.nc", "r", memory=content) as held:
        held.set_auto_mask(False)
        said = {key: held.getncattr(key) for key in held.ncattrs()}
        arrays = {key: np.asarray(held[key][...], dtype=float) for key in held.variables}
    if said["layout_version"] != record_layout.VERSION:
        raise InputError(
            f"{name}: `layout_version` of the record must be {record_layout.VERSION}; "
            f"got {said['layout_version']}"
        )
    shared = {
        "case": load(said["case"], file=name),
        "name": Path(str(said["name"])).name or "record",
        "input_sha256": str(said["input_sha256"]),
        "case_file": said.get("case_file"),
        "surface": json.loads(said["surface"]) if "surface" in said else None,
    }
    if said[record_layout.KIND] == "curve":
        return _curve(arrays, said, shared)
    return _result(arrays, said, shared)


def _result(
    arrays: Mapping[str, Any], said: Mapping[str, Any], shared: Mapping[str, Any]
) -> Result:
    nothing = np.empty(0)
    motion: dict[str, Any] = {key: arrays.get(key, nothing) for key in record_layout.MOTION}
    return Result(
        **shared,
        outcome=Outcome(said["outcome"]),
        **motion,
        forces=_below(arrays, "force_"),
        energies={key: values for key, values in _below(arrays, "energy_").items() if values.ndim},
        events={key: arrays.get(key, nothing) for key in record_layout.EVENTS},
        **{key: json.loads(said[key]) for key in record_layout.PARTS},
        realisations=_realisations(arrays),
    )


def _realisations(arrays: Mapping[str, np.ndarray]) -> Realisations | None:
    bodies = _below(arrays, record_layout.BODY)
    if not bodies:
        return None
    captured, lost = bodies.pop("captured") > 0.5, _below(bodies, "lost_")
    values = {name: values for name, values in bodies.items() if name in KINDS}
    return Realisations(captured, values, lost, _below(arrays, record_layout.SUMMIT))


def _curve(arrays: Mapping[str, Any], said: Mapping[str, Any], shared: Mapping[str, Any]) -> Curve:
    numbers: dict[str, Any] = {key: float(arrays[key]) for key in record_layout.CURVE}
    for key in _MAYBE:
        numbers[key] = None if np.isnan(numbers[key]) else numbers[key]
    return Curve(
        **shared,
        **{key: arrays[key] for key in record_layout.ALONG_CURVE},
        components_loading=_below(arrays, "force_loading_"),
        components_unloading=_below(arrays, "force_unloading_"),
        **numbers,
        warnings=json.loads(said["warnings"]),
        jumps=json.loads(said["jumps"]) if "jumps" in said else None,
    )


def _below(arrays: Mapping[str, np.ndarray], prefix: str) -> dict[str, np.ndarray]:
    """Variables of one kind by their short names."""
    return {
        key.removeprefix(prefix): values for key, values in arrays.items() if key.startswith(prefix)
    }
