"""Scanning curves of a contact on a half-space, from a reversal on a major branch."""

from __future__ import annotations

from typing import Any

from .._jax import jax, jnp
from .contact import Held, ReversalSampling, ScanningCurve
from .continuation import RingMemory, with_derivatives
from .equilibrium import RingEquilibrium, solve_equilibrium
from .rough import DeformingContact

_ALIKE = 3.0  # rms heights between reversals whose curves are interpolated, at most


def ring_reversals(contact: DeformingContact) -> ReversalSampling:
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
        flat = jnp.zeros(contact.rings + 1)
        old = interface.branch_memory(interface.initial_memory(flat), held.unloading)
        frozen = jax.lax.stop_gradient((contact, start, old, size, held.field))
        rest = jax.lax.cond(
            wanted,
            lambda: solve_equilibrium(*frozen),
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
