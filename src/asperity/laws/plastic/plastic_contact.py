"""What a contact that yields is: a loading law, and the curve on which it unloads."""

from __future__ import annotations

import abc

import equinox as eqx

from ..._jax import jax, jnp
from ..law import Real, quantity

_LEAST = 1e-12  # over the yield overlap: less is the rounding of a place where contact begins
_STEPS = 4  # of Newton's method; three reach rounding, the logarithms are nearly straight


def power(base: jax.Array, exponent: jax.Array | float) -> jax.Array:
    """``base**exponent`` where the base is positive, else 0, with finite derivatives."""
    inside = base > 0.0
    # Spelled out, so that several powers of one base share its logarithm.
    logarithm = jnp.log(jnp.where(inside, base, 1.0))
    return jnp.where(inside, jnp.exp(exponent * logarithm), 0.0)


class PlasticContact(eqx.Module):
    """One asperity that yields under a plane, without adhesion.

    The first loading follows ``loading_force``. Once the *overlap* has been as large as
    *deepest*, unloading and loading again follow, up to there, the reversible curve::

        force(deepest) * ((overlap - residual) / (deepest - residual))**exponent

    and nothing where the overlap is below the residual overlap. A contact that was never
    deeper than ``yield_overlap`` is Hertz's and loses nothing.

    Overlap and deepest [m]: how far the plane stands behind the tip of the undeformed
    asperity, 0 or below when apart, the overlap not above the deepest. Force [N]: positive
    when it pushes apart. Energy [J]. Arrays of any shape; everything works under ``jit``,
    ``vmap`` and ``grad``.

    Parameters
    ----------
    radius
        Radius at the tip [m].
    modulus
        Contact modulus E* [Pa].
    """

    radius: Real = quantity()
    modulus: Real = quantity()

    @property
    @abc.abstractmethod
    def yield_overlap(self) -> jax.Array:
        """Overlap [m] up to which the contact is elastic."""

    @property
    def kinks(self) -> tuple[jax.Array, ...]:
        """Overlaps [m] at which the loading law is not smooth, ascending from the yield's."""
        return (self.yield_overlap,)

    @abc.abstractmethod
    def loading_force(self, overlap: jax.Array) -> jax.Array:
        """Force [N] when the contact is loaded for the first time."""

    @abc.abstractmethod
    def loading_work(self, overlap: jax.Array) -> jax.Array:
        """Work [J] of the first loading: the integral of its force from overlap 0."""

    @abc.abstractmethod
    def residual(self, deepest: jax.Array) -> jax.Array:
        """Overlap [m] at which an unloaded contact parts; 0 where it never yielded."""

    @abc.abstractmethod
    def exponent(self, deepest: jax.Array) -> jax.Array:
        """Exponent of the unloading curve; 1.5 where the contact never yielded."""

    def force(self, overlap: jax.Array, deepest: jax.Array) -> jax.Array:
        """Force [N] of a contact that has been as deep as ``deepest``."""
        deep = jnp.maximum(deepest, self.yield_overlap)
        return self.loading_force(deep) * power(self._share(overlap, deep), self.exponent(deep))

    def unloading(self, deepest: jax.Array) -> tuple[jax.Array, jax.Array]:
        """Logarithm of the force [N] one yield overlap above the residual, and the exponent.

        Of the curve that unloads from ``deepest``, continued to there.
        """
        deep = jnp.maximum(deepest, self.yield_overlap)
        order = self.exponent(deep)
        span = (deep - self.residual(deep)) / self.yield_overlap
        return jnp.log(self.loading_force(deep)) - order * jnp.log(span), order

    def recoverable(self, overlap: jax.Array, deepest: jax.Array) -> jax.Array:
        """Energy [J] that unloading from this overlap gives back."""
        deep = jnp.maximum(deepest, self.yield_overlap)
        order = self.exponent(deep) + 1.0
        whole = self.loading_force(deep) * (deep - self.residual(deep)) / order
        share = self._share(overlap, deep)
        return whole * share * power(share, order - 1.0)

    def returned(self, deepest: jax.Array) -> jax.Array:
        """Energy [J] that unloading from ``deepest`` gives back on the whole."""
        deep = jnp.maximum(deepest, self.yield_overlap)
        back = self.recoverable(deep, deep)
        return jnp.where(deepest > self.yield_overlap, back, self.loading_work(deepest))

    def dissipated(self, deepest: jax.Array) -> jax.Array:
        """Energy [J] lost by a contact that has been as deep as ``deepest``."""
        deep = jnp.maximum(deepest, self.yield_overlap)
        lost = self.loading_work(deep) - self.recoverable(deep, deep)
        return jnp.where(deepest > self.yield_overlap, lost, 0.0)

    def deepest(self, recovered: jax.Array) -> jax.Array:
        """Deepest overlap [m] of a contact that springs back by ``recovered`` [m] until it parts.

        The inverse of the deepest less its residual, by Newton's method in logarithms.
        """
        some = recovered > _LEAST * self.yield_overlap
        goal = jnp.where(some, recovered, self.yield_overlap)

        def sprung(deepest: jax.Array) -> jax.Array:
            return deepest - self.residual(deepest)

        deepest = goal
        for _ in range(_STEPS):
            back, slope = jax.jvp(sprung, (deepest,), (jnp.ones_like(deepest),))
            deepest = deepest * jnp.exp(jnp.log(goal / back) * back / (slope * deepest))
        return jnp.where(some, deepest, 0.0)

    @property
    def _stiffness(self) -> jax.Array:
        """Hertz force over overlap^1.5 [N/m^1.5]. Johnson (1985), eq. 4.23."""
        return 4.0 / 3.0 * self.modulus * jnp.sqrt(self.radius)

    def _share(self, overlap: jax.Array, deep: jax.Array) -> jax.Array:
        """How far along the unloading curve: 0 at the residual overlap, 1 at the deepest."""
        left = self.residual(deep)
        return jnp.maximum(overlap - left, 0.0) / (deep - left)


class EtsionUnloading(PlasticContact):
    """Unloading as fitted to finite elements of a sphere that a rigid plane pressed.

    With x the deepest overlap over that of yield: residual overlap over the deepest
    (1 - x^-0.28)(1 - x^-0.69), exponent 1.5 x^-0.0331. Etsion, Kligerman and Kadin (2005),
    for x up to 170.
    """

    def residual(self, deepest: jax.Array) -> jax.Array:
        depth = jnp.log(self._depth(deepest))
        return jnp.maximum(deepest, 0.0) * jnp.expm1(-0.28 * depth) * jnp.expm1(-0.69 * depth)

    def exponent(self, deepest: jax.Array) -> jax.Array:
        return 1.5 * jnp.exp(-0.0331 * jnp.log(self._depth(deepest)))

    def _depth(self, deepest: jax.Array) -> jax.Array:
        return jnp.maximum(deepest / self.yield_overlap, 1.0)
