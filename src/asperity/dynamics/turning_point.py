"""Where a phase ends: the first place at which the kinetic energy is spent."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from equinox.internal import unvmap_any

from .._jax import jax, jnp
from ..numerics.polynomials import DERIVATIVE, chebyshev_sum, local
from ..numerics.roots import root_between
from ..numerics.trees import choose
from .curve_table import ENERGY_SAMPLES
from .external_forces import Load
from .phase import Ahead, TurningPoint, kinetic_along

_SHARES = np.linspace(0.0, 1.0, ENERGY_SAMPLES)[1:]
_CLOSE = 4e-14  # relative: the step that follows one so short is lost in rounding
_INWARDS = 0.1  # of a bracket
_CLIMBS = 3  # Newton steps to the largest energy, from a place that is near


class _Piece(NamedTuple):
    """Kinetic energy along one piece: offset + sum(integral) less what the load takes."""

    low: jax.Array
    high: jax.Array
    integral: jax.Array
    force: jax.Array
    offset: jax.Array
    origin: jax.Array
    load: Load

    def energy(self, place: jax.Array) -> jax.Array:
        """Kinetic energy [J], any shape."""
        work = chebyshev_sum(self.integral, local(self.low, self.high, place))
        return self.offset + work - self.load.potential_gain(self.origin, place - self.origin)

    def slope(self, place: jax.Array) -> jax.Array:
        """Force of contact less the load [N]."""
        contact = chebyshev_sum(self.force, local(self.low, self.high, place))
        return contact - self.load.force(place)

    def towards_top(self, place: jax.Array) -> jax.Array:
        """Nearer to where the energy is largest [m], within the piece; else the place itself."""
        width = self.high - self.low
        bend = chebyshev_sum(
            jnp.asarray(DERIVATIVE) @ self.force, local(self.low, self.high, place)
        )
        bend = bend * 2.0 / jnp.where(width > 0.0, width, 1.0) - self.load.slope(place)
        step = jnp.where(bend < 0.0, -self.slope(place) / jnp.where(bend < 0.0, bend, 1.0), 0.0)
        return jnp.clip(place + step, self.low, self.high)


def _piece(ahead: Ahead, piece: jax.Array) -> _Piece:
    """One piece of the way, or one panel of the branch."""
    table, work = ahead.table, ahead.inner
    panel = jnp.clip(piece - ahead.pieces, 0, table.ends.shape[0] - 2)
    outer = _Piece(
        table.ends[panel], table.ends[panel + 1],
        table.works.integral[ahead.branch, panel, :, 0],
        table.values[ahead.branch, panel, :, 0],
        work.kinetic[-1] - ahead.before[0], ahead.begin, work.load,
    )  # fmt: skip
    if not ahead.pieces:
        return outer
    k = jnp.minimum(piece, ahead.pieces - 1)
    p = work.pieces
    first = local(p.low[k], p.high[k], p.enter[k])
    integral = work.integral[:, k, 0]
    inner = _Piece(
        p.low[k], p.high[k], integral, p.values[k, :, 0],
        work.kinetic[k] - chebyshev_sum(integral, first), p.enter[k], work.load,
    )  # fmt: skip
    return choose(piece < ahead.pieces, inner, outer)


class _Bracket(NamedTuple):
    """Places [m] between which the kinetic energy [J] is spent, and what it is there."""

    inner: jax.Array
    outer: jax.Array
    left: jax.Array
    missing: jax.Array


class _Looks(NamedTuple):
    """Places where the kinetic energy was looked at, and where it was found spent first."""

    places: jax.Array
    energies: jax.Array
    passed: jax.Array
    found: jax.Array
    piece: jax.Array
    bracket: _Bracket


def _look_on_branch(ahead: Ahead) -> _Looks:
    """On the panels of the branch, whose work at these places is known."""
    places = ahead.table.looks.ravel()
    energies = ahead.outer(ahead.table.works.looks[ahead.branch].ravel(), places)
    beyond = ahead.sign * (places - ahead.begin) > 0.0
    spent = jnp.logical_and(beyond, energies < 0.0)
    count = places.shape[0]
    order = jnp.where(ahead.unloading, np.arange(count, 0, -1), np.arange(1, count + 1))
    first = jnp.argmax(jnp.where(spent, order, 0))
    before = jnp.clip(first - jnp.where(ahead.unloading, 1, -1), 0, count - 1)
    inner = jnp.where(beyond[before], places[before], ahead.begin)
    left = jnp.where(beyond[before], energies[before], ahead.inner.kinetic[-1])
    piece = ahead.pieces + first // ENERGY_SAMPLES
    bracket = _Bracket(inner, places[first], left, energies[first])
    return _Looks(places, energies, beyond, spent[first], piece, bracket)


def _look_along_curve(ahead: Ahead) -> _Looks:
    """On the pieces before the branch."""
    p = ahead.inner.pieces
    places = p.enter[:, None] + (p.leave - p.enter)[:, None] * _SHARES
    energies = kinetic_along(ahead.inner, places).ravel()
    count = _SHARES.size
    spent = jnp.logical_and(energies < 0.0, jnp.repeat(p.leave != p.enter, count))
    first = jnp.argmax(spent)
    piece = first // count
    outer = places.ravel()[first]
    inner = outer - (p.leave - p.enter)[piece] / count
    entered = ahead.inner.kinetic[piece]
    left = jnp.where(first % count == 0, entered, energies[jnp.maximum(first - 1, 0)])
    passed = jnp.ones(places.size, bool)
    bracket = _Bracket(inner, outer, left, energies[first])
    return _Looks(places.ravel(), energies, passed, spent[first], piece, bracket)


def find_turning_point(ahead: Ahead, wanted: jax.Array) -> TurningPoint:
    """The first place where the kinetic energy is spent; its largest before where ``wanted``."""
    table, looks = ahead.table, _look_on_branch(ahead)
    piece, found, bracket = looks.piece, looks.found, looks.bracket
    places, energies, passed = looks.places, looks.energies, looks.passed
    if ahead.pieces:
        near = _look_along_curve(ahead)
        soon = near.found
        piece = jnp.where(soon, near.piece, piece)
        pairs = zip(near.bracket, bracket, strict=True)
        bracket = _Bracket(*(jnp.where(soon, *pair) for pair in pairs))
        found = jnp.logical_or(soon, found)
        places = jnp.concatenate([near.places, places])
        energies = jnp.concatenate([near.energies, energies])
        passed = jnp.concatenate([near.passed, passed])
    end = jnp.where(ahead.unloading, table.ends[-1], table.ends[0])
    last = jnp.where(ahead.unloading, table.panel_at(table.ends[-1]), 0)
    piece = jnp.where(found, piece, ahead.pieces + last)
    here = _piece(ahead, piece)
    place = jnp.where(found, _polish(here, bracket), end)

    def largest() -> jax.Array:
        before = jnp.logical_and(passed, ahead.sign * (place - places) >= 0.0)
        return _fastest(ahead, places, jnp.where(before, energies, 0.0))

    maximum_kinetic = jax.lax.cond(unvmap_any(wanted), largest, lambda: jnp.zeros(()))
    return TurningPoint(
        piece, place, found, maximum_kinetic, jnp.where(found, 0.0, here.energy(place))
    )


def _fastest(ahead: Ahead, places: jax.Array, energies: jax.Array) -> jax.Array:
    """The largest kinetic energy [J], by Newton's method from the largest that was looked at.

    Within its piece and those beside it: where two meet, the force may set in, and rounding says
    in which of them the largest was.
    """
    best = jnp.argmax(energies)
    on_way = ahead.pieces * _SHARES.size
    piece = jnp.where(
        best < on_way, best // _SHARES.size, ahead.pieces + (best - on_way) // ENERGY_SAMPLES
    )

    def climbed(piece: jax.Array) -> jax.Array:
        here = _piece(ahead, piece)
        still = jax.lax.stop_gradient(here)
        begin = jnp.clip(jax.lax.stop_gradient(places[best]), still.low, still.high)
        place = jax.lax.fori_loop(0, _CLIMBS, lambda _, place: still.towards_top(place), begin)
        # At the top the energy does not change with the place.
        return here.energy(place)

    each = jax.vmap(climbed)(jnp.stack([piece, jnp.maximum(piece - 1, 0), piece + 1]))
    return jnp.maximum(energies[best], jnp.max(each))


def _polish(piece: _Piece, bracket: _Bracket) -> jax.Array:
    """Root of the kinetic energy in a bracket."""
    frozen, bracket = jax.lax.stop_gradient((piece, bracket))
    inner, outer, left, missing = bracket
    # From where a line between the ends is 0; not at the inner one, where the body may have begun.
    change = left - missing
    share = jnp.clip(left / jnp.where(change > 0.0, change, 1.0), _INWARDS, 1.0)
    close = _CLOSE * jnp.maximum(jnp.abs(inner), jnp.abs(outer))
    place = root_between(frozen.energy, inner, outer, close, inner + share * (outer - inner))
    slope = jax.lax.stop_gradient(piece.slope(place))
    correction = piece.energy(place) / jnp.where(slope == 0.0, 1.0, slope)
    # The value is polished already; the last Newton step carries the derivative.
    return place - (correction - jax.lax.stop_gradient(correction))
