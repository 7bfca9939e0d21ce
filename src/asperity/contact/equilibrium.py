"""Equilibrium of rings: separation h = d + profile + u(p(h)) on a half-space.

Newton's method, whose linear systems are solved as far as they need be. Derivatives pass by
the implicit function theorem.
"""

from __future__ import annotations

from functools import cache
from math import pi
from typing import Any, NamedTuple

import equinox as eqx
import numpy as np

from .._jax import jax, jnp
from ..halfspace import ring_mesh
from ..interface.rough_planes import Memory as Thresholds
from ..laws.law import Real
from ..numerics.krylov import CLOSE, dense_solve, implicit_solve, nearly_solved
from ..numerics.roots import fixed_point
from ..numerics.trees import choose
from .rough import DeformingContact

_ENOUGH = 1e-13  # relative change left in the separation
_INEXACT = 10.0 * CLOSE  # rate at which a step converges whose system is solved to that
_BEYOND = 1e-6  # of the load may lie beyond the mesh
_WIDEN = 0.02  # power of that load by which the mesh grows: it may fall off as r^-50
_WIDEST = 4.0  # times the size that the pressure on the rings asks for
_RESTART = 20  # steps after which a bad first guess is given up
_STEPS = 120


class RingEquilibrium(NamedTuple):
    """Rings at rest.

    Attributes
    ----------
    displacement
        Displacement u of the rings and of the mesh's end [m], shape (rings + 1,).
    pressure
        Pressure on the rings [Pa], approximately.
    error
        Estimated relative error of the force.
    """

    displacement: jax.Array
    pressure: jax.Array
    error: jax.Array


class _Step(NamedTuple):
    h: jax.Array
    pressure: jax.Array
    change: jax.Array
    rate: jax.Array
    off: jax.Array
    steps: jax.Array

    @property
    def enough(self) -> jax.Array:
        """Whether what the next step would change is small enough."""
        return self.change * jnp.minimum(self.rate, 1.0) < _ENOUGH


def profile_of(contact: DeformingContact, size: Real) -> jax.Array:
    """Profile of the body at the rings and at the mesh's end [m]."""
    mesh = ring_mesh(contact.rings)
    return contact.shape.profile(size * np.append(mesh.radius, mesh.end))


@cache
def compliance(rings: int) -> np.ndarray:
    """Displacement at the rings and at the end per pressure at them, times E* over the size.

    The end neither carries any nor gives way: what lies beyond stands for itself, so that the
    force is the slope of the energy wherever the mesh may end.
    """
    return np.pad(ring_mesh(rings).compliance, (0, 1))


def _displacement(contact: DeformingContact, size: jax.Array, pressure: jax.Array) -> jax.Array:
    """Displacement [m] of the rings and of the end under a pressure [Pa] on them."""
    return size / contact.modulus * (compliance(contact.rings) @ pressure)


def pressed(
    contact: DeformingContact, thresholds: Thresholds, h: jax.Array
) -> tuple[jax.Array, jax.Array]:
    """Pressure and its slope at separations h [m]."""

    def pressure(h: jax.Array) -> jax.Array:
        return contact.interface.pressure(h, thresholds)

    return jax.jvp(pressure, (h,), (jnp.ones_like(h),))


def solve_equilibrium(
    contact: DeformingContact,
    separation: jax.Array,
    thresholds: Thresholds,
    size: jax.Array,
    displacement: jax.Array,
) -> RingEquilibrium:
    """Rings in equilibrium at a rigid separation, from a first guess of their ``displacement``.

    Without derivatives; :func:`equilibrium_displacement` gives them. Too small a separation is
    the safe side to start from: pressure falls and is convex in h, so that a step never leaves
    that side far behind. A guess that does not converge is given up for that side.
    """
    safe = separation + profile_of(contact, size)
    area = np.append(ring_mesh(contact.rings).area, 0.0)
    rms = contact.interface.scale.rms
    one = jnp.ones(())
    guess = _Step(
        safe + displacement, jnp.zeros_like(safe), one, one, jnp.zeros(()), jnp.asarray(0)
    )

    def step(now: _Step) -> tuple[_Step, jax.Array]:
        pressure, slope = pressed(contact, thresholds, now.h)
        right = now.h - safe - _displacement(contact, size, pressure)
        move = nearly_solved(compliance(contact.rings), size / contact.modulus * slope, right)
        change = jnp.max(jnp.abs(move) / (rms + jnp.abs(now.h)))
        rate = jnp.maximum(change / now.change, _INEXACT)
        load = jnp.sum(area * jnp.abs(pressure))
        off = jnp.minimum(rate, 1.0) * jnp.sum(area * jnp.abs(slope * move))
        off = off / jnp.where(load > 0.0, load, 1.0)
        after = _Step(now.h - move, pressure, change, rate, off, now.steps + 1)
        lost = (after.steps == _RESTART) & ~after.enough
        begun = _Step(safe, pressure, one, one, off, after.steps)
        after = choose(lost, begun, after)
        return after, jnp.where(after.enough, 0.0, 1.0)

    end, _ = fixed_point(step, guess, 0.0, _STEPS)
    return RingEquilibrium(end.h - safe, end.pressure[:-1], end.off)


