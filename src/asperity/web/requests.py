"""What a request holds: checked, bounded, and as a case."""

from __future__ import annotations

import json
from collections.abc import Iterable
from dataclasses import dataclass, field
from typing import Any, NoReturn

from asperity.config import Case
from asperity.config.problems import check
from asperity.errors import InputError, refuse_all

MOST_RINGS = 160
MOST_IMPACTS = 2000
MOST_DEPTH = 8

_KEYS = ("case", "name", "asker", "surfaces")
_LONGEST = 100


@dataclass(frozen=True)
class Asked:
    """A case that the page asks for.

    Parameters
    ----------
    tables
        The case's tables as they stand in a file.
    name
        What the user calls it.
    asker
        Which of the page's designs asks; of one asker only the newest request counts.
    surfaces
        Uploads by name.
    """

    tables: dict[str, Any]
    name: str = "case"
    asker: str = ""
    surfaces: dict[str, str] = field(default_factory=dict)

    def case(self) -> Case:
        """The case, within what a page computes at once; what it says of output does not count.

        Raises
        ------
        InputError
            Where it is no case, or larger than that.
        """
        tables = {key: value for key, value in self.tables.items() if key != "output"}
        case = check(Case, tables)
        refuse_all(
            InputError(
                f"`{key}` must be at most {most} on this page; copy the case and take "
                f"`asperity run` for more; got {getattr(case.numerics, key)}",
                key=f"numerics.{key}",
            )
            for key, most in (("rings", MOST_RINGS), ("max_impacts", MOST_IMPACTS))
            if getattr(case.numerics, key) > most
        )
        return case


def asked(body: bytes) -> Asked:
    """What a request's JSON asks for.

    Raises
    ------
    InputError
        Where it is not as it should be.
    """
    given = _read(body, _KEYS)
    _refuse_no_tables(given, "case")
    surfaces = given.get("surfaces", {})
    if not isinstance(surfaces, dict) or not all(_short(value) for value in surfaces.values()):
        raise InputError("`surfaces` must be an object of texts")
    words = {key: given.get(key, "") for key in ("name", "asker")}
    for key, value in words.items():
        if not _short(value):
            raise InputError(f"`{key}` must be a text of at most {_LONGEST} characters")
    return Asked(given["case"], words["name"] or "case", words["asker"], surfaces)


def changed(body: bytes) -> tuple[dict[str, Any], dict[str, Any]]:
    """The tables of a case after a choice of the user and before it, as a request's JSON has them.

    Raises
    ------
    InputError
        Where it is not as it should be.
    """
    given = _read(body, ("case", "before"))
    _refuse_no_tables(given, "case")
    _refuse_no_tables(given, "before")
    return given["case"], given["before"]


def _read(body: bytes, keys: tuple[str, ...]) -> dict[str, Any]:
    try:
        given = json.loads(body, parse_constant=_refuse)
        json.dumps(given, ensure_ascii=False).encode()  # refuses halves of characters, "\\ud800"
    except (ValueError, RecursionError):
        raise InputError("a request must be a JSON object of whole characters") from None
    if not isinstance(given, dict) or not set(given) <= set(keys):
        raise InputError(f"a request must be a JSON object with keys among {', '.join(keys)}")
    return given


def _refuse_no_tables(given: dict[str, Any], name: str) -> None:
    if not isinstance(given.get(name), dict):
        raise InputError(f"`{name}` must be an object: the tables of a case")
    refuse_depth(given[name])
    _refuse_null(given[name])


def _short(value: object) -> bool:
    return isinstance(value, str) and len(value) <= _LONGEST


def _refuse(constant: str) -> NoReturn:
    raise ValueError(constant)


def refuse_depth(value: Any, left: int = MOST_DEPTH) -> None:
    """Refuse tables that are nested deeper than any case.

    Raises
    ------
    InputError
        With the limit.
    """
    if not left:
        raise InputError(f"`case` must be nested at most {MOST_DEPTH} deep")
    for each in _inside(value):
        refuse_depth(each, left - 1)


def _refuse_null(value: Any) -> None:
    """A key without a value is left out: a case file has no null."""
    if value is None:
        raise InputError("`case` must hold no null; leave the key out")
    for each in _inside(value):
        _refuse_null(each)


def _inside(value: Any) -> Iterable[Any]:
    if isinstance(value, dict):
        return value.values()
    return value if isinstance(value, list) else ()
