"""When two answers are the same: the rule for each kind of quantity.

An answer is a dictionary of four kinds of quantities, each by its name:

- ``values``: numbers, and lists of numbers; stored beside their response;
- ``bounds``: balances, of which only the size counts;
- ``exact``: counts, switches and words;
- ``sentences``: warnings and reasons, by what they say and not by their numbers.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterator
from typing import Any, NamedTuple

FLOOR = 4e-16
"""Smallest relative response: two units in the last place."""

TIMES = 10.0
"""What is allowed, in responses; and in stored balances."""

BALANCE = 1e-9
"""A balance that is allowed whatever was stored: a tenth of the default tolerance."""

WORDS = 8
"""Leading words by which a sentence is known."""

KINDS = ("values", "bounds", "exact", "sentences")

_NUMBER = re.compile(r"[-+−(\[]*\d")
_UNIT = re.compile(r"(%|°|[fpnuµmkMG]?(m|s|N|J|W|Pa|K|deg\w?)(\^?\d)?(/.*)?)[,;:.)\]]*$")


class Difference(NamedTuple):
    """What is not as it was.

    Attributes
    ----------
    quantity
        Kind and name, with the number of the element in a list.
    stored, found
        What it was, and what it is.
    allowed
        Largest difference, or size of a balance; None where it must be the same.
    """

    quantity: str
    stored: Any
    found: Any
    allowed: float | None


def sentence(text: str) -> str:
    """Leading words of a sentence, without numbers, and without the units that follow them."""
    words: list[str] = []
    after = False
    for word in text.split():
        number = bool(_NUMBER.match(word))
        if not number and not (after and _UNIT.match(word)):
            words.append(word.strip(",;:.()").lower())
        after = number
    return " ".join(words[:WORDS])


def response_of(value: Any, others: list[Any]) -> Any:
    """Largest change of a value among those of changed inputs, element by element.

    Parameters
    ----------
    value
        A number, None, or a list of them.
    others
        The same quantity of each change; None where it had no answer.

    Returns
    -------
    As the value: numbers, infinite where an element appeared or went, None of None.
    """
    if isinstance(value, list):
        parts = [o if isinstance(o, list) and len(o) == len(value) else None for o in others]
        return [
            response_of(v, [None if p is None else p[i] for p in parts])
            for i, v in enumerate(value)
        ]
    if not isinstance(value, int | float) or not math.isfinite(value):
        return None
    steps = [abs(o - value) if isinstance(o, int | float) else math.inf for o in others]
    return float(f"{max(steps, default=0.0):.3g}")


def allowed(value: float, response: float) -> float:
    """Largest difference from a stored value: ten times its response, or the floor's."""
    return TIMES * max(response, FLOOR * abs(value))


def differences(stored: dict[str, Any], found: dict[str, Any]) -> list[Difference]:
    """What differs between a stored answer and one that was found.

    Parameters
    ----------
    stored
        As `asking` gives it, but ``values`` hold pairs of a value and its response.
    found
        As `asking` gives it.
    """
    out = []
    for kind in KINDS:
        before, now = stored.get(kind, {}), found.get(kind, {})
        for name in sorted(before.keys() | now.keys()):
            if name not in now or name not in before:
                gone = Difference(f"{kind}.{name}", before.get(name), now.get(name), None)
                out.append(gone)
            else:
                out += _of_kind(kind, f"{kind}.{name}", before[name], now[name])
    return out


def _of_kind(kind: str, name: str, stored: Any, found: Any) -> Iterator[Difference]:
    """Differences of one quantity by the rule of its kind."""
    if kind == "values":
        yield from _values(name, *stored, found)
    elif kind == "bounds" and isinstance(stored, int | float):
        most = max(TIMES * abs(stored), BALANCE)
        if not isinstance(found, int | float) or not abs(found) <= most:
            yield Difference(name, stored, found, most)
    elif stored != found:
        yield Difference(name, stored, found, None)


def _values(name: str, stored: Any, response: Any, found: Any) -> Iterator[Difference]:
    """Differences of a number or of a list of numbers."""
    if isinstance(stored, list):
        if not isinstance(found, list) or len(found) != len(stored):
            yield Difference(name, stored, found, None)
            return
        for i, each in enumerate(zip(stored, response, found, strict=True)):
            yield from _values(f"{name}[{i}]", *each)
    elif response is None or not isinstance(found, int | float):
        if stored != found and response != math.inf:
            yield Difference(name, stored, found, None)
    elif not abs(found - stored) <= (most := allowed(stored, response)):
        yield Difference(name, stored, found, most)
