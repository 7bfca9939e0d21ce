"""Distributions of asperity heights above their mean plane."""

from __future__ import annotations

import abc

import equinox as eqx

from .._jax import jax, jnp
from ..laws.base import Powers, Real, quantity
from ..special import height_integral, height_integrals, normal_density, order_ratio


class Heights(eqx.Module):
    """Distribution of heights z [m] above the mean plane.

    Besides the density phi it gives its repeated tail integrals
    T_0 = phi, T_k(x) = int_x^inf T_(k-1): means over a plane use T_0, forces on a
    rigid paraboloid T_1.
    """

    @property
    @abc.abstractmethod
    def rms(self) -> jax.Array | float:
        """Root mean square height [m]."""

    @abc.abstractmethod
    def tail(self, order: int, height: jax.Array) -> jax.Array:
        """T_order at ``height`` [m], in m^(order-1); ``order`` 0, 1, 2, ... is static."""

    @abc.abstractmethod
    def mean_powers(self, terms: Powers, order: int, separation: jax.Array) -> jax.Array:
        """Integrals of ``term(g) T_order(separation - g)`` over all gaps g.

        One row a term, each of the shape of ``separation``.
        """


class Gaussian(Heights):
    """Gaussian heights. Greenwood and Williamson (1966); the publication's eq. 6.

    Parameters
    ----------
    rms_height
        Standard deviation sigma of the heights [m].
    """

    rms_height: Real = quantity()

    @property
    def rms(self) -> jax.Array | float:
        return self.rms_height

    def tail(self, order: int, height: jax.Array) -> jax.Array:
        x = height / self.rms_height
        if order == 0:
            return normal_density(x) / self.rms_height
        scale = self.rms_height ** (order - 1) * order_ratio(0.0, order - 1)
        return scale * height_integral(order - 1.0, x)

    def mean_powers(self, terms: Powers, order: int, separation: jax.Array) -> jax.Array:
        sigma = self.rms_height
        reduced = jnp.stack(
            [jnp.broadcast_to(separation - t.edge, separation.shape) for t in terms]
        )
        values = height_integrals(tuple(t.exponent + order for t in terms), reduced / sigma)
        scale = [
            t.coefficient * sigma ** (t.exponent + order) * order_ratio(t.exponent, order)
            for t in terms
        ]
        return jnp.stack([c * v for c, v in zip(scale, values, strict=True)])
