"""A study file as text -> its tables, with every problem of the text in one line."""

from __future__ import annotations

import re
import stat
import tomllib
from collections.abc import Iterator
from pathlib import Path
from typing import Annotated, Any

from pydantic import BeforeValidator, Field

from asperity.case import SIZE_LIMIT
from asperity.case.fields import Number
from asperity.case.problems import check, did_you_mean
from asperity.case.table import Table
from asperity.errors import InputError
from asperity.studies.sweep.layout import DEFAULT_KEEP
from asperity.studies.sweep.sampling import Sample
from asperity.units import shown

LINE_LIMIT = 1000
"""Longest line of a study [characters]: the parser's time grows with its square."""

_DEPTH = 3  # of materials.NAME.key, the deepest of a case

_PLACE = re.compile(r"\s*\(at (?:line (\d+), column (\d+)|end of document)\)$")


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


def content(path: str) -> str:
    """Text of a study file, which is never read beyond 1 MiB.

    Raises
    ------
    InputError
        Where it cannot be read, or is no text.
    """
    try:
        status = Path(path).stat()
        if stat.S_ISDIR(status.st_mode):
            raise _unusable(path, "a study must be a file; got a folder")
        if not stat.S_ISREG(status.st_mode):
            raise _unusable(path, "a study must be a regular file; got a device, pipe or socket")
        if status.st_size > SIZE_LIMIT:
            raise _unusable(path, f"a study must be at most 1 MiB; got {status.st_size} bytes")
        with Path(path).open("rb") as stream:
            return stream.read(SIZE_LIMIT + 1).decode("utf-8-sig")
    except OSError as error:
        raise _unusable(path, f"cannot be read: {error.strerror or error}") from None
    except UnicodeDecodeError as error:
        rule = f"a study must be UTF-8 text; got a binary file (byte {error.start + 1})"
        raise _unusable(path, rule) from None
    except InputError:
        raise
    except ValueError:  # a null character
        raise _unusable(path, "cannot be read: no path of a file") from None


def tables(text: str, file: str | None) -> StudyTable:
    """The tables of a study's text.

    Raises
    ------
    InputError
        One line that names file, key, line, rule and value.
    """
    found = _parsed(text, file)
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


def refuse_size(text: str, file: str | None) -> None:
    """Refuse a text that is too long, or has too long a line.

    Raises
    ------
    InputError
        With the limit.
    """
    if len(text) > SIZE_LIMIT or len(text.encode(errors="replace")) > SIZE_LIMIT:
        raise _unusable(file, f"a study must be at most 1 MiB; got {len(text)} characters")
    longest = max(len(line) for line in text.split("\n"))
    if longest > LINE_LIMIT:
        rule = f"a line must be at most {LINE_LIMIT} characters (a list can have several lines)"
        raise _unusable(file, f"{rule}; got one of {longest}")


def _parsed(text: str, file: str | None) -> dict[str, Any]:
    refuse_size(text, file)
    if "\0" in text:
        raise _unusable(file, "a study must be text; got a binary file")
    if not text.strip():
        raise _unusable(file, "a study must have tables; got an empty file")
    try:
        return tomllib.loads(text)
    except RecursionError:
        raise _unusable(file, "not TOML: values nested too deeply") from None
    except tomllib.TOMLDecodeError as error:
        raise _unusable(file, _syntax(str(error), text)) from None
    except ValueError:  # Python reads no whole number of thousands of digits
        raise _unusable(file, "not TOML: a number of too many digits") from None


def axes(table: StudyTable, text: str, file: str | None) -> list[tuple[str, str, Any]]:
    """The axes: dotted key, the words that name it in a message, and what stands there.

    Raises
    ------
    InputError
        Where there is none, or one stands twice.
    """
    found: dict[str, tuple[str, str, Any]] = {}
    for key, value in _flat("", table.axes):
        where = _where(key, text, file)
        if key in found:
            raise InputError(f"{where}: must be given once; got two", file=file, key=f"axes.{key}")
        found[key] = key, where, value
    if not found:
        raise _unusable(file, "[axes] must have at least one axis; got none", "axes")
    return list(found.values())


def _flat(above: str, table: dict[str, Any], depth: int = 1) -> Iterator[tuple[str, Any]]:
    """Axes by dotted key: ``roughness.rms_height = ..`` without quotes is a table of tables."""
    for key, value in table.items():
        inner = value.values() if isinstance(value, dict) else ()
        if inner and depth < _DEPTH and all(isinstance(each, dict) for each in inner):
            yield from _flat(f"{above}{key}.", value, depth + 1)
        else:
            yield f"{above}{key}", value


def _where(key: str, text: str, file: str | None) -> str:
    """An axis' place: file, key, and the line on which the key stands."""
    short = key if len(key) <= 60 else f"{key[:57]}..."
    stands = re.compile(rf"""\s*(\[\s*axes\s*\.\s*)?["']?{re.escape(key)}["']?\s*[]=]""")
    lines = enumerate(text.split("\n"), start=1)
    line = next((number for number, line in lines if stands.match(line)), None)
    place = f'axes."{short}"' + (f" (line {line})" if line else "")
    return f"{file}: {place}" if file else place


def _unusable(file: str | None, rule: str, key: str | None = None) -> InputError:
    return InputError(f"{file}: {rule}" if file else rule, file=file, key=key)


def _syntax(message: str, source: str) -> str:
    """The parser's message with the line in front."""
    place = _PLACE.search(message)
    rule = _PLACE.sub("", message)
    if place is None:
        return f"not TOML: {rule}"
    line = int(place.group(1)) if place.group(1) else source.count("\n") + 1
    column = f", column {place.group(2)}" if place.group(2) else ""
    return f"not TOML (line {line}{column}): {rule}"
