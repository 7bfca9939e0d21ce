"""Curves of a contact as Chebyshev polynomials on panels of the separation.

A contact is solved once on the panels of its major branches, and again on the few
pieces between a reversal and the major branch. In between everything is a polynomial,
so that no equation is solved inside the motion and work is integrated exactly.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
from numpy.polynomial import chebyshev

from .._jax import jax, jnp
from ..contact.contact import Contact, Memory, State, YieldingContact
from ..laws.law import Real
from ..numerics.compilation import kept
from ..numerics.polynomials import ANTIDERIVATIVE, NODES, chebyshev_sum, from_points, local

ENERGY_SAMPLES = 24
"""Points of a panel at which the kinetic energy is sampled, its ends among them."""

NO_CUTS = np.zeros(0)
"""Panels as the contact has them."""

_LEAST = 1e-6  # of the largest work: errors are not asked to be small against less
_ENERGY_SAMPLES = np.linspace(-1.0, 1.0, ENERGY_SAMPLES)
_GAUSS, _WEIGHT = np.polynomial.legendre.leggauss(24)
_Y = 0.5 * (_GAUSS + 1.0)
TIME_NODES = np.sin(0.5 * np.pi * _Y) ** 2
"""Nodes of a quadrature over a piece, as fractions of it: square-root ends become smooth."""
RATE = 0.25 * np.pi * np.sin(np.pi * _Y) * _WEIGHT
"""Its weights, as fractions of the piece."""


class Quantities(NamedTuple):
    """How the numbers of a :class:`State` lie in one row.

    Force, its attractive parts, stored, central, contacting, size, then the bonds, then the
    parts; after these, in a table alone, the field.
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

    @property
    def field(self) -> slice:
        """Columns of what the memory is renewed by."""
        return slice(6 + self.laws + self.parts, None)


FORCE, ATTRACTION, STORED, CENTRAL, CONTACTING, SIZE = range(6)
DRIVE = slice(FORCE, ATTRACTION + 1)
"""The columns that a motion integrates."""


@kept
class Works(NamedTuple):
    """Work of the force, and of its attractive part, from the top of a table down.

    Attributes
    ----------
    integral
        Chebyshev coefficients on each panel, shape (branches, panels, NODES + 1, 2): the
        work from the top to a place is their sum there.
    looks
        Work of the force [J] at ENERGY_SAMPLES separations of each panel, shape (branches,
        panels, ENERGY_SAMPLES).
    nodes
        Likewise at the TIME_NODES of each panel.
    """

    integral: jax.Array
    looks: jax.Array
    nodes: jax.Array


@kept
class Table(NamedTuple):
    """Major branches of a contact.

    Attributes
    ----------
    ends
        Ends of the panels [m], ascending, shape (panels + 1,).
    values
        Rows of quantities as Chebyshev coefficients, shape (branches, panels, NODES, rows).
        The first branch has no bonds kept, the last has all.
    works
        Their integrals.
    errors
        Work of the last Chebyshev coefficients of the force on each panel, relative to the work
        from outside to there: an estimate of the interpolation error, shape (panels,).
    residual
        Largest error estimate of the contact itself.
    losses
        Energy [J] lost when one bond forms and when it breaks, shape (2, laws).
    means
        What its scanning curves are solved with (:meth:`Contact.means`).
    left
        What the first impact left of a contact that yields; empty without one.
    reversals
        The scanning curves; empty where each is solved as it comes.
    """

    ends: jax.Array
    values: jax.Array
    works: Works
    errors: jax.Array
    residual: jax.Array
    losses: jax.Array
    means: Any = ()
    left: Any = ()
    reversals: Any = ()

    def lost_by_bonds(self, change: jax.Array) -> jax.Array:
        """Energy [J] lost as the numbers of bonds change, per law, shape (..., laws)."""
        formed, broken = self.losses
        return jnp.maximum(change, 0.0) * formed + jnp.maximum(-change, 0.0) * broken

    @property
    def looks(self) -> jax.Array:
        """The places [m] of :attr:`Works.looks`, shape (panels, ENERGY_SAMPLES)."""
        low, high = self.ends[:-1, None], self.ends[1:, None]
        return 0.5 * (low + high) + 0.5 * (high - low) * _ENERGY_SAMPLES

    @property
    def nodes(self) -> jax.Array:
        """The places [m] of :attr:`Works.nodes`."""
        low, high = self.ends[:-1, None], self.ends[1:, None]
        return low + (high - low) * TIME_NODES

    def panel_at(self, place: jax.Array) -> jax.Array:
        """Index of the panel of a place [m]; of two that meet there, the lower one."""
        return jnp.sum(self.ends[1:-1] < place)


