"""Curves of a contact as Chebyshev polynomials on panels of the separation.

A contact is solved once on the panels of its outermost branches, and again on the few
pieces between a reversal and the outermost branch. In between everything is a polynomial,
so that no equation is solved inside the motion and work is integrated exactly.
"""

from __future__ import annotations

from itertools import product
from typing import NamedTuple

import numpy as np
from numpy.polynomial import chebyshev

from .._jax import jax, jnp
from ..contact.base import Contact, Memory, State

NODES = 12
_ANTIDERIVATIVE = np.array([chebyshev.chebint(row) for row in np.eye(NODES)])


class Quantities(NamedTuple):
    """How the numbers of a :class:`State` lie in one row.

    Force, its attractive parts, stored, central, touching, size, then the bonds, then the
    parts.
    """

    laws: int
    parts: int

    @property
    def bonds(self) -> slice:
        """Columns of the bonds."""
        return slice(6, 6 + self.laws)

    @property
    def components(self) -> slice:
        """Columns of the forces by mechanism."""
        return slice(6 + self.laws, 6 + self.laws + self.parts)


FORCE, PULL, STORED, CENTRAL, TOUCHING, SIZE = range(6)
DRIVE = slice(FORCE, PULL + 1)
"""The columns that a motion integrates."""


class Table(NamedTuple):
    """Outermost branches of a contact.

    Attributes
    ----------
    ends
        Ends of the panels [m], ascending, shape (panels + 1,).
    values
        Rows of quantities as Chebyshev coefficients, shape (branches, panels, NODES, rows).
        The first branch has no bonds kept, the last has all.
    error
        Work of the last Chebyshev coefficients of the force on a panel, relative to the work
        from outside to there: an estimate of the interpolation error.
    residual
        Largest error estimate of the contact itself.
    """

    ends: jax.Array
    values: jax.Array
    error: jax.Array
    residual: jax.Array


class Pieces(NamedTuple):
    """Polynomials along one monotone phase, in the order in which they are passed.

    Attributes
    ----------
    low, high
        Interval [m] on which each polynomial is defined, shape (pieces,).
    enter, leave
        Separations [m] between which it is used, in the direction of motion.
    values
        Chebyshev coefficients of each row, shape (pieces, NODES, rows).
    """

    low: jax.Array
    high: jax.Array
    enter: jax.Array
    leave: jax.Array
    values: jax.Array


def rows_of(state: State) -> jax.Array:
    """The numbers of a state in one row."""
    pull = state.force - state.elastic
    head = jnp.stack([state.force, pull, state.stored, state.central, state.touching, state.size])
    return jnp.concatenate([head, state.bonds, state.parts])


def quantities(contact: Contact) -> Quantities:
    """Layout of the rows of a contact."""
    return Quantities(len(contact.mechanisms), len(contact.components))


def branches(contact: Contact) -> tuple[tuple[bool, ...], ...]:
    """The outermost branches: all combinations on a smooth body, else none or all bonds."""
    laws = len(contact.mechanisms)
    if contact.discrete:
        return tuple(tuple(reversed(bits)) for bits in product((False, True), repeat=laws))
    return ((False,) * laws, (True,) * laws) if laws else ((),)


def tabulate(contact: Contact, low: jax.Array, high: jax.Array) -> Table:
    """Solve a contact on its outermost branches between two separations [m]."""
    ends = jax.lax.stop_gradient(contact.panels(low, high))
    memories = [contact.extreme(branch) for branch in branches(contact)]
    stacked = jax.tree_util.tree_map(lambda *leaves: jnp.stack(leaves), *memories)
    if jax.tree_util.tree_leaves(stacked):
        values, errors = jax.lax.map(
            lambda memory: _fit(contact, memory, ends[:-1], ends[1:]), stacked
        )
    else:
        values, errors = (x[None] for x in _fit(contact, memories[0], ends[:-1], ends[1:]))
    force = values[..., FORCE]
    width = jnp.diff(ends)
    tail = jnp.max(jnp.abs(force[..., -2:]), axis=-1) * width
    done = jnp.max(jnp.abs(force), axis=-1) * width
    # Against the work from outside down to each panel: what a body that turns there has done.
    work = jnp.cumsum(done[:, ::-1], axis=1)[:, ::-1]
    matters = work > 1e-9 * jnp.max(work)
    error = jnp.where(matters, tail / jnp.where(work > 0.0, work, 1.0), 0.0)
    return Table(ends, values, jnp.max(error), jnp.max(errors))


def blank_table(contact: Contact) -> Table:
    """A table of zeros, of the shapes that :func:`tabulate` gives."""
    ends = jax.eval_shape(contact.panels, jnp.zeros(()), jnp.ones(())).shape[0]
    layout = quantities(contact)
    shape = (len(branches(contact)), ends - 1, NODES, layout.components.stop)
    zero = jnp.zeros(())
    return Table(jnp.linspace(0.0, 1.0, ends), jnp.zeros(shape), zero, zero)


