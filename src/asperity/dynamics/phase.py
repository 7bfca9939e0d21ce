"""One phase of a motion: from one turning point to the next.

Where the force depends on the separation alone, turning points are roots of the kinetic
energy K(d), and the time between two places is the integral of dd / v, v = sqrt(2 K / m).
A phase runs over the pieces of the way from its reversal to the major branch, then
over the panels of that branch, whose work is tabulated once for all phases.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from .._jax import jax, jnp
from ..numerics.polynomials import NODES, antiderivative, chebyshev_sum, local
from .curve_table import DRIVE, FORCE, STORED, TIME_NODES, Pieces, Table
from .external_forces import Load
from .phase_time import Ends, time_over

_TIME_NODES_AND_ENDS = np.concatenate([[0.0], TIME_NODES, [1.0]])  # with both ends
_BOTH = np.array([0, -1])
_ALTERNATE = (-1.0) ** np.arange(NODES)  # Chebyshev polynomials at the lower end


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
        climbed = self.inner.load.climb(self.begin, distance)
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
    gain = gain - load.climb(pieces.enter, pieces.leave - pieces.enter)
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
    return work.kinetic[:-1, None] + gain - work.load.climb(enter, places - enter)


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


def travel_time(ahead: Ahead, turn: TurningPoint, mass: jax.Array) -> jax.Array:
    """Time [s] from the start of a phase to its turn."""
    total = _time_of_whole(ahead, turn, mass) + _time_of_parts(ahead, turn, mass)
    return total + _time_before(ahead, turn, mass) if ahead.pieces else total


def _until(ahead: Ahead, turn: TurningPoint, place: jax.Array) -> jax.Array:
    near, far = jnp.minimum(place, turn.place), jnp.maximum(place, turn.place)
    return jnp.where(ahead.unloading, near, far)


def _time_of_whole(ahead: Ahead, turn: TurningPoint, mass: jax.Array) -> jax.Array:
    """On panels passed as a whole, whose work is known at all places of the quadrature."""
    table, panel = ahead.table, turn.piece - ahead.pieces
    index = np.arange(table.ends.shape[0] - 1)
    low, high = jnp.minimum(panel, ahead.panel), jnp.maximum(panel, ahead.panel)
    whole = (panel >= 0) & (low < index) & (index < high)
    nodes, looks = table.works.nodes[ahead.branch], table.works.looks[ahead.branch]
    first, last = (
        ahead.outer(looks[:, k], places)
        for k, places in ((0, table.ends[:-1]), (-1, table.ends[1:]))
    )
    force = table.values[ahead.branch, :, :, FORCE]
    load = ahead.inner.load
    pushes = (
        jnp.sum(force * _ALTERNATE, axis=1) - load.force(table.ends[:-1]),
        jnp.sum(force, axis=1) - load.force(table.ends[1:]),
    )
    ends = Ends(first, last, *pushes)
    energies = ahead.outer(nodes, table.nodes)
    return time_over(jnp.diff(table.ends), whole, energies, mass, ends)


def _time_of_parts(ahead: Ahead, turn: TurningPoint, mass: jax.Array) -> jax.Array:
    """On the panel in which the branch begins, and on the one in which the body turns."""
    table, panel = ahead.table, turn.piece - ahead.pieces
    panels = jnp.stack([ahead.panel, panel])
    low, high = table.ends[panels], table.ends[panels + 1]
    near, far = (
        jnp.where(ahead.unloading, high[0], low[0]),
        jnp.where(ahead.unloading, low[1], high[1]),
    )
    first = jnp.stack([ahead.begin, far])
    last = jnp.stack([_until(ahead, turn, near), turn.place])
    span = last - first
    integral = table.works.integral[ahead.branch, panels, :, 0]
    start = local(low, high, first)[:, None]
    x = start + (local(low, high, last)[:, None] - start) * _TIME_NODES_AND_ENDS
    distance = (first - ahead.begin)[:, None] + span[:, None] * _TIME_NODES_AND_ENDS
    energies = ahead.gained(chebyshev_sum(integral.T[:, :, None], x), distance)
    energies = _resting(turn, last, energies.at[0, 0].set(ahead.inner.kinetic[-1]))
    force = table.values[ahead.branch, panels, :, FORCE]
    both = chebyshev_sum(force.T[:, :, None], x[:, _BOTH])
    ends = Ends.of(energies, both - ahead.inner.load.force(jnp.stack([first, last], axis=1)))
    used = (panel >= 0) & jnp.stack([jnp.asarray(True), panel != ahead.panel])
    return time_over(span, used, energies[:, 1:-1], mass, ends)


def _time_before(ahead: Ahead, turn: TurningPoint, mass: jax.Array) -> jax.Array:
    """On the pieces before the branch."""
    p = ahead.inner.pieces
    ends = _until(ahead, turn, p.enter), _until(ahead, turn, p.leave)
    return time_along(ahead.inner, ends, mass, lambda last, e: _resting(turn, last, e))


def time_along(
    work: Work,
    ends: tuple[jax.Array, jax.Array],
    mass: jax.Array,
    resting: Callable[[jax.Array, jax.Array], jax.Array] = lambda last, energies: energies,
) -> jax.Array:
    """Time [s] over pieces between two places of each [m].

    Parameters
    ----------
    work
        The pieces, with the kinetic energy along them.
    ends
        Where the body enters and leaves each.
    mass
        Mass [kg].
    resting
        Sets the energies at places of the pieces to 0 where the body turns at the last.
    """
    p, (enter, leave) = work.pieces, ends
    span = leave - enter
    places = enter[:, None] + span[:, None] * _TIME_NODES_AND_ENDS
    energies = resting(leave, kinetic_along(work, places))
    both = places[:, _BOTH]
    x = local(p.low[:, None], p.high[:, None], both)
    force = chebyshev_sum(p.values[..., FORCE].T[:, :, None], x)
    at_ends = Ends.of(energies, force - work.load.force(both))
    return time_over(span, span != 0.0, energies[:, 1:-1], mass, at_ends)


def _resting(turn: TurningPoint, last: jax.Array, energies: jax.Array) -> jax.Array:
    """The energies of pieces, the last of each 0 where the body turns there: not its rounding."""
    still = turn.found & (last == turn.place)
    return energies.at[:, -1].set(jnp.where(still, 0.0, energies[:, -1]))


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
    climbed = load.climb(ahead.begin, place - ahead.begin)
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