@kept
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
    """The numbers of a state in one row, its field last."""
    attraction = state.force - state.elastic
    head = jnp.stack(
        [state.force, attraction, state.stored, state.central, state.contacting, state.size]
    )
    return jnp.concatenate([head, state.bonds, state.parts, state.field])


def quantities(contact: Contact) -> Quantities:
    """Layout of the rows of a contact."""
    return Quantities(len(contact.mechanisms), len(contact.components))


def tabulate(contact: Contact, low: jax.Array, high: jax.Array, cuts: Real = NO_CUTS) -> Table:
    """Solve a contact on its major branches between two separations [m].

    Its panels end at the ``cuts`` [m] too, which lie where forces are not negligible.
    """
    return _tabulated(contact, (low, high), cuts, lambda ends, places, values: values)


def tabulate_again(
    contact: YieldingContact, before: Table, memory: Memory, turn: jax.Array, cuts: Real = NO_CUTS
) -> Table:
    """Solve a contact that yields as its first impact leaves it.

    Parameters
    ----------
    contact
        The contact before that impact.
    before
        Its table, of its first approach alone. That branch comes first in the new table too,
        and stands for all others below the deepest point, which nothing reaches again.
    memory, turn
        Memory and separation [m] at the deepest point.
    """
    left = contact.left_by(memory, turn)

    def joined(ends: jax.Array, places: jax.Array, values: jax.Array) -> jax.Array:
        first = _read_again(before, places)
        deeper = (ends[1:] <= turn)[:, None, None]
        return jnp.concatenate([first[None], jnp.where(deeper, first, values)])

    span = before.ends[0], before.ends[-1]
    table = _tabulated(contact.after(left), span, cuts, joined)
    return table._replace(left=left)


def _tabulated(
    contact: Contact,
    span: tuple[jax.Array, jax.Array],
    cuts: Real,
    joined: Callable[[jax.Array, jax.Array, jax.Array], jax.Array],
) -> Table:
    ends = jax.lax.stop_gradient(contact.panels(*span))
    ends = jnp.sort(jnp.concatenate([ends, jnp.clip(cuts, ends[0], ends[-1])]))
    points = chebyshev.chebpts1(NODES)
    places = 0.5 * (ends[:-1] + ends[1:])[:, None] + 0.5 * jnp.diff(ends)[:, None] * points
    states = contact.curves(ends, places)
    values = jax.vmap(lambda branch: fit(all_rows(branch)))(states)
    values = joined(ends, places, values)
    force = values[..., FORCE]
    width = jnp.diff(ends)
    tail = jnp.max(jnp.abs(force[..., -2:]), axis=-1) * width
    done = jnp.max(jnp.abs(force), axis=-1) * width
    # Against the work from outside down to each panel: what a body that turns there has done.
    work = jnp.cumsum(done[:, ::-1], axis=1)[:, ::-1]
    work = work + _LEAST * jnp.max(work)
    error = jnp.where(work == 0.0, 0.0, tail / jnp.where(work == 0.0, 1.0, work))  # NaN of NaN
    losses = jnp.stack(contact.losses())
    errors = jnp.max(error, axis=0), jnp.max(states.error)
    return Table(ends, values, _works(ends, values), *errors, losses, contact.means(*span))


