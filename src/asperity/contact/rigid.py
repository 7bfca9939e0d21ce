"""A rough paraboloid that does not deform in bulk."""

from __future__ import annotations

import dataclasses
from math import pi
from typing import Any

import numpy as np

from .._jax import jax, jnp
from ..interface.height_quadrature import Near
from ..interface.rough_planes import Means, RoughPlanes
from ..interface.rough_planes import Memory as Thresholds
from ..numerics.polynomials import points_between
from .contact import (
    Held,
    Potential,
    ScanningCurve,
    State,
)
from .profile import Sphere
from .resolution import LINEAR, Resolution, resolution
from .rough import RoughContact
from .scanning_curve import by_mechanism, lowest_place, pieces_for, pieces_to

_FAR = 2  # panels beyond the interaction range, in geometric progression
_FAR_TAIL = 20  # where a force may go on there: each at most 2.5 times as far, up to 2e7 reaches


class RigidContact(RoughContact):
    """A rough sphere on a plane, without bulk deformation.

    Parameters
    ----------
    interface, shape, resolved
        As for :class:`~asperity.contact.rough.RoughContact`.

    Notes
    -----
    Every place of a rigid body moves alike, so one threshold a law remembers the whole
    contact. Forces are 2 pi R times the integral of the pressure over the separation,
    which for Gaussian heights raises the order of each height integral by one.
    """

    def __init__(
        self, interface: RoughPlanes, shape: Sphere, resolved: Resolution | None = None
    ) -> None:
        self.interface = interface
        self.shape = shape
        self.resolved = resolved or resolution(interface, deforms=False)

    @property
    def _measure(self) -> jax.Array:
        return jnp.asarray(2.0 * pi * self.shape.radius)

    @property
    def far(self) -> int:
        """Panels beyond the interaction range. Without values."""
        return _FAR if self.interface.only_bonded else _FAR_TAIL

    def initial_memory(self) -> Thresholds:
        return self.interface.initial_memory()

    def branches(self) -> tuple[Thresholds, ...]:
        return self.interface.branches()

    def state(self, separation: jax.Array, memory: Thresholds) -> State:
        return self._state(separation, self.interface.measure(separation, memory, integrated=1))

    def _branch(self, ends: jax.Array, places: jax.Array, memory: Thresholds) -> State:
        """Places of one panel share their quadrature; far out only where all forces have ended.

        That holds for places within some 27 rms heights, as panels are but far below the mean
        plane: see :meth:`place_by_place`.
        """
        if not self.resolved.shared:
            return super()._branch(ends, places, memory)
        count = places.shape[0] - (0 if self.interface.only_bonded else self.far)
        states = [self._states(Near(True, self.resolved.shared), places[:count], memory)]
        if count < places.shape[0]:
            states.append(super()._branch(ends, places[count:], memory))
        return jax.tree_util.tree_map(lambda *rows: jnp.concatenate(rows), *states)

    def place_by_place(self) -> RigidContact | None:
        """The contact with a quadrature at each place of a panel, where places share theirs.

        It takes longer to compile and to solve. None where means are closed forms, or each place
        has its own already.
        """
        if type(self) is not RigidContact or self.interface.closed or not self.resolved.shared:
            return None
        return dataclasses.replace(self, resolved=self.resolved._replace(shared=0))

    def _states(self, near: Near, places: jax.Array, memory: Thresholds) -> State:
        """The contact at rows of places [m], those of a row near one another."""
        means = self._means(near, places, memory)
        # Its rows of forces and of bonds last, for one place to have all of them.
        parts, bonds = (jnp.moveaxis(rows, 0, -1) for rows in (means.parts, means.bonds))
        return jax.vmap(jax.vmap(self._state))(places, means._replace(parts=parts, bonds=bonds))

    def _means(self, near: Near, places: jax.Array, memory: Thresholds) -> Means:
        """At rows of places near one another, on a branch or on the way to it."""
        return self.interface.measure(places, memory, 1, near)

    def _state(self, separation: jax.Array, means: Means) -> State:
        parts, *rest = (self._measure * mean for mean in means)
        return State.undeformed(separation, (self.components, parts), *rest)

    def update_memory(
        self, memory: Thresholds, separation: jax.Array, held: Held | None = None
    ) -> Thresholds:
        return self.interface.remember(memory, separation)

    def scanning_curve(
        self, memory: Thresholds, start: jax.Array, unloading: jax.Array, within: tuple[Any, Any]
    ) -> ScanningCurve | None:
        """Every bond of a law that is held reaches the branch at the same separation.

        Classes of radius share their pieces, which are cut where each of them reaches it.
        """
        if not self.interface.hysteretic:
            return None
        ends = self.interface.rejoining(memory, unloading)
        marks = [self._marks(start, some) for some in by_mechanism(self.interface.hysteretic, ends)]
        enter, leave = pieces_to(jnp.concatenate(marks), start, unloading, within)
        places = enter[:, None] + (leave - enter)[:, None] * points_between(self.resolved.nodes)
        return ScanningCurve(enter, leave, self._states(Near(level=False), places, memory))

    def _marks(self, start: jax.Array, ends: jax.Array) -> jax.Array:
        """Ends of pieces from a reversal to the last of the ends of some bonds, and those ends."""
        end = ends[jnp.argmax(jnp.abs(ends - start))]
        pieces, narrowing = pieces_for(ends, self.resolved.pieces), self.resolved.later
        even = np.linspace(0.0, 1.0, pieces - narrowing + 1)[1:]
        outward = np.append(even[0] * 2.0 ** -np.arange(narrowing, 0.0, -1.0), even)
        inward = np.append(1.0 - outward[-2::-1], 1.0)
        marks = start + (end - start) * jnp.where(end > start, outward, inward)
        return marks if ends.size == 1 else jnp.concatenate([marks, ends])

    def lower_bound(
        self, release: jax.Array, kinetic: jax.Array, potential: Potential
    ) -> jax.Array:
        ladder = _LADDER * self.interface.scale.rms
        return lowest_place(self._work, ladder, release, kinetic, potential)

    def _work(self, places: jax.Array) -> jax.Array:
        """Work [J] of the first approach to separations [m]."""
        return self._measure * self.interface.work_of_approach(places, integrated=1)

    def panels(self, low: jax.Array, high: jax.Array) -> jax.Array:
        return rough_panels(self, low, high, self.resolved.panels)

    @property
    def interaction_range(self) -> jax.Array:
        return self.interface.scale.top + self.interface.interaction_range


_LADDER = np.concatenate([np.arange(9.0, -3.0, -0.5), -3.0 * 2.0 ** np.arange(0.0, 50.0)])


def rough_panels(contact: RigidContact, low: jax.Array, high: jax.Array, count: int) -> jax.Array:
    """Ends of ``count`` panels over the range of a rough contact, and of those beyond it.

    Even over a few rms around 0 and in proportion to |d| far from it.
    """
    scale = LINEAR * contact.interface.scale.rms
    top = jnp.clip(contact.interaction_range, low, high)
    ends = jnp.linspace(jnp.arcsinh(low / scale), jnp.arcsinh(top / scale), count + 1)
    near = (scale * jnp.sinh(ends)).at[0].set(low).at[-1].set(top)
    ratio = jnp.maximum(high / jnp.where(top > 0.0, top, high), 1.0)
    steps = np.arange(1.0, contact.far + 1.0) / contact.far
    far = jnp.where(top < high, top * ratio**steps, high)
    return jnp.concatenate([near, far.at[-1].set(high)])
