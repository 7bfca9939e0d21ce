"""The results of a study as one dataset: the study has its dimensions, a store its values."""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING

import numpy as np

from asperity.sweeps.store.store import Store
from asperity.sweeps.store.variables import Variable, attributes, coordinates
from asperity.sweeps.study.columns import FAILED, Column, reasons
from asperity.sweeps.study.study import Study

if TYPE_CHECKING:
    import xarray


def open_study(
    path: str | os.PathLike[str], columns: Iterable[str] | None = None
) -> xarray.Dataset:
    """The results of a study as a dataset with units.

    Parameters
    ----------
    path
        The store, e.g. ``"study.zarr"``; it need not be complete.
    columns
        Names of the columns wanted; without it all but ``reason``.

    Returns
    -------
    xarray.Dataset
        A grid has a dimension for each axis, named by its key; a sample has the dimension
        ``case``, with the axes' values along it. All values are SI, with ``units`` and
        ``long_name``. The attributes ``cases``, ``computed`` and ``failed`` are numbers of cases;
        cases not yet computed have the outcome -1, no integers (-1) and NaN elsewhere.

    Raises
    ------
    InputError
        Where it is no store, a column is unknown, or a chunk is damaged.
    """
    store = Store.open(path)
    if columns is None:
        columns = [name for name in store.columns if name != "reason"]
    return dataset_of(store, ("outcome", *columns))


def dataset_of(store: Store, names: Iterable[str]) -> xarray.Dataset:
    """Some columns of an open store as a dataset; see `open_study`."""
    values = {name: store.column(name) for name in store.checked(names)}
    return dataset_in(store.study, values)


def dataset_in(study: Study, values: Mapping[str, np.ndarray]) -> xarray.Dataset:
    """Columns of a study as a dataset, ``outcome`` among them; see `open_study`.

    Parameters
    ----------
    study : Study
        The study.
    values : mapping of str to ndarray
        Columns by name, shape (cases[, width]).
    """
    import xarray

    columns = {column.name: column for column in study.columns}
    variables = {
        name: _variable(columns[name], column, study.dims, study.shape)
        for name, column in values.items()
    }
    outcome = values["outcome"]
    return xarray.Dataset(
        variables,
        coordinates(study),
        {
            "title": f"{study.base_name}: {study.size} cases",
            "base": study.base_name,
            "axes": [axis.key for axis in study.axes],
            "cases": study.size,
            "computed": int(np.count_nonzero(outcome >= 0)),
            "failed": int(np.count_nonzero(outcome == FAILED)),
            "study": study.canonical,
            "fingerprint": study.fingerprint,
        },
    )


def _variable(
    column: Column, values: np.ndarray, dimensions: tuple[str, ...], shape: tuple[int, ...]
) -> Variable:
    """A column along the dimensions of the study."""
    about = attributes(column)
    if "flag_values" in about:
        about["flag_values"] = np.array(about["flag_values"], column.dtype)
    if column.along == "byte":
        return dimensions, reasons(values).reshape(shape), about
    if column.along:
        return (*dimensions, column.along), values.reshape(*shape, -1), about
    return dimensions, values.reshape(shape), about
