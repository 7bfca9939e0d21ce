"""Time of a phase: over pieces, by the kinetic energies at the places of a quadrature."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from .._jax import jax, jnp
from ..numerics.polynomials import NODES, chebyshev_sum, local
from .curve_table import FORCE, RATE, TIME_NODES
from .phase import Ahead, TurningPoint, Work, kinetic_along

NEAR = 3
"""Node of a quadrature up to which the energy must grow as at the end: 0.1 % of a piece on."""

_ROUNDING = 1e-13  # of that energy: less may be none
_TIME_NODES_AND_ENDS = np.concatenate([[0.0], TIME_NODES, [1.0]])  # with both ends
_BOTH = np.array([0, -1])
_ALTERNATE = (-1.0) ** np.arange(NODES)  # Chebyshev polynomials at the lower end
_SLOW = 0.01  # of the energy that a piece adds: entered with more, it is summed to 1e-9


class Ends(NamedTuple):
    """Kinetic energy [J] where pieces begin and end, and force on the body there [N]."""

    first: jax.Array
    last: jax.Array
    first_push: jax.Array
    last_push: jax.Array

    @classmethod
    def of(cls, energies: jax.Array, pushes: jax.Array) -> Ends:
        """From columns of which the outermost are the ends."""
        return cls(energies[:, 0], energies[:, -1], pushes[:, 0], pushes[:, -1])

    def gains(self, span: jax.Array) -> tuple[jax.Array, jax.Array]:
        """Energy [J] that each end's force would give over the whole piece, away from that end."""
        return self.first_push * span, -self.last_push * span


def time_over(
    span: jax.Array, used: jax.Array, energies: jax.Array, mass: jax.Array, ends: Ends
) -> jax.Array:
    """Time [s] over pieces with kinetic energies [J] at the places TIME_NODES of each.

    With what the quadrature misses where the body is at rest just before a piece, or just after.
    """
    squares = jnp.where(energies > 0.0, 2.0 / mass * energies, jnp.inf)  # of the speeds
    slowness = jnp.sum(RATE * jax.lax.rsqrt(squares), axis=1)
    near = energies[:, NEAR], energies[:, -1 - NEAR]
    for energy, gain, beside in zip((ends.first, ends.last), ends.gains(span), near, strict=True):
        grown = energy + gain * TIME_NODES[NEAR]
        missed = jnp.where(jnp.abs(beside - grown) < 0.1 * grown, missed_time(energy, gain), 0.0)
        slowness = slowness + missed * jnp.sqrt(0.5 * mass)
    return jnp.sum(jnp.where(used, slowness * jnp.abs(span), 0.0))


def missed_time(
    energy: jax.Array,
    gain: jax.Array,
    places: np.ndarray = TIME_NODES,
    weights: np.ndarray = RATE,
) -> jax.Array:
    """What a quadrature misses of the integral of (energy + gain y)^-1/2 over y from 0 to 1."""
    slow = (energy > _ROUNDING * gain) & (energy < _SLOW * gain)
    safe, by = jnp.where(slow, energy, 1.0), jnp.where(slow, gain, 1.0)
    exact = 2.0 / (jnp.sqrt(safe + by) + jnp.sqrt(safe))
    found = jnp.sum(weights * jax.lax.rsqrt(safe[..., None] + by[..., None] * places), axis=-1)
    return jnp.where(slow, exact - found, 0.0)


def travel_time(ahead: Ahead, turn: TurningPoint, mass: jax.Array) -> jax.Array:
    """Time [s] from the start of a phase to its turn."""
    total = _time_of_whole(ahead, turn, mass) + _time_of_parts(ahead, turn, mass)
    return total + _time_before(ahead, turn, mass) if ahead.pieces else total


def _until(ahead: Ahead, turn: TurningPoint, place: jax.Array) -> jax.Array:
    near, far = jnp.minimum(place, turn.place), jnp.maximum(place, turn.place)
    return jnp.where(ahead.unloading, near, far)


