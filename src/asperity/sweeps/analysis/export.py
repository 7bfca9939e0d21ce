"""The results of a study as a table: one row a case, axes first, units in the header."""

from __future__ import annotations

import contextlib
import csv
import importlib
import os
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np

from asperity.errors import InputError
from asperity.sweeps.store.dataset import dataset_of
from asperity.sweeps.store.store import Store
from asperity.sweeps.store.variables import FLAGS
from asperity.sweeps.study.columns import Column, reasons
from asperity.writing import aside, ending_of

_WORDS = np.array(FLAGS["outcome"], dtype=object)


def export(
    store: str | os.PathLike[str], file: str | os.PathLike[str], *, force: bool = False
) -> Path:
    """Write the results of a study as ``.csv``, ``.parquet`` or ``.nc``.

    CSV and Parquet have one row a case, read and written task by task, so that any number of
    cases fits the memory; what does not apply is empty, outcomes are words. NetCDF has the
    dimensions of `open_study`.

    Parameters
    ----------
    store
        The store.
    file
        What to write; its ending says how.
    force
        Whether a file that is there may be replaced.

    Returns
    -------
    Path
        The file.

    Raises
    ------
    InputError
        Where the store cannot be read, the ending is unknown, the file is there already, or
        Parquet's writer is not installed.
    OutputError
        Where the file cannot be written.
    """
    target = Path(file)
    writer = _WRITERS[ending_of(target, _WRITERS)]
    found = Store.open(store)
    found.refuse_empty()
    with aside(target, force=force) as path:
        writer(found, path)
    return target


def blocks(store: Store) -> Iterator[dict[str, np.ndarray]]:
    """The table in pieces of one task, in order: arrays of one length by the columns' names.

    Axes and float measures are SI numbers, NaN where one does not apply; outcomes and reasons are
    words; whether the first impact captures is an object array of booleans and None. What has
    several values a case has a column for each, with its number from 1 in the name.
    """
    study = store.study
    for number in range(study.tasks):
        cases = study.task(number)
        table = dict(study.values(cases.start, cases.stop))
        for column in study.columns:
            if number in store.done:
                values = store.read(number, column.name)
            else:
                values = study.blank(column, len(cases))
            table |= _in_words(column, values)
        yield table


def units(store: Store) -> dict[str, str]:
    """SI units of the table's columns by name; "" for words."""
    table = {axis.key: axis.unit for axis in store.study.axes}
    for column in store.study.columns:
        names = _names(column, store.study.width(column.along) if column.along else 0)
        table |= dict.fromkeys(names, column.unit)
    return table


def _names(column: Column, width: int) -> list[str]:
    """Names of a column's values in the table."""
    if not column.along or column.along == "byte" or width == 1:
        return [column.name]
    return [f"{column.name}_{number}" for number in range(1, width + 1)]


def _in_words(column: Column, values: np.ndarray) -> dict[str, np.ndarray]:
    """A column's values as the table has them."""
    if column.along == "byte":
        return {column.name: reasons(values)}
    if column.name == "outcome":
        return {column.name: _WORDS[values.astype(int) + 1]}
    if column.name == "captured":
        return {column.name: np.array([None, False, True], dtype=object)[values.astype(int) + 1]}
    if column.along:
        names = _names(column, values.shape[1])
        return dict(zip(names, np.ascontiguousarray(values.T), strict=True))
    return {column.name: values}


def _csv(store: Store, path: Path) -> None:
    """Numbers with all their digits; nothing where one does not apply."""
    with path.open("w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        heads = units(store).items()
        writer.writerow([f"{name} [{unit}]" if unit else name for name, unit in heads])
        for table in blocks(store):
            columns = (_written(values) for values in table.values())
            writer.writerows(zip(*columns, strict=True))


def _written(values: np.ndarray) -> list[Any]:
    if values.dtype.kind == "f":
        return ["" if value != value else value for value in values.tolist()]
    if values.dtype.kind in "bO":
        return [
            ("true" if value else "false") if isinstance(value, bool) else value
            for value in values.tolist()
        ]
    return ["" if value < 0 else value for value in values.tolist()]


def _parquet(store: Store, path: Path) -> None:
    """A row group for each task or more, units in the columns' metadata, null for none."""
    try:
        pyarrow, parquet = map(importlib.import_module, ("pyarrow", "pyarrow.parquet"))
    except ImportError:
        raise InputError(
            "Parquet needs pyarrow, which is not installed: pip install 'asperity[parquet]'"
        ) from None
    schema = None
    with contextlib.ExitStack() as stack:
        for table in blocks(store):
            if schema is None:
                schema = _schema(pyarrow, store, table)
                writer = stack.enter_context(parquet.ParquetWriter(path, schema))
            columns = [
                pyarrow.array(values, type=field.type, from_pandas=True, mask=_absent(values))
                for values, field in zip(table.values(), schema, strict=True)
            ]
            writer.write_table(pyarrow.Table.from_arrays(columns, schema=schema))


def _absent(values: np.ndarray) -> np.ndarray | None:
    """Where whole numbers stand for none."""
    return values < 0 if values.dtype.kind == "i" and bool(np.any(values < 0)) else None


def _schema(pyarrow: Any, store: Store, table: dict[str, np.ndarray]) -> Any:
    """Types and units of the table's columns."""
    fields = []
    for name, unit in units(store).items():
        kind = table[name].dtype
        if name == "captured":
            held = pyarrow.bool_()
        else:
            held = pyarrow.string() if kind.kind == "O" else pyarrow.from_numpy_dtype(kind)
        fields.append(pyarrow.field(name, held, metadata={"unit": unit} if unit else None))
    about = {"study": store.study.canonical, "fingerprint": store.study.fingerprint}
    return pyarrow.schema(fields, metadata=about)


def _netcdf(store: Store, path: Path) -> None:
    made = dataset_of(store, store.columns)
    try:
        made.to_netcdf(path, engine="netcdf4", format="NETCDF4")
    except RuntimeError as error:  # what netCDF's library makes of a full disk
        raise OSError(str(error)) from error


_WRITERS: dict[str, Callable[[Store, Path], None]] = {
    ".csv": _csv,
    ".parquet": _parquet,
    ".nc": _netcdf,
}
