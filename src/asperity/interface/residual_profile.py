"""Asperities as a closest approach left them: their means as polynomials of one place.

Pressed once to a closest approach, an asperity has one effective height y for good. Then a mean
over all of them of a truncated power of the gap h - y depends on one number, the effective
height from which it counts; so do the mean force and energy of the contacts. They are tabulated
once, instead of being integrated at every separation and for every memory of bonds.
"""

from __future__ import annotations

from itertools import pairwise
from math import comb, factorial
from typing import NamedTuple

import numpy as np
from numpy.polynomial import chebyshev

from .._jax import jax, jnp
from ..laws.law import TruncatedPower
from ..laws.plastic import PlasticContact
from ..numerics.compilation import kept
from ..numerics.polynomials import clenshaw, from_points, local
from ..surfaces.heights.distribution import Heights
from .height_quadrature import gathered

HIGHEST = 2
"""Largest exponent of the truncated powers."""

_NODES = 14  # coefficients of the contacts' force on a panel
_ROW = _NODES + HIGHEST + 1  # and of what is integrated from them
_POINTS = 14  # of a quadrature over the part of a panel above a place, and over each one above
_STEPS = 5  # panels in geometric progression beyond the last kink of the contact
_EVEN = 7  # even panels over the heights
_BELOW = 6  # and over those below the closest approach that laws reach

_X = chebyshev.chebpts1(_NODES)
_TO_COEFFICIENTS = from_points(_NODES)
# From each place up to the end of the panel.
_INTEGRAL = np.pad(-chebyshev.chebint(np.eye(_ROW - 1), lbnd=1), ((0, 0), (0, 1)))
_SHARES, _WEIGHTS = gathered(_POINTS)  # there may be powers at both ends


def _between_nodes(x: np.ndarray) -> np.ndarray:
    """From values at the nodes of a panel to those at places ``x`` of it."""
    rows: np.ndarray = chebyshev.chebvander(x, _NODES - 1) @ _TO_COEFFICIENTS
    return rows


_ABOVE = 0.5 * (1.0 - _X)  # share of a panel above each node
_ON_PANEL = _between_nodes(2.0 * _SHARES - 1.0)
_ON_REST = _between_nodes(1.0 - 2.0 * _ABOVE[:, None] * (1.0 - _SHARES))


@kept
class Flattened(NamedTuple):
    """Means over asperities that were flattened, as functions of an effective height.

    Attributes
    ----------
    lowest
        Closest approach [m].
    ends
        Ends of the panels of effective heights above it [m], ascending; some lie below.
    contact
        Force and energy of the contacts at a separation, as Chebyshev coefficients on each
        panel, shape (2, panels, coefficients); constant below the closest approach.
    powers
        Likewise sums over the asperities above an effective height y0 of their flatness to
        the power of a size, times (y - y0)^n, shape (sizes, HIGHEST + 1, panels, coefficients).
    gained
        What these sums have gained at the closest approach, shape (sizes, HIGHEST + 1).
    dissipated
        What the contacts keep [J].
    """

    lowest: jax.Array
    ends: jax.Array
    contact: jax.Array
    powers: jax.Array
    gained: jax.Array
    dissipated: jax.Array

    @property
    def unloading_panels(self) -> jax.Array:
        """Separations above the closest approach [m] between which contacts spring back."""
        return self.ends[_BELOW + 2 :]


def flatness(deepest: jax.Array, sprung: jax.Array) -> jax.Array:
    """Factor by which a tip that was overlapped by ``deepest`` and springs back is flatter."""
    pressed = sprung > 0.0
    return jnp.where(pressed, deepest / jnp.where(pressed, sprung, 1.0), 1.0)


