"""A rough paraboloid on an elastic half-space: pressure and displacement agree."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable
from math import pi
from typing import NamedTuple

import equinox as eqx
import numpy as np

from .._jax import jax, jnp
from ..halfspace import ring_mesh
from ..interface import Interface
from ..interface import Memory as Thresholds
from ..laws.base import Real, quantity
from ..shapes import Sphere
from .base import Contact, State
from .rigid import RigidContact, asinh_panels

_PANELS = 10
_COARSE = 32  # rings of the mesh on which the size of the contact is found
_PASSES = 12  # of that search, at most
_ITERATIONS = 80


class RingMemory(NamedTuple):
    """Thresholds on the rings of a mesh of a given size.

    Attributes
    ----------
    thresholds
        One array a hysteretic law, shape (rings + 1,); the last belongs to the mesh's end.
    size
        Length [m] of the mesh; 0 where all thresholds are infinite and the mesh is free.
    rates
        Smallest rate of a ring's separation per rigid separation at the last reversal.
    lift
        Displacement [m] of the rings at the last reversal, shape (rings + 1,).
    """

    thresholds: Thresholds
    size: jax.Array
    rates: jax.Array
    lift: jax.Array


class Field(NamedTuple):
    """Solution on the rings: separation [m] and pressure [Pa], and how well they agree."""

    size: jax.Array
    separation: jax.Array
    pressure: jax.Array
    slope: jax.Array
    residual: jax.Array


class ElasticContact(Contact):
    """A rough sphere on a plane, both elastic half-spaces in bulk.

    Parameters
    ----------
    interface
        What happens between the two mean planes.
    shape
        The body.
    modulus
        Contact modulus E* [Pa] of the bulk.
    rings
        Number of rings (static). The force converges with a high order in it.
    refinement
        Factor on the number of panels of its curves (static).
    inner_nodes
        Solutions on a piece between a reversal and the outermost branch, at most 12 (static).
    inner_panels
        Number of these pieces (static); see :class:`RigidContact`.

    Notes
    -----
    The separation is h(r) = d + rise(r) + u(r) with u the displacement of the pressure
    p(h), solved by Newton's method on rings whose mesh follows the size of the contact
    (the publication's eqs. 18-20, axisymmetric). Beyond the mesh the body is rigid.
    """

    interface: Interface
    shape: Sphere
    modulus: Real = quantity()
    rings: int = eqx.field(static=True, default=96)
    refinement: int = eqx.field(static=True, default=1)
    inner_nodes: int = eqx.field(static=True, default=12)
    inner_panels: int = eqx.field(static=True, default=1)

    @property
    def mechanisms(self) -> tuple[str, ...]:
        return self.interface.mechanisms

    @property
    def components(self) -> tuple[str, ...]:
        return self.interface.components

    @property
    def reversal_panels(self) -> int:
        return self.inner_panels

    @property
    def reversal_nodes(self) -> int:
        return self.inner_nodes

    @property
    def rigid(self) -> RigidContact:
        """The same contact without bulk deformation."""
        return RigidContact(self.interface, self.shape)

    def refined(self, factor: int) -> ElasticContact:
        return dataclasses.replace(self, refinement=factor)

    def fresh(self) -> RingMemory:
        return self.extreme((False,) * len(self.mechanisms))

    def extreme(self, bonded: tuple[bool, ...]) -> RingMemory:
        count = len(ring_mesh(self.rings).radius) + 1
        rows = tuple(jnp.full(count, -jnp.inf if is_bonded else jnp.inf) for is_bonded in bonded)
        return RingMemory(rows, jnp.zeros(()), jnp.ones(()), jnp.zeros(count))

    def state(self, separation: jax.Array, memory: RingMemory) -> State:
        return self._measured(separation, memory, self.field(separation, memory))

    def _measured(self, separation: jax.Array, memory: RingMemory, field: Field) -> State:
        h, size = field.separation, field.size
        mesh = ring_mesh(self.rings)
        inside = self.interface.measure(h, memory.thresholds)
        outside = self.interface.measure(h[-1:], _last(memory.thresholds), lift=1)
        area = mesh.area * size**2
        around = 2.0 * pi * self.shape.radius

        def whole(inner: jax.Array, outer: jax.Array) -> jax.Array:
            return inner[..., :-1] @ area + around * outer[..., 0]

        parts = whole(inside.parts, outside.parts)
        lift = mesh.compliance @ field.pressure * size / self.modulus
        bulk = 0.5 * area @ (field.pressure * lift)
        return State(
            force=jnp.sum(parts),
            stored=whole(inside.energy, outside.energy) + bulk,
            central=separation + mesh.centre_compliance @ field.pressure * size / self.modulus,
            bonds=whole(inside.bonds, outside.bonds),
            parts=parts,
            touching=whole(inside.touching, outside.touching),
            error=field.residual,
            size=size,
            elastic=self.elastic_part(parts),
        )

    def states(self, separations: jax.Array, memory: RingMemory) -> State:
        """One after the other: each takes as many Newton steps as it needs, no more."""
        return jax.lax.map(lambda d: self.state(d, memory), separations)

    def states_near(self, separations: jax.Array, memory: RingMemory) -> State:
        """On the mesh of the reversal, from its displacement."""
        size = jnp.where(memory.size > 0.0, memory.size, _first_size(self, separations[0]))

        def near(separation: jax.Array) -> State:
            field = self._solved(separation, memory, size, memory.lift)
            return self._measured(separation, memory, field)

        return jax.lax.map(near, separations)

    def field(self, separation: jax.Array, memory: RingMemory) -> Field:
        """Solve for the rings, on a mesh that fits where ``memory`` holds none."""
        frozen = jax.lax.stop_gradient((self, separation, memory))
        size, start = jax.lax.cond(
            frozen[2].size > 0.0, lambda _, __, m: (m.size, m.lift), _search, *frozen
        )
        return self._solved(separation, memory, size, start)

    def _solved(
        self, separation: jax.Array, memory: RingMemory, size: jax.Array, lift: jax.Array
    ) -> Field:
        """Solve on a given mesh. Gradients pass by the last Newton step, with the mesh held."""
        contact, place, old, size, lift = jax.lax.stop_gradient(
            (self, separation, memory, size, lift)
        )
        held = _newton(contact, place, old.thresholds, size, lift, self.rings)
        return _polish(self, separation, memory.thresholds, size, held)

    def remember(
        self, memory: RingMemory, separation: jax.Array, size: jax.Array | None = None
    ) -> RingMemory:
        if size is None:
            field = self.field(separation, memory)
        else:
            kept = jnp.where(memory.size > 0.0, memory.size, size)
            field = self._solved(separation, memory, kept, memory.lift)
        mesh = ring_mesh(self.rings)
        matrix = mesh.compliance * field.size / self.modulus * field.slope[:-1]
        count = len(mesh.radius)
        rates = _dense_solve(jnp.eye(count) - matrix, jnp.ones((count, 1)))
        return RingMemory(
            self.interface.remember(memory.thresholds, field.separation),
            field.size,
            jnp.clip(jnp.min(rates), 1e-3, 1.0),
            field.separation
            - separation
            - self.shape.rise(field.size * np.append(mesh.radius, mesh.end)),
        )

    def bonded(self, memory: RingMemory) -> jax.Array:
        return jnp.zeros(len(self.mechanisms), bool)

    def switches(self, memory: RingMemory, separation: jax.Array, parting: jax.Array) -> jax.Array:
        """Where the slowest ring has passed from one outermost branch to the other."""
        rows = []
        for law in self.interface.hysteretic:
            width = 1.02 * (law.breaking_gap - law.forming_gap) / memory.rates
            width = jnp.where(memory.size > 0.0, width, 0.0)  # else on a branch already
            rows.append(separation + jnp.where(parting, width, -width))
        return jnp.stack(rows) if rows else jnp.zeros((0,))

    def losses(self) -> tuple[jax.Array, jax.Array]:
        return self.interface.losses()

    def floor(self, release: jax.Array, kinetic: jax.Array, weight: jax.Array) -> jax.Array:
        """The rigid contact's, less the depth at which Hertz stores the energy alone."""
        lowest = self.rigid.floor(release, kinetic, weight)
        fall = kinetic + weight * (release - lowest)
        depth = (15.0 / 8.0 * fall / (self.modulus * jnp.sqrt(self.shape.radius))) ** 0.4
        # The deeper fall through that depth feeds it once more.
        fall = fall + weight * depth
        depth = (15.0 / 8.0 * fall / (self.modulus * jnp.sqrt(self.shape.radius))) ** 0.4
        return lowest - 1.1 * depth

    def panels(self, low: jax.Array, high: jax.Array) -> jax.Array:
        return asinh_panels(low, high, self.interface.heights.rms, _PANELS * self.refinement)

    @property
    def reach(self) -> jax.Array:
        return self.rigid.reach


def _last(thresholds: Thresholds) -> Thresholds:
    return tuple(b[-1:] for b in thresholds)


def _first_size(contact: ElasticContact, separation: jax.Array) -> jax.Array:
    """Size of the mesh before anything is solved: light contact, and Hertz's radius."""
    sigma, radius = contact.interface.heights.rms, contact.shape.radius
    light = 3.0 * radius * sigma / (1.0 + jnp.maximum(separation / sigma, 0.0))
    return jnp.sqrt(light + radius * jnp.maximum(-separation, 0.0))


def _search(
    contact: ElasticContact, separation: jax.Array, memory: RingMemory
) -> tuple[jax.Array, jax.Array]:
    """Size of the mesh, and a first displacement on it, from a coarse mesh.

    The size is sqrt(3 <r^2>), the mean weighted with the pressure squared: the radius of
    a Hertz contact, and 1.7 standard deviations of a contact of Gaussian tails.
    """
    coarse, fine = ring_mesh(_COARSE), ring_mesh(contact.rings)
    branch = tuple(
        jnp.full(len(coarse.radius) + 1, jnp.where(b[0] > 0, jnp.inf, -jnp.inf))
        for b in memory.thresholds
    )
    first = _first_size(contact, separation)

    def improve(carry):  # type: ignore[no-untyped-def]
        size, lift, _, count = carry
        h = _newton(contact, separation, branch, size, lift, _COARSE)
        pressure = contact.interface.pressure(h, branch)[:-1]
        largest = jnp.max(jnp.abs(pressure))
        some = largest > 0.0
        weight = coarse.area * jnp.where(some, pressure / jnp.where(some, largest, 1.0), 1.0) ** 2
        spread = jnp.sum(weight * coarse.radius**2) / jnp.sum(weight)
        rise = contact.shape.rise(size * jnp.append(coarse.radius, coarse.end))
        ratio = jnp.where(some, jnp.clip(jnp.sqrt(3.0 * spread), 0.2, 3.0), 1.0)
        return size * ratio, h - separation - rise, jnp.abs(ratio - 1.0), count + 1

    def go_on(carry):  # type: ignore[no-untyped-def]
        return jnp.logical_and(carry[2] > 2e-3, carry[3] < _PASSES)

    flat = jnp.zeros(len(coarse.radius) + 1)
    size, lift, _, _ = jax.lax.while_loop(go_on, improve, (first, flat, jnp.inf, 0))
    where = jnp.append(coarse.radius, coarse.end)
    return size, jnp.interp(jnp.append(fine.radius, fine.end), where, lift)


def _equations(
    contact: ElasticContact,
    separation: jax.Array,
    thresholds: Thresholds,
    size: jax.Array,
    rings: int,
) -> Callable[[jax.Array], tuple[jax.Array, jax.Array, jax.Array, jax.Array]]:
    """Residual of h = d + rise + u(p(h)), pressure and its slope, as a function of h."""
    mesh = ring_mesh(rings)
    rise = contact.shape.rise(size * np.append(mesh.radius, mesh.end))
    rows = jnp.concatenate([mesh.compliance, mesh.end_compliance[None]]) * size / contact.modulus

    def pressure_at(h: jax.Array) -> jax.Array:
        return contact.interface.pressure(h, thresholds)

    def equations(h: jax.Array) -> tuple[jax.Array, jax.Array, jax.Array, jax.Array]:
        pressure, slope = jax.jvp(pressure_at, (h,), (jnp.ones_like(h),))
        return h - separation - rise - rows @ pressure[:-1], pressure, slope, rows

    return equations


def _newton(
    contact: ElasticContact,
    separation: jax.Array,
    thresholds: Thresholds,
    size: jax.Array,
    lift: jax.Array,
    rings: int,
) -> jax.Array:
    """Separations h on the rings by Newton's method, from a first displacement.

    Too small a separation is the safe side to start from: pressure falls and is convex in
    h, so that a step never leaves that side far behind.
    """
    mesh = ring_mesh(rings)
    equations = _equations(contact, separation, thresholds, size, rings)
    rise = contact.shape.rise(size * np.append(mesh.radius, mesh.end))
    sigma = contact.interface.heights.rms

    def step(carry):  # type: ignore[no-untyped-def]
        h, _, count = carry
        residual, _, slope, rows = equations(h)
        change = _solve(rows, slope, residual)
        small = 1e-13 * (sigma + jnp.abs(h))
        return h - change, jnp.max(jnp.abs(change) / small), count + 1

    def go_on(carry):  # type: ignore[no-untyped-def]
        _, change, count = carry
        return jnp.logical_and(change > 1.0, count < _ITERATIONS)

    h = separation + rise + lift
    return jax.lax.while_loop(go_on, step, (h, jnp.inf, 0))[0]


@jax.custom_batching.sequential_vmap
def _dense_solve(matrix: jax.Array, right: jax.Array) -> jax.Array:
    """Solve one dense system; a batch of them one after the other.

    Within a loop XLA's batched call is slower and makes all wait for the slowest.
    """
    return jnp.linalg.solve(matrix, right)


def _solve(rows: jax.Array, slope: jax.Array, residual: jax.Array) -> jax.Array:
    """(I - C diag(slope))^-1 residual; the mesh's end carries no pressure itself."""
    inner = slope.shape[0] - 1
    scaled = rows * slope[:-1]
    change = _dense_solve(jnp.eye(inner) - scaled[:-1], residual[:-1, None])[:, 0]
    return jnp.append(change, residual[-1] + scaled[-1] @ change)


def _polish(
    contact: ElasticContact,
    separation: jax.Array,
    thresholds: Thresholds,
    size: jax.Array,
    held: jax.Array,
) -> Field:
    """One Newton step that carries derivatives (implicit function theorem)."""
    equations = _equations(contact, separation, thresholds, size, contact.rings)
    residual, pressure, slope, rows = equations(held)
    scaled = jax.lax.stop_gradient(rows * slope[:-1])
    matrix = jnp.eye(residual.shape[0] - 1) - scaled[:-1]
    change = jax.lax.custom_linear_solve(
        lambda x: matrix @ x,
        residual[:-1],
        lambda _, right: _dense_solve(matrix, right[:, None])[:, 0],
        lambda _, right: _dense_solve(matrix.T, right[:, None])[:, 0],
    )
    change = jnp.append(change, residual[-1] + scaled[-1] @ change)
    # The step is within rounding: pressure follows it to first order.
    pressure = pressure - slope * change
    area = ring_mesh(contact.rings).area
    load = jnp.sum(area * jnp.abs(pressure[:-1]))
    off = jnp.sum(area * jnp.abs(slope * change)[:-1])
    error = jax.lax.stop_gradient(off / jnp.where(load > 0.0, load, 1.0))
    return Field(size, held - change, pressure[:-1], slope, error)
