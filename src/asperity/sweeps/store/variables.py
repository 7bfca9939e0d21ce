"""What a store and a dataset say of their variables: dimensions, coordinates, CF's attributes."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from asperity.errors import ENDS
from asperity.sweeps.study.columns import Column

if TYPE_CHECKING:
    from asperity.sweeps.study.study import Axis, Study

Variable = tuple[tuple[str, ...], np.ndarray, dict[str, Any]]
"""Dimensions, values and attributes."""

FLAGS = {
    "outcome": ("not_computed", *(outcome.value for outcome in ENDS)),
    "captured": ("undecided", "rebounds", "captured"),
}
"""Meanings of the codes -1, 0, 1, ... of a column."""


def coordinates(study: Study) -> dict[str, Variable]:
    """The axes' values: of a grid along the axis itself, of a sample along the cases."""
    if study.sample is None:
        return {axis.key: ((axis.key,), axis.values, _about(axis)) for axis in study.axes}
    drawn = study.values(0, study.size)
    return {axis.key: (study.dims, drawn[axis.key], _about(axis)) for axis in study.axes}


def _about(axis: Axis) -> dict[str, str]:
    """Unit, name and scale of an axis."""
    unit = {"units": axis.unit} if axis.unit else {}
    return {**unit, "long_name": axis.label, "scale": axis.scale}


def axis_column(axis: Axis) -> Column:
    """The values of an axis as a column; text and switches by their number in the list."""
    kind = "int64" if axis.whole else "float64"
    return Column(axis.key, kind if axis.numeric else "int32", axis.unit, axis.label)


def drawn(study: Study, cases: range) -> dict[str, np.ndarray]:
    """The values of some cases for the columns of a sample's axes; nothing of a grid."""
    if study.sample is None:
        return {}
    values, found = study.values(cases.start, cases.stop), {}
    for axis in study.axes:
        column, own = axis_column(axis), values[axis.key]
        if not axis.numeric:
            own = np.array([axis.listed.index(value) for value in own.tolist()])
        found[axis.key] = own.astype(column.dtype)
    return found


def attributes(column: Column, axes: tuple[Axis, ...] = ()) -> dict[str, Any]:
    """Unit, name and codes of a column, as the CF conventions call them."""
    about: dict[str, Any] = {"long_name": column.meaning}
    if column.unit:
        about["units"] = column.unit
    codes = {axis.key: axis.listed for axis in axes if not axis.numeric}
    if column.name in FLAGS:
        names = FLAGS[column.name]
        about["flag_values"] = list(range(-1, len(names) - 1))
        about["flag_meanings"] = " ".join(names)
    elif column.name in codes:
        names = tuple(str(value) for value in codes[column.name])
        about["flag_values"] = list(range(len(names)))
        about["flag_meanings"] = " ".join(name.replace(" ", "_") for name in names)
    return about
