"""Distributions of asperity heights above their mean plane."""

from __future__ import annotations

import abc
from math import sqrt
from typing import ClassVar

import equinox as eqx

from ..._jax import jax, jnp
from ...laws.law import Powers, Real, quantity
from ...numerics.height_integrals import height_integral, integrals_at, normal_density, order_ratio
from .panel_length import PanelLengths


class Heights(eqx.Module):
    """Distribution of heights z [m] above the mean plane.

    Besides the density phi it gives its repeated tail integrals
    T_0 = phi, T_k(x) = int_x^inf T_(k-1): means over a plane use T_0, forces on a
    rigid paraboloid T_1.
    """

    cuts: ClassVar[int] = 1
    """Into how many each piece of a quadrature over Gaussian heights is cut."""

    @property
    def panel_lengths(self) -> PanelLengths:
        """How finely the curves are cut that it makes. Without values."""
        return PanelLengths()

    @property
    @abc.abstractmethod
    def rms(self) -> jax.Array | float:
        """Root mean square height [m]."""

    @property
    @abc.abstractmethod
    def top(self) -> jax.Array | float:
        """Height [m] above which next to none is."""

    @property
    @abc.abstractmethod
    def bottom(self) -> jax.Array | float:
        """Height [m] below which next to none is."""

    @abc.abstractmethod
    def highest_beside(self, height: jax.Array) -> jax.Array:
        """Height [m] above which all together weigh nothing against those above ``height``."""

    @abc.abstractmethod
    def tail(self, order: int, height: jax.Array, size: float = 0.0) -> jax.Array:
        """T_order at ``height`` [m], in m^(order-1); ``order`` 0, 1, 2, ... is static.

        Where asperities differ in tip radius too, each counts by the power ``size`` (static) of
        its radius over that of the law.
        """

    @abc.abstractmethod
    def mean_powers(
        self,
        terms: Powers,
        order: int,
        separation: jax.Array,
        sizes: tuple[float, ...] | None = None,
    ) -> jax.Array:
        """Integrals of ``term(g) T_order(separation - g)`` over all gaps g.

        One row a term, each of the shape of ``separation``; ``sizes`` as in :meth:`tail`, one a
        term, 0 by default.
        """


def _name(edge: jax.Array | float) -> float | int:
    """The same for edges that are the same number or array."""
    return edge if isinstance(edge, float) else id(edge)


_WINDOW = 8.6  # heights beyond this many rms weigh less than 1e-16


class Gaussian(Heights):
    """Gaussian heights. Greenwood and Williamson (1966); the publication's eq. 6.

    Parameters
    ----------
    rms_height
        Standard deviation sigma of the heights [m].
    mean_height
        Their mean above the plane that separations count from [m].
    """

    rms_height: Real = quantity()
    mean_height: Real = quantity(0.0)

    @property
    def rms(self) -> jax.Array | float:
        return self.rms_height

    @property
    def top(self) -> jax.Array | float:
        return self.mean_height + 9.0 * self.rms_height

    @property
    def bottom(self) -> jax.Array | float:
        return self.mean_height - _WINDOW * self.rms_height

    def highest_beside(self, height: jax.Array) -> jax.Array:
        above = jnp.maximum(height - self.mean_height, 0.0)
        return self.mean_height + jnp.hypot(above, _WINDOW * self.rms_height)

    def tail(self, order: int, height: jax.Array, size: float = 0.0) -> jax.Array:
        x = (height - self.mean_height) / self.rms_height
        if order == 0:
            return normal_density(x) / self.rms_height
        if order == 1:
            return 0.5 * jax.lax.erfc(x / sqrt(2.0))
        scale = self.rms_height ** (order - 1) * order_ratio(0.0, order - 1)
        return scale * height_integral(order - 1.0, x)

    def mean_powers(
        self,
        terms: Powers,
        order: int,
        separation: jax.Array,
        sizes: tuple[float, ...] | None = None,
    ) -> jax.Array:
        sigma, above = self.rms_height, separation - self.mean_height
        # Terms share edges and orders: each order at each edge once.
        edges = {_name(t.edge): t.edge for t in terms}
        pairs = [(_name(t.edge), t.exponent + order) for t in terms]
        orders = {edge: tuple(dict.fromkeys(n for e, n in pairs if e == edge)) for edge in edges}
        reduced = jnp.stack([jnp.broadcast_to(above - e, separation.shape) for e in edges.values()])
        found = integrals_at(tuple(orders.values()), reduced / sigma)
        row = {pair: k for k, pair in enumerate((e, n) for e in orders for n in orders[e])}
        values = [found[row[pair]] for pair in pairs]
        scale = [
            t.coefficient * sigma ** (t.exponent + order) * order_ratio(t.exponent, order)
            for t in terms
        ]
        return jnp.stack([c * v for c, v in zip(scale, values, strict=True)])
