"""What a body loses where its contact jumps from one equilibrium to another, at fixed separation.

The energy that drops, less what bonds lose that form or break meanwhile: waves in the bulk carry it
away.
"""

from __future__ import annotations

from typing import NamedTuple

from .._jax import jax, jnp
from ..contact.contact import Contact
from ..numerics.compilation import kept
from ..numerics.polynomials import chebyshev_sum, local
from .curve_table import CENTRAL, STORED, Pieces, Quantities, Table, join, outer_row

INSTABILITY = "instability"
"""Mechanism of that loss."""

_JUMP = 1e-4  # of the contact's own length: central separations that differ by less are one


@kept
class Jumps(NamedTuple):
    """Jumps on the way of a phase, and beyond its end.

    Attributes
    ----------
    place
        Separations [m], shape (places,).
    energy
        Energy lost at each [J]: 0 where nothing jumps.
    """

    place: jax.Array
    energy: jax.Array

    @classmethod
    def none(cls) -> Jumps:
        """Of a contact that does not jump."""
        return cls(jnp.zeros(0), jnp.zeros(0))

    def until(self, place: jax.Array, unloading: jax.Array) -> jax.Array:
        """Energy lost until a separation is reached [J]."""
        ahead = jnp.where(unloading, 1.0, -1.0)
        passed = ahead * (place[..., None] - self.place) > 0.0
        return jnp.sum(jnp.where(passed, self.energy, 0.0), axis=-1)

    def lost(self, place: jax.Array, unloading: jax.Array) -> jax.Array:
        """The same as an array with one entry; empty for a contact that does not jump."""
        return self.until(place, unloading)[None] if self.place.shape[0] else jnp.zeros(0)


def over_folds(
    contact: Contact,
    table: Table,
    branch: jax.Array,
    inner: Pieces,
    reversal: tuple[jax.Array, jax.Array],
    unloading: jax.Array,
) -> tuple[jax.Array, Jumps]:
    """Index of the side of its branch to which a body comes, and its jumps on the way.

    Parameters
    ----------
    contact, table
        The contact and its curves.
    branch
        Index of the branch, on its first side.
    inner
        The scanning curve.
    reversal
        Rigid and central separation where it begins [m].
    unloading
        Whether the body moves outwards.
    """
    if contact.sides == 1:
        return branch, Jumps.none()
    place, central = reversal
    if inner.leave.shape[0]:
        place = inner.leave[-1]
        x = local(inner.low[-1], inner.high[-1], place)
        central = chebyshev_sum(inner.values[-1, :, CENTRAL], x)
    branch = _side(table, branch, place, central, unloading, contact.scale)
    pieces = join(table, branch, inner, reversal[0], unloading)
    return branch, _jumps_along(contact, table, pieces, inner.low.shape[0])


def _side(
    table: Table,
    branch: jax.Array,
    place: jax.Array,
    central: jax.Array,
    unloading: jax.Array,
    scale: jax.Array,
) -> jax.Array:
    """The side of a branch on which a body is, by its central separation [m].

    Where both are one, that which is followed in the direction of motion.
    """
    half = table.values.shape[0] // 2
    outer, inner = (outer_row(table, k, place)[CENTRAL] for k in (branch, branch + half))
    one = jnp.abs(outer - inner) <= _JUMP * scale
    nearer = jnp.abs(central - inner) < jnp.abs(central - outer)
    return branch + half * jnp.where(one, unloading, nearer)


def _jumps_along(contact: Contact, table: Table, pieces: Pieces, curve: int) -> Jumps:
    """The jumps along the pieces of a phase, on the branch alone.

    ``curve`` pieces before it are those of the scanning curve: where these do not meet, or where
    energy would rise, the energy balance shows it.
    """
    bonds, count = Quantities(len(contact.mechanisms), 0).bonds, pieces.low.shape[0]
    filled = jnp.where(pieces.enter != pieces.leave, jnp.arange(count), count)
    following = jax.lax.cummin(filled, reverse=True)[1:]
    here, there = jnp.arange(count - 1), jnp.minimum(following, count - 1)
    place = pieces.leave[:-1]

    def row(k: jax.Array) -> jax.Array:
        x = local(pieces.low[k], pieces.high[k], place)
        return chebyshev_sum(jnp.moveaxis(pieces.values[k], 1, 0), x[:, None])

    before, after = row(here), row(there)
    by_bonds = table.lost_by_bonds(after[:, bonds] - before[:, bonds])
    drop = before[:, STORED] - after[:, STORED] - jnp.sum(by_bonds, axis=1)
    apart = jnp.abs(after[:, CENTRAL] - before[:, CENTRAL]) > _JUMP * contact.scale
    on_branch = (here >= curve) & (filled[:-1] < count) & (following < count)
    return Jumps(place, jnp.where(apart & on_branch & (drop > 0.0), drop, 0.0))
