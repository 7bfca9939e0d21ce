"""Which of a test's cases run each time, and which with `make validate` alone."""

from collections.abc import Iterable
from typing import Any

import pytest


def long_but(cases: Iterable[Any], *quick: Any) -> list[Any]:
    """Parameters of a test: those that are not quick belong to long studies."""
    return [case if case in quick else _long(case) for case in cases]


def _long(case: Any) -> Any:
    values = case if isinstance(case, tuple) else (case,)
    return pytest.param(*values, marks=pytest.mark.long)
