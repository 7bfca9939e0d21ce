"""What a choice on the page asks for besides: missing keys, and what would mend a refused case."""

from __future__ import annotations

import functools
import re
from collections.abc import Iterator, Sequence
from typing import Any

from asperity.config import Case
from asperity.config.problems import check, place
from asperity.errors import InputError
from asperity.web.form import form

Tables = dict[str, Any]

_NAMED = re.compile(r"`([a-z_]+)`")
"""A key in a message."""

_MOST_FILLED = 12
"""Keys that one choice may fill in."""

_MOST_MENDED = 6
"""Problems that a remedy is looked for."""


def completed(tables: Tables, before: Tables) -> Tables:
    """The tables with the keys that are missing since a choice, at the values of their examples.

    Parameters
    ----------
    tables, before
        The case after the choice and before it. What was missing before stays missing.
    """
    known = {one.key for one in _problems(before)}
    for _ in range(_MOST_FILLED):
        missing = [one.key for one in _problems(tables) if one.key not in known]
        filled = next((new for key in missing if (new := _filled(tables, key)) is not None), None)
        if filled is None:
            break
        tables = filled
    return tables


def remedies(tables: Tables) -> list[dict[str, Any]]:
    """For problems of a case one other value each that mends them.

    Returns
    -------
    A list of ``{at, key, value}``: the key that is refused, and the key and the value that mend
    it; a value of None takes the key, or the table, away.
    """
    found = []
    for problem in _problems(tables)[:_MOST_MENDED]:
        best: tuple[int, str, Any] | None = None
        for key, value in _changes(tables, problem):
            left = _problems(_with(tables, key, value))
            if problem.key in {one.key for one in left} or (best and best[0] <= len(left)):
                continue
            best = len(left), key, value
        if best is not None:
            found.append({"at": problem.key, "key": best[1], "value": best[2]})
    return found


def _problems(tables: Tables) -> tuple[InputError, ...]:
    """All that is wrong with a case, but for what it says of output."""
    try:
        check(Case, {key: value for key, value in tables.items() if key != "output"})
    except InputError as error:
        return error.problems
    return ()


def _filled(tables: Tables, key: str | None) -> Tables | None:
    """The tables with a key that is not there at its example; None where that is no help."""
    about = _keys().get(_place(key or ""))
    if key is None or about is None or about["example"] is None or _given(tables, key) is not None:
        return None
    new = _with(tables, key, about["example"])
    return None if key in {one.key for one in _problems(new)} else new


def _changes(tables: Tables, problem: InputError) -> Iterator[tuple[str, Any]]:
    """What might mend a problem, as key and value; a value of None takes the key away.

    Every other choice of the key at fault, 'none' last; to leave the key, or the table, out; a key
    that is not there and that the message names, at its example.
    """
    if problem.key is None:
        return
    key, about = problem.key, _keys().get(_place(problem.key))
    given = _given(tables, key)
    if about is not None:
        choices = [choice for choice in about["choices"] if choice != given]
        yield from ((key, choice) for choice in sorted(choices, key=lambda one: one == "none"))
    if given is not None and (about is None or not about["needed"]):
        yield key, None
    table = key.rpartition(".")[0]
    for name in dict.fromkeys(_NAMED.findall(str(problem))):
        other = _keys().get((table, name))
        if other is not None and _given(tables, f"{table}.{name}") is None:
            yield f"{table}.{name}", other["example"]


@functools.cache
def _keys() -> dict[tuple[str, str], dict[str, Any]]:
    """What the form knows of each key, by table and key."""
    return {(table["name"], key["key"]): key for table in form() for key in table["keys"]}


def _place(key: str) -> tuple[str, str]:
    """Table and key of a dotted key; of a material of one's own without its name."""
    return place(key)[0], place(key)[-1]


def _given(tables: Tables, key: str) -> Any:
    """The value of a key, or a table; None where there is none."""
    found: Any = tables
    for part in place(key):
        found = found.get(part) if isinstance(found, dict) else None
    return found


def _with(tables: Tables, key: str, value: Any) -> Tables:
    """The tables with another value of a key, or of a table; None takes it away."""
    return _changed(tables, place(key), value)


def _changed(tables: Any, path: Sequence[str], value: Any) -> Tables:
    first, *rest = path
    given: Tables = tables if isinstance(tables, dict) else {}
    if rest:
        value = _changed(given.get(first), rest, value)
    if value is None:
        return {one: each for one, each in given.items() if one != first}
    return {**given, first: value}
