"""Pressure and energy between two rough planes, with the memory of every bond."""

from __future__ import annotations

import dataclasses

import equinox as eqx

from .._jax import jax, jnp
from ..laws.law import Law, Powers, Real, TruncatedPower, quantity, terms
from ..surfaces.heights.distribution import Heights
from ..surfaces.heights.panel_length import PanelLengths
from .height_quadrature import Near, between, means, means_near
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
        return tuple(separation - gap for gap in self.bond_gaps(separation, memory))

    @property
    def closed(self) -> bool:
        return all(type(law).powers is not Law.powers for law in self.laws)

    def measure(
        self, separation: jax.Array, memory: Memory, integrated: int = 0, near: Near | None = None
    ) -> Means:
        edges = {k: self._bond_gap(law, b, separation) for k, (law, b) in self._pairs(memory)}
        laws = dict(enumerate(self.laws))
        requests: list[tuple[str, TruncatedPower, float]] = [
            ("contacting", TruncatedPower(1.0, 0.0, 0.0), 0.0)
        ]
        for k, law in laws.items():
            size = law.radius_power
            if law.hysteretic:
                requests.append((f"bonds {k}", TruncatedPower(1.0, 0.0, edges[k]), size))
            force, energy = law.powers(edges[k]) or ((), ())
            requests += [(law.mechanism, term, size) for term in force]
            requests += [("energy", term, size) for term in energy]
        names, flat, sizes = zip(*requests, strict=True)
        values = self.heights.mean_powers(flat, integrated, separation, sizes)
        sums: dict[str, jax.Array] = {}
        for name, value in zip(names, values, strict=True):
            sums[name] = sums.get(name, 0.0) + self.density * value
        for k, law in laws.items():
            if law.powers(edges[k]) is None:
                found = self._quadrature(k, edges[k], separation, integrated, near)
                for name, mean in found.items():
                    sums[name] = sums.get(name, 0.0) + self.density * mean
        zero = jnp.zeros_like(separation)
        bonds = [sums[f"bonds {k}"] for k, law in laws.items() if law.hysteretic]
        return Means(
            parts=jnp.stack([sums.get(name, zero) for name in self.components]),
            energy=sums.get("energy", zero),
            bonds=jnp.stack(bonds) if bonds else jnp.zeros((0, *separation.shape)),
            contacting=sums["contacting"],
        )

    def counted(
        self, separation: jax.Array, memory: Memory, integrated: int = 0
    ) -> tuple[jax.Array, jax.Array]:
        """Contacting asperities and bonds by law, as in :class:`Means`."""
        edges: tuple[Real, ...] = (0.0, *self.bond_gaps(separation, memory))
        powers = tuple(TruncatedPower(1.0, 0.0, edge) for edge in edges)
        sizes = (0.0, *(law.radius_power for law in self.hysteretic))
        found = self.density * self.heights.mean_powers(powers, integrated, separation, sizes)
        return found[0], found[1:]

    def bond_gaps(self, separation: jax.Array, memory: Memory) -> list[jax.Array]:
        """Gap [m] of each law that remembers below which asperities are bonded."""
        return [
            self._bond_gap(law, b, separation)
            for law, b in zip(self.hysteretic, memory, strict=True)
        ]

    def pressure(self, separation: jax.Array, memory: Memory, integrated: int = 0) -> jax.Array:
        return self._total(separation, memory, integrated, of_force=True)

    def _total(
        self, separation: jax.Array, memory: Memory, integrated: int, *, of_force: bool
    ) -> jax.Array:
        """Mean of the force or of the energy of all laws."""
        edges = {k: self._bond_gap(law, b, separation) for k, (law, b) in self._pairs(memory)}
        total = jnp.zeros_like(separation)
        flat: Powers = ()
        sizes: tuple[float, ...] = ()
        for k, law in enumerate(self.laws):
            powers = law.powers(edges[k])
            if powers is None:
                found = self._quadrature(k, edges[k], separation, integrated)
                energy = found.pop("energy")
                total = total + (sum(found.values()) if of_force else energy)
            else:
                flat += powers[0 if of_force else 1]
                sizes += (law.radius_power,) * (len(flat) - len(sizes))
        if flat:
            values = self.heights.mean_powers(flat, integrated, separation, sizes)
            total = total + jnp.sum(values, axis=0)
        return self.density * total

    def energy(self, separation: jax.Array, memory: Memory, integrated: int = 0) -> jax.Array:
        return self._total(separation, memory, integrated, of_force=False)

    def approach_tables(self, ends: jax.Array) -> tuple[PanelTable | None, ...]:
        places = places_of(ends)

        def one(number: int, law: Law) -> PanelTable | None:
            edge = jnp.broadcast_to(law.forming_gap if law.hysteretic else -jnp.inf, places.shape)
            if law.powers(edge) is not None:
                return None
            found = self._quadrature(number, edge, places, 0)
            return PanelTable.through(ends, [found[name] for name in sorted(found)])

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
        begin, shape = jnp.asarray(law.forming_gap, float), separation.shape
        flat = jnp.broadcast_to(edge, shape).ravel(), separation.ravel()
        more = between(law, self.heights, begin, *flat, 0, self.pieces * self.heights.cuts)
        return {name: row + more[name].reshape(shape) for name, row in found.items()}

    def _pairs(self, memory: Memory) -> list[tuple[int, tuple[Law, jax.Array | None]]]:
        thresholds = iter(memory)
        return [
            (k, (law, next(thresholds) if law.hysteretic else None))
            for k, law in enumerate(self.laws)
        ]

    @staticmethod
    def _bond_gap(law: Law, threshold: jax.Array | None, separation: jax.Array) -> jax.Array:
        """Gap below which asperities are bonded: the clamp, seen from the gap."""
        if threshold is None:
            return jnp.full_like(separation, -jnp.inf)
        return jnp.clip(separation - threshold, law.forming_gap, law.breaking_gap)

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
