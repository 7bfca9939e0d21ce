"""Liquid bridge that neither grows nor shrinks while it is stretched."""

from __future__ import annotations

from math import pi, radians
from typing import ClassVar

import equinox as eqx

from .._jax import jax, jnp
from . import bridge
from .base import Law, Real, quantity

EDGE_HOLDS = 0.1
"""Volume over radius^3 up to which the edge of the liquid is counted: as far as it is tested."""


EDGE_ANGLE = radians(80.0)
"""Contact angle [rad] up to which likewise."""


class ConstantVolume(Law):
    """Meniscus that forms when the bodies touch and then keeps its volume until it breaks.

    Parameters
    ----------
    radius
        Radius at the tip [m].
    tension
        Surface tension [N/m].
    contact_angle
        Contact angle on both bodies [rad], below pi/2.
    kelvin_radius
        Radius of curvature in equilibrium with the vapour [m], at which it forms.
    edge
        Whether the surface energy of the liquid's edge counts (static). It holds for small
        volumes, up to EDGE_HOLDS radius^3; without it the pull is that of a thin bridge.

    Notes
    -----
    It forms with the volume of the meniscus in equilibrium at touch, pi radius c^2 with
    c = 2 kelvin_radius cos(angle), and breaks at `bridge.rupture_distance`. Force and energy
    are those of :mod:`.bridge`, with their errors. What separating it has cost is lost when it
    breaks. For impacts, which are too short for liquid to condense or to evaporate.
    """

    radius: Real = quantity()
    tension: Real = quantity()
    contact_angle: Real = quantity()
    kelvin_radius: Real = quantity()
    edge: bool = eqx.field(static=True, default=True)

    mechanism: ClassVar[str] = "capillary"
    counts: ClassVar[frozenset[str]] = frozenset({"capillary"})

    @property
    def height(self) -> jax.Array:
        """Gap at the edge of the liquid at touch, c [m]."""
        return jnp.asarray(2.0 * self.kelvin_radius * jnp.cos(self.contact_angle))

    @property
    def volume(self) -> jax.Array:
        """Volume of liquid [m^3]."""
        return pi * self.radius * self.height**2

    @property
    def hysteretic(self) -> bool:
        return True

    @property
    def breaking_gap(self) -> jax.Array:
        return bridge.rupture_distance(self.volume, self.radius, self.contact_angle)

    @property
    def kinks(self) -> tuple[jax.Array | float, ...]:
        return (0.0, self.breaking_gap)

    @property
    def length(self) -> jax.Array:
        return jnp.minimum(self.height, self.breaking_gap)

    def force(self, gap: jax.Array) -> jax.Array:
        return jnp.zeros_like(gap)

    def energy(self, gap: jax.Array) -> jax.Array:
        """Energy of the free branch [J]; it ends at touch."""
        return jnp.zeros_like(gap)

    def bonded_force(self, gap: jax.Array) -> jax.Array:
        pull = bridge.force if self.edge else bridge.leading_force
        return pull(gap, *self._liquid)

    def bonded_energy(self, gap: jax.Array) -> jax.Array:
        spent = bridge.energy if self.edge else bridge.leading_energy
        return spent(gap, *self._liquid)

    @property
    def _liquid(self) -> tuple[Real, Real, Real, Real]:
        return self.volume, self.radius, self.tension, self.contact_angle
