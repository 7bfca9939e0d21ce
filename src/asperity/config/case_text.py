"""A case as text: canonical TOML with SI units, and the commented template."""

from __future__ import annotations

import inspect
import json
import re
import textwrap
from collections.abc import Mapping
from typing import Any

from pydantic import BaseModel
from pydantic.fields import FieldInfo

from asperity.config.problems import place, tables_of
from asperity.errors import InputError

_BARE = re.compile(r"[A-Za-z0-9_-]+")


def toml(model: BaseModel) -> str:
    """A model as TOML: values first, then its tables; every quantity with its SI unit."""
    return text_of(written(model))


def written(model: BaseModel) -> dict[str, Any]:
    """The tables of a model as `tomllib.loads` gives them, every quantity with its SI unit."""
    found: dict[str, Any] = {}
    for name, field in ordered(type(model)).items():
        value, unit = getattr(model, name), unit_of(field)
        if isinstance(value, BaseModel):
            value = written(value)
        elif isinstance(value, dict):
            value = {inner: written(table) for inner, table in value.items()} or None
        elif isinstance(value, float) and unit not in ("", "1"):
            value = f"{value!r} {unit}"
        if value is not None:
            found[field.alias or name] = value
    return found


def text_of(tables: Mapping[str, Any]) -> str:
    """The tables of a case as TOML, values as they were given; keys that are None are left out.

    Parameters
    ----------
    tables : mapping
        As :func:`tomllib.loads` gives them.
    """
    return "\n".join(_given(tables, ())).strip() + "\n"


def _given(tables: Mapping[str, Any], around: tuple[str, ...]) -> list[str]:
    inner = {key: value for key, value in tables.items() if isinstance(value, Mapping)}
    lines = [
        f"{_key(key)} = {literal(value)}"
        for key, value in tables.items()
        if key not in inner and value is not None
    ]
    if around and (lines or not inner):
        lines = [f"[{'.'.join(_key(part) for part in around)}]", *lines]
    rest = [line for key, table in inner.items() for line in _given(table, (*around, key))]
    return [*lines, "", *rest] if lines else rest


def ordered(model: type[BaseModel]) -> dict[str, FieldInfo]:
    """Fields of a model, those that it declares itself before the inherited ones."""
    fields = model.model_fields
    own = [name for name in inspect.get_annotations(model) if name in fields]
    return {name: fields[name] for name in (*own, *(f for f in fields if f not in own))}


def unit_of(field: FieldInfo) -> str:
    """SI unit of a field's values; ``"1"`` for plain numbers, ``""`` for text and switches."""
    extra = field.json_schema_extra
    return str(extra.get("unit", "")) if isinstance(extra, dict) else ""


def literal(value: object) -> str:
    """A value in TOML's notation."""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, list):
        return f"[{', '.join(map(literal, value))}]"
    if isinstance(value, str):
        # JSON's escapes are TOML's too, but for the one that JSON leaves out.
        return json.dumps(value, ensure_ascii=False).replace("\x7f", "\\u007f")
    return repr(value)


def _key(name: str) -> str:
    return name if _BARE.fullmatch(name) else literal(name)


def change(tables: dict[str, Any], changes: Mapping[str, object]) -> None:
    """Give tables other values at dotted keys; None removes a key."""
    for dotted, value in changes.items():
        *above, last = place(dotted)
        table = tables
        for part in above:
            table = table.setdefault(part, {})
            if not isinstance(table, dict):
                raise InputError(f"`{dotted}` is not a key: `{part}` is no table", key=dotted)
        if value is None:
            table.pop(last, None)
        else:
            table[last] = value


def commented(model: type[BaseModel], heading: str) -> str:
    """A commented file with every key of a model, from the models' own descriptions.

    Keys that a case may do without stand behind a ``#``.
    """
    lines = [f"# {line}" for line in heading.splitlines()]
    plain = {n: f for n, f in ordered(model).items() if not tables_of(f.annotation)}
    lines += _commented_keys(plain)
    for name, field in ordered(model).items():
        for table in tables_of(field.annotation):
            lines += ["", *_commented_table(name, field, table)]
    return "\n".join(lines) + "\n"


def _commented_table(name: str, field: FieldInfo, table: type[BaseModel]) -> list[str]:
    about = [f"# {line}" for line in textwrap.wrap(inspect.getdoc(table) or "", 90)]
    if "dict" in str(field.annotation):
        return [*about, f"# [{name}.NAME]", *_commented_keys(ordered(table), active=False)]
    extra = field.json_schema_extra
    if isinstance(extra, dict) and extra.get("rare"):
        return [*about, f"# [{name}]", *_commented_keys(ordered(table), active=False)]
    return [*about, f"[{name}]", *_commented_keys(ordered(table))]


def _commented_keys(fields: Mapping[str, FieldInfo], *, active: bool = True) -> list[str]:
    lines = []
    for name, field in fields.items():
        extra = field.json_schema_extra
        shown = isinstance(extra, dict) and extra.get("shown")
        set_here = field.is_required() or shown or field.get_default() is not None
        example = literal((field.examples or [None])[0])
        start = f"{'' if active and set_here else '# '}{field.alias or name} = {example}"
        line = f"{start:<38}  # {field.description}"
        lines += [line] if len(line) <= 100 else [f"# {field.description}", start]
    return lines
