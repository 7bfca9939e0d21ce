"""Gas squeezed between a sphere and a plane."""

from __future__ import annotations

from math import pi
from typing import ClassVar

from .._jax import jax, jnp
from ..laws.law import Real, quantity
from .external_forces import Along, Drag


def slip_factor(separation: Real, slip_length: Real) -> jax.Array:
    """Share of the squeeze force that first-order slip on both surfaces leaves, 0 to 1.

    Parameters
    ----------
    separation
        Central separation [m], positive, any shape.
    slip_length
        Slip length b of both surfaces [m], 0 or more. Vinogradova (1995).
    """
    x = 6.0 * slip_length / jnp.asarray(separation, dtype=jnp.float64)
    # By its series where x is small: the difference below would cancel.
    little = x < 1e-4
    large = jnp.where(little, 1.0, x)
    whole = 2.0 / large * ((1.0 + 1.0 / large) * jnp.log1p(large) - 1.0)
    return jnp.where(little, 1.0 - x / 3.0 + x**2 / 6.0, whole)


class SqueezeFilm(Drag):
    """Gas between a sphere and a plane: a drag in both directions.

    Parameters
    ----------
    radius
        Radius of the sphere [m].
    viscosity
        Viscosity of the gas [Pa s].
    slip_length
        Slip length on both surfaces [m].
    closest
        Separation [m] below which the film does not thin: the rms height of rough surfaces. At
        0 the film thins without end, for bodies that never touch: the drag is not finite at
        separations of 0 and below, so that a contact that reaches them needs it above 0.

    Notes
    -----
    Force over speed 6 pi viscosity radius^2 f/separation with f of :func:`slip_factor`: the
    limit of Brenner's solution (1961) for a gap that is small beside the radius, 1 % off at
    0.4 % of it. A continuum with first-order slip: it holds below a Knudsen number, mean free
    path over separation, of 0.1, and while the pressure in the film, about
    3 viscosity radius speed f/separation^2, is small beside the gas's own.
    """

    radius: Real = quantity()
    viscosity: Real = quantity()
    slip_length: Real = quantity(0.0)
    closest: Real = quantity(0.0)

    name: ClassVar[str] = "gas"

    @property
    def thinnest(self) -> Real | None:
        return self.closest

    def resistance(self, along: Along) -> jax.Array:
        return self.drag(along.central)

    def drag(self, separation: Real) -> jax.Array:
        """Force over speed [N s/m] at a central separation [m], any shape."""
        gap = jnp.maximum(jnp.asarray(separation, dtype=jnp.float64), self.closest)
        film = 6.0 * pi * self.viscosity * self.radius**2 / gap
        return film * slip_factor(gap, self.slip_length)
