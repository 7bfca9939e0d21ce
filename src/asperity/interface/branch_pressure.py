"""Pressure and energy between rough planes on one major branch, tabulated over separation."""

from __future__ import annotations

from .._jax import jax, jnp
from ..laws.law import Law
from ..surfaces.heights.panel_length import PanelLengths
from .height_quadrature import Near
from .panel_table import PanelTable, places_of
from .rough_planes import Means, Memory, RoughPlanes, Scale

_SMALL = 1e-3  # of the largest pressure


class BranchPressure(RoughPlanes):
    """Rough planes whose means are read from a table, where there are many rings to solve.

    Parameters
    ----------
    planes
        The planes; integrated means are theirs.
    memory
        Memory on the branch, one threshold [m] a law.
    ends
        Ends of the table's panels [m], ascending.
    """

    planes: RoughPlanes
    parts: PanelTable
    others: PanelTable

    def __init__(self, planes: RoughPlanes, memory: Memory, ends: jax.Array) -> None:
        places = places_of(ends)
        each = tuple(jnp.broadcast_to(threshold, places.shape) for threshold in memory)
        means = planes.measure(places, each)
        self.planes = planes
        # Apart, so that what is not read is not computed either.
        self.parts = PanelTable.through(ends, list(means.parts))
        others = [means.energy, *means.bonds, means.contacting]
        self.others = PanelTable.through(ends, others, energy=0)

    @property
    def error(self) -> jax.Array:
        """The last coefficients of the pressure over the largest pull or push around."""
        pressure = jnp.abs(self.parts.total().coefficients[..., 0])
        last = jnp.max(pressure[-2:], axis=0)
        return jnp.max(last / (pressure[0] + _SMALL * jnp.max(pressure[0])))

    def pressure(self, separation: jax.Array, memory: Memory, integrated: int = 0) -> jax.Array:
        if integrated:
            return self.planes.pressure(separation, memory, integrated)
        return self.parts.total()(separation)[0]

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
        rows = self.others(separation)
        return Means(self.parts(separation), rows[0], rows[1:-1], rows[-1])
