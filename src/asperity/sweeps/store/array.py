"""The arrays of a store: their metadata, as zarr writes it, and their chunks as bytes."""

from __future__ import annotations

import json
import warnings
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from asperity.errors import InputError
from asperity.sweeps.store.manifest import SCHEMA, refuse_newer
from asperity.sweeps.store.variables import attributes, axis_column, coordinates
from asperity.sweeps.study.blocks import Blocks
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
    blocks : Blocks
        The cases, and how they are cut into chunks.
    width : tuple of int
        Number of values of a case where there are several; else empty.
    dtype : numpy.dtype
        Little-endian.
    fill : float or int
        What stands where nothing was computed.
    """

    blocks: Blocks
    width: tuple[int, ...]
    dtype: np.dtype
    fill: float | int

    def key(self, task: int) -> str:
        """Name of a task's chunk."""
        return ".".join(map(str, ["c", *self.blocks.index(task), *(0 for _ in self.width)]))

    def chunk(self, task: int, values: np.ndarray) -> np.ndarray:
        """Values as they lie in a chunk, one at an end filled up.

        Raises
        ------
        ValueError
            Where their type or shape is another.
        """
        extent = self.blocks.extent(task)
        shape = (len(self.blocks.cases(task)), *self.width)
        if values.shape != shape or values.dtype != self.dtype:
            raise ValueError(
                f"values must be {self.dtype} of shape {shape}; got {values.dtype}, {values.shape}"
            )
        whole = np.full((*self.blocks.block, *self.width), self.fill, self.dtype)
        whole[tuple(map(slice, extent))] = values.reshape(*extent, *self.width)
        return whole

    def values(self, task: int, content: bytes) -> np.ndarray:
        """Values of a task from its chunk, shape (cases[, width])."""
        whole = np.frombuffer(content, self.dtype).reshape(*self.blocks.block, *self.width)
        return whole[tuple(map(slice, self.blocks.extent(task)))].reshape(-1, *self.width)


class Group(NamedTuple):
    """What the metadata of a store say."""

    fingerprint: str
    text: str
    arrays: dict[str, Array]


def metadata(study: Study) -> dict[str, bytes]:
    """Metadata of a study's store, and the values of a grid's axes, by file; by the study alone."""
    import zarr
    from zarr.codecs import ZstdCodec

    files: dict[str, Any] = {}
    options: dict[str, Any] = {
        "compressors": ZstdCodec(level=LEVEL, checksum=True),
        "chunk_key_encoding": {"name": "default", "separator": "."},
    }
    about = {"schema": SCHEMA, "study": study.canonical, "fingerprint": study.fingerprint}
    if study.sample is not None:
        about["coordinates"] = " ".join(axis.key for axis in study.axes)
    memory = zarr.storage.MemoryStore(files)
    group = zarr.create_group(memory, attributes=about, zarr_format=3)
    for column in stored(study):
        along = (study.width(column.along),) if column.along else ()
        group.create_array(
            column.name,
            shape=(*study.shape, *along),
            chunks=(*study.blocks.block, *along),
            dtype=column.dtype,
            fill_value=column.fill,
            dimension_names=(*study.dims, *((column.along,) if along else ())),
            attributes=attributes(column, study.axes),
            **options,
        )
    if study.sample is None:
        for key, (dims, values, told) in coordinates(study).items():
            text = values.dtype == object
            made = group.create_array(
                key,
                shape=values.shape,
                chunks=values.shape,
                dtype="string" if text else values.dtype,
                dimension_names=dims,
                attributes=told,
                **options,
            )
            made[:] = values.astype(str).astype(object) if text else values
    with warnings.catch_warnings():  # xarray looks for it, and zarr warns that others may not
        warnings.filterwarnings("ignore", message="Consolidated metadata")
        zarr.consolidate_metadata(memory)
    return {name: content.to_bytes() for name, content in files.items()}


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
    dims, arrays = _dims(path / "outcome" / METADATA), {}
    for file in sorted(path.glob(f"*/{METADATA}")):
        if (name := file.parent.name) not in dims:  # the values of an axis
            arrays[name] = read_array(file, len(dims))
    if len({array.blocks for array in arrays.values()}) > 1:
        raise InputError(
            f"{path}: must have arrays of one shape; got {', '.join(arrays)}", file=str(path)
        )
    return Group(str(about["fingerprint"]), str(about["study"]), arrays)


def read_array(file: Path, dims: int) -> Array:
    """What an array's metadata say.

    Parameters
    ----------
    file : Path
        Its metadata.
    dims : int
        Number of dimensions of the cases.

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
        if not shape or len(chunk) != len(shape) or min(*shape, *chunk) < 1:
            raise ValueError(f"shape {shape} in chunks of {chunk}")
        blocks = Blocks(shape[:dims], chunk[:dims])
        return Array(blocks, shape[dims:], dtype, np.nan if fill == "NaN" else fill)
    except (KeyError, TypeError, ValueError) as error:
        raise corrupt(file, str(error)) from None


def stored(study: Study) -> tuple[Column, ...]:
    """The columns of a store: those of the study, and the values of the axes of a sample."""
    return (*study.columns, *(map(axis_column, study.axes) if study.sample is not None else ()))


def _dims(file: Path) -> tuple[str, ...]:
    """Names of the dimensions of a column without any of its own."""
    try:
        return tuple(map(str, _json(file)["dimension_names"]))
    except (KeyError, TypeError) as error:
        raise corrupt(file, str(error)) from None


def _json(file: Path) -> dict[str, Any]:
    try:
        about = json.loads(file.read_bytes())
    except OSError as error:
        raise corrupt(file, error.strerror or str(error)) from error
    except ValueError as error:
        raise corrupt(file, str(error)) from None
    if not isinstance(about, dict):
        raise corrupt(file, "no table")
    return about


def same(file: Path, content: bytes) -> bool:
    """Whether a file says what it should; metadata in whatever layout."""
    try:
        found = file.read_bytes()
        return found == content or bool(json.loads(found) == json.loads(content))
    except (OSError, ValueError):
        return False


def corrupt(file: Path, reason: str) -> InputError:
    """What to say of metadata that cannot be read."""
    return InputError(
        f"{file}: cannot be read: {reason} - `asperity sweep STUDY --repair` writes it again",
        file=str(file),
    )


def other_study(path: Path) -> InputError:
    """What to say of the store of another study."""
    return InputError(
        f"{path}: must be the store of this study; it is that of another, or of an earlier text "
        "of it",
        file=str(path),
    )


def refuse_other_cut(path: Path, array: Array, study: Study) -> None:
    """Refuse a store whose chunks are not this program's tasks.

    Raises
    ------
    InputError
        With the cases of a task of both.
    """
    if array.blocks != study.blocks:
        ours, theirs = (f"{each.largest}" for each in (study.blocks, array.blocks))
        raise InputError(
            f"{path}: must be cut into tasks of {ours} cases; got {theirs} - "
            "another version of asperity wrote it",
            file=str(path),
        )
