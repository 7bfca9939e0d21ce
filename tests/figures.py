"""Figures of the validation: what a source says and what the program finds, a row each.

The tests of `tests/validation` assert on these rows and the page `docs/validation.md` prints them.
"""

from collections.abc import Iterable
from importlib import import_module
from pathlib import Path
from typing import NamedTuple


class Figure(NamedTuple):
    """One number that is known from elsewhere, and ours.

    Attributes
    ----------
    problem
        What is computed, in a few words.
    source
        Where the expected number comes from.
    expected, found
        The number known, not 0, and ours.
    unit
        Of both; empty for a pure number.
    limit
        Largest relative difference that the test allows.
    """

    problem: str
    source: str
    expected: float
    found: float
    unit: str
    limit: float

    @property
    def difference(self) -> float:
        """Of ours from the number known, relative to it."""
        return self.found / self.expected - 1.0

    @property
    def holds(self) -> bool:
        """Whether the difference is within the limit."""
        return abs(self.difference) <= self.limit


def misses(rows: Iterable[Figure]) -> list[Figure]:
    """Rows beyond their limit."""
    return [row for row in rows if not row.holds]


def collected() -> list[Figure]:
    """Rows of all files of the validation that have any, by the files' names."""
    files = sorted((Path(__file__).parent / "validation").glob("test_*.py"))
    modules = [import_module(f"validation.{path.stem}") for path in files]
    rows = [row for module in modules if hasattr(module, "figures") for row in module.figures()]
    return list(dict.fromkeys(rows))


def table(rows: Iterable[Figure]) -> str:
    """Rows as a Markdown table."""
    lines = ["| problem | source | its value | ours | difference | limit |", "|" + "---|" * 6]
    for row in rows:
        unit = f" {row.unit}" if row.unit else ""
        lines.append(
            f"| {row.problem} | {row.source} | {row.expected:.7g}{unit} | {row.found:.7g}{unit} "
            f"| {row.difference:+.1e} | {row.limit:.1e} |"
        )
    return "\n".join(lines)