def _time_of_whole(ahead: Ahead, turn: TurningPoint, mass: jax.Array) -> jax.Array:
    """On panels passed as a whole, whose work is known at all places of the quadrature."""
    table, panel = ahead.table, turn.piece - ahead.pieces
    index = np.arange(table.ends.shape[0] - 1)
    low, high = jnp.minimum(panel, ahead.panel), jnp.maximum(panel, ahead.panel)
    whole = (panel >= 0) & (low < index) & (index < high)
    nodes, looks = table.works.nodes[ahead.branch], table.works.looks[ahead.branch]
    first, last = (
        ahead.outer(looks[:, k], places)
        for k, places in ((0, table.ends[:-1]), (-1, table.ends[1:]))
    )
    force = table.values[ahead.branch, :, :, FORCE]
    load = ahead.inner.load
    pushes = (
        jnp.sum(force * _ALTERNATE, axis=1) - load.force(table.ends[:-1]),
        jnp.sum(force, axis=1) - load.force(table.ends[1:]),
    )
    ends = Ends(first, last, *pushes)
    energies = ahead.outer(nodes, table.nodes)
    return time_over(jnp.diff(table.ends), whole, energies, mass, ends)


def _time_of_parts(ahead: Ahead, turn: TurningPoint, mass: jax.Array) -> jax.Array:
    """On the panel in which the branch begins, and on the one in which the body turns."""
    table, panel = ahead.table, turn.piece - ahead.pieces
    panels = jnp.stack([ahead.panel, panel])
    low, high = table.ends[panels], table.ends[panels + 1]
    near, far = (
        jnp.where(ahead.unloading, high[0], low[0]),
        jnp.where(ahead.unloading, low[1], high[1]),
    )
    first = jnp.stack([ahead.begin, far])
    last = jnp.stack([_until(ahead, turn, near), turn.place])
    span = last - first
    integral = table.works.integral[ahead.branch, panels, :, 0]
    start = local(low, high, first)[:, None]
    x = start + (local(low, high, last)[:, None] - start) * _TIME_NODES_AND_ENDS
    distance = (first - ahead.begin)[:, None] + span[:, None] * _TIME_NODES_AND_ENDS
    energies = ahead.gained(chebyshev_sum(integral.T[:, :, None], x), distance)
    energies = _resting(turn, last, energies.at[0, 0].set(ahead.inner.kinetic[-1]))
    force = table.values[ahead.branch, panels, :, FORCE]
    both = chebyshev_sum(force.T[:, :, None], x[:, _BOTH])
    ends = Ends.of(energies, both - ahead.inner.load.force(jnp.stack([first, last], axis=1)))
    used = (panel >= 0) & jnp.stack([jnp.asarray(True), panel != ahead.panel])
    return time_over(span, used, energies[:, 1:-1], mass, ends)


def _time_before(ahead: Ahead, turn: TurningPoint, mass: jax.Array) -> jax.Array:
    """On the pieces before the branch."""
    p = ahead.inner.pieces
    ends = _until(ahead, turn, p.enter), _until(ahead, turn, p.leave)
    return time_along(ahead.inner, ends, mass, lambda last, e: _resting(turn, last, e))


def time_along(
    work: Work,
    ends: tuple[jax.Array, jax.Array],
    mass: jax.Array,
    resting: Callable[[jax.Array, jax.Array], jax.Array] = lambda last, energies: energies,
) -> jax.Array:
    """Time [s] over pieces between two places of each [m].

    Parameters
    ----------
    work
        The pieces, with the kinetic energy along them.
    ends
        Where the body enters and leaves each.
    mass
        Mass [kg].
    resting
        Sets the energies at places of the pieces to 0 where the body turns at the last.
    """
    p, (enter, leave) = work.pieces, ends
    span = leave - enter
    places = enter[:, None] + span[:, None] * _TIME_NODES_AND_ENDS
    energies = resting(leave, kinetic_along(work, places))
    both = places[:, _BOTH]
    x = local(p.low[:, None], p.high[:, None], both)
    force = chebyshev_sum(p.values[..., FORCE].T[:, :, None], x)
    at_ends = Ends.of(energies, force - work.load.force(both))
    return time_over(span, span != 0.0, energies[:, 1:-1], mass, at_ends)


def _resting(turn: TurningPoint, last: jax.Array, energies: jax.Array) -> jax.Array:
    """The energies of pieces, the last of each 0 where the body turns there: not its rounding."""
    still = turn.found & (last == turn.place)
    return energies.at[:, -1].set(jnp.where(still, 0.0, energies[:, -1]))
