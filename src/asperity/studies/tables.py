"""The published tables, or others of the same layout."""

from __future__ import annotations

import csv
import importlib.resources
import math
from dataclasses import dataclass
from decimal import Decimal, InvalidOperation
from pathlib import Path

from ..errors import InputError
from ..units import shown

QUANTITIES = ("log_decrement", "stiction_time", "power_loss")
"""What the tables hold of each case."""

SIZE_LIMIT = 1 << 20
"""Largest size of a file of tables [bytes]."""

_COLUMNS = {
    "asperity_radius_nm": -9,
    "rms_height_nm": -9,
    "stiction_time_us": -6,
    "power_loss_1e-4_nW": -13,
    "log_decrement": 0,
}
"""Power of ten of each column's unit in SI."""

_RANGE = {"asperity_radius_nm": (1e-3, 1e6), "rms_height_nm": (1e-3, 1e6)}


@dataclass(frozen=True)
class Entry:
    """A row of a published table, in SI; None where a value is missing.

    Parameters
    ----------
    table
        Which table it stands in.
    asperity_radius, rms_height
        The surface [m].
    values
        By name of :data:`QUANTITIES`: decrement, stiction time [s], power loss [W].
    """

    table: int
    asperity_radius: float
    rms_height: float
    values: dict[str, float | None]

    @property
    def surface(self) -> tuple[float, float]:
        """Asperity radius and rms height [m]."""
        return self.asperity_radius, self.rms_height

    @property
    def name(self) -> str:
        """The surface in words, e.g. ``beta = 0.25 nm, sigma = 10.5 nm``."""
        radius, height = (f"{x * 1e9:.4g} nm" for x in self.surface)
        return f"beta = {radius}, sigma = {height}"


def read_tables(file: str | None = None) -> list[Entry]:
    """Tables from a CSV file; without one the publication's Tables 2 and 3.

    Parameters
    ----------
    file
        Path of a file with the columns ``table, asperity_radius_nm, rms_height_nm,
        stiction_time_us, power_loss_1e-4_nW, log_decrement``. A value that is not known is
        left empty; lines that begin with ``#`` are comments.

    Raises
    ------
    InputError
        One line that names file, line, column, rule and value.
    """
    if file is None:
        source = importlib.resources.files(__package__) / "published_tables.csv"
        return _entries(source.read_text(encoding="utf-8"), "published_tables.csv")
    path = Path(file)
    try:
        if path.is_file() and path.stat().st_size > SIZE_LIMIT:
            raise InputError(f"{file}: tables must be at most 1 MiB", file=file)
        text = path.read_text(encoding="utf-8-sig")
    except UnicodeDecodeError:
        raise InputError(f"{file}: tables must be text; got a binary file", file=file) from None
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or error
        raise InputError(f"{file}: cannot be read: {reason}", file=file) from None
    return _entries(text, file)


def _entries(text: str, file: str) -> list[Entry]:
    lines = [
        (number, line)
        for number, line in enumerate(text.splitlines(), start=1)
        if line.strip() and not line.lstrip().startswith("#")
    ]
    if not lines:
        raise InputError(f"{file}: tables must have rows; got none", file=file)
    try:
        rows = [next(csv.reader([line])) for _, line in lines]
    except csv.Error as error:
        raise InputError(f"{file}: no CSV: {error}", file=file) from None
    header = [name.strip() for name in rows[0]]
    missing = [name for name in ("table", *_COLUMNS) if name not in header]
    if missing:
        raise InputError(
            f"{file} (line {lines[0][0]}): the column `{missing[0]}` is missing", file=file
        )
    if len(rows) == 1:
        raise InputError(f"{file}: tables must have rows; got none", file=file)
    return [
        _entry(dict(zip(header, row, strict=False)), f"{file} (line {number})", file)
        for (number, _), row in zip(lines[1:], rows[1:], strict=True)
    ]


def _entry(row: dict[str, str], place: str, file: str) -> Entry:
    found: dict[str, float | None] = {}
    for name, power in _COLUMNS.items():
        text = row.get(name, "").strip()
        low, high = _RANGE.get(name, (0.0, math.inf))
        if not text and name not in _RANGE:
            found[name] = None
            continue
        try:
            value = Decimal(text)
        except InvalidOperation:
            value = Decimal("NaN")
        if not (value.is_finite() and low < value < high):
            rule = "must be a positive number" if low == 0.0 else f"must lie in [{low:g}, {high:g}]"
            raise InputError(f"{place}: `{name}` {rule}; got {shown(text)}", file=file)
        found[name] = float(value.scaleb(power))
    table = row.get("table", "").strip()
    if not table.isdecimal():
        raise InputError(f"{place}: `table` must be a whole number; got {shown(table)}", file=file)
    radius, height = found["asperity_radius_nm"], found["rms_height_nm"]
    assert radius is not None
    assert height is not None
    values = {
        "log_decrement": found["log_decrement"],
        "stiction_time": found["stiction_time_us"],
        "power_loss": found["power_loss_1e-4_nW"],
    }
    return Entry(int(table), radius, height, values)
