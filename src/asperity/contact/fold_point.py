"""The point at which the curve of equilibria folds, along its length."""

from __future__ import annotations

from typing import NamedTuple

from .._jax import jax, jnp
from ..interface.rough_planes import Memory as Thresholds
from ..numerics.krylov import dense_solve
from ..numerics.trees import choose
from .elastic import ElasticContact
from .equilibrium import balance, profile_of

_ON_ARC = 5  # steps of Newton's method from a point close by
_EVALUATIONS = 60  # on the way to a fold
_FLAT = 1e-6  # of the slope at its start: there the separation is the fold's to its square
_FIRST = 0.05  # of the distance to the place beyond the fold: the first step to it


class _Arc(NamedTuple):
    """A point of the curve of equilibria, by its length, and the slope of the separation there."""

    length: jax.Array
    slope: jax.Array
    h: jax.Array
    place: jax.Array
    rate: jax.Array


class _Bracket(NamedTuple):
    """Points on either side of a fold, and the step by which the farther one is sought."""

    near: _Arc
    far: _Arc
    step: jax.Array
    tries: jax.Array

    @property
    def flattest(self) -> jax.Array:
        return jnp.minimum(jnp.abs(self.near.slope), jnp.abs(self.far.slope))


def fold_point(
    contact: ElasticContact,
    thresholds: Thresholds,
    before: tuple[jax.Array, jax.Array, jax.Array, jax.Array],
    beyond: jax.Array,
) -> tuple[jax.Array, jax.Array]:
    """Where the slope of the separation with arc length is 0 [m], and whether that was found.

    From rings ``before`` it (their separation, size of the mesh, displacement and rate) towards a
    separation ``beyond`` it. The length is measured along the change of the displacement where the
    search begins, so that the slope is 1 there; it falls almost evenly to 0 at a fold, and is
    negative beyond.
    """
    place, size, displacement, rate = before
    ahead, profile = jnp.sign(beyond - place), profile_of(contact, size)
    along = rate / (rate @ rate)
    start = place + profile + displacement

    def bordered(x: jax.Array) -> tuple[jax.Array, jax.Array]:
        left, matrix = balance(contact, x[:-1], x[-1] + profile, thresholds, size)
        matrix = jnp.concatenate([matrix, -jnp.ones((len(left), 1))], axis=1)
        return left, jnp.concatenate([matrix, jnp.append(along, 0.0)[None]])

    def arc_at(near: _Arc, length: jax.Array) -> _Arc:
        def newton(_: int, x: jax.Array) -> jax.Array:
            left, matrix = bordered(x)
            off = along @ (x[:-1] - start) - ahead * length
            return x - dense_solve(matrix, jnp.append(left, off))

        further = (length - near.length) * ahead
        guess = jnp.append(near.h + near.rate * further, near.place + near.slope * further)
        x = jax.lax.fori_loop(0, _ON_ARC, newton, guess)
        rate = dense_solve(bordered(x)[1], jnp.zeros(len(x)).at[-1].set(1.0))
        return _Arc(length, rate[-1], x[:-1], x[-1], rate[:-1])

    def search(now: _Bracket) -> _Bracket:
        near, far, step, tries = now
        bracketed = far.slope <= 0.0
        share = near.slope / jnp.where(bracketed, near.slope - far.slope, 1.0)
        between = near.length + jnp.clip(share, 0.0, 1.0) * (far.length - near.length)
        found = arc_at(near, jnp.where(bracketed, between, near.length + step))
        passed = ~(found.slope > 0.0)
        far, near = choose(passed, found, far), choose(passed, near, found)
        # The end that stays counts for half: else it would stay for long (Illinois).
        near = near._replace(slope=jnp.where(passed & bracketed, 0.5 * near.slope, near.slope))
        return _Bracket(near, far, jnp.where(bracketed | passed, step, 2.0 * step), tries + 1)

    begin = _Arc(jnp.zeros(()), jnp.ones(()), start, place, rate)
    step = _FIRST * jnp.abs(beyond - place)
    end = jax.lax.while_loop(
        lambda now: (now.flattest > _FLAT) & (now.tries < _EVALUATIONS),
        search,
        _Bracket(begin, begin, step, jnp.asarray(0)),
    )
    nearer = jnp.abs(end.far.slope) < jnp.abs(end.near.slope)
    return jnp.where(nearer, end.far.place, end.near.place), end.far.slope <= 0.0
