"""Equilibria of a paraboloid and a plane under the Lennard-Jones pressure, at any gap.

In the reduced units of their path (:mod:`.lennard_jones_path`).
"""

from __future__ import annotations

from itertools import pairwise
from typing import NamedTuple

import numpy as np

from .._jax import jax, jnp
from .lennard_jones_path import (
    ENERGY,
    FORCE,
    GAP,
    MEASURES,
    PRESSED,
    Equilibria,
    largest_gap,
    path_at,
)

_SAMPLES = 10  # on a panel, between which folds are sought and equilibria are bracketed
_STEPS = 7  # of Newton's method within a bracket
_BEYOND = 1e-9  # of a measure: a step that leaves its bracket by less does so by rounding
_STEEPEST = 3.0  # times the mean: a cubic with steeper ends may not be monotone
_BISECTIONS = 34  # for a fold
_ROUNDING = 4e-15  # of a gap
_FLAT = 1e-7  # slope of the gap with the measure that counts as none, over 1 + |gap|


class Folds(NamedTuple):
    """Where the path folds: from which equilibria a body jumps, in and out.

    Attributes
    ----------
    first, last
        Measure at the first fold, where the outer branch ends, and at the last.
    inwards, outwards
        Rows there.
    some
        Whether there are any; else both are one equilibrium.
    """

    first: jax.Array
    last: jax.Array
    inwards: jax.Array
    outwards: jax.Array
    some: jax.Array

    def on_branches(self, dimensions: int) -> tuple[jax.Array, jax.Array]:
        """Measure and gap at the folds that end the outer and the inner branch, (2, 1, ...)."""
        shape = (2,) + (1,) * (dimensions - 1)
        measures = jnp.stack([self.first, self.last]).reshape(shape)
        gaps = jnp.stack([self.inwards[GAP], self.outwards[GAP]]).reshape(shape)
        return measures, gaps


_BETWEEN = np.unique(
    np.concatenate([np.linspace(*ends, _SAMPLES + 1) for ends in pairwise(MEASURES)])
)
"""Measures between which folds are sought and equilibria are bracketed."""


@jax.jit
def _folds_of(path: Equilibria) -> Folds:
    """The first and the last fold; where there is none, the flattest place stands for both."""
    places, count = jnp.asarray(_BETWEEN), len(_BETWEEN)
    gaps, slopes = path.gap(places)
    slope = slopes / (1.0 + jnp.abs(gaps))
    back = slope > _FLAT  # the gap grows again
    some = jnp.any(back)
    start, end = jnp.argmax(back), count - 1 - jnp.argmax(back[::-1])
    # The gap stops falling at the first, and falls again from the last.
    low = jnp.stack([places[jnp.maximum(start - 1, 0)], places[end]])
    high = jnp.stack([places[start], places[jnp.minimum(end + 1, count - 1)]])
    falls_before = jnp.asarray([True, False])

    def closer(_: int, ends: tuple[jax.Array, jax.Array]) -> tuple[jax.Array, jax.Array]:
        middle = 0.5 * (ends[0] + ends[1])
        before = (path.gap(middle)[1] < 0.0) == falls_before
        return jnp.where(before, middle, ends[0]), jnp.where(before, ends[1], middle)

    low, high = jax.lax.fori_loop(0, _BISECTIONS, closer, (low, high))
    at = jnp.where(some, 0.5 * (low + high), places[jnp.argmax(slope)])
    at = jax.lax.stop_gradient(at)
    rows, _ = path.read(at)
    return Folds(at[0], at[1], rows[:, 0], rows[:, 1], some)


class _Brackets(NamedTuple):
    """Where equilibria lie on both branches, outer and inner, each array of shape (2, ...)."""

    start: jax.Array
    end: jax.Array
    guess: jax.Array