def flatten(
    contact: PlasticContact,
    heights: Heights,
    sizes: tuple[float, ...],
    within: tuple[jax.Array, jax.Array],
    integrated: int,
) -> Flattened:
    """Tabulate what a closest approach leaves, for one asperity per area.

    Parameters
    ----------
    contact, heights
        Contact of one asperity, and the heights before anything touched.
    sizes
        Powers of the flatness (static).
    within
        Closest approach, and largest gap that a law reaches over [m].
    integrated
        0 for a plane, 1 for a rigid paraboloid.
    """
    lowest, _interaction_range = within
    ends = _ends(contact, heights, lowest)
    low, width = ends[:-1, None], jnp.diff(ends)[:, None]
    sprung = low + 0.5 * width * (1.0 + _X)
    deepest = contact.deepest(sprung)
    _, left = jax.jvp(contact.residual, (deepest,), (jnp.ones_like(deepest),))
    count = heights.tail(integrated, lowest + deepest) / (1.0 - left)
    flat = flatness(deepest, sprung)
    each = []
    for size in sizes:
        row = _fitted(flat**size * count)
        rows = []
        for n in range(HIGHEST + 1):
            row = max(n, 1) * _from_above(row, width)
            rows.append(row)
        each.append(jnp.stack(rows))
    powers = jnp.stack(each)
    force = _fitted(_contact_force(contact, ends, deepest, count))
    both = jnp.stack([force, _from_above(force, width)])
    lost = _from_above(_fitted(contact.dissipated(deepest) * count), width)
    signs = (-1.0) ** np.arange(_ROW)
    whole = [factorial(n) * heights.tail(integrated + 1 + n, lowest) for n in range(HIGHEST + 1)]
    gained = powers[:, :, 0] @ signs - jnp.stack(whole)
    further, below = _below(heights, gained, within, integrated)
    # Nothing is below, but for rounding.
    deeper = (
        jnp.zeros((2, further.shape[0] - 1, _ROW)).at[..., 0].set((both[:, 0] @ signs)[:, None])
    )
    return Flattened(
        lowest,
        jnp.concatenate([further[:-1], ends]),
        jnp.concatenate([deeper, both], axis=1),
        jnp.concatenate([below, powers], axis=2),
        gained,
        jnp.asarray(signs) @ lost[0],
    )


def _below(
    heights: Heights, gained: jax.Array, within: tuple[jax.Array, jax.Array], integrated: int
) -> tuple[jax.Array, jax.Array]:
    """Panels below the closest approach, and the sums on them.

    What is above the closest approach counts whole there, and what is below was never pressed.
    """
    lowest, interaction_range = within
    uneven = jnp.clip(
        heights.bottom - lowest, -interaction_range, 0.0
    )  # lower down they are polynomials
    ends = jnp.append(-interaction_range, uneven * np.linspace(1.0, 0.0, _BELOW + 1))
    edge = -(ends[:-1, None] + 0.5 * jnp.diff(ends)[:, None] * (1.0 + _X))
    terms = tuple(TruncatedPower(1.0, float(n), edge) for n in range(HIGHEST + 1))
    closed = heights.mean_powers(terms, integrated, jnp.broadcast_to(lowest, edge.shape))
    rows = [
        [
            _fitted(whole + in_reach(term, of_size))
            for term, whole in zip(terms, closed, strict=True)
        ]
        for of_size in gained
    ]
    return ends, jnp.stack([jnp.stack(row) for row in rows])


def _ends(contact: PlasticContact, heights: Heights, lowest: jax.Array) -> jax.Array:
    """Ends of the panels above, as effective heights above the closest approach [m]."""
    last = jnp.maximum(heights.highest_beside(jnp.minimum(lowest, heights.top)), lowest)
    uneven = jnp.clip(heights.bottom, lowest, last)
    even = uneven + (last - uneven) * np.linspace(0.0, 1.0, _EVEN + 1) - lowest
    *_, last_kink = kinks = contact.kinks
    wide = jnp.maximum(2.0 * heights.rms, uneven - lowest)
    ladder = last_kink * jnp.maximum(wide / last_kink, 1.0) ** (np.arange(_STEPS + 1) / _STEPS)
    between = [jnp.sqrt(low * high) for low, high in pairwise(kinks)][1:]
    marks = jnp.stack([jnp.zeros(()), *kinks, *between])
    deepest = jnp.sort(jnp.clip(jnp.concatenate([even, ladder[1:], marks]), 0.0, last - lowest))
    return deepest - contact.residual(deepest)


