"""The table of impacts in the summary of a result."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING

from asperity.amounts import scaled

if TYPE_CHECKING:
    from asperity.results.result_data import ResultData

_FEW_MORE = 3  # than are asked for are shown, not left out

_COLUMNS = (
    ("height", "rebound_height", "m"),
    ("restitution", "restitution", ""),
    ("period", "rebound_period", "s"),
)
_PUBLISHED = (
    ("decrement", "log_decrement", ""),
    ("power loss", "power_loss", "W"),
    ("one-way", "power_loss_published", "W"),
)
"""What the publication counts."""


def impact_table(result: ResultData, most: int | None, published: bool | None) -> list[str]:
    """The table of impacts, each column in one unit; its first ``most`` rows of many more."""
    shows = result.case.publication is not None if published is None else published
    columns = [*_COLUMNS, *(_PUBLISHED if shows else ())]
    given = [result.measures.get(key) or [] for _, key, _ in columns]
    count = max(len(values) for values in given)
    if not count:
        return []
    shown = count if most is None or count <= most + _FEW_MORE else most
    units = [_column_unit(values[:shown], columns[i][2]) for i, values in enumerate(given)]
    lines = ["", "Impacts" + " (one-way: the power loss as the publication counts it)" * shows]
    lines.append(_row("", [title for title, _, _ in columns]))
    lines.append(_row("", [unit for _, unit in units]))
    for number in range(shown):
        cells = [
            cell_text(values[number] if number < len(values) else None, factor, unit)
            for values, (factor, unit) in zip(given, units, strict=True)
        ]
        lines.append(_row(str(number + 1), cells))
    return lines if shown == count else [*lines, f"  and {count - shown} more"]


def _column_unit(values: Sequence[float | None], unit: str) -> tuple[float, str]:
    return scaled(max((abs(v) for v in values if v is not None), default=0.0), unit)


def cell_text(value: float | None, factor: float, unit: str) -> str:
    """A value of the table; a ratio with more digits, since it may be close to 1."""
    digits = 4 if unit else 6
    return "-" if value is None or not math.isfinite(value) else f"{value / factor:.{digits}g}"


def _row(first: str, cells: Iterable[str]) -> str:
    return (f"{first:>6}" + "".join(f"{cell:>12}" for cell in cells)).rstrip()
