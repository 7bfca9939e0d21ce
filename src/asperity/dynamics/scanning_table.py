"""Scanning curves, tabulated by the separation of their reversal.

What holds a body that turns on a major branch depends on where it turned and on nothing
else. The turning points of a motion lie close together, and everything along the ways that lead
back from them is a smooth function of their place: a polynomial, through a few ways that are
solved before the motion begins. All but lengths are divided by the number of asperities that touch
before they are fitted, since both fall off alike. Other reversals, on a way itself, are solved as
they come.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.polynomial import chebyshev

from .._jax import jax, jnp
from ..contact.contact import Contact, Held, Memory, YieldingContact
from ..numerics.compilation import kept
from ..numerics.polynomials import NODES, chebyshev_sum, from_points, local
from .curve_table import (
    CENTRAL,
    CONTACTING,
    FORCE,
    SIZE,
    Pieces,
    Table,
    all_rows,
    fit,
    outer_row,
    quantities,
)
from .record import Body
from .static_equilibrium import Reference

CLOSE = 1e-8
"""Error of the work along a curve, over the impact energy, up to which the polynomial serves."""

_FAR = 3  # ranges of the reversals in approach, at most
RANGES = 1 + _FAR
"""Ranges of reversals: one in retraction, the others in approach."""

_WIDE = 1.7  # rms heights that one of them spans, where that is enough
_NONE = 1e-120  # contacting asperities: their logarithm and its derivatives are finite
_FALL = 0.1  # of the coefficients over the place of the reversal, from one to the next, at least
_BEND = 2  # degree of the size of the mesh over that place


@kept
class Reversals(NamedTuple):
    """Scanning curves by ranges of reversals: the first in retraction, the others in approach.

    Attributes
    ----------
    low, high
        The ranges [m], shape (ranges,).
    length
        Chebyshev coefficients over each of the ends of the pieces, from the reversal in the
        direction of motion [m], shape (ranges, ways, pieces).
    contacting
        Likewise those of the logarithm of the number of asperities that touch at the places of
        each piece, shape (ranges, ways, pieces, places).
    rows
        Likewise those of all quantities there, over that number but for lengths, shape (ranges,
        ways, pieces, places, rows).
    error
        Estimated error of the work along the way over the impact energy, shape (ranges,).
    """

    low: jax.Array
    high: jax.Array
    length: jax.Array
    contacting: jax.Array
    rows: jax.Array
    error: jax.Array

    def _range(self, start: jax.Array, unloading: jax.Array) -> jax.Array:
        """Index of the range of a reversal at ``start`` [m]."""
        return jnp.where(unloading, 0, 1 + jnp.sum(self.high[1:-1] < start))

    def cover(self, start: jax.Array, unloading: jax.Array) -> jax.Array:
        """Whether they hold for a reversal at ``start`` [m]."""
        k = self._range(start, unloading)
        inside = jnp.logical_and(self.low[k] <= start, start <= self.high[k])
        return jnp.logical_and(inside, self.error[k] <= CLOSE)

    def pieces(self, start: jax.Array, unloading: jax.Array) -> Pieces:
        """The scanning curve from ``start`` [m]."""
        k = self._range(start, unloading)
        x = local(self.low[k], self.high[k], start)
        leave = start + jnp.where(unloading, 1.0, -1.0) * chebyshev_sum(self.length[k], x[None])
        enter = jnp.concatenate([start[None], leave[:-1]])
        contacting = jnp.exp(chebyshev_sum(self.contacting[k], x[None, None]))
        rows = chebyshev_sum(self.rows[k], x[None, None, None])
        rows = rows * _scales(contacting, rows.shape[-1])
        return _along(enter, leave, fit(rows), unloading)


def solve_reversals(contact: Contact, body: Body, table: Table, reference: Reference) -> Table:
    """A table with the scanning curves from where a body can turn on its major branches.

    It turns between its deepest point and the static equilibrium on the way in, and between that
    and its highest point, or where forces end, on the way out. What is not pressed does not return.
    """
    sampling = contact.reversals
    if sampling is None:
        return table
    frozen, body, rest = jax.lax.stop_gradient((table, body, reference.equilibrium))
    within = frozen.ends[0], frozen.ends[-1]
    deepest, energy = _first_fall(frozen, body)
    interaction_range = jax.lax.stop_gradient(contact.interaction_range)
    ends = _ends(
        rest, jnp.minimum(within[1], interaction_range), jax.lax.stop_gradient(sampling.scale)
    )
    low, high = jnp.append(deepest, ends[:-1]), jnp.append(rest, ends[1:])
    returns = jnp.asarray(bool(body.forces)) | (body.weight > 0.0)
    wanted = jax.lax.stop_gradient(sampling.alike(low, high)) & returns & (low < high)
    nodes, parted = chebyshev.chebpts1(sampling.number), np.arange(RANGES) > 0
    places = 0.5 * (low + high)[:, None] + 0.5 * (high - low)[:, None] * nodes
    rows = jnp.stack([_rows(frozen, k, places[n]) for n, k in enumerate(parted.astype(int))])
    held = Held(
        outer=jnp.ones((RANGES, sampling.number), bool),
        unloading=jnp.broadcast_to(parted[:, None], (RANGES, sampling.number)),
        size=rows[..., SIZE] @ _to_degree(_BEND, nodes).T,
        field=rows[..., quantities(contact).field],
    )
    jobs = places, held, jnp.broadcast_to(wanted[:, None], (RANGES, sampling.number))
    jobs = jax.tree_util.tree_map(lambda leaf: leaf.reshape(-1, *leaf.shape[2:]), jobs)
    solved = jax.lax.map(lambda job: sampling.curve(job[0], job[1], job[2], within), jobs)
    rows = jax.vmap(all_rows)(solved.states)
    contacting = jnp.where(rows[..., CONTACTING] > _NONE, rows[..., CONTACTING], _NONE)
    rows = rows / _scales(contacting, rows.shape[-1])
    length = jnp.abs(solved.leave - jobs[0][:, None])
    each = length, jnp.log(contacting), rows
    length, numbers, rows = (_over_places(x, nodes) for x in each)
    most = jnp.max(contacting.reshape(RANGES, -1), axis=1)
    error = most * _error(length, numbers, rows) / jnp.where(energy > 0.0, energy, 1.0)
    error = jnp.where(wanted, error, jnp.inf)
    return table._replace(reversals=Reversals(low, high, length, numbers, rows, error))


def _ends(low: jax.Array, high: jax.Array, rms: jax.Array) -> jax.Array:
    """Ends of as many even ranges as are needed, the others empty at the upper end."""
    width = jnp.maximum((high - low) / _FAR, jnp.minimum(_WIDE * rms, high - low))
    count = jnp.ceil((high - low) / jnp.where(width > 0.0, width, 1.0) - 1e-9)
    width = (high - low) / jnp.maximum(count, 1.0)
    number = np.arange(1.0 + _FAR)
    return jnp.where((number > 0.0) & (number >= count), high, low + width * number)


def _scales(contacting: jax.Array, count: int) -> jax.Array:
    """What so many quantities are divided by: all but lengths fall off as the number does."""
    return jnp.where(np.isin(np.arange(count), (CENTRAL, SIZE)), 1.0, contacting[..., None])


def _rows(table: Table, direction: int, places: jax.Array) -> jax.Array:
    """All quantities at places of the branch on which a body comes there."""
    branch = direction * (table.values.shape[0] - 1)
    return jax.vmap(lambda place: outer_row(table, branch, place))(places)


def _first_fall(table: Table, body: Body) -> tuple[jax.Array, jax.Array]:
    """A place just below that of the first turn [m], and the largest energy before it [J]."""
    places = table.looks.ravel()
    work = table.works.looks[0].ravel()
    panel = table.panel_at(body.release)
    x = local(table.ends[panel], table.ends[panel + 1], body.release)
    gained = work - chebyshev_sum(table.works.integral[0, panel, :, 0], x)
    kinetic = body.kinetic + gained - body.load.potential_gain(body.release, places - body.release)
    below = places < body.release
    deepest = jnp.max(jnp.where(below & (kinetic < 0.0), places, table.ends[0]))
    passed = below & (places > deepest)
    return deepest, jnp.max(jnp.where(passed, kinetic, body.kinetic))


def _to_degree(degree: int, nodes: np.ndarray) -> np.ndarray:
    """From values at Chebyshev points to those of the polynomial of a degree that fits them."""
    found: np.ndarray = chebyshev.chebvander(nodes, degree) @ from_points(len(nodes))[: degree + 1]
    return found


def _over_places(values: jax.Array, nodes: np.ndarray) -> jax.Array:
    """Values at the places of all ranges as Chebyshev coefficients over these."""
    each = values.reshape(-1, len(nodes), *values.shape[1:])
    return jnp.einsum("kn,bn...->bk...", from_points(len(nodes)), each)


def _error(length: jax.Array, contacting: jax.Array, rows: jax.Array) -> jax.Array:
    """Estimated error of the work [J] over the contacting asperities, shape (ranges,)."""
    force = jnp.abs(rows[..., FORCE])
    last = force[:, 2:] + force[:, :1] * jnp.abs(contacting[:, 2:])
    off = jnp.maximum(last[:, -1], _FALL * last[:, -2])
    span = jnp.diff(length[:, 0], axis=1, prepend=0.0)
    return jnp.sum(jnp.max(off, axis=2) * span, axis=1)


def inner_pieces(
    contact: Contact, table: Table, memory: Memory, start: jax.Array, unloading: jax.Array
) -> Pieces:
    """The pieces between a reversal at ``start`` and the major branch, some for each law."""
    sampling = contact.reversals
    if not table.reversals or sampling is None:
        return _solved(contact, table, memory, start, unloading)
    known = sampling.on_branch(memory) & table.reversals.cover(start, unloading)
    return jax.lax.cond(
        known,
        lambda: table.reversals.pieces(start, unloading),
        lambda: _solved(contact, table, memory, start, unloading),
    )


def _solved(
    contact: Contact, table: Table, memory: Memory, start: jax.Array, unloading: jax.Array
) -> Pieces:
    if table.left and isinstance(contact, YieldingContact):
        contact = contact.after(table.left)
    contact = contact.reading(table.means)
    curve = contact.scanning_curve(memory, start, unloading, (table.ends[0], table.ends[-1]))
    if curve is None:
        none = jnp.zeros(0)
        return Pieces(none, none, none, none, jnp.zeros((0, *table.values.shape[2:])))
    return _along(curve.enter, curve.leave, fit(all_rows(curve.states)), unloading)


def _along(enter: jax.Array, leave: jax.Array, values: jax.Array, unloading: jax.Array) -> Pieces:
    """Pieces of polynomials in the direction of motion."""
    odd = (-1.0) ** np.arange(NODES)[:, None]
    values = values * jnp.where(unloading, 1.0, odd)  # places descend on the way in
    return Pieces(jnp.minimum(enter, leave), jnp.maximum(enter, leave), enter, leave, values)
