"""How the bulk under a contact creeps: a standard linear solid."""

from __future__ import annotations

import dataclasses
from typing import Any

import equinox as eqx

from .._jax import jax, jnp
from ..laws import Hertz
from ..laws.law import Real, quantity
from .contact import Contact, Held, Memory, Potential, ScanningCurve, State
from .delayed_formation import DelayedContact
from .elastic import ElasticContact
from .smooth import SmoothContact

VISCOUS = "viscous"
"""Mechanism of the energy that the bulk takes by its creep."""


class Relaxation(eqx.Module):
    """A half-space whose modulus relaxes, E*(t)/E* = k + (1 - k) exp(-t/time).

    Parameters
    ----------
    contact
        The contact while nothing has relaxed yet, with the instantaneous modulus: an
        :class:`ElasticContact`, or a :class:`SmoothContact` of Hertz's law.
    ratio
        Relaxed over instantaneous modulus k, in (0, 1].
    time
        Relaxation time [s]. Under a load it creeps with time/k.
    delayed
        What the menisci of rings take time by, on a bulk that does not creep.
    """

    contact: Contact
    ratio: Real = quantity()
    time: Real = quantity()
    delayed: DelayedContact | None = None

    @classmethod
    def none(cls, delayed: DelayedContact) -> Relaxation:
        """A bulk that does not creep, under menisci that take time."""
        return cls(delayed.base, 1.0, 1.0, delayed)

    def relaxed(self) -> RelaxedContact:
        """The contact after a long time, as what moves slowly meets it."""
        base = self.contact
        if isinstance(base, ElasticContact):
            return RelaxedContact(dataclasses.replace(base, modulus=self.ratio * base.modulus))
        assert isinstance(base, SmoothContact)
        assert isinstance(base.law, Hertz)
        law = dataclasses.replace(base.law, modulus=self.ratio * base.law.modulus)
        return RelaxedContact(dataclasses.replace(base, law=law))


class RelaxedContact(Contact):
    """A contact whose bulk has relaxed, with a name for what its creep takes.

    Parameters
    ----------
    base
        The contact with the relaxed modulus.

    Notes
    -----
    Creep takes nothing from what moves slowly: energy is lost in a motion alone, and booked there
    as bonds of 1 J each.
    """

    base: Contact

    @property
    def mechanisms(self) -> tuple[str, ...]:
        return (*self.base.mechanisms, VISCOUS)

    @property
    def components(self) -> tuple[str, ...]:
        return self.base.components

    @property
    def reference(self) -> jax.Array | None:
        return self.base.reference

    @property
    def error_floor(self) -> float:
        return self.base.error_floor

    @property
    def interaction_range(self) -> jax.Array:
        return self.base.interaction_range

    def refined(self, factor: int) -> RelaxedContact:
        return RelaxedContact(self.base.refined(factor))

    def initial_memory(self) -> Memory:
        return self.base.initial_memory()

    def branches(self) -> tuple[Memory, ...]:
        return self.base.branches()

    def branch_of(self, memory: Memory, unloading: jax.Array) -> jax.Array:
        return self.base.branch_of(memory, unloading)

    def state(self, separation: jax.Array, memory: Memory) -> State:
        return _with_viscous(self.base.state(separation, memory))

    def curves(self, ends: jax.Array, places: jax.Array) -> State:
        return _with_viscous(self.base.curves(ends, places))

    def scanning_curve(
        self, memory: Memory, start: jax.Array, unloading: jax.Array, within: tuple[Any, Any]
    ) -> ScanningCurve | None:
        curve = self.base.scanning_curve(memory, start, unloading, within)
        return None if curve is None else curve._replace(states=_with_viscous(curve.states))

    def update_memory(
        self, memory: Memory, separation: jax.Array, held: Held | None = None
    ) -> Memory:
        return self.base.update_memory(memory, separation, held)

    def losses(self) -> tuple[jax.Array, jax.Array]:
        formed, broken = self.base.losses()
        return jnp.append(formed, 1.0), jnp.append(broken, 0.0)

    def lower_bound(
        self, release: jax.Array, kinetic: jax.Array, potential: Potential
    ) -> jax.Array:
        return self.base.lower_bound(release, kinetic, potential)

    def panels(self, low: jax.Array, high: jax.Array) -> jax.Array:
        return self.base.panels(low, high)


def _with_viscous(state: State) -> State:
    """A state with a place for what creep has taken, which is nothing."""
    none = jnp.zeros((*state.bonds.shape[:-1], 1))
    return state._replace(bonds=jnp.concatenate([state.bonds, none], axis=-1))
