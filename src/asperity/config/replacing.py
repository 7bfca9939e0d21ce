"""A case with other values or another name: values from Python, as numbers in SI or as text."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any, TypeVar

from pydantic import BaseModel

from asperity.config import case_text, problems
from asperity.config.tables import CaseTables
from asperity.errors import InputError
from asperity.units import example, shown

_Tables = TypeVar("_Tables", bound=CaseTables)


def named(case: _Tables, name: str) -> _Tables:
    """The case under another name, which is no part of what makes two cases equal."""
    copy = case.model_copy()
    copy.__dict__["name"] = name  # where a cached property keeps its value, which no field does
    return copy


def replaced(case: _Tables, changes: Mapping[str, object]) -> _Tables:
    """The case with other values, under the same name; see `Case.replace`.

    Raises
    ------
    InputError
        Where a key is unknown or a value breaks a rule.
    """
    if not isinstance(changes, Mapping):
        raise InputError(
            "`changes` must be values by their dotted key, such as {'body.radius': 1e-5}; got "
            f"{shown(changes)}"
        )
    model = type(case)
    tables = case_text.written(case)
    case_text.change(
        tables, {key: as_written(model, _key(key), value) for key, value in changes.items()}
    )
    return named(problems.check(model, tables), case.name)


def as_written(model: type[BaseModel], key: str, value: object) -> object:
    """A value from Python as it stands in a case file.

    Parameters
    ----------
    model : type
        The case's model.
    key : str
        Dotted key of the value, or of a table.
    value : object
        Text as in a file; a number, in SI where the key has a unit; a table of such values.

    Raises
    ------
    InputError
        Where a key with a unit is given a switch, or what is no finite number.
    """
    if isinstance(value, Mapping):
        return {
            _key(inner): as_written(model, f"{key}.{inner}", each) for inner, each in value.items()
        }
    try:
        return with_unit(value, _unit(model, key), key.rpartition(".")[2])
    except InputError as error:
        raise InputError(f"{key}: {error}", key=key) from None


def with_unit(value: object, unit: str, name: str) -> object:
    """A value from Python as text with a unit, where it is a number and the key has one.

    Parameters
    ----------
    value : object
        A number in SI, NumPy's and JAX's scalars too; anything else comes back as it is.
    unit : str
        SI unit of the key; "1" for plain numbers, "" for text and switches.
    name : str
        What to call the value in messages.

    Raises
    ------
    InputError
        Where a key with a unit is given a switch, or what is no finite number.
    """
    value = _plain(value)
    if unit in ("", "1"):
        return value
    if isinstance(value, bool):
        raise InputError(
            f"`{name}` must be a number in {unit}, or text with a unit such as "
            f"'{example(unit)}'; got {value}"
        )
    if not isinstance(value, int | float):
        return value
    try:
        number = float(value)
    except OverflowError:  # a whole number beyond any float
        number = math.inf
    if not math.isfinite(number):
        raise InputError(f"`{name}` must be a finite number; got {shown(value)} {unit}")
    return f"{number!r} {unit}"


def _plain(value: object) -> Any:
    """A scalar of NumPy's or of JAX's as Python's own number, switch or text; else the value."""
    item = getattr(value, "item", None)
    return item() if callable(item) and getattr(value, "shape", None) == () else value


def _key(key: object) -> str:
    if not isinstance(key, str):
        raise InputError(f"a key must be text, such as 'body.radius'; got {shown(key)}")
    return key


def _unit(model: type[BaseModel], key: str) -> str:
    """SI unit of a key, as of a field; nothing of an unknown key."""
    *above, last = problems.place(key)
    table = problems.table_of(model, tuple(above))
    field = None if table is None else table.model_fields.get(last)
    return "" if field is None else case_text.unit_of(field)
