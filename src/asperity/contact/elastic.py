"""A rough paraboloid on an elastic half-space: pressure and displacement agree."""

from __future__ import annotations

import dataclasses
from math import pi
from typing import Any, NamedTuple

import equinox as eqx
import numpy as np

from .._jax import jax, jnp
from ..halfspace import ring_mesh
from ..interface import Interface
from ..interface import Memory as Thresholds
from ..laws.base import Real, quantity
from ..program import kept
from ..shapes import Sphere
from .base import Contact, Held, State, Way, pieces_to, way_points
from .rigid import FAR, RigidContact, rough_panels
from .settling import Rest, asked_size, resting, rise_of, settle

_FIT = 0.02  # how closely the mesh fits the pressure
_PASSES = 12  # of that fit, at most
_MORE = 1.02  # than the way at the first rate


@kept
class RingMemory(NamedTuple):
    """Thresholds on the rings of a mesh of a given size.

    Attributes
    ----------
    thresholds
        One array a hysteretic law, shape (rings + 1,); the last belongs to the mesh's end.
    size
        Length [m] of the mesh; 0 where all thresholds are infinite and the mesh is free.
    lift
        Displacement [m] of the rings at the last reversal, shape (rings + 1,).
    """

    thresholds: Thresholds
    size: jax.Array
    lift: jax.Array


class _Trail(NamedTuple):
    """The last three places and displacements of the rings there, newest first."""

    places: jax.Array
    lifts: jax.Array

    @classmethod
    def straight(cls, place: jax.Array, lift: jax.Array, rate: jax.Array, step: jax.Array):  # type: ignore[no-untyped-def]
        """Rings that came by ``rate`` in steps of ``step`` [m]."""
        back = -step * np.arange(3.0)
        return cls(place + back, lift + back[:, None] * rate)

    def guess(self, place: jax.Array) -> jax.Array:
        """The parabola through them, at a place further on."""
        (a, b, c), x = self.places, place
        apart = (a - b) * (b - c) * (c - a)
        safe = jnp.where(apart == 0.0, 1.0, apart)
        weights = jnp.stack(
            [
                (x - b) * (x - c) * (c - b) / safe,
                (x - a) * (x - c) * (a - c) / safe,
                (x - a) * (x - b) * (b - a) / safe,
            ]
        )
        return jnp.where(apart == 0.0, self.lifts[0], weights @ self.lifts)

    def append(self, place: jax.Array, lift: jax.Array) -> _Trail:
        """With one more, the oldest dropped."""
        return _Trail(
            jnp.concatenate([place[None], self.places[:-1]]),
            jnp.concatenate([lift[None], self.lifts[:-1]]),
        )


