"""What a motion means: rebound heights, restitution, decrement, capture, losses.

Everything is computed from the turning points in JAX, so that it can be batched and
differentiated; rows of impacts that did not take place, and measures that do not apply,
are NaN.
"""

from __future__ import annotations

from typing import NamedTuple

from ._jax import jax, jnp
from .errors import Outcome
from .impact import Body, Impacts, Motion, Table
from .impact.damping import kinetic_at
from .impact.datum import end_of_contact
from .impact.history import ENDS, Phase
from .impact.table import join
from .program import kept


@kept
class Measures(NamedTuple):
    """Measures of a motion.

    Attributes
    ----------
    impact_speed
        Largest speed on the first way in [m/s].
    captured
        Whether a rebound stays within the contact, or the body came to rest in it.
    capture_time
        Time of the impact that captures [s].
    stiction_time
        Time from release to rest [s].
    rebound_height
        Apex above the static equilibrium [m], per impact.
    restitution
        Square root of the ratio of energies after and before, per impact.
    log_decrement
        Logarithm of the ratio of successive rebound heights, the first against the release.
    impact_time
        Time from maximum to maximum [s].
    power_loss
        Energy lost from maximum to maximum over that time [W].
    power_loss_published
        Work of the attractive forces on the way out over that time [W], eq. 23.
    reference
        Separation [m] at which energies in and out are compared: the end of contact, or
        NaN where the body is released within it and the static equilibrium is taken.
    """

    impact_speed: jax.Array
    captured: jax.Array
    capture_time: jax.Array
    stiction_time: jax.Array
    rebound_height: jax.Array
    restitution: jax.Array
    log_decrement: jax.Array
    impact_time: jax.Array
    power_loss: jax.Array
    power_loss_published: jax.Array
    reference: jax.Array


Passing = tuple[jax.Array, jax.Array]
"""Kinetic energies [J] at the end of contact on the way in and out, per impact."""


def measure(
    motion: Motion,
    body: Body,
    passing: Passing | None = None,
    reference: jax.Array | None = None,
) -> Measures:
    """Measures of a motion; see :class:`Measures`.

    Parameters
    ----------
    motion, body
        The motion, and what moved.
    passing
        For a motion in gas of which no phases are kept: its energies at the end of contact.
    reference
        The end of contact [m], where it is known: :func:`contact_ends`, which needs the table.
    """
    rows, datum, end = motion.impacts, motion.datum, motion.end
    reference = contact_ends(motion.table, rows) if reference is None else reference
    outside = reference < body.release
    escaped = end.outcome == ENDS.index(Outcome.ESCAPED)
    last = jnp.arange(rows.made.shape[0]) == end.made - 1
    gone = jnp.logical_and(escaped, last)
    away = gone | (last & (end.outcome == ENDS.index(Outcome.STOPPED)))  # of no further maximum

    falls = body.weight > 0.0
    top = body.release + jnp.where(
        falls, body.kinetic / jnp.where(falls, body.weight, 1.0), jnp.inf * (body.kinetic > 0)
    )
    rebounds = rows.made & (rows.apex > rows.deepest)  # a body that creeps to rest has none
    apex = jnp.where(gone, jnp.nan, jnp.where(rebounds, rows.apex, jnp.nan))
    height = apex - datum.equilibrium
    before = _shift(height, top - datum.equilibrium)
    fits = jnp.logical_and(jnp.isfinite(before), height > 0.0)
    decrement = jnp.log(jnp.where(fits, before, 1.0) / jnp.where(fits, height, 1.0))

    duration = rows.apex_time - _shift(rows.apex_time, 0.0)
    period = jnp.where(jnp.logical_and(rows.made, jnp.logical_not(away)), duration, jnp.nan)
    total = jnp.sum(rows.lost, axis=1)
    captures = _captures(motion, body, reference, away)
    rests = end.outcome == ENDS.index(Outcome.REST)
    seen = jnp.logical_and(outside, jnp.any(captures))
    damped = jnp.asarray(body.film is not None)
    captured = jnp.where(jnp.logical_and(outside, ~damped), seen, jnp.logical_or(seen, rests))
    first = jnp.argmax(captures)
    stiction = jnp.where(rests, end.time, jnp.nan)
    capture_time = jnp.where(seen, rows.deepest_time[first], stiction)
    safe = jnp.where(jnp.isfinite(period), period, 1.0)
    blank = jnp.where(jnp.isfinite(period), 1.0, jnp.nan)
    return Measures(
        impact_speed=jnp.sqrt(2.0 * rows.fastest[0] / body.mass),
        captured=captured,
        capture_time=jnp.where(captured, capture_time, jnp.nan),
        stiction_time=stiction,
        rebound_height=height,
        restitution=_restitution(motion, body, reference, outside, gone, captures, passing),
        log_decrement=jnp.where(fits, decrement, jnp.nan),
        impact_time=period,
        power_loss=(total - _shift(total, 0.0)) / safe * blank,
        power_loss_published=rows.pull_work / safe * blank,
        reference=jnp.where(outside, reference, jnp.nan),
    )


