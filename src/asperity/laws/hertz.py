"""Elastic contact without adhesion."""

from __future__ import annotations

from typing import ClassVar

from .._jax import jax, jnp
from .law import Law, Powers, Real, TruncatedPower, quantity


class Hertz(Law):
    """Hertz contact of a paraboloid and a plane.

    Parameters
    ----------
    radius
        Radius at the tip [m].
    modulus
        Contact modulus E* [Pa].

    Notes
    -----
    Force 4/3 E* sqrt(radius) overlap^1.5. Johnson (1985), eq. 4.23.
    """

    radius: Real = quantity()
    modulus: Real = quantity()

    mechanism: ClassVar[str] = "elastic"
    counts: ClassVar[frozenset[str]] = frozenset({"elastic"})
    radius_power: ClassVar[float] = 0.5

    def force(self, gap: jax.Array) -> jax.Array:
        return self.powers(jnp.zeros(()))[0][0](gap)

    def energy(self, gap: jax.Array) -> jax.Array:
        return self.powers(jnp.zeros(()))[1][0](gap)

    def powers(self, bond_gap: jax.Array) -> tuple[Powers, Powers]:
        stiffness = 4.0 / 3.0 * self.modulus * jnp.sqrt(self.radius)
        return (
            (TruncatedPower(stiffness, 1.5, 0.0),),
            (TruncatedPower(0.4 * stiffness, 2.5, 0.0),),
        )
