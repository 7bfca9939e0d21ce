"""Surface force of rigid bodies across a gap."""

from __future__ import annotations

from math import pi
from typing import ClassVar

from .._jax import jax, jnp
from .law import Law, Real, quantity

_FAR = 2.0**33


class Bradley(Law):
    """Adhesive part of the rigid-body model: the 3-9 potential between two planes.

    Parameters
    ----------
    radius
        Radius at the tip [m].
    work_of_adhesion
        Energy to part unit area w [J/m^2].
    spacing
        Interatomic spacing eps of the potential [m].

    Notes
    -----
    By Derjaguin's construction the force at a gap g is -2 pi radius W(g) with
    W/w = (4/3)(eps/(g+eps))^2 - (1/3)(eps/(g+eps))^8, constant at -2 pi radius w for
    g < 0. To be added to :class:`Hertz`, with which it is the DMT model with its tail.
    Bradley (1932); the publication's eq. 1.
    """

    radius: Real = quantity()
    work_of_adhesion: Real = quantity()
    spacing: Real = quantity()

    counts: ClassVar[frozenset[str]] = frozenset({"adhesion"})
    radius_power: ClassVar[float] = 1.0

    def force(self, gap: jax.Array) -> jax.Array:
        y = self.spacing / (jnp.maximum(gap, 0.0) + self.spacing)
        return self._pull * (4.0 * y**2 - y**8) / 3.0

    def energy(self, gap: jax.Array) -> jax.Array:
        y = self.spacing / (jnp.maximum(gap, 0.0) + self.spacing)
        outside = self._pull * self.spacing * (4.0 * y - y**7 / 7.0) / 3.0
        return outside + self._pull * jnp.maximum(-gap, 0.0)

    def energy_beyond(self, gap: jax.Array) -> jax.Array:
        """Up to a gap of 2^33 spacings, far outside everything, since it grows with log(gap)."""
        y = self.spacing / (jnp.maximum(gap, 0.0) + self.spacing)
        inside = jnp.maximum(-gap, 0.0)
        outside = self._pull * self.spacing**2 * (4.0 * jnp.log(_FAR * y) - y**6 / 42.0) / 3.0
        at_touch = self._pull * self.spacing * (4.0 - 1.0 / 7.0) / 3.0
        return outside + inside * (at_touch + 0.5 * self._pull * inside)

    @property
    def _pull(self) -> jax.Array | float:
        return -2.0 * pi * self.radius * self.work_of_adhesion

    @property
    def interaction_range(self) -> jax.Array:
        return 1.2e3 * self.spacing

    @property
    def length(self) -> jax.Array | float:
        return self.spacing
