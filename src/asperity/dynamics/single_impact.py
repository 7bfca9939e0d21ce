"""First impacts of single bodies: rigid, on the summits that stand under each."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import NamedTuple

import numpy as np

from .._jax import jax, jnp
from ..contact.asperity_table import Asperities
from ..contact.pressed_summits import PressedSummits
from ..laws.law import Real
from ..laws.plastic import PlasticContact
from ..numerics.compilation import OPTIMISED, Program, kept
from ..numerics.roots import root_between

_SEPARATIONS = 48  # separations on approach, and on retraction besides the ends of bonds
_FINER = 16  # between two of them on approach
_ROUNDS, _NEAR = 3, 7  # about the least energy on retraction
_ABOUT = np.linspace(-1.0, 1.0, 9)  # times the range of bonds, about each of the highest summits
_HIGHEST = 32  # of these, which decide; at those below one separation each is looked at
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


class Yielding(NamedTuple):
    """Tips that yield, and how deep earlier impacts have pressed them.

    Attributes
    ----------
    contact
        Contact of one tip, all being alike.
    closest_approach
        Closest approach [m] of each body on the same summits before; infinite at its first impact.
    """

    contact: PlasticContact
    closest_approach: Real


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
        Kinetic energy [J] that it brings to where forces end on retraction, had none acted before.
        That is where they begin, but for tips that yield, which are lower then.
    restitution
        Square root of the ratio of what it takes from there to it; 0 where the body is captured.
    contacting
        Summits in contact at the turning point.
    maximum_force
        Contact force there [N].
    loaded
        Effective number of loaded summits there, (sum F)^2 / sum F^2.
    bonds
        Bonds of each law there, shape (laws,).
    lost
        Energy [J] that they take by the time all are broken, shape (laws,). Where tips yield, what
        these keep follows.
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
    table: Asperities,
    wanted: bool,
    contact: PlasticContact | None,
    launch: Launch,
    offsets: jax.Array,
    classes: jax.Array,
    pressed_to: Real,
) -> SingleImpact:
    """One body, on summits with descending ``offsets`` [m]; its pull-off force where ``wanted``.

    Bodies do not deform in bulk, so that all summits move alike: the energy is the sum of theirs.
    Tips that yield were pressed before, to a separation ``pressed_to`` [m].
    """
    summits = table.of(classes)
    found = PressedSummits.of(summits, contact, jnp.maximum(offsets - pressed_to, 0.0))
    top = top_of(summits, launch, offsets - found.residual)
    external = _external_energy(found, launch, offsets, top)
    turning_point = rigid_approach(found, launch, offsets, top)
    gaps = turning_point - offsets
    pressed = found.turned(gaps)
    recovered = offsets - pressed.residual
    branch = summits.branch(turning_point - recovered)
    kept_by_tips = found.approach(gaps) - pressed.bonded(gaps, branch)

    def energy_on_retraction(separation: jax.Array) -> jax.Array:
        work = pressed.bonded(separation - offsets, branch) + kept_by_tips
        return external(separation) - jnp.sum(work)

    def force(separation: jax.Array) -> jax.Array:
        one = jnp.ones_like(separation)
        return jax.jvp(energy_on_retraction, (separation,), (one,))[1] + launch.weight

    held = turning_point - recovered <= summits.forming
    end = jnp.minimum(top, jnp.max(recovered + summits.interaction_range))
    ends = jnp.where(held, recovered + summits.breaking, end)
    looked_at = _on_retraction(summits, jnp.max(recovered), turning_point, end, ends)
    begun = external(top) - jnp.sum(found.approach(top - offsets))
    before, after = begun + launch.weight * (top - end), energy_on_retraction(end)
    captured = jnp.minimum(_least(energy_on_retraction, *looked_at), after) < 0.0
    each = -jax.jvp(found.approach, (gaps,), (jnp.ones_like(gaps),))[1]
    squares = jnp.sum(each**2)
    lost = jnp.sum(held * pressed.flatness * summits.lost, axis=1)
    yielding = jnp.zeros(0) if contact is None else jnp.sum(kept_by_tips)[None]
    nothing = jnp.asarray(jnp.nan)
    return SingleImpact(
        closest_approach=turning_point,
        captured=captured,
        impact_energy=before,
        restitution=jnp.where(captured, 0.0, jnp.sqrt(jnp.maximum(after, 0.0) / before)),
        contacting=jnp.sum(gaps < 0.0).astype(float),
        maximum_force=jnp.sum(each),
        loaded=jnp.sum(each) ** 2 / jnp.where(squares > 0.0, squares, 1.0),
        bonds=jnp.sum(held, axis=1).astype(float),
        lost=jnp.append(lost, yielding),
        interaction=jnp.zeros(()),
        pull_off=_pull_off(summits, force, recovered, turning_point, *looked_at)
        if wanted
        else nothing,
        unsolved=jnp.zeros(()),
        within_range=jnp.sum(gaps <= summits.approach_range),
    )


Along = Callable[[jax.Array], jax.Array]


def top_of(summits: Asperities, launch: Launch, offsets: jax.Array) -> jax.Array:
    """The separation [m] at which a body is released, or its first summit begins to pull."""
    return jnp.minimum(launch.release, jnp.max(offsets + summits.interaction_range))


def _external_energy(
    found: PressedSummits, launch: Launch, offsets: jax.Array, top: jax.Array
) -> Along:
    """Kinetic energy and work [J] that a body without summits would have at a separation [m]."""
    begin = jnp.where(jnp.isfinite(launch.release), launch.release, top)
    energy = launch.kinetic + jnp.sum(found.approach(begin - offsets))
    return lambda separation: energy + launch.weight * (begin - separation)


def rigid_approach(
    found: PressedSummits, launch: Launch, offsets: jax.Array, top: jax.Array
) -> jax.Array:
    """The first separation [m] at which a body that does not deform in bulk has spent its energy.

    NaN where there is none in the table.
    """
    external, summits = _external_energy(found, launch, offsets, top), found.summits

    def energy(separation: jax.Array) -> jax.Array:
        return external(separation) - jnp.sum(found.approach(separation - offsets))

    gaps = summits.gaps_of_first(summits.cells * (1.0 - _SHARES))
    first = jnp.max(offsets - found.residual)
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


def _on_retraction(
    summits: Asperities, first: jax.Array, start: jax.Array, top: jax.Array, ends: jax.Array
) -> tuple[jax.Array, jax.Array]:
    """Separations [m] to look at from ``start`` on, those of ``ends`` among them, and their steps.

    Closest together at the start, and where the ``first`` summit has its forces.
    """
    shares = _SHARES[2::2]
    near = [summits.between(start, top, origin, shares) for origin in (start, first)]
    even, ends = jnp.sort(jnp.concatenate(near)), ends.ravel()
    ends = ends - _CLOSE * jnp.abs(ends)  # just before they break
    separations = jnp.clip(jnp.concatenate([even, ends]), even[0], top)
    return separations, jnp.interp(separations, even, jnp.diff(even, prepend=start))


def _pull_off(
    summits: Asperities,
    force: Along,
    offsets: jax.Array,
    start: jax.Array,
    separations: jax.Array,
    step: jax.Array,
) -> jax.Array:
    """The largest tension on retraction [N]; it has about as many maxima as there are summits."""
    lengths = summits.breaking, jnp.abs(summits.pull_off_gap), summits.scale
    widest = jnp.max(jnp.vstack(lengths))
    highest = jax.lax.top_k(offsets, min(_HIGHEST, offsets.size))[0]
    about = (highest[:, None] + widest * _ABOUT).ravel()
    more = jnp.concatenate([offsets + summits.pull_off_gap, about])
    more = jnp.clip(more, start, jnp.max(separations))
    steps = jnp.minimum(jnp.append(step, jnp.full(more.shape, widest)), widest)
    return -jnp.minimum(_least(force, jnp.append(separations, more), steps), 0.0)


def _least(value: Along, separations: jax.Array, step: jax.Array) -> jax.Array:
    """The least value at some separations that are a ``step`` [m] apart, and about it."""
    within = jnp.min(separations), jnp.max(separations)

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
    yielding: Yielding | None = None,
) -> SingleImpact:
    bodies, summits = offsets.shape
    contact, before = yielding or (None, jnp.full(bodies, jnp.inf))
    together = bodies
    while together > 1 and together * 2 * _SEPARATIONS * summits > _AT_ONCE:
        together //= 2
    jobs = jax.tree_util.tree_map(
        lambda leaf: leaf.reshape(-1, together, *leaf.shape[1:]),
        (launches, offsets, classes, before),
    )
    one = partial(_impact, table, wanted, contact)
    found = jax.lax.map(lambda job: jax.vmap(one)(*job), jobs)
    return jax.tree_util.tree_map(lambda leaf: leaf.reshape(bodies, *leaf.shape[2:]), found)


single_impacts = Program(_impacts, OPTIMISED)
"""First impacts of many bodies, whose number is a power of two.

By their launches of shape (bodies,), the offsets [m] of their summits, descending, and the classes
of these, of shape (bodies, summits), whether their pull-off forces are wanted (static), and what is
known of tips that yield."""
