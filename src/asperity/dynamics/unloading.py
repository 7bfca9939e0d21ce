"""Pull-off force and work of separation: what pulls two bodies apart after a first loading."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from .._jax import jax, jnp
from ..numerics.compilation import kept
from ..numerics.polynomials import ANTIDERIVATIVE, DERIVATIVE, chebyshev_sum, local
from .curve_table import CONTACTING, FORCE, STORED, Pieces, Quantities, Table, join
from .record import Phase

_SHARES = 0.5 * (1.0 - np.cos(np.pi * np.linspace(0.0, 1.0, 25)))
_ROUNDING = 1e-15  # of the largest force, some units in the last place: less tension is none
_SUMMED = 1e-14  # of the terms of a piece's polynomial: their sum is not known closer
_NEWTON = 8  # steps from the nearest of these shares of a piece


@kept
class Unloading(NamedTuple):
    """The attraction between two bodies that are pulled apart.

    Attributes
    ----------
    pull_off
        Largest tension while unloading [N]; 0 where nothing pulls. A tension is rounding, and
        counts as none, below 1e-15 of the largest force or 1e-14 of the sum of the sizes of the
        terms of its polynomial.
    separation
        Rigid separation at which it occurs [m]; NaN where nothing pulls.
    work
        Work against the tension [J], from the separation of zero force to infinity.
    held
        Expected number of asperities that touch or are bonded there.
    depends
        Whether they depend on the load before: unloading reaches the major branch, which is the
        same after any load, only beyond the separation of zero force; or the contact has yielded.
    """

    pull_off: jax.Array
    separation: jax.Array
    work: jax.Array
    held: jax.Array
    depends: jax.Array


def unloading(table: Table, rise: Phase) -> Unloading:
    """What a restitution phase is pulled back by, were it to go on to infinity.

    Parameters
    ----------
    table
        The major branches of the contact.
    rise
        The phase: where it starts, its scanning curve, and the branch that this leads to.

    Notes
    -----
    The pull-off force is the extremum of the unloading force, a root of its derivative. The work
    is the largest value of the integral of the attraction from a separation to infinity. Both are
    found on the polynomials of the curves, to the error of these. Beyond the table the free
    energy of the bodies is what is left to do.
    """
    pieces = join(table, rise.branch, rise.inner, rise.start, jnp.asarray(True))
    curve = _Curve.of(pieces)
    lowest = curve.extremum(curve.force, curve.slope, curve.bend)
    tension = -curve.least(curve.force, lowest)
    pulls = tension > jnp.maximum(_ROUNDING * curve.largest, curve.rounding(lowest))
    beyond = -chebyshev_sum(table.values[rise.branch, -1, :, STORED], jnp.ones(()))
    begins = curve.extremum(curve.left, -curve.force, -curve.slope)
    work = beyond - curve.least(curve.left, begins)
    joined = rise.inner.leave[-1] if rise.inner.leave.shape[0] else rise.start
    zero_force = curve.place(curve.left, begins)
    depends = jnp.logical_and(joined > rise.start, joined > zero_force)
    if table.left:
        depends = jnp.ones_like(depends)
    return Unloading(
        pull_off=jnp.where(pulls, tension, 0.0),
        separation=jnp.where(pulls, curve.place(curve.force, lowest), jnp.nan),
        work=jnp.where(pulls, work, 0.0),
        held=curve.held(lowest, Quantities(rise.bonds.shape[0], 0)),
        depends=jnp.logical_and(pulls, depends),
    )


class _Curve(NamedTuple):
    """Force along the pieces of an unloading, with its derivatives, as polynomials.

    ``left`` is its integral from a separation to the end. Each has the degree along its first
    axis and the pieces along its second. Empty pieces are not ``used``.
    """

    pieces: Pieces
    left: jax.Array
    force: jax.Array
    slope: jax.Array
    bend: jax.Array
    used: jax.Array

    @classmethod
    def of(cls, pieces: Pieces) -> _Curve:
        used = pieces.leave > pieces.enter
        half = jnp.where(used, 0.5 * (pieces.high - pieces.low), 1.0)
        force = pieces.values[..., FORCE].T
        slope = jnp.asarray(DERIVATIVE) @ force / half
        bend = jnp.asarray(DERIVATIVE)[:-1, :-1] @ slope / half
        work = jnp.asarray(ANTIDERIVATIVE) @ force * half
        enter, leave = (local(pieces.low, pieces.high, end) for end in pieces[2:4])
        at_leave = chebyshev_sum(work, leave)
        gain = jnp.where(used, at_leave - chebyshev_sum(work, enter), 0.0)
        # Summed from the end, so that the large work of repulsion does not cancel.
        beyond = jnp.cumsum(gain[::-1])[::-1] - gain
        left = (-work).at[0].add(at_leave + beyond)
        return cls(pieces, left, force, slope, bend, used)

    @property
    def largest(self) -> jax.Array:
        """Largest size of the force where pieces begin [N]."""
        at_enter = chebyshev_sum(self.force, self._local(self.pieces.enter))
        return jnp.max(jnp.where(self.used, jnp.abs(at_enter), 0.0))

    def rounding(self, places: jax.Array) -> jax.Array:
        """How closely the force is known on the piece where it is least [N]."""
        piece = jnp.argmin(self._values(self.force, places))
        return _SUMMED * jnp.sum(jnp.abs(self.force[:, piece]))

    def _local(self, place: jax.Array) -> jax.Array:
        return local(self.pieces.low, self.pieces.high, place)

    def extremum(self, value: jax.Array, slope: jax.Array, bend: jax.Array) -> jax.Array:
        """Where ``value`` is least on each piece [m]: Newton's method from the least of samples."""
        pieces = self.pieces
        places = pieces.enter + (pieces.leave - pieces.enter) * _SHARES[:, None]
        best = jnp.argmin(chebyshev_sum(value[:, None], self._local(places)), axis=0)
        index = jnp.arange(best.size)
        low = places[jnp.maximum(best - 1, 0), index]
        high = places[jnp.minimum(best + 1, len(_SHARES) - 1), index]

        def nearer(_: int, place: jax.Array) -> jax.Array:
            x = self._local(place)
            rate, change = chebyshev_sum(slope, x), chebyshev_sum(bend, x)
            step = jnp.where(change > 0.0, rate / jnp.where(change > 0.0, change, 1.0), 0.0)
            return jnp.clip(place - step, low, high)

        return jax.lax.fori_loop(0, _NEWTON, nearer, places[best, index])

    def least(self, value: jax.Array, places: jax.Array) -> jax.Array:
        """The least value over all pieces, each at its place."""
        return jnp.min(self._values(value, places))

    def place(self, value: jax.Array, places: jax.Array) -> jax.Array:
        """The place [m] of the least value."""
        return places[jnp.argmin(self._values(value, places))]

    def held(self, places: jax.Array, layout: Quantities) -> jax.Array:
        """Asperities that touch or are bonded where the force is least."""
        pieces, k = self.pieces, jnp.argmin(self._values(self.force, places))
        x = local(pieces.low[k], pieces.high[k], places[k])
        row = chebyshev_sum(pieces.values[k], x[None])
        bonds = jnp.max(row[layout.bonds], initial=0.0)
        return jnp.maximum(row[CONTACTING], bonds)

    def _values(self, value: jax.Array, places: jax.Array) -> jax.Array:
        return jnp.where(self.used, chebyshev_sum(value, self._local(places)), jnp.inf)
