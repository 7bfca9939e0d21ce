"""Where a body would rest, and where contact ends."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from .._jax import jax, jnp
from ..numerics.compilation import kept
from ..numerics.polynomials import chebyshev_sum, local
from ..numerics.roots import root_between
from .curve_table import FORCE, STORED, Table
from .external_forces import Load

_NEGLIGIBLE = 1e-6  # of the largest force: below it bodies are apart
_PLACES = 32
_CLOSE = 1e-15  # of a panel: the step that follows one so short is lost in rounding


@kept
class Reference(NamedTuple):
    """Separations from which a motion is measured.

    Attributes
    ----------
    equilibrium
        Static equilibrium on approach [m]: the outermost separation at which the contact
        carries the load, or a spring alone holds the body. NaN where there is none (no
        gravity and no adhesion).
    stored
        Stored energy there [J]; NaN where there is none.
    """

    equilibrium: jax.Array
    stored: jax.Array


def find_reference(table: Table, load: Load, branch: int) -> Reference:
    """Static equilibrium on a branch of approach."""
    values, still = table.values[branch], jax.lax.stop_gradient(load)

    def carries(force: jax.Array, place: jax.Array) -> jax.Array:
        pressed = still.force(place)
        return force - (pressed + 1e-9 * jnp.abs(pressed))

    place, panel, found = _outermost(table.ends, values[..., FORCE], carries)
    x = local(table.ends[panel], table.ends[panel + 1], place)
    excess = chebyshev_sum(values[panel, :, FORCE], x) - load.force(place)
    slope = _slope(values[panel, :, FORCE], x, table.ends, panel) - still.slope(place)
    place = _carrying(place, excess, slope)
    x = local(table.ends[panel], table.ends[panel + 1], place)
    stored = chebyshev_sum(values[panel, :, STORED], x)
    return Reference(jnp.where(found, place, jnp.nan), jnp.where(found, stored, jnp.nan))


def end_of_contact(table: Table, peak: jax.Array) -> jax.Array:
    """Outermost separation [m] at which any branch carries 1e-6 of the peak force."""
    least = _NEGLIGIBLE * peak
    ends = jax.vmap(lambda force: _end(table.ends, force, least))(table.values[..., FORCE])
    return jnp.max(ends)


def _end(ends: jax.Array, force: jax.Array, least: jax.Array) -> jax.Array:
    """The outermost separation [m] at which the size of a branch's force is above ``least``."""
    still = jax.lax.stop_gradient(least)
    place, panel, _ = _outermost(ends, force, lambda size, _: jnp.abs(size) - still)
    x = local(ends[panel], ends[panel + 1], place)
    carried = chebyshev_sum(force[panel], x)
    # Where the force jumps over that size there is no root to follow, only an end of a panel.
    meets = jnp.abs(jnp.abs(carried) - least) < 1e-3 * least
    slope = jnp.where(meets, jnp.sign(carried) * _slope(force[panel], x, ends, panel), 0.0)
    return _carrying(place, jnp.where(meets, jnp.abs(carried) - least, 0.0), slope)


def _carrying(place: jax.Array, excess: jax.Array, slope: jax.Array) -> jax.Array:
    """A place that was found, with the derivative that a Newton step to it has."""
    slope = jax.lax.stop_gradient(slope)
    correction = excess / jnp.where(slope == 0.0, 1.0, slope)
    return place - (correction - jax.lax.stop_gradient(correction))


def _outermost(
    ends: jax.Array, force: jax.Array, excess: Callable[[jax.Array, jax.Array], jax.Array]
) -> tuple[jax.Array, jax.Array, jax.Array]:
    """The largest separation at which a function of force and separation begins to be positive.

    The root is sought between two places that are looked at.
    """
    ends, force = jax.lax.stop_gradient((ends, force))
    fractions = np.linspace(0.0, 1.0, _PLACES)  # the ends of a panel are places of its own
    sampled = jax.vmap(lambda row: chebyshev_sum(row[:, None], jnp.asarray(2.0 * fractions - 1.0)))(
        force
    )
    places = ends[:-1, None] + jnp.diff(ends)[:, None] * fractions
    filled = (ends[1:] > ends[:-1])[:, None]
    holds = jnp.logical_and(excess(sampled, places) > 0.0, filled).ravel()
    index = holds.shape[0] - 1 - jnp.argmax(holds[::-1])
    panel, place = index // _PLACES, index % _PLACES
    low, width, row = ends[panel], ends[panel + 1] - ends[panel], force[panel]

    def value(at: jax.Array) -> jax.Array:
        return excess(chebyshev_sum(row, 2.0 * at - 1.0), low + width * at)

    at = jnp.asarray(fractions)
    near, far = at[place], at[jnp.minimum(place + 1, _PLACES - 1)]
    return low + width * root_between(value, near, far, _CLOSE), panel, jnp.any(holds)


def _slope(coefficients: jax.Array, x: jax.Array, ends: jax.Array, panel: jax.Array) -> jax.Array:
    width = ends[panel + 1] - ends[panel]
    rate = jax.jvp(lambda s: chebyshev_sum(coefficients, s), (x,), (jnp.ones_like(x),))[1]
    return rate * 2.0 / jnp.where(width > 0.0, width, 1.0)
