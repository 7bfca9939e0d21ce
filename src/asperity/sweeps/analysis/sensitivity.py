"""How much of a measure's variance each axis of a study makes: Sobol's indices.

The first-order index of an axis is the share of the variance that it makes alone, the total one
its share with all that it makes together with others (Saltelli et al. 2010, Comput. Phys. Commun.
181:259, the estimators of `scipy.stats.sobol_indices`).
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from asperity.config.problems import among
from asperity.errors import InputError, SimulationError
from asperity.sweeps.study.columns import FAILED, MEASURES, Column
from asperity.sweeps.study.study import Study

Evaluate = Callable[[Mapping[str, np.ndarray]], Mapping[str, np.ndarray]]
"""Axes' values by key, shape (cases,) -> columns by name, shape (cases, [width])."""

CONFIDENCE = 0.95
"""Probability that an index lies within its interval."""

_FEWEST, _MOST = 100, 999
_WORK = 1 << 29
_ROUNDING = 1e-13


@dataclass(frozen=True)
class Index:
    """One kind of index of every axis, with its interval of confidence; shapes (axes,)."""

    value: np.ndarray
    low: np.ndarray
    high: np.ndarray


@dataclass(frozen=True)
class Sensitivity:
    """Sobol's indices of one measure over the axes of a study.

    Parameters
    ----------
    measure
        Its name.
    unit, meaning
        Its unit, and what it is.
    keys, labels
        The axes.
    first, total
        First-order and total indices.
    size
        Points of the sample; the cases are ``size * (axes + 2)``.
    cases
        Number of cases computed.
    """

    measure: str
    unit: str
    meaning: str
    keys: tuple[str, ...]
    labels: tuple[str, ...]
    first: Index
    total: Index
    size: int
    cases: int

    def json_object(self) -> dict[str, Any]:
        """Plain numbers for JSON, in SI."""
        return {
            "measure": self.measure,
            "unit": self.unit,
            "size": self.size,
            "cases": self.cases,
            "confidence": CONFIDENCE,
            "axes": {
                key: {
                    kind: {
                        "index": float(index.value[k]),
                        "low": float(index.low[k]),
                        "high": float(index.high[k]),
                    }
                    for kind, index in (("first", self.first), ("total", self.total))
                }
                for k, key in enumerate(self.keys)
            },
        }


