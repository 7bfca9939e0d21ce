"""The publication's conjunction: a rigid sphere over pressures that end at an edge."""

from __future__ import annotations

from math import pi

import numpy as np
from numpy.polynomial import chebyshev

from .._jax import jax, jnp
from ..laws.law import Real, quantity
from ..laws.published_pressures import PublishedPressure
from ..numerics.polynomials import from_points, points_between
from .contact import Contact, Held, Potential, State
from .profile import Sphere
from .scanning_curve import first_out_of_reach

_NODES, _WEIGHTS = (np.asarray(a) for a in np.polynomial.legendre.leggauss(16))
_LADDER = 1.0 - 2.0 ** np.arange(-14.0, 21.0)  # of the edge: each depth twice the one before
_FEW, _FEW_WEIGHTS = (np.asarray(a) for a in np.polynomial.legendre.leggauss(3))
_DOUBT = 1e-2  # of a pull that is bounded, not computed


def _integrals_from(nodes: int) -> tuple[np.ndarray, np.ndarray]:
    """Matrices from values at Chebyshev points of [-1, 1] to integrals from a place to 1.

    Of the values, and of them times the distance from the place; the places are the points
    and, in the last row, -1.
    """
    points = np.append(chebyshev.chebpts1(nodes), -1.0)
    coefficients = from_points(nodes)
    once = chebyshev.chebint(coefficients, axis=0)
    twice = chebyshev.chebint(once, axis=0)
    at_1, at_end = (chebyshev.chebval(1.0, each) for each in (once, twice))
    plain = at_1 - chebyshev.chebval(points, once).T
    far = chebyshev.chebval(points, twice).T
    return plain, at_1 * (1.0 - points)[:, None] - (at_end - far)


