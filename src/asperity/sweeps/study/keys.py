"""The keys of a case that a study can vary, found from the case's own schema."""

from __future__ import annotations

import functools
import typing
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

from pydantic import BaseModel, create_model
from pydantic.fields import FieldInfo

from asperity.config.base_table import Table
from asperity.config.case_text import unit_of
from asperity.config.key_labels import label
from asperity.config.problems import check, did_you_mean, parts_of, place, table_of, tables_of
from asperity.config.schema import Case
from asperity.errors import InputError
from asperity.units import shown

_NOT_VARIED = {
    "schema": "the version of the case's schema, of which there is one",
    "output": "what a run writes to its folder, which a study does not do",
}

Value = float | int | str | bool
"""A value of a key: SI float, whole number, text or switch."""


@dataclass(frozen=True)
class Key:
    """A key of a case, with the rules of its values.

    Attributes
    ----------
    key
        Dotted key, e.g. "roughness.rms_height".
    unit
        SI unit of the values; "1" for plain numbers, "" for text and switches.
    label
        What it is, in a few words.
    whole
        Whether the values are whole numbers.
    """

    key: str
    unit: str
    label: str
    whole: bool

    @property
    def numeric(self) -> bool:
        """Whether the values are numbers, and a range of them has a meaning."""
        return self.unit != ""

    @property
    def last(self) -> str:
        """The key in its table, e.g. "rms_height"."""
        return self.key.rpartition(".")[2]

    def read(self, value: object) -> Value:
        """A value as it stands in a case file, in SI.

        Raises
        ------
        InputError
            With the rule that it breaks: the same as in a case file.
        """
        try:
            table = check(_table_of(self.key), {self.last: value})
        except InputError as error:
            rule = str(error).removeprefix(f"{self.last}: ")
            if error.key != self.last:  # one kind of value of several
                rule = f"`{self.last}` must be text or a whole number; got {shown(value)}"
            raise InputError(rule) from None
        result: Value = getattr(table, self.last)
        return result

    def written(self, value: Value) -> Value:
        """A value in SI as it stands in a case file; `read` gives the same value back."""
        return value if self.unit in ("", "1") else f"{value!r} {self.unit}"


def find(name: str, materials: Iterable[str] = ()) -> Key:
    """The key of a dotted name.

    Parameters
    ----------
    name : str
        E.g. "roughness.rms_height", or "materials.glass.density" for a material of the case.
    materials : iterable of str
        Names of the base case's own materials.

    Raises
    ------
    InputError
        Where a case has no such key, or no study can vary it.
    """
    table = name.partition(".")[0]
    if table in _NOT_VARIED:
        raise InputError(f"must not go over `{name}`: it is {_NOT_VARIED[table]}")
    own, field = tuple(materials), _field(name)
    if field is None:
        raise InputError(_unknown(name, own))
    material = ".".join(place(name)[1:-1])
    if table == "materials" and material not in own:
        raise InputError(
            f"must go over a material of the base case, which has no [materials.{material}]"
            f"{did_you_mean(material, own)}"
        )
    inside, unit = _types(field), unit_of(field)
    if list in inside:
        raise InputError(
            f"must not go over `{name}`, whose value is a list; write a study for each"
        )
    return Key(name, unit, label(name), unit != "" and int in inside)


def known(materials: Iterable[str] = ()) -> list[str]:
    """Dotted names of all keys that a study can vary."""
    found = [
        f"{table}.{key}"
        for table, model in _tables().items()
        for key, field in model.model_fields.items()
        if table not in (*_NOT_VARIED, "materials") and list not in _types(field)
    ]
    own = _tables()["materials"].model_fields
    return found + [f"materials.{name}.{key}" for name in materials for key in own]


def _unknown(name: str, materials: tuple[str, ...]) -> str:
    """What to say of a name that is no key of a case."""
    names = known(materials)
    if name in _tables():
        return f"must go over a key; `{name}` is a table of a case"
    same = [each for each in names if each.rpartition(".")[2] == name.rpartition(".")[2]]
    hint = f" - did you mean '{same[0]}'?" if len(same) == 1 else did_you_mean(name, names)
    return f"must go over a key of a case, such as 'body.radius'; got {shown(name)}{hint}"


@functools.cache
def _tables() -> dict[str, type[BaseModel]]:
    """The tables of a case by name; for [materials.NAME] that of one material."""
    fields = Case.model_fields.items()
    return {name: inside[0] for name, field in fields if (inside := tables_of(field.annotation))}


def _field(name: str) -> FieldInfo | None:
    """Field of a dotted key; None where there is none."""
    *above, last = place(name)
    model = table_of(Case, tuple(above)) if above else None
    return None if model is None else model.model_fields.get(last)


@functools.cache
def _table_of(name: str) -> type[BaseModel]:
    """A model of one key alone, that checks its values as a case's table does."""
    field = _field(name)
    assert field is not None
    kind: Any = field.annotation
    for rule in field.metadata:
        kind = typing.Annotated[kind, rule]
    fields: dict[str, Any] = {name.rpartition(".")[2]: (kind, ...)}
    return create_model("One", __base__=Table, **fields)


def _types(field: FieldInfo) -> list[Any]:
    """Python's types within that of a field."""
    return [typing.get_origin(part) or part for part in parts_of(field.annotation)]
