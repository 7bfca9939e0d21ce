"""All cases of a group: their motions, and what is measured of them."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from asperity._jax import jax
from asperity.contact import ElasticContact
from asperity.dynamics import Body
from asperity.integration.batch_motion import BatchMotion
from asperity.integration.batch_records import ImpactRows, slices, taken
from asperity.integration.clock import Clock
from asperity.integration.panel_cuts import PATIENCE, Left
from asperity.integration.steps import Steps
from asperity.sweeps.compute.building import Group
from asperity.sweeps.study.columns import FAILED

_LEAST = 16


class BatchSolution(NamedTuple):
    """What became of the cases of a group, each array with the cases along its first axis.

    Attributes
    ----------
    outcome
        Codes of `asperity.errors.ENDS`.
    made
        Number of impacts.
    last_apex_time
        Time of the last apex [s].
    lost
        Energy lost in all, by mechanism [J].
    history
        Impacts by name, as in :class:`asperity.dynamics.Impacts`, shape (cases, impacts).
    measures
        By name, as in :class:`asperity.results.measures.Measures`.
    at_depth
        :class:`asperity.regimes.validity.AtDepth` of the first impact, shape (cases, 3).
    failures
        Why a case failed, by its place in the group.
    release
        Mechanical energy at the release [J].
    body
        Mass and release of each case, as it was launched.
    """

    outcome: np.ndarray
    made: np.ndarray
    last_apex_time: np.ndarray
    lost: np.ndarray
    history: dict[str, np.ndarray]
    measures: dict[str, np.ndarray]
    at_depth: np.ndarray
    failures: dict[int, Exception]
    release: np.ndarray
    body: Body


def integrate_batch(
    group: Group, clock: Clock, *, checked: bool = True, width: int | None = None
) -> BatchSolution:
    """Integrate all cases of a group.

    Parameters
    ----------
    group
        The cases.
    clock
        Told of the time in compiled code.
    checked
        Whether they must be released outside contact. Nothing finer is compiled for others, which
        are launched where forces begin.
    width
        Cases of a compiled call; without it, what suits the group.
    """
    steps = Steps.of_batch(group.batch, group.rows.size, width)
    # One that may jump is solved by itself, as a single run does it.
    patience = 0 if checked and type(group.batch.contact) is ElasticContact else PATIENCE
    motions = BatchMotion(
        group.batch, group.tolerance, steps, clock,
        finer=checked, checked=checked, launched=group.launched, patience=patience,
    )  # fmt: skip
    motions.integrate()
    return _solution(motions)


def compile_ahead(groups: list[Group]) -> None:
    """Compile the steps of groups of cases, where they are not yet."""
    for group in groups:
        count = group.rows.size
        steps = Steps.of_batch(group.batch, count)
        steps.compile_ahead(taken(group.batch, next(slices(np.arange(count), steps.width))))


def _solution(motions: BatchMotion) -> BatchSolution:
    """What became of all cases."""
    count, made, failures = motions.made.size, motions.made, motions.failures
    out = BatchSolution(
        np.full(count, FAILED), made, np.full(count, np.nan), np.zeros((count, 0)), {}, {},
        np.full((count, 3), np.nan), failures, np.full(count, np.nan),
        motions.batch.body,
    )  # fmt: skip
    ends, rows = motions.ends(), motions.history(_power(int(made.max())))
    if ends is None or rows is None:
        return out
    begun, first = ends
    assert first is not None
    moved, progress = made > 0, begun.progress
    outcome = np.where(moved, progress.outcome, FAILED)
    for place in np.flatnonzero(moved & (outcome == FAILED)).tolist():
        failures[place] = Left("the motion left the tabulated separations")
    history = {name: x for name, x in rows.impacts._asdict().items() if x is not None}
    return out._replace(
        outcome=outcome,
        last_apex_time=np.where(moved, progress.time, np.nan),
        lost=np.asarray(progress.lost),
        history=history,
        measures=_measured(motions, rows),
        at_depth=np.where(moved[:, None], first.at_depth, np.nan),
        release=np.where(moved, begun.origin, np.nan),
    )


def _measured(motions: BatchMotion, rows: ImpactRows) -> dict[str, np.ndarray]:
    """The measures of cases that were integrated, in calls of like lengths."""
    out: dict[str, np.ndarray] = {}
    made, steps, ends = motions.made, motions.steps, motions.ends()
    assert ends is not None
    begun, first = ends
    assert first is not None
    for some in slices(np.flatnonzero(made > 0), steps.width):
        size = _power(int(made[some].max()))
        values = taken((motions.batch, begun, first.contact), some)
        past = jax.tree_util.tree_map(lambda leaf, n=size: leaf[:, :n], taken(rows, some))
        found = motions.clock.run(steps.measure, *values, past)
        real = some >= 0
        for name, value in found._asdict().items():
            array = np.asarray(value)[real]
            if name not in out:
                shape = (made.size, *rows.impacts.made.shape[1 : array.ndim])
                out[name] = np.full(shape, False if array.dtype == bool else np.nan, array.dtype)
            if array.ndim > 1:
                out[name][some[real], : array.shape[1]] = array
            else:
                out[name][some[real]] = array
    return out


def _power(count: int) -> int:
    """A power of two that is enough: few shapes, so few compilations."""
    return max(_LEAST, 1 << max(count - 1, 0).bit_length())
