"""A sphere that adheres as it is pressed elastically, yields, and adheres more for it."""

from __future__ import annotations

from math import pi

import equinox as eqx
import numpy as np

from ..._jax import jax, jnp
from ..jkr import Jkr
from ..law import Real, quantity

_NODES, _WEIGHTS = (np.asarray(values) for values in np.polynomial.legendre.leggauss(8))


@jax.jit
def _cubic_root(pressure: jax.Array, pull: jax.Array) -> jax.Array:
    """The root u > 0 of u^3 - pressure u - pull = 0.

    Newton from above on a function that is convex there.
    """
    u = jnp.sqrt(pressure) + jnp.cbrt(pull)
    for _ in range(8):
        u = u - (u * (u * u - pressure) - pull) / (3.0 * u * u - pressure)
    return u


class AdhesiveThorntonNing(eqx.Module):
    """Adhesive elastic-plastic contact of a paraboloid and a plane.

    Parameters
    ----------
    radius
        Radius at the tip R [m].
    modulus
        Contact modulus E* [Pa].
    work
        Work of adhesion w [J/m^2].
    yield_pressure
        Contact pressure p_y [Pa] that is nowhere exceeded.

    Notes
    -----
    Overlap and deepest overlap [m], at least 0, may have any shape; forces [N] and energies
    [J] have it too. Bonded contact with separated surfaces as the zero of energy, as in `Jkr`.

    Contact radius a and overlap keep the relation of Johnson, Kendall and Roberts, whose
    pressure at s = sqrt(1 - (r/a)^2) is A s - B/s with A = 2 E* a/(pi R) and
    B = sqrt(2 w E*/(pi a)). Yield begins where A - B = p_y (Thornton and Ning 1998, eq. 65).
    Beyond, the pressure is cut at p_y within the radius a_p where A s - B/s = p_y. With
    q = sqrt(a^2 - a_p^2) the force is the integral of what is left,

        F = pi [p_y (a^2 - q^2/3) - (4/3) sqrt(2 w E* a/pi) q].

    Its stiffness joins that of the elastic contact smoothly, and is eq. 69 of the paper with q
    for the contact radius at yield, from which q departs by adhesion alone. Without adhesion
    it is F_y + pi p_y R (overlap - overlap at yield).

    On unloading the contact is elastic, with the tip radius that gives the same force at the
    same contact radius, and shifted to the same overlap (the paper's eqs. 20 and 72-77):
    1/R_p = 3 (F + sqrt(8 pi w E* a^3))/(4 E* a^3), shift a^2 (1/R - 1/R_p).

    Where adhesion alone nearly makes it yield (A < 2.5 B at yield, the force there below 0),
    the model's flatter tip at first stores more: `dissipated` falls to at most 4 % of the loss
    on forming below 0 before it grows. Below p_y = (2 w E*^2/(pi^2 R))^(1/3) it yields on
    touching, ``yield_overlap`` is negative, the 4 % is soon exceeded and ``dissipated(0)`` is
    not 0: the model no longer holds.

    Thornton and Ning (1998), Powder Technology 99, 154-162.
    """

    radius: Real = quantity()
    modulus: Real = quantity()
    work: Real = quantity()
    yield_pressure: Real = quantity()

    @property
    def yield_overlap(self) -> jax.Array:
        """Overlap at which yield begins [m]; below 0 if it yields on touching."""
        root = self._yield_root
        return root**4 / self.radius - pi * self._suction / self.modulus * root

    def loading_force(self, overlap: jax.Array) -> jax.Array:
        """Force [N] while pressed to this overlap for the first time."""
        root = self._root(overlap)
        plastic = self._truncated(root, self._ring(root))
        elastic = self._virgin.bonded_force(-jnp.minimum(overlap, self.yield_overlap))
        return jnp.where(overlap > self.yield_overlap, plastic, elastic)

    def loading_energy(self, overlap: jax.Array) -> jax.Array:
        """Energy [J] of `Jkr` at yield, and the work of the loading force from there."""
        elastic = self._virgin.bonded_energy(-jnp.minimum(overlap, self.yield_overlap))
        return elastic + self._plastic_work(overlap)

    @jax.jit  # here and below: traced once, however often it is asked
    def tip_radius(self, deepest: jax.Array) -> jax.Array:
        """Tip radius [m] of the contact that unloads from the deepest overlap."""
        root = self._root(deepest)
        adhesion = 2.0 * pi * self._suction * root**3
        hertz = self._truncated(root, self._ring(root)) + adhesion
        flattened = 4.0 * self.modulus * root**6 / (3.0 * hertz)
        return jnp.where(deepest > self.yield_overlap, flattened, self.radius)

    @jax.jit
    def residual(self, deepest: jax.Array) -> jax.Array:
        """Overlap [m] at which the flattened, undeformed tip just touches the plane."""
        curvature = 1.0 / self.radius - 1.0 / self.tip_radius(deepest)
        return self._root(deepest) ** 4 * curvature

    def tip(self, deepest: jax.Array) -> Jkr:
        """The elastic contact of the tip that unloads from the deepest overlap."""
        return Jkr(self.tip_radius(deepest), self.modulus, self.work)

    def force(self, gap: jax.Array, deepest: jax.Array) -> jax.Array:
        """Force [N] of the bonded contact at a gap [m] not deeper than the deepest overlap."""
        return self.tip(deepest).bonded_force(gap + self.residual(deepest))

    def energy(self, gap: jax.Array, deepest: jax.Array) -> jax.Array:
        """Energy [J] of the bonded contact that unloading gives back."""
        return self.tip(deepest).bonded_energy(gap + self.residual(deepest))

    def dissipated(self, deepest: jax.Array) -> jax.Array:
        """Energy [J] that plastic flow has taken, 0 until yield."""
        lost = self.loading_energy(deepest) - self.energy(-deepest, deepest)
        return jnp.where(deepest > self.yield_overlap, lost, 0.0)

    @property
    def _virgin(self) -> Jkr:
        return Jkr(self.radius, self.modulus, self.work)

    @property
    def _rise(self) -> jax.Array:
        """Compression at the centre per contact radius, A/a [Pa/m]."""
        return 2.0 * self.modulus / (pi * self.radius)

    @property
    def _suction(self) -> jax.Array:
        """Adhesive tension at the centre times the root of the contact radius [Pa m^0.5]."""
        return jnp.sqrt(2.0 * self.work * self.modulus / pi)

    @property
    def _yield_root(self) -> jax.Array:
        """Root u of the contact radius at yield: rise u^3 - p_y u - suction = 0, one root > 0."""
        return _cubic_root(self.yield_pressure / self._rise, self._suction / self._rise)

    @jax.jit
    def _root(self, overlap: jax.Array) -> jax.Array:
        """Root of the contact radius [m^0.5] at an overlap, at yield's below it."""
        beyond = jnp.maximum(overlap, self.yield_overlap)
        return jnp.sqrt(self._virgin.contact_radius(-beyond))

    def _ring(self, root: jax.Array) -> jax.Array:
        """Length q [m] from p_y = A s - B/s: rise q^2 - p_y q - suction root = 0."""
        pressure = self.yield_pressure
        bent = jnp.sqrt(pressure**2 + 4.0 * self._rise * self._suction * root)
        return (pressure + bent) / (2.0 * self._rise)

    def _truncated(self, root: jax.Array, ring: jax.Array) -> jax.Array:
        """Integral of the truncated pressure over the contact [N]."""
        capped = self.yield_pressure * (root**4 - ring**2 / 3.0)
        return pi * (capped - 4.0 / 3.0 * self._suction * root * ring)

    def _plastic_work(self, overlap: jax.Array) -> jax.Array:
        """Work [J] of the loading force from yield to an overlap, 0 below it.

        Root and ring are polynomials of x = root/(2 rise ring), the integrand one of degree
        15: eight nodes are exact.
        """
        bend = self._rise * self._suction
        start = self._yield_root
        first = start / (2.0 * self._rise * self._ring(start))
        last = self._root(overlap)
        half = (last / (2.0 * self._rise * self._ring(last)) - first)[..., None] / 2.0
        x = first + half * (1.0 + _NODES)
        ring = (self.yield_pressure + 2.0 * bend * x) / self._rise
        root = 2.0 * self._rise * x * ring
        sinking = 4.0 * root**3 / self.radius - pi * self._suction / self.modulus
        widening = 2.0 * self.yield_pressure + 8.0 * bend * x
        work = jnp.sum(_WEIGHTS * half * self._truncated(root, ring) * sinking * widening, -1)
        return jnp.where(overlap > self.yield_overlap, work, 0.0)
