"""First impacts of single bodies: rigid, on the summits that stand under each."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import NamedTuple

import numpy as np

from .._jax import jax, jnp
from ..contact.asperity_table import Asperities
from ..laws.law import Real
from ..numerics.compilation import OPTIMISED, Program, kept
from ..numerics.roots import root_between

_SEPARATIONS = 48  # separations on approach, and on retraction besides the ends of bonds
_FINER = 16  # between two of them on approach
_ROUNDS, _NEAR = 3, 7  # about the least energy on retraction
_ABOUT = np.linspace(-1.0, 1.0, 9)  # times the range of bonds, about each summit
_CLOSE = 1e-14  # of a separation: less is lost in rounding
_AT_ONCE = 1 << 14  # gaps that are held in memory together: more leave the cache
_SHARES = np.linspace(0.0, 1.0, _SEPARATIONS + 1)


class Launch(NamedTuple):
    """How single bodies come, one value each.

    Attributes
    ----------
    kinetic
        Kinetic energy at the release [J]; NaN for one that stays away.
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
        Separation [m] of the turning point; NaN where none is found in the table.
    captured
        Whether it does not leave the interaction range of its summits.
    impact_energy
        Kinetic energy where forces begin, on approach [J].
    restitution
        Square root of the ratio of that on retraction to it; 0 where the body is captured.
    contacting
        Summits in contact at the turning point.
    maximum_force
        Contact force there [N].
    loaded
        Effective number of loaded summits there, (sum F)^2 / sum F^2.
    bonds
        Bonds of each law there, shape (laws,).
    lost
        Energy [J] that they take by the time all are broken, shape (laws,).
    interaction
        Energy [J] that changes of bonds take besides, as they move other summits through the
        half-space; negative where it is set free. 0 on a rigid bulk.
    pull_off
        Largest tension on retraction [N]; NaN where it is not asked for.
    unsolved
        1 where summits on a half-space had no equilibrium at some separation: a jump of theirs
        is then not in the balance. Else 0.
    within_range
        Summits that have felt anything by then; where those are all that were given, there may be
        more.
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
    interaction: jax.Array
    pull_off: jax.Array
    unsolved: jax.Array
    within_range: jax.Array


def _impact(
    table: Asperities, wanted: bool, launch: Launch, offsets: jax.Array, classes: jax.Array
) -> SingleImpact:
    """One body, on summits with descending ``offsets`` [m]; its pull-off force where ``wanted``.

    Bodies do not deform in bulk, so that all summits move alike: the energy is the sum of theirs.
    """
    summits = table.of(classes)
    top = top_of(summits, launch, offsets)
    external = _external_energy(summits, launch, offsets, top)
    turning_point = rigid_approach(summits, launch, offsets, top)
    gaps = turning_point - offsets
    branch = summits.branch(gaps)

    def energy_on_retraction(separation: jax.Array) -> jax.Array:
        return external(separation) - jnp.sum(summits.work(separation - offsets, branch))

    def force(separation: jax.Array) -> jax.Array:
        one = jnp.ones_like(separation)
        return jax.jvp(energy_on_retraction, (separation,), (one,))[1] + launch.weight

    held = gaps <= summits.forming
    ends = jnp.where(held, offsets + summits.breaking, top).ravel()
    ends = ends - _CLOSE * jnp.abs(ends)  # just before they break
    # Closest together at the turning point, and where the first summit has its forces.
    shares = _SHARES[2::2]
    near_turn, near_first = (
        summits.between(turning_point, top, origin, shares)
        for origin in (turning_point, offsets[0])
    )
    even = jnp.sort(jnp.append(near_turn, near_first))
    separations = jnp.clip(jnp.concatenate([even, ends]), even[0], top)
    step = jnp.interp(separations, even, jnp.diff(even, prepend=turning_point))
    left = _least(energy_on_retraction, separations, step, (even[0], top))
    before = external(top) - jnp.sum(summits.work(top - offsets))
    after = energy_on_retraction(top)
    captured = jnp.minimum(left, after) < 0.0
    each = -jax.jvp(summits.work, (gaps,), (jnp.ones_like(gaps),))[1]
    squares = jnp.sum(each**2)
    pull_off = jnp.asarray(jnp.nan)
    if wanted:
        pull_off = _pull_off(summits, force, offsets, separations, step)
    return SingleImpact(
        closest_approach=turning_point,
        captured=captured,
        impact_energy=before,
        restitution=jnp.where(captured, 0.0, jnp.sqrt(jnp.maximum(after, 0.0) / before)),
        contacting=jnp.sum(gaps < 0.0).astype(float),
        maximum_force=jnp.sum(each),
        loaded=jnp.sum(each) ** 2 / jnp.where(squares > 0.0, squares, 1.0),
        bonds=jnp.sum(held, axis=1).astype(float),
        lost=jnp.sum(held * summits.lost, axis=1),
        interaction=jnp.zeros(()),
        pull_off=pull_off,
        unsolved=jnp.zeros(()),
        within_range=jnp.sum(gaps <= summits.approach_range),
    )


