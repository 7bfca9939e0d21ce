"""Adhesion that acts inside the contact with its full force."""

from __future__ import annotations

from math import pi
from typing import ClassVar

from .._jax import jax, jnp
from .law import Law, Powers, Real, TruncatedPower, quantity


class Dmt(Law):
    """Adhesive part of the DMT model, without a tail outside the contact.

    Parameters
    ----------
    radius
        Radius at the tip [m].
    work_of_adhesion
        Energy to part unit area [J/m^2].

    Notes
    -----
    Force -2 pi radius work while the gap is negative, nothing beyond: the publication's
    eqs. 4-9. To be added to :class:`Hertz`. With the surface force outside the contact
    it is :class:`Bradley` + :class:`Hertz`. Derjaguin, Muller and Toporov (1975).
    """

    radius: Real = quantity()
    work_of_adhesion: Real = quantity()

    counts: ClassVar[frozenset[str]] = frozenset({"adhesion"})
    radius_power: ClassVar[float] = 1.0

    def force(self, gap: jax.Array) -> jax.Array:
        return self.powers(jnp.zeros(()))[0][0](gap)

    def energy(self, gap: jax.Array) -> jax.Array:
        return self.powers(jnp.zeros(()))[1][0](gap)

    def powers(self, bond_gap: jax.Array) -> tuple[Powers, Powers]:
        pull = -2.0 * pi * self.radius * self.work_of_adhesion
        return (TruncatedPower(pull, 0.0, 0.0),), (TruncatedPower(pull, 1.0, 0.0),)
