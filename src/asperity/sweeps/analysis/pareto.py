"""The Pareto front of a study: cases that no other beats in two measures at once."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from asperity.errors import InputError
from asperity.sweeps.analysis.view import axes_of, measure_named
from asperity.units import shown
from asperity.writing import csv_of

if TYPE_CHECKING:
    import xarray


@dataclass(frozen=True)
class Goal:
    """A measure, and which way is better.

    Parameters
    ----------
    measure
        Its name.
    largest
        Whether more is better.
    """

    measure: str
    largest: bool

    def __str__(self) -> str:
        return f"{'max' if self.largest else 'min'}:{self.measure}"


@dataclass(frozen=True)
class Front:
    """Two measures of all cases that have both, and which of them lie on the front.

    Parameters
    ----------
    goals
        What is better.
    cases
        Numbers of the cases that have both measures, shape (cases,).
    values
        Their measures in SI, shape (2, cases).
    best
        Indices into ``cases`` of those that no other beats, by the first measure.
    """

    goals: tuple[Goal, Goal]
    cases: np.ndarray
    values: np.ndarray
    best: np.ndarray


def goal_of(text: str) -> Goal:
    """A goal such as ``min:time_to_rest``.

    Raises
    ------
    InputError
        Where it has another form.
    """
    way, _, name = text.partition(":")
    if way not in ("min", "max") or not name:
        raise InputError(
            f"`pareto` must be two of min:MEASURE or max:MEASURE; got {shown(text)}", key="pareto"
        )
    return Goal(name, way == "max")


def undominated(first: np.ndarray, second: np.ndarray) -> np.ndarray:
    """Indices of the points that no other beats, the less of both the better, by ``first``.

    A point is beaten by one that is no worse in either and better in one; of equal points the
    first counts.

    Parameters
    ----------
    first, second
        Finite values, shape (points,).
    """
    order = np.lexsort((second, first))
    least = np.minimum.accumulate(second[order])
    ahead = np.concatenate([[np.inf], least[:-1]]) if order.size else least
    kept: np.ndarray = order[second[order] < ahead]
    return kept


def front_of(dataset: xarray.Dataset, goals: tuple[Goal, Goal]) -> Front:
    """The Pareto front of a study's results; measures of every impact count by the first one.

    Raises
    ------
    InputError
        Where a measure is unknown, both are the same, or no case has both.
    """
    names = [measure_named(dataset, goal.measure, "pareto") for goal in goals]
    if names[0] == names[1]:
        raise InputError(f"`pareto` must be two measures; got {names[0]} twice", key="pareto")
    pair = np.array([numbers(dataset, name) for name in names])
    cases = np.flatnonzero(np.all(np.isfinite(pair), axis=0))
    if cases.size == 0:
        raise InputError(
            f"`pareto` must be two measures that one case has both of; {names[0]} and {names[1]} "
            "go together in none",
            key="pareto",
        )
    values = pair[:, cases]
    signs = np.array([[-1.0 if goal.largest else 1.0] for goal in goals])
    return Front(goals, cases, values, undominated(*(signs * values)))


def numbers(dataset: xarray.Dataset, name: str) -> np.ndarray:
    """A measure of every case in SI, NaN where it has none, shape (cases,)."""
    first = dataset[name].isel(impact=0, turn=0, missing_dims="ignore")
    values = first.values.ravel()
    if values.dtype.kind == "f":
        return values
    return np.where(values >= 0, values.astype(float), np.nan)


def axis_values(dataset: xarray.Dataset, cases: np.ndarray) -> dict[str, np.ndarray]:
    """Values of every axis at some cases, by the axes' keys."""
    every = dataset["outcome"]
    return {key: dataset[key].broadcast_like(every).values.flat[cases] for key in axes_of(dataset)}


def table(dataset: xarray.Dataset, front: Front) -> bytes:
    """The front as CSV: a row a case, axes first, SI units in the header."""
    held = axis_values(dataset, front.cases[front.best])
    names = [*held, *(goal.measure for goal in front.goals)]
    columns = [*held.values(), *front.values[:, front.best]]
    rows = zip(*(column.tolist() for column in columns), strict=True)
    return csv_of([_headed(dataset, name) for name in names], rows)


def _headed(dataset: xarray.Dataset, name: str) -> str:
    unit = dataset[name].attrs.get("units", "")
    return f"{name} [{unit}]" if unit else name