def _brackets_of(gap: jax.Array, path: Equilibria, folds: Folds) -> _Brackets:
    """Those of equilibria at gaps within the outer and the inner branch."""
    places = jnp.asarray(_BETWEEN)
    gaps, slopes = path.gap(places)
    # Along a branch the gap falls; what is not of it counts as too large a measure, or too small.
    outer = jnp.where(places < folds.first, -gaps, jnp.inf)
    inner = jnp.where(places > folds.last, -gaps, -jnp.inf)
    index = jnp.stack([jnp.searchsorted(outer, -gap[0]), jnp.searchsorted(inner, -gap[1])])
    fold, there = folds.on_branches(gap.ndim)
    low = jnp.stack([places[0], folds.last]).reshape(fold.shape)
    high = jnp.stack([folds.first, places[-1]]).reshape(fold.shape)

    def end_at(number: jax.Array) -> tuple[jax.Array, jax.Array, jax.Array]:
        within = jnp.clip(places[number], low, high)
        own = within == places[number]
        return within, jnp.where(own, gaps[number], there), jnp.where(own, slopes[number], 0.0)

    start, before, falls_first = end_at(jnp.maximum(index - 1, 0))
    end, after, falls_last = end_at(jnp.minimum(index, len(_BETWEEN) - 1))
    whole = before - after
    share = jnp.clip((before - gap) / jnp.where(whole > 0.0, whole, 1.0), 0.0, 1.0)
    # Next to a fold the gap changes with the square of the measure, else nearly as a cubic of it.
    mean = whole / jnp.where(end > start, start - end, -1.0)
    first, last = (
        jnp.clip(mean / jnp.where(slope < 0.0, slope, -1.0), 0.0, _STEEPEST)
        for slope in (falls_first, falls_last)
    )
    curved = share * (1.0 - share) * ((1.0 - share) * (first - 1.0) + share * (1.0 - last))
    at_first, at_last = folds.some & (start == fold), folds.some & (end == fold)
    cubic = jnp.where(at_last, 1.0 - jnp.sqrt(1.0 - share), share + curved)
    guess = start + (end - start) * jnp.where(at_first, jnp.sqrt(share), cubic)
    return _Brackets(start, end, guess)


@jax.jit
def _measures_at(gap: jax.Array, path: Equilibria, folds: Folds) -> jax.Array:
    """The measures of equilibria at gaps within the outer and the inner branch, shape (2, ...)."""
    start, end, guess = _brackets_of(gap, path, folds)
    gap_at = path.gap_within(0.5 * (start + end))

    def closer(
        _: int, now: tuple[jax.Array, jax.Array, jax.Array]
    ) -> tuple[jax.Array, jax.Array, jax.Array]:
        place, start, end = now
        value, slope = gap_at(place)
        over = value - gap
        start, end = jnp.where(over > 0.0, place, start), jnp.where(over > 0.0, end, place)
        falls = slope < 0.0
        newton = place - over / jnp.where(falls, slope, 1.0)
        # It may leave the bracket by the rounding of a root at its end.
        within = jnp.clip(newton, start, end)
        sound = falls & (jnp.abs(newton - within) <= _BEYOND * (1.0 + jnp.abs(within)))
        return jnp.where(sound, within, 0.5 * (start + end)), start, end

    found = jax.lax.fori_loop(0, _STEPS, closer, (guess, start, end))[0]
    # At a fold rounding of the gap alone would move the measure by its square root.
    fold, there = folds.on_branches(gap.ndim)
    return jnp.where(jnp.abs(gap - there) <= _ROUNDING * jnp.abs(gap), fold, found)


@jax.jit
def solved(log_tabor: jax.Array) -> tuple[Equilibria, Folds]:
    """All equilibria at one Tabor number, and where their path folds."""
    path = path_at(log_tabor)
    return path, _folds_of(path)


def energy_beyond(gap: jax.Array, path: Equilibria, folds: Folds) -> jax.Array:
    """Integral of the energy over gaps from some of the outer branch to the largest."""
    here = jnp.stack([gap, jnp.full_like(gap, largest_gap())])
    places = jax.lax.stop_gradient(_measures_at(jnp.stack([here, here]), path, folds)[0])
    there, slopes = path.gap(places)
    regular = slopes < -1e-9
    along = places + jnp.where(regular, (here - there) / jnp.where(regular, slopes, 1.0), 0.0)
    until_gap, until_largest = path.energy_over_gaps(along)
    return until_gap - until_largest


@jax.custom_jvp
@jax.jit
def equilibria(
    gap: jax.Array, path: Equilibria, folds: Folds
) -> tuple[jax.Array, jax.Array, jax.Array]:
    """Force, its part where surfaces press, and energy, at gaps on both branches, (2, ...)."""
    values, _ = path.read(_measures_at(gap, path, folds))
    return values[FORCE], values[PRESSED], values[ENERGY]


@equilibria.defjvp
@jax.jit
def _equilibria_jvp(primals, tangents):  # type: ignore[no-untyped-def]
    (gap, path, folds), (by_gap, by_path, _) = primals, tangents
    measure = _measures_at(gap, path, folds)
    values, slopes = path.read(measure)
    changes, _ = by_path.read(measure)
    regular = slopes[GAP] < -1e-9
    moved = by_gap - changes[GAP]
    along = jnp.where(regular, moved / jnp.where(regular, slopes[GAP], 1.0), 0.0)
    force, pressed = (slopes[k] * along + changes[k] for k in (FORCE, PRESSED))
    # The energy is stationary in the shapes of both bodies: its slope with the gap is the force.
    energy = changes[ENERGY] - values[FORCE] * moved
    return (values[FORCE], values[PRESSED], values[ENERGY]), (force, pressed, energy)
