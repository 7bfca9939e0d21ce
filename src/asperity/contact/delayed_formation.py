"""Contacts whose menisci take time to form."""

from __future__ import annotations

import dataclasses
from math import comb

import equinox as eqx

from .._jax import jax, jnp
from ..errors import InputError
from ..interface.interface import Interface
from ..interface.layers import Layers
from ..interface.rough_planes import RoughPlanes
from ..laws.law import Law, Powers, Real, Sum, TruncatedPower, quantity, terms
from .contact import Contact, Memory, State
from .resolution import Resolution
from .rough import RoughContact
from .smooth import SmoothContact

LATE = "capillary"
"""The mechanism of the bonds that take time; all others form at once."""

_HIGHEST = 1.0  # m: no asperity is higher


class PrescribedBonds(Law):
    """A law whose bonds are prescribed: they form when asked, at any gap.

    Parameters
    ----------
    law
        The law. Where a meniscus of it is missing there is no force, overlap or not.
    holds
        Whether its bonds also break only when asked (static).
    """

    law: Law
    holds: bool = eqx.field(static=True)

    @property
    def mechanism(self) -> str:  # type: ignore[override]
        return self.law.mechanism

    @property
    def counts(self) -> frozenset[str]:  # type: ignore[override]
        return self.law.counts

    @property
    def radius_power(self) -> float:  # type: ignore[override]
        return self.law.radius_power

    @property
    def hysteretic(self) -> bool:
        return True

    @property
    def only_bonded(self) -> bool:
        return self.mechanism == LATE or self.law.only_bonded

    @property
    def forming_gap(self) -> jax.Array | float:
        return -jnp.inf

    @property
    def breaking_gap(self) -> jax.Array | float:
        return jnp.inf if self.holds else self.law.breaking_gap

    @property
    def kinks(self) -> tuple[jax.Array | float, ...]:
        return self.law.kinks

    @property
    def interaction_range(self) -> jax.Array:
        return self.law.interaction_range

    @property
    def length(self) -> jax.Array | float:
        return self.law.length

    def force(self, gap: jax.Array) -> jax.Array:
        return jnp.zeros_like(gap) if self.mechanism == LATE else self.law.force(gap)

    def energy(self, gap: jax.Array) -> jax.Array:
        return jnp.zeros_like(gap) if self.mechanism == LATE else self.law.energy(gap)

    def bonded_force(self, gap: jax.Array) -> jax.Array:
        return self.law.bonded_force(gap)

    def bonded_energy(self, gap: jax.Array) -> jax.Array:
        return self.law.bonded_energy(gap)

    def response(self, gap: jax.Array, bonded: jax.Array) -> dict[str, jax.Array]:
        if self.mechanism == LATE:
            return super().response(gap, bonded)
        return self.law.response(gap, bonded)

    def powers(self, bond_gap: jax.Array) -> tuple[Powers, Powers] | None:
        bond_gap = jnp.maximum(bond_gap, -_HIGHEST)  # where there is no meniscus at all
        whole = self.law.powers(jnp.maximum(bond_gap, self.law.forming_gap))
        if whole is None:
            return None
        force, energy = (tuple(p for t in part for p in _within(t, bond_gap)) for part in whole)
        return force, energy


def _within(term: TruncatedPower, end: jax.Array) -> Powers:
    """A power of a whole exponent, cut off above the gap ``end`` [m], as a sum of powers."""
    n = int(term.exponent)
    assert n == term.exponent
    rest = jnp.maximum(term.edge - end, 0.0)
    edge = jnp.minimum(term.edge, end)
    return tuple(
        TruncatedPower(term.coefficient * comb(n, k) * rest ** (n - k), float(k), edge)
        for k in range(n + 1)
    )


