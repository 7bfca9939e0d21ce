"""First impacts of single bodies: rigid, on the summits that stand under each."""

from __future__ import annotations

from functools import partial
from typing import NamedTuple

from .._jax import jax, jnp
from ..contact.asperity_table import Asperities
from ..contact.pressed_summits import PressedSummits
from ..laws.law import Real
from ..laws.plastic import PlasticContact
from ..numerics.compilation import Program, kept
from .damped_summits import arrive_damped, damped_kinetic_apart, leave_damped
from .delayed_path import Delay, DelayedPath, Formation, prompt_path, with_menisci
from .delayed_summits import arrive_delayed, leave_delayed
from .record import Body
from .summit_path import (
    Arrival,
    Departure,
    Launch,
    Outward,
    SummitPath,
    arrive,
    end_of,
    kinetic_apart,
    leave,
    top_of,
)

_AT_ONCE = 1 << 14  # gaps that are held in memory together: more leave the cache
_LOOKS = 96  # gaps of each summit for which energies are held


class Yielding(NamedTuple):
    """Tips that yield, and how deep earlier impacts have pressed them.

    Attributes
    ----------
    contact
        Contact of a tip of each class, with values of shape (classes,).
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
        Separation [m] of the turning point; NaN where none is found in the table. Where forces
        begin, of a body that does not come as close as that.
    captured
        Whether its kinetic energy is spent before forces end. Also of a body that drag stops on its
        way in and that other forces press on; what else is known of it is of that place.
    impact_energy
        Kinetic energy [J] that it brings to where forces end on retraction, had its summits none
        before. 0 where it meets none.
    restitution
        Square root of the ratio of what it takes from there to it; 0 where the body is captured or
        drag stops it, 1 where it comes back without having met a summit.
    contacting
        Summits in contact at the turning point.
    maximum_force
        Contact force there [N].
    loaded
        Effective number of loaded summits there, (sum F)^2 / sum F^2 by the loads of Hertz.
    bonds
        Bonds of each law there, shape (laws,).
    lost
        Energy [J] that they take by the time all are broken, shape (laws,). Where tips yield, what
        these keep follows; then what each drag takes from the release on, until forces end;
        until it hardly moves, of a body that is captured.
    interaction
        Energy [J] that changes of bonds take besides, as they move other summits through the
        half-space; negative where it is set free. 0 on a rigid bulk.
    pull_off
        Largest tension on retraction [N]; NaN where it is not asked for.
    end
        Separation [m] where forces end on retraction.
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
    end: jax.Array
    unsolved: jax.Array
    within_range: jax.Array


def _impact(
    table: Asperities,
    wanted: bool,
    contact: PlasticContact | None,
    delay: Delay | None,
    body: Body,
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
    contact = jax.tree_util.tree_map(lambda values: values[classes], contact)
    found = PressedSummits.of(summits, contact, jnp.maximum(offsets - pressed_to, 0.0))
    inward = SummitPath(found, offsets)
    top = top_of(summits, launch, offsets - found.residual)
    arrival, menisci = _arrive(body, delay, inward, launch, top)
    turning_point = jnp.where(arrival.met, arrival.turning_point, top)
    gaps = turning_point - offsets
    pressed = found.turned(gaps)
    recovered = offsets - pressed.residual
    outward = SummitPath(pressed, offsets, summits.branch(turning_point - recovered))
    held = turning_point - recovered <= summits.forming
    end = end_of(summits, recovered, held, top)
    begin = end_of(summits, offsets - found.residual, jnp.zeros_like(held), top)
    met = arrival.met & (turning_point < begin)
    ends = jnp.where(held, recovered + summits.breaking, end)
    out = Outward(outward, turning_point, end, recovered, ends)
    departure, taken = _leave(body, delay, out, arrival.kinetic, menisci)
    before, captured, restitution = balance(body, arrival, departure, met, (top, end))
    lost, maximum_force = held * pressed.flatness * summits.lost, inward.force(turning_point)
    if delay is not None and menisci is not None and taken is not None:
        at_turn = DelayedPath(prompt_path(inward, delay), menisci.formed, delay.law)
        maximum_force = at_turn.force(turning_point)
        held = held.at[delay.law].set(menisci.formed)
        lost = lost.at[delay.law].set(taken.lost)
        out = out._replace(path=with_menisci(outward, delay, taken))
    kept_by_tips = inward.work(turning_point) - outward.work(turning_point)
    yielding = jnp.zeros(0) if contact is None else kept_by_tips[None]
    return SingleImpact(
        closest_approach=jnp.where(jnp.isnan(departure.after), jnp.nan, turning_point),
        captured=captured,
        impact_energy=before,
        restitution=restitution,
        contacting=jnp.sum(gaps < 0.0).astype(float),
        maximum_force=maximum_force,
        loaded=effectively_loaded(gaps),
        bonds=jnp.sum(held, axis=1).astype(float),
        lost=jnp.concatenate(
            [jnp.sum(lost, axis=1), yielding, arrival.taken + met * departure.taken]
        ),
        interaction=jnp.zeros(()),
        pull_off=out.pull_off() if wanted else jnp.asarray(jnp.nan),
        end=end,
        unsolved=jnp.zeros(()),
        within_range=jnp.sum(gaps <= summits.approach_range),
    )


def _arrive(
    body: Body, delay: Delay | None, path: SummitPath, launch: Launch, top: jax.Array
) -> tuple[Arrival, Formation | None]:
    """The way in, and the menisci at its end where these take time."""
    if delay is not None:
        return arrive_delayed(body, path, launch, top, delay)
    return (arrive_damped if body.damped else arrive)(body, path, launch, top), None


def _leave(
    body: Body, delay: Delay | None, outward: Outward, kinetic: jax.Array, menisci: Formation | None
) -> tuple[Departure, Formation | None]:
    """The way out, and the menisci at its end."""
    if delay is not None and menisci is not None:
        return leave_delayed(body, outward, kinetic, menisci, delay)
    return (leave_damped if body.damped else leave)(body, outward, kinetic), None


def effectively_loaded(gaps: jax.Array) -> jax.Array:
    """As how many alike ones summits with some gaps [m] carry, by Hertz's loads; 0 where none does.

    As the effective number of the mean field: forces with what attracts would sum to less than one
    of them.
    """
    loads = jnp.maximum(-gaps, 0.0) ** 1.5
    squares = jnp.sum(loads**2)
    return jnp.sum(loads) ** 2 / jnp.where(squares > 0.0, squares, 1.0)


def balance(
    body: Body,
    arrival: Arrival,
    departure: Departure,
    met: jax.Array,
    within: tuple[jax.Array, jax.Array],
) -> tuple[jax.Array, jax.Array, jax.Array]:
    """Impact energy [J], whether a body is captured, and its restitution.

    Parameters
    ----------
    body, arrival, departure
        What moves, and how it comes and leaves.
    met
        Whether it meets a summit.
    within
        Its top, and where forces end on its way out [m].
    """
    apart = damped_kinetic_apart if body.damped else kinetic_apart
    before = jnp.where(met, apart(body, arrival.before, *within), 0.0)
    drawn = arrival.met | (body.load.force(arrival.turning_point) > 0.0)
    captured = (departure.captured & met) | (arrival.stays & drawn)
    after = jnp.where(met, jnp.maximum(departure.after, 0.0), before)
    kept = jnp.where(before > 0.0, jnp.sqrt(after / jnp.where(before > 0.0, before, 1.0)), ~met)
    return before, captured, jnp.where(captured | arrival.stays, 0.0, kept)


def _impacts(
    table: Asperities,
    body: Body,
    launches: Launch,
    offsets: jax.Array,
    classes: jax.Array,
    wanted: bool = True,
    yielding: Yielding | None = None,
    delay: Delay | None = None,
) -> SingleImpact:
    bodies, summits = offsets.shape
    contact, before = yielding or (None, jnp.full(bodies, jnp.inf))
    together = bodies
    while together > 1 and together * _LOOKS * summits > _AT_ONCE:
        together //= 2
    jobs = jax.tree_util.tree_map(
        lambda leaf: leaf.reshape(-1, together, *leaf.shape[1:]),
        (launches, offsets, classes, before),
    )
    one = partial(_impact, table, wanted, contact, delay, body)
    found = jax.lax.map(lambda job: jax.vmap(one)(*job), jobs)
    return jax.tree_util.tree_map(lambda leaf: leaf.reshape(bodies, *leaf.shape[2:]), found)


single_impacts = Program(_impacts)
"""First impacts of many bodies, whose number is a power of two.

By what moves, their launches of shape (bodies,), the offsets [m] of their summits, descending, and
the classes of these, of shape (bodies, summits), whether their pull-off forces are wanted (static),
and what is known of tips that yield. Of the body its mass, weight, drags and forces count."""
