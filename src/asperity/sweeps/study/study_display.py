"""A study as Python shows it: one line, and a table for notebooks."""

from __future__ import annotations

from asperity.config.display import value_text
from asperity.config.html_table import card, counted
from asperity.sweeps.study.axes import Axis
from asperity.sweeps.study.definition import StudyDefinition

_LISTED = 6
"""Values of an axis that are shown one by one."""


def sentence(study: StudyDefinition) -> str:
    """Number of cases, and the keys over which they vary."""
    return f"{counted(study.size, 'case')} over {', '.join(axis.key for axis in study.axes)}"


def html(study: StudyDefinition, warnings: list[str]) -> str:
    """Axes with their values and units, what is kept, and what should be known beforehand."""
    drawn = study.sample
    how = [] if drawn is None else [("sample", f"{drawn.method}, seed {drawn.seed}")]
    sections = [
        ("Axes", [(axis.key, _values(axis)) for axis in study.axes]),
        ("Kept of each case", [("measures", ", ".join(study.keep)), *how]),
    ]
    return card(study.base_name, f"Study: {sentence(study)}.", sections, warnings)


def _values(axis: Axis) -> str:
    """An axis' values, or their number and ends."""
    if axis.listed and (not axis.numeric or len(axis.listed) <= _LISTED):
        return ", ".join(value_text(value, axis.unit) for value in axis.listed)
    ends = f"from {value_text(axis.low, axis.unit)} to {value_text(axis.high, axis.unit)}"
    count = f"{counted(axis.size, 'value')} " if axis.size else ""
    return f"{count}{ends}" + (", log" if axis.scale == "log" else "")
