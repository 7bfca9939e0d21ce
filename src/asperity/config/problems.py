"""What is wrong with a case, in one line that names file, key, rule and value."""

from __future__ import annotations

import difflib
import re
from collections.abc import Collection, Iterable, Mapping
from typing import Any, TypeVar, get_args

from pydantic import BaseModel, ValidationError

from asperity.config.old_words import new_name
from asperity.errors import InputError
from asperity.units import shown

Model = TypeVar("Model", bound=BaseModel)
Place = tuple[str, ...]

_PART = r"""(?:[A-Za-z0-9_-]+|"(?:[^"\\]|\\.)*"|'[^']*')"""
_KEY = re.compile(rf"\s*({_PART}(?:\s*\.\s*{_PART})*)\s*=")
_HEADER = re.compile(rf"\s*\[\[?\s*({_PART}(?:\s*\.\s*{_PART})*)\s*\]")
_PARTS = re.compile(_PART)


def did_you_mean(word: str, options: Iterable[str]) -> str:
    """`` - did you mean 'rms_height'?``, or nothing where no option is close to the word.

    Of a word that was renamed it says what it is called now.
    """
    options = list(options)
    renamed = new_name(word)
    if renamed != word and renamed in options:
        return f" - it is called '{renamed}' now"
    near = nearest(word, options)
    return "" if near is None else f" - did you mean '{near}'?"


def among(
    name: str,
    known: Collection[str],
    rule: str,
    *,
    key: str | None = None,
    file: str | None = None,
) -> None:
    """Refuse a name that is none of those known, with the one that was meant.

    Parameters
    ----------
    name
        What was given.
    known
        The names that there are.
    rule
        What it must be.
    key, file
        What is at fault, as `InputError` takes it.

    Raises
    ------
    InputError
        Where it is none of them.
    """
    if name not in known:
        hint = did_you_mean(str(name), known)
        raise InputError(f"{rule}; got {shown(name)}{hint}", key=key, file=file)


def nearest(word: str, options: Iterable[str]) -> str | None:
    """The option that is close to a word; None where none is."""
    by_lower = {option.lower(): option for option in options}
    close = difflib.get_close_matches(word[:60].lower(), by_lower, n=1)
    return by_lower[close[0]] if close else None


def check(model: type[Model], table: Any, *, source: str = "", file: str | None = None) -> Model:
    """A table's values as a model.

    Parameters
    ----------
    model : type
        Model to make.
    table : dict
        Keys and values, as tomllib gives them.
    source : str
        Text that the table was read from, for line numbers.
    file : str, optional
        Name of the file, for the message.

    Raises
    ------
    InputError
        With the first problem: an unknown key before a bad value before a missing key, since a
        misspelt key is missing too. The others stand in its ``also``.
    """
    try:
        return model.model_validate(table)
    except ValidationError as error:
        lines = _line_numbers(source)
        found = error.errors(include_url=False)
    order = {"extra_forbidden": 0, "missing": 2}
    found.sort(key=lambda e: (order.get(e["type"], 1), _line(lines, _places(e)[0]) or 0))
    refused = [
        _refusal(place, message, _line(lines, place), file)
        for error in found
        for place, message in zip(_places(error), _messages(model, error), strict=True)
    ]
    raise InputError(str(refused[0]), file=file, key=refused[0].key, also=refused[1:])


def _refusal(place: Place, message: str, line: int | None, file: str | None) -> InputError:
    """A problem with its file, its key and its line in front."""
    key = ".".join(part if len(part) <= 60 else f"{part[:57]}..." for part in place)
    where = f"{key} (line {line})" if line and key else key
    return InputError(": ".join(part for part in (file, where, message) if part),
                      file=file, key=key or None)  # fmt: skip


def _causes(error: Any) -> tuple[InputError | None, ...]:
    """The rules of ours that one of pydantic's errors is about; None for a rule of its own."""
    cause = error.get("ctx", {}).get("error")
    return cause.problems if isinstance(cause, InputError) else (None,)


def _places(error: Any) -> list[Place]:
    """Where one of pydantic's errors is, down to the keys that rules between keys name."""
    around = tuple(str(part) for part in error["loc"])
    keys = (cause.key if cause is not None else None for cause in _causes(error))
    return [(*around, *(key.split(".") if key else ())) for key in keys]


