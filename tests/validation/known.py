"""Rows of the known numbers in `tests/data`, and the largest pull of a curve."""

from collections.abc import Callable
from pathlib import Path

import numpy as np

from asperity._jax import jax, jnp


def rows(name: str, header: int, count: int, **options: object) -> np.ndarray:
    """All rows of a table of numbers below so many lines of comments and names."""
    file = Path(__file__).parents[1] / "data" / f"{name}.csv"
    found = np.genfromtxt(file, delimiter=",", comments="#", skip_header=header, **options)
    assert len(found) == count
    return found


def largest_pull(force: Callable[[jax.Array], jax.Array], low: float, high: float) -> float:
    """Of a force over gaps, by three grids, each around the largest of the one before."""
    for _ in range(3):
        gaps = np.linspace(low, high, 2001)
        pull = -np.asarray(force(jnp.asarray(gaps)))
        k = int(np.argmax(pull))
        low, high = gaps[max(k - 1, 0)], gaps[min(k + 1, 2000)]
    return float(pull.max())
