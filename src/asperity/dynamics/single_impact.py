"""First impacts of single bodies: rigid, on the summits that stand under each."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import NamedTuple

import numpy as np

from .._jax import jax, jnp
from ..contact.asperity_table import Asperities, AsperityTable
from ..laws.law import Real
from ..numerics.compilation import Program, kept
from ..numerics.roots import root_between

_LOOKS = 48  # at the energy on the way in, and on the way out besides the ends of bonds
_FINER = 16  # between two of them on the way in
_ROUNDS, _NEAR = 3, 7  # of looks about the least energy on the way out
_ABOUT = np.linspace(-1.0, 1.0, 9)  # times the range of bonds, about each summit: where to look
_CLOSE = 1e-14  # of a separation: less is lost in rounding
_AT_ONCE = 1 << 14  # gaps that are held in memory together: more leave the cache
_SHARES = np.linspace(0.0, 1.0, _LOOKS + 1)


class Launch(NamedTuple):
    """How single bodies come, one value each.

    Attributes
    ----------
    kinetic
        Kinetic energy at the release [J].
    release
        Separation there [m]; infinite for one that is launched where the forces on it begin.
    weight
        Weight [N].
    """

    kinetic: Real
    release: Real
    weight: Real


@kept
class SingleImpact(NamedTuple):
    """First impact of a single body.

    Attributes
    ----------
    closest_approach
        Separation [m] at which it turns; NaN where none is found in the table.
    captured
        Whether it does not come out of the reach of its summits.
    impact_energy
        Kinetic energy where forces begin, on the way in [J].
    restitution
        Square root of the ratio of that on the way out, to it; 0 where the body is captured.
    contacting
        Summits that touch at the turn.
    maximum_force
        Contact force there [N].
    loaded
        Effective number of loaded summits there, (sum F)^2 / sum F^2.
    bonds
        Bonds of each law at the turn, shape (laws,).
    lost
        Energy [J] that they take by the time all are broken, shape (laws,).
    pull_off
        Largest tension on the way out [N]; NaN where it is not asked for.
    within_reach
        Summits within reach at the turn; where those are all that were given, there may be more.
    """

    closest_approach: jax.Array
    captured: jax.Array
    impact_energy: jax.Array
    restitution: jax.Array
    contacting: jax.Array
    maximum_force: jax.Array
    loaded: jax.Array
    bonds: jax.Array
    lost: jax.Array
    pull_off: jax.Array
    within_reach: jax.Array


def _impact(
    table: AsperityTable, pulls: bool, launch: Launch, offsets: jax.Array, kinds: jax.Array
) -> SingleImpact:
    """One body, on summits with descending ``offsets`` [m]; its pull-off force where it ``pulls``.

    Bodies do not deform in bulk, so that all summits move alike: the energy is the sum of theirs.
    """
    summits = table.of(kinds)
    top = jnp.minimum(launch.release, jnp.max(offsets + summits.reach))
    begin = jnp.where(jnp.isfinite(launch.release), launch.release, top)

    def fallen(place: jax.Array) -> jax.Array:
        return launch.kinetic + launch.weight * (begin - place)

    def on_way_in(place: jax.Array) -> jax.Array:
        return fallen(place) - jnp.sum(summits.work(place - offsets))

    turn = _turn(summits, on_way_in, offsets, top)
    gaps = turn - offsets
    row = summits.row(gaps)

    def on_way_out(place: jax.Array) -> jax.Array:
        return fallen(place) - jnp.sum(summits.work(place - offsets, row))

    def force(place: jax.Array) -> jax.Array:
        return jax.jvp(on_way_out, (place,), (jnp.ones_like(place),))[1] + launch.weight

    held = gaps <= summits.forming
    ends = jnp.where(held, offsets + summits.breaking, top).ravel()
    ends = ends - _CLOSE * jnp.abs(ends)  # just before they break
    # Closest together at the turn, and where the first summit has its forces.
    near = [summits.between(turn, top, origin, _SHARES[2::2]) for origin in (turn, offsets[0])]
    even = jnp.sort(jnp.concatenate(near))
    places = jnp.clip(jnp.concatenate([even, ends]), even[0], top)
    step = jnp.interp(places, even, jnp.diff(even, prepend=turn))
    left = _least(on_way_out, places, step, (even[0], top))
    before, after = on_way_in(top), on_way_out(top)
    captured = jnp.minimum(left, after) < 0.0
    each = -jax.jvp(summits.work, (gaps,), (jnp.ones_like(gaps),))[1]
    squares = jnp.sum(each**2)
    return SingleImpact(
        closest_approach=turn,
        captured=captured,
        impact_energy=before,
        restitution=jnp.where(captured, 0.0, jnp.sqrt(jnp.maximum(after, 0.0) / before)),
        contacting=jnp.sum(gaps < 0.0).astype(float),
        maximum_force=jnp.sum(each),
        loaded=jnp.sum(each) ** 2 / jnp.where(squares > 0.0, squares, 1.0),
        bonds=jnp.sum(held, axis=1).astype(float),
        lost=jnp.sum(held * summits.lost, axis=1),
        pull_off=_pull(summits, force, offsets, places, step) if pulls else jnp.asarray(jnp.nan),
        within_reach=jnp.sum(gaps <= summits.reach),
    )


Along = Callable[[jax.Array], jax.Array]


def _turn(summits: Asperities, energy: Along, offsets: jax.Array, top: jax.Array) -> jax.Array:
    """The first separation [m] on the way in at which the energy is spent."""
    gaps = summits.first_gap(summits.cells * (1.0 - _SHARES))
    places = jnp.append(top, jnp.minimum(offsets[0] + gaps, top))
    found = jnp.asarray(True)
    for _ in range(2):
        spent = jax.vmap(energy)(places) < 0.0
        found = found & jnp.any(spent)
        after = jnp.maximum(jnp.argmax(spent), 1)
        inner, outer = places[after - 1], places[after]
        places = inner + (outer - inner) * np.linspace(0.0, 1.0, _FINER + 1)
    turn = root_between(energy, inner, outer, _CLOSE * (jnp.abs(outer) + summits.reach[0]))
    return jnp.where(found, turn, jnp.nan)


def _pull(
    summits: Asperities, force: Along, offsets: jax.Array, places: jax.Array, step: jax.Array
) -> jax.Array:
    """The largest tension on the way out [N]; there are about as many as there are summits."""
    widest = jnp.max(jnp.append(summits.breaking, jnp.abs(summits.pulling)))
    about = (offsets[:, None] + widest * _ABOUT).ravel()
    within = jnp.min(places), jnp.max(places)
    more = jnp.clip(jnp.concatenate([offsets + summits.pulling, about]), *within)
    steps = jnp.minimum(jnp.append(step, jnp.full(more.shape, widest)), widest)
    return -jnp.minimum(_least(force, jnp.append(places, more), steps, within), 0.0)


def _least(
    value: Along, places: jax.Array, step: jax.Array, within: tuple[jax.Array, jax.Array]
) -> jax.Array:
    """The least value along a way, looked at ``places`` that are a ``step`` [m] apart."""

    def nearer(_: int, now: tuple[jax.Array, ...]) -> tuple[jax.Array, ...]:
        place, width, _least = now
        near = jnp.clip(place + width * np.linspace(-1.0, 1.0, _NEAR), *within)
        found = jax.vmap(value)(near)
        best = jnp.argmin(found)
        return near[best], width * 2.0 / (_NEAR - 1), found[best]

    found = jax.vmap(value)(places)
    best = jnp.argmin(found)
    return jax.lax.fori_loop(0, _ROUNDS, nearer, (places[best], step[best], found[best]))[2]


def _impacts(
    table: AsperityTable,
    launches: Launch,
    offsets: jax.Array,
    kinds: jax.Array,
    pulls: bool = True,
) -> SingleImpact:
    bodies, summits = offsets.shape
    together = bodies
    while together > 1 and together * 2 * _LOOKS * summits > _AT_ONCE:
        together //= 2
    jobs = jax.tree_util.tree_map(
        lambda leaf: leaf.reshape(-1, together, *leaf.shape[1:]), (launches, offsets, kinds)
    )
    found = jax.lax.map(lambda job: jax.vmap(partial(_impact, table, pulls))(*job), jobs)
    return jax.tree_util.tree_map(lambda leaf: leaf.reshape(bodies, *leaf.shape[2:]), found)


single_impacts = Program(_impacts, {})
"""First impacts of many bodies, whose number is a power of two.

By their launches of shape (bodies,), the offsets [m] of their summits, descending, and the classes
of these, of shape (bodies, summits), and whether their pull-off forces are wanted (static)."""