def _fit(
    contact: Contact,
    memory: Memory,
    low: jax.Array,
    high: jax.Array,
    nodes: int = NODES,
    near: bool = False,
) -> tuple[jax.Array, jax.Array]:
    """Coefficients [piece, NODES, rows] of a contact reached from ``memory``."""
    x = chebyshev.chebpts1(nodes)
    to_coefficients = np.zeros((NODES, nodes))
    to_coefficients[:nodes] = np.linalg.inv(chebyshev.chebvander(x, nodes - 1))
    middle, half = 0.5 * (low + high), 0.5 * (high - low)
    places = (middle[:, None] + half[:, None] * x).ravel()
    states = contact.states_near(places, memory) if near else contact.states(places, memory)
    rows = jax.vmap(rows_of)(states).reshape(low.shape[0], nodes, -1)
    return jnp.einsum("kn,pnq->pkq", jnp.asarray(to_coefficients), rows), states.error


def inner_pieces(
    contact: Contact, table: Table, memory: Memory, start: jax.Array, parting: jax.Array
) -> Pieces:
    """The pieces between a reversal at ``start`` and the outermost branch: one a law."""
    ahead = jnp.where(parting, 1.0, -1.0)
    marks = jnp.clip(contact.switches(memory, start, parting), table.ends[0], table.ends[-1])
    if not marks.shape[0]:
        return Pieces(marks, marks, marks, marks, jnp.zeros((0, *table.values.shape[2:])))
    marks = start + ahead * jnp.sort(jnp.maximum(ahead * (marks - start), 0.0))
    first = jnp.concatenate([start[None], marks[:-1]])
    share = np.linspace(0.0, 1.0, contact.reversal_panels + 1)
    steps = first[:, None] + (marks - first)[:, None] * share
    first, marks = steps[:, :-1].ravel(), steps[:, 1:].ravel()
    low, high = jnp.minimum(first, marks), jnp.maximum(first, marks)
    values, _ = _fit(contact, memory, low, high, contact.reversal_nodes, near=True)
    return Pieces(low, high, first, marks, values)


def branch_of(contact: Contact, memory: Memory, parting: jax.Array) -> jax.Array:
    """Index of the outermost branch that a body with ``memory`` reaches."""
    if contact.discrete:
        weights = 2 ** np.arange(len(contact.mechanisms))
        return jnp.sum(jnp.where(contact.bonded(memory), weights, 0))
    return jnp.where(parting, len(branches(contact)) - 1, 0)


def join(
    table: Table,
    branch: jax.Array,
    inner: Pieces,
    start: jax.Array,
    parting: jax.Array,
    columns: slice = slice(None),
) -> Pieces:
    """All polynomials ahead of a body that leaves ``start``: the inner pieces, then a branch.

    Of the ``columns`` alone: a motion needs the force, not the rest of each row.
    """
    begin = inner.leave[-1] if inner.leave.shape[0] else start
    inner = inner._replace(values=inner.values[..., columns])
    low, high, outer = table.ends[:-1], table.ends[1:], table.values[branch][..., columns]
    up = (low, high, jnp.maximum(low, begin), jnp.maximum(high, begin), outer)
    down = (low, high, jnp.minimum(high, begin), jnp.minimum(low, begin), outer)
    rest = [jnp.where(parting, a, b[::-1]) for a, b in zip(up, down, strict=True)]
    return Pieces(*(jnp.concatenate(pair) for pair in zip(inner, rest, strict=True)))


def row_at(
    table: Table,
    branch: jax.Array,
    inner: Pieces,
    piece: jax.Array,
    place: jax.Array,
    parting: jax.Array,
) -> jax.Array:
    """All quantities at a place of a piece as :func:`join` counts them."""
    count, ahead = table.ends.shape[0] - 1, inner.low.shape[0]
    step = jnp.clip(piece - ahead, 0, count - 1)
    panel = jnp.where(parting, step, count - 1 - step)
    x = local(table.ends[panel], table.ends[panel + 1], place)
    row = chebyshev_sum(table.values[branch, panel], x)
    if not ahead:
        return row
    at = jnp.minimum(piece, ahead - 1)
    near = chebyshev_sum(inner.values[at], local(inner.low[at], inner.high[at], place))
    return jnp.where(piece < ahead, near, row)


def outer_row(table: Table, branch: int, place: jax.Array) -> jax.Array:
    """All quantities of an outermost branch at one separation [m]."""
    count = table.ends.shape[0] - 2
    panel = jnp.clip(jnp.searchsorted(table.ends, place, side="right") - 1, 0, count)
    x = local(table.ends[panel], table.ends[panel + 1], place)
    return chebyshev_sum(table.values[branch, panel], x)


def local(low: jax.Array, high: jax.Array, place: jax.Array) -> jax.Array:
    """Coordinate in [-1, 1] of a place in an interval; 0 where the interval is empty."""
    width = high - low
    safe = jnp.where(width > 0.0, width, 1.0)
    return jnp.where(width > 0.0, (2.0 * place - low - high) / safe, 0.0)


def chebyshev_sum(coefficients: jax.Array, x: jax.Array) -> jax.Array:
    """Sum of Chebyshev polynomials; the coefficients' first axis is the degree."""
    upper = jnp.zeros_like(coefficients[0] * x)
    lower = upper
    for k in range(coefficients.shape[0] - 1, 0, -1):
        upper, lower = coefficients[k] + 2.0 * x * upper - lower, upper
    return coefficients[0] + x * upper - lower


def antiderivative(coefficients: jax.Array) -> jax.Array:
    """Chebyshev coefficients of the integral over x; first axis the degree."""
    return jnp.tensordot(jnp.asarray(_ANTIDERIVATIVE).T, coefficients, axes=1)
