"""A rough paraboloid that does not deform in bulk, with asperities that yield."""

from __future__ import annotations

import dataclasses
from typing import Any

from .._jax import jax, jnp
from ..interface.height_quadrature import Near
from ..interface.rough_planes import Means, RoughPlanes
from ..interface.rough_planes import Memory as Thresholds
from .contact import ScanningCurve, YieldingContact
from .profile import Sphere
from .resolution import Resolution
from .rigid import RigidContact

Left = tuple[Thresholds, jax.Array, Any]


class RigidPlasticContact(RigidContact, YieldingContact):
    """A rough sphere on a plane, without bulk deformation; its asperities yield.

    Parameters
    ----------
    interface, shape, resolved
        As for :class:`~asperity.contact.rough.RoughContact`.
    left
        Memory and separation [m] at the deepest point of the first impact, where it has had one,
        and what that left of the asperities.
    """

    left: Left | None

    def __init__(
        self,
        interface: RoughPlanes,
        shape: Sphere,
        resolved: Resolution | None = None,
        left: Left | None = None,
    ) -> None:
        super().__init__(interface, shape, resolved)
        self.left = left

    def left_by(self, memory: Thresholds, separation: jax.Array) -> Left:
        return memory, separation, self.interface.flattened(memory, 1)

    def after(self, left: Left) -> RigidPlasticContact:
        return dataclasses.replace(self, left=left, interface=self.interface.as_flattened(left[2]))

    def branches(self) -> tuple[Thresholds, ...]:
        if self.left is None:
            return (self.initial_memory(),)
        memory, branch = self.left[0], self.interface.branch_memory
        unloading = (False, True) if self.interface.hysteretic else (False,)
        return tuple(branch(memory, apart) for apart in unloading)

    def branch_of(self, memory: Thresholds, unloading: jax.Array) -> jax.Array:
        apart = jnp.where(unloading, min(len(self.interface.hysteretic), 1), 0)
        return jnp.where(self.interface.has_yielded(memory), 1 + apart, 0)

    def _means(self, near: Near, places: jax.Array, memory: Thresholds) -> Means:
        if self.left is None:
            return self.interface.first_approach(places, 1)
        return super()._means(near, places, memory)

    def scanning_curve(
        self, memory: Thresholds, start: jax.Array, unloading: jax.Array, within: tuple[Any, Any]
    ) -> ScanningCurve | None:
        """As without yielding; a first approach comes from no reversal."""
        if self.left is None:
            return None
        return super().scanning_curve(memory, start, unloading, within)

    def _marks(self, start: jax.Array, ends: jax.Array) -> jax.Array:
        """Ends of pieces that narrow towards where asperities were pressed flat."""
        assert self.left is not None
        low, high = jnp.minimum(start, jnp.min(ends)), jnp.maximum(start, jnp.max(ends))
        panels = self.left[1] + self.interface.unloading_panels
        return jnp.append(jnp.clip(panels, low, high), ends)

    def panels(self, low: jax.Array, high: jax.Array) -> jax.Array:
        """More above the deepest point, where asperities spring back.

        And above where bonds of those that were hardly pressed form or break.
        """
        ends = super().panels(low, high)
        if self.left is None:
            return ends
        turn, panels = self.left[1], self.interface.unloading_panels
        bends = [jnp.asarray(law.breaking_gap, float) for law in self.interface.hysteretic]
        starts = turn + jnp.stack([jnp.zeros(()), *bends])
        # Not at the turn itself, where rounding would make a body turn that has just turned, and
        # where a panel so narrow would have no derivatives but those of rounding.
        below = turn - 1e-9 * self.interface.scale.rms
        marks = jnp.concatenate([(starts[:, None] + panels).ravel(), starts[1:], below[None]])
        marks = jnp.where(jnp.abs(marks - turn) <= turn - below, below, marks)
        return jnp.sort(jnp.concatenate([ends, jnp.clip(marks, ends[0], ends[-1])]))
