"""Loads, depths and speeds as options give them."""

from __future__ import annotations

from typing import Any

from asperity.errors import InputError
from asperity.units import quantity


def turn_of(load: str | None, depth: str | None) -> dict[str, Any]:
    """What :func:`asperity.curve` takes for ``--load`` and ``--depth``.

    Raises
    ------
    InputError
        If both are given, or one is no force or length.
    """
    if load is not None and depth is not None:
        raise InputError("`--load` must be given without `--depth`; got both")
    found: dict[str, Any] = {}
    if load is not None:
        found["load"] = quantity(load, "N", "--load")
    if depth is not None:
        found["depth"] = quantity(depth, "m", "--depth")
    return found


def speeds_of(ends: str | None, points: int | None) -> dict[str, Any]:
    """What :func:`asperity.restitution_curve` takes for ``--speeds`` and ``--points``.

    Raises
    ------
    InputError
        If the ends are not two ascending speeds.
    """
    if ends is None:
        return {"points": points}
    given = [quantity(part.strip(), "m/s", "--speeds") for part in ends.split(",")]
    if len(given) != 2 or not 0.0 < given[0] < given[1]:
        raise InputError(
            "`--speeds` must be two ascending speeds above 0 with a comma between them, such as "
            f"'1 mm/s, 10 m/s'; got {ends!r}"
        )
    return {"ends": (given[0], given[1]), "points": points}
