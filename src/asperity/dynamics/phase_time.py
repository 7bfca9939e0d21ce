"""Time over pieces of a phase, by the kinetic energies at the places of a quadrature."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from .._jax import jax, jnp
from .curve_table import RATE, TIME_NODES

NEAR = 3
"""Node of a quadrature up to which the energy must grow as at the end: 0.1 % of a piece on."""

_ROUNDING = 1e-13  # of that energy: less may be none
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
