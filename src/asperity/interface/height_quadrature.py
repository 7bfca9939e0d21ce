"""Means over heights of laws without truncated powers, by quadrature over the gap."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from .._jax import jax, jnp
from ..laws.law import Law
from ..surfaces.heights.distribution import Heights

EVEN = 7
"""Even pieces over Gaussian heights, besides those that a law's kinks ask for; of 6.4 rms at most
where places within 27 rms of one another share them, which is good to 1e-9."""

_STEPS = 4  # of a ladder, in geometric progression from a quarter of the law's length
_HALVES = 2  # pieces of the gaps between the edges of places near one another


class Near(NamedTuple):
    """Separations that are within a few rms of one another (all static).

    Attributes
    ----------
    level
        Whether bonds reach up to the same gap at all of them.
    pieces
        Even pieces that they share.
    nodes
        Places on the way from a reversal to the branch of one law that tell all of it.
    """

    level: bool
    pieces: int = EVEN
    nodes: int = 16


class Asked(NamedTuple):
    """What is asked of a law (all static).

    Attributes
    ----------
    names
        "energy", "force", or mechanisms of its force.
    integrated
        0 for a plane, 1 for a rigid paraboloid.
    """

    names: tuple[str, ...]
    integrated: int


def means(
    law: Law, heights: Heights, edge: jax.Array, separation: jax.Array, asked: Asked
) -> jax.Array:
    """Means at separations [m] of any shape, one row a name.

    Parameters
    ----------
    law, heights
        The law and the heights.
    edge
        Gap [m] below which asperities are bonded, of that shape.
    separation
        The separations.
    asked
        What of.
    """

    def one(e: jax.Array, h: jax.Array) -> jax.Array:
        return means_near(law, heights, e[None], h[None], asked, Near(level=True))[:, 0]

    shape = jnp.shape(separation)
    flat = jax.vmap(one, out_axes=1)
    found: jax.Array = flat(jnp.ravel(jnp.broadcast_to(edge, shape)), jnp.ravel(separation))
    return found.reshape(-1, *shape)


def means_near(
    law: Law,
    heights: Heights,
    edges: jax.Array,
    separations: jax.Array,
    asked: Asked,
    near: Near,
) -> jax.Array:
    """Means at separations [m] near one another, which share their nodes.

    As :func:`means`, for vectors.
    """
    low, high, edge = jnp.min(separations), jnp.max(separations), jnp.min(edges)
    # Beyond the end of a law the share of its gaps falls steeply, from the last one on.
    within = low - edge if law.only_bonded else jnp.asarray(heights.bottom)
    lowest = low - heights.highest_beside(within)
    # Up to here places differ in how many asperities are higher; beyond, all of them are.
    uneven = high - heights.bottom
    end = _end(law, uneven, edge, asked.integrated)
    pieces = near.pieces * heights.cuts
    even = lowest + (jnp.minimum(uneven, end) - lowest) * np.linspace(0.0, 1.0, pieces + 1)
    kinks = jnp.append(_kinks(law), edge)
    bounds = _pieces((lowest, end), kinks, even, _shortest(law, heights), law)
    gap, weight = points(bounds)
    values = weight * _values(law, gap, gap < edge, asked.names)
    shares = heights.tail(asked.integrated, separations[:, None, None] - gap, law.radius_power)
    found = jnp.stack([jnp.einsum("ij,pij->p", row, shares) for row in values])
    if law.hysteretic and not near.level:
        found = found + between(law, heights, edge, edges, separations, asked)
    if asked.integrated == 0 or law.only_bonded:
        return found
    whole = heights.tail(1, jnp.asarray(heights.bottom), law.radius_power)
    beyond = [_beyond(law, end, _shortest(law, heights), name) for name in asked.names]
    return found + whole * jnp.stack(beyond)[:, None]


def _end(law: Law, uneven: jax.Array, edge: jax.Array, integrated: int) -> jax.Array:
    """Gap [m] up to which a law is integrated piece by piece.

    A paraboloid may be so deep that all asperities beside its apex are well within the law.
    """
    if law.only_bonded:
        return edge if integrated else jnp.minimum(uneven, edge)
    return jnp.maximum(uneven, jnp.max(_kinks(law))) if integrated else uneven


def _kinks(law: Law) -> jax.Array:
    return jnp.stack([jnp.asarray(gap, float) for gap in law.kinks])


def between(
    law: Law,
    heights: Heights,
    edge: jax.Array,
    edges: jax.Array,
    separations: jax.Array,
    asked: Asked,
    pieces: int = _HALVES,
) -> jax.Array:
    """What bonds of gaps between ``edge`` and each place's own of ``edges`` add to its mean.

    ``edge`` is the least of them; ``edges`` and ``separations`` are vectors. 16 nodes on each of
    even ``pieces`` (static).
    """
    steps = np.linspace(0.0, 1.0, pieces + 1)
    gap, weight = jax.vmap(points)(edge + (edges - edge)[:, None] * steps)
    bonded = _values(law, gap, jnp.ones(gap.shape, bool), asked.names)
    free = _values(law, gap, jnp.zeros(gap.shape, bool), asked.names)
    shares = heights.tail(asked.integrated, separations[:, None, None] - gap, law.radius_power)
    return jnp.sum((bonded - free) * weight * shares, axis=(-2, -1))


def _values(law: Law, gap: jax.Array, bonded: jax.Array, names: tuple[str, ...]) -> jax.Array:
    """Force, parts of it or energy on the branch that holds, one row a name."""
    parts = law.components(gap, bonded) if set(names) - {"energy", "force"} else {}
    rows = []
    for name in names:
        if name not in ("energy", "force"):
            rows.append(parts[name])
            continue
        free, held = (
            (law.energy, law.bonded_energy) if name == "energy" else (law.force, law.bonded_force)
        )
        rows.append(jnp.where(bonded, held(gap), free(gap)) if law.hysteretic else free(gap))
    return jnp.stack(rows)


def _shortest(law: Law, heights: Heights) -> jax.Array:
    """Length [m] on which the mean changes, at least."""
    return jnp.minimum(law.length, heights.rms)


def _pieces(
    between: tuple[jax.Array, jax.Array],
    kinks: jax.Array,
    even: jax.Array,
    shortest: jax.Array,
    law: Law,
) -> jax.Array:
    """Sorted ends of the pieces: kinks, even ones, and ladders from the kinks to both ends.

    Where the law ends with its bonds, nothing lies above the highest kink.
    """
    lowest, highest = between
    kink = jnp.sort(jnp.clip(kinks, lowest, highest))
    span = highest - lowest
    first = jnp.minimum(0.25 * shortest, span)
    ratio = jnp.where(first > 0.0, span / jnp.where(first > 0.0, first, 1.0), 1.0)
    ladder = first * ratio ** (np.arange(_STEPS) / _STEPS)
    steps = [kink[0] - ladder] if law.only_bonded else [kink[0] - ladder, kink[-1] + ladder]
    return jnp.sort(jnp.clip(jnp.concatenate([even, kink, *steps]), lowest, highest))


def points(bounds: jax.Array, nodes: int = 16) -> tuple[jax.Array, jax.Array]:
    """Nodes and weights on all pieces, shape (pieces, nodes).

    Gathered at both ends of each, where there may be square roots. Kept apart by pieces: XLA
    makes vector code of what follows, which it does not of nodes in one row.
    """
    places, weights = np.polynomial.legendre.leggauss(nodes)
    t = 0.5 * (places + 1.0)
    inner = t * t * (3.0 - 2.0 * t)
    slope = 6.0 * t * (1.0 - t) * 0.5 * weights
    width = jnp.diff(bounds)[:, None]
    return bounds[:-1, None] + width * inner, width * slope


def _beyond(law: Law, start: jax.Array, shortest: jax.Array, name: str) -> jax.Array:
    """Integral of a free branch over all gaps beyond ``start``, where T_1 is 1."""
    if name != "energy":
        whole = law.energy(start)
        return jnp.where(name == "force" or name == law.mechanism, whole, 0.0)
    known = law.energy_beyond(start)
    if known is not None:
        return known
    ladder = shortest * 2.0 ** np.arange(-2.0, 34.0)
    gap, weight = points(jnp.sort(jnp.maximum(jnp.append(_kinks(law), ladder), start)))
    return jnp.sum(weight * law.energy(gap))
