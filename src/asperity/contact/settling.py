"""Equilibrium of rings: separation h = d + rise + u(p(h)) on a half-space.

Newton's method that keeps its matrix as long as it gains a digit with it: a solution next to
a known one then costs one factorization, or none where the bulk hardly gives way and the matrix
of the known one serves. Derivatives pass by the implicit function theorem.
"""

from __future__ import annotations

from typing import Any, NamedTuple, Protocol

import equinox as eqx
import numpy as np
from equinox.internal import unvmap_any

from .._jax import jax, jnp
from ..halfspace import ring_mesh
from ..interface import Memory as Thresholds
from ..layers import Surfaces
from ..shapes import Sphere
from .factors import SOFT, Matrix, dense_solve

_ENOUGH = 1e-12  # relative change left in the separation
_STALE = 0.1  # a matrix that gains less than this factor a step is made anew
_RESTART = 20  # steps after which a bad first guess is given up
_STEPS = 120


class Rough(Protocol):
    """What rings are pressed by."""

    interface: Surfaces
    shape: Sphere
    modulus: Any


class Rest(NamedTuple):
    """Rings at rest.

    Attributes
    ----------
    lift
        Displacement u of the rings and of the mesh's end [m], shape (rings + 1,).
    rates
        Rate of their separation per rigid separation, approximately.
    pressure
        Pressure on the rings [Pa], approximately.
    error
        Estimated relative error of the force.
    """

    lift: jax.Array
    rates: jax.Array
    pressure: jax.Array
    error: jax.Array


class _Step(NamedTuple):
    h: jax.Array
    pressure: jax.Array
    change: jax.Array
    rate: jax.Array
    off: jax.Array
    steps: jax.Array
    serves: jax.Array

    @property
    def enough(self) -> jax.Array:
        """Whether what the next step would change is small enough."""
        return self.change * jnp.minimum(self.rate, 1.0) < _ENOUGH


def rise_of(contact: Rough, size: jax.Array, rings: int) -> jax.Array:
    """Rise of the body's surface at the rings and at the mesh's end [m]."""
    mesh = ring_mesh(rings)
    return contact.shape.rise(size * np.append(mesh.radius, mesh.end))


def _rows(contact: Rough, size: jax.Array, rings: int) -> jax.Array:
    """Displacement at the rings and at the end per pressure at each ring."""
    mesh = ring_mesh(rings)
    rows = np.concatenate([mesh.compliance, mesh.end_compliance[None]])
    return rows * (size / contact.modulus)


def _pressed(contact: Rough, thresholds: Thresholds, h: jax.Array) -> tuple[jax.Array, jax.Array]:
    """Pressure and its slope at separations h [m]."""

    def pressure(h: jax.Array) -> jax.Array:
        return contact.interface.pressure(h, thresholds)

    return jax.jvp(pressure, (h,), (jnp.ones_like(h),))


def settle(
    contact: Rough,
    separation: jax.Array,
    thresholds: Thresholds,
    size: jax.Array,
    lift: jax.Array,
    rings: int,
) -> Rest:
    """Rings in equilibrium at a rigid separation, from a first guess of their ``lift``.

    Without derivatives; :func:`resting` gives them.
    """
    return settle_near(contact, separation, thresholds, size, lift, Matrix.blank(rings))[0]


def settle_near(
    contact: Rough,
    separation: jax.Array,
    thresholds: Thresholds,
    size: jax.Array,
    lift: jax.Array,
    matrix: Matrix,
) -> tuple[Rest, Matrix]:
    """The same near a known solution, from its ``matrix``; and the matrix of this one.

    Too small a separation is the safe side to start from: pressure falls and is convex in
    h, so that a step never leaves that side far behind. A guess that does not converge is
    given up for that side.
    """
    rings = len(matrix.slope)
    safe = separation + rise_of(contact, size, rings)
    newton = _Newton(contact, thresholds, safe, _rows(contact, size, rings))
    one = jnp.ones(())
    # With the matrix of a known solution where it serves; two steps then show how well.
    guess = _Step(
        safe + lift, jnp.zeros(rings), one, one, jnp.zeros(()), jnp.asarray(0), matrix.serves
    )

    def go_on(carry: tuple[_Step, Matrix]) -> jax.Array:
        now, _ = carry
        return jnp.logical_not(now.enough) & (now.steps < _STEPS)

    end, matrix = jax.lax.while_loop(go_on, lambda carry: newton.step(*carry), (guess, matrix))
    return Rest(end.h - safe, matrix.rates, end.pressure, end.off), matrix


