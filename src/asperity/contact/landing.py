"""Where rings come to rest that are out of equilibrium, and the mesh that fits them there."""

from __future__ import annotations

from typing import Any

import numpy as np

from .._jax import jax, jnp
from ..halfspace import ring_mesh
from ..interface.rough_planes import Memory as Thresholds
from ..numerics.krylov import dense_solve
from ..numerics.roots import fixed_point
from .elastic import ElasticContact
from .equilibrium import RingEquilibrium, asked_size, balance, profile_of, solve_equilibrium

_SETTLING = 4000  # steps of direct iteration
_SETTLED = 1e-9  # rms heights: a step of it that counts as none
_PEAKED, _RINGED = 0.8, 0.95  # <r>^2/<r^2> of attraction: pi/4 for a Gaussian peak, 1 for a ring
_CHANGE = 1.3  # of the mesh's size at a time, at most
_FIT, _PASSES = 0.05, 12  # how closely the mesh fits, and how often it is changed for it


def settle(
    contact: ElasticContact,
    place: jax.Array,
    thresholds: Thresholds,
    size: jax.Array,
    displacement: jax.Array,
) -> jax.Array:
    """Displacement [m] in which rings come to rest at a separation, from one out of equilibrium.

    Repulsion and bulk are solved for at each step and attraction is taken as it was. Every step
    lowers the energy, as rings do that approach equilibrium slowly, and the last is at the next
    minimum: the energy is a convex function less another one. Without derivatives.
    """
    safe, rms = place + profile_of(contact, size), contact.interface.scale.rms

    def step(h: jax.Array) -> tuple[jax.Array, jax.Array]:
        left, matrix = balance(contact, h, safe, thresholds, size, most=0.0)
        move = dense_solve(matrix, left)
        return h - move, jnp.max(jnp.abs(move)) / rms

    h, _ = fixed_point(step, safe + displacement, _SETTLED, _SETTLING)
    rest: jax.Array = h - safe
    return rest


def fit(
    contact: ElasticContact,
    place: jax.Array,
    thresholds: Thresholds,
    size: jax.Array,
    displacement: jax.Array,
    *,
    landing: bool = False,
) -> tuple[jax.Array, jax.Array]:
    """Size [m] of the mesh that fits rings in equilibrium, and their displacement [m].

    Rings that are ``landing`` (static) are not led back over the fold that they come from.
    """

    def again(now: tuple[jax.Array, ...]) -> tuple[tuple[jax.Array, ...], jax.Array]:
        size, ratio, displacement = now
        size, guess = size * ratio, on_other_mesh(displacement, ratio)
        if landing:
            guess = settle(contact, place, thresholds, size, guess)
        rest = solve_equilibrium(contact, place, thresholds, size, guess)
        ratio = bounded_size(rest)
        return (size, ratio, rest.displacement), jnp.abs(ratio - 1.0)

    begin: Any = size, jnp.ones(()), displacement
    (size, _, displacement), _ = fixed_point(again, begin, _FIT, _PASSES)
    return size, displacement


def bounded_size(rest: RingEquilibrium) -> jax.Array:
    """Size of the mesh that rings ask for, over the present one; it changes by a little at a time.

    As :func:`asperity.contact.equilibrium.asked_size`. Where attraction lies in a ring, as about a
    contact, the ring's radius: there the mesh is finest.
    """
    mesh = ring_mesh(len(rest.pressure))
    weight = mesh.area * jnp.minimum(rest.pressure, 0.0) ** 4
    whole = jnp.sum(weight)
    weight = weight / jnp.where(whole > 0.0, whole, 1.0)
    radius, square = weight @ mesh.radius, weight @ mesh.radius**2
    ringed = radius**2 / jnp.where(square > 0.0, square, 1.0)
    share = jnp.clip((ringed - _PEAKED) / (_RINGED - _PEAKED), 0.0, 1.0)
    asked = asked_size(rest)
    asked = asked ** (1.0 - share) * jnp.where(share > 0.0, radius, 1.0) ** share
    return jnp.clip(asked, 1.0 / _CHANGE, _CHANGE)


def on_other_mesh(displacement: jax.Array, ratio: jax.Array) -> jax.Array:
    """Displacement [m] at the rings of a mesh that is ``ratio`` times as large, about."""
    mesh = ring_mesh(len(displacement) - 1)
    radii = np.append(mesh.radius, mesh.end)
    there = ratio * radii
    inside = jnp.interp(there, radii, displacement)
    return jnp.where(there > mesh.end, displacement[-1] * mesh.end / there, inside)
