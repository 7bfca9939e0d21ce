"""What moves, how it can end, and what is kept of a motion: its phases and impacts."""

from __future__ import annotations

from typing import Any, NamedTuple

import equinox as eqx
import numpy as np

from .._jax import jax, jnp
from ..contact.contact import Memory
from ..errors import Tolerance
from ..laws.law import Real, as_float64, quantity, quantity_or_none
from ..numerics.compilation import AT_ONCE, Program, kept
from .curve_table import Pieces, Table
from .external_forces import Along, Drag, ExternalForce, Load
from .instability import Jumps
from .static_equilibrium import Reference

IN_MOTION = -1
"""Code of a motion that has not ended; see :data:`asperity.errors.ENDS`."""


class Body(eqx.Module):
    """What moves, and how it starts.

    Parameters
    ----------
    mass
        Mass [kg].
    gravity
        Acceleration towards the surface [m/s^2], 0 or more.
    release
        Rigid separation at time 0 [m].
    speed
        Speed towards the surface at time 0 [m/s], 0 or more.
    drags
        What takes energy on its way, in the order of the ledger.
    forces
        What acts on it besides its weight, its contact and the drags.
    rebounds_from
        Separation [m] from which rebounds count; by default the static equilibrium.
    in_bulk
        What the bulk takes (static), by creep or by jumps of its surface: losses after those of
        the drags.
    """

    mass: Real = quantity()
    gravity: Real = quantity()
    release: Real = quantity()
    speed: Real = quantity(0.0)
    drags: tuple[Drag, ...] = ()
    forces: tuple[ExternalForce, ...] = ()
    rebounds_from: Real | None = quantity_or_none()
    in_bulk: tuple[str, ...] = eqx.field(static=True, default=())

    @property
    def mechanisms(self) -> tuple[str, ...]:
        """Names of the losses that are not the contact's."""
        return (*(drag.name for drag in self.drags), *self.in_bulk)

    @property
    def damped(self) -> bool:
        """Whether a drag takes energy on the way."""
        return bool(self.drags)

    @property
    def damped_apart(self) -> bool:
        """Whether one does outside contact too."""
        return any(drag.acts_apart for drag in self.drags)

    def resistances(self, along: Along) -> jax.Array:
        """Each drag's force over speed [N s/m] along a way, shape (drags, ...)."""
        each = [drag.resistance(along) for drag in self.drags]
        return jnp.stack(each) if each else jnp.zeros((0, *along.central.shape))

    @property
    def weight(self) -> jax.Array:
        """Weight [N]."""
        return self.mass * self.gravity

    @property
    def load(self) -> Load:
        """What presses it towards the surface."""
        return Load(self.weight, self.forces)

    @property
    def plain(self) -> Any:
        """The same of NumPy's arrays, whose arithmetic compiles nothing."""
        return jax.tree_util.tree_map(np.asarray, self)

    @property
    def kinetic(self) -> jax.Array:
        """Kinetic energy at the release [J]."""
        return 0.5 * self.mass * self.speed**2


def _resistances_apart(body: Body, central: Real) -> jax.Array:
    return body.resistances(Along.apart(central))


resistances_apart = Program(_resistances_apart, AT_ONCE)
"""`Body.resistances` at central separations [m] apart from a motion, compiled as a whole."""


@kept
class Phase(NamedTuple):
    """What a monotone phase started from; enough to draw it again.

    ``spent`` is where drag has taken the momentum of a body that other forces push on [m]; NaN
    where that does not happen.
    """

    start: jax.Array
    stop: jax.Array
    kinetic: jax.Array
    begun: jax.Array
    branch: jax.Array
    inner: Pieces
    lost: jax.Array
    bonds: jax.Array
    jumps: Jumps
    spent: jax.Array


class Limits(NamedTuple):
    """Ends of a motion as traced values: rest, time limit [s], largest number of impacts."""

    rest: jax.Array
    time: jax.Array
    impacts: jax.Array

    @classmethod
    def of(cls, tolerance: Tolerance) -> Limits:
        """The limits of a tolerance."""
        return cls(
            as_float64(tolerance.rest),
            as_float64(tolerance.time_limit),
            jnp.asarray(np.asarray(tolerance.max_impacts)),
        )


@kept
class Progress(NamedTuple):
    """A motion at the turning point before its next impact."""

    memory: Memory
    place: jax.Array
    kinetic: jax.Array
    time: jax.Array
    lost: jax.Array
    bonds: jax.Array
    central: jax.Array
    first: jax.Array
    impact_energy: jax.Array
    outcome: jax.Array
    made: jax.Array

    @classmethod
    def over(cls, time: jax.Array, outcome: jax.Array, made: jax.Array) -> Progress:
        """Where a motion ended, without what would be needed to go on."""
        none: Any = ()
        return cls(none, none, none, time, none, none, none, none, none, outcome, made)


@kept
class Begun(NamedTuple):
    """What a motion goes on from.

    Attributes
    ----------
    table, reference, origin
        Curves, static equilibrium, and mechanical energy at the release [J].
    progress
        The motion at its last apex.
    """

    table: Table
    reference: Reference
    origin: jax.Array
    progress: Progress


@kept
class Impacts(NamedTuple):
    """One row an impact; rows after the last have ``made`` False.

    Attributes
    ----------
    made
        Whether the impact took place.
    closest_approach, apex
        Rigid separations [m] of the turning points; the apex of a body that escapes is
        the end of the table.
    closest_approach_time, apex_time
        Times [s].
    mechanical
        Kinetic, potential and stored energy at the apex [J].
    leaving
        The same energy were the body to leave the contact, whether or not it has enough: a body
        that is captured has less than its potential energy at the end of contact. With drag, less
        what that took until the apex. NaN for motions stepped in time, where a captured body has
        no such energy.
    force
        Contact force at closest approach [N].
    contacting, bonds
        Expected asperities in contact, and bonds by law, at closest approach.
    lost
        Energy lost until the apex, since the release [J]: by law, then by drag.
    energy_balance_error
        Largest change of the sum of all energies since the release [J].
    pull_work
        Work of the attractive parts on the way out [J], as in the publication's eq. 23.
    maximum_kinetic
        Largest kinetic energy on the first way in, on a spring of the first impact [J]; the same
        in all rows.
    fall, rise
        The two phases; empty of motions stepped in time, which have a trajectory.
    """

    made: jax.Array
    closest_approach: jax.Array
    apex: jax.Array
    closest_approach_time: jax.Array
    apex_time: jax.Array
    mechanical: jax.Array
    leaving: jax.Array
    force: jax.Array
    contacting: jax.Array
    bonds: jax.Array
    lost: jax.Array
    energy_balance_error: jax.Array
    pull_work: jax.Array
    maximum_kinetic: jax.Array
    fall: Phase
    rise: Phase


class Motion(NamedTuple):
    """A whole motion.

    Attributes
    ----------
    impacts
        One row an impact.
    end
        Where it ended.
    table
        The contact's major branches.
    reference
        The static equilibrium, and the energy stored there.
    release
        Mechanical energy at the release [J].
    """

    impacts: Impacts
    end: Progress
    table: Table
    reference: Reference
    release: jax.Array