class PublishedContact(Contact):
    """A rough sphere by the publication's equations, without bulk deformation.

    Parameters
    ----------
    pressure
        The mean pressures.
    shape
        The body.
    retraction_only
        1 where adhesion and menisci pull only while the bodies part: what the published
        decrements say, and no law that a bond could follow. 0 where they always pull.
    resolved
        Panels of the curves between two non-smooth points of the pressures (static).

    Notes
    -----
    With ``retraction_only`` the way out takes from the body what the pull does over it. It is
    booked like bonds that break: :attr:`State.bonds` holds the work [J] that each pull would
    still do from here to the edge, a joule of it is lost for each joule that goes, and
    nothing when it comes back on the way in. The memory is whether the bodies part.
    """

    pressure: PublishedPressure
    shape: Sphere
    retraction_only: Real = quantity(1.0)

    @property
    def mechanisms(self) -> tuple[str, ...]:
        return ("adhesion", "capillary")

    @property
    def components(self) -> tuple[str, ...]:
        return ("elastic", *self.mechanisms)

    def branches(self) -> tuple[jax.Array, ...]:
        return jnp.zeros(()), jnp.ones(())

    def state(self, separation: jax.Array, memory: jax.Array) -> State:
        """The contact at a rigid separation; ``memory`` is 1 where the bodies part, 0 else."""
        return self._state(separation, memory, *self._integrals(separation))

    def _state(
        self, separation: jax.Array, memory: jax.Array, force: jax.Array, energy: jax.Array
    ) -> State:
        """From the integrals of each pressure, asperities that touch last."""
        lost = self.retraction_only
        pull = force[1:3]
        parts = jnp.concatenate([force[:1], -(1.0 - lost * (1.0 - memory)) * pull])
        stored = energy[0] - (1.0 - lost) * jnp.sum(energy[1:3])
        forces, bonds = (self.components, parts), lost * energy[1:3]
        return State.undeformed(separation, forces, stored, bonds, contacting=force[3])

    def curves(self, ends: jax.Array, places: jax.Array) -> State:
        """Both branches from the same integrals: those of a panel, and of all beyond it."""
        plain, far = _integrals_from(places.shape[1])
        # One panel more, from where these end to where the conjunction does.
        marks = jnp.append(ends, jnp.maximum(self.pressure.end, ends[-1]))
        width = jnp.diff(marks)
        points = points_between(places.shape[1])
        nodes = jnp.concatenate([places, (marks[-2] + width[-1] * points)[None]])
        values = 2.0 * pi * self.shape.radius * self._pressures(nodes)
        half = (0.5 * width)[None, :, None]
        force = half * jnp.einsum("kn,cpn->cpk", plain, values)
        energy = half**2 * jnp.einsum("kn,cpn->cpk", far, values)
        beyond = _beyond(force[..., -1])
        # What acts beyond a panel does its work over the way to there.
        energy_beyond = _beyond(energy[..., -1] + beyond * width)
        distance = (marks[1:, None] - nodes)[None]
        energy = energy[..., :-1] + beyond[..., None] * distance + energy_beyond[..., None]
        force = force[..., :-1] + beyond[..., None]
        force, energy = force[:, :-1], energy[:, :-1]
        at_place = jax.vmap(jax.vmap(self._state, (0, None, 1, 1)), (0, None, 1, 1))
        return jax.vmap(lambda memory: at_place(places, memory, force, energy))(
            jnp.stack(self.branches())
        )

    def _pressures(self, places: jax.Array) -> jax.Array:
        """The pressures [Pa], and asperities that touch [1/m^2], along a new first axis."""
        p = self.pressure
        return jnp.stack(
            [p.contact(places), p.adhesion(places), p.capillary(places), p.touching(places)]
        )

    def _integrals(self, separation: jax.Array) -> tuple[jax.Array, jax.Array]:
        """Force [N] and energy [J] of each pressure from here to the edge; contacts last."""
        p = self.pressure
        start = jnp.minimum(separation, p.end)
        marks = jnp.sort(jnp.clip(jnp.stack([start, *p.kinks, p.end]), start, p.end))
        half = 0.5 * jnp.diff(marks)[:, None]
        places = (marks[:-1, None] + half * (_NODES + 1.0)).ravel()
        weights = 2.0 * pi * self.shape.radius * (half * _WEIGHTS).ravel()
        values = self._pressures(places)
        return values @ weights, values @ (weights * (places - start))

    def update_memory(
        self, memory: jax.Array, separation: jax.Array, held: Held | None = None
    ) -> jax.Array:
        return memory if held is None else jnp.where(held.unloading, 0.0, 1.0)

    def losses(self) -> tuple[jax.Array, jax.Array]:
        """A joule of work undone costs nothing, a joule done is lost."""
        return jnp.zeros(len(self.mechanisms)), jnp.ones(len(self.mechanisms))

    def lower_bound(
        self, release: jax.Array, kinetic: jax.Array, potential: Potential
    ) -> jax.Array:
        p = self.pressure
        ladder = jnp.asarray(_LADDER) * p.end
        width = p.end * -np.diff(_LADDER, prepend=1.0)[:, None]
        places = ladder[:, None] + 0.5 * width * (_FEW + 1.0)
        weights = pi * self.shape.radius * width * _FEW_WEIGHTS
        # More than all menisci pull in full; less than the energy is stored, then.
        pull = (1.0 - self.retraction_only) * (1.0 + _DOUBT) * p.strongest_pull(places)
        pressure = p.contact(places) - pull
        steps = jnp.sum(weights * pressure, axis=1)
        force = jnp.cumsum(steps) - steps
        own = jnp.sum(weights * pressure * (places - ladder[:, None]), axis=1)
        stored = jnp.cumsum(own + force * width[:, 0])
        # Three separations between two steps of the search give the energy to 1e-4.
        level = potential(release) + kinetic
        level = level + 1e-3 * jnp.abs(level)
        return first_out_of_reach(stored + potential(ladder), level, ladder, release)

    def panels(self, low: jax.Array, high: jax.Array) -> jax.Array:
        marks = jnp.stack([low, *self.pressure.kinks, self.pressure.end])
        marks = jnp.sort(jnp.clip(marks, low, high))
        steps = np.arange(self.resolved.panels) / self.resolved.panels
        near = (marks[:-1, None] + jnp.diff(marks)[:, None] * steps).ravel()
        return jnp.concatenate([near, jnp.stack([marks[-1], high])])

    @property
    def interaction_range(self) -> jax.Array:
        return self.pressure.end


def _beyond(panels: jax.Array) -> jax.Array:
    """The sum over all panels beyond each, along the last axis."""
    return jnp.cumsum(panels[..., ::-1], axis=-1)[..., ::-1] - panels