def contact_ends(table: Table, rows: Impacts) -> jax.Array:
    """Where the contact of a motion ends [m]: its force is 1e-6 of the largest there."""
    peak = jnp.max(jnp.where(rows.made, jnp.abs(rows.force), 0.0))
    return end_of_contact(table, peak)


def passing_at(body: Body, table: Table, rows: Impacts, place: jax.Array) -> Passing:
    """Kinetic energies [J] with which each impact passes a place [m] outside contact."""

    def passing(phase: Phase, parting: bool) -> jax.Array:
        way = jnp.asarray(parting)
        pieces = join(table, phase.branch, phase.inner, phase.start, way)
        return kinetic_at(body, pieces, phase.kinetic, way, place)

    return (
        jax.vmap(lambda phase: passing(phase, False))(rows.fall),
        jax.vmap(lambda phase: passing(phase, True))(rows.rise),
    )


def _shift(values: jax.Array, first: jax.Array | float) -> jax.Array:
    """The values of the impact before, ``first`` before the first."""
    return jnp.concatenate([jnp.asarray(first, dtype=jnp.float64)[None], values[:-1]])


def _captures(motion: Motion, body: Body, reference: jax.Array, gone: jax.Array) -> jax.Array:
    """Whether a rebound stays within the contact, per impact.

    Gas alone may keep one within its reach: that is no capture, and the static equilibrium
    counts in place of the end of contact.
    """
    rows = motion.impacts
    held = reference if body.film is None else jnp.fmin(reference, motion.datum.equilibrium)
    return jnp.logical_and(rows.made, jnp.logical_and(rows.apex < held, ~gone))


def _restitution(
    motion: Motion,
    body: Body,
    reference: jax.Array,
    outside: jax.Array,
    gone: jax.Array,
    captures: jax.Array,
    passing: Passing | None,
) -> jax.Array:
    """sqrt(E_out / E_in), E the energy above a body at rest at the end of contact.

    A body released within the reach of the contact has no such place on its path: there E
    counts from the static equilibrium. The impact that captures has 0, later ones NaN, and so
    has a rebound that gas alone keeps from coming back there.
    """
    rows = motion.impacts
    weight = body.weight
    zero = jnp.where(
        outside, weight * reference, motion.datum.stored + weight * motion.datum.equilibrium
    )
    after = rows.mechanical - zero
    before = _shift(after, motion.release - zero)
    if body.film is not None:
        # Gas takes energy beyond the reference too: count what passes there.
        kinetic_in, kinetic_out = passing or passing_at(body, motion.table, rows, reference)
        before = jnp.where(outside, kinetic_in, before)
        after = jnp.where(outside, kinetic_out, after)
    back = jnp.logical_or(rows.apex >= reference, gone)
    counts = jnp.logical_or(back, jnp.logical_not(outside))
    usable = jnp.logical_and(jnp.logical_and(before > 0.0, after > 0.0), counts)
    ratio = jnp.where(usable, after, 1.0) / jnp.where(usable, before, 1.0)
    free_before = jnp.logical_or(_shift(counts.astype(float), 1.0) > 0.5, ~outside)
    ends = jnp.logical_and(outside, free_before)
    if body.film is not None:
        ends = jnp.logical_and(ends, captures)
    otherwise = jnp.where(ends, 0.0, jnp.nan)
    value = jnp.where(usable, jnp.sqrt(jnp.where(usable, ratio, 1.0)), otherwise)
    return jnp.where(rows.made, value, jnp.nan)
