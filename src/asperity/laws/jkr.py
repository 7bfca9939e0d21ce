"""JKR: adhesive elastic contact of soft bodies, with the pull-off force of one asperity."""

from __future__ import annotations

from math import pi
from typing import ClassVar

from .._jax import jax, jnp
from .law import OnlyBonded, Real, quantity


class Jkr(OnlyBonded):
    """Johnson-Kendall-Roberts contact of a paraboloid and a plane, Hertz included.

    Parameters
    ----------
    radius
        Radius at the tip [m].
    modulus
        Contact modulus E* [Pa].
    work_of_adhesion
        Energy to part unit area w [J/m^2].

    Notes
    -----
    With the contact radius a: overlap = a^2/radius - sqrt(2 pi a w/E*) and force
    4 E* a^3/(3 radius) - sqrt(8 pi w E* a^3). The bond forms at gap 0, where the force
    jumps to -(4/3) pi w radius, and breaks at the fold of the branch, where it is
    -(5/6) pi w radius: pull-off at a given separation. In between the force is least, -(3/2)
    pi w radius: pull-off at a given load. Johnson, Kendall and Roberts (1971), eqs. 14-19.
    """

    radius: Real = quantity()
    modulus: Real = quantity()
    work_of_adhesion: Real = quantity()

    counts: ClassVar[frozenset[str]] = frozenset({"elastic", "adhesion"})

    @property
    def breaking_gap(self) -> jax.Array:
        return 3.0 * 2.0 ** (-8.0 / 3.0) * self._depth

    @property
    def kinks(self) -> tuple[jax.Array | float, ...]:
        return (self.breaking_gap,)

    @property
    def length(self) -> jax.Array | float:
        return self._depth

    @property
    def _depth(self) -> jax.Array:
        """Overlap at which the two terms of the overlap are equal in size [m]."""
        w, r, e = self.work_of_adhesion, self.radius, self.modulus
        return jnp.cbrt((2.0 * pi * w / e) ** 2 * r)

    def contact_radius(self, gap: jax.Array) -> jax.Array:
        """Contact radius [m] on the bonded branch; at the fold's beyond the fold.

        In u = sqrt(a), scaled, the branch is u^4 - u = overlap.
        """
        overlap = jnp.maximum(-gap / self._depth, -3.0 * 2.0 ** (-8.0 / 3.0))
        return self._radius_scale * _branch(overlap) ** 2

    @property
    def _radius_scale(self) -> jax.Array:
        w, r, e = self.work_of_adhesion, self.radius, self.modulus
        return jnp.cbrt(2.0 * pi * w * r**2 / e)

    def bonded_response(self, gap: jax.Array) -> dict[str, jax.Array]:
        """Hertz force at this contact radius, the pull of the adhesive stress, and the energy.

        The elastic energy of both stress fields less the work of adhesion of the disc:
        E* a (overlap_1^2 - (2/3) a^2 overlap_1/R + a^4/(5 R^2)) - pi a^2 w, overlap_1 the
        overlap. It is that of a flat punch pressed through overlap_1 - a^2/R after the
        paraboloid touched over a (Johnson 1985, section 5.5).
        """
        a = self.contact_radius(gap)
        elastic = 4.0 / 3.0 * self.modulus * a**3 / self.radius
        pull = -jnp.sqrt(8.0 * pi * self.work_of_adhesion * self.modulus * a**3)
        depth, rise = -gap, a**2 / self.radius
        stored = self.modulus * a * (depth**2 - 2.0 / 3.0 * depth * rise + rise**2 / 5.0)
        energy = stored - pi * a**2 * self.work_of_adhesion
        return {"elastic": elastic, "adhesion": pull, "energy": energy}


_FOLD = 2.0 ** (-2.0 / 3.0)  # where d(u^4 - u)/du = 0


@jax.custom_jvp
def _branch(overlap: jax.Array) -> jax.Array:
    """Larger real root u of u^4 - u = overlap, for overlap not below the fold's."""
    excess = jnp.maximum(overlap + 3.0 * 2.0 ** (-8.0 / 3.0), 0.0)
    # excess = 6 f^2 s^2 + 4 f s^3 + s^4 in s = u - f, f the fold: a little more than the square of
    # s^2 + sqrt(6) f s, whose root is at most 3.3 % off. Two of Halley's steps come to 1e-14.
    root, linear = jnp.sqrt(excess), 6.0**0.5 * _FOLD
    s = 2.0 * root / (linear + jnp.sqrt(linear**2 + 4.0 * root))
    for halley in (1.0, 1.0, 0.0):
        value = s * s * (6.0 * _FOLD**2 + s * (4.0 * _FOLD + s)) - excess
        slope = s * (12.0 * _FOLD**2 + s * (12.0 * _FOLD + 4.0 * s))
        bend = 12.0 * (_FOLD**2 + s * (2.0 * _FOLD + s))
        below = 2.0 * slope**2 - halley * value * bend
        s = jnp.maximum(s - 2.0 * value * slope / jnp.where(below > 0.0, below, 1.0), 0.0)
    return _FOLD + s


@_branch.defjvp
def _branch_jvp(primals, tangents):  # type: ignore[no-untyped-def]
    (overlap,), (change,) = primals, tangents
    u = _branch(overlap)
    slope = 4.0 * u**3 - 1.0
    regular = slope > 1e-7
    return u, jnp.where(regular, change / jnp.where(regular, slope, 1.0), 0.0)
