"""Interfaces that act side by side between the same two planes."""

from __future__ import annotations

from collections.abc import Sequence
from functools import reduce

import equinox as eqx

from .._jax import jax, jnp
from ..errors import InputError
from ..laws.law import Law, terms
from ..surfaces.heights.panel_length import PanelLengths
from .height_quadrature import Near
from .interface import Interface, Means, Memory
from .plastic_interface import PlasticInterface
from .radius_classes import RadiusClasses, Scale, scale_of
from .residual_profile import Flattened

Layer = Interface | RadiusClasses | PlasticInterface


class Layers(eqx.Module):
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

    parts: tuple[Layer, ...]

    def __init__(self, parts: Sequence[Layer]) -> None:
        counted = [name for part in parts for law in terms(part.law) for name in law.counts]
        twice = sorted({name for name in counted if counted.count(name) > 1})
        if twice:
            raise InputError(f"two layers contain the {twice[0]} force; it would count twice")
        self.parts = tuple(parts)

    @property
    def hysteretic(self) -> tuple[Law, ...]:
        """The laws that remember, in the order of the memory."""
        return tuple(law for part in self.parts for law in part.hysteretic)

    @property
    def mechanisms(self) -> tuple[str, ...]:
        """Names under which losses are booked."""
        return tuple(name for part in self.parts for name in part.mechanisms)

    @property
    def components(self) -> tuple[str, ...]:
        """Mechanisms of the forces, elastic first."""
        names = {name for part in self.parts for name in part.components}
        return tuple(sorted(names, key=lambda name: (name != "elastic", name)))

    @property
    def panel_lengths(self) -> PanelLengths:
        """How finely its curves are cut. Without values."""
        return reduce(PanelLengths.and_of, [part.panel_lengths for part in self.parts])

    @property
    def error_floor(self) -> float:
        """Relative error of curves below which nothing is gained. Without values."""
        return max(part.error_floor for part in self.parts)

    @property
    def interaction_range(self) -> jax.Array:
        """Gap [m] beyond which no law pulls by more than 1e-6 of its largest pull."""
        return reduce(jnp.maximum, [part.interaction_range for part in self.parts])

    @property
    def last_kink(self) -> jax.Array:
        """Gap [m] beyond which all laws are smooth."""
        return jnp.max(jnp.stack([part.last_kink for part in self.parts]))

    @property
    def heights(self) -> Scale:
        """What their heights are on the whole."""
        return scale_of([part.heights for part in self.parts])

    def initial_memory(self, place: jax.Array | float = 0.0) -> Memory:
        """Memory of surfaces that have never touched, one threshold per ``place``."""
        return tuple(b for part in self.parts for b in part.initial_memory(place))

    def saturated_memory(self, place: jax.Array | float = 0.0) -> Memory:
        """Saturated memory, on the major unloading branch: all bonds that can hold do."""
        return tuple(b for part in self.parts for b in part.saturated_memory(place))

    def remember(self, memory: Memory, separation: jax.Array) -> Memory:
        """The memory after the separation moved monotonically to ``separation`` [m]."""
        return tuple(
            b for part, own in self._shares(memory) for b in part.remember(own, separation)
        )

    @property
    def yields(self) -> bool:
        """Whether what was pressed once stays changed. Without values."""
        return any(part.yields for part in self.parts)

    @property
    def unloading_panels(self) -> jax.Array:
        """See :attr:`PlasticInterface.unloading_panels`."""
        parts = [part for part in self.parts if isinstance(part, PlasticInterface)]
        return jnp.concatenate([part.unloading_panels for part in parts])

    def has_yielded(self, memory: Memory) -> jax.Array:
        """Whether anything was pressed so that it stays changed."""
        each = [part.has_yielded(own) for part, own in self._shares(memory)]
        return jnp.any(jnp.stack(each))

    def swept(self, memory: Memory, unloading: jax.Array | bool) -> Memory:
        """The memory on a major branch; see :meth:`Interface.swept`."""
        return tuple(b for part, own in self._shares(memory) for b in part.swept(own, unloading))

    def merging(self, memory: Memory, unloading: jax.Array) -> list[jax.Array]:
        """Separations [m] at which the bonds of each law reach the major branch."""
        return [d for part, own in self._shares(memory) for d in part.merging(own, unloading)]

    def work_of_approach(self, separation: jax.Array, integrated: int = 0) -> jax.Array:
        """Work per area [J/m^2] that bringing free surfaces to a separation takes, at least."""
        values = [part.work_of_approach(separation, integrated) for part in self.parts]
        return jnp.sum(jnp.stack(values), axis=0)

    @property
    def only_bonded(self) -> bool:
        """Whether every law without truncated powers ends with its bonds. Without values."""
        return all(part.only_bonded for part in self.parts)

    def measure(
        self, separation: jax.Array, memory: Memory, integrated: int = 0, near: Near | None = None
    ) -> Means:
        """All means over the heights; see :meth:`Interface.measure`."""
        each = [
            part.measure(separation, own, integrated, near) for part, own in self._shares(memory)
        ]
        return self._together(each, separation)

    def first_approach(self, separation: jax.Array, integrated: int = 0) -> Means:
        """The means of :meth:`measure` for surfaces that were never closer."""
        each = [
            part.first_approach(separation, integrated)
            if isinstance(part, PlasticInterface)
            else part.measure(separation, part.initial_memory(), integrated)
            for part in self.parts
        ]
        return self._together(each, separation)

    def flattened(self, memory: Memory, integrated: int) -> tuple[Flattened | None, ...]:
        """What a first approach leaves of each; see :meth:`PlasticInterface.flattened`."""
        return tuple(
            part.flattened(own, integrated) if isinstance(part, PlasticInterface) else None
            for part, own in self._shares(memory)
        )

    def as_flattened(self, pressed: tuple[Flattened | None, ...]) -> Layers:
        """The interfaces from then on."""
        return Layers(
            [
                part.as_flattened(left) if isinstance(part, PlasticInterface) else part
                for part, left in zip(self.parts, pressed, strict=True)
            ]
        )

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
        """Mean pressure [Pa], positive when it pushes apart (``integrated`` 1: N per 2 pi R)."""
        values = [part.pressure(separation, own, integrated) for part, own in self._shares(memory)]
        return jnp.sum(jnp.stack(values), axis=0)

    def energy(self, separation: jax.Array, memory: Memory, integrated: int = 0) -> jax.Array:
        """Stored energy per area [J/m^2], 0 for free surfaces far apart."""
        values = [part.energy(separation, own, integrated) for part, own in self._shares(memory)]
        return jnp.sum(jnp.stack(values), axis=0)

    def losses(self) -> tuple[jax.Array, jax.Array]:
        """Energy [J] lost when one bond forms, and when it breaks, per hysteretic law."""
        formation, rupture = zip(*(part.losses() for part in self.parts), strict=True)
        return jnp.concatenate(formation), jnp.concatenate(rupture)

    def _shares(self, memory: Memory) -> list[tuple[Layer, Memory]]:
        """Each interface with its own part of the memory."""
        out, first = [], 0
        for part in self.parts:
            last = first + len(part.mechanisms)
            out.append((part, memory[first:last]))
            first = last
        return out


Surfaces = Layer | Layers
"""What a rough contact presses."""
