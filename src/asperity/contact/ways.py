"""Places on the way from a reversal to a branch, and down to where a body cannot come."""

from __future__ import annotations

from typing import Any

import numpy as np

from .._jax import jax, jnp


def way_points(nodes: int) -> np.ndarray:
    """Chebyshev points on a piece, as fractions of the way along it."""
    points: np.ndarray = 0.5 * (1.0 + np.polynomial.chebyshev.chebpts1(nodes))
    return points


def pieces_to(
    marks: jax.Array, start: jax.Array, parting: jax.Array, within: tuple[Any, Any]
) -> tuple[jax.Array, jax.Array]:
    """Ends of the pieces from a reversal to the last of the ``marks``, ``within`` bounds [m]."""
    ahead = jnp.where(parting, 1.0, -1.0)
    marks = jnp.clip(marks, *within)
    marks = start + ahead * jnp.sort(jnp.maximum(ahead * (marks - start), 0.0))
    return jnp.concatenate([start[None], marks])[:-1], marks


def first_out_of_reach(
    values: jax.Array, level: jax.Array, places: jax.Array, release: jax.Array
) -> jax.Array:
    """The first of descending ``places`` below ``release`` where ``values`` exceed ``level``."""
    above = jnp.logical_and(jnp.logical_not(values <= level), places < release)
    index = jnp.where(jnp.any(above), jnp.argmax(above), places.shape[0] - 1)
    return jnp.asarray(places)[index]
