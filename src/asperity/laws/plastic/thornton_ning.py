"""Yielding sphere whose pressure is cut off."""

from __future__ import annotations

from math import pi

from ..._jax import jax, jnp
from ..law import Real, quantity
from .plastic_contact import PlasticContact, power


class ThorntonNing(PlasticContact):
    """Thornton and Ning's contact of an elastic, perfectly plastic sphere, without adhesion.

    Parameters
    ----------
    radius
        Radius at the tip [m].
    modulus
        Contact modulus E* [Pa].
    yield_pressure
        Largest pressure p that the contact bears [Pa].

    Notes
    -----
    Yield begins where Hertz's pressure 2 E* a/(pi radius) reaches p, at the force
    pi^3 p^3 radius^2/(6 E*^2). Beyond, the pressure is cut off at p and the force grows by
    pi p radius for each unit of overlap, the contact radius being sqrt(radius overlap) still.
    Unloading is Hertz's, with the radius R_p that this contact radius and force ask for: R_p
    over radius is Hertz's force at the deepest overlap over the force there. Thornton and Ning
    (1998).
    """

    yield_pressure: Real = quantity()

    @property
    def yield_overlap(self) -> jax.Array:
        return (pi * self.yield_pressure / (2.0 * self.modulus)) ** 2 * self.radius

    def loading_force(self, overlap: jax.Array) -> jax.Array:
        x = overlap / self.yield_overlap
        return self._yield_force * jnp.where(x <= 1.0, power(x, 1.5), 1.5 * x - 0.5)

    def loading_work(self, overlap: jax.Array) -> jax.Array:
        x = overlap / self.yield_overlap
        beyond = jnp.maximum(x - 1.0, 0.0)
        reduced = 0.4 * power(jnp.minimum(x, 1.0), 2.5) + beyond + 0.75 * beyond**2
        return self._yield_force * self.yield_overlap * reduced

    def residual(self, deepest: jax.Array) -> jax.Array:
        x = jnp.maximum(deepest / self.yield_overlap, 1.0)
        return jnp.maximum(deepest, 0.0) * (1.0 - (1.5 * x - 0.5) / x**1.5)

    def exponent(self, deepest: jax.Array) -> jax.Array:
        return jnp.full_like(deepest, 1.5, dtype=jnp.float64)

    @property
    def _yield_force(self) -> jax.Array:
        return self._stiffness * self.yield_overlap**1.5
