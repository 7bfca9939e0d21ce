"""One phase of a motion: from one turning point to the next.

Where the force depends on the separation alone, turning points are roots of the kinetic
energy K(d), and the time between two places is the integral of dd / v, v = sqrt(2 K / m).
A phase runs over the pieces of the way from its reversal to the outermost branch, then
over the panels of that branch, whose work is tabulated once for all phases.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from .._jax import jax, jnp
from .table import (
    DRIVE,
    LOOKS,
    RATE,
    RISE,
    Pieces,
    Table,
    antiderivative,
    chebyshev_sum,
    local,
)

_SHARES = np.linspace(0.0, 1.0, LOOKS)[1:]
_POLISH = 60  # halvings and Newton steps of a turning point, at most
_CLOSE = 4e-15  # relative


class Work(NamedTuple):
    """Kinetic energy along pieces.

    Attributes
    ----------
    pieces
        The polynomials.
    integral
        Chebyshev coefficients of the work of the force and of its attractive part, shape
        (NODES + 1, pieces, 2).
    kinetic
        Kinetic energy [J] where each piece is entered, and after the last, (pieces + 1,).
    weight
        Weight [N].
    """

    pieces: Pieces
    integral: jax.Array
    kinetic: jax.Array
    weight: jax.Array


class Ahead(NamedTuple):
    """All that lies ahead of a body that has just turned.

    Attributes
    ----------
    table
        The outermost branches.
    branch
        Index of the one that it reaches.
    inner
        Kinetic energy along the way there.
    begin
        Separation [m] at which it is reached.
    before
        Work from the top of the table to there, of the force and of its attractive part [J].
    panel
        Panel of the branch in which it begins.
    parting
        Whether the body moves outwards.
    """

    table: Table
    branch: jax.Array
    inner: Work
    begin: jax.Array
    before: jax.Array
    panel: jax.Array
    parting: jax.Array

    @property
    def sign(self) -> jax.Array:
        """1 outwards, -1 inwards."""
        return jnp.where(self.parting, 1.0, -1.0)

    @property
    def pieces(self) -> int:
        """Number of pieces before the branch."""
        return self.inner.pieces.low.shape[0]

    def outer(self, work: jax.Array, places: jax.Array) -> jax.Array:
        """Kinetic energy [J] at places of the branch where the ``work`` from the top is known."""
        gain = work - self.before[0] - self.inner.weight * (places - self.begin)
        return self.inner.kinetic[-1] + gain


class Turn(NamedTuple):
    """End of a phase: the piece and place where the body turns, or the end of the table.

    Pieces are counted along the way to the branch, then by the panels of the table.
    """

    piece: jax.Array
    place: jax.Array
    found: jax.Array
    fastest: jax.Array
    kinetic: jax.Array


def work_along(pieces: Pieces, kinetic: jax.Array, weight: jax.Array) -> Work:
    """Integrate the force along pieces that are entered with a kinetic energy [J]."""
    half = 0.5 * (pieces.high - pieces.low)
    integral = antiderivative(jnp.moveaxis(pieces.values[..., DRIVE], 1, 0)) * half[:, None]
    force = integral[..., 0]
    first = local(pieces.low, pieces.high, pieces.enter)
    last = local(pieces.low, pieces.high, pieces.leave)
    gain = chebyshev_sum(force, last) - chebyshev_sum(force, first)
    gain = gain - weight * (pieces.leave - pieces.enter)
    energies = kinetic + jnp.concatenate([jnp.zeros(1), jnp.cumsum(gain)])
    return Work(pieces, integral, energies, weight)


def kinetic_along(work: Work, places: jax.Array) -> jax.Array:
    """Kinetic energy [J] at places [m] of every piece, shape (pieces, places)."""
    p = work.pieces
    force = work.integral[..., 0]
    x = local(p.low[:, None], p.high[:, None], places)
    first = local(p.low, p.high, p.enter)
    gain = chebyshev_sum(force[:, :, None], x) - chebyshev_sum(force, first)[:, None]
    return work.kinetic[:-1, None] + gain - work.weight * (places - p.enter[:, None])


def look_ahead(
    table: Table,
    branch: jax.Array,
    inner: Pieces,
    kinetic: jax.Array,
    weight: jax.Array,
    start: jax.Array,
    parting: jax.Array,
) -> Ahead:
    """What lies ahead of a body that leaves ``start`` with a kinetic energy [J]."""
    work = work_along(inner, kinetic, weight)
    begin = inner.leave[-1] if inner.leave.shape[0] else start
    meets = jnp.sum(table.ends[1:-1] <= begin)
    panel = jnp.where(parting, meets, table.panel_at(begin))
    before = _work_at(table, branch, panel, begin)
    return Ahead(table, branch, work, begin, before, panel, parting)


def _work_at(table: Table, branch: jax.Array, panel: jax.Array, place: jax.Array) -> jax.Array:
    """Work from the top to a place of a panel, of the force and of its attractive part [J]."""
    x = local(table.ends[panel], table.ends[panel + 1], place)
    return chebyshev_sum(table.works.integral[branch, panel], x)


class _Piece(NamedTuple):
    """Kinetic energy along one piece: offset + sum(integral) - weight (place - origin)."""

    low: jax.Array
    high: jax.Array
    integral: jax.Array
    force: jax.Array
    offset: jax.Array
    origin: jax.Array
    weight: jax.Array

    def energy(self, place: jax.Array) -> jax.Array:
        """Kinetic energy [J], any shape."""
        work = chebyshev_sum(self.integral, local(self.low, self.high, place))
        return self.offset + work - self.weight * (place - self.origin)

    def slope(self, place: jax.Array) -> jax.Array:
        """Force less weight [N]."""
        return chebyshev_sum(self.force, local(self.low, self.high, place)) - self.weight


def _piece(ahead: Ahead, piece: jax.Array) -> _Piece:
    """One piece of the way, or one panel of the branch."""
    table, work = ahead.table, ahead.inner
    panel = jnp.clip(piece - ahead.pieces, 0, table.ends.shape[0] - 2)
    outer = _Piece(
        table.ends[panel], table.ends[panel + 1],
        table.works.integral[ahead.branch, panel, :, 0],
        table.values[ahead.branch, panel, :, 0],
        work.kinetic[-1] - ahead.before[0], ahead.begin, work.weight,
    )  # fmt: skip
    if not ahead.pieces:
        return outer
    k = jnp.minimum(piece, ahead.pieces - 1)
    p = work.pieces
    first = local(p.low[k], p.high[k], p.enter[k])
    integral = work.integral[:, k, 0]
    inner = _Piece(
        p.low[k], p.high[k], integral, p.values[k, :, 0],
        work.kinetic[k] - chebyshev_sum(integral, first), p.enter[k], work.weight,
    )  # fmt: skip
    return jax.tree_util.tree_map(
        lambda near, far: jnp.where(piece < ahead.pieces, near, far), inner, outer
    )


class _Looks(NamedTuple):
    """Places where the kinetic energy was looked at, and where it was found spent first."""

    places: jax.Array
    energies: jax.Array
    passed: jax.Array
    found: jax.Array
    piece: jax.Array
    inner: jax.Array
    outer: jax.Array


def _look_on_branch(ahead: Ahead) -> _Looks:
    """On the panels of the branch, whose work at these places is known."""
    places = ahead.table.looks.ravel()
    energies = ahead.outer(ahead.table.works.looks[ahead.branch].ravel(), places)
    beyond = ahead.sign * (places - ahead.begin) > 0.0
    spent = jnp.logical_and(beyond, energies < 0.0)
    count = places.shape[0]
    first = jnp.where(ahead.parting, jnp.argmax(spent), count - 1 - jnp.argmax(spent[::-1]))
    before = jnp.clip(first - jnp.where(ahead.parting, 1, -1), 0, count - 1)
    inner = jnp.where(beyond[before], places[before], ahead.begin)
    piece = ahead.pieces + first // LOOKS
    return _Looks(places, energies, beyond, jnp.any(spent), piece, inner, places[first])


def _look_on_way(ahead: Ahead) -> _Looks:
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
    passed = jnp.ones(places.size, bool)
    return _Looks(places.ravel(), energies, passed, jnp.any(spent), piece, inner, outer)


def find_turn(ahead: Ahead) -> Turn:
    """The first place where the kinetic energy is spent."""
    table, looks = ahead.table, _look_on_branch(ahead)
    piece, found, inner, outer = looks.piece, looks.found, looks.inner, looks.outer
    places, energies, passed = looks.places, looks.energies, looks.passed
    if ahead.pieces:
        near = _look_on_way(ahead)
        soon = near.found
        piece = jnp.where(soon, near.piece, piece)
        inner, outer = jnp.where(soon, near.inner, inner), jnp.where(soon, near.outer, outer)
        found = jnp.logical_or(soon, found)
        places = jnp.concatenate([near.places, places])
        energies = jnp.concatenate([near.energies, energies])
        passed = jnp.concatenate([near.passed, passed])
    end = jnp.where(ahead.parting, table.ends[-1], table.ends[0])
    last = jnp.where(ahead.parting, table.panel_at(table.ends[-1]), 0)
    piece = jnp.where(found, piece, ahead.pieces + last)
    here = _piece(ahead, piece)
    place = jnp.where(found, _polish(here, inner, outer), end)
    passed = jnp.logical_and(passed, ahead.sign * (place - places) >= 0.0)
    fastest = jnp.max(jnp.where(passed, energies, 0.0))
    return Turn(piece, place, found, fastest, jnp.where(found, 0.0, here.energy(place)))


def _polish(piece: _Piece, inner: jax.Array, outer: jax.Array) -> jax.Array:
    """Root of the kinetic energy between two places: Newton kept inside its bracket."""
    frozen, inner, outer = jax.lax.stop_gradient((piece, inner, outer))
    close = _CLOSE * jnp.maximum(jnp.abs(inner), jnp.abs(outer))

    def go_on(carry):  # type: ignore[no-untyped-def]
        _, _, _, moved, count = carry
        return jnp.logical_and(moved > close, count < _POLISH)

    def step(carry):  # type: ignore[no-untyped-def]
        inside, outside, place, _, count = carry
        energy, slope = frozen.energy(place), frozen.slope(place)
        alive = energy >= 0.0
        inside, outside = jnp.where(alive, place, inside), jnp.where(alive, outside, place)
        target = place - energy / jnp.where(slope == 0.0, 1.0, slope)
        moved = jnp.minimum(jnp.abs(target - place), jnp.abs(outside - inside))
        between = (target - inside) * (target - outside) <= 0.0
        middle = 0.5 * (inside + outside)
        following = jnp.where(jnp.logical_or(between, moved <= close), target, middle)
        low, high = jnp.minimum(inside, outside), jnp.maximum(inside, outside)
        return inside, outside, jnp.clip(following, low, high), moved, count + 1

    start = (inner, outer, 0.5 * (inner + outer), jnp.asarray(jnp.inf), 0)
    place = jax.lax.while_loop(go_on, step, start)[2]
    slope = jax.lax.stop_gradient(piece.slope(place))
    correction = piece.energy(place) / jnp.where(slope == 0.0, 1.0, slope)
    # The value is polished already; the last Newton step carries the derivative.
    return place - (correction - jax.lax.stop_gradient(correction))


def travel_time(ahead: Ahead, turn: Turn, mass: jax.Array) -> jax.Array:
    """Time [s] from the start of a phase to its turn."""
    table, inner = ahead.table, ahead.inner
    panel = turn.piece - ahead.pieces
    reached = panel >= 0

    def until(place: jax.Array) -> jax.Array:
        near, far = jnp.minimum(place, turn.place), jnp.maximum(place, turn.place)
        return jnp.where(ahead.parting, near, far)

    # Panels passed as a whole, whose work is known at all places of the quadrature.
    index = np.arange(table.ends.shape[0] - 1)
    low, high = jnp.minimum(panel, ahead.panel), jnp.maximum(panel, ahead.panel)
    whole = reached & (low < index) & (index < high)
    energies = ahead.outer(table.works.nodes[ahead.branch], table.nodes)
    total = _time_over(jnp.diff(table.ends), whole, energies, mass)
    # The panel in which the branch begins, and the one in which the body turns.
    near = jnp.where(ahead.parting, table.ends[ahead.panel + 1], table.ends[ahead.panel])
    far = jnp.where(ahead.parting, table.ends[panel], table.ends[panel + 1])
    first = jnp.stack([ahead.begin, far])
    last = jnp.stack([until(near), turn.place])
    panels = jnp.stack([ahead.panel, panel])
    span = last - first
    places = first[:, None] + span[:, None] * RISE
    integral = table.works.integral[ahead.branch, panels, :, 0]
    x = local(table.ends[panels][:, None], table.ends[panels + 1][:, None], places)
    energies = ahead.outer(chebyshev_sum(integral.T[:, :, None], x), places)
    used = jnp.stack([reached, jnp.logical_and(reached, panel != ahead.panel)])
    total = total + _time_over(jnp.abs(span), used, energies, mass)
    if not ahead.pieces:
        return total
    p = inner.pieces
    enter = until(p.enter)
    span = until(p.leave) - enter
    energies = kinetic_along(inner, enter[:, None] + span[:, None] * RISE)
    return total + _time_over(jnp.abs(span), span != 0.0, energies, mass)


def _time_over(
    length: jax.Array, used: jax.Array, energies: jax.Array, mass: jax.Array
) -> jax.Array:
    """Time [s] over pieces with kinetic energies [J] at the places RISE of each."""
    moving = jnp.logical_and(energies > 0.0, used[:, None])
    speed = jnp.sqrt(jnp.where(moving, 2.0 * energies / mass, 1.0))
    return jnp.sum(jnp.where(moving, RATE / speed * length[:, None], 0.0))


def pull_work(ahead: Ahead, turn: Turn) -> jax.Array:
    """Work of the adhesive and capillary forces over a phase [J]."""
    panel = jnp.maximum(turn.piece - ahead.pieces, 0)
    at_end = _work_at(ahead.table, ahead.branch, panel, turn.place)[1]
    total = jnp.where(turn.piece >= ahead.pieces, at_end - ahead.before[1], 0.0)
    if not ahead.pieces:
        return total
    p, pull = ahead.inner.pieces, ahead.inner.integral[..., 1]

    def until(place: jax.Array) -> jax.Array:
        near, far = jnp.minimum(place, turn.place), jnp.maximum(place, turn.place)
        inside = jnp.where(ahead.parting, near, far)
        return chebyshev_sum(pull, local(p.low, p.high, inside))

    return total + jnp.sum(until(p.leave) - until(p.enter))


def row_at(ahead: Ahead, turn: Turn) -> jax.Array:
    """All quantities of the contact where a phase ends."""
    table = ahead.table
    panel = jnp.maximum(turn.piece - ahead.pieces, 0)
    x = local(table.ends[panel], table.ends[panel + 1], turn.place)
    row = chebyshev_sum(table.values[ahead.branch, panel], x[None])
    if not ahead.pieces:
        return row
    p = ahead.inner.pieces
    at = jnp.minimum(turn.piece, ahead.pieces - 1)
    near = chebyshev_sum(p.values[at], local(p.low[at], p.high[at], turn.place)[None])
    return jnp.where(turn.piece < ahead.pieces, near, row)
