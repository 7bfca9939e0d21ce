"""Pressure and energy between two rough planes, with the memory of every bond."""

from __future__ import annotations

import dataclasses

import equinox as eqx

from .._jax import jax, jnp
from ..laws.law import Law, Powers, Real, TruncatedPower, quantity, terms
from ..surfaces.heights.distribution import Heights
from ..surfaces.heights.panel_length import PanelLengths
from .height_quadrature import Near, between, means, means_near
from .named_means import asked_powers, bond_gaps, means_of
from .panel_table import PanelTable, places_of
from .rough_planes import Means, Memory, RoughPlanes, Scale


class Interface(RoughPlanes):
    """Many asperities of random height between two planes.

    Parameters
    ----------
    law
        What one asperity does (a :class:`~asperity.laws.Law` or a sum of them).
    heights
        Distribution of their heights.
    density
        Asperities per area [1/m^2].
    approach
        Means of each law without truncated powers on the branch of approach, per asperity: its
        forces, by name, and the energy. Empty where they are integrated as they come.
    pieces
        As for :meth:`reading`.

    Notes
    -----
    Separation h [m] is the distance between the mean planes; the gap of an asperity of
    height z is h - z. Asperities differ in height alone, so the bonded ones are always
    those above a threshold b, which follows b <- clamp(b, h - g_break, h - g_form): a play
    operator, exact for any sequence of reversals (Visintin 1994; ``docs/theory``).
    """

    law: Law
    heights: Heights
    density: Real = quantity()
    approach: tuple[PanelTable | None, ...] = ()
    pieces: int = eqx.field(static=True, default=0)

    @property
    def laws(self) -> tuple[Law, ...]:
        return terms(self.law)

    @property
    def scale(self) -> Scale:
        return Scale.of(self.heights)

    @property
    def panel_lengths(self) -> PanelLengths:
        return self.heights.panel_lengths

    def remember(self, memory: Memory, separation: jax.Array) -> Memory:
        return tuple(separation - gap for gap in bond_gaps(self.hysteretic, separation, memory))

    @property
    def closed(self) -> bool:
        return all(type(law).powers is not Law.powers for law in self.laws)

    def measure(
        self, separation: jax.Array, memory: Memory, integrated: int = 0, near: Near | None = None
    ) -> Means:
        edges = bond_gaps(self.laws, separation, memory)
        names, powers, sizes = zip(*asked_powers(self.laws, edges), strict=True)
        values = self.heights.mean_powers(powers, integrated, separation, sizes)
        sums: dict[str, jax.Array] = {}
        for name, value in zip(names, values, strict=True):
            sums[name] = sums.get(name, 0.0) + self.density * value
        for k, (law, edge) in enumerate(zip(self.laws, edges, strict=True)):
            if law.powers(edge) is None:
                found = self._quadrature(k, edge, separation, integrated, near)
                for name, mean in found.items():
                    sums[name] = sums.get(name, 0.0) + self.density * mean
        return means_of(self.laws, self.components, sums, separation)

    def counted(
        self, separation: jax.Array, memory: Memory, integrated: int = 0
    ) -> tuple[jax.Array, jax.Array]:
        """Contacting asperities and bonds by law, as in :class:`Means`."""
        edges: tuple[Real, ...] = (0.0, *bond_gaps(self.hysteretic, separation, memory))
        powers = tuple(TruncatedPower(1.0, 0.0, edge) for edge in edges)
        sizes = (0.0, *(law.radius_power for law in self.hysteretic))
        found = self.density * self.heights.mean_powers(powers, integrated, separation, sizes)
        return found[0], found[1:]

    def pressure(self, separation: jax.Array, memory: Memory, integrated: int = 0) -> jax.Array:
        edges = bond_gaps(self.laws, separation, memory)
        total = jnp.zeros_like(separation)
        flat: Powers = ()
        sizes: tuple[float, ...] = ()
        for k, law in enumerate(self.laws):
            powers = law.powers(edges[k])
            if powers is None:
                found = self._quadrature(k, edges[k], separation, integrated)
                del found["energy"]
                total = total + sum(found.values())
            else:
                flat += powers[0]
                sizes += (law.radius_power,) * (len(flat) - len(sizes))
        if flat:
            values = self.heights.mean_powers(flat, integrated, separation, sizes)
            total = total + jnp.sum(values, axis=0)
        return self.density * total

    def approach_tables(self, ends: jax.Array) -> tuple[PanelTable | None, ...]:
        places = places_of(ends)

        def one(number: int, law: Law) -> PanelTable | None:
            edge = jnp.broadcast_to(law.forming_gap if law.hysteretic else -jnp.inf, places.shape)
            if law.powers(edge) is not None:
                return None
            found = self._quadrature(number, edge, places, 0)
            names = sorted(found)
            return PanelTable.through(ends, [found[n] for n in names], names.index("energy"))

        each = tuple(one(k, law) for k, law in enumerate(self.laws))
        return each if any(table is not None for table in each) else ()

    def reading(self, tables: tuple[PanelTable | None, ...], pieces: int) -> Interface:
        return dataclasses.replace(self, approach=tables, pieces=pieces)

    def _read(self, number: int, edge: jax.Array, separation: jax.Array) -> dict[str, jax.Array]:
        """Means over one plane: of the branch of approach, and of the bonds that differ from it."""
        law, table = self.laws[number], self.approach[number]
        assert table is not None
        names = sorted((*(law.counts or {law.mechanism}), "energy"))
        found = dict(zip(names, table(separation), strict=True))
        if not law.hysteretic:
            return found
        more = self.beside(number, edge, separation, 0, self.pieces * self.heights.cuts)
        return {name: row + more[name] for name, row in found.items()}

    def beside(
        self, number: int, edge: jax.Array, separation: jax.Array, integrated: int, pieces: int
    ) -> dict[str, jax.Array]:
        """What bonds that differ from the branch of approach add to the means of one law.

        Per asperity, of bonds up to the gap ``edge`` [m]: a quadrature on even ``pieces`` (static).
        """
        law, shape = self.laws[number], separation.shape
        begin = jnp.asarray(law.forming_gap, float)
        flat = jnp.broadcast_to(edge, shape).ravel(), separation.ravel()
        found = between(law, self.heights, begin, *flat, integrated, pieces)
        return {name: row.reshape(shape) for name, row in found.items()}

    def _quadrature(
        self,
        number: int,
        edge: jax.Array,
        separation: jax.Array,
        integrated: int,
        near: Near | None = None,
    ) -> dict[str, jax.Array]:
        """Means of a law without truncated powers, named as in :meth:`Law.response`."""
        law = self.laws[number]
        if near is None and self.approach and integrated == 0:
            return self._read(number, edge, separation)
        if near is None:
            return means(law, self.heights, edge, separation, integrated)

        def row(edge: jax.Array, separation: jax.Array) -> dict[str, jax.Array]:
            return means_near(law, self.heights, edge, separation, integrated, near)

        return (row if separation.ndim == 1 else jax.vmap(row))(edge, separation)
