"""Means over heights by name: which of them laws ask for, and how they are put together.

A name is a mechanism of the force, "energy", "contacting", or "bonds k" of law number k.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import NamedTuple

from .._jax import jax, jnp
from ..laws.law import Law, TruncatedPower
from .rough_planes import Means, Memory


class Ask(NamedTuple):
    """A mean that is asked for: of a truncated power, times a power of the tip radius."""

    name: str
    term: TruncatedPower
    size: float


def bond_gaps(laws: Sequence[Law], separation: jax.Array, memory: Memory) -> list[jax.Array]:
    """Gap [m] of each law below which asperities are bonded: the clamp, seen from the gap."""
    thresholds, none = iter(memory), jnp.full_like(separation, -jnp.inf)
    return [
        jnp.clip(separation - next(thresholds), law.forming_gap, law.breaking_gap)
        if law.hysteretic
        else none
        for law in laws
    ]


def asked_powers(laws: Sequence[Law], edges: Sequence[jax.Array]) -> list[Ask]:
    """All that laws ask for that are bonded up to the gaps ``edges`` [m].

    Of a law that is no sum of truncated powers, its bonds alone.
    """
    asked = [Ask("contacting", TruncatedPower(1.0, 0.0, 0.0), 0.0)]
    for k, (law, edge) in enumerate(zip(laws, edges, strict=True)):
        size = law.radius_power
        if law.hysteretic:
            asked.append(Ask(f"bonds {k}", TruncatedPower(1.0, 0.0, edge), size))
        force, energy = law.powers(edge) or ((), ())
        asked += [Ask(law.mechanism, term, size) for term in force]
        asked += [Ask("energy", term, size) for term in energy]
    return asked


def means_of(
    laws: Sequence[Law],
    components: Sequence[str],
    sums: Mapping[str, jax.Array],
    separation: jax.Array,
) -> Means:
    """The means that belong to some names, at separations [m]; a force not named is 0."""
    zero = jnp.zeros_like(separation)
    bonds = [sums[f"bonds {k}"] for k, law in enumerate(laws) if law.hysteretic]
    return Means(
        parts=jnp.stack([sums.get(name, zero) for name in components]),
        energy=sums.get("energy", zero),
        bonds=jnp.stack(bonds) if bonds else jnp.zeros((0, *separation.shape)),
        contacting=sums["contacting"],
    )
