"""Asperities that yield and are loaded for the first time: their means over the heights."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from .._jax import jax, jnp
from ..laws.plastic import PlasticContact
from ..surfaces.heights.distribution import Heights
from .height_quadrature import ladder, points
from .residual_profile import HIGHEST, flatness

_EVEN = 5  # pieces over the heights, besides those that kinks ask for
_STEPS = 3  # of a ladder of pieces from where contact begins
NODES = 16
"""Nodes on a piece."""


class Loaded(NamedTuple):
    """Means at a separation that was never undercut, for one asperity per area.

    Attributes
    ----------
    force
        Of the contacts [N].
    recoverable, dissipated
        Work of the contacts that comes back, and that is kept [J].
    gained
        As for :class:`~asperity.interface.residual_profile.Flattened`.
    """

    force: jax.Array
    recoverable: jax.Array
    dissipated: jax.Array
    gained: jax.Array


def first_loading(
    contact: PlasticContact,
    heights: Heights,
    sizes: tuple[float, ...],
    separation: jax.Array,
    integrated: int,
    nodes: int = NODES,
) -> Loaded:
    """Means at one separation [m]; see :func:`~asperity.interface.residual_profile.flatten`.

    By so many ``nodes`` (static) on each piece of the overlaps.
    """
    deepest, weight = points(_bounds(contact, heights, separation), nodes)
    share = weight * heights.tail(integrated, separation + deepest)
    sprung = deepest - contact.residual(deepest)
    flat = flatness(deepest, sprung)

    def mean(values: jax.Array) -> jax.Array:
        return jnp.vdot(values, share)

    none = jnp.zeros(HIGHEST + 1)
    gained = [
        jnp.stack([mean(flat**size * sprung**n - deepest**n) for n in range(HIGHEST + 1)])
        if size
        else none  # of what does not depend on the tips
        for size in sizes
    ]
    back = mean(contact.returned(deepest))
    return Loaded(
        mean(contact.loading_force(deepest)),
        back,
        mean(contact.loading_work(deepest)) - back,
        jnp.stack(gained),
    )


def _bounds(contact: PlasticContact, heights: Heights, separation: jax.Array) -> jax.Array:
    """Ends of pieces of the overlap between which everything is smooth."""
    last = heights.highest_beside(jnp.minimum(separation, heights.top))
    span = jnp.maximum(last - separation, 0.0)
    uneven = jnp.clip(heights.bottom - separation, 0.0, span)
    even = uneven + (span - uneven) * np.linspace(0.0, 1.0, _EVEN + 1)
    first = jnp.minimum(0.25 * heights.rms, contact.yield_overlap)
    steps = ladder(jnp.minimum(first, span), span, _STEPS)
    ends = [even, steps, jnp.stack([jnp.zeros(()), *contact.kinks])]
    return jnp.sort(jnp.clip(jnp.concatenate(ends), 0.0, span))
