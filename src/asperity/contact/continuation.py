"""Rings of a deforming contact along a path: each solution the first guess of the next."""

from __future__ import annotations

from typing import Any, NamedTuple, Protocol

import numpy as np

from .._jax import jax, jnp
from ..interface.interface import Memory as Thresholds
from .equilibrium import Rest, Rough, asked_size, beyond, rates, rise_of, settle
from .resolution import Resolution, fills_by_contact
from .scanning_curve import pieces_to, way_points

_FIT = 0.02  # how closely the mesh fits the pressure
_PASSES = 12  # of that fit, at most
_TRAIL = 4  # places behind from which the next is guessed
_MORE = 1.02  # than the way at the first rate
_MUCH_MORE = 1.2  # where liquid fills the surface: the rate falls as the bulk springs back


class Deforming(Rough, Protocol):
    """A contact whose rings are followed."""

    rings: int
    resolved: Resolution

    @property
    def passed(self) -> tuple[int, int]:
        """Pieces of a way back, and places on each."""


class Bound(Protocol):
    """Rings that hold bonds on a mesh of their own."""

    @property
    def thresholds(self) -> Thresholds:
        """One array a hysteretic law [m]."""

    @property
    def size(self) -> jax.Array:
        """Length of the mesh [m]."""

    @property
    def lift(self) -> jax.Array:
        """Displacement of the rings at the reversal [m]."""


class Trail(NamedTuple):
    """The last few places and displacements of the rings there, newest first."""

    places: jax.Array
    lifts: jax.Array

    @classmethod
    def straight(
        cls, place: jax.Array, lift: jax.Array, rate: jax.Array, step: jax.Array | float
    ) -> Trail:
        """Rings that came by ``rate`` in steps of ``step`` [m]."""
        back = -step * np.arange(float(_TRAIL))
        return cls(place + back, lift + back[:, None] * rate)

    def guess(self, place: jax.Array) -> jax.Array:
        """The polynomial through them, at a place further on."""
        one = np.eye(_TRAIL)
        apart = self.places[:, None] - self.places + one
        known = jnp.all(apart != 0.0)
        ratios = (place - self.places) * (1.0 - one) + one
        weights = jnp.prod(ratios / jnp.where(known, apart, 1.0), axis=1)
        return jnp.where(known, weights @ self.lifts, self.lifts[0])

    def append(self, place: jax.Array, lift: jax.Array) -> Trail:
        """With one more, the oldest dropped."""
        return Trail(
            jnp.concatenate([place[None], self.places[:-1]]),
            jnp.concatenate([lift[None], self.lifts[:-1]]),
        )


def first_size(contact: Deforming, separation: jax.Array) -> jax.Array:
    """Size of the mesh before anything is solved: light contact, and Hertz's radius."""
    sigma, radius = contact.interface.heights.rms, contact.shape.radius
    light = 3.0 * radius * sigma / (1.0 + jnp.maximum(separation / sigma, 0.0))
    return jnp.sqrt(light + radius * jnp.maximum(-separation, 0.0))


def _marks(
    contact: Deforming,
    memory: Bound,
    start: jax.Array,
    unloading: jax.Array,
    rates: jax.Array,
) -> jax.Array:
    """Ends of the pieces of the way back, for each law.

    Even ones until the fastest ring has passed from one branch to the other, and one more
    until the slowest has.
    """
    slowest = jnp.clip(jnp.min(rates), 1e-3, 1.0)
    fastest = jnp.maximum(jnp.max(rates), slowest)
    pieces = contact.resolved.pieces
    even = np.arange(1.0, pieces) / max(pieces - 1, 1)
    more = _MUCH_MORE if fills_by_contact(contact.interface.hysteretic) else _MORE
    shares = jnp.append(even / fastest, more / slowest)
    ahead = jnp.where(unloading, 1.0, -1.0) * (memory.size > 0.0)
    rows = [
        start + ahead * (law.breaking_gap - law.forming_gap) * shares
        for law in contact.interface.hysteretic
    ]
    return jnp.concatenate(rows)


