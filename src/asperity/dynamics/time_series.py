"""A motion as a time series, drawn from the record of its phases."""

from __future__ import annotations

from functools import partial
from typing import NamedTuple

import numpy as np

from .._jax import jax, jnp
from ..numerics.compilation import Program
from ..numerics.polynomials import chebyshev_sum, local
from .curve_table import CENTRAL, RATE, TIME_NODES, Pieces, Table, join, read_row
from .damped_phase import cut, follow
from .external_forces import Along
from .phase import Work, kinetic_along, work_along
from .record import Body, Impacts, Phase
from .resolved_pieces import resolved

_ROUNDING = 1e-12  # of a motion's time
_BATCH = 16  # phases a compiled call
_AGREE = 1e-6  # of its duration: to this two quadratures of a phase agree
_SAMPLES = 40  # on a phase, and again on its part in contact


class Series(NamedTuple):
    """Samples in the order of time.

    Attributes
    ----------
    time, separation, speed
        [s], [m] and [m/s], shape (samples,).
    rows
        Quantities of the contact (see :mod:`.curve_table`), shape (samples, rows).
    dissipated, drag
        By drag: energy taken since the phase began [J], and force over speed [N s/m], shape
        (samples, drags).
    phase
        Index of the phase of each sample, two an impact.
    """

    time: np.ndarray
    separation: np.ndarray
    speed: np.ndarray
    rows: np.ndarray
    dissipated: np.ndarray
    drag: np.ndarray
    phase: np.ndarray


def sample(body: Body, table: Table, impacts: Impacts) -> Series:
    """Draw a motion: its release, then every phase, some samples on each piece of its curves."""
    places = _places(table)
    made = int(np.sum(np.asarray(impacts.made)))
    parts = []
    for first in range(0, made, _BATCH):
        chosen = np.minimum(np.arange(first, first + _BATCH), made - 1)
        rows = jax.tree_util.tree_map(partial(_rows, chosen), impacts)
        drawn = [
            _draw(body, table, phase, ended, jax.device_put(np.asarray(unloading)), places)
            for phase, ended, unloading in (
                (rows.fall, rows.closest_approach_time, False),
                (rows.rise, rows.apex_time, True),
            )
        ]
        count = min(_BATCH, made - first)
        parts.append([np.stack(pair, axis=1)[:count] for pair in zip(*drawn, strict=True)])
    joined = [np.concatenate(column) for column in zip(*parts, strict=True)]
    phase = np.broadcast_to(np.arange(2 * made).reshape(made, 2, 1), joined[0].shape)
    time, separation, speed = (a.ravel() for a in joined[:3])
    time = _onwards(body, time, joined[6].ravel().astype(bool))
    values, dissipated, drag = (a.reshape(time.size, a.shape[-1]) for a in joined[3:6])
    keep = joined[6].ravel().astype(bool)
    row = read_row(table, 0, float(body.release))[: joined[3].shape[-1]]
    still, none = np.zeros(len(body.drags)), np.zeros(joined[4].shape[-1])
    acting = body.resistances(Along.apart(jnp.asarray(row[CENTRAL]))) if body.drags else still
    release = (0.0, body.release, -np.asarray(body.speed), row, none, acting, 0)
    rest = (time, separation, speed, values, dissipated, drag, phase.ravel())
    return Series(
        *(
            np.concatenate([np.asarray(a)[None], b[keep]])
            for a, b in zip(release, rest, strict=True)
        )
    )


def compile_ahead(body: Body, table: Table, impacts: Impacts) -> None:
    """Compile in a thread what draws a motion that is given by its shapes."""

    def some(leaf: jax.Array) -> jax.ShapeDtypeStruct:
        return jax.ShapeDtypeStruct((_BATCH, *leaf.shape[1:]), leaf.dtype)

    rows = jax.tree_util.tree_map(some, impacts)
    unloading = jax.ShapeDtypeStruct((), bool)
    _draw.ahead(body, table, rows.fall, rows.closest_approach_time, unloading, _places(table))


def _onwards(body: Body, time: np.ndarray, keep: np.ndarray) -> np.ndarray:
    """Times [s] without steps back by rounding; larger ones stay, for they are errors.

    A body that drag stops takes for ever to do so: where nothing else acts the times of its last
    samples are not resolved, and none is before another.
    """
    latest = np.maximum.accumulate(np.where(keep, np.maximum(time, 0.0), 0.0))
    back = np.max(np.where(keep, latest - time, 0.0), initial=0.0)
    stops = body.damped_apart and not (body.forces or float(body.weight) > 0.0)
    return latest if stops or back <= _ROUNDING * latest[-1] else time


def _places(table: Table) -> int:
    """Samples on each piece of the curves, besides those close to the turning points."""
    return 1 + 2 * _SAMPLES // table.ends.shape[0]


def _rows(chosen: np.ndarray, leaf: jax.Array) -> np.ndarray:
    return np.asarray(leaf)[chosen]


def until(series: Series, limit: float) -> Series:
    """The samples up to a time limit [s]."""
    kept = series.time <= limit
    return Series(*(column[kept] for column in series))