class ElasticContact(Contact):
    """A rough sphere on a plane, both elastic half-spaces in bulk.

    Parameters
    ----------
    interface
        What happens between the two mean planes.
    shape
        The body.
    modulus
        Contact modulus E* [Pa] of the bulk.
    rings
        Number of rings (static). The force converges with a high order in it.
    panel_count, inner_nodes, inner_panels
        As for :class:`RigidContact`; of several pieces the last one is where the rings that
        lag behind reach the branch.

    Notes
    -----
    The separation is h(r) = d + rise(r) + u(r) with u the displacement of the pressure
    p(h), solved by Newton's method on rings whose mesh follows the size of the contact
    (the publication's eqs. 18-20, axisymmetric). Beyond the mesh the body is rigid.
    """

    interface: Interface
    shape: Sphere
    modulus: Real = quantity()
    rings: int = eqx.field(static=True, default=80)
    panel_count: int = eqx.field(static=True, default=8)
    inner_nodes: int = eqx.field(static=True, default=16)
    inner_panels: int = eqx.field(static=True, default=2)

    @property
    def mechanisms(self) -> tuple[str, ...]:
        return self.interface.mechanisms

    @property
    def components(self) -> tuple[str, ...]:
        return self.interface.components

    @property
    def reversal_panels(self) -> int:
        return self.inner_panels

    @property
    def reversal_nodes(self) -> int:
        return self.inner_nodes

    @property
    def rigid(self) -> RigidContact:
        """The same contact without bulk deformation."""
        return RigidContact(self.interface, self.shape)

    def refined(self, factor: int) -> ElasticContact:
        return dataclasses.replace(self, panel_count=factor * self.panel_count)

    def fresh(self) -> RingMemory:
        return self.extreme((False,) * len(self.mechanisms))

    def extreme(self, bonded: tuple[bool, ...]) -> RingMemory:
        rows = tuple(
            jnp.full(self.rings + 1, -jnp.inf if is_bonded else jnp.inf) for is_bonded in bonded
        )
        return RingMemory(rows, jnp.zeros(()), jnp.zeros(self.rings + 1))

    def state(self, separation: jax.Array, memory: RingMemory) -> State:
        size, rest = self._alone(separation, memory)
        return self._measured(separation, memory.thresholds, size, rest)

    def _measured(
        self, separation: jax.Array, thresholds: Thresholds, size: jax.Array, rest: Rest
    ) -> State:
        mesh = ring_mesh(self.rings)
        h = separation + rise_of(self, size, self.rings) + rest.lift
        inside = self.interface.measure(h, thresholds)
        outside = self.interface.measure(h[-1:], _last(thresholds), lift=1)
        area = mesh.area * size**2
        around = 2.0 * pi * self.shape.radius

        def whole(inner: jax.Array, outer: jax.Array) -> jax.Array:
            return inner[..., :-1] @ area + around * outer[..., 0]

        parts = whole(inside.parts, outside.parts)
        pressure = jnp.sum(inside.parts, axis=0)[:-1]
        bulk = 0.5 * area @ (pressure * rest.lift[:-1])
        return State(
            force=jnp.sum(parts),
            stored=whole(inside.energy, outside.energy) + bulk,
            central=mesh.axis @ h[:-1],
            bonds=whole(inside.bonds, outside.bonds),
            parts=parts,
            touching=whole(inside.touching, outside.touching),
            error=rest.error,
            size=size,
            elastic=self.elastic_part(parts),
            field=rest.lift,
        )

    def _rest(
        self, separation: jax.Array, thresholds: Thresholds, size: jax.Array, rest: Rest
    ) -> Rest:
        """Rings that settled, with the derivatives of where they lie."""
        held = jax.lax.stop_gradient((size, rest.lift))
        return rest._replace(
            lift=resting(self, separation, thresholds, *held, rings=self.rings)
        )

    def branch(self, ends: jax.Array, places: jax.Array, memory: RingMemory) -> State:
        """From outside in, each solution the first guess of the next.

        The ends of the panels come first: there the size of the mesh is found, which is linear
        in between. Beyond the reach of the forces the body is as good as rigid.
        """
        near = places.shape[0] - FAR
        down = places[:near].ravel()[::-1]
        frozen = jax.lax.stop_gradient((self, ends[: near + 1][::-1], down, memory.thresholds))
        sizes, rests = _descend(*frozen)

        def one(place: jax.Array, size: jax.Array, rest: Rest) -> State:
            rest = self._rest(place, memory.thresholds, size, rest)
            return self._measured(place, memory.thresholds, size, rest)

        states = jax.vmap(one)(down, sizes, rests)
        inner = jax.tree_util.tree_map(
            lambda leaf: leaf[::-1].reshape(near, places.shape[1], *leaf.shape[1:]), states
        )
        thresholds = tuple(b[-1] for b in memory.thresholds)
        outer = self.rigid.branch(ends, places[near:], thresholds)
        still = jnp.zeros((FAR, places.shape[1], *inner.field.shape[2:]))
        outer = outer._replace(field=still, size=jnp.full(places[near:].shape, sizes[0]))
        return jax.tree_util.tree_map(lambda a, b: jnp.concatenate([a, b]), inner, outer)

    def way(
        self, memory: RingMemory, start: jax.Array, parting: jax.Array, within: tuple[Any, Any]
    ) -> Way:
        """On the mesh of the reversal, from its displacement, step by step.

        Nowhere for a body that turned where no bond reaches.
        """
        size = jax.lax.stop_gradient(memory.size)

        def one(place: jax.Array, rest: Rest) -> State:
            rest = self._rest(place, memory.thresholds, size, rest)
            return self._measured(place, memory.thresholds, size, rest)

        @jax.jit  # traced once, for its shapes and for itself
        def back() -> Way:
            frozen = jax.lax.stop_gradient((self, memory, start))
            enter, leave, places, rests = _retrace(*frozen, size, parting, within)
            return Way(enter, leave, jax.vmap(jax.vmap(one))(places, rests))

        shapes = jax.eval_shape(back)

        def nowhere() -> Way:
            blank = jax.tree_util.tree_map(lambda leaf: jnp.zeros(leaf.shape, leaf.dtype), shapes)
            still = jnp.broadcast_to(start, shapes.enter.shape)
            return Way(still, still, blank.states)

        bound = jnp.logical_and(memory.size > 0.0, start < self.reach)
        return jax.lax.cond(bound, back, nowhere)

    def _alone(self, separation: jax.Array, memory: RingMemory) -> tuple[jax.Array, Rest]:
        """Size of the mesh and the rings at one separation, from nothing."""
        frozen, place, old = jax.lax.stop_gradient((self, separation, memory))
        bound = old.size > 0.0
        first = jnp.where(bound, old.size, _first_size(frozen, place))
        size, rest = _fitted(
            frozen, place, old.thresholds, first, old.lift, jnp.logical_not(bound)
        )
        return size, self._rest(separation, memory.thresholds, size, rest)

    def remember(self, memory: RingMemory, separation: jax.Array) -> RingMemory:
        size, rest = self._alone(separation, memory)
        h = separation + rise_of(self, size, self.rings) + rest.lift
        return RingMemory(self.interface.remember(memory.thresholds, h), size, rest.lift)

    def turned(self, memory: RingMemory, separation: jax.Array, held: Held) -> RingMemory:
        """From the displacement that the curves give there."""
        size = jax.lax.stop_gradient(held.size)
        h = separation + rise_of(self, size, self.rings) + held.field
        # On an outermost branch no ring holds to what it remembered on its former mesh.
        swept = jnp.where(held.parting, -jnp.inf, jnp.inf)
        old = tuple(jnp.where(held.outer, swept, b) for b in memory.thresholds)
        return RingMemory(self.interface.remember(old, h), size, held.field)

    def bonded(self, memory: RingMemory) -> jax.Array:
        return jnp.zeros(len(self.mechanisms), bool)

    def switches(self, memory: RingMemory, separation: jax.Array, parting: jax.Array) -> jax.Array:
        """Where the slowest ring has passed from one outermost branch to the other."""
        _, rest = self._alone(separation, memory)
        marks = _marks(self, memory, separation, parting, rest)
        return marks[self.reversal_panels - 1 :: self.reversal_panels]

    def losses(self) -> tuple[jax.Array, jax.Array]:
        return self.interface.losses()

    def floor(self, release: jax.Array, kinetic: jax.Array, weight: jax.Array) -> jax.Array:
        """The rigid contact's, less the depth at which Hertz stores the energy alone."""
        lowest = self.rigid.floor(release, kinetic, weight)
        fall = kinetic + weight * (release - lowest)
        depth = (15.0 / 8.0 * fall / (self.modulus * jnp.sqrt(self.shape.radius))) ** 0.4
        # The deeper fall through that depth feeds it once more.
        fall = fall + weight * depth
        depth = (15.0 / 8.0 * fall / (self.modulus * jnp.sqrt(self.shape.radius))) ** 0.4
        return lowest - 1.1 * depth

    def panels(self, low: jax.Array, high: jax.Array) -> jax.Array:
        return rough_panels(self.rigid, low, high, self.panel_count)

    @property
    def reach(self) -> jax.Array:
        return self.rigid.reach


