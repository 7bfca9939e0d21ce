"""Equilibria of a paraboloid and a plane under the Lennard-Jones pressure, read from a table.

In reduced units: gaps in spacings, forces in w R, energies in w R eps, with w the work of adhesion,
R the radius and eps the spacing. ``tools/lennard_jones.py`` solves them and makes the table.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from functools import cache
from itertools import pairwise
from pathlib import Path
from typing import NamedTuple

import numpy as np

from .._jax import jax, jnp
from ..numerics.polynomials import chebyshev_sum, local

TABLE = Path(__file__).with_name("lennard_jones.npy")
"""Chebyshev coefficients of all equilibria, from ``tools/lennard_jones.py``.

Their axes: panel of ln mu, its degree, panel of the measure, its degree, and the row: gap, force,
force where the pressure presses, energy.
"""

NODES = 10
"""Coefficients along a panel of the measure."""

DEGREES = 8
"""Coefficients along a panel of ln mu."""

TABOR_NUMBERS = np.array([0.01, 0.03, 0.1, 0.3, 0.7, 1.0, 1.4, 2.0, 3.0, 5.0])
"""Tabor numbers at which the panels of the table end."""

MEASURES = np.concatenate(
    [
        np.linspace(-22.0, -2.0, 9)[:-1],
        np.linspace(-2.0, 0.0, 5)[:-1],
        np.linspace(0.0, 2.5, 21)[:-1],
        np.linspace(2.5, 4.0, 7)[:-1],
        np.linspace(4.0, 12.2, 13),
    ]
)
"""Where the panels end along a path. The measure grows along it, from far apart to deep contact."""

GAP, _FORCE, _PRESSED, _ENERGY = range(4)
_SAMPLES = 10  # on a panel, between which folds are sought and equilibria are bracketed
_STEPS = 7  # of Newton's method within a bracket
_BEYOND = 1e-9  # of a measure: a step that leaves its bracket by less does so by rounding
_STEEPEST = 3.0  # times the mean: a cubic with steeper ends may not be monotone
_BISECTIONS = 34  # for a fold
_ROUNDING = 4e-15  # of a gap
_FLAT = 1e-7  # slope of the gap with the measure that counts as none, over 1 + |gap|


class Equilibria(NamedTuple):
    """All equilibria at one Tabor number, in reduced units.

    Attributes
    ----------
    coefficients
        Of the rows of the table, and of their slopes with the measure; shape (NODES, panels, 8).
    """

    coefficients: jax.Array

    def read(self, measure: jax.Array) -> tuple[jax.Array, jax.Array]:
        """All rows at measures, and their slopes, rows first; outside the table at its ends."""
        at = self._rows(measure, range(8))(measure)
        return jnp.stack(at[:4]), jnp.stack(at[4:])

    def gap(self, measure: jax.Array) -> tuple[jax.Array, ...]:
        """The gap at measures, and its slope."""
        return self.gap_within(measure)(measure)

    def gap_within(self, near: jax.Array) -> Callable[[jax.Array], tuple[jax.Array, ...]]:
        """The same at measures, each of the panel that the one of ``near`` beside it is on."""
        return self._rows(near, (GAP, 4 + GAP))

    def _rows(
        self, near: jax.Array, numbers: Iterable[int]
    ) -> Callable[[jax.Array], tuple[jax.Array, ...]]:
        """Some rows at measures, each of the panel that the one of ``near`` beside it is on.

        Each by itself: that takes half the time of all in one array.
        """
        ends = jnp.asarray(MEASURES)
        panel = jnp.clip(jnp.searchsorted(ends, near) - 1, 0, len(MEASURES) - 2)
        low, high = ends[panel], ends[panel + 1]
        chosen = [self.coefficients[:, panel, number] for number in numbers]

        def at(measure: jax.Array) -> tuple[jax.Array, ...]:
            x = jnp.clip(local(low, high, measure), -1.0, 1.0)
            return tuple(chebyshev_sum(row, x) for row in chosen)

        return at

    def energy_over_gaps(self, measure: jax.Array) -> jax.Array:
        """Integral of the energy over the gap, from a measure outwards to the path's begin.

        Exact for the polynomials of a panel.
        """
        ends = jnp.asarray(MEASURES)
        panel = jnp.clip(jnp.searchsorted(ends, measure) - 1, 0, len(MEASURES) - 2)
        whole = self._energy_on_panels(jnp.arange(len(MEASURES) - 1), ends[1:])
        before = jnp.append(0.0, jnp.cumsum(whole))
        return before[panel] + self._energy_on_panels(panel, measure)

    def _energy_on_panels(self, panel: jax.Array, measure: jax.Array) -> jax.Array:
        """From the begin of each one's panel to a measure on it."""
        low = jnp.asarray(MEASURES)[panel]
        node, weight = (x.reshape(-1, *(1,) * panel.ndim) for x in _ON_PANEL)
        places = low + (measure - low) * node
        energy, slope = self._rows(places, (_ENERGY, 4 + GAP))(places)
        return -(measure - low) * jnp.sum(weight * energy * slope, axis=0)


def _nodes_on_panel() -> tuple[np.ndarray, np.ndarray]:
    """Nodes and weights on [0, 1] that integrate the product of a row and a slope exactly."""
    node, weight = np.polynomial.legendre.leggauss(NODES)
    return 0.5 * (node + 1.0), 0.5 * weight


_ON_PANEL = _nodes_on_panel()

_SLOPE = np.array([np.polynomial.chebyshev.chebder(row) for row in np.eye(NODES)]).T
"""From coefficients to those of the slope with x, one fewer."""


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


@cache
def _table() -> np.ndarray:
    return np.asarray(np.load(TABLE, allow_pickle=False))


@cache
def largest_gap() -> float:
    """A reduced gap that all paths begin beyond, where bodies hardly deform each other."""
    return 0.99 * float(np.polynomial.chebyshev.chebval(-1.0, _table()[0, 0, 0, :, GAP]))


@cache
def smallest_gap() -> float:
    """A reduced gap which all paths reach."""
    ends = np.polynomial.chebyshev.chebval(1.0, _table()[:, 0, -1, :, GAP].T)
    return 0.999 * float(np.max(ends))


@jax.jit
def _path_at(log_tabor: jax.Array) -> Equilibria:
    """All equilibria at one Tabor number."""
    ends = jnp.asarray(np.log(TABOR_NUMBERS))
    panel = jnp.clip(jnp.searchsorted(ends, log_tabor) - 1, 0, len(TABOR_NUMBERS) - 2)
    chosen = jnp.asarray(_table())[panel]

    found = chebyshev_sum(chosen, local(ends[panel], ends[panel + 1], log_tabor))
    slope = np.concatenate([_SLOPE, np.zeros((1, NODES))])
    slopes = jnp.einsum("kn,xnr,x->xkr", slope, found, 2.0 / np.diff(MEASURES))
    return Equilibria(jnp.swapaxes(jnp.concatenate([found, slopes], axis=-1), 0, 1))


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
    path = _path_at(log_tabor)
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
    return values[_FORCE], values[_PRESSED], values[_ENERGY]


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
    force, pressed = (slopes[k] * along + changes[k] for k in (_FORCE, _PRESSED))
    # The energy is stationary in the shapes of both bodies: its slope with the gap is the force.
    energy = changes[_ENERGY] - values[_FORCE] * moved
    return (values[_FORCE], values[_PRESSED], values[_ENERGY]), (force, pressed, energy)
