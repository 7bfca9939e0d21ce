"""Liquid bridge in equilibrium with the vapour around it."""

from __future__ import annotations

import abc
from math import pi
from typing import Any, ClassVar

import equinox as eqx

from ..._jax import jax, jnp
from ..law import Law, Powers, Real, TruncatedPower, quantity


class Formation(eqx.Module):
    """When a meniscus forms."""

    @abc.abstractmethod
    def gap(self, interaction_range: jax.Array) -> jax.Array:
        """Gap [m] at which it forms, given the largest it can span."""


class ByContact(Formation):
    """Forms when the bodies touch and holds to the Kelvin gap: a cycle loses energy."""

    def gap(self, interaction_range: jax.Array) -> jax.Array:
        return jnp.zeros_like(interaction_range)


class ByKelvinGap(Formation):
    """Forms at the gap at which it also breaks: conservative."""

    def gap(self, interaction_range: jax.Array) -> jax.Array:
        return interaction_range


class Condensed(Law):
    """Liquid in equilibrium with the vapour, wherever it forms: the gaps between its branches.

    What is one has ``contact_angle``, ``kelvin_radius`` and ``formation``.
    """

    mechanism: ClassVar[str] = "capillary"
    counts: ClassVar[frozenset[str]] = frozenset({"capillary"})

    @property
    def interaction_range(self: Any) -> jax.Array:
        """Largest gap that it spans, c [m]."""
        return jnp.asarray(2.0 * self.kelvin_radius * jnp.cos(self.contact_angle))

    @property
    def hysteretic(self: Any) -> bool:
        return isinstance(self.formation, ByContact)

    @property
    def forming_gap(self: Any) -> jax.Array:
        gap: jax.Array = self.formation.gap(self.interaction_range)
        return gap

    @property
    def breaking_gap(self) -> jax.Array:
        return self.interaction_range

    @property
    def kinks(self) -> tuple[jax.Array | float, ...]:
        return (0.0, self.interaction_range)

    def force(self, gap: jax.Array) -> jax.Array:
        return jnp.where(gap < self.forming_gap, self.bonded_force(gap), 0.0)

    def energy(self, gap: jax.Array) -> jax.Array:
        """Energy [J]; with :class:`ByContact` the free branch ends where a bond forms."""
        inside = jnp.where(gap < self.forming_gap, self.bonded_energy(gap), 0.0)
        return jnp.where(gap < 0.0, self.bonded_energy(gap), inside)


class Meniscus(Condensed):
    """Meniscus of constant curvature between a paraboloid and a plane.

    Parameters
    ----------
    radius
        Radius at the tip [m].
    tension
        Surface tension [N/m].
    contact_angle
        Contact angle with both solids [rad], below pi/2.
    kelvin_radius
        Kelvin radius r_k > 0 [m].
    formation
        :class:`ByContact` (default) or :class:`ByKelvinGap`.

    Notes
    -----
    It spans gaps up to c = 2 r_k cos(angle) and pulls with 4 pi radius tension
    cos(angle) (1 - g/c), by its full value when the bodies touch. The publication's
    eq. 12, without the repulsion that it prints beyond c.
    """

    radius: Real = quantity()
    tension: Real = quantity()
    contact_angle: Real = quantity()
    kelvin_radius: Real = quantity()
    formation: Formation = ByContact()

    radius_power: ClassVar[float] = 1.0

    @property
    def pull(self) -> jax.Array:
        """Its largest force [N], at contact."""
        return 4.0 * pi * self.radius * self.tension * jnp.cos(self.contact_angle)

    def bonded_force(self, gap: jax.Array) -> jax.Array:
        return -self.pull * jnp.clip(1.0 - gap / self.interaction_range, 0.0, 1.0)

    def bonded_energy(self, gap: jax.Array) -> jax.Array:
        left = jnp.clip(1.0 - gap / self.interaction_range, 0.0, 1.0)
        return -self.pull * (0.5 * self.interaction_range * left**2 + jnp.maximum(-gap, 0.0))

    def powers(self, bond_gap: jax.Array) -> tuple[Powers, Powers]:
        c, slope = self.interaction_range, self.pull / self.interaction_range
        edge = bond_gap if self.hysteretic else c
        step_f, step_u = -slope * (c - edge), -0.5 * slope * (c - edge) ** 2
        force = (
            TruncatedPower(-slope, 1.0, edge),
            TruncatedPower(step_f, 0.0, edge),
            TruncatedPower(slope, 1.0, 0.0),
        )
        energy = (
            TruncatedPower(-0.5 * slope, 2.0, edge),
            TruncatedPower(step_f, 1.0, edge),
            TruncatedPower(step_u, 0.0, edge),
            TruncatedPower(0.5 * slope, 2.0, 0.0),
        )
        return force, energy
