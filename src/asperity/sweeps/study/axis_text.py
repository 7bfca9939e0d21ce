"""An axis as it stands in a study file -> `Axis`, with every problem in one line."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Annotated, Any

import numpy as np
from pydantic import BeforeValidator, Field

from asperity.config.base_table import Table
from asperity.config.fields import Number
from asperity.config.problems import check, did_you_mean
from asperity.errors import InputError
from asperity.sweeps.study.axes import Axis, Scale
from asperity.sweeps.study.keys import Key, Value
from asperity.units import shown

STEPS_LIMIT = 1_000_000_000
"""Most values of a range; so many cases are counted, and never held at once."""

LIST_LIMIT = 10_000
"""Most values of a list, each of which is read with its unit."""


def _list(value: object) -> object:
    if not isinstance(value, list) or not 1 <= len(value) <= LIST_LIMIT:
        got = f"{len(value)} of them" if isinstance(value, list) and value else shown(value)
        raise InputError(f"`values` must be a list of 1 to {LIST_LIMIT} values; got {got}")
    return value


class AxisTable(Table):
    """An axis as it stands in a study file, before its values are read."""

    values: Annotated[list[Any], BeforeValidator(_list)] | None = None
    start: Any = Field(None, alias="from")
    to: Any = None
    steps: Annotated[int, Number(f"[2, {STEPS_LIMIT}]", whole=True)] | None = None
    scale: Scale | None = None


def axis_of(key: Key, written: object, *, sampled: bool) -> Axis:
    """The axis of a key.

    Parameters
    ----------
    key : Key
        What varies.
    written : dict
        What the study file has for it.
    sampled : bool
        Whether the values are drawn, so that a range has no steps.

    Raises
    ------
    InputError
        Where a value breaks the key's rule, or the range one of its own.
    """
    table = _table(written)
    if table.values is not None:
        return _listed(key, table.values)
    if not key.numeric:
        raise InputError(
            f"`values` must be given for `{key.last}`, which is no number and has no range; got "
            "`from` and `to`"
        )
    return _range(key, table, sampled=sampled)


def _table(written: object) -> AxisTable:
    """An axis' table, before its values are read."""
    if not isinstance(written, dict):
        raise InputError(
            "must be a table, {values = [..]} or {from = .., to = .., steps = ..}; got "
            f"{shown(written)}"
        )
    known = [field.alias or name for name, field in AxisTable.model_fields.items()]
    for name in written:
        if name not in known:
            raise InputError(
                f"`{shown(name)[1:-1]}` is not a key of an axis; got {shown(written[name])}"
                f"{did_you_mean(name, known)}"
            )
    try:
        table = check(AxisTable, written)
    except InputError as error:
        raise InputError(str(error).removeprefix(f"{error.key}: ")) from None
    _refuse_both_or_neither(written)
    return table


def _refuse_both_or_neither(written: dict[str, Any]) -> None:
    """Refuse an axis that has both a list of values and a range, or neither."""
    if "values" in written:
        for name in ("from", "to", "steps", "scale"):
            if name in written:
                raise InputError(
                    f"`{name}` and `values` exclude each other: list the values or give their "
                    "range; got both"
                )
        return
    for name in ("from", "to"):
        if name not in written:
            raise InputError(
                f"`{name}` must be given, or `values` in place of `from` and `to`; got nothing"
            )


def _range(key: Key, table: AxisTable, *, sampled: bool) -> Axis:
    low, high = _end(key, "from", table.start), _end(key, "to", table.to)
    if low >= high:
        raise InputError(
            f"`to` must be larger than `from` ({shown(table.start)}); got {shown(table.to)}"
        )
    if table.scale == "log" and low <= 0.0:
        raise InputError(f"`from` must be positive with scale = 'log'; got {shown(table.start)}")
    steps, scale = _steps(table.steps, sampled=sampled), table.scale or "linear"
    axis = Axis(**vars(key), listed=(), low=low, high=high, steps=steps, scale=scale)
    if key.whole and steps:
        _refuse_meeting(axis)
    return axis


def _end(key: Key, name: str, value: object) -> float:
    """An end of a range in SI."""
    try:
        return float(key.read(value))
    except InputError as error:
        raise InputError(f"`{name}`: {error}") from None


def _steps(steps: int | None, *, sampled: bool) -> int:
    if sampled and steps is not None:
        raise InputError(
            "`steps` must be absent with a [sample] table, which sets how many values are drawn; "
            f"got {steps}"
        )
    if not sampled and steps is None:
        raise InputError(
            "`steps`, the number of values, must be given without a [sample] table; got nothing"
        )
    return steps or 0


def _refuse_meeting(axis: Axis) -> None:
    """Refuse steps so close that they would meet on one whole number."""
    low, high = int(axis.low), int(axis.high)
    if axis.steps <= high - low + 1 and len(np.unique(axis.values)) == axis.steps:
        return
    raise InputError(
        f"`steps` must be few enough for each to be a whole number of its own (from {low} to "
        f"{high}, {axis.scale}); got {axis.steps}"
    )


def _listed(key: Key, values: Sequence[object]) -> Axis:
    """An axis of listed values."""
    found: dict[tuple[type, Value], object] = {}
    for written in values:
        value = key.read(written)
        same = (type(value), value)
        if same in found:
            both = dict.fromkeys(map(shown, (found[same], written)))
            raise InputError(
                f"`values` must differ; got {' and '.join(both)}{' twice' * (len(both) == 1)}"
            )
        found[same] = written
    listed = tuple(value for _, value in found)
    numbers = [float(value) for value in listed] if key.numeric else [0.0]
    low, high = min(numbers), max(numbers)
    return Axis(**vars(key), listed=listed, low=low, high=high, steps=0, scale="linear")
