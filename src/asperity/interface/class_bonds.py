"""Bonds of a class of tip radius that differ from its branch of approach."""

from __future__ import annotations

from typing import NamedTuple

from .._jax import jax, jnp
from ..laws.law import Law
from ..numerics.polynomials import chebyshev_sum, from_points, local, points_between
from ..surfaces.heights.distribution import Heights
from .height_quadrature import between


class ClassBonds(NamedTuple):
    """What the bonds of one law add to the branch of approach of their class of radius.

    Attributes
    ----------
    law, heights
        The law and the heights of the class.
    names, integrated
        Mechanisms or "energy", a row each, of planes (0) or of a rigid paraboloid (1) (static).
    pieces
        Even pieces of a quadrature over these bonds (static).
    """

    law: Law
    heights: Heights
    names: tuple[str, ...]
    integrated: int
    pieces: int

    def at(self, threshold: jax.Array, places: jax.Array) -> jax.Array:
        """At places [m] of any shape, with a threshold of the memory for each, or one for all."""
        edges = self._edge(jnp.broadcast_to(places - threshold, places.shape))
        return self._up_to(edges.ravel(), places.ravel()).reshape(-1, *places.shape)

    def along(self, threshold: jax.Array, places: jax.Array, nodes: int) -> jax.Array:
        """At places [m] of any shape on the way from one reversal, by polynomials of few nodes.

        One up to where these bonds reach the unloading branch, and one beyond, however many
        pieces other classes make of the way. Nothing is added below where they reach the branch
        of approach. The first is one of the root of the distance to the unloading branch: bonds
        let go at a fold.
        """
        low, high = jnp.min(places), jnp.max(places)
        forms, end = threshold + self.law.forming_gap, threshold + self.law.breaking_gap
        forming, breaking = (jnp.clip(place, low, high) for place in (forms, end))

        first, last = _root(end - forming), _root(end - breaking)
        root = last + (first - last) * points_between(nodes)
        here = jnp.where(jnp.isfinite(end), end, 0.0) - root**2
        x = local(last, first, _root(end - jnp.clip(places, forming, breaking)))
        on_way = _read(self._up_to(self._edge(here - threshold), here), x)

        beyond = breaking + (high - breaking) * points_between(nodes)
        x = local(breaking, high, jnp.clip(places, breaking, high))
        whole = jnp.asarray(self.law.breaking_gap, float)[None]
        parted = _read(self._up_to(whole, beyond), x)
        return jnp.where(places > forms, jnp.where(places <= end, on_way, parted), 0.0)

    def _edge(self, gap: jax.Array) -> jax.Array:
        return jnp.clip(gap, self.law.forming_gap, self.law.breaking_gap)

    def _up_to(self, edges: jax.Array, places: jax.Array) -> jax.Array:
        """By quadrature, for vectors; of ``edges`` there may be one for all."""
        start = jnp.asarray(self.law.forming_gap, float)
        found = between(self.law, self.heights, start, edges, places, self.integrated, self.pieces)
        return jnp.stack([found[name] for name in self.names])


def _root(x: jax.Array) -> jax.Array:
    """Square root of what is positive and finite, else 0; with derivatives."""
    fine = (x > 0.0) & (x < jnp.inf)
    return jnp.where(fine, jnp.sqrt(jnp.where(fine, x, 1.0)), 0.0)


def _read(values: jax.Array, x: jax.Array) -> jax.Array:
    """Polynomials through rows of values at Chebyshev points of [-1, 1], at x."""
    series = from_points(values.shape[1]) @ values.T
    return chebyshev_sum(series[(...,) + (None,) * x.ndim], x)
