"""What a motion means: rebound heights, restitution, decrement, capture, losses.

Everything is computed from the turning points in JAX, so that it can be batched and
differentiated; rows of impacts that did not take place, and measures that do not apply,
are NaN.
"""

from __future__ import annotations

from typing import NamedTuple

from .._jax import jax, jnp
from ..dynamics import Body, Motion
from ..errors import ENDS, Outcome
from ..laws.law import Real
from ..numerics.compilation import kept
from .first_contact import FirstContact, Passing, first_contact, passing_at


@kept
class Measures(NamedTuple):
    """Measures of a motion.

    Attributes
    ----------
    impact_speed
        Speed of approach where forces begin, at the end of contact [m/s]; NaN where a drag or a
        spring stops the body before. Of a body released within that, the speed at its static
        equilibrium, the largest.
    maximum_speed
        Largest speed on the first way in [m/s]: with attraction, above that of approach.
    captured
        Whether the first impact captures: its apex lies within the end of contact, where the
        force is 1e-6 of its peak, and with drag below the static equilibrium too. Of a body that is
        released within the end of contact the static equilibrium alone is asked.
    capture_time
        Time of the first impact, of all, that captures so [s].
    time_to_rest
        Time from release to rest [s].
    rebound_height
        Apex above the static equilibrium [m], per impact.
    restitution
        Square root of the ratio of energies after and before, per impact.
    log_decrement
        Logarithm of the ratio of successive rebound heights, the first against the release.
    rebound_period
        Time from maximum to maximum [s].
    power_loss
        Energy lost from maximum to maximum over that time [W].
    power_loss_published
        Work of the attractive forces on the way out over that time [W], eq. 23.
    contact_time
        Time that the first impact spends within the end of contact [s]; NaN where it is captured.
    maximum_force
        Contact force at the closest approach of the first impact [N]; of a motion that was stepped
        in time the largest of that impact.
    pull_off, pull_off_separation
        Largest tension while unloading from the first impact [N], and where it is [m]; 0 and NaN
        where nothing pulls.
    work_of_separation
        Work against that tension from the separation of zero force on [J].
    preload
        Load of the first impact [N] where these depend on it; NaN where any larger load gives the
        same.
    contact_end
        Separation [m] at which energies in and out are compared: the end of contact, or
        NaN where the body is released within it, or never comes there, and the static equilibrium
        is taken.
    touched
        Whether there is a contact at all.
    held_at_pull_off
        Expected number of asperities that touch or are bonded at pull-off.
    outset
        Separation [m] beyond which even the gentlest impact meets no force: in that the weight or
        the pull-off force is the largest.
    margin
        Apex of the first impact, from the separation below which that is a capture [m].
    """

    impact_speed: jax.Array
    maximum_speed: jax.Array
    captured: jax.Array
    capture_time: jax.Array
    time_to_rest: jax.Array
    rebound_height: jax.Array
    restitution: jax.Array
    log_decrement: jax.Array
    rebound_period: jax.Array
    power_loss: jax.Array
    power_loss_published: jax.Array
    contact_time: jax.Array
    maximum_force: jax.Array
    pull_off: jax.Array
    pull_off_separation: jax.Array
    work_of_separation: jax.Array
    preload: jax.Array
    contact_end: jax.Array
    touched: jax.Array
    held_at_pull_off: jax.Array
    outset: jax.Array
    margin: jax.Array