class DelayedContact(eqx.Module):
    """A contact whose menisci take time to form.

    Parameters
    ----------
    contact
        The contact, a :class:`RigidContact`, an :class:`ElasticContact` or a
        :class:`SmoothContact`, with menisci that form at once.
    time
        Formation time [s], above 0.

    Notes
    -----
    Asperities higher than a threshold b have a meniscus. With the separation d of the rigid
    body, b falls towards d - g_form while it is above: db/dt = (d - g_form - b)/time. It rises
    at once to d - g_break. A smooth body is one asperity of height 0: it has a meniscus while
    b < 0. On a half-space each ring has its own b and d. All other bonds are those of
    ``contact``.
    """

    base: Contact
    laws: tuple[Law, ...]
    meniscus_index: int = eqx.field(static=True)
    time: Real = quantity()

    def __init__(self, contact: RoughContact | SmoothContact, time: Real) -> None:
        if isinstance(contact, SmoothContact):
            self.laws = tuple(law for law in terms(contact.law) if law.hysteretic)
            law = _prescribed(contact.law, smooth=True)
            self.base = dataclasses.replace(contact, law=law)
        else:
            self.laws = contact.interface.hysteretic
            planes = _base_of(contact.interface)
            self.base = dataclasses.replace(contact, interface=planes, resolved=_UNUSED)
        self.meniscus_index = contact.mechanisms.index(LATE)
        self.time = jnp.asarray(time, dtype=jnp.float64)

    @property
    def discrete(self) -> bool:
        """Whether a bond is one yes or no, as on a smooth body."""
        return isinstance(self.base, SmoothContact)

    @property
    def law(self) -> Law:
        """The law of the menisci."""
        return self.laws[self.meniscus_index]

    def state(self, separation: jax.Array, memory: Memory, threshold: jax.Array) -> State:
        """The contact at a separation [m], with a threshold [m] of the menisci.

        ``memory`` is that of the other bonds after the last reversal; of a smooth body, which
        bonds there are, of menisci too.
        """
        return self.base.state(separation, self.with_threshold(memory, threshold))

    def with_threshold(self, memory: Memory, threshold: jax.Array) -> Memory:
        """The memory of all bonds."""
        if self.discrete:
            return memory
        k = self.meniscus_index
        return (*memory[:k], threshold, *memory[k + 1 :])

    @property
    def losses(self) -> tuple[jax.Array, jax.Array]:
        """Energy [J] lost at one stroke when a bond of each law forms, and when it breaks.

        Nothing of menisci that form: :meth:`loss` tells that.
        """
        formed, broken = jnp.stack([law.losses for law in self.laws], axis=1)
        return formed.at[self.meniscus_index].set(0.0), broken

    def loss(self, gap: jax.Array) -> jax.Array:
        """Energy [J] lost when one meniscus forms at a gap [m]."""
        return -self.law.bonded_energy(gap)


_UNUSED = Resolution(panels=1, nodes=8, pieces=1)
"""No curves are made of a contact with prescribed bonds: one program serves for all of them."""


def _base_of(planes: RoughPlanes) -> RoughPlanes:
    """The planes, whose menisci form when asked."""
    if isinstance(planes, Layers):
        return Layers([_base_of(part) for part in planes.parts])
    if isinstance(planes, Interface):
        return dataclasses.replace(planes, law=_prescribed(planes.law, smooth=False))
    if LATE in planes.mechanisms:
        raise InputError(
            "`formation_time` must be absent where the bridges of each class of tip radius would "
            "need a history of their own; take model = 'equilibrium' or source = 'gaussian'",
            key="capillary.formation_time",
        )
    return planes


def _prescribed(law: Law, *, smooth: bool) -> Law:
    """The law with prescribed bonds: those of menisci, and of a smooth body all, which it holds."""
    parts = [
        PrescribedBonds(part, holds=smooth)
        if part.hysteretic and (smooth or part.mechanism == LATE)
        else part
        for part in terms(law)
    ]
    return parts[0] if len(parts) == 1 else Sum(parts)
