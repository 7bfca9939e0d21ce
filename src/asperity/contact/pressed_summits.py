"""Summits under one body: elastic, or pressed flat where their tips yield."""

from __future__ import annotations

from typing import NamedTuple

from .._jax import jax, jnp
from ..interface.residual_profile import flatness
from ..laws.law import Real
from ..laws.plastic import PlasticContact
from .asperity_table import AGAIN, Asperities


class PressedSummits(NamedTuple):
    """Summits, and how deep each was pressed before.

    A tip that has yielded is flatter, and stands back by its residual overlap. As in
    :mod:`~asperity.interface.plastic_interface`, one that was pressed pulls by the laws beside
    contact as a tip of the larger radius does, and as if it were whole until it turns.

    Attributes
    ----------
    summits
        Their energies. The laws beside contact are proportional to the tip radius where it yields.
    contact
        The contact of a tip that yields; None of elastic ones.
    deepest, residual
        Deepest overlap of each [m], 0 of a tip that never touched, and the overlap at which it
        parts. 0 of elastic ones.
    flatness
        Tip radius of each over that before [-].
    """

    summits: Asperities
    contact: PlasticContact | None = None
    deepest: Real = 0.0
    residual: Real = 0.0
    flatness: Real = 1.0

    @classmethod
    def of(
        cls, summits: Asperities, contact: PlasticContact | None, deepest: jax.Array
    ) -> PressedSummits:
        """Summits that were pressed to some overlaps [m], if their tips yield."""
        if contact is None:
            return cls(summits)
        residual = contact.residual(deepest)
        return cls(summits, contact, deepest, residual, flatness(deepest, deepest - residual))

    def approach(self, gap: jax.Array) -> jax.Array:
        """Work [J] of each from far away to a gap [m]; a pressed one no deeper than before."""
        first = self.summits.work(gap)
        if self.contact is None:
            return first
        return jnp.where(self.deepest > 0.0, self.bonded(gap, AGAIN), first)

    def turned(self, gap: jax.Array) -> PressedSummits:
        """The same once a body has turned at a gap [m] of each: none is pressed deeper again."""
        deepest = jnp.where(self.deepest > 0.0, self.deepest, jnp.maximum(-gap, 0.0))
        return self.of(self.summits, self.contact, deepest)

    def bonded(self, gap: jax.Array, branch: jax.Array | int) -> jax.Array:
        """Work [J] of each to a gap [m] on a branch, less what its contact has lost before."""
        if self.contact is None:
            return self.summits.work(gap, branch)
        beside = self.flatness * self.summits.work(gap + self.residual, branch)
        return beside + self.contact.recoverable(-gap, self.deepest)
