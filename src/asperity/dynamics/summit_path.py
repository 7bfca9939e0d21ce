"""The path of a rigid body on its summits, where nothing but bonds and tips takes energy."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from .._jax import jax, jnp
from ..contact.asperity_table import Asperities
from ..contact.pressed_summits import PressedSummits
from ..laws.law import Real
from ..numerics.roots import root_between
from .external_forces import Load
from .record import Body

_SEPARATIONS = 48  # separations on approach, and on retraction besides the ends of bonds
_FINER = 16  # between two of them on approach
_ROUNDS, _NEAR = 3, 7  # about the least energy on retraction
_ABOUT = np.linspace(-1.0, 1.0, 9)  # times the range of bonds, about each of the highest summits
_HIGHEST = 32  # of these, which decide; at those below one separation each is looked at
_ONE_BY_ONE = 1024  # of the highest, as many of all others, of which each bond is looked at
_AT_ONCE = 1 << 22  # gaps of which energies are held together
_CLOSE = 1e-14  # of a separation: less is lost in rounding
_SHARES = np.linspace(0.0, 1.0, _SEPARATIONS + 1)

Curve = Callable[[jax.Array], jax.Array]


class Launch(NamedTuple):
    """How single bodies come, one value each.

    Attributes
    ----------
    kinetic
        Kinetic energy at the release [J]; NaN for one that stays away.
    release
        Separation there [m]; infinite for one that is launched where the forces on it begin.
    """

    kinetic: Real
    release: Real


class SummitPath(NamedTuple):
    """Summits under a body on its way in, or out again. They all move alike.

    Attributes
    ----------
    pressed
        The summits, and how deep each was pressed.
    offsets
        Separation at which each meets the plane [m], shape (n,).
    branch
        Branch of each on the way out; None on the way in.
    """

    pressed: PressedSummits
    offsets: jax.Array
    branch: jax.Array | None = None

    def each(self, separation: jax.Array) -> jax.Array:
        """Work [J] of each from far away to a separation [m], shape (n,)."""
        gaps = separation - self.offsets
        if self.branch is None:
            return self.pressed.approach(gaps)
        return self.pressed.bonded(gaps, self.branch)

    def work(self, separation: jax.Array) -> jax.Array:
        """That of all [J]."""
        return jnp.sum(self.each(separation))

    def forces(self, separation: jax.Array) -> jax.Array:
        """Force of each [N], positive apart, shape (n,)."""
        return -jax.jvp(self.each, (separation,), (jnp.ones_like(separation),))[1]

    def force(self, separation: jax.Array) -> jax.Array:
        """That of all [N]."""
        return jnp.sum(self.forces(separation))


class Arrival(NamedTuple):
    """A body on its way in.

    Attributes
    ----------
    before
        Kinetic energy [J] at its top; see :func:`top_of`.
    turning_point
        Separation [m] of its turning point; NaN where none is found in the table.
    kinetic
        Kinetic energy there [J]: rounding.
    taken
        Energy taken by each drag [J].
    met
        Whether it comes to its top.
    stays
        Whether drag stops it where no other force pushes it back: it does not come back.
    """

    before: jax.Array
    turning_point: jax.Array
    kinetic: jax.Array
    taken: jax.Array
    met: jax.Array
    stays: jax.Array


class Departure(NamedTuple):
    """A body on its way out.

    Attributes
    ----------
    captured
        Whether its kinetic energy is spent before forces end.
    after
        Kinetic energy where they end [J].
    taken
        Energy taken by each drag [J].
    """

    captured: jax.Array
    after: jax.Array
    taken: jax.Array


def top_of(summits: Asperities, launch: Launch, offsets: jax.Array) -> jax.Array:
    """The separation [m] at which a body is released, or its first summit begins to pull."""
    return jnp.minimum(launch.release, jnp.max(offsets + summits.interaction_range))


def end_of(summits: Asperities, offsets: jax.Array, bonded: jax.Array, top: jax.Array) -> jax.Array:
    """The separation [m] at which the last force ends, with some bonds, shape (laws, n)."""
    felt = jnp.max(offsets + summits.approach_range)
    broken = jnp.max(jnp.where(bonded, offsets + summits.breaking, felt), initial=felt)
    return jnp.minimum(top, broken)


def begin_of(launch: Launch, top: jax.Array) -> jax.Array:
    """Where a body is released [m]: by its launch, or at its ``top``."""
    return jnp.where(jnp.isfinite(launch.release), launch.release, top)


def arrive(body: Body, path: SummitPath, launch: Launch, top: jax.Array) -> Arrival:
    """The way in of a body that no drag slows, by the summits of ``path``."""
    begin, load = begin_of(launch, top), body.load
    before = launch.kinetic + path.work(begin) - path.work(top)
    before = before - load.potential_gain(begin, top - begin)
    turning_point = turning_of(path, load, before, top)
    kinetic = _energy(path, load, before, top)(turning_point)
    met, stays = ~(before < 0.0), jnp.asarray(False)
    return Arrival(before, turning_point, kinetic, jnp.zeros(0), met, stays)


def kinetic_apart(body: Body, kinetic: jax.Array, start: jax.Array, stop: jax.Array) -> jax.Array:
    """Kinetic energy [J] at ``stop`` [m] of a body with some at ``start``, apart from summits."""
    return kinetic - body.load.potential_gain(start, stop - start)


def _energy(path: SummitPath, load: Load, kinetic: jax.Array, start: jax.Array) -> Curve:
    """Kinetic energy [J] at a separation [m], of a body that has some at the ``start`` [m]."""
    begun = kinetic + path.work(start)
    return lambda place: begun - path.work(place) - load.potential_gain(start, place - start)


def turning_of(path: SummitPath, load: Load, before: jax.Array, top: jax.Array) -> jax.Array:
    """The first separation [m] at which a body has spent what it had ``before`` [J] at its top.

    NaN where there is none in the table.
    """
    summits = path.pressed.summits
    energy = _energy(path, load, before, top)
    gaps = summits.gaps_of_first(summits.cells * (1.0 - _SHARES))
    first = jnp.max(path.offsets - path.pressed.residual)
    separations = jnp.append(top, jnp.minimum(first + gaps, top))
    reached = jnp.asarray(True)
    for _ in range(2):
        spent = jax.vmap(energy)(separations) < 0.0
        reached = reached & jnp.any(spent)
        after = jnp.maximum(jnp.argmax(spent), 1)
        inner, outer = separations[after - 1], separations[after]
        separations = inner + (outer - inner) * np.linspace(0.0, 1.0, _FINER + 1)
    turning_point = root_between(
        energy, inner, outer, _CLOSE * (jnp.abs(outer) + summits.interaction_range[0])
    )
    return jnp.where(reached, turning_point, jnp.nan)


class Outward(NamedTuple):
    """The way out of a body.

    Attributes
    ----------
    path
        Its summits.
    start, end
        Where it turns, and where forces end [m].
    recovered
        Offsets of its summits as they are now [m], shape (n,).
    ends
        Where bonds break that were made [m]; others at the end.
    """

    path: SummitPath
    start: jax.Array
    end: jax.Array
    recovered: jax.Array
    ends: jax.Array

    @property
    def together(self) -> int:
        """Separations at which the energies of all summits are held in memory."""
        return max(_AT_ONCE // self.recovered.size, 1)

    def even(self, shares: np.ndarray) -> jax.Array:
        """Separations from the start to the end [m], ascending.

        Closest together at the start, and where the first summit has its forces.
        """
        return evenly(self.path.pressed.summits, self.start, self.end, self.recovered, shares)

    def looked_at(self) -> tuple[jax.Array, jax.Array]:
        """Separations [m] to look at, the ends of bonds among them, and their steps."""
        even, ends = self.even(_SHARES[2::2]), self.ends[:, _some(self.recovered.size)].ravel()
        ends = ends - _CLOSE * jnp.abs(ends)  # just before they break
        separations = jnp.clip(jnp.concatenate([even, ends]), even[0], self.end)
        return separations, jnp.interp(separations, even, jnp.diff(even, prepend=self.start))

    def pull_off(self) -> jax.Array:
        """The largest tension [N]; it has about as many maxima as there are summits."""
        separations, step = self.looked_at()
        summits = self.path.pressed.summits
        lengths = summits.breaking, jnp.abs(summits.pull_off_gap), summits.scale
        widest = jnp.max(jnp.vstack(lengths))
        highest = jax.lax.top_k(self.recovered, min(_HIGHEST, self.recovered.size))[0]
        about = (highest[:, None] + widest * _ABOUT).ravel()
        peaks = (self.recovered + summits.pull_off_gap)[_some(self.recovered.size)]
        more = jnp.concatenate([peaks, about])
        more = jnp.clip(more, self.start, jnp.max(separations))
        steps = jnp.minimum(jnp.append(step, jnp.full(more.shape, widest)), widest)
        separations = jnp.append(separations, more)
        return -jnp.minimum(_least(self.path.force, separations, steps, self.together), 0.0)


def evenly(
    summits: Asperities, start: jax.Array, end: jax.Array, offsets: jax.Array, shares: np.ndarray
) -> jax.Array:
    """Separations [m] from a low one to another, closest together there and at the first summit."""
    origins = start, jnp.max(offsets)
    found = [summits.between(start, end, at, shares) for at in origins]
    return jnp.sort(jnp.concatenate(found))


def leave(body: Body, outward: Outward, kinetic: jax.Array) -> Departure:
    """The way out of a body that no drag slows, with a kinetic energy [J] where it turns."""
    energy = _energy(outward.path, body.load, kinetic, outward.start)
    after = energy(outward.end)
    least = _least(energy, *outward.looked_at(), outward.together)
    captured = jnp.minimum(least, after) < 0.0
    return Departure(captured, after, jnp.zeros(0))


def _some(count: int) -> np.ndarray:
    """Numbers of the highest summits, and of some of all others."""
    if count <= 2 * _ONE_BY_ONE:
        return np.arange(count)
    others = np.linspace(_ONE_BY_ONE, count - 1, _ONE_BY_ONE).astype(int)
    return np.append(np.arange(_ONE_BY_ONE), others)


def _least(value: Curve, separations: jax.Array, step: jax.Array, together: int) -> jax.Array:
    """The least value at some separations that are a ``step`` [m] apart, and about it.

    Computed at so many ``together``.
    """
    within = jnp.min(separations), jnp.max(separations)

    def nearer(_: int, now: tuple[jax.Array, ...]) -> tuple[jax.Array, ...]:
        separation, width, _least = now
        near = jnp.clip(separation + width * np.linspace(-1.0, 1.0, _NEAR), *within)
        found = jax.vmap(value)(near)
        best = jnp.argmin(found)
        return near[best], width * 2.0 / (_NEAR - 1), found[best]

    found = jax.lax.map(value, separations, batch_size=together)
    best = jnp.argmin(found)
    return jax.lax.fori_loop(0, _ROUNDS, nearer, (separations[best], step[best], found[best]))[2]
