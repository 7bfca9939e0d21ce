"""Pressure and energy between rough planes on one major branch, tabulated over separation."""

from __future__ import annotations

import numpy as np
from numpy.polynomial import chebyshev

from .._jax import jax, jnp
from ..laws.law import Law
from ..numerics.polynomials import NODES, chebyshev_sum, from_points, local
from ..surfaces.heights.panel_length import PanelLengths
from .height_quadrature import Near
from .rough_planes import Means, Memory, RoughPlanes, Scale

_TO_COEFFICIENTS = from_points(NODES)
_SLOPE = np.arange(NODES) ** 2 * (-1.0) ** np.arange(1, NODES + 1)  # at the lower end
_SMALL = 1e-3  # of the largest pressure
_TAIL = 2.0  # power with which attraction across a gap falls: that of an asperity, beyond the table


class BranchPressure(RoughPlanes):
    """Rough planes whose means are read from a table, where there are many rings to solve.

    Parameters
    ----------
    planes
        The planes; integrated means are theirs.
    memory
        Memory on the branch, one threshold [m] a law.
    ends
        Ends of the table's panels [m], ascending. Below them the pressure goes on along its slope,
        above like that of surface forces.
    """

    planes: RoughPlanes
    ends: jax.Array
    parts: jax.Array
    others: jax.Array

    def __init__(self, planes: RoughPlanes, memory: Memory, ends: jax.Array) -> None:
        nodes = 0.5 + 0.5 * chebyshev.chebpts1(NODES)
        places = ends[:-1, None] + jnp.diff(ends)[:, None] * nodes
        each = tuple(jnp.broadcast_to(threshold, places.shape) for threshold in memory)
        self.planes, self.ends = planes, ends
        means = planes.measure(places, each)
        others = [means.energy, *means.bonds, means.contacting]
        # Apart, so that what is not read is not computed either.
        self.parts, self.others = (
            jnp.einsum("kn,qpn->kpq", _TO_COEFFICIENTS, jnp.stack(list(rows)))
            for rows in (means.parts, others)
        )

    @property
    def error(self) -> jax.Array:
        """The last coefficients of the pressure over the largest pull or push around."""
        pressure = jnp.abs(jnp.sum(self.parts, axis=2))
        last = jnp.max(pressure[-2:], axis=0)
        return jnp.max(last / (pressure[0] + _SMALL * jnp.max(pressure[0])))

    def _read(self, separation: jax.Array, coefficients: jax.Array) -> jax.Array:
        """Values with such coefficients, (NODES, panels, ...), at separations of shape (n,)."""
        ends, shape = self.ends, jnp.shape(separation)
        separation = jnp.ravel(separation)
        panel = jnp.clip(jnp.searchsorted(ends, separation) - 1, 0, len(ends) - 2)
        x = local(ends[panel], ends[panel + 1], separation)
        more = coefficients.ndim - 2
        wide = x.reshape(-1, *(1,) * more)
        found = chebyshev_sum(coefficients[:, panel], jnp.clip(wide, -1.0, 1.0))
        slope = jnp.tensordot(_SLOPE, coefficients[:, 0], axes=1)
        below = jnp.minimum(separation - ends[0], 0.0) * 2.0 / (ends[1] - ends[0])
        beyond = jnp.maximum(separation / ends[-1], 1.0).reshape(wide.shape)
        found = (found + slope * below.reshape(wide.shape)) * beyond**-_TAIL
        return found.reshape(*shape, *found.shape[1:])

    def pressure(self, separation: jax.Array, memory: Memory, integrated: int = 0) -> jax.Array:
        if integrated:
            return self.planes.pressure(separation, memory, integrated)
        return self._read(separation, jnp.sum(self.parts, axis=2))

    @property
    def laws(self) -> tuple[Law, ...]:
        return self.planes.laws

    @property
    def scale(self) -> Scale:
        return self.planes.scale

    @property
    def panel_lengths(self) -> PanelLengths:
        return self.planes.panel_lengths

    def remember(self, memory: Memory, separation: jax.Array) -> Memory:
        return self.planes.remember(memory, separation)

    def measure(
        self, separation: jax.Array, memory: Memory, integrated: int = 0, near: Near | None = None
    ) -> Means:
        if integrated:
            return self.planes.measure(separation, memory, integrated, near)
        parts, rows = (
            jnp.moveaxis(self._read(separation, coefficients), -1, 0)
            for coefficients in (self.parts, self.others)
        )
        return Means(parts, rows[0], rows[1:-1], rows[-1])
