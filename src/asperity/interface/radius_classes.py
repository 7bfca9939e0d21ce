"""Asperities of several tip radii, in classes that each have a memory of their own."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from math import ceil
from typing import Any

import equinox as eqx
import numpy as np

from .._jax import jax, jnp
from ..inputs import CLASSES
from ..laws.law import Law
from ..surfaces.heights.panel_length import PanelLengths
from .height_quadrature import Near
from .interface import Interface
from .major_branches import BranchTable, branch_tables
from .named_means import bond_gaps
from .rough_planes import Means, Memory, RoughPlanes, Scale

_FEW = 4  # pieces of bonds that are not of the branch


class RadiusClasses(RoughPlanes):
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
    that differ from it; see :mod:`asperity.interface.major_branches`.
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
    def laws(self) -> tuple[Law, ...]:
        """Their laws, a number for each class in each."""
        return self.stacked.laws

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
        return self.stacked.mechanisms * self.count

    @property
    def panel_lengths(self) -> PanelLengths:
        return self.stacked.panel_lengths

    @property
    def interaction_range(self) -> jax.Array:
        return jnp.max(jax.vmap(lambda part: part.interaction_range)(self.stacked))

    @property
    def last_kink(self) -> jax.Array:
        return jnp.max(jax.vmap(lambda part: part.last_kink)(self.stacked))

    @property
    def scale(self) -> Scale:
        return Scale.largest([part.scale for part in self.parts])

    def remember(self, memory: Memory, separation: jax.Array) -> Memory:
        shares = zip(self.parts, self._shares(memory), strict=True)
        return tuple(b for part, own in shares for b in part.remember(own, separation))

    def work_of_approach(self, separation: jax.Array, integrated: int = 0) -> jax.Array:
        if not self.tables:
            return super().work_of_approach(separation, integrated)
        return self._sum([table(separation, integrated)[-1] for table in self.tables])

    @property
    def only_bonded(self) -> bool:
        return self.stacked.only_bonded

    def measure(
        self, separation: jax.Array, memory: Memory, integrated: int = 0, near: Near | None = None
    ) -> Means:
        """Places ``near`` one another that are level lie on a major branch."""
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
        if self.tables:
            rows = self._rows(separation, memory, integrated)
            return self._sum([jnp.sum(values[:-1], axis=0) for values in rows])
        each = self._each(lambda part, own: part.pressure(separation, own, integrated), memory)
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

        def beside(places: jax.Array) -> list[jax.Array]:
            def one(part: Interface, own: Memory) -> list[jax.Array]:
                out = []
                for k, edge in enumerate(bond_gaps(part.laws, places, own)):
                    found = part.beside(k, edge, places, integrated, self.pieces)
                    rows = [found[name] for name in (*self.tables[k].names, "energy")]
                    out.append(part.density * jnp.stack(rows))
                return out

            return [jnp.sum(rest, axis=0) for rest in self._each(one, memory)]

        if near is None or self.pieces <= _FEW:
            more = beside(separation)
        else:  # one row of places after the other: that many nodes of all take gigabytes
            more = [jnp.moveaxis(rest, 0, 1) for rest in jax.lax.map(beside, separation)]
        return [
            table(separation, integrated) + rest
            for table, rest in zip(self.tables, more, strict=True)
        ]

    @staticmethod
    def _sum(values: list[jax.Array]) -> jax.Array:
        return jnp.sum(jnp.stack(values), axis=0)

    def losses(self) -> tuple[jax.Array, jax.Array]:
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


def members(radii: np.ndarray, classes: int = CLASSES) -> list[np.ndarray]:
    """Indices of the summits of each class of tip radius, the smallest radii first."""
    order = np.argsort(radii, kind="stable")
    share = np.cumsum(radii[order] ** (2.0 / 3.0))
    number = np.minimum((classes * share / share[-1]).astype(int), classes - 1)
    return [order[number == k] for k in range(classes) if np.any(number == k)]
