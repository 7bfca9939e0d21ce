"""What acts on a body besides its contact: weight, forces with a potential, and drags."""

from __future__ import annotations

import abc
from typing import ClassVar, NamedTuple

import equinox as eqx
import numpy as np

from .._jax import jax, jnp
from ..laws.law import Real
from ..numerics.roots import root_between

_DISTANCES = 2.0 ** np.arange(-60.0, 60.0)  # of the release: distances that are tried
_CLOSE = 1e-16  # of a distance: a move that is lost in rounding


class ExternalForce(eqx.Module):
    """A force that depends on the separation alone and has a potential, as a spring's.

    A subclass is one mechanism: :class:`asperity.dynamics.suspension.Spring`.
    """

    name: ClassVar[str]
    """Name of the force in a result."""

    @abc.abstractmethod
    def force(self, place: jax.Array) -> jax.Array:
        """Force towards the surface [N] at a separation [m], any shape."""

    @abc.abstractmethod
    def slope(self, place: jax.Array) -> jax.Array:
        """Derivative of :meth:`force` with the separation [N/m]."""

    @abc.abstractmethod
    def potential_gain(self, start: jax.Array, distance: jax.Array) -> jax.Array:
        """Potential energy [J] that a body gains from ``start`` over a ``distance`` outwards [m].

        The integral of :meth:`force`, in a form that does not cancel where the distance is small.
        """


class Along(NamedTuple):
    """What a drag may depend on, at some places of a body's way.

    Attributes
    ----------
    central
        Separation of the deformed mean planes at the axis [m].
    stiffness, bend
        First [N/m] and second [N/m^2] derivative of the contact force with the separation.
    speed
        About how fast the body is [m/s].
    """

    central: jax.Array
    stiffness: jax.Array
    bend: jax.Array
    speed: jax.Array

    @classmethod
    def apart(cls, central: jax.Array) -> Along:
        """The same outside contact, where no contact force changes."""
        none = jnp.zeros_like(central)
        return cls(central, none, none, none)


class Drag(eqx.Module):
    """A force against the speed of a body and in proportion to it: it takes energy on the way.

    A subclass is one mechanism: :class:`asperity.dynamics.gas_film.SqueezeFilm`,
    :class:`asperity.dynamics.wave_radiation.WaveRadiation`,
    :class:`asperity.dynamics.suspension.Dashpot`.
    """

    name: ClassVar[str]
    """Name of its loss in the ledger, and of its force in a result."""

    acts_apart: ClassVar[bool] = True
    """Whether it acts outside contact too, and may so bring a body to rest."""

    @property
    def thinnest(self) -> Real | None:
        """Separation [m] down to which it grows as one over the separation.

        None where it does not: pieces of the way are cut for one that does.
        """
        return None

    @abc.abstractmethod
    def resistance(self, along: Along) -> jax.Array:
        """Force over speed [N s/m], of the shape of ``along.central``."""


class Load(NamedTuple):
    """What presses a body towards the surface: its weight, and forces with a potential.

    Attributes
    ----------
    weight
        Weight [N].
    forces
        The forces beside it.
    """

    weight: jax.Array
    forces: tuple[ExternalForce, ...] = ()

    def force(self, place: jax.Array) -> jax.Array:
        """Force towards the surface [N] at a separation [m], any shape."""
        total = self.weight
        for one in self.forces:
            total = total + one.force(place)
        return total

    def slope(self, place: jax.Array) -> jax.Array:
        """Derivative of :meth:`force` with the separation [N/m]."""
        total = jnp.zeros(())
        for one in self.forces:
            total = total + one.slope(place)
        return total

    def potential_gain(self, start: Real, distance: jax.Array) -> jax.Array:
        """Potential energy [J] gained from ``start`` over a ``distance`` outwards [m]."""
        gained = self.weight * distance
        for one in self.forces:
            gained = gained + one.potential_gain(start, distance)
        return gained

    def potential(self, place: jax.Array) -> jax.Array:
        """Potential energy [J] at a separation [m], above that at a separation of 0."""
        return self.potential_gain(np.zeros(()), place)

    def apex_height(self, start: jax.Array, kinetic: jax.Array) -> jax.Array:
        """How far above ``start`` [m] a body with a kinetic energy [J] gets; infinite for good.

        The first distance beyond which its energy does not suffice.
        """
        if not self.forces:
            falls = self.weight > 0.0
            height = kinetic / jnp.where(falls, self.weight, 1.0)
            return jnp.where(falls, height, jnp.inf * (kinetic > 0))
        still, begin, energy = jax.lax.stop_gradient((self, start, kinetic))
        distances = jnp.asarray(_DISTANCES) * jnp.abs(begin)
        spent = still.potential_gain(begin, distances) > energy
        first = jnp.argmax(spent)
        inside = jnp.where(first > 0, distances[jnp.maximum(first - 1, 0)], 0.0)

        def left(distance: jax.Array) -> jax.Array:
            return energy - still.potential_gain(begin, distance)

        distance = root_between(left, inside, distances[first], _CLOSE * distances[first])
        pull = still.force(begin + distance)
        missing = (kinetic - self.potential_gain(start, distance)) / jnp.where(
            pull > 0.0, pull, 1.0
        )
        return jnp.where(jnp.any(spent), distance + missing, jnp.inf)
