"""The pressure between rough planes on one major branch, tabulated over their separation."""

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
_TAIL = 2.0  # power with which attraction across a gap falls: that of an asperity, beyond the table


class BranchPressure(RoughPlanes):
    """Rough planes whose pressure is read from a table, to guess what the planes themselves solve.

    Parameters
    ----------
    planes
        The planes; all but the pressure is theirs.
    memory
        Memory on the branch, one threshold [m] a law.
    ends
        Ends of the table's panels [m], ascending. Below them the pressure goes on along its slope,
        above like that of surface forces.
    """

    planes: RoughPlanes
    ends: jax.Array
    coefficients: jax.Array

    def __init__(self, planes: RoughPlanes, memory: Memory, ends: jax.Array) -> None:
        nodes = 0.5 + 0.5 * chebyshev.chebpts1(NODES)
        places = ends[:-1, None] + jnp.diff(ends)[:, None] * nodes
        each = tuple(jnp.broadcast_to(threshold, places.shape) for threshold in memory)
        self.planes, self.ends = planes, ends
        self.coefficients = jnp.asarray(_TO_COEFFICIENTS) @ planes.pressure(places, each).T

    def pressure(self, separation: jax.Array, memory: Memory, integrated: int = 0) -> jax.Array:
        if integrated:
            return self.planes.pressure(separation, memory, integrated)
        ends = self.ends
        panel = jnp.clip(jnp.searchsorted(ends, separation) - 1, 0, len(ends) - 2)
        x = local(ends[panel], ends[panel + 1], separation)
        found = chebyshev_sum(self.coefficients[:, panel], jnp.clip(x, -1.0, 1.0))
        first = self.coefficients[:, 0]
        slope = (np.arange(NODES) ** 2 * (-1.0) ** np.arange(1, NODES + 1)) @ first
        below = jnp.minimum(separation - ends[0], 0.0) * 2.0 / (ends[1] - ends[0])
        beyond = jnp.maximum(separation / ends[-1], 1.0)
        return (found + slope * below) * beyond**-_TAIL

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
        return self.planes.measure(separation, memory, integrated, near)
