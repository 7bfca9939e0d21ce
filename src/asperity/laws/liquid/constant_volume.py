"""Liquid bridge that neither grows nor shrinks while it is stretched."""

from __future__ import annotations

from math import pi, radians
from typing import ClassVar

import equinox as eqx

from ..._jax import jax, jnp
from ..law import Law, Real, quantity
from . import bridge
from .meniscus import ByContact, Formation, Meniscus

EDGE_HOLDS = 0.1
"""Volume over radius^3 up to which the edge of the liquid is counted: as far as it is tested."""


EDGE_ANGLE = radians(80.0)
"""Contact angle [rad] up to which likewise."""


class ConstantVolume(Law):
    """Meniscus that keeps from touch on the volume that it has there, until it breaks.

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
    formation
        With :class:`ByKelvinGap` there is a :class:`Meniscus` in equilibrium before touch.
    edge
        Whether the surface energy of the liquid's edge counts (static). It holds for small
        volumes, up to EDGE_HOLDS radius^3; without it the pull is that of a thin bridge.

    Notes
    -----
    It forms with the volume of the meniscus in equilibrium at touch, pi radius c^2 with
    c = 2 kelvin_radius cos(angle), and breaks at `bridge.rupture_distance`. Force and energy
    are those of :mod:`.bridge`, with their errors. What separating it has cost is lost when it
    breaks. For impacts, which are too short for liquid to condense or to evaporate.

    Formed at the Kelvin gap, the meniscus follows equilibrium in and out until the bodies
    touch; from then on it is the bridge, without its edge, so that the force is continuous. A
    meniscus that came close and never touched stays in equilibrium, where in truth it keeps a
    volume that is smaller by (its closest gap/c)^2. Where the bridge would break within c, or
    with a gain, it is in equilibrium throughout.
    """

    radius: Real = quantity()
    tension: Real = quantity()
    contact_angle: Real = quantity()
    kelvin_radius: Real = quantity()
    formation: Formation = ByContact()
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
        return jnp.where(self.keeps, self._rupture, self.height)

    @property
    def kinks(self) -> tuple[jax.Array | float, ...]:
        inner = () if self._touches else (self.height,)
        return (0.0, *inner, self.breaking_gap)

    @property
    def keeps(self) -> jax.Array:
        """Whether it keeps its volume, or is in equilibrium throughout."""
        if self._touches:
            return jnp.asarray(True)
        reaches = self._rupture > self.height
        cost = bridge.leading_energy(self._rupture, *self._liquid) + self._at_touch
        return jnp.logical_and(reaches, cost > 0.0)

    @property
    def length(self) -> jax.Array:
        return jnp.minimum(self.height, self.breaking_gap)

    @property
    def only_bonded(self) -> bool:
        return self._touches

    def force(self, gap: jax.Array) -> jax.Array:
        return jnp.zeros_like(gap) if self._touches else self._before.force(gap)

    def energy(self, gap: jax.Array) -> jax.Array:
        """Energy of the free branch [J]; it ends at touch."""
        return jnp.zeros_like(gap) if self._touches else self._before.energy(gap)

    def bonded_force(self, gap: jax.Array) -> jax.Array:
        pull = bridge.force if self.edge else bridge.leading_force
        bonded = pull(gap, *self._liquid)
        return bonded if self._touches else jnp.where(self.keeps, bonded, self.force(gap))

    def bonded_energy(self, gap: jax.Array) -> jax.Array:
        spent = bridge.energy if self.edge else bridge.leading_energy
        bonded = spent(gap, *self._liquid) + self._at_touch
        return bonded if self._touches else jnp.where(self.keeps, bonded, self.energy(gap))

    @property
    def _touches(self) -> bool:
        """Whether nothing is there before touch. Known without values."""
        return isinstance(self.formation, ByContact)

    @property
    def _before(self) -> Meniscus:
        return Meniscus(
            self.radius, self.tension, self.contact_angle, self.kelvin_radius, self.formation
        )

    @property
    def _at_touch(self) -> jax.Array:
        """Energy with which it begins [J]."""
        return self.energy(jnp.zeros(()))

    @property
    def _rupture(self) -> jax.Array:
        return bridge.rupture_distance(self.volume, self.radius, self.contact_angle)

    @property
    def _liquid(self) -> tuple[Real, Real, Real, Real]:
        return self.volume, self.radius, self.tension, self.contact_angle
