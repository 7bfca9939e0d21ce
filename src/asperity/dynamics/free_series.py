"""Phases without drag as time series, in NumPy: nothing is compiled for a picture.

Energies follow from the work that the curves hold, times from the same quadrature as in the motion.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.polynomial import chebyshev

from ..numerics.polynomials import ANTIDERIVATIVE, local
from .curve_table import FORCE, RATE, TIME_NODES, Table
from .record import Body

SAMPLES = 40
"""Samples on a phase, and again on its part in contact."""

_AGREE = 1e-6  # of its duration: to this two quadratures of a phase agree
_STEPS = np.sin(0.5 * np.pi * np.linspace(0.0, 1.0, SAMPLES)) ** 2


class _Curves(NamedTuple):
    """What phases pass: their scanning curves, then a major branch, in the order of motion.

    Attributes
    ----------
    low, high, enter, leave
        As in :class:`~asperity.dynamics.curve_table.Pieces`, shape (phases, pieces).
    values
        Coefficients of their rows, shape (phases, pieces, NODES, rows).
    work
        Coefficients of an integral of the force [J], shape (phases, pieces, NODES + 1).
    kinetic, zero
        Kinetic energy [J] at the separation ``zero`` [m], less that integral there, shape (phases,
        pieces).
    """

    low: np.ndarray
    high: np.ndarray
    enter: np.ndarray
    leave: np.ndarray
    values: np.ndarray
    work: np.ndarray
    kinetic: np.ndarray
    zero: np.ndarray

    @classmethod
    def of(cls, table: Table, phases: Any, load: Any, *, unloading: bool) -> _Curves:
        """Those of phases and a load of NumPy's arrays, of phases with an axis of them first."""
        inner, branch, start = phases.inner, phases.branch, np.asarray(phases.start)
        order = slice(None) if unloading else slice(None, None, -1)
        ends, count = np.asarray(table.ends), start.size
        low, high = (np.broadcast_to(e[order], (count, e.size)) for e in (ends[:-1], ends[1:]))
        begin = inner.leave[:, -1:] if inner.leave.shape[1] else start[:, None]
        bound = np.maximum if unloading else np.minimum
        first, last = (low, high) if unloading else (high, low)
        values = np.asarray(table.values)[branch][:, order, :, : inner.values.shape[-1]]
        work = np.asarray(table.works.integral)[branch][:, order, :, 0]

        half = 0.5 * (inner.high - inner.low)
        own = np.einsum("kn,fpn->fpk", ANTIDERIVATIVE, inner.values[..., FORCE]) * half[..., None]
        entered, left = (
            _sum(own, local(inner.low, inner.high, at)) for at in (inner.enter, inner.leave)
        )
        gained = left - entered - load.potential_gain(inner.enter, inner.leave - inner.enter)
        kinetic = phases.kinetic[:, None] + np.cumsum(np.pad(gained, ((0, 0), (1, 0))), axis=1)
        # Of panels that meet where the branch begins, the one ahead.
        at = np.sum(bound(last, begin) == begin, axis=1, keepdims=True)
        at = np.minimum(at, low.shape[1] - 1)
        here = local(
            np.take_along_axis(low, at, axis=1), np.take_along_axis(high, at, axis=1), begin
        )
        before = _sum(np.take_along_axis(work, at[..., None], axis=1), here)
        return cls(
            np.append(inner.low, low, axis=1),
            np.append(inner.high, high, axis=1),
            np.append(inner.enter, bound(first, begin), axis=1),
            np.append(inner.leave, bound(last, begin), axis=1),
            np.append(inner.values, values, axis=1),
            np.append(own, work, axis=1),
            np.append(kinetic[:, :-1] - entered, _like(low, kinetic[:, -1:] - before), axis=1),
            np.append(inner.enter, _like(low, begin), axis=1),
        )

    def energy(self, index: np.ndarray, places: np.ndarray, load: Any) -> np.ndarray:
        """Kinetic energy [J] at places [m] of pieces by their index, shape (phases, n, places)."""
        low, high, kinetic, zero, work = (
            _pick(leaf, index) for leaf in (self.low, self.high, self.kinetic, self.zero, self.work)
        )
        x = local(low[..., None], high[..., None], places)
        climbed = load.potential_gain(zero[..., None], places - zero[..., None])
        found: np.ndarray = kinetic[..., None] + _sum(work[:, :, None], x) - climbed
        return found

    def rows(self, index: np.ndarray, places: np.ndarray) -> np.ndarray:
        """Their rows at one place [m] each, shape (phases, n, rows)."""
        low, high, values = (_pick(leaf, index) for leaf in (self.low, self.high, self.values))
        # A place is rounded by its distance from the start, which a narrow panel may not allow.
        x = np.clip(local(low, high, places), -1.0, 1.0)
        return _sum(np.moveaxis(values, 2, -1), x[..., None])