def rates(
    contact: DeformingContact,
    separation: jax.Array,
    thresholds: Thresholds,
    size: jax.Array,
    displacement: jax.Array,
) -> jax.Array:
    """Rate of the separation of rings that have settled per rigid separation, approximately."""
    h = separation + profile_of(contact, size) + displacement
    slope = pressed(contact, thresholds, h)[1]
    return dense_solve(_matrix(contact, size, slope), jnp.ones_like(h))


def _matrix(contact: DeformingContact, size: jax.Array, slope: jax.Array) -> jax.Array:
    """Change of what a separation leaves over, per change of the separation."""
    return jnp.eye(len(slope)) - compliance(contact.rings) * (size / contact.modulus * slope)


@eqx.filter_custom_jvp
def equilibrium_displacement(
    contact: DeformingContact,
    separation: jax.Array,
    thresholds: Thresholds,
    size: jax.Array,
    displacement: jax.Array,
) -> jax.Array:
    """The ``displacement`` [m] of rings in equilibrium, with its derivatives.

    With respect to contact, separation and thresholds, on a mesh that is held.
    """
    return displacement


@equilibrium_displacement.def_jvp
def _resting_jvp(primals: Any, tangents: Any) -> tuple[jax.Array, jax.Array]:
    contact, separation, thresholds, size, displacement = primals
    h = separation + profile_of(contact, size) + displacement
    _, slope = pressed(contact, thresholds, h)
    matrix = _matrix(contact, size, slope)

    def pushed(
        contact: DeformingContact, separation: jax.Array, thresholds: Thresholds
    ) -> jax.Array:
        held = separation + profile_of(contact, size) + displacement
        pressure = contact.interface.pressure(held, thresholds)
        return _displacement(contact, size, pressure)

    _, push = eqx.filter_jvp(pushed, primals[:3], tangents[:3])
    return displacement, implicit_solve(matrix, push)


def balance(
    contact: DeformingContact,
    h: jax.Array,
    safe: jax.Array,
    thresholds: Thresholds,
    size: jax.Array,
    most: float | None = None,
) -> tuple[jax.Array, jax.Array]:
    """By how much a separation h exceeds the undeformed one and the displacement [m].

    And its derivative by h; with slopes of the pressure up to ``most`` alone.
    """
    pressure, slope = pressed(contact, thresholds, h)
    left = h - safe - _displacement(contact, size, pressure)
    slope = slope if most is None else jnp.minimum(slope, most)
    return left, _matrix(contact, size, slope)


def asked_size(rest: RingEquilibrium, beyond: jax.Array | float = 0.0) -> jax.Array:
    """Size of the mesh that a pressure asks for, sqrt(2.5 <r^2>), over the present one.

    The mean is weighted with the pressure's magnitude: the radius of a Hertz contact, and
    1.6 standard deviations of a contact of Gaussian tails. More where more of the load than a
    millionth lies ``beyond`` the mesh (over the size squared [Pa]), as of liquid about a small
    contact, but never more than four times as much.
    """
    mesh = ring_mesh(len(rest.pressure))
    weight = mesh.area * jnp.abs(rest.pressure)
    load = jnp.sum(weight)
    some = load > 0.0
    load = jnp.where(some, load, 1.0)
    ratio = jnp.sqrt(2.5 * (weight @ mesh.radius**2) / load)
    wider = (beyond / (load + beyond) / _BEYOND) ** _WIDEN
    ratio = jnp.maximum(ratio, jnp.minimum(wider, _WIDEST * ratio))
    return jnp.where(some, jnp.clip(ratio, 0.2, 3.0), 1.0)


def beyond(contact: DeformingContact, size: jax.Array, end: jax.Array) -> jax.Array:
    """Load of bonds beyond the mesh where its end is at separation ``end``, over size^2 [Pa].

    Of all that can hold there: a mesh is kept while a body parts.
    """
    torn, fresh = contact.interface.saturated_memory(end), contact.interface.initial_memory(end)
    force = contact.interface.pressure(end, torn, integrated=1)
    force = force - contact.interface.pressure(end, fresh, integrated=1)
    return 2.0 * pi * contact.shape.radius * jnp.abs(force) / size**2