def _last(thresholds: Thresholds) -> Thresholds:
    return tuple(b[-1:] for b in thresholds)


def _first_size(contact: ElasticContact, separation: jax.Array) -> jax.Array:
    """Size of the mesh before anything is solved: light contact, and Hertz's radius."""
    sigma, radius = contact.interface.heights.rms, contact.shape.radius
    light = 3.0 * radius * sigma / (1.0 + jnp.maximum(separation / sigma, 0.0))
    return jnp.sqrt(light + radius * jnp.maximum(-separation, 0.0))


def _marks(
    contact: ElasticContact,
    memory: RingMemory,
    start: jax.Array,
    parting: jax.Array,
    rest: Rest,
) -> jax.Array:
    """Ends of the pieces of the way back: even ones until the fastest ring has passed from
    one branch to the other, and one more until the slowest has, for each law.

    There are no such ways for a body that is on a branch already.
    """
    slowest = jnp.clip(jnp.min(rest.rates), 1e-3, 1.0)
    fastest = jnp.maximum(jnp.max(rest.rates), slowest)
    even = np.arange(1.0, contact.reversal_panels) / max(contact.reversal_panels - 1, 1)
    shares = jnp.append(even / fastest, _MORE / slowest)
    ahead = jnp.where(parting, 1.0, -1.0) * (memory.size > 0.0)
    rows = [
        start + ahead * (law.breaking_gap - law.forming_gap) * shares
        for law in contact.interface.hysteretic
    ]
    return jnp.concatenate(rows)


