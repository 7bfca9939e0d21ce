"""Asperities of several tip radii, in classes that each have a memory of their own."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from math import ceil
from typing import Any, NamedTuple

import equinox as eqx
import numpy as np

from .._jax import jax, jnp
from ..inputs import CLASSES
from ..laws.law import Law, terms
from ..surfaces.heights.panel_length import PanelLengths
from .class_bonds import ClassBonds
from .height_quadrature import Asked, Near
from .interface import Interface, Means, Memory
from .major_branches import BranchTable, branch_tables


class Scale(NamedTuple):
    """How rough several interfaces are together: largest rms height and highest height [m]."""

    rms: jax.Array
    top: jax.Array


class RadiusClasses(eqx.Module):
    """Asperities of several tip radii: an interface for each class of radius, side by side.

    For laws whose gaps depend on the radius, so that bonds of different radii need a memory
    each. Every asperity belongs to one class.

    Parameters
    ----------
    parts
        The interfaces, with the same kinds of laws and of heights.
    tabulated
        Whether their major branches are tabulated where they can be (static): of measured
        heights on the same nodes. Else every mean is a quadrature.

    Notes
    -----
    A mean is that of the branch of approach, read from the table, and a quadrature over the bonds
    that differ from it; see :mod:`asperity.interface.major_branches`. On a scanning curve that
    quadrature is read at a few places of each class.
    """

    stacked: Interface
    tables: tuple[BranchTable, ...]
    count: int = eqx.field(static=True)
    pieces: int = eqx.field(static=True)

    def __init__(self, parts: Sequence[Interface], *, tabulated: bool = True) -> None:
        self.stacked = jax.tree_util.tree_map(lambda *leaves: jnp.stack(leaves), *parts)
        self.count = len(parts)
        self.pieces = _pieces(parts)
        self.tables = branch_tables(self.stacked) if tabulated else ()

    @property
    def law(self) -> Law:
        """Their laws, a number for each class in each."""
        return self.stacked.law

    @property
    def parts(self) -> tuple[Interface, ...]:
        """The classes one by one."""
        return tuple(
            jax.tree_util.tree_map(lambda leaf, k=k: leaf[k], self.stacked)
            for k in range(self.count)
        )

    @property
    def hysteretic(self) -> tuple[Law, ...]:
        """The laws that remember, class after class."""
        return tuple(law for part in self.parts for law in part.hysteretic)

    @property
    def mechanisms(self) -> tuple[str, ...]:
        """Names under which losses are booked."""
        return self.stacked.mechanisms * self.count

    @property
    def components(self) -> tuple[str, ...]:
        """Mechanisms of the forces, elastic first."""
        return self.stacked.components

    @property
    def panel_lengths(self) -> PanelLengths:
        """How finely its curves are cut. Without values."""
        return self.stacked.panel_lengths

    @property
    def error_floor(self) -> float:
        """Relative error of curves below which nothing is gained. Without values."""
        return self.stacked.error_floor

    @property
    def interaction_range(self) -> jax.Array:
        """Gap [m] beyond which no law pulls by more than 1e-6 of its largest pull."""
        return jnp.max(jax.vmap(lambda part: part.interaction_range)(self.stacked))

    @property
    def last_kink(self) -> jax.Array:
        """Gap [m] beyond which all laws are smooth."""
        return jnp.max(jax.vmap(lambda part: part.last_kink)(self.stacked))

    @property
    def heights(self) -> Scale:
        """What their heights are on the whole."""
        return scale_of([part.heights for part in self.parts])

    def initial_memory(self, place: jax.Array | float = 0.0) -> Memory:
        """Memory of surfaces that have never touched, one threshold per ``place``."""
        return self.stacked.initial_memory(place) * self.count

    def saturated_memory(self, place: jax.Array | float = 0.0) -> Memory:
        """Saturated memory, on the major unloading branch: all bonds that can hold do."""
        return self.stacked.saturated_memory(place) * self.count

    def remember(self, memory: Memory, separation: jax.Array) -> Memory:
        """The memory after the separation moved monotonically to ``separation`` [m]."""
        shares = zip(self.parts, self._shares(memory), strict=True)
        return tuple(b for part, own in shares for b in part.remember(own, separation))

    @property
    def yields(self) -> bool:
        """Whether what was pressed once stays changed. Without values."""
        return self.stacked.yields

    def has_yielded(self, memory: Memory) -> jax.Array:
        """Whether anything was pressed so that it stays changed."""
        return self.stacked.has_yielded(memory)

    def swept(self, memory: Memory, unloading: jax.Array | bool) -> Memory:
        """The memory on a major branch; see :meth:`Interface.swept`."""
        return self.stacked.swept(memory, unloading)

    def merging(self, memory: Memory, unloading: jax.Array) -> list[jax.Array]:
        """Separations [m] at which the bonds of each law reach the major branch."""
        shares = zip(self.parts, self._shares(memory), strict=True)
        return [d for part, own in shares for d in part.merging(own, unloading)]

    def work_of_approach(self, separation: jax.Array, integrated: int = 0) -> jax.Array:
        """Work per area [J/m^2] that bringing free surfaces to a separation takes, at least."""
        if not self.tables:
            return self.energy(separation, self.initial_memory(), integrated)
        return self._sum([table(separation, integrated)[-1] for table in self.tables])

    @property
    def only_bonded(self) -> bool:
        """Whether every law without truncated powers ends with its bonds. Without values."""
        return self.stacked.only_bonded

    def measure(
        self, separation: jax.Array, memory: Memory, integrated: int = 0, near: Near | None = None
    ) -> Means:
        """All means over the heights; see :meth:`Interface.measure`.

        Places ``near`` one another that are level lie on a major branch.
        """
        if not self.tables:
            each = self._each(
                lambda part, own: part.measure(separation, own, integrated, near), memory
            )
            sums = jax.tree_util.tree_map(lambda leaf: jnp.sum(leaf, axis=0), each)
            bonds = each.bonds.reshape(-1, *each.bonds.shape[2:])
            return Means(sums.parts, sums.energy, bonds, sums.contacting)
        rows = self._rows(separation, memory, integrated, near)
        parts: dict[str, list[jax.Array]] = {name: [] for name in self.components}
        for table, values in zip(self.tables, rows, strict=True):
            for name, value in zip(table.names, values, strict=False):
                parts[name].append(value)
        contacting, bonds = self._each(
            lambda part, own: part.counted(separation, own, integrated), memory
        )
        return Means(
            parts=jnp.stack([self._sum(values) for values in parts.values()]),
            energy=self._sum([values[-1] for values in rows]),
            bonds=bonds.reshape(-1, *separation.shape),
            contacting=jnp.sum(contacting, axis=0),
        )

    def pressure(self, separation: jax.Array, memory: Memory, integrated: int = 0) -> jax.Array:
        """Mean pressure [Pa], positive when it pushes apart (``integrated`` 1: N per 2 pi R)."""
        if self.tables:
            rows = self._rows(separation, memory, integrated)
            return self._sum([jnp.sum(values[:-1], axis=0) for values in rows])
        each = self._each(lambda part, own: part.pressure(separation, own, integrated), memory)
        return jnp.sum(each, axis=0)

    def energy(self, separation: jax.Array, memory: Memory, integrated: int = 0) -> jax.Array:
        """Stored energy per area [J/m^2], 0 for free surfaces far apart."""
        if self.tables:
            rows = self._rows(separation, memory, integrated)
            return self._sum([values[-1] for values in rows])
        each = self._each(lambda part, own: part.energy(separation, own, integrated), memory)
        return jnp.sum(each, axis=0)

    def _rows(
        self, separation: jax.Array, memory: Memory, integrated: int, near: Near | None = None
    ) -> list[jax.Array]:
        """Forces and energy of each law, as its table has them."""
        laws = len(self.tables)
        if near is not None and near.level:
            return [
                table(separation, integrated, jnp.isneginf(b))
                for table, b in zip(self.tables, memory[:laws], strict=True)
            ]

        def beside(part: Interface, own: Memory) -> list[jax.Array]:
            out = []
            for law, threshold, table in zip(terms(part.law), own, self.tables, strict=True):
                asked = Asked((*table.names, "energy"), integrated)
                bonds = ClassBonds(law, part.heights, asked, self.pieces)
                if near is None:
                    out.append(part.density * bonds.at(threshold, separation))
                else:
                    out.append(part.density * bonds.along(threshold, separation, near.nodes))
            return out

        more = self._each(beside, memory)
        return [
            table(separation, integrated) + jnp.sum(rest, axis=0)
            for table, rest in zip(self.tables, more, strict=True)
        ]

    @staticmethod
    def _sum(values: list[jax.Array]) -> jax.Array:
        return jnp.sum(jnp.stack(values), axis=0)

    def losses(self) -> tuple[jax.Array, jax.Array]:
        """Energy [J] lost when one bond forms, and when it breaks, per hysteretic law."""
        formation, rupture = jax.vmap(lambda part: part.losses())(self.stacked)
        return formation.ravel(), rupture.ravel()

    def _each(self, value: Callable[[Interface, Memory], Any], memory: Memory) -> Any:
        """A value of all classes, their axis first."""
        shares = self._shares(memory)
        rows = tuple(jnp.stack(each) for each in zip(*shares, strict=True))
        return jax.vmap(value)(self.stacked, rows)

    def _shares(self, memory: Memory) -> list[Memory]:
        """The memory of each class."""
        laws = len(memory) // self.count
        return [memory[k * laws : (k + 1) * laws] for k in range(self.count)]


def _pieces(parts: Sequence[Interface]) -> int:
    """Pieces of the quadratures over the bonds of a class; two where values are traced."""
    if any(isinstance(leaf, jax.core.Tracer) for leaf in jax.tree_util.tree_leaves(parts)):
        return 2
    part = parts[-1]  # of the largest radii
    widths = [float(law.breaking_gap - law.forming_gap) for law in part.hysteretic]
    rms = float(part.heights.rms)
    nodes, pieces = part.panel_lengths.along(max(widths, default=0.0) / rms if rms > 0.0 else 0.0)
    return ceil(nodes * pieces / 16)


def scale_of(heights: Sequence[Any]) -> Scale:
    """The largest rms height and the highest height among several distributions."""
    return Scale(
        jnp.max(jnp.stack([jnp.asarray(each.rms) for each in heights])),
        jnp.max(jnp.stack([jnp.asarray(each.top) for each in heights])),
    )


def members(radii: np.ndarray, classes: int = CLASSES) -> list[np.ndarray]:
    """Indices of the summits of each class of tip radius, the smallest radii first."""
    order = np.argsort(radii, kind="stable")
    share = np.cumsum(radii[order] ** (2.0 / 3.0))
    number = np.minimum((classes * share / share[-1]).astype(int), classes - 1)
    return [order[number == k] for k in range(classes) if np.any(number == k)]
