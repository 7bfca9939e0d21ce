"""Liquid that fills every narrow gap."""

from __future__ import annotations

from ..._jax import jax, jnp
from ..law import Powers, Real, TruncatedPower, quantity
from .meniscus import ByContact, Condensed, Formation


class KelvinFilling(Condensed):
    """Liquid in every place whose local gap is below what the vapour sustains.

    Per area of surface, not per asperity: its heights are those of the surface, with a rms of
    their own, and its density is 1.

    Parameters
    ----------
    tension
        Surface tension [N/m].
    contact_angle
        Contact angle on both surfaces [rad], below pi/2.
    kelvin_radius
        Radius of curvature in equilibrium with the vapour [m].
    formation
        When a place fills.

    Notes
    -----
    Where the gap g is below c = 2 kelvin_radius cos(angle) the liquid pulls with
    tension/kelvin_radius; where the solids touch there is none. The work of separation is
    2 tension cos(angle) at any humidity. Between a smooth sphere and a plane it is
    :class:`Meniscus` with the sphere's radius. ``docs/theory``.
    """

    tension: Real = quantity()
    contact_angle: Real = quantity()
    kelvin_radius: Real = quantity()
    formation: Formation = ByContact()

    @property
    def pull(self) -> jax.Array:
        """Its tension on filled places [Pa]."""
        return jnp.asarray(self.tension / self.kelvin_radius)

    def bonded_force(self, gap: jax.Array) -> jax.Array:
        return jnp.where((gap >= 0.0) & (gap < self.interaction_range), -self.pull, 0.0)

    def bonded_energy(self, gap: jax.Array) -> jax.Array:
        return -self.pull * (self.interaction_range - jnp.clip(gap, 0.0, self.interaction_range))

    def powers(self, bond_gap: jax.Array) -> tuple[Powers, Powers]:
        edge = bond_gap if self.hysteretic else self.interaction_range
        left = self.interaction_range - edge
        force = (TruncatedPower(-self.pull, 0.0, edge), TruncatedPower(self.pull, 0.0, 0.0))
        energy = (
            TruncatedPower(-self.pull, 1.0, edge),
            TruncatedPower(-self.pull * left, 0.0, edge),
            TruncatedPower(self.pull, 1.0, 0.0),
        )
        return force, energy
