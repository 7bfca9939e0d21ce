"""How the bulk under a contact creeps: a standard linear solid."""

from __future__ import annotations

import dataclasses
from typing import Any

import equinox as eqx

from .._jax import jax, jnp
from ..laws import Hertz
from ..laws.law import Real, quantity
from .contact import Contact, Held, Memory, State, Way
from .delayed_formation import LateContact
from .elastic import ElasticContact
from .smooth import SmoothContact

VISCOUS = "viscous"
"""Mechanism of the energy that the bulk takes by its creep."""


class Creep(eqx.Module):
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
    late
        What the menisci of rings take time by, on a bulk that does not creep.
    """

    contact: Contact
    ratio: Real = quantity()
    time: Real = quantity()
    late: LateContact | None = None

    @classmethod
    def none(cls, late: LateContact) -> Creep:
        """A bulk that does not creep, under menisci that take time."""
        return cls(late.told, 1.0, 1.0, late)

    def relaxed(self) -> CreptContact:
        """The contact after a long time, as what moves slowly meets it."""
        told = self.contact
        if isinstance(told, ElasticContact):
            return CreptContact(dataclasses.replace(told, modulus=self.ratio * told.modulus))
        assert isinstance(told, SmoothContact)
        assert isinstance(told.law, Hertz)
        law = dataclasses.replace(told.law, modulus=self.ratio * told.law.modulus)
        return CreptContact(dataclasses.replace(told, law=law))


class CreptContact(Contact):
    """A contact whose bulk has relaxed, with a name for what its creep takes.

    Parameters
    ----------
    told
        The contact with the relaxed modulus.

    Notes
    -----
    Creep takes nothing from what moves slowly: energy is lost in a motion alone, and booked there
    as bonds of 1 J each.
    """

    told: Contact

    @property
    def mechanisms(self) -> tuple[str, ...]:
        return (*self.told.mechanisms, VISCOUS)

    @property
    def components(self) -> tuple[str, ...]:
        return self.told.components

    @property
    def discrete(self) -> bool:
        return self.told.discrete

    @property
    def datum(self) -> jax.Array | None:
        return self.told.datum

    @property
    def lagging(self) -> int:
        return self.told.lagging

    @property
    def blur(self) -> float:
        return self.told.blur

    @property
    def reach(self) -> jax.Array:
        return self.told.reach

    def refined(self, factor: int) -> CreptContact:
        return CreptContact(self.told.refined(factor))

    def fresh(self) -> Memory:
        return self.told.fresh()

    def extreme(self, bonded: tuple[bool, ...]) -> Memory:
        return self.told.extreme(bonded[:-1])

    def branches(self) -> tuple[Memory, ...]:
        return self.told.branches()

    def branch_of(self, memory: Memory, unloading: jax.Array) -> jax.Array:
        return self.told.branch_of(memory, unloading)

    def state(self, separation: jax.Array, memory: Memory) -> State:
        return _with_viscous(self.told.state(separation, memory))

    def branch(self, ends: jax.Array, places: jax.Array, memory: Memory) -> State:
        return _with_viscous(self.told.branch(ends, places, memory))

    def way(
        self, memory: Memory, start: jax.Array, unloading: jax.Array, within: tuple[Any, Any]
    ) -> Way | None:
        way = self.told.way(memory, start, unloading, within)
        return None if way is None else way._replace(states=_with_viscous(way.states))

    def remember(self, memory: Memory, separation: jax.Array) -> Memory:
        return self.told.remember(memory, separation)

    def turned(self, memory: Memory, separation: jax.Array, held: Held) -> Memory:
        return self.told.turned(memory, separation, held)

    def bonded(self, memory: Memory) -> jax.Array:
        return self.told.bonded(memory)

    def losses(self) -> tuple[jax.Array, jax.Array]:
        formed, broken = self.told.losses()
        return jnp.append(formed, 1.0), jnp.append(broken, 0.0)

    def floor(self, release: jax.Array, kinetic: jax.Array, weight: jax.Array) -> jax.Array:
        return self.told.floor(release, kinetic, weight)

    def panels(self, low: jax.Array, high: jax.Array) -> jax.Array:
        return self.told.panels(low, high)


def _with_viscous(state: State) -> State:
    """A state with a place for what creep has taken, which is nothing."""
    none = jnp.zeros((*state.bonds.shape[:-1], 1))
    return state._replace(bonds=jnp.concatenate([state.bonds, none], axis=-1))
