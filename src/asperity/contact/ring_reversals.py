"""Scanning curves of a contact on a half-space, from a reversal on a major branch."""

from __future__ import annotations

from typing import Any, Protocol

from .._jax import jax, jnp
from ..interface.rough_planes import Memory as Thresholds
from .contact import Held, ReversalSampling, ScanningCurve
from .continuation import Deforming, RingMemory, with_derivatives
from .equilibrium import RingEquilibrium, solve_equilibrium

_ALIKE = 3.0  # rms heights between reversals whose curves are interpolated, at most


class Hysteretic(Deforming, Protocol):
    """A contact that scanning curves are asked of."""

    @property
    def interaction_range(self) -> jax.Array:
        """Separation beyond which nothing is felt [m]."""

    def scanning_curve(
        self, memory: RingMemory, start: jax.Array, unloading: jax.Array, within: tuple[Any, Any]
    ) -> ScanningCurve | None:
        """The scanning curve from a reversal to the major branch."""

    def update_memory(
        self, memory: RingMemory, separation: jax.Array, held: Held | None = None
    ) -> RingMemory:
        """Memory after a monotone motion."""


def ring_reversals(contact: Hysteretic) -> ReversalSampling:
    """How few scanning curves of a contact stand for all."""
    interface, interaction_range = contact.interface, contact.interaction_range
    rms = jnp.asarray(interface.scale.rms)

    def alike(low: jax.Array, high: jax.Array) -> jax.Array:
        """Where forces fall off along all of them by about as much, and they are short."""
        widths = [law.breaking_gap - law.forming_gap for law in interface.hysteretic]
        apart = high - low
        short = apart * jnp.max(jnp.stack(widths)) < rms**2
        return short & (apart < _ALIKE * rms) & (high <= interaction_range * (1.0 + 1e-12))

    def curve(
        start: jax.Array, held: Held, wanted: jax.Array, within: tuple[Any, Any]
    ) -> ScanningCurve:
        size = jax.lax.stop_gradient(held.size)
        old, flat = branch_thresholds(contact, held), jnp.zeros(contact.rings + 1)
        frozen = jax.lax.stop_gradient((contact, start, old, size, held.field))
        rest = jax.lax.cond(
            wanted,
            lambda: solve_equilibrium(*frozen, contact.rings),
            lambda: RingEquilibrium(flat, flat[:-1], jnp.zeros(())),
        )
        rest = with_derivatives(contact, start, old, size, rest)
        before = RingMemory(old, size, rest.displacement, held.outer)
        memory = contact.update_memory(before, start, held._replace(field=rest.displacement))
        memory = memory._replace(size=jnp.where(wanted, size, 0.0))
        found = contact.scanning_curve(memory, start, ~held.unloading, within)
        assert found is not None
        return found

    number = contact.resolved.reversals
    return ReversalSampling(number, rms, alike, curve, lambda memory: memory.outer)


def branch_thresholds(contact: Deforming, held: Held) -> Thresholds:
    """Thresholds on the major branch on which a body comes."""
    whole = jnp.where(held.unloading, -jnp.inf, jnp.full(contact.rings + 1, jnp.inf))
    return (whole,) * len(contact.interface.hysteretic)
