"""What a force law is: two branches with an energy each, and the gaps between them."""

from __future__ import annotations

import abc
from collections.abc import Iterable, Sequence
from typing import Any, ClassVar, NamedTuple

import equinox as eqx
import numpy as np

from .._jax import jax, jnp
from ..errors import InputError

Real = Any
"""A float or an array given, a float64 array kept: what a converted field is to a type checker."""


def quantity(default: float | None = None) -> Any:
    """A physical value of a module, kept as a float64 array: traced, never static."""
    if default is None:
        return eqx.field(converter=as_float64)
    return eqx.field(converter=as_float64, default=default)


def quantity_or_none() -> Any:
    """The same where it may be absent, as it is by default."""
    return eqx.field(
        converter=lambda value: None if value is None else as_float64(value), default=None
    )


def as_float64(value: Any) -> jax.Array:
    """A float64 array of a number or an array."""
    if isinstance(value, int | float | np.ndarray):
        value = np.asarray(value, np.float64)  # JAX would compile the conversion
    return jnp.asarray(value, dtype=jnp.float64)


class TruncatedPower(NamedTuple):
    """``coefficient * max(edge - gap, 0)**exponent``: a term of a force or an energy."""

    coefficient: jax.Array | float
    exponent: float
    edge: jax.Array | float

    def __call__(self, gap: jax.Array) -> jax.Array:
        """Value at a gap [m], any shape; a power of 0 is the step that is 1 inside."""
        overlap = jnp.maximum(self.edge - gap, 0.0)
        inside = overlap > 0.0
        power = jnp.where(inside, overlap, 1.0) ** self.exponent
        return self.coefficient * jnp.where(inside, power, 0.0)


Powers = tuple[TruncatedPower, ...]


class Law(eqx.Module):
    """Force of one asperity or one smooth body on a plane, free or bonded.

    A law has a *free* and a *bonded* branch, each with an energy: force = -d(energy)/d(gap),
    and the free energy tends to 0 far away. A bond forms when the gap falls to
    ``forming_gap`` and breaks when it grows to ``breaking_gap``; both steps lose energy.
    A conservative law has the free branch alone.

    Gap [m]: distance between the undeformed asperity and the plane, negative when they
    overlap. Force [N]: positive when it pushes apart. Energy [J]. Arrays of any shape;
    everything works under ``jit``, ``vmap`` and ``grad``.
    """

    mechanism: ClassVar[str] = "adhesion"
    """The name under which its losses are booked, and its force shown."""

    counts: ClassVar[frozenset[str]] = frozenset()
    """The forces it contains ("elastic", "adhesion", "capillary"): no two laws of a sum
    may contain the same one."""

    radius_power: ClassVar[float] = 0.0
    """At equal gaps it grows with this power of the tip radius: 0, 0.5 or 1; 0 also where with
    none, so that asperities of different radii need a law each."""

    @abc.abstractmethod
    def force(self, gap: jax.Array) -> jax.Array:
        """Force of the free branch [N]."""

    @abc.abstractmethod
    def energy(self, gap: jax.Array) -> jax.Array:
        """Energy of the free branch [J], 0 far away."""

    def bonded_force(self, gap: jax.Array) -> jax.Array:
        """Force of the bonded branch [N]; a conservative law has none of its own."""
        return self.force(gap)

    def bonded_energy(self, gap: jax.Array) -> jax.Array:
        """Energy of the bonded branch [J]."""
        return self.energy(gap)

    @property
    def hysteretic(self) -> bool:
        """Whether it has a bonded branch of its own. Known without values."""
        return False

    @property
    def forming_gap(self) -> jax.Array | float:
        """Gap [m] at which a bond forms on approach."""
        return 0.0

    @property
    def breaking_gap(self) -> jax.Array | float:
        """Gap [m] at which a bond breaks on unloading, not below ``forming_gap``."""
        return self.forming_gap

    @property
    def kinks(self) -> tuple[jax.Array | float, ...]:
        """Gaps [m] at which a branch or its slope is not smooth."""
        return (0.0,)

    @property
    def interaction_range(self) -> jax.Array:
        """Gap [m] beyond which the force is below 1e-6 of its largest pull."""
        return self.last_kink

    @property
    def last_kink(self) -> jax.Array:
        """The largest of the kinks [m], or 0."""
        ends = [jnp.asarray(gap, dtype=jnp.float64) for gap in self.kinks]
        return jnp.max(jnp.maximum(jnp.stack([*ends, jnp.zeros(())]), 0.0))

    @property
    def length(self) -> jax.Array | float:
        """The shortest length [m] on which the force changes, away from its kinks."""
        return jnp.inf

    def powers(self, bond_gap: jax.Array) -> tuple[Powers, Powers] | None:
        """Force and energy as truncated powers where every gap below ``bond_gap`` is bonded.

        None where the law has no such form; then its mean over heights is a quadrature.
        """
        return None

    def energy_beyond(self, gap: jax.Array) -> jax.Array | None:
        """Integral of the free energy over all gaps beyond one [J m]; None where by quadrature.

        An energy that falls like 1/gap has none: it is cut at a gap fixed by the law, which
        shifts the zero of energy of a rough body and nothing else.
        """
        return None

    @property
    def only_bonded(self) -> bool:
        """Whether its free branch is nothing at all. Known without values."""
        return False

    def response(self, gap: jax.Array, bonded: jax.Array) -> dict[str, jax.Array]:
        """All of a law at once, on the branch that holds: both share most of their work.

        The force [N] by mechanism, under the names of :attr:`counts` (or else
        :attr:`mechanism`), and the energy [J] as "energy".
        """
        force, energy = self.force(gap), self.energy(gap)
        if self.hysteretic:
            force = jnp.where(bonded, self.bonded_force(gap), force)
            energy = jnp.where(bonded, self.bonded_energy(gap), energy)
        return {self.mechanism: force, "energy": energy}

    @property
    def losses(self) -> jax.Array:
        """Energy [J] lost when one bond forms, and when it breaks."""
        ends = [jnp.asarray(gap, float) for gap in (self.forming_gap, self.breaking_gap)]
        gaps = jnp.stack(jnp.broadcast_arrays(*ends))
        drop = jax.vmap(lambda gap: self.energy(gap) - self.bonded_energy(gap))(gaps)
        return jnp.stack([drop[0], -drop[1]])

    @property
    def formation_loss(self) -> jax.Array:
        """Energy [J] lost when one bond forms."""
        return self.losses[0]

    @property
    def rupture_loss(self) -> jax.Array:
        """Energy [J] lost when one bond breaks."""
        return self.losses[1]

    def __add__(self, other: Law) -> Sum:
        return Sum((*terms(self), *terms(other)))