def _fitted(
    contact: ElasticContact,
    place: jax.Array,
    thresholds: Thresholds,
    size: jax.Array,
    lift: jax.Array,
    free: jax.Array,
) -> tuple[jax.Array, Rest]:
    """The rings at one place, on a mesh whose size fits the pressure where it is ``free``."""
    rings = contact.rings
    flat = jnp.zeros_like(lift)

    def again(now: tuple[Any, ...]) -> tuple[Any, ...]:
        size, ratio, rest, passes = now
        size = size * ratio
        rest = settle(contact, place, thresholds, size, rest.lift, rings)
        return size, jnp.where(free, asked_size(rest, rings), 1.0), rest, passes + 1

    def unfit(now: tuple[Any, ...]) -> jax.Array:
        off = jnp.logical_and(jnp.abs(now[1] - 1.0) > _FIT, now[3] < _PASSES)
        return jnp.logical_or(now[3] == 0, off)

    blank = Rest(lift, flat, flat[:-1], jnp.zeros(()))
    size, _, rest, _ = jax.lax.while_loop(unfit, again, (size, jnp.ones(()), blank, 0))
    return size, rest


def _descend(
    contact: ElasticContact, corners: jax.Array, places: jax.Array, thresholds: Thresholds
) -> tuple[jax.Array, Rest]:
    """Sizes and rings at descending ``places`` within panels that end at ``corners``."""
    count = corners.shape[0]
    sigma = contact.interface.heights.rms
    flat = jnp.zeros(contact.rings + 1)
    above = _Trail.straight(corners[0] + sigma, flat, flat, -sigma)

    def step(carry: tuple[_Trail, jax.Array, jax.Array], job: tuple[jax.Array, jax.Array]) -> Any:
        trail, factor, sizes = carry
        k, place = job
        corner = k < count
        trail = jax.tree_util.tree_map(lambda a, b: jnp.where(k == count, a, b), above, trail)
        light = _first_size(contact, place)
        between = jnp.interp(place, corners[::-1], sizes[::-1])
        size, rest = _fitted(
            contact,
            place,
            thresholds,
            jnp.where(corner, light * factor, between),
            jnp.where(corner, trail.lifts[0], trail.guess(place)),
            corner,
        )
        sizes = jnp.where(jnp.arange(count) == k, size, sizes)
        return (trail.append(place, rest.lift), size / light, sizes), (size, rest)

    begin = (above, jnp.ones(()), jnp.ones(count))
    jobs = jnp.concatenate([corners, places])
    _, found = jax.lax.scan(step, begin, (jnp.arange(jobs.shape[0]), jobs))
    sizes, rests = jax.tree_util.tree_map(lambda leaf: leaf[count:], found)
    return sizes, rests


def _retrace(
    contact: ElasticContact,
    memory: RingMemory,
    start: jax.Array,
    size: jax.Array,
    parting: jax.Array,
    within: tuple[Any, Any],
) -> tuple[jax.Array, jax.Array, jax.Array, Rest]:
    """Pieces of the way back, places on them and the rings there; first of all at the start."""
    nodes = contact.reversal_nodes
    steps = way_points(nodes)
    sigma = contact.interface.heights.rms
    pieces = len(contact.mechanisms) * contact.reversal_panels
    whole = jnp.broadcast_to(start, (pieces,))
    flat = jnp.zeros_like(memory.lift)

    def step(carry: tuple[_Trail, jax.Array, jax.Array], k: jax.Array) -> Any:
        trail, enter, leave = carry
        piece = jnp.maximum(k - 1, 0) // nodes
        share = jnp.asarray(steps)[jnp.maximum(k - 1, 0) % nodes]
        place = enter[piece] + (leave - enter)[piece] * share
        lift = jnp.where(k == 0, memory.lift, trail.guess(place))
        rest = settle(contact, place, memory.thresholds, size, lift, contact.rings)
        marks = _marks(contact, memory, start, parting, rest)
        pair = pieces_to(marks, start, parting, within)
        enter, leave = (jnp.where(k == 0, a, b) for a, b in zip(pair, (enter, leave), strict=True))
        back = jnp.where(parting, sigma, -sigma) * 1e-2
        straight = _Trail.straight(place, rest.lift, rest.rates - 1.0, back)
        trail = jax.tree_util.tree_map(
            lambda a, b: jnp.where(k == 0, a, b), straight, trail.append(place, rest.lift)
        )
        return (trail, enter, leave), (place, rest)

    begin = (_Trail.straight(start, memory.lift, flat, sigma), whole, whole)
    (_, enter, leave), found = jax.lax.scan(step, begin, jnp.arange(1 + pieces * nodes))
    places, rests = jax.tree_util.tree_map(
        lambda leaf: leaf[1:].reshape(pieces, nodes, *leaf.shape[1:]), found
    )
    return enter, leave, places, rests
