"""Where a branch of equilibria folds.

Soft bodies that adhere have several equilibria at one separation. As the separation changes, rings
follow a branch of stable ones until it folds: there force and displacement change infinitely fast
with the separation, and the least eigenvalue of the equilibrium's Jacobian is 0. Beyond it they
jump at fixed separation (Greenwood, Proc. R. Soc. A 453 (1997) 1277; Feng, Colloids Surf. A 172
(2000) 175). Without derivatives.
"""

from __future__ import annotations

from typing import NamedTuple, TypeVar

from .._jax import jax, jnp
from ..interface.rough_planes import Memory as Thresholds
from ..numerics.compilation import kept
from ..numerics.krylov import dense_solve
from ..numerics.roots import fixed_point
from .continuation import ContinuationPath, Deforming
from .equilibrium import RingEquilibrium, balance, pressed, profile_of
from .landing import bounded_size, fit, on_other_mesh, settle

_STEPS = 12  # of Newton's method from a place near by
_ON_ARC = 5  # of it on the curve of equilibria, whose points lie closer
_ENOUGH = 1e-11  # of the separation: a move that counts as none
_FAR = 0.5  # rms heights between a guess and what it leads to: more is another branch
_SAME = 0.1  # rms heights between the axes of rings that are the same on two meshes
_REFIT = 0.1  # of its size: a mesh that fits so closely is kept
_EVALUATIONS = 60  # on the way to a fold
_FLAT = 1e-6  # of the slope at its start: there the separation is the fold's to its square
_FIRST = 0.05  # of the distance to the place beyond the fold: the first step to it


_Tree = TypeVar("_Tree")


class _Rest(NamedTuple):
    """Rings at a separation, their rate with it, and whether they are in a stable equilibrium."""

    place: jax.Array
    size: jax.Array
    displacement: jax.Array
    pressure: jax.Array
    rate: jax.Array
    stable: jax.Array


@kept
class Fold(NamedTuple):
    """The first fold of a branch that is followed one way.

    Attributes
    ----------
    place
        Its separation [m]; NaN where there is none.
    size
        Size [m] of the mesh on which it lies there.
    number
        How many there are on the whole way.
    """

    place: jax.Array
    size: jax.Array
    number: jax.Array


def _at_rest(
    contact: Deforming, place: jax.Array, thresholds: Thresholds, size: jax.Array, guess: jax.Array
) -> _Rest:
    """The equilibrium to which Newton's method leads from a guess, if it is near and stable."""
    safe, rms = place + profile_of(contact, size, contact.rings), contact.interface.scale.rms

    def step(h: jax.Array) -> tuple[jax.Array, jax.Array]:
        left, matrix = balance(contact, h, safe, thresholds, size)
        move = dense_solve(matrix, left)
        return h - move, jnp.max(jnp.abs(move) / (rms + jnp.abs(h)))

    h, change = fixed_point(step, safe + guess, _ENOUGH, _STEPS)
    _, matrix = balance(contact, h, safe, thresholds, size)
    near = jnp.max(jnp.abs(h - safe - guess)) < _FAR * rms
    # One eigenvalue at a time passes through 0, so that the determinant's sign tells.
    stable = (change <= _ENOUGH) & near & (jnp.linalg.slogdet(matrix)[0] > 0.0)
    rate = dense_solve(matrix, jnp.ones_like(h))
    pressure = pressed(contact, thresholds, h)[0][:-1]
    return _Rest(place, size, h - safe, pressure, rate, stable)


class _Search(NamedTuple):
    """Rings that are followed, and the folds that they came by."""

    path: ContinuationPath
    here: _Rest
    fold: Fold