class OnlyBonded(Law):
    """A law whose free branch is nothing at all: what its forces are, it is by its bond."""

    @abc.abstractmethod
    def bonded_response(self, gap: jax.Array) -> dict[str, jax.Array]:
        """The bonded branch at a gap, as :meth:`response`."""

    @property
    def hysteretic(self) -> bool:
        return True

    @property
    def only_bonded(self) -> bool:
        return True

    def force(self, gap: jax.Array) -> jax.Array:
        return jnp.zeros_like(gap)

    def energy(self, gap: jax.Array) -> jax.Array:
        return jnp.zeros_like(gap)

    def bonded_force(self, gap: jax.Array) -> jax.Array:
        parts = self.bonded_response(gap)
        return sum((parts[name] for name in sorted(self.counts)), jnp.zeros_like(gap))

    def bonded_energy(self, gap: jax.Array) -> jax.Array:
        return self.bonded_response(gap)["energy"]

    def response(self, gap: jax.Array, bonded: jax.Array) -> dict[str, jax.Array]:
        held = self.bonded_response(gap)
        return {name: jnp.where(bonded, value, 0.0) for name, value in held.items()}


class Sum(Law):
    """Laws that act side by side on the same asperity.

    Raises
    ------
    InputError
        If two of them contain the same force.
    """

    parts: tuple[Law, ...]

    def __init__(self, parts: Sequence[Law]) -> None:
        refuse_twice(laws=parts)
        self.parts = tuple(parts)

    def force(self, gap: jax.Array) -> jax.Array:
        return sum((law.force(gap) for law in self.parts), jnp.zeros_like(gap))

    def energy(self, gap: jax.Array) -> jax.Array:
        return sum((law.energy(gap) for law in self.parts), jnp.zeros_like(gap))


def terms(law: Law) -> tuple[Law, ...]:
    """The laws of a sum; a law alone is a sum of one."""
    return law.parts if isinstance(law, Sum) else (law,)


def components_of(laws: Sequence[Law], more: Iterable[str] = ()) -> tuple[str, ...]:
    """Mechanisms of the forces of laws, and ``more``: elastic first."""
    names = {name for law in laws for name in law.counts or {law.mechanism}}
    return tuple(sorted(names.union(more), key=lambda name: (name != "elastic", name)))


def refuse_twice(*contacts: tuple[Any, Iterable[str]], laws: Sequence[Law]) -> None:
    """Refuse laws that act side by side, and beside contacts, if two contain the same force.

    Each contact comes with the names of its forces.

    Raises
    ------
    InputError
        With the two, and the force.
    """
    seen: dict[str, str] = {}
    for part, names in (*contacts, *((law, law.counts) for law in laws)):
        for name in sorted(names):
            if name in seen:
                raise InputError(
                    f"{type(part).__name__} and {seen[name]} both contain the {name} force; "
                    "it would count twice"
                )
            seen[name] = type(part).__name__
