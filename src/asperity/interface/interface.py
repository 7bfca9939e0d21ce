"""Pressure and energy between two rough planes, with the memory of every bond."""

from __future__ import annotations

from functools import reduce
from typing import NamedTuple

import equinox as eqx

from .._jax import jax, jnp
from ..laws.law import Law, Powers, Real, TruncatedPower, quantity, terms
from ..surfaces.heights.distribution import Heights
from ..surfaces.heights.panel_length import PanelLengths
from .height_quadrature import Asked, Near, means, means_near

Memory = tuple[jax.Array, ...]
"""One threshold height b [m] per hysteretic law: the asperities higher than b are bonded."""


class Means(NamedTuple):
    """Means over the heights, per area (``integrated`` 1: per 2 pi R).

    Attributes
    ----------
    parts
        Pressure by mechanism [Pa], in the order of :attr:`Interface.components`.
    energy
        Stored energy [J/m^2].
    bonds
        Bonds by law [1/m^2]; where tip radii differ, in bonds of the law's own radius.
    contacting
        Asperities with a negative gap [1/m^2].
    """

    parts: jax.Array
    energy: jax.Array
    bonds: jax.Array
    contacting: jax.Array


class Interface(eqx.Module):
    """Many asperities of random height between two planes.

    Parameters
    ----------
    law
        What one asperity does (a :class:`~asperity.laws.Law` or a sum of them).
    heights
        Distribution of their heights.
    density
        Asperities per area [1/m^2].

    Notes
    -----
    Separation h [m] is the distance between the mean planes; the gap of an asperity of
    height z is h - z. Asperities differ in height alone, so the bonded ones are always
    those above a threshold b, which follows b <- clamp(b, h - g_break, h - g_form): a play
    operator, exact for any sequence of reversals (Visintin 1994; ``docs/theory``).

    ``integrated`` 0 gives means over the plane (pressure [Pa], energy per area [J/m^2]);
    ``integrated`` 1 integrates them once more over the separation from h to infinity, which
    times 2 pi R is the force and energy of a rigid paraboloid of radius R whose apex is at h.
    """

    law: Law
    heights: Heights
    density: Real = quantity()

    @property
    def hysteretic(self) -> tuple[Law, ...]:
        """The laws that remember, in the order of the memory."""
        return tuple(law for law in terms(self.law) if law.hysteretic)

    @property
    def mechanisms(self) -> tuple[str, ...]:
        """Names under which the losses of :meth:`losses` are booked."""
        return tuple(law.mechanism for law in self.hysteretic)

    @property
    def components(self) -> tuple[str, ...]:
        """Mechanisms of the forces, elastic first."""
        names = {name for law in terms(self.law) for name in law.counts or {law.mechanism}}
        return tuple(sorted(names, key=lambda name: (name != "elastic", name)))

    @property
    def panel_lengths(self) -> PanelLengths:
        """How finely its curves are cut. Without values."""
        return self.heights.panel_lengths

    @property
    def error_floor(self) -> float:
        """Relative error of curves below which nothing is gained. Without values."""
        return self.heights.error_floor

    @property
    def interaction_range(self) -> jax.Array:
        """Gap [m] beyond which no law pulls by more than 1e-6 of its largest pull."""
        return reduce(jnp.maximum, [law.interaction_range for law in terms(self.law)])

    @property
    def last_kink(self) -> jax.Array:
        """Gap [m] beyond which all laws are smooth."""
        return reduce(jnp.maximum, [law.last_kink for law in terms(self.law)])

    def initial_memory(self, place: jax.Array | float = 0.0) -> Memory:
        """Memory of surfaces that have never touched, one threshold per ``place``."""
        return tuple(jnp.full(jnp.shape(place), jnp.inf) for _ in self.hysteretic)

    def saturated_memory(self, place: jax.Array | float = 0.0) -> Memory:
        """Saturated memory, on the major unloading branch: all bonds that can hold do."""
        return tuple(jnp.full(jnp.shape(place), -jnp.inf) for _ in self.hysteretic)

    def remember(self, memory: Memory, separation: jax.Array) -> Memory:
        """The memory after the separation moved monotonically to ``separation`` [m]."""
        return tuple(separation - gap for gap in self.bond_gaps(separation, memory))

    @property
    def closed(self) -> bool:
        """Whether all its means are closed forms, of truncated powers. Without values."""
        return all(type(law).powers is not Law.powers for law in terms(self.law))

    @property
    def yields(self) -> bool:
        """Whether what was pressed once stays changed. Without values."""
        return False

    def has_yielded(self, memory: Memory) -> jax.Array:
        """Whether anything was pressed so that it stays changed."""
        return jnp.asarray(False)

    def swept(self, memory: Memory, unloading: jax.Array | bool) -> Memory:
        """The memory on a major branch: no bond is left of what it was, or all hold."""
        return tuple(jnp.where(unloading, -jnp.inf, jnp.full_like(b, jnp.inf)) for b in memory)

    def merging(self, memory: Memory, unloading: jax.Array) -> list[jax.Array]:
        """Separations [m] at which the bonds of each law reach the major branch."""
        return [
            b + jnp.where(unloading, law.breaking_gap, law.forming_gap)
            for law, b in zip(self.hysteretic, memory, strict=True)
        ]

    def work_of_approach(self, separation: jax.Array, integrated: int = 0) -> jax.Array:
        """Work per area [J/m^2] that bringing free surfaces to a separation takes, at least."""
        return self.energy(separation, self.initial_memory(), integrated)

    @property
    def only_bonded(self) -> bool:
        """Whether every law without truncated powers ends with its bonds. Without values."""
        edge = jnp.zeros(())
        return all(law.only_bonded or law.powers(edge) is not None for law in terms(self.law))

    def measure(
        self, separation: jax.Array, memory: Memory, integrated: int = 0, near: Near | None = None
    ) -> Means:
        """All means over the heights at a separation reached monotonically from ``memory``.

        Parameters
        ----------
        separation
            Separation of the mean planes [m], any shape.
        memory
            Thresholds at the last reversal, each of that shape or a scalar.
        integrated
            0 for a plane, 1 for a rigid paraboloid (times 2 pi R).
        near
            How they lie to one another if they are rows of places, those of a row near one another,
            which all have one memory.
        """
        edges = {k: self._bond_gap(law, b, separation) for k, (law, b) in self._pairs(memory)}
        laws = dict(enumerate(terms(self.law)))
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
                asked = Asked((*self._force_names(law), "energy"), integrated)
                rows = self._quadrature(law, edges[k], separation, asked, near)
                for name, mean in zip(asked.names, rows, strict=True):
                    target = law.mechanism if name == "force" else name
                    sums[target] = sums.get(target, 0.0) + self.density * mean
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
        """Mean pressure [Pa], positive when it pushes apart (``integrated`` 1: N per 2 pi R)."""
        return self._total(separation, memory, integrated, "force")

    def _total(
        self, separation: jax.Array, memory: Memory, integrated: int, name: str
    ) -> jax.Array:
        """Mean of the force or of the energy of all laws."""
        edges = {k: self._bond_gap(law, b, separation) for k, (law, b) in self._pairs(memory)}
        total = jnp.zeros_like(separation)
        flat: Powers = ()
        sizes: tuple[float, ...] = ()
        for k, law in enumerate(terms(self.law)):
            powers = law.powers(edges[k])
            if powers is None:
                asked = Asked((name,), integrated)
                total = total + self._quadrature(law, edges[k], separation, asked)[0]
            else:
                flat += powers[0 if name == "force" else 1]
                sizes += (law.radius_power,) * (len(flat) - len(sizes))
        if flat:
            values = self.heights.mean_powers(flat, integrated, separation, sizes)
            total = total + jnp.sum(values, axis=0)
        return self.density * total

    def energy(self, separation: jax.Array, memory: Memory, integrated: int = 0) -> jax.Array:
        """Stored energy per area [J/m^2], 0 for free surfaces far apart."""
        return self._total(separation, memory, integrated, "energy")

    def losses(self) -> tuple[jax.Array, jax.Array]:
        """Energy [J] lost when one bond forms, and when it breaks, per hysteretic law."""
        return (
            _stack([jnp.asarray(law.formation_loss) for law in self.hysteretic]),
            _stack([jnp.asarray(law.rupture_loss) for law in self.hysteretic]),
        )

    def _pairs(self, memory: Memory) -> list[tuple[int, tuple[Law, jax.Array | None]]]:
        thresholds = iter(memory)
        return [
            (k, (law, next(thresholds) if law.hysteretic else None))
            for k, law in enumerate(terms(self.law))
        ]

    @staticmethod
    def _bond_gap(law: Law, threshold: jax.Array | None, separation: jax.Array) -> jax.Array:
        """Gap below which asperities are bonded: the clamp, seen from the gap."""
        if threshold is None:
            return jnp.full_like(separation, -jnp.inf)
        return jnp.clip(separation - threshold, law.forming_gap, law.breaking_gap)

    def _quadrature(
        self,
        law: Law,
        edge: jax.Array,
        separation: jax.Array,
        asked: Asked,
        near: Near | None = None,
    ) -> jax.Array:
        """Means of a law without truncated powers, one row a name."""
        if near is None:
            return means(law, self.heights, edge, separation, asked)
        if separation.ndim == 1:
            return means_near(law, self.heights, edge, separation, asked, near)
        return jax.vmap(
            lambda edge, row: means_near(law, self.heights, edge, row, asked, near), out_axes=1
        )(edge, separation)

    @staticmethod
    def _force_names(law: Law) -> tuple[str, ...]:
        """The parts into which a law without powers takes its force apart."""
        if len(law.counts) < 2:
            return ("force",)
        zero = jnp.zeros(())
        return tuple(law.components(zero, zero > 1.0))


def _stack(rows: list[jax.Array]) -> jax.Array:
    return jnp.stack(rows) if rows else jnp.zeros((0,))