class _Newton(NamedTuple):
    """The rings at one place: separations from ``safe`` on, and displacement per pressure."""

    contact: Rough
    thresholds: Thresholds
    safe: jax.Array
    rows: jax.Array

    def pressure(self, h: jax.Array) -> jax.Array:
        return self.contact.interface.pressure(h, self.thresholds)

    def step(self, now: _Step, matrix: Matrix) -> tuple[_Step, Matrix]:
        """One step, with the matrix at hand while it serves, else with a new one."""

        def renewed() -> Matrix:
            pairs = zip(matrix, self.matrix(now.h), strict=True)
            return Matrix(*(jnp.where(now.serves, old, new) for old, new in pairs))

        # In a batch none is made where all serve.
        matrix = jax.lax.cond(unvmap_any(~now.serves), renewed, lambda: matrix)
        area = ring_mesh(len(matrix.slope)).area
        pressure = self.pressure(now.h)
        move = matrix.back(now.h - self.safe - self.rows @ pressure[:-1])
        change = jnp.max(jnp.abs(move) / (self.contact.interface.heights.rms + jnp.abs(now.h)))
        rate = change / now.change
        load = jnp.sum(area * jnp.abs(pressure[:-1]))
        off = jnp.sum(area * jnp.abs(matrix.slope * move[:-1]))
        off = jnp.minimum(rate, 1.0) * off / jnp.where(load > 0.0, load, 1.0)
        rate = jnp.where(now.serves & (now.steps == 0), jnp.maximum(rate, SOFT), rate)
        steps = now.steps + 1
        after = _Step(now.h - move, pressure[:-1], change, rate, off, steps, rate < _STALE)
        lost = (steps > _RESTART) & (steps < 2 * _RESTART) & ~after.enough & ~after.serves
        one = jnp.ones(())
        begun = _Step(self.safe, pressure[:-1], one, one, off, jnp.asarray(2 * _RESTART), ~lost)
        after = jax.tree_util.tree_map(lambda a, b: jnp.where(lost, a, b), begun, after)
        return after, matrix

    def matrix(self, h: jax.Array) -> Matrix:
        """The matrix at separations h."""
        return Matrix.of(self.rows, _pressed(self.contact, self.thresholds, h)[1][:-1])


@eqx.filter_custom_jvp
def resting(
    contact: Rough,
    separation: jax.Array,
    thresholds: Thresholds,
    size: jax.Array,
    lift: jax.Array,
    *,
    rings: int,
) -> jax.Array:
    """The displacement ``lift`` of rings that have settled, with its derivatives.

    With respect to contact, separation and thresholds, on a mesh that is held.
    """
    return lift


@resting.def_jvp
def _resting_jvp(primals: Any, tangents: Any, *, rings: int) -> tuple[jax.Array, jax.Array]:
    contact, separation, thresholds, size, lift = primals
    h = separation + rise_of(contact, size, rings) + lift
    _, slope = _pressed(contact, thresholds, h)
    rows = _rows(contact, size, rings)
    matrix = jnp.eye(len(slope) - 1) - rows[:-1] * slope[:-1]

    def pushed(contact: Rough, separation: jax.Array, thresholds: Thresholds) -> jax.Array:
        held = separation + rise_of(contact, size, rings) + lift
        pressure = contact.interface.pressure(held, thresholds)
        return _rows(contact, size, rings) @ pressure[:-1]

    _, push = eqx.filter_jvp(pushed, primals[:3], tangents[:3])
    inner = jax.lax.custom_linear_solve(
        lambda x: matrix @ x,
        push[:-1],
        lambda _, right: dense_solve(matrix, right),
        lambda _, right: dense_solve(matrix.T, right),
    )
    return lift, jnp.append(inner, push[-1] + (rows[-1] * slope[:-1]) @ inner)


def asked_size(rest: Rest, rings: int) -> jax.Array:
    """Size of the mesh that a pressure asks for, sqrt(2.5 <r^2>), over the present one.

    The mean is weighted with the pressure's magnitude: the radius of a Hertz contact, and
    1.6 standard deviations of a contact of Gaussian tails.
    """
    mesh = ring_mesh(rings)
    weight = mesh.area * jnp.abs(rest.pressure)
    total = jnp.sum(weight)
    some = total > 0.0
    ratio = jnp.sqrt(2.5 * (weight @ mesh.radius**2) / jnp.where(some, total, 1.0))
    return jnp.where(some, jnp.clip(ratio, 0.2, 3.0), 1.0)
