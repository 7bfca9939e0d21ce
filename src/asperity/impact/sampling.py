"""A motion as a time series, drawn from the record of its phases."""

from __future__ import annotations

from typing import NamedTuple

import equinox as eqx
import numpy as np

from .._jax import jax, jnp
from .motion import Body, Impacts, Phase
from .phase import kinetic_along, work_along
from .table import Table, chebyshev_sum, join, local, outer_row

_GAUSS, _WEIGHT = np.polynomial.legendre.leggauss(12)
_Y = 0.5 * (_GAUSS + 1.0)
_RISE = np.sin(0.5 * np.pi * _Y) ** 2
_RATE = 0.25 * np.pi * np.sin(np.pi * _Y) * _WEIGHT
_BATCH = 16  # phases a compiled call
_SAMPLES = 80  # a phase, about


class Series(NamedTuple):
    """Samples in the order of time.

    Attributes
    ----------
    time, separation, speed
        [s], [m] and [m/s], shape (samples,).
    rows
        Quantities of the contact (see :mod:`.table`), shape (samples, rows).
    phase
        Index of the phase of each sample, two an impact.
    """

    time: np.ndarray
    separation: np.ndarray
    speed: np.ndarray
    rows: np.ndarray
    phase: np.ndarray


def sample(body: Body, table: Table, impacts: Impacts) -> Series:
    """Draw a motion: its release, then every phase, some samples on each piece of its curves."""
    places = 1 + _SAMPLES // (table.ends.shape[0] - 1)
    made = int(np.sum(np.asarray(impacts.made)))
    parts = []
    for first in range(0, made, _BATCH):
        chosen = np.minimum(np.arange(first, first + _BATCH), made - 1)
        rows = jax.tree_util.tree_map(lambda leaf: np.asarray(leaf)[chosen], impacts)  # noqa: B023
        drawn = [
            _draw(body, table, phase, jnp.asarray(parting), places)
            for phase, parting in ((rows.fall, False), (rows.rise, True))
        ]
        count = min(_BATCH, made - first)
        parts.append([np.stack(pair, axis=1)[:count] for pair in zip(*drawn, strict=True)])
    joined = [np.concatenate(column) for column in zip(*parts, strict=True)]
    phase = np.broadcast_to(np.arange(2 * made).reshape(made, 2, 1), joined[0].shape)
    time, separation, speed, kept = (a.ravel() for a in (*joined[:3], joined[4]))
    values = joined[3].reshape(time.size, -1)
    keep = kept.astype(bool)
    row = outer_row(table, 0, jnp.asarray(body.release))
    release = (0.0, body.release, -body.speed, row, 0)
    rest = (time[keep], separation[keep], speed[keep], values[keep], phase.ravel()[keep])
    return Series(
        *(np.concatenate([np.asarray(a)[None], b]) for a, b in zip(release, rest, strict=True))
    )


@eqx.filter_jit
def _draw(
    body: Body, table: Table, phases: Phase, parting: jax.Array, places: int
) -> tuple[jax.Array, ...]:
    return jax.vmap(lambda phase: _draw_one(body, table, phase, parting, places))(phases)


def _draw_one(
    body: Body, table: Table, phase: Phase, parting: jax.Array, places: int
) -> tuple[jax.Array, ...]:
    """Time, separation, speed, rows and whether to keep, flat over pieces and places."""
    pieces = join(table, phase.branch, phase.inner, phase.start, parting)
    work = work_along(pieces, phase.kinetic, body.weight)

    def until(place: jax.Array) -> jax.Array:
        return jnp.where(parting, jnp.minimum(place, phase.stop), jnp.maximum(place, phase.stop))

    enter = until(pieces.enter)
    length = until(pieces.leave) - enter
    steps = np.sin(0.5 * np.pi * np.arange(places + 1) / places) ** 2
    ends = enter[:, None] + length[:, None] * steps
    spans = jnp.diff(ends, axis=1)
    inner = ends[:, :-1, None] + spans[..., None] * _RISE
    shape = inner.shape
    energy = kinetic_along(work, inner.reshape(shape[0], -1)).reshape(shape)
    moving = jnp.logical_and(energy > 0.0, spans[..., None] != 0.0)
    speed = jnp.sqrt(jnp.where(moving, 2.0 * energy / body.mass, 1.0))
    taken = jnp.sum(jnp.where(moving, _RATE / speed, 0.0), axis=2) * jnp.abs(spans)
    time = phase.begun + jnp.cumsum(taken.ravel())
    at = ends[:, 1:]
    kinetic = jnp.maximum(kinetic_along(work, at), 0.0)
    x = local(pieces.low[:, None], pieces.high[:, None], at)
    rows = chebyshev_sum(jnp.moveaxis(pieces.values, 1, 0)[:, :, None, :], x[..., None])
    away = jnp.where(parting, 1.0, -1.0)
    return (
        time,
        at.ravel(),
        (away * jnp.sqrt(2.0 * kinetic / body.mass)).ravel(),
        rows.reshape(-1, rows.shape[-1]),
        (spans != 0.0).ravel(),
    )
