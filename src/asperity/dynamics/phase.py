"""One phase of a motion: from one turning point to the next.

Where the force depends on the separation alone, turning points are roots of the kinetic
energy K(d), and the time between two places is the integral of dd / v, v = sqrt(2 K / m).
A phase runs over the pieces of the way from its reversal to the major branch, then
over the panels of that branch, whose work is tabulated once for all phases.
"""

from __future__ import annotations

from typing import NamedTuple

from .._jax import jax, jnp
from ..numerics.polynomials import antiderivative, chebyshev_sum, local
from .curve_table import DRIVE, STORED, Pieces, Table
from .external_forces import Load


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
    load
        What presses the body towards the surface.
    """

    pieces: Pieces
    integral: jax.Array
    kinetic: jax.Array
    load: Load


class Ahead(NamedTuple):
    """All that lies ahead of a body that has just turned.

    Attributes
    ----------
    table
        The major branches.
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
    unloading
        Whether the body moves outwards.
    """

    table: Table
    branch: jax.Array
    inner: Work
    begin: jax.Array
    before: jax.Array
    panel: jax.Array
    unloading: jax.Array

    @property
    def sign(self) -> jax.Array:
        """1 outwards, -1 inwards."""
        return jnp.where(self.unloading, 1.0, -1.0)

    @property
    def pieces(self) -> int:
        """Number of pieces before the branch."""
        return self.inner.pieces.low.shape[0]

    def outer(self, work: jax.Array, places: jax.Array) -> jax.Array:
        """Kinetic energy [J] at places of the branch where the ``work`` from the top is known."""
        return self.gained(work, places - self.begin)

    def gained(self, work: jax.Array, distance: jax.Array) -> jax.Array:
        """The same, by the ``distance`` [m] from where the branch begins."""
        climbed = self.inner.load.potential_gain(self.begin, distance)
        return self.inner.kinetic[-1] + (work - self.before[0] - climbed)


class TurningPoint(NamedTuple):
    """End of a phase: the piece and place where the body turns, or the end of the table.

    Pieces are counted along the way to the branch, then by the panels of the table. The largest
    kinetic energy before it may be 0 where it was not asked for.
    """

    piece: jax.Array
    place: jax.Array
    found: jax.Array
    maximum_kinetic: jax.Array
    kinetic: jax.Array


def in_order(ahead: Ahead, turn: TurningPoint) -> TurningPoint:
    """A turn whose piece counts along the joined way, with panels counted as the table does."""
    panels = ahead.table.ends.shape[0] - 1
    step = turn.piece - ahead.pieces
    panel = jnp.where(ahead.unloading, step, panels - 1 - step)
    return turn._replace(piece=jnp.where(step < 0, turn.piece, ahead.pieces + panel))


def work_along(pieces: Pieces, kinetic: jax.Array, load: Load) -> Work:
    """Integrate the force along pieces that are entered with a kinetic energy [J]."""
    half = 0.5 * (pieces.high - pieces.low)
    integral = antiderivative(jnp.moveaxis(pieces.values[..., DRIVE], 1, 0)) * half[:, None]
    force = integral[..., 0]
    first = local(pieces.low, pieces.high, pieces.enter)
    last = local(pieces.low, pieces.high, pieces.leave)
    gain = chebyshev_sum(force, last) - chebyshev_sum(force, first)
    gain = gain - load.potential_gain(pieces.enter, pieces.leave - pieces.enter)
    energies = kinetic + jnp.concatenate([jnp.zeros(1), jnp.cumsum(gain)])
    return Work(pieces, integral, energies, load)


def kinetic_along(work: Work, places: jax.Array) -> jax.Array:
    """Kinetic energy [J] at places [m] of every piece, shape (pieces, places)."""
    p = work.pieces
    force = work.integral[..., 0]
    x = local(p.low[:, None], p.high[:, None], places)
    first = local(p.low, p.high, p.enter)
    gain = chebyshev_sum(force[:, :, None], x) - chebyshev_sum(force, first)[:, None]
    enter = p.enter[:, None]
    return work.kinetic[:-1, None] + gain - work.load.potential_gain(enter, places - enter)


def look_ahead(
    table: Table,
    branch: jax.Array,
    inner: Pieces,
    kinetic: jax.Array,
    load: Load,
    start: jax.Array,
    unloading: jax.Array,
) -> Ahead:
    """What lies ahead of a body that leaves ``start`` with a kinetic energy [J]."""
    work = work_along(inner, kinetic, load)
    begin = inner.leave[-1] if inner.leave.shape[0] else start
    meets = jnp.sum(table.ends[1:-1] <= begin)
    panel = jnp.where(unloading, meets, table.panel_at(begin))
    before = _work_at(table, branch, panel, begin)
    return Ahead(table, branch, work, begin, before, panel, unloading)


def _work_at(table: Table, branch: jax.Array, panel: jax.Array, place: jax.Array) -> jax.Array:
    """Work from the top to a place of a panel, of the force and of its attractive part [J]."""
    x = local(table.ends[panel], table.ends[panel + 1], place)
    return chebyshev_sum(table.works.integral[branch, panel], x)


def pull_work(ahead: Ahead, turn: TurningPoint) -> jax.Array:
    """Work of the adhesive and capillary forces over a phase [J]."""
    panel = jnp.maximum(turn.piece - ahead.pieces, 0)
    at_end = _work_at(ahead.table, ahead.branch, panel, turn.place)[1]
    total = jnp.where(turn.piece >= ahead.pieces, at_end - ahead.before[1], 0.0)
    if not ahead.pieces:
        return total
    p, attraction = ahead.inner.pieces, ahead.inner.integral[..., 1]

    def until(place: jax.Array) -> jax.Array:
        near, far = jnp.minimum(place, turn.place), jnp.maximum(place, turn.place)
        inside = jnp.where(ahead.unloading, near, far)
        return chebyshev_sum(attraction, local(p.low, p.high, inside))

    return total + jnp.sum(until(p.leave) - until(p.enter))


def mechanical_at_end(ahead: Ahead) -> jax.Array:
    """Mechanical energy [J] at the end of the table, were a body that moves out not to turn."""
    place = ahead.table.ends[-1]
    load = ahead.inner.load
    climbed = load.potential_gain(ahead.begin, place - ahead.begin)
    kinetic = ahead.inner.kinetic[-1] - ahead.before[0] - climbed
    stored = chebyshev_sum(ahead.table.values[ahead.branch, -1, :, STORED], jnp.ones(()))
    return kinetic + load.potential(place) + stored


def row_at(ahead: Ahead, turn: TurningPoint) -> jax.Array:
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