def fitted(
    contact: Deforming,
    place: jax.Array,
    thresholds: Thresholds,
    size: jax.Array,
    lift: jax.Array,
    free: jax.Array,
) -> tuple[jax.Array, Rest]:
    """The rings at one place, on a mesh whose size fits the pressure where it is ``free``."""
    rings, fills = contact.rings, fills_by_contact(contact.interface.hysteretic)

    def again(now: tuple[Any, ...]) -> tuple[Any, ...]:
        size, ratio, rest, passes = now
        size = size * ratio
        rest = settle(contact, place, thresholds, size, rest.lift, rings)
        end = place + rise_of(contact, size, rings)[-1]
        more = beyond(contact, size, end) if fills else 0.0
        asked = asked_size(rest, rings, more)
        return size, jnp.where(free, asked, 1.0), rest, passes + 1

    def unfit(now: tuple[Any, ...]) -> jax.Array:
        off = jnp.logical_and(jnp.abs(now[1] - 1.0) > _FIT, now[-1] < _PASSES)
        return jnp.logical_or(now[-1] == 0, off)

    blank = Rest(lift, jnp.zeros_like(lift[:-1]), jnp.zeros(()))
    begin = size, jnp.ones(()), blank, 0
    size, _, rest, _ = jax.lax.while_loop(unfit, again, begin)
    return size, rest


def descend(
    contact: Deforming, corners: jax.Array, places: jax.Array, thresholds: Thresholds
) -> tuple[jax.Array, Rest]:
    """Sizes and rings at descending ``places`` within panels that end at ``corners``."""
    count = corners.shape[0]
    sigma = contact.interface.heights.rms
    flat = jnp.zeros(contact.rings + 1)
    above = Trail.straight(corners[0] + sigma, flat, flat, -sigma)

    def step(carry: tuple[Any, ...], job: tuple[jax.Array, jax.Array]) -> Any:
        trail, factor, sizes = carry
        k, place = job
        corner = k < count
        trail = jax.tree_util.tree_map(lambda a, b: jnp.where(k == count, a, b), above, trail)
        light = first_size(contact, place)
        between = jnp.interp(place, corners[::-1], sizes[::-1])
        size, rest = fitted(
            contact,
            place,
            thresholds,
            jnp.where(corner, light * factor, between),
            jnp.where(corner, trail.lifts[0], trail.guess(place)),
            corner,
        )
        sizes = jnp.where(jnp.arange(count) == k, size, sizes)
        return (trail.append(place, rest.lift), size / light, sizes), (size, rest)

    begin = above, jnp.ones(()), jnp.ones(count)
    jobs = jnp.concatenate([corners, places])
    _, found = jax.lax.scan(step, begin, (jnp.arange(jobs.shape[0]), jobs))
    sizes, rests = jax.tree_util.tree_map(lambda leaf: leaf[count:], found)
    return sizes, rests


def retrace(
    contact: Deforming,
    memory: Bound,
    start: jax.Array,
    size: jax.Array,
    unloading: jax.Array,
    within: tuple[Any, Any],
) -> tuple[jax.Array, jax.Array, jax.Array, Rest]:
    """Pieces of the way back, places on them and the rings there; first of all at the start."""
    pieces, nodes = contact.passed
    steps = way_points(nodes)
    sigma = contact.interface.heights.rms
    held = memory.thresholds, size
    pace = rates(contact, start, *held, memory.lift, contact.rings)
    marks = _marks(contact, memory, start, unloading, pace)
    enter, leave = pieces_to(marks, start, unloading, within)
    back = jnp.where(unloading, sigma, -sigma) * 1e-2
    trail = Trail.straight(start, memory.lift, pace - 1.0, back)

    def step(trail: Trail, place: jax.Array) -> Any:
        rest = settle(contact, place, *held, trail.guess(place), contact.rings)
        return trail.append(place, rest.lift), rest

    places = enter[:, None] + (leave - enter)[:, None] * jnp.asarray(steps)
    _, found = jax.lax.scan(step, trail, places.ravel())
    rests = jax.tree_util.tree_map(lambda leaf: leaf.reshape(pieces, nodes, *leaf.shape[1:]), found)
    return enter, leave, places, rests
