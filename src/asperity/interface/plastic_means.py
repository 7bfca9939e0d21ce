"""Asperities that yield: their means at one separation, integrated over the heights.

For any closest approach, any bonds and any laws beside contact. What a motion asks for is
tabulated instead (:mod:`~asperity.interface.residual_profile`,
:mod:`~asperity.interface.virgin_loading`).
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from .._jax import jax, jnp
from ..laws.law import Law, terms
from ..laws.plastic import PlasticContact
from ..surfaces.heights.distribution import Heights
from .height_quadrature import ladder, points
from .residual_profile import flatness

_EVEN = 5  # pieces over the heights, besides those that kinks ask for
_STEPS = 3  # of a ladder of pieces from where contact begins
_NODES = 12


class Asperities(NamedTuple):
    """One asperity per area: its contact, the laws beside it, and the heights."""

    contact: PlasticContact
    law: Law
    heights: Heights


def means_at(
    asperities: Asperities,
    separation: jax.Array,
    closest: jax.Array,
    edges: list[jax.Array],
    integrated: int,
) -> dict[str, jax.Array]:
    """Means at one separation [m]: forces by mechanism, energy, what is kept, bonds, contacts.

    Parameters
    ----------
    asperities
        What there is.
    separation, closest
        Separation, and the closest approach before [m].
    edges
        Gap [m] below which asperities are bonded, for each law.
    integrated
        0 for a plane, 1 for a rigid paraboloid.
    """
    contact, law, heights = asperities
    low = jnp.minimum(closest, separation)
    begin = _height(contact, separation, low)
    bounds = _bounds(asperities, (separation, low, begin), edges, integrated)
    height, weight = points(bounds, _NODES)
    share = weight * heights.tail(integrated, height)
    deepest = jnp.maximum(height - low, 0.0)
    overlap = jnp.maximum(height - separation, 0.0)
    gap = separation - height + contact.residual(deepest)
    flatter = flatness(deepest, deepest - contact.residual(deepest))
    # While it goes deeper than ever, a tip pulls as if it were whole.
    pulling = jnp.where(separation <= closest, 1.0, flatter)
    sums = {
        "elastic": jnp.sum(share * contact.force(overlap, deepest)),
        "energy": jnp.sum(share * contact.recoverable(overlap, deepest)),
        "kept": _kept(asperities, low, integrated),
        "contacting": heights.tail(integrated + 1, begin),
    }
    for k, (one, edge) in enumerate(zip(terms(law), edges, strict=True)):
        held, size = gap < edge, one.radius_power
        for name, part in one.response(gap, held).items():
            by = flatter if name == "energy" else pulling
            sums[name] = sums.get(name, 0.0) + jnp.sum(share * by**size * part)
        if one.hysteretic:
            sums[f"bonds {k}"] = jnp.sum(share * jnp.where(held, flatter**size, 0.0))
    return sums


def _kept(asperities: Asperities, low: jax.Array, integrated: int) -> jax.Array:
    """Energy that contact down to a separation keeps.

    And what conservative laws beside it gain by flatter tips, which goes the same way.
    """
    contact, law, heights = asperities
    last = jnp.maximum(heights.highest_beside(jnp.minimum(low, heights.top)), low)
    first = low if integrated else jnp.clip(low, heights.bottom, last)
    uneven = jnp.clip(first, heights.bottom, last)
    even = uneven + (last - uneven) * np.linspace(0.0, 1.0, _EVEN + 1)
    kinks = jnp.stack([first, *(low + kink for kink in contact.kinks)])
    bounds = jnp.sort(jnp.clip(jnp.concatenate([even, kinks]), first, last))
    height, weight = points(bounds, _NODES)
    share = weight * heights.tail(integrated, height)
    deepest = jnp.maximum(height - low, 0.0)
    kept = jnp.sum(share * contact.dissipated(deepest))
    flatter = flatness(deepest, deepest - contact.residual(deepest))
    for one in terms(law):
        if not one.hysteretic:
            gain = flatter**one.radius_power - 1.0
            kept = kept - jnp.sum(share * gain) * one.energy(jnp.zeros(()))
    return kept


def _height(contact: PlasticContact, effective: jax.Array, low: jax.Array) -> jax.Array:
    """Height [m] of the asperities that have come to an ``effective`` height."""
    recovered = jnp.maximum(effective - low, 0.0)
    return jnp.minimum(effective, low) + contact.deepest(recovered)


def _bounds(
    asperities: Asperities,
    places: tuple[jax.Array, jax.Array, jax.Array],
    edges: list[jax.Array],
    integrated: int,
) -> jax.Array:
    """Ends of pieces of the heights between which everything is smooth.

    ``places`` are the separation, the closest approach and the height from which asperities touch.
    """
    contact, law, heights = asperities
    separation, low, begin = places
    laws = terms(law)
    pairs = zip(laws, edges, strict=True)
    gaps = [jnp.asarray(k, float) for one in laws for k in one.kinks if not _at_touch(k)]
    gaps += [jnp.maximum(edge, 0.0) for one, edge in pairs if one.hysteretic]
    marks = [_height(contact, separation - gap, low) for gap in gaps]
    first = jnp.min(jnp.stack([begin, *marks]))
    if integrated == 0:
        first = jnp.maximum(first, heights.bottom)
    highest = heights.highest_beside(jnp.minimum(begin, heights.top))
    last = jnp.maximum(highest, first)
    uneven = jnp.maximum(first, heights.bottom)
    even = uneven + (last - uneven) * np.linspace(0.0, 1.0, _EVEN + 1)
    span = last - begin
    narrowest = jnp.minimum(0.25 * heights.rms, jnp.maximum(begin - low, contact.yield_overlap))
    narrowest = jnp.clip(narrowest, 0.0, jnp.maximum(span, 0.0))
    kinks = low + jnp.stack(contact.kinks)
    ends = [even, begin + ladder(narrowest, span, _STEPS), kinks, jnp.stack([begin, first, *marks])]
    return jnp.sort(jnp.clip(jnp.concatenate(ends), first, last))


def _at_touch(kink: jax.Array | float) -> bool:
    """Whether a kink lies where bodies touch, by what is known without values."""
    return isinstance(kink, float) and kink == 0.0
