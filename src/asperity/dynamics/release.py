"""Where a body is released: outside every force's range."""

from __future__ import annotations

import numpy as np

from .._jax import jax, jnp
from .curve_table import FORCE, Table, outer_row
from .record import Body

TRIES = 16
"""Places that are tried, one after another, where no release is given."""

_WITHIN = 0.9  # of the release: between there and it the force is taken as a power of the distance
_LEAST = 0.5  # of that power: a force that falls more slowly is looked at anew from further out
_MOST = 100.0  # times as far in one step
_BEYOND = 1.02  # of the distance, for what the power misses


def at_release(table: Table, body: Body) -> tuple[jax.Array, jax.Array, jax.Array]:
    """The force at the release, by which power of the distance it falls there, and the largest.

    Parameters
    ----------
    table
        Curves of the contact.
    body
        The body.

    Returns
    -------
    Size of the force at the release [N], the power [-], and the largest force in the table [N].
    """
    places = jnp.stack([body.release * 1.0, _WITHIN * body.release])
    force, nearer = jnp.abs(jax.vmap(lambda d: outer_row(table, 0, d)[FORCE])(places))
    both = (force > 0.0) & (nearer > 0.0)
    ratio = jnp.where(both, nearer, 1.0) / jnp.where(both, force, 1.0)
    power = jnp.log(ratio) / -np.log(_WITHIN)
    return force, power, jnp.max(jnp.abs(table.values[..., 0, FORCE]))


def negligible_force(
    weight: np.ndarray, largest: np.ndarray, *, chosen: bool = False
) -> np.ndarray:
    """Force [N] below which a body counts as outside contact.

    Parameters
    ----------
    weight
        Weight of the body [N].
    largest
        Largest force of the contact [N].
    chosen
        Whether the release is the program's. It then lies where the force is 1e-3 of the weight or
        1e-6 of the largest, whichever is nearer: a body that was given a speed is not to fall far.
        A release that the user gives is held to the first of these, or without weight the second.
    """
    of_weight, of_largest = 1e-3 * weight, 1e-6 * largest
    if chosen:
        return np.maximum(of_weight, of_largest)
    return np.where(weight > 0.0, of_weight, of_largest)


def farther(
    release: np.ndarray, force: np.ndarray, power: np.ndarray, limit: np.ndarray
) -> np.ndarray:
    """Separation [m] at which a force above the limit is likely to have fallen below it."""
    ratio = np.maximum(force / np.where(limit > 0.0, limit, np.inf), 1.0)
    factor: np.ndarray = _BEYOND * ratio ** (1.0 / np.maximum(power, _LEAST))
    return release * np.minimum(factor, _MOST)
