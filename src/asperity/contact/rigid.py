"""A rough paraboloid that does not deform in bulk."""

from __future__ import annotations

import dataclasses
from math import pi

import equinox as eqx
import numpy as np

from .._jax import jax, jnp
from ..interface import Interface
from ..interface import Memory as Thresholds
from ..shapes import Sphere
from .base import Contact, State, first_out_of_reach

_PANELS = 26
_LINEAR = 4.0  # panels are even in asinh(separation / (_LINEAR rms))


class RigidContact(Contact):
    """A rough sphere on a plane, without bulk deformation.

    Parameters
    ----------
    interface
        What happens between the two mean planes.
    shape
        The body.
    refinement
        Factor on the number of panels of its curves (static).
    inner_panels
        Pieces of the way from a reversal to the outermost branch (static): one for every
        1.5 rms that a law's bonds stretch.

    Notes
    -----
    Every place of a rigid body moves alike, so one threshold a law remembers the whole
    contact. Forces are 2 pi R times the integral of the pressure over the separation,
    which for Gaussian heights raises the order of each height integral by one.
    """

    interface: Interface
    shape: Sphere
    refinement: int = eqx.field(static=True, default=1)
    inner_panels: int = eqx.field(static=True, default=1)

    @property
    def reversal_panels(self) -> int:
        return self.inner_panels

    @property
    def mechanisms(self) -> tuple[str, ...]:
        return self.interface.mechanisms

    @property
    def components(self) -> tuple[str, ...]:
        return self.interface.components

    @property
    def _measure(self) -> jax.Array:
        return jnp.asarray(2.0 * pi * self.shape.radius)

    def refined(self, factor: int) -> RigidContact:
        return dataclasses.replace(self, refinement=factor)

    def fresh(self) -> Thresholds:
        return self.interface.fresh()

    def extreme(self, bonded: tuple[bool, ...]) -> Thresholds:
        return tuple(jnp.asarray(-jnp.inf if is_bonded else jnp.inf) for is_bonded in bonded)

    def state(self, separation: jax.Array, memory: Thresholds) -> State:
        means = self.interface.measure(separation, memory, lift=1)
        parts = self._measure * means.parts
        return State(
            force=jnp.sum(parts),
            stored=self._measure * means.energy,
            central=separation,
            bonds=self._measure * means.bonds,
            parts=parts,
            touching=self._measure * means.touching,
            error=jnp.full_like(separation, 1e-16),
            size=jnp.zeros_like(separation),
            elastic=self.elastic_part(parts),
        )

    def remember(
        self, memory: Thresholds, separation: jax.Array, size: jax.Array | None = None
    ) -> Thresholds:
        return self.interface.remember(memory, separation)

    def bonded(self, memory: Thresholds) -> jax.Array:
        return jnp.zeros(len(self.mechanisms), bool)

    def switches(self, memory: Thresholds, separation: jax.Array, parting: jax.Array) -> jax.Array:
        rows = [
            b + jnp.where(parting, law.breaking_gap, law.forming_gap)
            for law, b in zip(self.interface.hysteretic, memory, strict=True)
        ]
        return jnp.stack(rows) if rows else jnp.zeros((0,))

    def losses(self) -> tuple[jax.Array, jax.Array]:
        return self.interface.losses()

    def floor(self, release: jax.Array, kinetic: jax.Array, weight: jax.Array) -> jax.Array:
        ladder = jnp.append(release, _LADDER * self.interface.heights.rms)
        stored = self._measure * self.interface.energy(ladder, self.fresh(), lift=1)
        energy = stored + weight * ladder
        level = energy[0] + kinetic
        return first_out_of_reach(energy[1:], level + 1e-9 * jnp.abs(level), ladder[1:], release)

    def panels(self, low: jax.Array, high: jax.Array) -> jax.Array:
        return asinh_panels(low, high, self.interface.heights.rms, _PANELS * self.refinement)

    @property
    def reach(self) -> jax.Array:
        return 9.0 * self.interface.heights.rms + self.interface.reach


_LADDER = np.concatenate([np.arange(9.0, -3.0, -0.5), -3.0 * 2.0 ** np.arange(0.0, 60.0, 0.5)])


def asinh_panels(low: jax.Array, high: jax.Array, rms: jax.Array | float, count: int) -> jax.Array:
    """Ends of panels, even over a few rms around 0 and in proportion to |d| far from it."""
    scale = _LINEAR * rms
    ends = jnp.linspace(jnp.arcsinh(low / scale), jnp.arcsinh(high / scale), count + 1)
    inner = scale * jnp.sinh(ends)
    return inner.at[0].set(low).at[-1].set(high)
