"""First impacts of single bodies whose summits feel one another through a half-space."""

from __future__ import annotations

from typing import NamedTuple

from .._jax import jax, jnp
from ..contact.asperity_table import Asperities
from ..contact.coupled_summits import CoupledSummits, influence_between
from ..contact.pressed_summits import PressedSummits
from ..laws.law import Real
from ..numerics.compilation import OPTIMISED, Program
from .coupled_path import follow
from .single_impact import Launch, SingleImpact, rigid_approach, top_of


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
    rigid = rigid_approach(PressedSummits(summits), launch, offsets, top)
    depth = jnp.where(jnp.isfinite(rigid), jnp.maximum(offsets - rigid, 0.0), 0.0)
    influence = influence_between(positions, jnp.sqrt(tips[classes] * depth), modulus)
    coupled = CoupledSummits.on(summits, offsets, influence, depth > 0.0)
    begin = jnp.where(jnp.isfinite(launch.release), launch.release, top)
    before = launch.kinetic + launch.weight * (begin - top)
    end = follow(coupled, launch.weight, top, before, depth[0])
    after, turn = end.last.kinetic, end.at_turn
    captured = jnp.minimum(end.least, after) < 0.0
    squares = jnp.sum(turn.forces**2)
    tabulated = jnp.min(turn.gaps - summits.gap_of_border(0)) >= 0.0
    return SingleImpact(
        closest_approach=jnp.where(end.arrived & tabulated, end.turning_point, jnp.nan),
        captured=captured,
        impact_energy=before,
        restitution=jnp.where(captured, 0.0, jnp.sqrt(jnp.maximum(after, 0.0) / before)),
        contacting=jnp.sum(turn.gaps < 0.0).astype(float),
        maximum_force=turn.force,
        loaded=turn.force**2 / jnp.where(squares > 0.0, squares, 1.0),
        bonds=jnp.sum(end.bonded_at_turn, axis=1).astype(float),
        lost=end.lost,
        interaction=end.freed - jnp.sum(end.lost),
        pull_off=end.tension,
        unsolved=(~end.sound).astype(float),
        within_range=jnp.sum(turn.gaps <= summits.approach_range),
    )


def _impacts(
    table: Asperities,
    launches: Launch,
    offsets: jax.Array,
    classes: jax.Array,
    bulk: Bulk,
) -> SingleImpact:
    def one(job: tuple[Launch, jax.Array, jax.Array, jax.Array]) -> SingleImpact:
        launch, offsets, classes, positions = job
        return _coupled_impact(
            table, launch, offsets, classes, positions, bulk.tip_radii, bulk.modulus
        )

    return jax.lax.map(one, (launches, offsets, classes, bulk.positions))


coupled_impacts = Program(_impacts, OPTIMISED)
"""First impacts of many bodies on a half-space.

By the arguments of :data:`~asperity.dynamics.single_impact.single_impacts`, and the
:class:`Bulk`."""
