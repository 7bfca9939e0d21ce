"""Adhesion of finite range between elastic bodies: from rigid to soft."""

from __future__ import annotations

from math import pi
from typing import ClassVar

from .._jax import jax, jnp
from .adhesive_zone import End, Radii, Zone, contact_end, of_radii, radii, slopes
from .law import OnlyBonded, Real, quantity

RANGE_PER_SPACING = 9.0 * 3.0**0.5 / 16.0
"""Range h_0 per spacing: stress and work are then those of the 3-9 potential's peak."""


class Maugis(OnlyBonded):
    """Maugis-Dugdale contact of a paraboloid and a plane, Hertz included.

    Parameters
    ----------
    radius
        Radius at the tip [m].
    modulus
        Contact modulus E* [Pa].
    work_of_adhesion
        Energy to part unit area w [J/m^2].
    spacing
        Interatomic spacing eps [m]; the adhesive stress w/h_0 acts over gaps up to
        h_0 = (9 sqrt(3)/16) eps, where the 3-9 potential would have its peak.

    Notes
    -----
    Bodies touch within a radius a and attract within a radius c > a; outside contact, a = 0.
    Both follow from two equations for the gap, which are solved exactly. The bond forms at
    h_0 and breaks where the branch folds: outside contact while the elasticity parameter is
    below 0.938, in contact above. Maugis (1992).
    """

    radius: Real = quantity()
    modulus: Real = quantity()
    work_of_adhesion: Real = quantity()
    spacing: Real = quantity()

    counts: ClassVar[frozenset[str]] = frozenset({"elastic", "adhesion"})

    @property
    def elasticity(self) -> jax.Array:
        """Elasticity parameter lambda: 2 (w/h_0) (9 radius/(16 pi w E*^2))^(1/3)."""
        return 2.0 / pi * self._depth / self.forming_gap

    @property
    def forming_gap(self) -> jax.Array:
        return RANGE_PER_SPACING * self.spacing

    @property
    def breaking_gap(self) -> jax.Array:
        return -self._depth * contact_end(self.elasticity).last

    @property
    def kinks(self) -> tuple[jax.Array | float, ...]:
        """Where the contact proper ends on unloading, and where the bond breaks."""
        end = contact_end(self.elasticity)
        return (-self._depth * end.overlap, -self._depth * end.last)

    @property
    def length(self) -> jax.Array | float:
        return self._depth

    @property
    def _depth(self) -> jax.Array:
        """Unit of gap [m]: (9 pi^2 w^2 radius/(16 E*^2))^(1/3)."""
        w, r, e = self.work_of_adhesion, self.radius, self.modulus
        return jnp.cbrt((0.75 * pi * w / e) ** 2 * r)

    def bonded_response(self, gap: jax.Array) -> dict[str, jax.Array]:
        """Hertz force at this contact radius, the pull of the adhesive stress, and the energy.

        The energy, of the bodies and of the adhesive stress, is 0 where they begin to attract.
        """
        elastic, pull, energy = _state(-gap / self._depth, self.elasticity)
        unit = pi * self.work_of_adhesion * self.radius
        return {
            "elastic": unit * elastic,
            "adhesion": unit * pull,
            "energy": unit * self._depth * energy,
        }


# In the reduced units of `adhesive_zone`: overlap = -gap, `l` = lambda.


def _state(overlap: jax.Array, l: jax.Array) -> tuple[jax.Array, jax.Array, jax.Array]:
    """Elastic and adhesive force, and energy, on the bonded branch; at its end beyond it."""
    end = contact_end(l)
    return _held(jnp.maximum(overlap, end.last), l, jax.lax.stop_gradient(end))


@jax.custom_jvp
@jax.jit
def _held(overlap: jax.Array, l: jax.Array, end: End) -> tuple[jax.Array, jax.Array, jax.Array]:
    return _within(overlap, l, radii(overlap, l, end))


def _within(
    overlap: jax.Array, l: jax.Array, found: Radii
) -> tuple[jax.Array, jax.Array, jax.Array]:
    """Forces, and the energy: of the contact, of the zone's displacement, of its stress."""
    inner, flank = found
    outer, z = of_radii(inner, flank)
    depth = overlap - inner**2 / 3.0
    energy = 0.75 * inner * (depth**2 + 4.0 / 45.0 * inner**4)
    energy = energy - 4.0 / 9.0 * (l * outer * z.rise) ** 2 * (2.0 * outer + inner)
    energy = energy - outer**2 + l * _stress_work(overlap, inner, outer, z)
    return inner**3, -l * outer**2 * (2.0 * z.angle - z.segment), energy


def _stress_work(overlap: jax.Array, inner: jax.Array, outer: jax.Array, z: Zone) -> jax.Array:
    """Work of the stress against the shape of the body and its displacement by the contact."""
    square = z.cosine**2
    shape = (0.5 * square + 0.25) * z.sine * z.cosine - (square - 0.25) * z.angle
    return outer**4 * shape - outer**2 * (overlap - inner**2) * z.segment


@_held.defjvp
@jax.jit
def _held_jvp(primals, tangents):  # type: ignore[no-untyped-def]
    (overlap, l, end), (by_overlap, by_l, _) = primals, tangents
    inner, flank = radii(overlap, l, end)
    elastic, pull, energy = _within(overlap, l, (inner, flank))
    outer, z = of_radii(inner, flank)
    outer_change, inner_change = slopes(overlap, l, (inner, flank), (by_overlap, by_l))
    # Both equations make the energy stationary in a and c, so only its explicit slopes count.
    elastic_change = 3.0 * inner * inner_change
    force_change = 1.5 * inner * by_overlap - outer**2 * z.segment * by_l
    force_change = force_change - 2.0 * l * z.angle * outer_change
    energy_slope = _stress_work(overlap, inner, outer, z)
    energy_slope = energy_slope - 8.0 / 9.0 * l * (outer * z.rise) ** 2 * (2.0 * outer + inner)
    energy_change = (elastic + pull) * by_overlap + energy_slope * by_l
    changes = (elastic_change, force_change - elastic_change, energy_change)
    return (elastic, pull, energy), changes
