"""The force on a body along its path, as far as it was followed in steps, and pieces of it."""

from __future__ import annotations

from typing import NamedTuple

from .._jax import jax, jnp
from .external_forces import Along, Load
from .record import Body

_MOST = 16  # points between two ends of a piece


class CurvePoint(NamedTuple):
    """A body at one point of its path.

    Attributes
    ----------
    separation
        Where it is [m].
    kinetic
        Its kinetic energy if nothing takes any [J].
    force
        Contact force [N], positive apart.
    stiffness
        Its slope with the separation [N/m].
    """

    separation: jax.Array
    kinetic: jax.Array
    force: jax.Array
    stiffness: jax.Array


class ForceCurve(NamedTuple):
    """Points of a path in their order, on the way in and out again.

    Attributes
    ----------
    points
        Arrays of shape (most,); where a force steps there are two at one separation.
    begins
        Whether a point is the second of these, shape (most,).
    size
        How many there are so far.
    turn
        Number of the point at which the body turns; that of the last so far on the way in.
    """

    points: CurvePoint
    begins: jax.Array
    size: jax.Array
    turn: jax.Array

    @classmethod
    def of(cls, most: int, first: CurvePoint) -> ForceCurve:
        """A curve with its first point, and room for so many."""
        room = most + _MOST + 1  # what is read ahead
        points = CurvePoint(*(jnp.zeros(room).at[0].set(value) for value in first))
        return cls(points, jnp.zeros(room, bool), jnp.asarray(1), jnp.asarray(0))

    def append(self, point: CurvePoint, wanted: jax.Array, *, steps: bool = False) -> ForceCurve:
        """The curve with one point more where that is ``wanted``; ``steps`` where a force does."""
        at = jnp.where(wanted, self.size, self.begins.size)
        points = CurvePoint(
            *(
                some.at[at].set(value, mode="drop")
                for some, value in zip(self.points, point, strict=True)
            )
        )
        begins = self.begins.at[at].set(steps, mode="drop")
        return self._replace(points=points, begins=begins, size=self.size + wanted)

    def piece(self, start: jax.Array, last: jax.Array) -> CurvePiece:
        """From one point to the next step, the ``last`` point or one that is far enough."""

        def ahead(values: jax.Array) -> jax.Array:
            return jax.lax.dynamic_slice_in_dim(values, start, _MOST + 1)

        steps = ahead(self.begins)[1:]
        count = jnp.where(jnp.any(steps), jnp.maximum(jnp.argmax(steps), 1), _MOST)
        count = jnp.minimum(count, last - start)
        points = CurvePoint(*map(ahead, self.points))
        return CurvePiece(points, count)


class CurvePiece(NamedTuple):
    """A piece of a curve: between two points a cubic of the energy, a parabola of the stiffness.

    As :class:`~asperity.dynamics.drag.Piece`; the load is in the energies of the points.
    """

    points: CurvePoint
    intervals: jax.Array

    @property
    def enter(self) -> jax.Array:
        return self.points.separation[0]

    @property
    def leave(self) -> jax.Array:
        return self.points.separation[self.intervals]

    @property
    def ahead(self) -> jax.Array:
        return jnp.sign(self.leave - self.enter)

    def _cubic(self, place: jax.Array, load: Load) -> tuple[jax.Array, ...]:
        """Kinetic energy [J] at a place, shape (), with stiffness and its slope there."""
        points, sign = self.points, self.ahead
        passed = sign * (points.separation - place) <= 0.0
        k = jnp.clip(jnp.sum(passed & (jnp.arange(passed.size) < self.intervals)) - 1, 0)
        a, b = (CurvePoint(*(values[k + one] for values in points)) for one in (0, 1))
        width = b.separation - a.separation
        width = jnp.where(width == 0.0, 1.0, width)
        t = (place - a.separation) / width
        slopes = (width * (p.force - load.force(p.separation)) for p in (a, b))
        first, second = slopes
        gained = b.kinetic - a.kinetic
        rest = t * (1.0 - t) * ((1.0 - t) * (first - gained) - t * (second - gained))
        low, high = jnp.minimum(a.stiffness, b.stiffness), jnp.maximum(a.stiffness, b.stiffness)
        mean = jnp.clip((b.force - a.force) / width, low, high)  # no force steps where one does
        bulge = 6.0 * t * (1.0 - t) * (mean - 0.5 * (low + high))
        bend = (b.stiffness - a.stiffness) / width
        return a.kinetic + t * gained + rest, a.stiffness + t * width * bend + bulge, bend

    def energy(self, places: jax.Array, load: Load) -> jax.Array:
        kinetic = jnp.vectorize(lambda place: self._cubic(place, load)[0])
        return kinetic(places) - kinetic(self.enter)

    def push(self, place: jax.Array, load: Load) -> jax.Array:
        kinetic = jnp.vectorize(lambda at: self._cubic(at, load)[0])
        return jax.jvp(kinetic, (place,), (jnp.ones_like(place),))[1]

    def drags(self, body: Body, places: jax.Array, speed: jax.Array) -> jax.Array:
        _, stiffness, bend = jax.vmap(lambda place: self._cubic(place, body.load))(places)
        return body.resistances(Along(places, stiffness, bend, speed))
