"""What the equation of motion asks of a contact."""

from __future__ import annotations

import abc
import dataclasses
from collections.abc import Callable
from typing import Any, NamedTuple

import equinox as eqx

from .._jax import jax, jnp
from ..numerics.compilation import AT_ONCE, Program
from .resolution import Resolution

Memory = Any
"""A pytree that a contact alone understands: its bonds after the last reversal."""

Potential = Callable[[jax.Array], jax.Array]
"""Potential energy [J] of a body at a separation [m] under what acts on it besides the contact."""


class State(NamedTuple):
    """A contact at one rigid separation.

    Attributes
    ----------
    force
        Total force [N], positive apart.
    stored
        Recoverable energy [J].
    central
        Separation of the deformed mean planes at the axis [m].
    bonds
        Number of bonds per hysteretic law, shape (laws,).
    parts
        The force by mechanism [N], in the order of :attr:`Contact.components`.
    contacting
        Expected number of asperities in contact.
    error
        Estimated relative error of the force: 1e-16 where it is a closed form.
    size
        Length [m] on which the contact is resolved in the plane; 0 where it needs none.
    elastic
        The elastic part of the force [N].
    field
        What a contact that deforms needs to remember its bonds by; empty where it does not.
    """

    force: jax.Array
    stored: jax.Array
    central: jax.Array
    bonds: jax.Array
    parts: jax.Array
    contacting: jax.Array
    error: jax.Array
    size: jax.Array
    elastic: jax.Array
    field: jax.Array

    @classmethod
    def undeformed(
        cls,
        separation: jax.Array,
        forces: tuple[tuple[str, ...], jax.Array],
        stored: jax.Array,
        bonds: jax.Array,
        contacting: jax.Array,
    ) -> State:
        """Of bodies that do not deform in bulk, from the names of the forces and their parts."""
        components, parts = forces
        return cls(
            force=jnp.sum(parts),
            stored=stored,
            central=separation,
            bonds=bonds,
            parts=parts,
            contacting=contacting,
            error=jnp.full_like(separation, 1e-16),
            size=jnp.zeros_like(separation),
            elastic=elastic_part(components, parts),
            field=jnp.zeros(0),
        )


class ScanningCurve(NamedTuple):
    """The way from a reversal to the major branch, solved at some places.

    Attributes
    ----------
    enter, leave
        Ends of its pieces [m] in the direction of motion, shape (pieces,).
    states
        The contact at Chebyshev points of each piece, in the direction of motion, shape
        (pieces, points).
    """

    enter: jax.Array
    leave: jax.Array
    states: State


class Held(NamedTuple):
    """Where and how a phase ended: what the memory is renewed by.

    Attributes
    ----------
    outer
        Whether on a major branch, else still on the way to it.
    unloading
        Whether the phase led outwards.
    size, field
        As in :class:`State`.
    """

    outer: jax.Array
    unloading: jax.Array
    size: jax.Array
    field: jax.Array


class ReversalSampling(NamedTuple):
    """How scanning curves from all reversals on the major branches are found from a few.

    Attributes
    ----------
    number
        Scanning curves in each direction that stand for all (static).
    scale
        Length [m] over which forces fall off, by which ranges of reversals are cut.
    alike
        Whether few curves stand for those from all reversals between two separations [m].
    curve
        The scanning curve from a reversal at a separation [m], where the contact came as a
        :class:`Held` says, if it is wanted, within bounds [m]. Size and field of the held need not
        be those of the branch.
    on_branch
        Whether a memory is of a reversal on a major branch.
    """

    number: int
    scale: jax.Array
    alike: Callable[[jax.Array, jax.Array], jax.Array]
    curve: Callable[[jax.Array, Held, jax.Array, tuple[Any, Any]], ScanningCurve]
    on_branch: Callable[[Memory], jax.Array]


def elastic_part(components: tuple[str, ...], parts: jax.Array) -> jax.Array:
    """The elastic force among the parts of a force [N]; 0 where none is."""
    return parts[components.index("elastic")] if "elastic" in components else jnp.zeros(())


