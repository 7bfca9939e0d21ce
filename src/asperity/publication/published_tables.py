"""The published tables, or others of the same layout."""

from __future__ import annotations

import csv
import importlib.resources
from dataclasses import dataclass
from decimal import Decimal, InvalidOperation
from typing import NamedTuple

from ..config import Case
from ..config.case_file import read_text
from ..errors import InputError
from ..units import shown


class Quantity(NamedTuple):
    """What the tables hold of each case: its column, its name in words, its SI unit."""

    column: str
    words: str
    unit: str


QUANTITIES = {
    "log_decrement": Quantity("log_decrement", "decrement", ""),
    "time_to_rest": Quantity("time_to_rest_us", "stiction time", "s"),
    "power_loss": Quantity("power_loss_1e-4_nW", "power loss", "W"),
}

_COLUMNS = {
    "asperity_radius_nm": (-9, 1e-3, 1e6),
    "rms_height_nm": (-9, 1e-3, 1e6),
    "time_to_rest_us": (-6, 1e-6, 1e12),
    "power_loss_1e-4_nW": (-13, 1e-12, 1e12),
    "log_decrement": (0, 1e-9, 1e3),
}
"""Of each column the power of ten of its unit in SI, and its smallest and largest value.

Both are allowed. The range is wide, but nothing overflows.
"""

_KEYS = ("asperity_radius_nm", "rms_height_nm")
"""Columns that no row can do without."""

_LONGEST = 60
"""Characters of a number."""


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

    def within(self, case: Case) -> Case:
        """A case on this surface."""
        radius, height = self.surface
        changes = {"asperity_radius": f"{radius!r} m", "rms_height": f"{height!r} m"}
        return case.replace({f"roughness.{key}": value for key, value in changes.items()})


def read_tables(file: str | None = None) -> list[Entry]:
    """Tables from a CSV file; without one the publication's Tables 2 and 3.

    Parameters
    ----------
    file
        Path of a file with the columns ``table, asperity_radius_nm, rms_height_nm,
        time_to_rest_us, power_loss_1e-4_nW, log_decrement``. A value that is not known is
        left empty; lines that begin with ``#`` are comments.

    Raises
    ------
    InputError
        One line that names file, line, column, rule and value.
    """
    if file is None:
        source = importlib.resources.files(__package__) / "published_tables.csv"
        return _entries(source.read_text(encoding="utf-8"), "published_tables.csv")
    return _entries(read_text(file, "tables"), file)


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
    if len(set(header)) < len(header):
        raise InputError(f"{file} (line {lines[0][0]}): a column stands there twice", file=file)
    entries = []
    for (number, _), row in zip(lines[1:], rows[1:], strict=True):
        place = f"{file} (line {number})"
        if len(row) != len(header):
            raise InputError(
                f"{place}: a row must have {len(header)} values; got {len(row)}", file=file
            )
        entries.append(_entry(dict(zip(header, row, strict=True)), place, file))
    return entries


def _entry(row: dict[str, str], place: str, file: str) -> Entry:
    found = {name: _value(row, name, place, file) for name in _COLUMNS}
    table = row["table"].strip()
    if not (table.isdecimal() and len(table) < 10):
        raise InputError(f"{place}: `table` must be a whole number; got {shown(table)}", file=file)
    radius, height = found["asperity_radius_nm"], found["rms_height_nm"]
    assert radius is not None
    assert height is not None
    values = {name: found[quantity.column] for name, quantity in QUANTITIES.items()}
    return Entry(int(table), radius, height, values)


def _value(row: dict[str, str], name: str, place: str, file: str) -> float | None:
    """A value in SI; None where it is left empty and may be."""
    text = row[name].strip()
    if not text and name not in _KEYS:
        return None
    try:
        value = Decimal(text if len(text) <= _LONGEST else "NaN")
    except InvalidOperation:
        value = Decimal("NaN")
    power, low, high = _COLUMNS[name]
    if not (value.is_finite() and low <= value <= high):
        raise InputError(
            f"{place}: `{name}` must be a number in [{low:g}, {high:g}]; got {shown(text)}",
            file=file,
        )
    return float(value.scaleb(power))