def draw(
    body: Body, table: Table, phases: Any, ended: np.ndarray, places: int, *, unloading: bool
) -> tuple[np.ndarray, ...]:
    """Time, separation, speed, rows, dissipated, drag and whether to keep, in the order of time.

    Parameters
    ----------
    body, table
        What moves without drag, and its curves.
    phases
        A :class:`~asperity.dynamics.record.Phase` whose arrays are NumPy's, with an axis of phases
        first: all in one direction.
    ended
        When each ends [s].
    places
        Samples on each piece of the curves.
    unloading
        Whether they go outwards.
    """
    load, mass = body.plain.load, float(body.mass)
    curves = _Curves.of(table, phases, load, unloading=unloading)
    ahead = 1.0 if unloading else -1.0
    along = np.sort(ahead * _path(curves, phases, places), axis=1)
    ends, spans = ahead * along, ahead * np.diff(along, axis=1)
    middle = 0.5 * (along[:, 1:] + along[:, :-1])
    index = np.sum(middle[:, :, None] > ahead * curves.leave[:, None, :], axis=-1)
    index = np.minimum(index, curves.low.shape[1] - 1)
    nodes = ends[:, :-1, None] + spans[..., None] * TIME_NODES
    energy = curves.energy(index, nodes, load)
    moving = (energy > 0.0) & (spans != 0.0)[..., None]
    speed = np.sqrt(np.where(moving, 2.0 * energy / mass, 1.0))
    taken = np.sum(np.where(moving, RATE / speed, 0.0), axis=-1) * np.abs(spans)
    taken *= _to_end(np.sum(taken, axis=1), ended - phases.begun)[:, None]
    kinetic = np.maximum(curves.energy(index, ends[:, 1:, None], load)[..., 0], 0.0)
    return (
        phases.begun[:, None] + np.cumsum(taken, axis=1),
        ends[:, 1:],
        ahead * np.sqrt(2.0 * kinetic / mass),
        curves.rows(index, ends[:, 1:]),
        _by_jumps(phases, along[:, 1:], ahead),
        np.zeros((*spans.shape, 0)),
        spans != 0.0,
    )


def _sum(coefficients: np.ndarray, x: np.ndarray) -> np.ndarray:
    """Sums of Chebyshev polynomials, the coefficients' last axis the degree."""
    found: np.ndarray = chebyshev.chebval(x, np.moveaxis(coefficients, -1, 0), tensor=False)
    return found


def _like(shape: np.ndarray, column: np.ndarray) -> np.ndarray:
    return np.broadcast_to(column, shape.shape)


def _pick(leaf: np.ndarray, index: np.ndarray) -> np.ndarray:
    """The pieces of an index (phases, n) from (phases, pieces, ...)."""
    return leaf[np.arange(index.shape[0])[:, None], index]


def _to_end(sums: np.ndarray, durations: np.ndarray) -> np.ndarray:
    """Factors that end the times of phases where they were found to end, if these agree."""
    ratio = durations / np.where(sums > 0.0, sums, 1.0)
    return np.where(np.abs(ratio - 1.0) < _AGREE, ratio, 1.0)


def _by_jumps(phases: Any, along: np.ndarray, ahead: float) -> np.ndarray:
    """What jumps take until places in the order of motion, shape (phases, places, 1 or 0)."""
    jumps = phases.jumps
    if not jumps.place.shape[1]:
        return np.zeros((*along.shape, 0))
    passed = along[..., None] > ahead * jumps.place[:, None, :]
    return np.sum(np.where(passed, jumps.energy[:, None, :], 0.0), axis=-1, keepdims=True)


def _path(curves: _Curves, phases: Any, places: int) -> np.ndarray:
    """Separations to sample: denser at both turning points, in the contact, on every piece."""
    low = np.minimum(phases.start, phases.stop)[:, None]
    high = np.maximum(phases.start, phases.stop)[:, None]
    near = np.minimum(high, low + 2.0 * np.abs(low))
    # On the part of each piece that is passed, denser at its ends.
    enter, leave = np.clip(curves.enter, low, high), np.clip(curves.leave, low, high)
    inner = np.sin(0.5 * np.pi * np.arange(places) / places) ** 2
    passed = enter[..., None] + (leave - enter)[..., None] * inner
    both = [low + (high - low) * _STEPS, low + (near - low) * _STEPS]
    return np.clip(np.concatenate([*both, passed.reshape(low.shape[0], -1)], axis=1), low, high)