Along = Callable[[jax.Array], jax.Array]


def top_of(summits: Asperities, launch: Launch, offsets: jax.Array) -> jax.Array:
    """The separation [m] at which a body is released, or its first summit begins to pull."""
    return jnp.minimum(launch.release, jnp.max(offsets + summits.interaction_range))


def _external_energy(
    summits: Asperities, launch: Launch, offsets: jax.Array, top: jax.Array
) -> Along:
    """Kinetic energy and work [J] that a body without summits would have at a separation [m]."""
    begin = jnp.where(jnp.isfinite(launch.release), launch.release, top)
    energy = launch.kinetic + jnp.sum(summits.work(begin - offsets))
    return lambda separation: energy + launch.weight * (begin - separation)


def rigid_approach(
    summits: Asperities, launch: Launch, offsets: jax.Array, top: jax.Array
) -> jax.Array:
    """The first separation [m] at which a body that does not deform in bulk has spent its energy.

    NaN where there is none in the table.
    """
    external = _external_energy(summits, launch, offsets, top)

    def energy(separation: jax.Array) -> jax.Array:
        return external(separation) - jnp.sum(summits.work(separation - offsets))

    gaps = summits.gaps_of_first(summits.cells * (1.0 - _SHARES))
    separations = jnp.append(top, jnp.minimum(offsets[0] + gaps, top))
    found = jnp.asarray(True)
    for _ in range(2):
        spent = jax.vmap(energy)(separations) < 0.0
        found = found & jnp.any(spent)
        after = jnp.maximum(jnp.argmax(spent), 1)
        inner, outer = separations[after - 1], separations[after]
        separations = inner + (outer - inner) * np.linspace(0.0, 1.0, _FINER + 1)
    turning_point = root_between(
        energy, inner, outer, _CLOSE * (jnp.abs(outer) + summits.interaction_range[0])
    )
    return jnp.where(found, turning_point, jnp.nan)


def _pull_off(
    summits: Asperities, force: Along, offsets: jax.Array, separations: jax.Array, step: jax.Array
) -> jax.Array:
    """The largest tension on retraction [N]; it has about as many maxima as there are summits."""
    widest = jnp.max(jnp.append(summits.breaking, jnp.abs(summits.pull_off_gap)))
    about = (offsets[:, None] + widest * _ABOUT).ravel()
    within = jnp.min(separations), jnp.max(separations)
    more = jnp.clip(jnp.concatenate([offsets + summits.pull_off_gap, about]), *within)
    steps = jnp.minimum(jnp.append(step, jnp.full(more.shape, widest)), widest)
    return -jnp.minimum(_least(force, jnp.append(separations, more), steps, within), 0.0)


def _least(
    value: Along, separations: jax.Array, step: jax.Array, within: tuple[jax.Array, jax.Array]
) -> jax.Array:
    """The least value at some separations that are a ``step`` [m] apart, and about it."""

    def nearer(_: int, now: tuple[jax.Array, ...]) -> tuple[jax.Array, ...]:
        separation, width, _least = now
        near = jnp.clip(separation + width * np.linspace(-1.0, 1.0, _NEAR), *within)
        found = jax.vmap(value)(near)
        best = jnp.argmin(found)
        return near[best], width * 2.0 / (_NEAR - 1), found[best]

    found = jax.vmap(value)(separations)
    best = jnp.argmin(found)
    return jax.lax.fori_loop(0, _ROUNDS, nearer, (separations[best], step[best], found[best]))[2]


def _impacts(
    table: Asperities,
    launches: Launch,
    offsets: jax.Array,
    classes: jax.Array,
    wanted: bool = True,
) -> SingleImpact:
    bodies, summits = offsets.shape
    together = bodies
    while together > 1 and together * 2 * _SEPARATIONS * summits > _AT_ONCE:
        together //= 2
    jobs = jax.tree_util.tree_map(
        lambda leaf: leaf.reshape(-1, together, *leaf.shape[1:]), (launches, offsets, classes)
    )
    found = jax.lax.map(lambda job: jax.vmap(partial(_impact, table, wanted))(*job), jobs)
    return jax.tree_util.tree_map(lambda leaf: leaf.reshape(bodies, *leaf.shape[2:]), found)


single_impacts = Program(_impacts, OPTIMISED)
"""First impacts of many bodies, whose number is a power of two.

By their launches of shape (bodies,), the offsets [m] of their summits, descending, and the classes
of these, of shape (bodies, summits), and whether their pull-off forces are wanted (static)."""
