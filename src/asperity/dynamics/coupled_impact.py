"""First impacts of single bodies whose summits feel one another through a half-space."""

from __future__ import annotations

from typing import NamedTuple

from .._jax import jax, jnp
from ..contact.asperity_table import Asperities
from ..contact.coupled_summits import CoupledSummits, influence_between
from ..contact.pressed_summits import PressedSummits
from ..laws.law import Real
from ..numerics.compilation import Program
from .coupled_path import Path, follow
from .damped_coupled import damped_path
from .record import Body
from .single_impact import SingleImpact, balance, effectively_loaded
from .summit_path import (
    Arrival,
    Departure,
    Launch,
    SummitPath,
    arrive,
    end_of,
    top_of,
)


class Bulk(NamedTuple):
    """Summits on a half-space, for many bodies.

    Attributes
    ----------
    positions
        Coordinates of the summits from the axis of each body [m], shape (bodies, summits, 2).
    tip_radii
        Tip radius of each class of them [m], shape (classes,).
    modulus
        Contact modulus E* of the bulk [Pa].
    """

    positions: jax.Array
    tip_radii: jax.Array
    modulus: Real


def _coupled_impact(
    table: Asperities,
    body: Body,
    launch: Launch,
    offsets: jax.Array,
    classes: jax.Array,
    positions: jax.Array,
    tips: jax.Array,
    modulus: Real,
) -> SingleImpact:
    """One body, on summits with descending ``offsets`` [m]."""
    summits = table.of(classes)
    top = top_of(summits, launch, offsets)
    # Contacts are about as wide as those of a rigid body that comes with the same energy.
    rigid = arrive(body, SummitPath(PressedSummits(summits), offsets), launch, top)
    deepest = rigid.turning_point
    depth = jnp.where(jnp.isfinite(deepest), jnp.maximum(offsets - deepest, 0.0), 0.0)
    influence = influence_between(positions, jnp.sqrt(tips[classes] * depth), modulus)
    coupled = CoupledSummits.on(summits, offsets, influence, depth > 0.0)
    along = damped_path if body.damped else _free_path
    path, arrival, departure = along(body, coupled, launch, top, rigid, depth[0])
    turn, end = path.at_turn, path.last.separation
    begin = end_of(summits, offsets, jnp.zeros_like(path.bonded_at_turn), top)
    met = arrival.met & (arrival.turning_point < begin)
    before, captured, restitution = balance(body, arrival, departure, met, (top, end))
    tabulated = jnp.min(turn.gaps - summits.gap_of_border(0)) >= 0.0
    turning_point = jnp.where(path.arrived & tabulated, arrival.turning_point, jnp.nan)
    return SingleImpact(
        closest_approach=jnp.where(arrival.met, turning_point, top),
        captured=captured,
        impact_energy=before,
        restitution=restitution,
        contacting=jnp.sum(turn.gaps < 0.0).astype(float),
        maximum_force=turn.force,
        loaded=effectively_loaded(turn.gaps),
        bonds=jnp.sum(path.bonded_at_turn, axis=1).astype(float),
        lost=jnp.concatenate([path.lost, arrival.taken + met * departure.taken]),
        interaction=path.freed - jnp.sum(path.lost),
        pull_off=path.tension,
        end=end,
        unsolved=(~path.sound).astype(float),
        within_range=jnp.sum(turn.gaps <= summits.approach_range),
    )


def _free_path(
    body: Body,
    coupled: CoupledSummits,
    _launch: Launch,
    top: jax.Array,
    free: Arrival,
    depth: jax.Array,
) -> tuple[Path, Arrival, Departure]:
    """:func:`~asperity.dynamics.damped_coupled.damped_path` of a body that no drag slows."""
    path = follow(coupled, body.load, top, jnp.where(free.met, free.before, jnp.nan), depth)
    after = path.last.kinetic
    captured = jnp.minimum(path.least, after) < 0.0
    arrival = free._replace(turning_point=path.turning_point)
    return path, arrival, Departure(captured, after, jnp.zeros(0))


def _impacts(
    table: Asperities,
    body: Body,
    launches: Launch,
    offsets: jax.Array,
    classes: jax.Array,
    bulk: Bulk,
) -> SingleImpact:
    def one(job: tuple[Launch, jax.Array, jax.Array, jax.Array]) -> SingleImpact:
        launch, offsets, classes, positions = job
        return _coupled_impact(
            table, body, launch, offsets, classes, positions, bulk.tip_radii, bulk.modulus
        )

    return jax.lax.map(one, (launches, offsets, classes, bulk.positions))


coupled_impacts = Program(_impacts)
"""First impacts of many bodies on a half-space.

By the arguments of :data:`~asperity.dynamics.single_impact.single_impacts`, and the
:class:`Bulk`."""
