"""Size and unit of a map: what a file states, what the caller states, and whether they agree."""

from __future__ import annotations

import math
import re
from collections.abc import Iterable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from ...errors import InputError
from ...units import quantity, shown
from .content import refusal

_UNIT_TEXT = r"\s*\[([^\]]*)\]"
_COLUMNS = re.compile(rf"x{_UNIT_TEXT}[\s,;]*y{_UNIT_TEXT}[\s,;]*z{_UNIT_TEXT}")
_SIZE = re.compile(rf"size{_UNIT_TEXT}\s+(\S+)\s+(\S+)")
_PIXELS = re.compile(r"pixels\s+([0-9]{1,9})\s+([0-9]{1,9})")
_UNIT = re.compile(r"unit\s+(\S+)")
_MEANT = re.compile(r"(?:size|x)\s*\[")
# Gwyddion's export of a matrix as text, with its heading.
_WIDTH = re.compile(r"Width:\s*(.+)")
_HEIGHT = re.compile(r"Height:\s*(.+)")
_VALUES = re.compile(r"Value units:\s*(\S+)")

_SAME = 1e-3
"""Relative difference of two sizes that are the same, one of them rounded to three digits."""

SIZE_REMEDY = 'give it with --size "10 um x 10 um" (key `size` in a case)'
UNIT_REMEDY = "give it with --unit nm (key `unit` in a case)"


@dataclass(frozen=True)
class Stated:
    """What is stated of a map; None where nothing is.

    Parameters
    ----------
    size
        Size (x, y) [m]: pixels times their size.
    unit
        Unit of the heights, e.g. ``"nm"``.
    lateral
        Units of the columns x and y; a file that states them holds points, not a matrix.
    pixels
        Number of pixels (columns, rows).
    width, height
        Sizes along x and y [m] that stand on lines of their own.
    """

    size: tuple[float, float] | None = None
    unit: str | None = None
    lateral: tuple[str, str] | None = None
    pixels: tuple[int, int] | None = None
    width: float | None = None
    height: float | None = None


def stated_in(lines: Iterable[tuple[int, str]], file: str) -> Stated:
    """What the comment lines of a text file state.

    Parameters
    ----------
    lines
        Line numbers and comments, without their ``#``.
    file
        Name of the file, for messages.

    Raises
    ------
    InputError
        Where a line is meant to state something and cannot be read, or two lines contradict.
    """
    found = Stated()
    for number, text in lines:
        try:
            told = told_by(text)
        except InputError as error:
            raise refusal(file, f"line {number}: {error}") from None
        for name, value in told.items():
            before = getattr(found, name)
            if before is not None and before != value:
                raise refusal(
                    file,
                    f"line {number}: the {name} must be stated once; got {shown(value)} after "
                    f"{shown(before)}; keep the line that is right",
                )
            found = replace(found, **{name: value})
    if found.width is not None and found.height is not None and found.size is None:
        found = replace(found, size=(found.width, found.height))
    return found


def told_by(text: str) -> dict[str, Any]:
    """What one comment states, by the names of `Stated`; empty for a remark."""
    text = text.strip()
    if match := _COLUMNS.fullmatch(text):
        x, y, z = match.groups()
        return {"lateral": (checked_unit(x), checked_unit(y)), "unit": checked_unit(z)}
    if match := _SIZE.fullmatch(text):
        unit, x, y = match.groups()
        return {"size": (_length(f"{x} {unit}"), _length(f"{y} {unit}"))}
    if _MEANT.match(text):
        raise InputError(f"must read `# x[m] y[m] z[nm]` or `# size[um] 10 10`; got {shown(text)}")
    if match := _PIXELS.fullmatch(text):
        return {"pixels": (int(match[1]), int(match[2]))}
    if match := _UNIT.fullmatch(text) or _VALUES.fullmatch(text):
        return {"unit": checked_unit(match[1])}
    if match := _WIDTH.fullmatch(text):
        return {"width": _length(match[1])}
    if match := _HEIGHT.fullmatch(text):
        return {"height": _length(match[1])}
    return {}


def checked_unit(unit: str) -> str:
    """A unit of length as it was written.

    Raises
    ------
    InputError
        Where it is none.
    """
    _metres(unit)
    return unit


def in_metres(values: np.ndarray, unit: str) -> np.ndarray:
    """Values in ``unit`` as metres, rounded once where the unit is a decimal part of the metre."""
    factor = _metres(unit)
    parts = quantity("1 m", unit, "unit")
    # 50/1e9 is the float nearest to 50 nm; 50*1e-9 is not.
    scaled = values / parts if factor < 1.0 and parts == round(parts) else values * factor
    return np.asarray(scaled, dtype=np.float64)


def agreed_size(
    stated: tuple[float, float] | None, asked: tuple[float, float] | None, file: str, line: str = ""
) -> tuple[float, float]:
    """Size (x, y) [m] of a map by its file, by the caller, or by both.

    Parameters
    ----------
    stated, asked
        Size [m] by the file and by the caller.
    file
        Name of the file.
    line
        What else the message of a missing size advises.

    Raises
    ------
    InputError
        Where neither states it, they contradict, or it is no pair of positive lengths.
    """
    size = stated or asked
    if size is None:
        raise refusal(file, f"the size of the map must be known; got none; {SIZE_REMEDY}{line}")
    for one in (stated, asked):
        if one is not None and not all(math.isfinite(side) and side > 0.0 for side in one):
            raise refusal(
                file, f"the size must be two positive lengths; got {shown(one)} m; {SIZE_REMEDY}"
            )
    if stated is not None and asked is not None and not np.allclose(stated, asked, _SAME, 0.0):
        raise refusal(
            file,
            f"the size must be the one in the file, {_pair(stated)} m; got {_pair(asked)} m; "
            "leave the option out, or correct the file",
        )
    return size


def agreed_unit(stated: str | None, asked: str | None, file: str, line: str = "") -> str:
    """Unit of the heights by the file, by the caller, or by both.

    Raises
    ------
    InputError
        Where neither states it, they contradict, or it is no unit of length.
    """
    unit = stated or asked
    if unit is None:
        raise refusal(file, f"the heights must have a unit; got none; {UNIT_REMEDY}{line}")
    try:
        factors = [_metres(one) for one in (stated, asked) if one is not None]
    except InputError as error:
        raise refusal(file, str(error)) from None
    if factors[0] != factors[-1]:
        raise refusal(
            file,
            f"the unit must be the one in the file, {stated}; got {shown(asked)}; "
            "leave the option out, or correct the file",
        )
    return unit


def check_pixels(stated: Stated, shape: tuple[int, ...], file: str) -> None:
    """Refuse a map that has not as many pixels as its file states: it was cut short or joined."""
    got = shape[::-1]
    if stated.pixels is not None and stated.pixels != got:
        raise refusal(
            file,
            f"the map must have {stated.pixels[0]} x {stated.pixels[1]} pixels, as the file "
            f"states; got {got[0]} x {got[1]}; copy or export it again",
        )


def _metres(unit: str) -> float:
    try:
        return quantity(f"1 {unit}", "m", "unit")
    except InputError:
        raise InputError(f"the unit must be a length; got {shown(unit)}; write nm or um") from None


def _length(text: str) -> float:
    length = quantity(text, "m", "size")
    if length <= 0.0:
        raise InputError(f"the size must be positive; got {shown(text)}")
    return length


def _pair(size: tuple[float, float]) -> str:
    return f"{size[0]:.6g} x {size[1]:.6g}"
