"""Means over heights of laws without truncated powers, by quadrature over the gap."""

from __future__ import annotations

from functools import reduce
from typing import NamedTuple

import numpy as np

from .._jax import jax, jnp
from ..laws.law import Law, Real
from ..surfaces.heights.distribution import Heights

EVEN = 7
"""Even pieces over Gaussian heights, besides those that a law's kinks ask for; of 6.4 rms at most
where places within 27 rms of one another share them, which is good to 1e-9."""

_STEPS = 4  # of a ladder, in geometric progression from a quarter of the law's length
_NO_KINKS = np.zeros(0)
_OUTWARDS = 2.0 ** np.concatenate([np.arange(-2.0, 8.0), np.arange(9.0, 61.0, 2.0)])
"""Ends of pieces over a law's length: energies that fall with the gap alone add up to no limit, and
a body that bounces by metres is within them."""

_HALVES = 2  # pieces of the gaps between the edges of places near one another


class Near(NamedTuple):
    """Separations that are within a few rms of one another (all static).

    Attributes
    ----------
    level
        Whether bonds reach up to the same gap at all of them.
    pieces
        Even pieces that they share.
    """

    level: bool
    pieces: int = EVEN


def means(
    law: Law, heights: Heights, edge: jax.Array, separation: jax.Array, integrated: int
) -> dict[str, jax.Array]:
    """Means at separations [m] of any shape, named as in :meth:`Law.response`.

    Parameters
    ----------
    law, heights
        The law and the heights.
    edge
        Gap [m] below which asperities are bonded, of that shape.
    separation
        The separations.
    integrated
        0 for a plane, 1 for a rigid paraboloid (static).
    """

    def one(e: jax.Array, h: jax.Array) -> dict[str, jax.Array]:
        found = means_near(law, heights, e[None], h[None], integrated, Near(level=True))
        return {name: row[0] for name, row in found.items()}

    shape = jnp.shape(separation)
    found = jax.vmap(one)(jnp.ravel(jnp.broadcast_to(edge, shape)), jnp.ravel(separation))
    return {name: row.reshape(shape) for name, row in found.items()}


def means_near(
    law: Law,
    heights: Heights,
    edges: jax.Array,
    separations: jax.Array,
    integrated: int,
    near: Near,
) -> dict[str, jax.Array]:
    """Means at separations [m] near one another, which share their nodes.

    As :func:`means`, for vectors. The law is evaluated once, at all nodes: it is most of what
    there is to compile.
    """
    low, high, edge = jnp.min(separations), jnp.max(separations), jnp.min(edges)
    # Beyond the end of a law the share of its gaps falls steeply, from the last one on.
    within = low - edge if law.only_bonded else jnp.asarray(heights.bottom)
    lowest = low - heights.highest_beside(within)
    # Up to here places differ in how many asperities are higher; beyond, all of them are.
    uneven = high - heights.bottom
    kinks = _kinks(law)
    end = _end(law, uneven, edge, jnp.max(kinks), integrated)
    pieces = near.pieces * heights.cuts
    even = lowest + (jnp.minimum(uneven, end) - lowest) * np.linspace(0.0, 1.0, pieces + 1)
    bounds = _pieces((lowest, end), jnp.append(kinks, edge), even, _shortest(law, heights), law)
    gap, weight = points(bounds)
    more = _Between.of(edge, edges, _HALVES) if law.hysteretic and not near.level else None
    values, *beside = _responses(law, (gap, gap < edge), *(more.branches(law) if more else ()))
    shares = heights.tail(integrated, separations[:, None, None] - gap, law.radius_power)
    found = {name: jnp.einsum("ij,pij->p", weight * row, shares) for name, row in values.items()}
    if more:
        added = more.mean(beside, heights, separations, integrated, law)
        found = {name: row + added[name] for name, row in found.items()}
    if integrated == 0 or law.only_bonded:
        return found
    whole = heights.tail(1, jnp.asarray(heights.bottom), law.radius_power)
    return {
        name: row + whole * _beyond(law, end, _shortest(law, heights), name)
        for name, row in found.items()
    }


def _kinks(law: Law) -> jax.Array:
    return jnp.stack([jnp.asarray(gap, float) for gap in law.kinks])


def between(
    law: Law,
    heights: Heights,
    edge: jax.Array,
    edges: jax.Array,
    separations: jax.Array,
    integrated: int,
    pieces: int,
) -> dict[str, jax.Array]:
    """What bonds of gaps between ``edge`` and each place's own of ``edges`` add to its mean.

    ``edge`` is the least of them; ``edges`` and ``separations`` are vectors. 16 nodes on each of
    even ``pieces`` (static), which are cut at kinks of the law.
    """
    nodes = _Between.of(edge, edges, pieces, _kinks(law))
    found = _responses(law, *nodes.branches(law))
    return nodes.mean(found, heights, separations, integrated, law)