def _contact_force(
    contact: PlasticContact, ends: jax.Array, deepest: jax.Array, count: jax.Array
) -> jax.Array:
    """Mean force of the contacts at the nodes of all panels."""
    logarithm, exponent = contact.unloading(deepest)
    low, width = ends[:-1], jnp.diff(ends)
    unit = contact.yield_overlap
    some = width > 0.0
    log_width = jnp.log(jnp.where(some, width, unit) / unit)
    weighted = count * width[:, None]
    # The rest of the panel of each place.
    own = jnp.einsum("ikn,pn->pik", _ON_REST, exponent)
    start = jnp.einsum("ikn,pn->pik", _ON_REST, logarithm)
    share = jnp.einsum("ikn,pn->pik", _ON_REST, weighted)
    distance = np.log(_ABOVE[:, None] * _SHARES)
    powers = jnp.exp(start + own * (distance + log_width[:, None, None]))
    near = jnp.sum(_ABOVE[:, None] * _WEIGHTS * share * powers, axis=-1)
    # All panels above.
    own, start, share = (
        jnp.einsum("kn,pn->pk", _ON_PANEL, rows).ravel() for rows in (exponent, logarithm, weighted)
    )
    share = share * jnp.tile(_WEIGHTS, width.shape[0])
    there = (low[:, None] + width[:, None] * _SHARES).ravel()
    here = (low[:, None] + width[:, None] * 0.5 * (1.0 + _X)).ravel()
    panel = np.arange(width.shape[0])
    above = np.repeat(np.repeat(panel, _POINTS)[None] > panel[:, None], _NODES, axis=0)
    apart = jnp.where(above, there - here[:, None], unit)
    further = jnp.logical_and(above, apart > 0.0)
    powers = jnp.exp(start + own * jnp.log(jnp.where(further, apart, unit) / unit))
    far = jnp.sum(jnp.where(further, powers, 0.0) * share, axis=-1)
    return near + far.reshape(near.shape)


def _fitted(values: jax.Array) -> jax.Array:
    """Chebyshev coefficients of rows of values, with room for those of integrals."""
    rows = jnp.einsum("cn,pn->pc", _TO_COEFFICIENTS, values)
    return jnp.pad(rows, ((0, 0), (0, _ROW - _NODES)))


def _from_above(rows: jax.Array, width: jax.Array) -> jax.Array:
    """Integral of polynomials on panels from each place up to the last end."""
    own = 0.5 * width * jnp.einsum("ck,pk->pc", _INTEGRAL, rows)
    whole = own @ (-1.0) ** np.arange(_ROW)
    above = jnp.cumsum(whole[::-1])[::-1] - whole
    return own.at[:, 0].add(above)


def contact_means(flat: Flattened, separation: jax.Array) -> jax.Array:
    """Force and energy of the contacts at separations [m] not below the closest approach."""
    place = jnp.broadcast_to(separation - flat.lowest, (2, *separation.shape))
    return _read(flat, flat.contact, place)


def power_means(
    flat: Flattened, asked: list[tuple[TruncatedPower, int]], separation: jax.Array
) -> jax.Array:
    """Means of truncated powers times the flatness to the power of a size.

    Parameters
    ----------
    flat
        What was flattened.
    asked
        Terms, of whole exponents up to HIGHEST, each with the index of its size.
    separation
        Separations [m] not below the closest approach, any shape.
    """
    # Laws ask for the same mean several times: each is read once.
    keys = [(size, int(term.exponent), _same(term.edge)) for term, size in asked]
    each = {key: term.edge for key, (term, _) in zip(keys, asked, strict=True)}
    edge = jnp.stack([jnp.broadcast_to(edge, jnp.shape(separation)) for edge in each.values()])
    rows = jnp.stack([flat.powers[size, n] for size, n, _ in each])
    found = _read(flat, rows, separation - edge - flat.lowest)
    which = [list(each).index(key) for key in keys]
    return jnp.stack(
        [term.coefficient * found[k] for (term, _), k in zip(asked, which, strict=True)]
    )


def _same(edge: jax.Array | float) -> float | int:
    """What tells edges apart without values."""
    return edge if isinstance(edge, float) else id(edge)


def in_reach(term: TruncatedPower, gained: jax.Array) -> jax.Array:
    """What a truncated power gains that reaches all asperities that were pressed.

    Parameters
    ----------
    term
        The power; its edge counts from the closest approach [m].
    gained
        The sums of :class:`Flattened` for its size, (..., HIGHEST + 1).
    """
    n = int(term.exponent)
    edge = jnp.asarray(term.edge)
    parts = [comb(n, k) * edge ** (n - k) * gained[..., k] for k in range(n + 1)]
    return term.coefficient * jnp.sum(jnp.stack(parts), axis=0)


def _read(flat: Flattened, rows: jax.Array, place: jax.Array) -> jax.Array:
    """Values of rows of polynomials, each at its own effective heights above the lowest [m]."""
    panel = jnp.sum(place[..., None] >= flat.ends[1:-1], axis=-1)
    low, high = flat.ends[panel], flat.ends[panel + 1]
    first = np.arange(rows.shape[0]).reshape(-1, *(1,) * (place.ndim - 1))
    x = local(low, high, jnp.clip(place, low, high))
    here = rows.at[first, panel].get(mode="promise_in_bounds")
    found = clenshaw(jnp.moveaxis(here, -1, 0), x)
    return jnp.where(place < flat.ends[-1], found, 0.0)