class Contact(eqx.Module):
    """Two bodies pressed together along one axis, with the memory of their bonds.

    The *rigid separation* d [m] is the separation of the mean planes at the apex were
    nothing deformed in bulk. All methods take scalars and are batched by ``vmap``.

    Attributes
    ----------
    resolved
        How finely its curves are cut (static).
    """

    resolved: Resolution = eqx.field(static=True, kw_only=True, default=Resolution(1))

    @property
    @abc.abstractmethod
    def mechanisms(self) -> tuple[str, ...]:
        """Name of the loss of each hysteretic law, in the order of the memory."""

    @property
    @abc.abstractmethod
    def components(self) -> tuple[str, ...]:
        """Names of the forces in :attr:`State.parts`."""

    def initial_memory(self) -> Memory:
        """Memory of bodies that never touched: the first of the :meth:`branches`."""
        return self.branches()[0]

    @abc.abstractmethod
    def branches(self) -> tuple[Memory, ...]:
        """Memories of the major branches.

        On a smooth body all combinations of bonds. Else the first has no bonds and the last has
        all.
        """

    @property
    def sides(self) -> int:
        """Stable equilibria that a major branch may have at one separation (static)."""
        return 1

    @property
    def scale(self) -> jax.Array:
        """Length [m] over which its forces change, against which jumps are measured."""
        return self.interaction_range

    def branch_of(self, memory: Memory, unloading: jax.Array) -> jax.Array:
        """Index of the major branch that a body with ``memory`` reaches."""
        return jnp.where(unloading, min(len(self.mechanisms), 1), 0)

    @abc.abstractmethod
    def state(self, separation: jax.Array, memory: Memory) -> State:
        """The contact at a rigid separation, reached monotonically from ``memory``."""

    def curves(self, ends: jax.Array, places: jax.Array) -> State:
        """The contact on all :meth:`branches`, at ascending places [m].

        Shape (branches, panels, places), on panels with the given ``ends``.
        """
        memories = self.branches()
        stacked = jax.tree_util.tree_map(lambda *leaves: jnp.stack(leaves), *memories)
        if jax.tree_util.tree_leaves(stacked):
            return jax.lax.map(lambda memory: self._branch(ends, places, memory), stacked)
        states = self._branch(ends, places, memories[0])
        return jax.tree_util.tree_map(lambda leaf: leaf[None], states)

    def _branch(self, ends: jax.Array, places: jax.Array, memory: Memory) -> State:
        """The contact on one of them, shape (panels, places)."""
        return jax.vmap(jax.vmap(lambda d: self.state(d, memory)))(places)

    def scanning_curve(
        self, memory: Memory, start: jax.Array, unloading: jax.Array, within: tuple[Any, Any]
    ) -> ScanningCurve | None:
        """The way from a reversal at ``start`` to the major branch, ``within`` bounds [m].

        None for a contact that is always on a branch.
        """
        return None

    @property
    def reversals(self) -> ReversalSampling | None:
        """How few scanning curves stand for all; None where each is solved as it comes."""
        return None

    def means(self, low: jax.Array, high: jax.Array) -> Any:
        """Tables that :meth:`reading` takes, for a body between two separations [m]."""
        return ()

    def reading(self, means: Any) -> Contact:
        """The same contact, whose scanning curves are solved with tables of means."""
        return self

    @abc.abstractmethod
    def update_memory(
        self, memory: Memory, separation: jax.Array, held: Held | None = None
    ) -> Memory:
        """Memory after a monotone motion from ``memory`` to ``separation``.

        ``held`` tells how the motion ended there, where that is known already.
        """

    @abc.abstractmethod
    def losses(self) -> tuple[jax.Array, jax.Array]:
        """Energy [J] lost when one bond forms and when it breaks, per hysteretic law."""

    @abc.abstractmethod
    def lower_bound(
        self, release: jax.Array, kinetic: jax.Array, potential: Potential
    ) -> jax.Array:
        """A separation [m] that a body cannot reach.

        It leaves ``release`` [m] with ``kinetic`` [J], without bonds, in a ``potential``.
        """

    @abc.abstractmethod
    def panels(self, low: jax.Array, high: jax.Array) -> jax.Array:
        """Ends of the pieces between which the force is smooth on one scale."""

    @property
    @abc.abstractmethod
    def interaction_range(self) -> jax.Array:
        """Separation [m] beyond which bodies that never touched feel nothing.

        The force there is below 1e-6 of the largest pull.
        """


class YieldingContact(Contact):
    """A contact that its first impact leaves changed for good.

    It has one of the :meth:`branches`, that of its first approach, and the others once it has had
    its first impact (:meth:`after`).
    """

    @abc.abstractmethod
    def left_by(self, memory: Memory, separation: jax.Array) -> Any:
        """What a first impact leaves, that turned at a separation [m]; arrays for :meth:`after`."""

    @abc.abstractmethod
    def after(self, left: Any) -> Contact:
        """The contact as its first impact left it."""


def _interaction_range(contact: Contact) -> jax.Array:
    return jnp.asarray(contact.interaction_range, dtype=jnp.float64)


_compiled_range = Program(_interaction_range, AT_ONCE)
_ANY = Resolution(0)  # it decides nothing about a range, but each would be compiled


def interaction_range_of(contact: Contact) -> jax.Array:
    """`Contact.interaction_range` [m], compiled as a whole: alone it is a dozen programs."""
    if any(field.name == "resolved" for field in dataclasses.fields(contact)):
        contact = dataclasses.replace(contact, resolved=_ANY)
    return _compiled_range(contact)
