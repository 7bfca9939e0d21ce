"""The results of a study as one dataset: the study has its dimensions, a store its values."""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from asperity.config.problems import did_you_mean
from asperity.errors import InputError
from asperity.sweeps.store.store import REPAIR, Store
from asperity.sweeps.store.variables import Variable, attributes, coordinates
from asperity.sweeps.study.columns import FAILED, Column, reasons
from asperity.sweeps.study.study import Study, parse
from asperity.units import shown

if TYPE_CHECKING:
    import xarray


@dataclass(frozen=True)
class Results:
    """A store that was opened for reading.

    Parameters
    ----------
    study
        The study that it belongs to.
    store
        The store.
    """

    study: Study
    store: Store

    @property
    def path(self) -> str:
        """Its folder."""
        return str(self.store.path)

    @property
    def columns(self) -> dict[str, Column]:
        """Its columns by name."""
        return {column.name: column for column in self.study.columns}

    def checked(self, names: Iterable[str]) -> list[str]:
        """Names of columns, once each.

        Raises
        ------
        InputError
            Where the study has not kept one of them, or its array is missing.
        """
        wanted = list(dict.fromkeys(names))
        for name in wanted:
            if name not in self.columns:
                raise InputError(
                    f"{self.path}: a column must be one of {', '.join(self.columns)}; "
                    f"got {shown(name)}{did_you_mean(name, self.columns)}",
                    file=self.path,
                )
            if name not in self.store.arrays:
                raise InputError(
                    f"{self.path}: must hold an array {name}; it is missing - {REPAIR}",
                    file=self.path,
                )
        return wanted

    def refuse_empty(self) -> None:
        """Refuse a store in which nothing is computed yet.

        Raises
        ------
        InputError
            Where no task is finished.
        """
        if not self.store.done:
            raise InputError(
                f"{self.path}: must hold results; none is computed yet - `asperity sweep STUDY "
                "--resume` goes on",
                file=self.path,
            )


def open_results(path: str | os.PathLike[str]) -> Results:
    """Open a store for reading.

    Parameters
    ----------
    path
        The folder, e.g. ``"study.zarr"``.

    Raises
    ------
    InputError
        Where there is none, it is no store of a study, or one of a newer schema.
    """
    store = Store.open(Path(path))
    return Results(parse(store.text, file=os.fspath(path)), store)


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
    found = open_results(path)
    if columns is None:
        columns = [name for name in found.columns if name != "reason"]
    return dataset_of(found, ("outcome", *columns))


def dataset_of(found: Results, names: Iterable[str]) -> xarray.Dataset:
    """Some columns of an open store as a dataset; see `open_study`."""
    values = {name: found.store.column(name) for name in found.checked(names)}
    return dataset_in(found.study, values)


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
