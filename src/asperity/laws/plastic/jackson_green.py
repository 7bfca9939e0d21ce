"""Yielding sphere whose mean pressure follows the shape of its contact."""

from __future__ import annotations

from math import pi

import numpy as np

from ..._jax import jax, jnp
from ..law import Real, quantity
from .plastic_contact import EtsionUnloading, power

_CHANGE = 1.9  # over the critical overlap: where the published law changes from Hertz's to the fit
_STEPS = 10  # of Newton's method; seven reach rounding for Poisson ratios of 0 to 0.5
_STRETCH = 7.2  # in x^(1/7.2) the fit is powers and their exponentials, but for the hardness
_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(24)


class JacksonGreen(EtsionUnloading):
    """Jackson and Green's contact of an elastic, perfectly plastic sphere and a rigid plane.

    Parameters
    ----------
    radius
        Radius at the tip [m].
    modulus
        Contact modulus E* [Pa].
    yield_strength
        Yield strength S of the body that yields [Pa].
    poisson
        Poisson ratio of that body.

    Notes
    -----
    With C = 1.295 exp(0.736 poisson), e = S/E*, the critical overlap d = (pi C e/2)^2 radius
    and x the overlap over d, the force over (4/3) E* sqrt(radius) d^1.5 is x^1.5 up to 1.9 and
    beyond::

        exp(-x^(5/12)/4) x^1.5 + 4 H/(C S) (1 - exp(-x^(5/9)/25)) x

    The mean pressure H of full plasticity falls as the contact radius a grows to the tip's:
    H/S = 2.84 (1 - exp(-0.82 (a/radius)^-0.7)), a/radius = (pi C e/2) sqrt(x) (x/1.9)^(B/2),
    B = 0.14 exp(23 e). Jackson and Green (2005).

    At 1.9 the published law jumps: for S/E* up to 0.01 and a Poisson ratio of 0 by +7.5 %, 0.3
    by +0.5 %, 0.5 by -3.4 %; while it lies above Hertz's it would give energy back. Here Hertz's
    law holds up to the overlap at which the fit meets it, 4.1 d, 2.0 d and 1.3 d, and the fit
    beyond. The force is continuous, and as published but for overlaps between that one and
    1.9 d. Etsion's unloading is counted from there too, so that nothing is lost below it.
    """

    yield_strength: Real = quantity()
    poisson: Real = quantity()

    @property
    def yield_coefficient(self) -> jax.Array:
        """C: the largest Hertz pressure when yield begins, over the yield strength."""
        return 1.295 * jnp.exp(0.736 * self.poisson)

    @property
    def critical_overlap(self) -> jax.Array:
        """Overlap [m] at which the material below the surface begins to yield."""
        return self._slope**2 * self.radius

    @property
    def yield_overlap(self) -> jax.Array:
        return self._meeting * self.critical_overlap

    def loading_force(self, overlap: jax.Array) -> jax.Array:
        return self._changing_at(self._meeting, overlap)

    def loading_work(self, overlap: jax.Array) -> jax.Array:
        x, meeting = overlap / self.critical_overlap, self._meeting
        elastic = 0.4 * power(jnp.minimum(x, meeting), 2.5)
        reduced = elastic + self._fitted_work(meeting, jnp.maximum(x, meeting))
        return self._critical_force * self.critical_overlap * reduced

    def published_force(self, overlap: jax.Array) -> jax.Array:
        """First loading [N] as published, with its jump at 1.9 critical overlaps."""
        return self._changing_at(jnp.asarray(_CHANGE), overlap)

    def _changing_at(self, change: jax.Array, overlap: jax.Array) -> jax.Array:
        x = overlap / self.critical_overlap
        beyond = self._fit(jnp.maximum(x, change))
        return self._critical_force * jnp.where(x <= change, power(x, 1.5), beyond)

    def _fit(self, x: jax.Array) -> jax.Array:
        """The law beyond yield, over the critical force."""
        spread = 0.14 * jnp.exp(23.0 * self.yield_strength / self.modulus)
        contact_radius = self._slope * jnp.sqrt(x) * (x / _CHANGE) ** (spread / 2.0)
        pressure = -2.84 * jnp.expm1(-0.82 * contact_radius**-0.7)
        elastic = jnp.exp(-(x ** (5.0 / 12.0)) / 4.0) * x**1.5
        plastic = -jnp.expm1(-(x ** (5.0 / 9.0)) / 25.0) * x
        return elastic + 4.0 / self.yield_coefficient * pressure * plastic

    def _fitted_work(self, start: jax.Array, end: jax.Array) -> jax.Array:
        """Integral of the fit from start to end: Gauss's rule, to 1e-11 of the work (tests)."""
        first, last = start ** (1.0 / _STRETCH), end ** (1.0 / _STRETCH)
        half = (last - first) / 2.0
        s = first + half * (1.0 + _NODES.reshape(-1, *[1] * half.ndim))
        density = self._fit(s**_STRETCH) * s ** (_STRETCH - 1.0)
        return _STRETCH * half * jnp.tensordot(_WEIGHTS, density, 1)

    @property
    def _meeting(self) -> jax.Array:
        """Overlap over the critical one at which the fit meets Hertz's law."""
        return _meeting(self)

    @property
    def _slope(self) -> jax.Array:
        """Contact radius over the tip's radius at the critical overlap."""
        return pi * self.yield_coefficient * self.yield_strength / (2.0 * self.modulus)

    @property
    def _critical_force(self) -> jax.Array:
        return self._stiffness * self.critical_overlap**1.5


@jax.jit
def _meeting(law: JacksonGreen) -> jax.Array:
    """Where the law's fit meets x^1.5: Newton's method in the logarithm of x.

    The last step alone is differentiated: it carries the root's derivatives by the law's
    constants. Compiled here, once, for callers that are not.
    """

    def excess(u: jax.Array) -> jax.Array:
        return jnp.log(law._fit(jnp.exp(u))) - 1.5 * u

    def step(_: int, u: jax.Array) -> jax.Array:
        value, slope = jax.jvp(excess, (u,), (jnp.ones_like(u),))
        return u - value / slope

    start = jnp.full_like(law._slope, np.log(_CHANGE))
    u = jax.lax.stop_gradient(jax.lax.fori_loop(0, _STEPS, step, start))
    slope = jax.lax.stop_gradient(jax.jvp(excess, (u,), (jnp.ones_like(u),))[1])
    return jnp.exp(u - excess(u) / slope)
