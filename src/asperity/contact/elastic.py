"""A rough paraboloid on an elastic half-space: pressure and displacement agree."""

from __future__ import annotations

from math import ceil, pi
from typing import Any

import equinox as eqx

from .._jax import jax, jnp
from ..halfspace import ring_mesh, rings_of_mesh
from ..interface.branch_pressure import BranchPressure
from ..interface.rough_planes import Memory as Thresholds
from ..interface.rough_planes import RoughPlanes
from ..laws.law import Real, quantity
from ..numerics.trees import zeros_of
from .contact import Held, Potential, ReversalSampling, ScanningCurve, State
from .continuation import (
    RingMemory,
    continue_branch,
    continue_scanning_curve,
    first_size,
    fitted,
    table_ends,
    with_derivatives,
    with_table,
)
from .equilibrium import RingEquilibrium, profile_of
from .profile import Sphere
from .resolution import Resolution, resolution
from .rigid import RigidContact, rough_panels
from .ring_reversals import ring_reversals
from .rough import DeformingContact

_MOST_BESIDE = 9  # of the sixteen or so pieces of a whole quadrature


class ElasticContact(DeformingContact):
    """A rough sphere on a plane, both elastic half-spaces in bulk.

    Parameters
    ----------
    interface, shape
        As for :class:`~asperity.contact.rough.RoughContact`.
    modulus
        Contact modulus E* [Pa] of the bulk.
    rings
        Number of rings (static); the next multiple of 8 is taken. The force converges with a high
        order in it.
    resolved
        As there; of several pieces the last one is where the rings that lag behind reach the
        branch.
    drawn
        Energy [J] that attraction adds to what a body brings, where its curves must reach deeper
        for that; else 0.

    Notes
    -----
    The separation is h(r) = d + profile(r) + u(r) with u the displacement of the pressure
    p(h), solved by Newton's method on rings whose mesh follows the size of the contact
    (the publication's eqs. 18-20, axisymmetric). Beyond the mesh the body is rigid.
    """

    drawn: Real = quantity()

    def __init__(
        self,
        interface: RoughPlanes,
        shape: Sphere,
        modulus: Real,
        rings: int = 80,
        resolved: Resolution | None = None,
        drawn: Real = 0.0,
    ) -> None:
        self.interface = interface
        self.shape = shape
        self.modulus = modulus
        self.rings = rings_of_mesh(rings)
        self.resolved = resolved or resolution(interface, deforms=True)
        self.drawn = drawn

    @property
    def rigid(self) -> RigidContact:
        """The same contact without bulk deformation."""
        return RigidContact(self.interface, self.shape, self.resolved)

    def branches(self) -> tuple[RingMemory, ...]:
        flat = jnp.zeros(self.rings + 1)
        return tuple(
            RingMemory(thresholds, jnp.zeros(()), flat, jnp.asarray(False))
            for thresholds in self.interface.branches(flat)
        )

    def state(self, separation: jax.Array, memory: RingMemory) -> State:
        size, rest = self._alone(separation, memory)
        return self._measured(separation, memory.thresholds, size, rest)

    def _measured(
        self, separation: jax.Array, thresholds: Thresholds, size: jax.Array, rest: RingEquilibrium
    ) -> State:
        h = separation + profile_of(self, size) + rest.displacement
        area = ring_mesh(self.rings).area * size**2
        state, pressure = self.on_rings(separation, h, thresholds, size)
        bulk = 0.5 * area @ (pressure * rest.displacement[:-1])
        return state._replace(stored=state.stored + bulk, error=rest.error, field=rest.displacement)

    def on_rings(
        self, separation: jax.Array, h: jax.Array, thresholds: Thresholds, size: jax.Array
    ) -> tuple[State, jax.Array]:
        """The contact whose mean planes are apart by ``h`` [m] at its rings and the mesh's end.

        Without the energy of its bulk; and the pressure on the rings [Pa].
        """
        mesh = ring_mesh(self.rings)
        inside = self.interface.measure(h, thresholds)
        last = tuple(b[-1:] for b in thresholds)
        outside = self.interface.measure(h[-1:], last, integrated=1)
        area = mesh.area * size**2
        around = 2.0 * pi * self.shape.radius

        def whole(inner: jax.Array, outer: jax.Array) -> jax.Array:
            return inner[..., :-1] @ area + around * outer[..., 0]

        parts, *rest = jax.tree_util.tree_map(whole, inside, outside)
        state = State.undeformed(separation, (self.components, parts), *rest)
        state = state._replace(central=jnp.asarray(mesh.axis) @ h[:-1], size=size)
        return state, jnp.sum(inside.parts, axis=0)[:-1]

    def _branch(self, ends: jax.Array, places: jax.Array, memory: RingMemory) -> State:
        """From outside in, each solution the first guess of the next.

        The ends of the panels come first: there the size of the mesh is found, which is linear
        in between. The means of the planes are read from a table. Beyond the interaction range
        the body is as good as rigid.
        """
        near = places.shape[0] - self.rigid.far
        down = places[:near].ravel()[::-1]
        corners = ends[: near + 1][::-1]
        tabulated = with_table(self, corners[-1], corners[0], memory.thresholds)
        frozen = jax.lax.stop_gradient((tabulated, corners, down, memory.thresholds))
        sizes, rests = continue_branch(*frozen)
        states = tabulated._states(down, memory.thresholds, sizes, rests)
        inner = jax.tree_util.tree_map(
            lambda leaf: leaf[::-1].reshape(near, places.shape[1], *leaf.shape[1:]), states
        )
        return self._with_far(inner, ends, places, memory)

    def _states(
        self, places: jax.Array, thresholds: Thresholds, sizes: jax.Array, rests: RingEquilibrium
    ) -> State:
        """The contact at places of a branch, with the means of the planes from a table."""

        def one(place: jax.Array, size: jax.Array, rest: RingEquilibrium) -> State:
            rest = with_derivatives(self, place, thresholds, size, rest)
            return self._measured(place, thresholds, size, rest)

        states = jax.vmap(one)(places, sizes, rests)
        assert isinstance(self.interface, BranchPressure)
        return states._replace(error=jnp.maximum(states.error, self.interface.error))

    def _with_far(
        self, inner: State, ends: jax.Array, places: jax.Array, memory: RingMemory
    ) -> State:
        """A branch with the panels beyond the interaction range, where the body is rigid."""
        near = inner.force.shape[0]
        thresholds = tuple(b[-1] for b in memory.thresholds)
        outer = self.rigid._branch(ends, places[near:], thresholds)
        still = jnp.zeros((self.rigid.far, places.shape[1], *inner.field.shape[2:]))
        outer = outer._replace(field=still, size=jnp.full(places[near:].shape, inner.size[-1, -1]))
        return jax.tree_util.tree_map(lambda a, b: jnp.concatenate([a, b]), inner, outer)

    def scanning_curve(
        self, memory: RingMemory, start: jax.Array, unloading: jax.Array, within: tuple[Any, Any]
    ) -> ScanningCurve | None:
        """On the mesh of the reversal, from its displacement, step by step.

        Nowhere for a body that turned where no bond reaches.
        """
        if not self.mechanisms:
            return None
        size = jax.lax.stop_gradient(memory.size)

        def one(place: jax.Array, rest: RingEquilibrium) -> State:
            rest = with_derivatives(self, place, memory.thresholds, size, rest)
            return self._measured(place, memory.thresholds, size, rest)

        @jax.jit  # traced once, for its shapes and for itself
        def back() -> ScanningCurve:
            frozen = jax.lax.stop_gradient((self, memory, start))
            enter, leave, places, rests = continue_scanning_curve(*frozen, size, unloading, within)
            # Piece after piece: all at once take gigabytes where bonds stretch far.
            states = jax.lax.map(lambda piece: jax.vmap(one)(*piece), (places, rests))
            return ScanningCurve(enter, leave, states)

        shapes = jax.eval_shape(back)

        def nowhere() -> ScanningCurve:
            still = jnp.broadcast_to(start, shapes.enter.shape)
            return ScanningCurve(still, still, zeros_of(shapes.states))

        bound = jnp.logical_and(memory.size > 0.0, start < self.interaction_range)
        return jax.lax.cond(bound, back, nowhere)

    @property
    def pieces_beside(self) -> int:
        """Pieces of 16 nodes for bonds that are not of the branch of approach (static).

        Means are good to 1e-11 of the largest; to 5e-8 of bridges that stretch over thirty times
        the length on which they fall off. Pieces that finer scanning adds count for none.
        """
        resolved = self.resolved
        return 1 + ceil(resolved.nodes * (resolved.pieces - resolved.later) / 16)

    def means(self, low: jax.Array, high: jax.Array) -> Any:
        """Empty where pieces beside are many: their quadrature would cost as the whole does."""
        if not self.mechanisms or self.pieces_beside > _MOST_BESIDE:
            return ()
        return self.interface.approach_tables(
            table_ends(self, low, jnp.minimum(high, self.interaction_range))
        )

    def reading(self, means: Any) -> ElasticContact:
        if not means:
            return self
        planes = self.interface.reading(means, self.pieces_beside)
        return eqx.tree_at(lambda one: one.interface, self, planes)

    @property
    def reversals(self) -> ReversalSampling | None:
        return ring_reversals(self) if self.mechanisms else None

    def _alone(
        self, separation: jax.Array, memory: RingMemory
    ) -> tuple[jax.Array, RingEquilibrium]:
        """Size of the mesh and the rings at one separation, from nothing."""
        frozen, place, old = jax.lax.stop_gradient((self, separation, memory))
        bound = old.size > 0.0
        first = jnp.where(bound, old.size, first_size(frozen, place))
        size, rest = fitted(
            frozen, place, old.thresholds, first, old.displacement, jnp.logical_not(bound)
        )
        return size, with_derivatives(self, separation, memory.thresholds, size, rest)

    def update_memory(
        self, memory: RingMemory, separation: jax.Array, held: Held | None = None
    ) -> RingMemory:
        """From the displacement that the curves give there, or solved anew."""
        if held is None:
            size, rest = self._alone(separation, memory)
            old, displacement, outer = memory.thresholds, rest.displacement, jnp.asarray(False)
        else:
            size, displacement = jax.lax.stop_gradient(held.size), held.field
            # On a major branch no ring holds to what it remembered on its former mesh.
            branch = self.interface.branch_memory(memory.thresholds, held.unloading)
            pairs = zip(branch, memory.thresholds, strict=True)
            old, outer = tuple(jnp.where(held.outer, new, b) for new, b in pairs), held.outer
        h = separation + profile_of(self, size) + displacement
        return RingMemory(self.interface.remember(old, h), size, displacement, outer)

    def lower_bound(
        self, release: jax.Array, kinetic: jax.Array, potential: Potential
    ) -> jax.Array:
        """The rigid contact's, less the depth at which Hertz stores the energy alone."""
        lowest = self.rigid.lower_bound(release, kinetic, potential)
        fall = jnp.maximum(kinetic + potential(release) - potential(lowest), 0.0)
        fall = fall + self.drawn
        depth = (15.0 / 8.0 * fall / (self.modulus * jnp.sqrt(self.shape.radius))) ** 0.4
        # The deeper fall through that depth feeds it once more.
        fall = fall + potential(lowest) - potential(lowest - depth)
        depth = (15.0 / 8.0 * fall / (self.modulus * jnp.sqrt(self.shape.radius))) ** 0.4
        return lowest - 1.1 * depth

    def panels(self, low: jax.Array, high: jax.Array) -> jax.Array:
        return rough_panels(self.rigid, low, high, self.resolved.panels)

    @property
    def interaction_range(self) -> jax.Array:
        return self.rigid.interaction_range
