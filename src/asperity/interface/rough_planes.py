"""What a rough contact asks of what acts between two rough planes."""

from __future__ import annotations

import abc
from collections.abc import Sequence
from functools import reduce
from typing import Any, NamedTuple

import equinox as eqx

from .._jax import jax, jnp
from ..laws.law import Law, components_of
from ..surfaces.heights.panel_length import PanelLengths
from .height_quadrature import Near

Memory = tuple[jax.Array, ...]
"""One threshold height b [m] per hysteretic law: the asperities higher than b are bonded."""


class Means(NamedTuple):
    """Means over the heights, per area (``integrated`` 1: per 2 pi R).

    Attributes
    ----------
    parts
        Pressure by mechanism [Pa], in the order of :attr:`RoughPlanes.components`.
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


class Scale(NamedTuple):
    """How rough two planes are: largest rms height and highest height [m]."""

    rms: jax.Array
    top: jax.Array

    @classmethod
    def of(cls, heights: Any) -> Scale:
        """That of a distribution of heights."""
        return cls(jnp.asarray(heights.rms), jnp.asarray(heights.top))

    @classmethod
    def largest(cls, scales: Sequence[Scale]) -> Scale:
        """The largest among several."""
        rms, top = zip(*scales, strict=True)
        return cls(jnp.max(jnp.stack(rms)), jnp.max(jnp.stack(top)))


class RoughPlanes(eqx.Module):
    """Pressure and energy between two rough planes at a separation, with the memory of all bonds.

    ``integrated`` 0 gives means over the plane (pressure [Pa], energy per area [J/m^2]);
    ``integrated`` 1 integrates them once more over the separation from h to infinity, which
    times 2 pi R is the force and energy of a rigid paraboloid of radius R whose apex is at h.
    """

    @property
    @abc.abstractmethod
    def laws(self) -> tuple[Law, ...]:
        """The laws of its asperities."""

    @property
    def hysteretic(self) -> tuple[Law, ...]:
        """The laws that remember, in the order of the memory."""
        return tuple(law for law in self.laws if law.hysteretic)

    @property
    def mechanisms(self) -> tuple[str, ...]:
        """Names under which the losses of :meth:`losses` are booked."""
        return tuple(law.mechanism for law in self.hysteretic)

    @property
    def components(self) -> tuple[str, ...]:
        """Mechanisms of the forces, elastic first."""
        return components_of(self.laws)

    @property
    @abc.abstractmethod
    def scale(self) -> Scale:
        """How rough they are."""

    @property
    @abc.abstractmethod
    def panel_lengths(self) -> PanelLengths:
        """How finely its curves are cut. Without values."""

    @property
    def interaction_range(self) -> jax.Array:
        """Gap [m] beyond which no law pulls by more than 1e-6 of its largest pull."""
        return reduce(jnp.maximum, [law.interaction_range for law in self.laws])

    @property
    def last_kink(self) -> jax.Array:
        """Gap [m] beyond which all laws are smooth."""
        return reduce(jnp.maximum, [law.last_kink for law in self.laws])

    @property
    def only_bonded(self) -> bool:
        """Whether every law without truncated powers ends with its bonds. Without values."""
        edge = jnp.zeros(())
        return all(law.only_bonded or law.powers(edge) is not None for law in self.laws)

    @property
    def closed(self) -> bool:
        """Whether all its means are closed forms, of truncated powers. Without values."""
        return False

    def initial_memory(self, place: jax.Array | float = 0.0) -> Memory:
        """Memory of surfaces that have never touched, one threshold per ``place``."""
        return tuple(jnp.full(jnp.shape(place), jnp.inf) for _ in self.mechanisms)

    def saturated_memory(self, place: jax.Array | float = 0.0) -> Memory:
        """Saturated memory, on the major unloading branch: all bonds that can hold do."""
        return self.branch_memory(self.initial_memory(place), True)

    def branch_memory(self, memory: Memory, unloading: jax.Array | bool) -> Memory:
        """The memory on a major branch: no bond is left of what it was, or all hold."""
        return tuple(jnp.where(unloading, -jnp.inf, jnp.full_like(b, jnp.inf)) for b in memory)

    def branches(self, place: jax.Array | float = 0.0) -> tuple[Memory, ...]:
        """Memories of the major branches: without bonds, and with all where there are any."""
        both = self.initial_memory(place), self.saturated_memory(place)
        return both if self.mechanisms else both[:1]

    @abc.abstractmethod
    def remember(self, memory: Memory, separation: jax.Array) -> Memory:
        """The memory after the separation moved monotonically to ``separation`` [m]."""

    def rejoining(self, memory: Memory, unloading: jax.Array) -> list[jax.Array]:
        """Separations [m] at which the bonds of each law reach the major branch."""
        return [
            b + jnp.where(unloading, law.breaking_gap, law.forming_gap)
            for law, b in zip(self.hysteretic, memory, strict=True)
        ]

    @abc.abstractmethod
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

    def approach_tables(self, ends: jax.Array) -> tuple[Any, ...]:
        """What :meth:`reading` reads, with panels that end at ``ends`` [m]; empty for nothing."""
        return ()

    def reading(self, tables: tuple[Any, ...], pieces: int) -> RoughPlanes:
        """The same planes, whose means over one plane are read from tables.

        Parameters
        ----------
        tables
            What :meth:`approach_tables` gave.
        pieces
            Even pieces of a quadrature over bonds that are not of the branch of approach (static).
        """
        return self

    def pressure(self, separation: jax.Array, memory: Memory, integrated: int = 0) -> jax.Array:
        """Mean pressure [Pa], positive when it pushes apart (``integrated`` 1: N per 2 pi R)."""
        return jnp.sum(self.measure(separation, memory, integrated).parts, axis=0)

    def energy(self, separation: jax.Array, memory: Memory, integrated: int = 0) -> jax.Array:
        """Stored energy per area [J/m^2], 0 for free surfaces far apart."""
        return self.measure(separation, memory, integrated).energy

    def work_of_approach(self, separation: jax.Array, integrated: int = 0) -> jax.Array:
        """Work per area [J/m^2] that bringing free surfaces to a separation takes, at least."""
        return self.energy(separation, self.initial_memory(), integrated)

    def losses(self) -> tuple[jax.Array, jax.Array]:
        """Energy [J] lost when one bond forms, and when it breaks, per mechanism."""
        return losses_of(self.hysteretic)

    @property
    def yields(self) -> bool:
        """Whether what was pressed once stays changed. Without values."""
        return False

    def has_yielded(self, memory: Memory) -> jax.Array:
        """Whether anything was pressed so that it stays changed."""
        return jnp.asarray(False)

    @property
    def unloading_panels(self) -> jax.Array:
        """Separations above the closest approach [m] between which contacts spring back."""
        return jnp.zeros(0)

    def first_approach(self, separation: jax.Array, integrated: int = 0) -> Means:
        """The means of :meth:`measure` for surfaces that were never closer."""
        return self.measure(separation, self.initial_memory(), integrated)

    def flattened(self, memory: Memory, integrated: int) -> Any:
        """What a first approach leaves, for :meth:`as_flattened`; None where nothing changes."""
        return None

    def as_flattened(self, pressed: Any) -> RoughPlanes:
        """The interface from then on."""
        return self


def losses_of(laws: Sequence[Law]) -> tuple[jax.Array, jax.Array]:
    """Energy [J] lost when one bond forms, and when it breaks, of each of some laws."""
    each = [law.losses for law in laws]
    formed, broken = jnp.stack(each, axis=1) if each else jnp.zeros((2, 0))
    return formed, broken
