"""The first contact of a motion: where it ends, how long it lasts, what pulls the body back."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from .._jax import jax, jnp
from ..dynamics import Body, Impacts, Table
from ..dynamics.curve_table import join
from ..dynamics.damped_phase import kinetic_and_time_at
from ..dynamics.record import Phase
from ..dynamics.static_equilibrium import end_of_contact
from ..dynamics.unloading import Unloading, unloading
from ..laws.law import Real
from ..numerics.compilation import kept

_TOUCH = 1e-9  # of what a spring presses or holds with: less force is no contact
_LEAST = 1e-6  # of the force of one impact: none is gentler
_DRAGGED = 1e-3  # of the load, which drag leaves a contact to carry at a turn


@kept
class FirstContact(NamedTuple):
    """The first contact of a motion.

    Attributes
    ----------
    end
        End of contact: the outermost separation [m] at which the force is 1e-6 of the largest
        one, at a deepest point or at pull-off. NaN of a body on a spring that never touches.
    time
        Time spent within it in the first impact [s]; NaN where the body is captured.
    force
        Largest contact force of that impact [N].
    unloading
        What pulls the body back after it.
    outset
        As in :class:`asperity.results.measures.Measures` [m].
    """

    end: jax.Array
    time: jax.Array
    force: jax.Array
    unloading: Unloading
    outset: jax.Array

    @classmethod
    def unknown(cls, count: int) -> FirstContact:
        """Those of so many motions before their first impact."""
        none: Any = np.full(count, np.nan)
        pulled = Unloading(none, none, none, none, np.zeros(count, bool))  # type: ignore[arg-type]
        return cls(none, none, none, pulled, none)


Passing = tuple[jax.Array, jax.Array]
"""Kinetic energies [J] at the end of contact on the way in and out, per impact."""


def first_contact(table: Table, rows: Impacts, body: Body) -> FirstContact:
    """The first contact of a motion, from the phases of its first impact."""
    fall, rise = (
        jax.tree_util.tree_map(lambda leaf: leaf[0], phase) for phase in (rows.fall, rows.rise)
    )
    pulled = unloading(table, rise)
    peak = jnp.max(jnp.where(rows.made, jnp.abs(rows.force), 0.0))
    largest = jnp.maximum(peak, pulled.pull_off)
    gentlest = least_peak(body, pulled.pull_off, peak)
    peaks = jnp.stack([largest, gentlest])
    end, outset = jax.vmap(lambda size: end_of_contact(table, size))(peaks)
    if body.forces:
        ends = jnp.stack([body.release, rows.apex[0], rows.closest_approach[0]])
        most = jnp.max(jnp.abs(body.load.force(ends)))
        end = jnp.where(largest > _TOUCH * most, end, jnp.nan)
    phases = jax.tree_util.tree_map(lambda *two: jnp.stack(two), fall, rise)
    made = jnp.repeat(rows.made[:1], 2)
    _, (inwards, outwards) = _passing(body, table, phases, np.array([False, True]), made, end)
    time = rows.closest_approach_time[0] - fall.begun - inwards + outwards
    return FirstContact(
        end=end,
        time=jnp.where(rows.apex[0] >= end, time, jnp.nan),
        force=rows.force[0],
        unloading=pulled,
        outset=outset,
    )


def least_peak(body: Body, pull_off: Real, peak: Real) -> jax.Array:
    """Largest force of the gentlest impact [N]: the load or the pull-off force.

    Drag may stop a body where the contact carries far less than its load.
    """
    carried = jnp.maximum(body.load.force(jnp.zeros(())), 0.0)
    carried = _DRAGGED * carried if body.damped_apart else carried
    return jnp.maximum(jnp.maximum(carried, pull_off), _LEAST * peak)


def passing_at(body: Body, table: Table, rows: Impacts, place: jax.Array) -> Passing:
    """Kinetic energies [J] with which each impact passes a place [m] outside contact."""
    phases = jax.tree_util.tree_map(lambda *two: jnp.concatenate(two), rows.fall, rows.rise)
    count = rows.made.shape[0]
    unloading = np.repeat([False, True], count)
    kinetic, _ = _passing(body, table, phases, unloading, jnp.tile(rows.made, 2), place)
    return kinetic[:count], kinetic[count:]


def _passing(
    body: Body,
    table: Table,
    phases: Phase,
    unloading: np.ndarray,
    made: jax.Array,
    place: jax.Array,
) -> tuple[jax.Array, jax.Array]:
    """Kinetic energy [J] and time [s] with which phases that were made pass a place [m]."""

    def one(asked: tuple[Phase, jax.Array, jax.Array]) -> tuple[jax.Array, jax.Array]:
        phase, unloads, real = asked
        pieces = join(table, phase.branch, phase.inner, phase.start, unloads)
        return jax.lax.cond(
            real,
            lambda: kinetic_and_time_at(body, pieces, phase, unloads, place),
            lambda: (jnp.zeros(()), jnp.zeros(())),
        )

    return jax.lax.map(one, (phases, jnp.asarray(unloading), made))
