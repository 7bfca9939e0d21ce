"""Shapes of bodies: the rise of the surface above its lowest point."""

from __future__ import annotations

import equinox as eqx

from .._jax import jax
from ..laws.law import Real, quantity


class Sphere(eqx.Module):
    """A sphere, taken as the paraboloid of its lowest point.

    Parameters
    ----------
    radius
        Radius R [m]. The rise r^2/(2R) is within 1 % of the sphere's for r < 0.2 R.
    """

    radius: Real = quantity()

    def profile(self, place: jax.Array) -> jax.Array:
        """Height [m] of the surface at the distance ``place`` [m] from the axis."""
        return place**2 / (2.0 * self.radius)
