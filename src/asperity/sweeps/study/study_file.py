"""A study file as text -> its tables, with every problem of the text in one line."""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import Annotated, Any

from pydantic import BeforeValidator, Field

from asperity.config import case_file
from asperity.config.base_table import Table
from asperity.config.fields import Number
from asperity.config.problems import check, did_you_mean
from asperity.errors import InputError
from asperity.sweeps.study.columns import DEFAULT_KEEP
from asperity.sweeps.study.samples import Sample
from asperity.units import shown

_DEPTH = 3  # of materials.NAME.key, the deepest of a case


def _known(version: object) -> object:
    if type(version) is not int or version != 1:
        newer = isinstance(version, int) and version > 1
        why = ", a newer program's" if newer else ""
        raise InputError(
            f"`schema` must be 1, the only version of a study that this program knows; got "
            f"{shown(version)}{why}"
        )
    return version


def _names(value: object) -> object:
    if not isinstance(value, list) or not all(isinstance(name, str) for name in value):
        rule = "must be a list of measures' names, such as ['captured', 'restitution']"
        raise InputError(f"`keep` {rule}; got {shown(value)}")
    return value


class StudyTable(Table):
    """A study file's keys and tables, before base and axes are looked up."""

    schema_version: Annotated[int, BeforeValidator(_known)] = Field(1, alias="schema")
    base: Any
    name: str | None = None
    keep: Annotated[list[str], BeforeValidator(_names)] = Field(
        default_factory=lambda: list(DEFAULT_KEEP)
    )
    keep_impacts: Annotated[int, Number("[1, 100000]", whole=True)] = 1
    motions: bool = False
    axes: dict[str, Any]
    sample: Sample | None = None


def tables(text: str, file: str | None) -> StudyTable:
    """The tables of a study's text.

    Raises
    ------
    InputError
        One line that names file, key, line, rule and value.
    """
    found = case_file.tables(text, file, "a study")
    for key, value in found.items():
        options = [field.alias or name for name, field in StudyTable.model_fields.items()]
        if key not in options:
            got = "" if isinstance(value, dict) else f"; got {shown(value)}"
            rule = f"`{shown(key)[1:-1]}` is not a key or table of a study{got}"
            raise _unusable(file, rule + did_you_mean(key, options), key)
    if "base" not in found:
        rule = "`base`, a built-in case or a case file, must be given; got nothing"
        raise _unusable(file, rule, "base")
    return check(StudyTable, found, source=text, file=file)


def axes(table: StudyTable, text: str) -> list[tuple[str, str, Any]]:
    """The axes: dotted key, the words that name it in a message, and what stands there.

    Raises
    ------
    InputError
        Where there is none, or one stands twice.
    """
    found: dict[str, tuple[str, str, Any]] = {}
    for key, value in _flat("", table.axes):
        where = _where(key, text)
        if key in found:
            raise InputError(f"{where}: must be given once; got two", key=f"axes.{key}")
        found[key] = key, where, value
    if not found:
        raise InputError("[axes] must have at least one axis; got none", key="axes")
    return list(found.values())


def _flat(above: str, table: dict[str, Any], depth: int = 1) -> Iterator[tuple[str, Any]]:
    """Axes by dotted key: ``roughness.rms_height = ..`` without quotes is a table of tables."""
    for key, value in table.items():
        inner = value.values() if isinstance(value, dict) else ()
        if inner and depth < _DEPTH and all(isinstance(each, dict) for each in inner):
            yield from _flat(f"{above}{key}.", value, depth + 1)
        else:
            yield f"{above}{key}", value


def _where(key: str, text: str) -> str:
    """An axis' place: its key, and the line on which that stands."""
    short = key if len(key) <= 60 else f"{key[:57]}..."
    stands = re.compile(rf"""\s*(\[\s*axes\s*\.\s*)?["']?{re.escape(key)}["']?\s*[]=]""")
    lines = enumerate(text.split("\n"), start=1)
    line = next((number for number, line in lines if stands.match(line)), None)
    return f'axes."{short}"' + (f" (line {line})" if line else "")


def _unusable(file: str | None, rule: str, key: str) -> InputError:
    return InputError(f"{file}: {rule}" if file else rule, file=file, key=key)