class _Between(NamedTuple):
    """Nodes in gaps [m] whose bonds differ from place to place: (places, pieces, nodes)."""

    gap: jax.Array
    weight: jax.Array

    @classmethod
    def of(
        cls, edge: jax.Array, edges: jax.Array, pieces: int, kinks: Real = _NO_KINKS
    ) -> _Between:
        steps = np.linspace(0.0, 1.0, pieces + 1)

        def bounds(last: jax.Array) -> jax.Array:
            even = edge + (last - edge) * steps
            return jnp.sort(jnp.concatenate([even, jnp.clip(kinks, edge, last)]))

        return cls(*jax.vmap(lambda last: points(bounds(last)))(edges))

    def branches(self, law: Law) -> list[tuple[jax.Array, jax.Array]]:
        """Gaps, and whether they are bonded: both branches, where there are two."""
        held = [(self.gap, jnp.ones(self.gap.shape, bool))]
        return held if law.only_bonded else [*held, (self.gap, jnp.zeros(self.gap.shape, bool))]

    def mean(
        self,
        found: list[dict[str, jax.Array]],
        heights: Heights,
        separations: jax.Array,
        integrated: int,
        law: Law,
    ) -> dict[str, jax.Array]:
        """What the bonds add, from the law on its branches."""
        shares = heights.tail(integrated, separations[:, None, None] - self.gap, law.radius_power)
        share = self.weight * shares
        change = {name: reduce(jnp.subtract, [row[name] for row in found]) for name in found[0]}
        return {name: jnp.sum(row * share, axis=(-2, -1)) for name, row in change.items()}


def _responses(law: Law, *sets: tuple[jax.Array, jax.Array]) -> list[dict[str, jax.Array]]:
    """A law at several sets of gaps [m], bonded or not, whose last axes are alike."""
    nodes = sets[0][0].shape[-1]
    gap, bonded = (
        jnp.concatenate([x.reshape(-1, nodes) for x in rows]) for rows in zip(*sets, strict=True)
    )
    found = law.response(gap, bonded)
    ends = np.cumsum([0, *(x.size // nodes for x, _ in sets)])
    return [
        {name: row[first:last].reshape(x.shape) for name, row in found.items()}
        for (x, _), first, last in zip(sets, ends[:-1], ends[1:], strict=True)
    ]


def _end(
    law: Law, uneven: jax.Array, edge: jax.Array, last_kink: jax.Array, integrated: int
) -> jax.Array:
    """Gap [m] up to which a law is integrated piece by piece.

    A paraboloid may be so deep that all asperities beside its apex are well within the law.
    """
    if law.only_bonded:
        return edge if integrated else jnp.minimum(uneven, edge)
    return jnp.maximum(uneven, last_kink) if integrated else uneven


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
    away = ladder(first, span, _STEPS)
    steps = [kink[0] - away] if law.only_bonded else [kink[0] - away, kink[-1] + away]
    return jnp.sort(jnp.clip(jnp.concatenate([even, kink, *steps]), lowest, highest))


def ladder(first: jax.Array, span: jax.Array, steps: int) -> jax.Array:
    """So many distances from ``first`` on, in geometric progression towards a ``span``."""
    ratio = jnp.where(first > 0.0, span / jnp.where(first > 0.0, first, 1.0), 1.0)
    return first * ratio ** (np.arange(steps) / steps)


def points(bounds: jax.Array, nodes: int = 16) -> tuple[jax.Array, jax.Array]:
    """Nodes and weights on all pieces, shape (pieces, nodes).

    Gathered at both ends of each, where there may be square roots. Kept apart by pieces: XLA
    makes vector code of what follows, which it does not of nodes in one row.
    """
    places, weights = gathered(nodes)
    width = jnp.diff(bounds)[:, None]
    return bounds[:-1, None] + width * places, width * weights


def gathered(nodes: int) -> tuple[np.ndarray, np.ndarray]:
    """Nodes and weights on [0, 1], gathered at both ends."""
    places, weights = np.polynomial.legendre.leggauss(nodes)
    t = 0.5 * (places + 1.0)
    return t * t * (3.0 - 2.0 * t), 3.0 * t * (1.0 - t) * weights


def _beyond(law: Law, start: jax.Array, shortest: jax.Array, name: str) -> jax.Array:
    """Integral of a free branch over all gaps beyond ``start``, where T_1 is 1."""
    if name != "energy":
        return law.energy(start) if name == law.mechanism else jnp.zeros(())
    known = law.energy_beyond(start)
    if known is not None:
        return known
    ends = jnp.append(_kinks(law), shortest * _OUTWARDS)
    gap, weight = points(jnp.sort(jnp.maximum(ends, start)))
    return jnp.sum(weight * law.energy(gap))
