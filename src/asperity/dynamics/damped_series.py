"""Phases with drag as time series: each is followed once more, by compiled code."""

from __future__ import annotations

from .._jax import jax, jnp
from ..numerics.compilation import Program
from ..numerics.polynomials import chebyshev_sum, local
from .curve_table import Table, join
from .damped_phase import cut, follow
from .record import Body, Phase
from .resolved_pieces import resolved


def _draw_all(
    body: Body, table: Table, phases: Phase, unloading: jax.Array
) -> tuple[jax.Array, ...]:
    """Time, separation, speed, rows, dissipated, drag and whether to keep, in the order of time."""
    # Phases of few pieces do not wait for those of many.
    return jax.lax.map(lambda phase: _draw_one(body, table, phase, unloading), phases)


draw = Program(_draw_all)
"""As :func:`asperity.dynamics.free_series.draw`, in the order of time."""


def _draw_one(
    body: Body, table: Table, phase: Phase, unloading: jax.Array
) -> tuple[jax.Array, ...]:
    pieces = join(table, phase.branch, phase.inner, phase.start, unloading)
    finer, _ = resolved(body, pieces, phase.kinetic, phase.spent)
    passed = cut(finer, unloading, phase.stop)
    places, times, speeds, heats, drags = follow(body, passed, phase.kinetic)
    x = local(passed.low[:, None], passed.high[:, None], places)
    rows = chebyshev_sum(jnp.moveaxis(passed.values, 1, 0)[:, :, None], x[..., None])
    filled = jnp.broadcast_to((passed.enter != passed.leave)[:, None], places.shape)
    dissipated = heats.reshape(places.size, -1)
    if phase.jumps.place.shape[0]:
        lost = phase.jumps.until(places.ravel(), unloading)
        dissipated = jnp.concatenate([dissipated, lost[:, None]], axis=1)
    return (
        phase.begun + times.ravel(),
        places.ravel(),
        jnp.where(unloading, 1.0, -1.0) * speeds.ravel(),
        rows.reshape(places.size, -1),
        dissipated,
        drags.reshape(places.size, -1),
        filled.ravel(),
    )
