"""The publication's conjunction: a rigid sphere over pressures that end at an edge."""

from __future__ import annotations

import dataclasses
from math import pi

import equinox as eqx
import numpy as np

from .._jax import jax, jnp
from ..laws.base import Real, quantity
from ..laws.published import PublishedPressure
from ..shapes import Sphere
from .base import Contact, Held, State, first_out_of_reach

_PANELS = 2  # between two kinks of the pressures
_NODES, _WEIGHTS = (np.asarray(a) for a in np.polynomial.legendre.leggauss(16))
_LADDER = 1.0 - 2.0 ** np.arange(-14.0, 21.0)  # of the edge: each depth twice the one before


class PublishedContact(Contact):
    """A rough sphere by the publication's equations, without bulk deformation.

    Parameters
    ----------
    pressure
        The mean pressures.
    shape
        The body.
    parting_only
        1 where adhesion and menisci pull only while the bodies part: what the published
        decrements say, and no law that a bond could follow. 0 where they always pull.
    count
        Panels of the curves between two kinks (static).

    Notes
    -----
    With ``parting_only`` the way out takes from the body what the pull does over it. It is
    booked like bonds that break: :attr:`State.bonds` holds the work [J] that each pull would
    still do from here to the edge, a joule of it is lost for each joule that goes, and
    nothing when it comes back on the way in. The memory is whether the bodies part.
    """

    pressure: PublishedPressure
    shape: Sphere
    parting_only: Real = quantity(1.0)
    count: int = eqx.field(static=True, default=_PANELS)

    @property
    def mechanisms(self) -> tuple[str, ...]:
        return ("adhesion", "capillary")

    @property
    def components(self) -> tuple[str, ...]:
        return ("elastic", *self.mechanisms)

    @property
    def datum(self) -> jax.Array:
        """The edge of the conjunction."""
        return self.pressure.end

    def refined(self, factor: int) -> PublishedContact:
        return dataclasses.replace(self, count=factor * self.count)

    def fresh(self) -> jax.Array:
        return jnp.zeros(())

    def extreme(self, bonded: tuple[bool, ...]) -> jax.Array:
        return jnp.asarray(1.0 if any(bonded) else 0.0)

    def state(self, separation: jax.Array, memory: jax.Array) -> State:
        """The contact at a rigid separation; ``memory`` is 1 where the bodies part, 0 else."""
        force, energy, touching = self._integrals(separation)
        lost = self.parting_only
        parts = jnp.concatenate([force[:1], -(1.0 - lost * (1.0 - memory)) * force[1:]])
        return State(
            force=jnp.sum(parts),
            stored=energy[0] - (1.0 - lost) * jnp.sum(energy[1:]),
            central=separation,
            bonds=lost * energy[1:],
            parts=parts,
            touching=touching,
            error=jnp.full_like(separation, 1e-16),
            size=jnp.zeros_like(separation),
            elastic=force[0],
            field=jnp.zeros(0),
        )

    def _integrals(self, separation: jax.Array) -> tuple[jax.Array, jax.Array, jax.Array]:
        """Force [N] and energy [J] of each pressure from here to the edge; touching asperities."""
        p = self.pressure
        start = jnp.minimum(separation, p.end)
        marks = jnp.sort(jnp.clip(jnp.stack([start, *p.kinks, p.end]), start, p.end))
        half = 0.5 * jnp.diff(marks)[:, None]
        places = (marks[:-1, None] + half * (_NODES + 1.0)).ravel()
        weights = 2.0 * pi * self.shape.radius * (half * _WEIGHTS).ravel()
        values = jnp.stack([p.contact(places), p.adhesion(places), p.capillary(places)])
        touching = p.touching(places) @ weights
        return values @ weights, values @ (weights * (places - start)), touching

    def remember(self, memory: jax.Array, separation: jax.Array) -> jax.Array:
        return memory

    def turned(self, memory: jax.Array, separation: jax.Array, held: Held) -> jax.Array:
        return jnp.where(held.parting, 0.0, 1.0)

    def bonded(self, memory: jax.Array) -> jax.Array:
        return jnp.zeros(len(self.mechanisms), bool)

    def losses(self) -> tuple[jax.Array, jax.Array]:
        """A joule of work undone costs nothing, a joule done is lost."""
        return jnp.zeros(len(self.mechanisms)), jnp.ones(len(self.mechanisms))

    def floor(self, release: jax.Array, kinetic: jax.Array, weight: jax.Array) -> jax.Array:
        ladder = jnp.append(release, _LADDER * self.pressure.end)
        stored = jax.vmap(lambda d: self.state(d, self.fresh()).stored)(ladder)
        energy = stored + weight * ladder
        level = energy[0] + kinetic
        return first_out_of_reach(energy[1:], level + 1e-9 * jnp.abs(level), ladder[1:], release)

    def panels(self, low: jax.Array, high: jax.Array) -> jax.Array:
        marks = jnp.stack([low, *self.pressure.kinks, self.pressure.end])
        marks = jnp.sort(jnp.clip(marks, low, high))
        steps = np.arange(self.count) / self.count
        near = (marks[:-1, None] + jnp.diff(marks)[:, None] * steps).ravel()
        return jnp.concatenate([near, jnp.stack([marks[-1], high])])

    @property
    def reach(self) -> jax.Array:
        return self.pressure.end
