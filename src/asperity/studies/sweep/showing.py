"""A study as Python shows it: one line, and a table for notebooks."""

from __future__ import annotations

from typing import TYPE_CHECKING

from asperity.amounts import amount
from asperity.cards import card, counted

if TYPE_CHECKING:
    from asperity.studies.sweep.axes import Axis
    from asperity.studies.sweep.study import Study

_LISTED = 6
"""Values of an axis that are shown one by one."""


def sentence(study: Study) -> str:
    """Number of cases, and the keys over which they vary."""
    return f"{counted(study.size, 'case')} over {', '.join(axis.key for axis in study.axes)}"


def html(study: Study) -> str:
    """Axes with their values and units, what is kept, and what should be known beforehand."""
    drawn = study.sample
    how = [] if drawn is None else [("sample", f"{drawn.method}, seed {drawn.seed}")]
    sections = [
        ("Axes", [(axis.key, _values(axis)) for axis in study.axes]),
        ("Kept of each case", [("measures", ", ".join(study.keep)), *how]),
    ]
    return card(study.base_name, f"Study: {sentence(study)}.", sections, study.warnings)


def _values(axis: Axis) -> str:
    """An axis' values, or their number and ends."""
    if axis.listed and (not axis.numeric or len(axis.listed) <= _LISTED):
        return ", ".join(_text(axis, value) for value in axis.listed)
    ends = f"from {_text(axis, axis.low)} to {_text(axis, axis.high)}"
    count = f"{counted(axis.size, 'value')} " if axis.size else ""
    return f"{count}{ends}" + (", log" if axis.scale == "log" else "")


def _text(axis: Axis, value: object) -> str:
    if not isinstance(value, float):
        return str(value)
    return f"{value:.4g}" if axis.unit in ("", "1") else amount(value, axis.unit)
