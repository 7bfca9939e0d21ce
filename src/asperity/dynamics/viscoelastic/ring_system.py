"""Rings under a rough body on a half-space that creeps, and where they lie."""

from __future__ import annotations

from math import pi
from typing import Any, NamedTuple

from ..._jax import jax, jnp
from ...contact.delayed_formation import DelayedContact
from ...contact.elastic import ElasticContact
from ...contact.equilibrium import compliance, profile_of
from ...contact.viscoelastic import Relaxation
from ...halfspace import ring_mesh
from ...interface.rough_planes import Memory as Thresholds
from ...laws.law import Real
from ...numerics.compilation import kept
from ...numerics.roots import fixed_point
from ..curve_table import rows_of
from .ring_menisci import Holding, Waiting

_CLOSE = 1e-13  # change of a separation that is small enough, relative to heights and itself
_STEPS = 30


@kept
class RingState(NamedTuple):
    """Where a body and its rings are.

    Attributes
    ----------
    separation, speed
        Of the rigid body [m], and positive apart [m/s].
    gaps
        Separation of the mean planes at the rings and at the mesh's end [m].
    retarded
        The retarded pressure c at the rings [Pa].
    thresholds
        Memory of the bonds, at the rings and at the mesh's end.
    """

    separation: Real
    speed: Real
    gaps: Real
    retarded: Real
    thresholds: Thresholds


class Bulk(NamedTuple):
    """What the rings' displacement and force are made of."""

    contact: ElasticContact
    delayed: DelayedContact | None
    size: jax.Array
    rows: jax.Array
    area: jax.Array
    around: jax.Array
    excess: jax.Array
    pace: jax.Array

    @classmethod
    def of(cls, relaxation: Relaxation, size: jax.Array) -> Bulk:
        contact: Any = relaxation.contact
        mesh = ring_mesh(contact.rings)
        rows = compliance(contact.rings)[:, :-1]
        around = jnp.asarray(2.0 * pi * contact.shape.radius)
        area = jnp.asarray(mesh.area) * size**2
        excess, pace = 1.0 / relaxation.ratio - 1.0, relaxation.ratio / relaxation.time
        rows = rows * (size / contact.modulus)
        return cls(contact, relaxation.delayed, size, rows, area, around, excess, pace)

    @property
    def profile(self) -> jax.Array:
        """Profile of the body at the rings and at the mesh's end [m]."""
        return profile_of(self.contact, self.size)

    def pressed(self, gaps: jax.Array, held: Thresholds) -> tuple[jax.Array, jax.Array]:
        """Pressure on the rings [Pa] and the whole force [N]."""
        pressure = self.contact.interface.pressure(gaps, held)
        outside = self.contact.interface.pressure(
            gaps[-1:], tuple(b[-1:] for b in held), integrated=1
        )
        return pressure[:-1], self.area @ pressure[:-1] + self.around * outside[0]

    @property
    def waiting(self) -> Waiting | None:
        """Its menisci, where they take time."""
        return None if self.delayed is None else Waiting(self.delayed, self.contact.interface)

    def dissipated(self, pressure: jax.Array, retarded: jax.Array) -> jax.Array:
        """Power that the dashpots take [W]."""
        delayed = pressure - retarded
        return self.excess * self.pace * ((self.area * delayed) @ (self.rows[:-1] @ delayed))


@kept
class Freed(NamedTuple):
    """Rings in flight.

    Attributes
    ----------
    displacement
        Displacement that creep has left at the rings and at the mesh's end [m].
    axis
        The same at the axis [m].
    stored
        Energy that it holds [J].
    """

    displacement: Real
    axis: Real
    stored: Real


def freed(relaxation: Relaxation, size: Real, retarded: Real) -> Freed:
    """What creep has left on a mesh of a ``size`` [m], where nothing presses."""
    bulk = Bulk.of(relaxation, jnp.asarray(size))
    displacement = bulk.excess * (bulk.rows @ retarded)
    stored = 0.5 * retarded @ (bulk.area * displacement[:-1])
    return Freed(
        displacement, jnp.asarray(ring_mesh(bulk.contact.rings).axis) @ displacement[:-1], stored
    )


class Rest(NamedTuple):
    """Separations without pressure, what a pressure adds, and what the force adds to all."""

    base: jax.Array
    rows: jax.Array
    lever: jax.Array


def balanced(
    bulk: Bulk, holding: Holding, rest: Rest, guess: jax.Array
) -> tuple[jax.Array, jax.Array]:
    """Separations that agree with their pressures, by Newton's method, and whether they do."""
    surfaces = bulk.contact.interface
    scale = surfaces.scale.rms

    def newton(gaps: jax.Array) -> tuple[jax.Array, jax.Array]:
        def pressures(gaps: jax.Array) -> jax.Array:
            return surfaces.pressure(gaps, holding(gaps))

        pressure, slope = jax.jvp(pressures, (gaps,), (jnp.ones_like(gaps),))
        _, force = bulk.pressed(gaps, holding(gaps))
        missed = gaps - rest.base - rest.rows @ pressure[:-1] - rest.lever * force
        # The force outside the mesh is the pressure's integral from its end.
        by_gap = jnp.append(bulk.area * slope[:-1], -bulk.around * pressure[-1])
        inner = jnp.pad(rest.rows * slope[:-1], ((0, 0), (0, 1)))
        matrix = jnp.eye(gaps.size) - inner - rest.lever * by_gap
        move = jnp.linalg.solve(matrix, missed[:, None])[:, 0]
        return gaps - move, jnp.max(jnp.abs(move) / (scale + jnp.abs(gaps)))

    gaps, change = fixed_point(newton, guess, _CLOSE, _STEPS)
    return gaps, change <= 1e3 * _CLOSE


def row_of(bulk: Bulk, here: RingState) -> jax.Array:
    """Quantities of the contact in one row, without its field."""
    separation = jnp.asarray(here.separation)
    state, pressure = bulk.contact.on_rings(separation, here.gaps, here.thresholds, bulk.size)
    bent = pressure @ (bulk.area * (bulk.rows[:-1] @ pressure))
    retarded = here.retarded @ (bulk.area * (bulk.rows[:-1] @ here.retarded))
    stored = state.stored + 0.5 * (bent + bulk.excess * retarded)
    return rows_of(state._replace(stored=stored))
