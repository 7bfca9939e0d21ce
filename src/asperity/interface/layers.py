"""Interfaces that act side by side between the same two planes."""

from __future__ import annotations

from collections.abc import Sequence
from functools import reduce
from typing import Any

from .._jax import jax, jnp
from ..laws.law import Law, components_of, refuse_twice
from ..surfaces.heights.panel_length import PanelLengths
from .height_quadrature import Near
from .rough_planes import Means, Memory, RoughPlanes, Scale


class Layers(RoughPlanes):
    """Several interfaces between the same two planes: asperities, and liquid on the surface.

    Parameters
    ----------
    parts
        The interfaces. Their heights count from the same mean plane.

    Raises
    ------
    InputError
        If two of them contain the same force.

    Notes
    -----
    Pressures, energies and bonds add up; the memory is that of the parts in a row.
    """

    parts: tuple[RoughPlanes, ...]

    def __init__(self, parts: Sequence[RoughPlanes]) -> None:
        refuse_twice(laws=[law for part in parts for law in part.laws])
        self.parts = tuple(parts)

    @property
    def laws(self) -> tuple[Law, ...]:
        return tuple(law for part in self.parts for law in part.laws)

    @property
    def hysteretic(self) -> tuple[Law, ...]:
        return tuple(law for part in self.parts for law in part.hysteretic)

    @property
    def mechanisms(self) -> tuple[str, ...]:
        return tuple(name for part in self.parts for name in part.mechanisms)

    @property
    def components(self) -> tuple[str, ...]:
        return components_of((), [name for part in self.parts for name in part.components])

    @property
    def panel_lengths(self) -> PanelLengths:
        return reduce(PanelLengths.and_of, [part.panel_lengths for part in self.parts])

    @property
    def interaction_range(self) -> jax.Array:
        return reduce(jnp.maximum, [part.interaction_range for part in self.parts])

    @property
    def last_kink(self) -> jax.Array:
        return jnp.max(jnp.stack([part.last_kink for part in self.parts]))

    @property
    def scale(self) -> Scale:
        return Scale.largest([part.scale for part in self.parts])

    def remember(self, memory: Memory, separation: jax.Array) -> Memory:
        return tuple(
            b for part, own in self._shares(memory) for b in part.remember(own, separation)
        )

    @property
    def yields(self) -> bool:
        return any(part.yields for part in self.parts)

    @property
    def unloading_panels(self) -> jax.Array:
        return jnp.concatenate([part.unloading_panels for part in self.parts])

    def has_yielded(self, memory: Memory) -> jax.Array:
        each = [part.has_yielded(own) for part, own in self._shares(memory)]
        return jnp.any(jnp.stack(each))

    def branch_memory(self, memory: Memory, unloading: jax.Array | bool) -> Memory:
        return tuple(
            b for part, own in self._shares(memory) for b in part.branch_memory(own, unloading)
        )

    def rejoining(self, memory: Memory, unloading: jax.Array) -> list[jax.Array]:
        return [d for part, own in self._shares(memory) for d in part.rejoining(own, unloading)]

    def work_of_approach(self, separation: jax.Array, integrated: int = 0) -> jax.Array:
        values = [part.work_of_approach(separation, integrated) for part in self.parts]
        return jnp.sum(jnp.stack(values), axis=0)

    @property
    def only_bonded(self) -> bool:
        return all(part.only_bonded for part in self.parts)

    def measure(
        self, separation: jax.Array, memory: Memory, integrated: int = 0, near: Near | None = None
    ) -> Means:
        each = [
            part.measure(separation, own, integrated, near) for part, own in self._shares(memory)
        ]
        return self._together(each, separation)

    def first_approach(self, separation: jax.Array, integrated: int = 0) -> Means:
        each = [part.first_approach(separation, integrated) for part in self.parts]
        return self._together(each, separation)

    def flattened(self, memory: Memory, integrated: int) -> tuple[Any, ...]:
        return tuple(part.flattened(own, integrated) for part, own in self._shares(memory))

    def as_flattened(self, pressed: tuple[Any, ...]) -> Layers:
        pairs = zip(self.parts, pressed, strict=True)
        return Layers([part.as_flattened(left) for part, left in pairs])

    def approach_tables(self, ends: jax.Array) -> tuple[Any, ...]:
        each = tuple(part.approach_tables(ends) for part in self.parts)
        return each if any(each) else ()

    def reading(self, tables: tuple[Any, ...], pieces: int) -> Layers:
        if not tables:
            return self
        pairs = zip(self.parts, tables, strict=True)
        return Layers([part.reading(own, pieces) for part, own in pairs])

    def _together(self, each: list[Means], separation: jax.Array) -> Means:
        zero = jnp.zeros_like(separation)
        sums = dict.fromkeys(self.components, zero)
        contacting = zero
        for part, means in zip(self.parts, each, strict=True):
            for name, share in zip(part.components, means.parts, strict=True):
                sums[name] = sums[name] + share
            if "elastic" in part.components:
                contacting = contacting + means.contacting
        return Means(
            parts=jnp.stack([sums[name] for name in self.components]),
            energy=jnp.sum(jnp.stack([means.energy for means in each]), axis=0),
            bonds=jnp.concatenate([means.bonds for means in each]),
            contacting=contacting,
        )

    def pressure(self, separation: jax.Array, memory: Memory, integrated: int = 0) -> jax.Array:
        values = [part.pressure(separation, own, integrated) for part, own in self._shares(memory)]
        return jnp.sum(jnp.stack(values), axis=0)

    def losses(self) -> tuple[jax.Array, jax.Array]:
        formation, rupture = zip(*(part.losses() for part in self.parts), strict=True)
        return jnp.concatenate(formation), jnp.concatenate(rupture)

    def _shares(self, memory: Memory) -> list[tuple[RoughPlanes, Memory]]:
        """Each interface with its own part of the memory."""
        out, first = [], 0
        for part in self.parts:
            last = first + len(part.mechanisms)
            out.append((part, memory[first:last]))
            first = last
        return out
