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
from ..polynomials import antiderivative, chebyshev_sum, local
from .table import DRIVE, RATE, RISE, STORED, Pieces, Table


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
        return self.gained(work, places - self.begin)

    def gained(self, work: jax.Array, way: jax.Array) -> jax.Array:
        """The same, by the way [m] from where the branch begins."""
        return self.inner.kinetic[-1] + (work - self.before[0] - self.inner.weight * way)


class Turn(NamedTuple):
    """End of a phase: the piece and place where the body turns, or the end of the table.

    Pieces are counted along the way to the branch, then by the panels of the table. The largest
    kinetic energy before it may be 0 where it was not asked for.
    """

    piece: jax.Array
    place: jax.Array
    found: jax.Array
    fastest: jax.Array
    kinetic: jax.Array


def in_order(ahead: Ahead, turn: Turn) -> Turn:
    """A turn whose piece counts along the joined way, with panels counted as the table does."""
    panels = ahead.table.ends.shape[0] - 1
    step = turn.piece - ahead.pieces
    panel = jnp.where(ahead.parting, step, panels - 1 - step)
    return turn._replace(piece=jnp.where(step < 0, turn.piece, ahead.pieces + panel))


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
    total = time_over(jnp.diff(table.ends), whole, energies, mass)
    # The panel in which the branch begins, and the one in which the body turns.
    panels = jnp.stack([ahead.panel, panel])
    low, high = table.ends[panels], table.ends[panels + 1]
    near, far = jnp.where(ahead.parting, high[0], low[0]), jnp.where(ahead.parting, low[1], high[1])
    first = jnp.stack([ahead.begin, far])
    last = jnp.stack([until(near), turn.place])
    span = last - first
    integral = table.works.integral[ahead.branch, panels, :, 0]
    start = local(low, high, first)[:, None]
    x = start + (local(low, high, last)[:, None] - start) * RISE
    way = (first - ahead.begin)[:, None] + span[:, None] * RISE
    energies = ahead.gained(chebyshev_sum(integral.T[:, :, None], x), way)
    used = jnp.stack([reached, jnp.logical_and(reached, panel != ahead.panel)])
    total = total + time_over(jnp.abs(span), used, energies, mass)
    if not ahead.pieces:
        return total
    p = inner.pieces
    enter = until(p.enter)
    span = until(p.leave) - enter
    energies = kinetic_along(inner, enter[:, None] + span[:, None] * RISE)
    return total + time_over(jnp.abs(span), span != 0.0, energies, mass)


def time_over(
    length: jax.Array, used: jax.Array, energies: jax.Array, mass: jax.Array
) -> jax.Array:
    """Time [s] over pieces with kinetic energies [J] at the places RISE of each."""
    squares = jnp.where(energies > 0.0, 2.0 / mass * energies, jnp.inf)  # of the speeds
    slowness = jnp.sum(RATE * jax.lax.rsqrt(squares), axis=1)
    return jnp.sum(jnp.where(used, slowness * length, 0.0))


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


def mechanical_at_end(ahead: Ahead) -> jax.Array:
    """Mechanical energy [J] at the end of the table, were a body that moves out not to turn."""
    place = ahead.table.ends[-1]
    weight = ahead.inner.weight
    kinetic = ahead.inner.kinetic[-1] - ahead.before[0] - weight * (place - ahead.begin)
    stored = chebyshev_sum(ahead.table.values[ahead.branch, -1, :, STORED], jnp.ones(()))
    return kinetic + weight * place + stored


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