def _read_again(table: Table, places: jax.Array) -> jax.Array:
    """Coefficients of the first branch of a table on panels with these nodes, within its own."""
    panel = jax.vmap(table.panel_at)(jnp.mean(places, axis=1))
    x = jnp.clip(local(table.ends[panel, None], table.ends[panel + 1, None], places), -1.0, 1.0)
    coefficients = jnp.moveaxis(table.values[0, panel], 1, 0)
    rows = chebyshev_sum(coefficients[:, :, None, :], x[..., None])
    return fit(rows)


def _works(ends: jax.Array, values: jax.Array) -> Works:
    """Integrate the branches from the top down, once for all phases."""
    half = 0.5 * jnp.diff(ends)
    integral = jnp.einsum("kn,bpnc,p->bpkc", ANTIDERIVATIVE, values[..., DRIVE], half)
    signs = (-1.0) ** np.arange(NODES + 1)
    whole = jnp.einsum("bpkc,k->bpc", integral, 1.0 - signs)
    above = jnp.cumsum(whole[:, ::-1], axis=1)[:, ::-1]  # from each panel's low end to the top
    at_low = jnp.einsum("bpkc,k->bpc", integral, signs)
    integral = integral.at[..., 0, :].add(-above - at_low)
    look, node = (chebyshev.chebvander(x, NODES) for x in (_ENERGY_SAMPLES, 2.0 * TIME_NODES - 1.0))
    force = integral[..., 0]
    return Works(integral, force @ look.T, force @ node.T)


def all_rows(states: State) -> jax.Array:
    """The numbers of states at places of pieces, shape (pieces, places, rows)."""
    return jax.vmap(jax.vmap(rows_of))(states)


def fit(rows: jax.Array) -> jax.Array:
    """Coefficients [piece, NODES, rows] of rows at the Chebyshev points of pieces."""
    return jnp.einsum("kn,pnq->pkq", _to_coefficients(rows.shape[1]), rows)


def _to_coefficients(nodes: int) -> np.ndarray:
    """From values at so many Chebyshev points to NODES coefficients."""
    out = np.zeros((NODES, nodes))
    out[:nodes] = from_points(nodes)
    return out


def join(
    table: Table, branch: jax.Array, inner: Pieces, start: jax.Array, unloading: jax.Array
) -> Pieces:
    """All polynomials ahead of a body that leaves ``start``: the inner pieces, then a branch."""
    begin = inner.leave[-1] if inner.leave.shape[0] else start
    low, high = table.ends[:-1], table.ends[1:]
    outer = table.values[branch][..., : inner.values.shape[-1]]
    up = (low, high, jnp.maximum(low, begin), jnp.maximum(high, begin), outer)
    down = (low, high, jnp.minimum(high, begin), jnp.minimum(low, begin), outer)
    rest = [jnp.where(unloading, a, b[::-1]) for a, b in zip(up, down, strict=True)]
    return Pieces(*(jnp.concatenate(pair) for pair in zip(inner, rest, strict=True)))


def outer_row(table: Table, branch: jax.Array | int, place: jax.Array) -> jax.Array:
    """All quantities of a major branch at one separation [m]."""
    panel = table.panel_at(place)
    x = local(table.ends[panel], table.ends[panel + 1], place)
    return chebyshev_sum(table.values[branch, panel], x)


def read_row(table: Table, branch: int, place: float) -> np.ndarray:
    """The same for numbers, without compiling anything."""
    ends = np.asarray(table.ends)
    panel = int(np.sum(ends[1:-1] < place))
    x = local(ends[panel], ends[panel + 1], place)
    row: np.ndarray = chebyshev.chebval(x, np.asarray(table.values)[branch, panel])
    return row
