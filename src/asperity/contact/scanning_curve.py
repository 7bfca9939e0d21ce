"""Places on the way from a reversal to a branch, and down to where a body cannot come."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from .._jax import jax, jnp
from ..laws.law import Law
from .contact import Potential

STEPS = 36
"""Panels on each side of a non-smooth point."""

_RATIO = 3.0  # of their lengths
_NARROWEST = 1e-10
"""Of the separation: the first point of a panel is 2e-13 beyond its end, a thousand roundings."""


def pieces_to(
    marks: jax.Array, start: jax.Array, unloading: jax.Array, within: tuple[Any, Any]
) -> tuple[jax.Array, jax.Array]:
    """Ends of the pieces from a reversal to the last of the ``marks``, ``within`` bounds [m]."""
    ahead = jnp.where(unloading, 1.0, -1.0)
    marks = jnp.clip(marks, *within)
    marks = start + ahead * jnp.sort(jnp.maximum(ahead * (marks - start), 0.0))
    return jnp.concatenate([start[None], marks])[:-1], marks


def by_mechanism(laws: Sequence[Law], lengths: Sequence[jax.Array]) -> list[jax.Array]:
    """One length [m] of each law, in an array for each mechanism: of one law, or of its classes."""
    names = [law.mechanism for law in laws]
    pairs = list(zip(names, lengths, strict=True))
    return [jnp.stack([x for n, x in pairs if n == name]) for name in dict.fromkeys(names)]


def pieces_for(lengths: jax.Array, pieces: int) -> int:
    """Even pieces of bonds of one mechanism, where one law has ``pieces``.

    Classes share twice as many, besides those between their ends: each changes elsewhere.
    """
    return 2 * pieces if lengths.size > 1 and pieces > 1 else pieces


def panels_around(
    kinks: jax.Array, low: jax.Array, high: jax.Array, count: int, ends: tuple[Any, ...] = ()
) -> jax.Array:
    """Ends of panels that narrow to each kink from both sides, between ``low`` and ``high`` [m].

    Parameters
    ----------
    kinks
        Separations [m] at which a curve is not smooth, shape (kinks,); each is an end.
    low, high
        Outermost ends [m].
    count
        Panels on each side of a kink: :data:`STEPS`, or a multiple.
    ends
        Further ends [m], kept as they are.

    Returns
    -------
    Ascending ends [m]. A panel is empty, or at least ``_NARROWEST`` of its separation wide. A kink
    is known to some tens of roundings; where a force jumps, all points of a panel must lie on the
    same side of it.
    """
    powers = np.arange(0.0, count) / (count // STEPS)
    ladder = jnp.maximum(high, -low) * _RATIO**-powers
    steps = jnp.concatenate([(kinks[:, None] + sign * ladder).ravel() for sign in (-1.0, 1.0)])
    outer = jnp.stack([low, high])
    inner = _apart(jnp.concatenate([kinks, *(end[None] for end in ends)]), outer)
    given = jnp.concatenate([inner, outer])
    return jnp.sort(jnp.concatenate([_apart(steps, given), given]))


def _apart(places: jax.Array, given: jax.Array) -> jax.Array:
    """Places within the given ones; the first of these stands for each that is too close."""
    places = jnp.clip(places, jnp.min(given), jnp.max(given))
    least = _NARROWEST * jnp.abs(places)
    near = jnp.min(jnp.abs(places[:, None] - given), axis=1) < least
    places = jnp.sort(jnp.where(near, given[0], places))
    close = jnp.diff(places, prepend=-jnp.inf) < _NARROWEST * jnp.abs(places)
    return jnp.where(close, given[0], places)


def lowest_place(
    work: Callable[[jax.Array], jax.Array],
    ladder: np.ndarray | jax.Array,
    release: jax.Array,
    kinetic: jax.Array,
    potential: Potential,
) -> jax.Array:
    """The first place of a ``ladder`` [m] that a body cannot reach.

    It leaves ``release`` [m] with ``kinetic`` [J], in a ``potential``; coming from there to places
    takes the ``work`` [J] on the contact, at least.
    """
    places = jnp.append(release, ladder)
    energy = work(places) + potential(places)
    level = energy[0] + kinetic
    return first_out_of_reach(energy[1:], level + 1e-9 * jnp.abs(level), places[1:], release)


def first_out_of_reach(
    values: jax.Array, level: jax.Array, places: jax.Array, release: jax.Array
) -> jax.Array:
    """The first of descending ``places`` below ``release`` where ``values`` exceed ``level``."""
    above = jnp.logical_and(jnp.logical_not(values <= level), places < release)
    index = jnp.where(jnp.any(above), jnp.argmax(above), places.shape[0] - 1)
    return jnp.asarray(places)[index]
