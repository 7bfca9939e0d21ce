"""The arrays of a store: their metadata, as zarr writes it, and their chunks as bytes."""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from asperity.errors import ENDS, InputError
from asperity.sweeps.store.manifest import SCHEMA, refuse_newer
from asperity.sweeps.study.columns import Column

if TYPE_CHECKING:
    from asperity.sweeps.study.study import Study

LEVEL = 3
"""Of Zstandard's compression."""

METADATA = "zarr.json"


@dataclass(frozen=True)
class Array:
    """One column on disk.

    Parameters
    ----------
    shape : tuple of int
        Cases, and values a case where there are several.
    task_size : int
        Cases of a chunk.
    dtype : numpy.dtype
        Little-endian.
    fill : float or int
        What stands where nothing was computed.
    """

    shape: tuple[int, ...]
    task_size: int
    dtype: np.dtype
    fill: float | int

    @property
    def size(self) -> int:
        """Number of cases."""
        return self.shape[0]

    def key(self, task: int) -> str:
        """Name of a task's chunk."""
        return ".".join(["c", str(task), *("0" for _ in self.shape[1:])])

    def cases(self, task: int) -> int:
        """Cases of a task; the last may have fewer."""
        return min(self.task_size, self.size - task * self.task_size)

    def chunk(self, task: int, values: np.ndarray) -> np.ndarray:
        """Values as they lie in a chunk, the last one filled up.

        Raises
        ------
        ValueError
            Where their type or shape is another.
        """
        shape = (self.cases(task), *self.shape[1:])
        if values.shape != shape or values.dtype != self.dtype:
            raise ValueError(
                f"values must be {self.dtype} of shape {shape}; got {values.dtype}, {values.shape}"
            )
        if shape[0] == self.task_size:
            return np.ascontiguousarray(values, dtype=self.dtype)
        whole = np.full((self.task_size, *self.shape[1:]), self.fill, self.dtype)
        whole[: shape[0]] = values
        return whole

    def values(self, task: int, content: bytes) -> np.ndarray:
        """Values of a task from its chunk, shape (cases[, width])."""
        whole = np.frombuffer(content, self.dtype).reshape(self.task_size, *self.shape[1:])
        return whole[: self.cases(task)]


class Group(NamedTuple):
    """What the metadata of a store say."""

    fingerprint: str
    text: str
    arrays: dict[str, Array]


def metadata(study: Study) -> dict[str, bytes]:
    """The metadata files of a study's store, by name; they follow from the study alone."""
    import zarr
    from zarr.codecs import ZstdCodec

    files: dict[str, Any] = {}
    attributes = {"schema": SCHEMA, "study": study.canonical, "fingerprint": study.fingerprint}
    group = zarr.create_group(zarr.storage.MemoryStore(files), attributes=attributes, zarr_format=3)
    for column in study.columns:
        along = (study.width(column.along),) if column.along else ()
        group.create_array(
            column.name,
            shape=(study.size, *along),
            chunks=(study.task_size, *along),
            dtype=column.dtype,
            fill_value=column.fill,
            compressors=ZstdCodec(level=LEVEL, checksum=True),
            dimension_names=("case", column.along) if along else ("case",),
            chunk_key_encoding={"name": "default", "separator": "."},
            attributes=_attributes(column),
        )
    return {name: content.to_bytes() for name, content in files.items()}


def _attributes(column: Column) -> dict[str, Any]:
    about: dict[str, Any] = {"unit": column.unit, "meaning": column.meaning}
    if column.name == "outcome":
        about["codes"] = {outcome.value: code for code, outcome in enumerate(ENDS)}
    return about


def read_group(path: Path) -> Group:
    """The metadata of a store.

    Raises
    ------
    InputError
        Where there is none, it is of no sweep or of a newer schema, or an array's cannot be read.
    """
    if not (path / METADATA).is_file():
        what = (
            "has no zarr.json"
            if path.is_dir()
            else "is no folder"
            if path.exists()
            else "is not there"
        )
        raise InputError(f"{path}: must be the store of a sweep; it {what}", file=str(path))
    about = _json(path / METADATA).get("attributes", {})
    if not isinstance(about, dict) or not {"schema", "study", "fingerprint"} <= about.keys():
        raise InputError(
            f"{path}: must be the store of a sweep; it is another zarr group", file=str(path)
        )
    refuse_newer(path, about["schema"])
    folders = sorted(file.parent.name for file in path.glob(f"*/{METADATA}"))
    arrays = {name: read_array(path / name / METADATA) for name in folders}
    if "outcome" not in arrays or len({(a.size, a.task_size) for a in arrays.values()}) > 1:
        raise InputError(
            f"{path}: must have arrays of one length, `outcome` among them; "
            f"got {', '.join(arrays) or 'none'}",
            file=str(path),
        )
    return Group(str(about["fingerprint"]), str(about["study"]), arrays)


def read_array(file: Path) -> Array:
    """What an array's metadata say.

    Raises
    ------
    InputError
        Where they cannot be read.
    """
    about = _json(file)
    try:
        shape = tuple(int(n) for n in about["shape"])
        chunk = tuple(int(n) for n in about["chunk_grid"]["configuration"]["chunk_shape"])
        dtype = np.dtype(about["data_type"]).newbyteorder("<")
        fill = about["fill_value"]
        if not shape or shape[0] < 1 or chunk[0] < 1 or chunk[1:] != shape[1:]:
            raise ValueError(f"shape {shape} in chunks of {chunk}")
        return Array(shape, chunk[0], dtype, np.nan if fill == "NaN" else fill)
    except (KeyError, TypeError, ValueError) as error:
        raise torn(file, str(error)) from None


def _json(file: Path) -> dict[str, Any]:
    try:
        about = json.loads(file.read_bytes())
    except OSError as error:
        raise torn(file, error.strerror or str(error)) from error
    except ValueError as error:
        raise torn(file, str(error)) from None
    if not isinstance(about, dict):
        raise torn(file, "no table")
    return about


def same(file: Path, content: bytes) -> bool:
    """Whether a metadata file says what it should, in whatever layout."""
    try:
        return bool(json.loads(file.read_bytes()) == json.loads(content))
    except (OSError, ValueError):
        return False


def torn(file: Path, reason: str) -> InputError:
    """What to say of metadata that cannot be read."""
    return InputError(
        f"{file}: cannot be read: {reason} - `asperity sweep STUDY --repair` writes it again",
        file=str(file),
    )