def _messages(model: type[BaseModel], error: Any) -> list[str]:
    """Rules and values of one of pydantic's errors."""
    return [str(c) if c is not None else _message(model, error) for c in _causes(error)]


def _message(model: type[BaseModel], error: Any) -> str:
    """Rule and value of one of pydantic's own errors."""
    kind, place, value = error["type"], _places(error)[0], error["input"]
    name = place[-1] if place else "case"
    if kind == "extra_forbidden":
        return _unknown(model, place, value)
    if kind == "missing":
        return f"the table [{name}] is missing" if len(place) == 1 else f"`{name}` is missing"
    expected = error.get("ctx", {}).get("expected", "")
    rules = {
        "literal_error": f"must be {'one of ' if ' or ' in expected else ''}{expected}",
        "bool_type": "must be true or false",
        "string_type": "must be text in quotes",
        "model_type": "must be a table",
        "dict_type": "must be a table of tables",
    }
    hint = ""
    if kind == "literal_error" and isinstance(value, str):
        hint = did_you_mean(value, re.findall(r"'([^']*)'", expected))
    rule = rules.get(kind, error["msg"])
    return f"`{name}` {rule}; got {shown(value)}{hint}"


def _unknown(model: type[BaseModel], place: Place, value: object) -> str:
    """What to say of an unknown key: the rule, the value, and the key that was meant."""
    name, above = place[-1], place[:-1]
    owner = table_of(model, above)
    keys = [field.alias or key for key, field in owner.model_fields.items()] if owner else []
    what = f"a key of [{'.'.join(above)}]" if above else "a key or table of a case"
    got = "" if isinstance(value, dict) else f"; got {shown(value)}"
    hint = did_you_mean(name, keys)
    if not hint:
        homes = [
            key
            for key in model.model_fields
            if (table := table_of(model, (key,))) is not None and name in table.model_fields
        ]
        hint = f" - it belongs in [{homes[0]}]" if homes else ""
    return f"`{shown(name)[1:-1]}` is not {what}{got}{hint}"


def table_of(model: type[BaseModel], place: Place) -> type[BaseModel] | None:
    """The model of the table at a place; None where there is none."""
    for part in place:
        field = model.model_fields.get(part)
        if field is None:
            return None
        inside = tables_of(field.annotation)
        if not inside:
            return None
        model = inside[0]
        if "dict" in str(field.annotation):
            return model
    return model


def place(key: str) -> Place:
    """The tables around a dotted key, and the key; the name of a material may hold dots itself."""
    table, _, rest = key.partition(".")
    material, dot, last = rest.rpartition(".")
    return (table, material, last) if table == "materials" and dot else tuple(key.split("."))


def tables_of(annotation: Any) -> list[type[BaseModel]]:
    """The models within a type, e.g. `Roughness` in ``Roughness | None``."""
    kinds = [part for part in parts_of(annotation) if isinstance(part, type)]
    return [kind for kind in kinds if issubclass(kind, BaseModel)]


def parts_of(annotation: Any) -> list[Any]:
    """A type and all that it is made of, down to what its parts are annotated with."""
    return [annotation, *(inner for part in get_args(annotation) for inner in parts_of(part))]


def _line(lines: Mapping[Place, int], place: Place) -> int | None:
    """Line of a key, or of the innermost table around it that has one."""
    for end in range(len(place), 0, -1):
        if place[:end] in lines:
            return lines[place[:end]]
    return None


def _line_numbers(source: str) -> dict[Place, int]:
    """Line on which each key and each table of a TOML text first stands."""
    lines: dict[Place, int] = {}
    table: Place = ()
    for number, line in enumerate(source.split("\n"), start=1):
        if header := _HEADER.match(line):
            table = _unquoted(header.group(1))
            lines.setdefault(table, number)
        elif key := _KEY.match(line):
            place = table + _unquoted(key.group(1))
            for end in range(len(table) + 1, min(len(place), len(table) + 3) + 1):
                lines.setdefault(place[:end], number)
    return lines


def _unquoted(dotted: str) -> Place:
    parts = _PARTS.findall(dotted)
    return tuple(part[1:-1] if part[0] in "\"'" else part for part in parts)
