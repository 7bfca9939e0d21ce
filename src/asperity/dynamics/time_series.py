"""A motion as a time series, drawn from the record of its phases."""

from __future__ import annotations

from functools import partial
from typing import Any, NamedTuple, Self

import numpy as np

from .._jax import jax
from . import damped_series, free_series
from .curve_table import CENTRAL, Quantities, Table, read_row
from .free_series import SAMPLES
from .record import Body, Impacts, resistances_apart

_ROUNDING = 1e-12  # of a motion's time
_BATCH = 16  # phases that are drawn side by side


class Series(NamedTuple):
    """Samples in the order of time.

    Attributes
    ----------
    time, separation, speed
        [s], [m] and [m/s], shape (samples,).
    rows
        Quantities of the contact (see :mod:`.curve_table`), shape (samples, rows).
    lost
        Energy lost since the release [J], by law, then by drag, shape (samples, names).
    drag
        Force over speed of each drag [N s/m], shape (samples, drags).
    phase
        Index of the phase of each sample, two an impact.
    """

    time: np.ndarray
    separation: np.ndarray
    speed: np.ndarray
    rows: np.ndarray
    lost: np.ndarray
    drag: np.ndarray
    phase: np.ndarray

    def until(self, limit: float) -> Self:
        """The samples up to a time limit [s]."""
        kept = self.time <= limit
        return type(self)(*(column[kept] for column in self))


def sample(body: Body, table: Table, impacts: Impacts) -> Series:
    """Draw a motion: its release, then every phase, some samples on each piece of its curves."""
    made = int(np.sum(np.asarray(impacts.made)))
    parts = []
    for first in range(0, made, _BATCH):
        chosen = np.minimum(np.arange(first, first + _BATCH), made - 1)
        count = min(_BATCH, made - first)
        chosen = chosen if body.damped else chosen[:count]  # what is compiled has one width
        rows = jax.tree_util.tree_map(partial(_rows, chosen), impacts)
        drawn = [_phases(body, table, rows, unloading=unloading) for unloading in (False, True)]
        parts.append([np.stack(pair, axis=1)[:count] for pair in zip(*drawn, strict=True)])
    joined = [np.concatenate(column) for column in zip(*parts, strict=True)]
    phase = np.broadcast_to(np.arange(2 * made).reshape(made, 2, 1), joined[0].shape)
    time, separation, speed = (a.ravel() for a in joined[:3])
    time = _onwards(body, time, joined[6].ravel().astype(bool))
    values, lost, drag = (a.reshape(time.size, a.shape[-1]) for a in joined[3:6])
    keep = joined[6].ravel().astype(bool)
    row = read_row(table, 0, float(body.release))[: joined[3].shape[-1]]
    still, none = np.zeros(len(body.drags)), np.zeros(joined[4].shape[-1])
    acting = resistances_apart(body, np.asarray(row[CENTRAL])) if body.drags else still
    release = (0.0, body.release, -np.asarray(body.speed), row, none, acting, 0)
    rest = (time, separation, speed, values, lost, drag, phase.ravel())
    return Series(
        *(
            np.concatenate([np.asarray(a)[None], b[keep]])
            for a, b in zip(release, rest, strict=True)
        )
    )


def compile_ahead(body: Body, table: Table, impacts: Impacts) -> None:
    """Compile in a thread what draws a motion that is given by its shapes, if anything does."""
    if not body.damped:
        return

    def some(leaf: jax.Array) -> jax.ShapeDtypeStruct:
        return jax.ShapeDtypeStruct((_BATCH, *leaf.shape[1:]), leaf.dtype)

    fall = jax.tree_util.tree_map(some, impacts.fall)
    damped_series.draw.ahead(body, table, fall, jax.ShapeDtypeStruct((), bool))


def _phases(body: Body, table: Table, rows: Impacts, *, unloading: bool) -> tuple[np.ndarray, ...]:
    """Those of impacts in one direction: see :func:`.free_series.draw`; all that is lost."""
    phases: Any = rows.rise if unloading else rows.fall
    drawn: Any
    if body.damped:
        drawn = damped_series.draw(body, table, phases, jax.device_put(np.asarray(unloading)))
    else:
        ended = np.asarray(rows.apex_time if unloading else rows.closest_approach_time)
        panels = np.unique(np.asarray(table.ends)).size  # but for empty ones
        places = 1 + 2 * SAMPLES // panels  # on each piece, besides those at its turns
        drawn = free_series.draw(body, table, phases, ended, places, unloading=unloading)
    time, separation, speed, values, dissipated, drag, keep = drawn
    bonds = np.asarray(values)[..., Quantities(phases.bonds.shape[1], 0).bonds]
    change, (formed, broken) = bonds - phases.bonds[:, None], np.asarray(table.losses)
    by_law = np.maximum(change, 0.0) * formed + np.maximum(-change, 0.0) * broken
    lost = phases.lost[:, None] + np.concatenate([by_law, dissipated], axis=-1)
    return time, separation, speed, values, lost, drag, keep


def _onwards(body: Body, time: np.ndarray, keep: np.ndarray) -> np.ndarray:
    """Times [s] without steps back by rounding; larger ones stay, for they are errors.

    A body that drag stops takes for ever to do so: where nothing else acts the times of its last
    samples are not resolved, and none is before another.
    """
    latest = np.maximum.accumulate(np.where(keep, np.maximum(time, 0.0), 0.0))
    back = np.max(np.where(keep, latest - time, 0.0), initial=0.0)
    stops = body.damped_apart and not (body.forces or float(body.weight) > 0.0)
    return latest if stops or back <= _ROUNDING * latest[-1] else time


def _rows(chosen: np.ndarray, leaf: jax.Array) -> np.ndarray:
    return np.asarray(leaf)[chosen]


def ascending(lost: np.ndarray, least: float) -> np.ndarray:
    """Losses that never fall, where they fall by no more than ``least``: the curves' own error.

    Parameters
    ----------
    lost
        Energy lost since the release [J], shape (samples, names).
    least
        Energy [J] to which they are known; a name that falls by more is left as it is.
    """
    highest = np.maximum.accumulate(lost, axis=0)
    exact = np.max(highest - lost, axis=0, initial=0.0) <= least
    return np.where(exact, highest, lost)
