"""A smooth body: one law of one contact."""

from __future__ import annotations

from collections.abc import Sequence
from functools import reduce
from itertools import product

import equinox as eqx
import numpy as np

from .._jax import jax, jnp
from ..interface.rough_planes import losses_of
from ..laws.law import Law, components_of, terms
from .contact import Contact, Held, Potential, State
from .resolution import Resolution
from .scanning_curve import STEPS, lowest_place, panels_around

Flags = jax.Array

LADDER = -1e-16 * 2.0 ** np.arange(0.0, 80.0)
"""Separations [m] down from far below any deformation that a continuum has."""


class SmoothContact(Contact):
    """A smooth body on a smooth plane: the law of one asperity with the body's radius.

    Parameters
    ----------
    law
        The law, or a sum of laws, with the radius of the body.
    resolved
        Panels of its curves on each side of a non-smooth point (static).

    Notes
    -----
    The separation is the gap. Memory: one flag a hysteretic law, whether it is bonded.
    """

    law: Law
    resolved: Resolution = eqx.field(static=True, kw_only=True, default=Resolution(STEPS))

    @property
    def _hysteretic(self) -> tuple[Law, ...]:
        return tuple(law for law in terms(self.law) if law.hysteretic)

    @property
    def mechanisms(self) -> tuple[str, ...]:
        return tuple(law.mechanism for law in self._hysteretic)

    @property
    def components(self) -> tuple[str, ...]:
        return components_of(terms(self.law))

    def branches(self) -> tuple[Flags, ...]:
        return combinations(len(self.mechanisms))

    def branch_of(self, memory: Flags, unloading: jax.Array) -> jax.Array:
        return number_of(memory)

    def state(self, separation: jax.Array, memory: Flags) -> State:
        flags = self.update_memory(memory, separation)
        each = {name: jnp.zeros_like(separation) for name in (*self.components, "energy")}
        index = 0
        for law in terms(self.law):
            on = jnp.zeros((), bool)
            if law.hysteretic:
                on, index = flags[index] > 0.5, index + 1
            for name, share in law.response(separation, on).items():
                each[name] = each[name] + share
        stored = each.pop("energy")
        parts = jnp.stack(list(each.values()))
        touching = jnp.where(separation < 0.0, 1.0, 0.0)
        return State.undeformed(separation, (self.components, parts), stored, flags, touching)

    def update_memory(
        self, memory: Flags, separation: jax.Array, held: Held | None = None
    ) -> Flags:
        rows = []
        for k, law in enumerate(self._hysteretic):
            formed = separation <= law.forming_gap
            kept = jnp.logical_and(memory[k] > 0.5, separation < law.breaking_gap)
            rows.append(jnp.where(jnp.logical_or(formed, kept), 1.0, 0.0))
        return jnp.stack(rows) if rows else jnp.zeros((0,))

    def losses(self) -> tuple[jax.Array, jax.Array]:
        return losses_of(self._hysteretic)

    def lower_bound(
        self, release: jax.Array, kinetic: jax.Array, potential: Potential
    ) -> jax.Array:
        work = jax.vmap(lambda d: self.state(d, self.initial_memory()).stored)
        return lowest_place(work, LADDER, release, kinetic, potential)

    def panels(self, low: jax.Array, high: jax.Array) -> jax.Array:
        """The kinks of all laws, with panels that narrow to each."""
        return panels_around(kinks_of(self.law), low, high, self.resolved.panels)

    @property
    def interaction_range(self) -> jax.Array:
        return reduce(jnp.maximum, [law.interaction_range for law in terms(self.law)])


def combinations(bonds: int) -> tuple[Flags, ...]:
    """All combinations of so many bonds that hold or not."""
    return tuple(jnp.asarray(bits[::-1], float) for bits in product((0.0, 1.0), repeat=bonds))


def number_of(flags: Flags) -> jax.Array:
    """Which of the :func:`combinations` some flags are."""
    return jnp.sum(jnp.where(flags > 0.5, 2 ** np.arange(flags.size), 0))


def kinks_of(law: Law) -> jax.Array:
    """Gaps [m] at which a law or its parts are not smooth, 0 first, shape (kinks,)."""
    return jnp.stack([jnp.zeros(()), *(jnp.asarray(gap, float) for gap in gaps_of(terms(law)))])


def gaps_of(laws: Sequence[Law]) -> list[jax.Array | float]:
    """Gaps [m] at which laws have kinks, bonds form or break, each once."""
    found: dict[int, jax.Array | float] = {}
    for law in laws:
        ends = (law.forming_gap, law.breaking_gap) if law.hysteretic else ()
        found |= {id(gap): gap for gap in (*law.kinks, *ends)}
    return list(found.values())