def _draw_all(
    body: Body, table: Table, phases: Phase, ended: jax.Array, unloading: jax.Array, places: int
) -> tuple[jax.Array, ...]:
    def one(phase: Phase, end: jax.Array) -> tuple[jax.Array, ...]:
        return _draw_one(body, table, phase, end, unloading, places)

    if body.damped:  # phases of few pieces do not wait for those of many
        return jax.lax.map(lambda both: one(*both), (phases, ended))
    return jax.vmap(one)(phases, ended)


_draw = Program(_draw_all)


def _draw_one(
    body: Body, table: Table, phase: Phase, ended: jax.Array, unloading: jax.Array, places: int
) -> tuple[jax.Array, ...]:
    """Time, separation, speed, rows, dissipated, drag and whether to keep, in the order of time."""
    pieces = join(table, phase.branch, phase.inner, phase.start, unloading)
    if body.damped:
        finer, _ = resolved(body, pieces, phase.kinetic, phase.spent)
        return _draw_damped(body, finer, phase, unloading)
    work = work_along(pieces, phase.kinetic, body.load)
    ahead = jnp.where(unloading, 1.0, -1.0)
    path = _path(pieces, phase, places)
    along = jnp.sort(ahead * path)
    ends = ahead * along
    spans = jnp.diff(ends)
    index = jnp.searchsorted(ahead * pieces.leave, 0.5 * (along[1:] + along[:-1]))
    index = jnp.clip(index, 0, pieces.low.shape[0] - 1)
    here = Work(
        Pieces(*(leaf[index] for leaf in pieces)),
        work.integral[:, index],
        jnp.append(work.kinetic[index], 0.0),
        work.load,
    )
    energy = kinetic_along(here, ends[:-1, None] + spans[:, None] * TIME_NODES)
    moving = jnp.logical_and(energy > 0.0, (spans != 0.0)[:, None])
    speed = jnp.sqrt(jnp.where(moving, 2.0 * energy / body.mass, 1.0))
    taken = jnp.sum(jnp.where(moving, RATE / speed, 0.0), axis=1) * jnp.abs(spans)
    taken = taken * _to_end(jnp.sum(taken), ended - phase.begun)
    kinetic = jnp.maximum(kinetic_along(here, ends[1:, None])[:, 0], 0.0)
    # A place is rounded by its distance from the start, which a narrow panel may not allow.
    x = jnp.clip(local(here.pieces.low, here.pieces.high, ends[1:]), -1.0, 1.0)
    rows = chebyshev_sum(jnp.moveaxis(here.pieces.values, 1, 0), x[:, None])
    return (
        phase.begun + jnp.cumsum(taken),
        ends[1:],
        ahead * jnp.sqrt(2.0 * kinetic / body.mass),
        rows,
        _by_jumps(jnp.zeros((spans.size, 0)), phase, ends[1:], unloading),
        jnp.zeros((spans.size, 0)),
        spans != 0.0,
    )


def _to_end(sum_: jax.Array, duration: jax.Array) -> jax.Array:
    """Factor that ends the times of a phase where it was found to end, if these agree."""
    ratio = duration / jnp.where(sum_ > 0.0, sum_, 1.0)
    return jnp.where(jnp.abs(ratio - 1.0) < _AGREE, ratio, 1.0)


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


def _draw_damped(
    body: Body, pieces: Pieces, phase: Phase, unloading: jax.Array
) -> tuple[jax.Array, ...]:
    """The same with drag."""
    passed = cut(pieces, unloading, phase.stop)
    places, times, speeds, heats, drags = follow(body, passed, phase.kinetic)
    x = local(passed.low[:, None], passed.high[:, None], places)
    rows = chebyshev_sum(jnp.moveaxis(passed.values, 1, 0)[:, :, None], x[..., None])
    filled = jnp.broadcast_to((passed.enter != passed.leave)[:, None], places.shape)
    return (
        phase.begun + times.ravel(),
        places.ravel(),
        jnp.where(unloading, 1.0, -1.0) * speeds.ravel(),
        rows.reshape(places.size, -1),
        _by_jumps(heats.reshape(places.size, -1), phase, places.ravel(), unloading),
        drags.reshape(places.size, -1),
        filled.ravel(),
    )


def _by_jumps(
    dissipated: jax.Array, phase: Phase, places: jax.Array, unloading: jax.Array
) -> jax.Array:
    """What drags take, shape (places, drags), and with it what jumps take until there, if any."""
    if not phase.jumps.place.shape[0]:
        return dissipated
    lost = phase.jumps.until(places, unloading)
    return jnp.concatenate([dissipated, lost[:, None]], axis=1)


def _path(pieces: Pieces, phase: Phase, places: int) -> jax.Array:
    """Separations to sample: denser at both turning points, in the contact, on every piece."""
    low, high = jnp.minimum(phase.start, phase.stop), jnp.maximum(phase.start, phase.stop)
    near = jnp.minimum(high, low + 2.0 * jnp.abs(low))
    steps = np.sin(0.5 * np.pi * np.linspace(0.0, 1.0, _SAMPLES)) ** 2
    # On the part of each piece that is passed, denser at its ends.
    enter, leave = jnp.clip(pieces.enter, low, high), jnp.clip(pieces.leave, low, high)
    inner = np.sin(0.5 * np.pi * np.arange(places) / places) ** 2
    passed = enter[:, None] + (leave - enter)[:, None] * inner
    both = [low + (high - low) * steps, low + (near - low) * steps, passed.ravel()]
    return jnp.clip(jnp.concatenate(both), low, high)
