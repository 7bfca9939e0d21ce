"""Where a branch of equilibria folds.

Soft bodies that adhere have several equilibria at one separation. As the separation changes, rings
follow a branch of stable ones until it folds: there force and displacement change infinitely fast
with the separation, and the least eigenvalue of the equilibrium's Jacobian is 0. Beyond it they
jump at fixed separation (Greenwood, Proc. R. Soc. A 453 (1997) 1277; Feng, Colloids Surf. A 172
(2000) 175). Without derivatives.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from .._jax import jax, jnp
from ..interface.rough_planes import Memory as Thresholds
from ..numerics.compilation import AT_ONCE, Program, kept
from ..numerics.krylov import dense_solve
from ..numerics.roots import fixed_point
from ..numerics.trees import choose
from .continuation import ContinuationPath, first_size, with_table
from .elastic import ElasticContact
from .equilibrium import RingEquilibrium, balance, pressed, profile_of
from .fold_point import fold_point
from .landing import bounded_size, fit, on_other_mesh, settle

_EVEN, _WIDENING = 0.25, 0.02  # rms heights between places that are followed, and of the separation
_DEEP = 20.0  # rms heights, down to which folds are sought
_STEPS = 12  # of Newton's method from a place near by
_ENOUGH = 1e-11  # of the separation: a move that counts as none
_FAR = 0.5  # rms heights between a guess and what it leads to: more is another branch
_SAME = 0.1  # rms heights between the axes of rings that are the same on two meshes
_REFIT = 0.1  # of its size: a mesh that fits so closely is kept


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


class _Search(NamedTuple):
    """Rings that are followed, and the folds that they came by."""

    path: ContinuationPath
    here: _Rest
    fold: Fold


class _Follower(NamedTuple):
    """How rings of a contact with given bonds are followed, in one direction."""

    contact: ElasticContact
    thresholds: Thresholds
    ahead: jax.Array

    def rest(self, place: jax.Array, size: jax.Array, guess: jax.Array) -> _Rest:
        """The equilibrium to which Newton's method leads from a guess, if it is near and stable."""
        contact, thresholds, _ = self
        safe, rms = place + profile_of(contact, size), contact.interface.scale.rms

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

    def straight(self, here: _Rest) -> ContinuationPath:
        """A path along the rate of the rings."""
        step = self.ahead * self.contact.interface.scale.rms
        return ContinuationPath.straight(here.place, here.displacement, here.rate - 1.0, step)

    def step(self, now: _Search, place: jax.Array) -> tuple[_Search, None]:
        """On to the next place, over a fold if there is one."""
        on = self.rest(place, now.here.size, now.path.guess(place))
        here, fold = jax.lax.cond(on.stable, lambda: (on, now.fold), lambda: self.jump(now, place))
        ratio = bounded_size(RingEquilibrium(here.displacement, here.pressure, jnp.zeros(())))
        other = jax.lax.cond(
            jnp.abs(ratio - 1.0) > _REFIT,
            lambda: self.refitted(here, ratio),
            lambda: here._replace(stable=jnp.asarray(False)),
        )
        refit = other.stable
        here = choose(refit, other, here)
        path = now.path.append(place, here.displacement)
        path = choose(on.stable & ~refit, path, self.straight(here))
        return _Search(path, here, fold), None

    def refitted(self, here: _Rest, ratio: jax.Array) -> _Rest:
        """The same rings on the mesh that they ask for, ``ratio`` times as large."""
        moved = on_other_mesh(here.displacement, ratio)
        return self.rest(here.place, here.size * ratio, moved)

    def jump(self, now: _Search, place: jax.Array) -> tuple[_Rest, Fold]:
        """Where the branch folds before a place, and where rings come to rest there."""
        old, last = now.fold, now.here
        # It lies on the mesh on which its curves are solved.
        size, flat = fit(self.contact, last.place, self.thresholds, last.size, last.displacement)
        fitted = self.rest(last.place, size, flat)
        apart = jnp.abs(fitted.displacement[0] - last.displacement[0])
        same = apart < _SAME * self.contact.interface.scale.rms
        last = choose(fitted.stable & same, fitted, last)
        before = last.place, last.size, last.displacement, last.rate
        at, found = fold_point(self.contact, self.thresholds, before, place)
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


def first_fold(
    contact: ElasticContact, places: jax.Array, thresholds: Thresholds, size: jax.Array
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


def _sought(contact: ElasticContact, places: jax.Array) -> Fold:
    """The first fold of each branch along places from outside in, and then from inside out."""

    def one(job: tuple[Thresholds, jax.Array]) -> Fold:
        thresholds, along = job
        span = jnp.min(along), jnp.max(along)
        table = with_table(contact, *span, thresholds)
        return first_fold(table, along, thresholds, first_size(contact, along[0]))

    branches = contact.branches()
    thresholds = jax.tree_util.tree_map(
        lambda *leaves: jnp.stack(leaves * 2), *(memory.thresholds for memory in branches)
    )
    both = jnp.stack([places, places[::-1]])
    return jax.lax.map(one, (thresholds, jnp.repeat(both, len(branches), axis=0)))


_seek = Program(_sought, AT_ONCE)


def folds_of(contact: ElasticContact, low: float) -> Fold:
    """The first fold of each branch: from outside in for all, then from inside out.

    Parameters
    ----------
    contact
        A contact.
    low
        Separation [m] down to which folds are sought, or less deep.
    """
    rms, top = float(contact.interface.scale.rms), float(contact.interaction_range)
    return _seek(contact, jnp.asarray(_even(max(low, -_DEEP * rms), top, rms)))


def _even(low: float, top: float, rms: float) -> np.ndarray:
    """Separations [m] from outside in, close enough for rings to be followed."""
    places = [top]
    while places[-1] > low:
        places.append(places[-1] - _EVEN * rms - _WIDENING * abs(places[-1]))
    count = -(-len(places) // 64) * 64  # so that few numbers are compiled
    return np.interp(np.linspace(0.0, 1.0, count), np.linspace(0.0, 1.0, len(places)), places)
