"""Where a body is released: outside every force's range."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from .._jax import jax, jnp
from ..numerics.compilation import kept
from .curve_table import FORCE, Table, outer_row
from .record import Body

TRIES = 16
"""Places that are tried, one after another, where no release is given."""

_WITHIN = 0.9  # of the release: between there and it the force is taken as a power of the distance
_LEAST = 0.5  # of that power: a force that falls more slowly is looked at anew from further out
_MOST = 100.0  # times as far in one step
_BEYOND = 1.02  # of the distance, for what the power misses


@kept
class AtRelease(NamedTuple):
    """What tells whether a body is released outside contact.

    Attributes
    ----------
    force, power
        Size of the contact force at the release [N], and by which power of the distance it falls
        there [-].
    largest
        Largest contact force in the table [N].
    load
        Largest force that presses the body, or holds it, on its way without contact [N].
    """

    force: jax.Array
    power: jax.Array
    largest: jax.Array
    load: jax.Array


def at_release(table: Table, body: Body) -> AtRelease:
    """The forces at the release.

    Parameters
    ----------
    table
        Curves of the contact.
    body
        The body.
    """
    places = jnp.stack([body.release * 1.0, _WITHIN * body.release])
    force, nearer = jnp.abs(jax.vmap(lambda d: outer_row(table, 0, d)[FORCE])(places))
    both = (force > 0.0) & (nearer > 0.0)
    ratio = jnp.where(both, nearer, 1.0) / jnp.where(both, force, 1.0)
    power = jnp.log(ratio) / -np.log(_WITHIN)
    load = body.weight
    if body.forces:
        ends = jnp.stack([body.release * 1.0, table.ends[-1]])
        load = jnp.max(jnp.abs(body.load.force(ends)))
    return AtRelease(force, power, jnp.max(jnp.abs(table.values[..., 0, FORCE])), load)


def negligible_force(load: np.ndarray, largest: np.ndarray, *, chosen: bool = False) -> np.ndarray:
    """Force [N] below which a body counts as outside contact.

    Parameters
    ----------
    load
        Weight of the body, or what :class:`AtRelease` says of a spring [N].
    largest
        Largest force of the contact [N].
    chosen
        Whether the release is the program's, or a spring holds the body. It then lies where the
        force is 1e-3 of the load or 1e-6 of the largest, whichever is nearer: a body that was
        given a speed is not to fall far. A release that the user gives is held to the first of
        these, or without weight the second.
    """
    of_load, of_largest = 1e-3 * load, 1e-6 * largest
    if chosen:
        return np.maximum(of_load, of_largest)
    return np.where(load > 0.0, of_load, of_largest)


def farther(
    release: np.ndarray, force: np.ndarray, power: np.ndarray, limit: np.ndarray
) -> np.ndarray:
    """Separation [m] at which a force above the limit is likely to have fallen below it."""
    ratio = np.maximum(force / np.where(limit > 0.0, limit, np.inf), 1.0)
    factor: np.ndarray = _BEYOND * ratio ** (1.0 / np.maximum(power, _LEAST))
    return release * np.minimum(factor, _MOST)