class _Follower(NamedTuple):
    """How rings of a contact with given bonds are followed, in one direction."""

    contact: Deforming
    thresholds: Thresholds
    ahead: jax.Array

    def rest(self, place: jax.Array, size: jax.Array, guess: jax.Array) -> _Rest:
        return _at_rest(self.contact, place, self.thresholds, size, guess)

    def straight(self, here: _Rest) -> ContinuationPath:
        """A path along the rate of the rings."""
        step = self.ahead * self.contact.interface.scale.rms
        return ContinuationPath.straight(here.place, here.displacement, here.rate - 1.0, step)

    def step(self, now: _Search, place: jax.Array) -> tuple[_Search, None]:
        """On to the next place, over a fold if there is one."""
        on = self.rest(place, now.here.size, now.path.guess(place))
        here, fold = jax.lax.cond(on.stable, lambda: (on, now.fold), lambda: self.jump(now, place))
        other = self.refitted(here)
        ratio = other.size / here.size
        refit = (jnp.abs(ratio - 1.0) > _REFIT) & other.stable
        here = _choose(refit, other, here)
        path = now.path.append(place, here.displacement)
        path = _choose(on.stable & ~refit, path, self.straight(here))
        return _Search(path, here, fold), None

    def refitted(self, here: _Rest) -> _Rest:
        """The same rings on the mesh that they ask for."""
        rest = RingEquilibrium(here.displacement, here.pressure, jnp.zeros(()))
        ratio = bounded_size(rest, self.contact.rings)
        moved = on_other_mesh(here.displacement, ratio, self.contact.rings)
        return self.rest(here.place, here.size * ratio, moved)

    def jump(self, now: _Search, place: jax.Array) -> tuple[_Rest, Fold]:
        """Where the branch folds before a place, and where rings come to rest there."""
        old, last = now.fold, now.here
        # It lies on the mesh on which its curves are solved.
        size, flat = fit(self.contact, last.place, self.thresholds, last.size, last.displacement)
        fitted = self.rest(last.place, size, flat)
        apart = jnp.abs(fitted.displacement[0] - last.displacement[0])
        same = apart < _SAME * self.contact.interface.scale.rms
        last = _choose(fitted.stable & same, fitted, last)
        at, found = _fold(self, last, place)
        found = found & (self.ahead * (place - at) >= 0.0)  # else the guess was too poor
        first = found & (old.number == 0)
        fold = Fold(
            jnp.where(first, at, old.place),
            jnp.where(first, last.size, old.size),
            old.number + found,
        )
        landed = settle(self.contact, place, self.thresholds, last.size, last.displacement)
        size, landed = fit(self.contact, place, self.thresholds, last.size, landed, landing=True)
        return self.rest(place, size, landed), fold


def _choose(first: jax.Array, one: _Tree, other: _Tree) -> _Tree:
    chosen: _Tree = jax.tree_util.tree_map(lambda a, b: jnp.where(first, a, b), one, other)
    return chosen


def first_fold(
    contact: Deforming, places: jax.Array, thresholds: Thresholds, size: jax.Array
) -> Fold:
    """Follow rings along monotone ``places`` [m], and find where their branch folds first.

    Parameters
    ----------
    contact, thresholds
        The contact and its bonds.
    places
        Separations close enough for the rings to be followed.
    size
        Size [m] of the mesh at the first of them, about.
    """
    follower = _Follower(contact, thresholds, jnp.sign(places[-1] - places[0]))
    flat = jnp.zeros(contact.rings + 1)
    begin = fit(contact, places[0], thresholds, size, flat, landing=True)
    here = follower.rest(places[0], *begin)
    none = Fold(jnp.asarray(jnp.nan), size, jnp.asarray(0))
    start = _Search(follower.straight(here), here, none)
    end, _ = jax.lax.scan(follower.step, start, places)
    return end.fold


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


def _fold(follower: _Follower, before: _Rest, beyond: jax.Array) -> tuple[jax.Array, jax.Array]:
    """Where the slope of the separation with arc length is 0 [m], and whether that was found.

    The length is measured along the change of the displacement where the search begins, so that
    the slope is 1 there; it falls almost evenly to 0 at a fold, and is negative beyond.
    """
    contact, thresholds, ahead = follower
    profile = profile_of(contact, before.size, contact.rings)
    along = before.rate / (before.rate @ before.rate)
    start = before.place + profile + before.displacement

    def bordered(x: jax.Array) -> tuple[jax.Array, jax.Array]:
        left, matrix = balance(contact, x[:-1], x[-1] + profile, thresholds, before.size)
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
        far, near = _choose(passed, found, far), _choose(passed, near, found)
        # The end that stays counts for half: else it would stay for long (Illinois).
        near = near._replace(slope=jnp.where(passed & bracketed, 0.5 * near.slope, near.slope))
        return _Bracket(near, far, jnp.where(bracketed | passed, step, 2.0 * step), tries + 1)

    begin = _Arc(jnp.zeros(()), jnp.ones(()), start, before.place, before.rate)
    step = _FIRST * jnp.abs(beyond - before.place)
    end = jax.lax.while_loop(
        lambda now: (now.flattest > _FLAT) & (now.tries < _EVALUATIONS),
        search,
        _Bracket(begin, begin, step, jnp.asarray(0)),
    )
    nearer = jnp.abs(end.far.slope) < jnp.abs(end.near.slope)
    return jnp.where(nearer, end.far.place, end.near.place), end.far.slope <= 0.0
