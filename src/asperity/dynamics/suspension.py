"""A spring and a dashpot between a body and a base at rest: a cantilever, a switch, a tip."""

from __future__ import annotations

from typing import ClassVar

from .._jax import jax, jnp
from ..laws.law import Real, quantity
from .external_forces import Along, Drag, ExternalForce


class Spring(ExternalForce):
    """A linear spring.

    Parameters
    ----------
    stiffness
        Stiffness [N/m].
    rest_gap
        Separation at which it is relaxed [m].

    Notes
    -----
    Force towards the surface stiffness (separation - rest gap), potential
    stiffness (separation - rest gap)^2/2.
    """

    stiffness: Real = quantity()
    rest_gap: Real = quantity()

    name: ClassVar[str] = "spring"

    def force(self, place: jax.Array) -> jax.Array:
        force: jax.Array = self.stiffness * (place - self.rest_gap)
        return force

    def slope(self, place: jax.Array) -> jax.Array:
        slope: jax.Array = self.stiffness
        return slope

    def potential_gain(self, start: jax.Array, distance: jax.Array) -> jax.Array:
        gained: jax.Array = self.stiffness * distance * (start - self.rest_gap + 0.5 * distance)
        return gained


class Dashpot(Drag):
    """A linear dashpot, which damps at every separation.

    Parameters
    ----------
    damping
        Force over speed [N s/m].
    """

    damping: Real = quantity()

    name: ClassVar[str] = "damping"

    def resistance(self, along: Along) -> jax.Array:
        return jnp.full_like(along.central, 1.0) * self.damping