def measure(
    motion: Motion,
    body: Body,
    passing: Passing | None = None,
    first: FirstContact | None = None,
) -> Measures:
    """Measures of a motion; see :class:`Measures`.

    Parameters
    ----------
    motion, body
        The motion, and what moved.
    passing
        For a motion with drag outside contact of which no phases are kept: its energies at the
        end of contact.
    first
        Its first contact, where that is known; :func:`first_contact` needs the table.
    """
    rows, ground, end = motion.impacts, motion.reference, motion.end
    first = first_contact(motion.table, rows, body) if first is None else first
    contact_end, pulled = first.end, first.unloading
    outside = contact_end < body.release
    escaped = end.outcome == ENDS.index(Outcome.ESCAPED)
    last = jnp.arange(rows.made.shape[0]) == end.made - 1
    gone = jnp.logical_and(escaped, last)
    away = gone | (last & (end.outcome == ENDS.index(Outcome.STOPPED)))  # of no further maximum

    top = body.release + body.load.apex_height(body.release, body.kinetic)
    rebounds = rows.made & (
        rows.apex > rows.closest_approach
    )  # a body that creeps to rest has none
    apex = jnp.where(gone, jnp.nan, jnp.where(rebounds, rows.apex, jnp.nan))
    height = apex - ground.equilibrium
    before = _shift(height, top - ground.equilibrium)
    fits = jnp.logical_and(jnp.isfinite(before), height > 0.0)
    decrement = jnp.log(jnp.where(fits, before, 1.0) / jnp.where(fits, height, 1.0))

    duration = rows.apex_time - _shift(rows.apex_time, 0.0)
    period = jnp.where(jnp.logical_and(rows.made, jnp.logical_not(away)), duration, jnp.nan)
    total = jnp.sum(rows.lost, axis=1)
    rests = end.outcome == ENDS.index(Outcome.REST)
    held = _held_within(motion, body, contact_end, outside)
    captures = rows.made & (rows.apex < held) & ~away
    touched = ~jnp.isnan(contact_end) if body.forces else jnp.asarray(True)
    captures = (captures | (rests & rows.made & ~rebounds)) & touched
    capture_time = rows.closest_approach_time[jnp.argmax(captures)]
    energies = _energies(motion, body, contact_end, outside, passing)
    speed = _speed(jnp.where(outside, energies[0][0], rows.maximum_kinetic[0]), body.mass)
    ratio = _restitution(motion, body, contact_end, outside, gone, captures, energies)
    safe = jnp.where(jnp.isfinite(period), period, 1.0)
    blank = jnp.where(jnp.isfinite(period), 1.0, jnp.nan)
    return Measures(
        impact_speed=jnp.where(touched, speed, jnp.nan),
        maximum_speed=_speed(rows.maximum_kinetic[0], body.mass),
        captured=captures[0],
        capture_time=jnp.where(jnp.any(captures), capture_time, jnp.nan),
        time_to_rest=jnp.where(rests, end.time, jnp.nan),
        rebound_height=height,
        restitution=jnp.where(touched, ratio, jnp.nan),
        log_decrement=jnp.where(fits, decrement, jnp.nan),
        rebound_period=period,
        power_loss=(total - _shift(total, 0.0)) / safe * blank,
        power_loss_published=rows.pull_work / safe * blank,
        contact_time=jnp.where(outside, first.time, jnp.nan),
        maximum_force=first.force,
        pull_off=pulled.pull_off,
        pull_off_separation=pulled.separation,
        work_of_separation=pulled.work,
        preload=jnp.where(pulled.depends, rows.force[0], jnp.nan),
        contact_end=jnp.where(outside, contact_end, jnp.nan),
        touched=touched,
        held_at_pull_off=pulled.held,
        outset=first.outset,
        margin=rows.apex[0] - held,
    )


def _shift(values: jax.Array, first: jax.Array | float) -> jax.Array:
    """The values of the impact before, ``first`` before the first."""
    return jnp.concatenate([jnp.asarray(first, dtype=jnp.float64)[None], values[:-1]])


def _held_within(
    motion: Motion, body: Body, contact_end: jax.Array, outside: jax.Array
) -> jax.Array:
    """Separation [m] below which an apex is a capture.

    Drag alone may keep a body within the range of its contact: that is no capture, and the static
    equilibrium counts in place of the end of contact.
    """
    still = motion.reference.equilibrium
    alone = body.damped_apart and not body.forces  # a spring draws a body out that drag held
    held = jnp.fmin(contact_end, still) if alone else contact_end
    return jnp.where(outside, held, still)


def _speed(energy: jax.Array, mass: Real) -> jax.Array:
    """Speed [m/s] of a kinetic energy [J]; NaN of a negative one."""
    known = energy > 0.0
    return jnp.where(known, jnp.sqrt(2.0 / mass * jnp.where(known, energy, 1.0)), jnp.nan)


def _energies(
    motion: Motion, body: Body, contact_end: jax.Array, outside: jax.Array, passing: Passing | None
) -> tuple[jax.Array, jax.Array]:
    """Energies [J] before and after each impact, above that of a body at the end of contact.

    A body released within the range of the contact has no such place on its path: there they
    count from the static equilibrium.
    """
    rows, potential = motion.impacts, body.load.potential
    still = motion.reference
    at_rest = still.stored + potential(still.equilibrium)
    zero = jnp.where(outside, potential(contact_end), at_rest)
    after = rows.mechanical - zero
    before = _shift(after, motion.release - zero)
    if body.damped_apart:
        # It takes energy beyond the end of contact too: count what passes there.
        kinetic_in, kinetic_out = passing or passing_at(body, motion.table, rows, contact_end)
        before = jnp.where(outside, kinetic_in, before)
        after = jnp.where(outside, kinetic_out, after)
    return before, after


def _restitution(
    motion: Motion,
    body: Body,
    contact_end: jax.Array,
    outside: jax.Array,
    gone: jax.Array,
    captures: jax.Array,
    energies: tuple[jax.Array, jax.Array],
) -> jax.Array:
    """Square root of the ratio of the energies after and before each impact.

    The impact that captures has 0, later ones NaN, and so has a rebound that drag alone keeps
    from coming back to the end of contact.
    """
    rows, (before, after) = motion.impacts, energies
    back = jnp.logical_or(rows.apex >= contact_end, gone)
    counts = jnp.logical_or(back, jnp.logical_not(outside))
    usable = jnp.logical_and(jnp.logical_and(before > 0.0, after > 0.0), counts)
    ratio = jnp.where(usable, after, 1.0) / jnp.where(usable, before, 1.0)
    free_before = jnp.logical_or(_shift(counts.astype(float), 1.0) > 0.5, ~outside)
    ends = jnp.logical_and(outside, free_before)
    if body.damped_apart:
        ends = jnp.logical_and(ends, captures)
    otherwise = jnp.where(ends, 0.0, jnp.nan)
    value = jnp.where(usable, jnp.sqrt(jnp.where(usable, ratio, 1.0)), otherwise)
    return jnp.where(rows.made, value, jnp.nan)