class Evaluations(NamedTuple):
    """A measure over two independent samples, and over the first with one axis of the second.

    Attributes
    ----------
    a, b
        Over the samples, less the mean of both, shape (size,).
    mixed
        Over the first with axis k of the second, less the same mean, shape (axes, size).
    """

    a: np.ndarray
    b: np.ndarray
    mixed: np.ndarray

    def indices(self) -> tuple[np.ndarray, np.ndarray]:
        """First-order and total indices, shapes (axes,): Saltelli et al. (2010), table 2, b and f.

        Zero where the measure is the same everywhere.
        """
        variance = float(np.concatenate([self.a, self.b]).var()) or np.inf
        first = np.mean(self.b * (self.mixed - self.a), axis=1) / variance
        total = 0.5 * np.mean((self.a - self.mixed) ** 2, axis=1) / variance
        return first, total

    def intervals(self, random: np.random.Generator) -> tuple[np.ndarray, np.ndarray]:
        """Ends of the intervals of confidence of both kinds of index, shapes (2, axes).

        By bootstrap over the points of the sample.
        """
        size = self.a.size
        resamples = int(np.clip(_WORK // (size * (len(self.mixed) + 2)), _FEWEST, _MOST))
        found = []
        for _ in range(resamples):
            chosen = random.integers(size, size=size)
            one = Evaluations(self.a[chosen], self.b[chosen], self.mixed[:, chosen])
            found.append(one.indices())
        tails = 0.5 * (1.0 - CONFIDENCE)
        first, total = np.quantile(found, (tails, 1.0 - tails), axis=0).swapaxes(0, 1)
        return first, total


def sensitivity(study: Study, measure: str, evaluate: Evaluate) -> Sensitivity:
    """Sobol's indices of a measure over the axes of a sampled study.

    Parameters
    ----------
    study
        With a [sample] whose size is a power of two, and ranges of numbers for axes, over which
        values are drawn evenly (on a scale of their own).
    measure
        Name of a measure; one with a value for each impact counts by the first.
    evaluate
        What computes cases.

    Raises
    ------
    InputError
        Where the study or the measure is of another kind.
    SimulationError
        Where a case failed or has no such measure, or all cases have the same.
    """
    column = measured(measure)
    check(study)
    assert study.sample is not None
    size, seed = study.sample.size, study.sample.seed
    found, evaluated = _evaluated(study, column, evaluate)
    first, total = evaluated.intervals(np.random.default_rng([seed, 1]))
    return Sensitivity(
        measure,
        column.unit,
        column.meaning,
        tuple(axis.key for axis in study.axes),
        tuple(axis.label for axis in study.axes),
        Index(np.ravel(found.first_order), *first),
        Index(np.ravel(found.total_order), *total),
        size,
        size * (len(study.axes) + 2),
    )


def _evaluated(study: Study, column: Column, evaluate: Evaluate) -> tuple[Any, Evaluations]:
    """SciPy's result, and what it was made from."""
    from scipy.stats import sobol_indices, uniform

    assert study.sample is not None
    size, seed = study.sample.size, study.sample.seed
    kept: list[Evaluations] = []
    largest = 0.0

    def function(points: np.ndarray) -> np.ndarray:
        nonlocal largest
        # A point that was rounded up to 1 would lie outside what `from_unit` takes.
        inside = np.minimum(points, np.nextafter(1.0, 0.0))
        values = {a.key: a.from_unit(u) for a, u in zip(study.axes, inside, strict=True)}
        found = _measure(column, evaluate(values))
        largest = max(largest, float(np.abs(found).max()))
        return found

    def estimate(f_A: np.ndarray, f_B: np.ndarray, f_AB: np.ndarray) -> Any:
        kept.append(Evaluations(f_A[0], f_B[0], f_AB[:, 0]))
        return kept[-1].indices()

    dists = [uniform()] * len(study.axes)  # which the axes turn into their own values
    found = sobol_indices(func=function, n=size, dists=dists, method=estimate, rng=seed)
    if max(np.std(part) for part in (kept[0].a, kept[0].b)) <= _ROUNDING * largest:
        raise SimulationError(
            f"{column.name} must vary for a sensitivity; it is the same in all {size} points"
        )
    return found, kept[0]


def measured(name: str) -> Column:
    """The column of a measure.

    Raises
    ------
    InputError
        Where there is none of this name.
    """
    known = {column.name: column for column in MEASURES}
    among(name, known, f"`measure` must be one of {', '.join(known)}", key="measure")
    return known[name]


def check(study: Study) -> None:
    """Refuse a study over which indices have no meaning.

    Raises
    ------
    InputError
        Where it is no sample of a power of two, or an axis is no range of numbers.
    """
    if study.sample is None:
        raise InputError(
            "a [sample] table must be given for a sensitivity, with a power of two as its size; "
            "got a grid",
            key="sample",
        )
    size = study.sample.size
    if size < 2 or size & (size - 1):
        near = 1 << max(1, size.bit_length())
        raise InputError(
            f"`size` must be a power of two for a sensitivity, such as {near}; got {size}",
            key="sample.size",
        )
    for axis in study.axes:
        if axis.listed:
            raise InputError(
                f"`{axis.key}` must be a range of numbers, from and to, for a sensitivity; got a "
                "list of values",
                key=f"axes.{axis.key}",
            )
    if len(study.axes) < 2:
        raise InputError("a sensitivity must compare two axes or more; got one", key="axes")


def _measure(column: Column, columns: Mapping[str, np.ndarray]) -> np.ndarray:
    """The measure of every case, all of it known and not all the same.

    Raises
    ------
    SimulationError
        Where it is not.
    """
    values = np.asarray(columns[column.name])
    if column.along:
        values = values[:, 0]
    absent = values < 0 if values.dtype.kind == "i" else ~np.isfinite(values)
    if absent.any():
        lost = int(np.count_nonzero(np.asarray(columns["outcome"]) == FAILED))
        others = "" if column.name == "captured" else "; `captured` applies to every case"
        raise SimulationError(
            f"{column.name} must be known in every case for a sensitivity; of {values.size} cases "
            f"{int(absent.sum())} have none ({lost} failed){others}"
        )
    return values.astype(float)
