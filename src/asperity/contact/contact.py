"""What the equation of motion asks of a contact."""

from __future__ import annotations

import abc
from collections.abc import Callable
from itertools import product
from typing import Any, NamedTuple

import equinox as eqx
import numpy as np

from .._jax import jax, jnp

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


class Contact(eqx.Module):
    """Two bodies pressed together along one axis, with the memory of their bonds.

    The *rigid separation* d [m] is the separation of the mean planes at the apex were
    nothing deformed in bulk. All methods take scalars and are batched by ``vmap``.
    """

    @property
    @abc.abstractmethod
    def mechanisms(self) -> tuple[str, ...]:
        """Name of the loss of each hysteretic law, in the order of the memory."""

    @property
    @abc.abstractmethod
    def components(self) -> tuple[str, ...]:
        """Names of the forces in :attr:`State.parts`."""

    @property
    def discrete(self) -> bool:
        """Whether a bond is one yes or no, as on a smooth body."""
        return False

    @property
    def reference(self) -> jax.Array | None:
        """Separation [m] from which rebounds count; None for the static equilibrium."""
        return None

    def elastic_part(self, parts: jax.Array) -> jax.Array:
        """The elastic force among the parts [N]."""
        if "elastic" not in self.components:
            return jnp.zeros_like(parts[0])
        return parts[self.components.index("elastic")]

    @property
    def error_floor(self) -> float:
        """Relative error of its curves below which nothing is gained. Without values."""
        return 0.0

    @abc.abstractmethod
    def refined(self, factor: int) -> Contact:
        """The same contact with ``factor`` times as many panels on its curves."""

    @abc.abstractmethod
    def initial_memory(self) -> Memory:
        """Memory of bodies that never touched."""

    @abc.abstractmethod
    def extreme(self, bonded: tuple[bool, ...]) -> Memory:
        """Memory on a major branch: for each law, all bonds kept or none made."""

    @property
    def yields(self) -> bool:
        """Whether its first impact leaves it changed for good. Known without values."""
        return False

    @property
    def rest_branch(self) -> int:
        """Index of the branch on which it comes to rest: of approach, once it has yielded."""
        return int(self.yields)

    def left_by(self, memory: Memory, separation: jax.Array) -> Any:
        """What a first impact leaves, that turned at a separation [m]; arrays for :meth:`after`."""
        return ()

    def after(self, left: Any) -> Contact:
        """The contact as its first impact left it."""
        return self

    def branches(self) -> tuple[Memory, ...]:
        """Memories of the major branches.

        On a smooth body all combinations of bonds. Else the first has no bonds and the last has
        all. A contact that yields has that of its first approach alone, and the others once it
        has had its first impact (:meth:`after`).
        """
        laws = len(self.mechanisms)
        if self.discrete:
            combinations = product((False, True), repeat=laws)
            return tuple(self.extreme(tuple(reversed(bits))) for bits in combinations)
        ends = ((False,) * laws, (True,) * laws) if laws else ((),)
        return tuple(self.extreme(bonded) for bonded in ends)

    def branch_of(self, memory: Memory, unloading: jax.Array) -> jax.Array:
        """Index of the major branch that a body with ``memory`` reaches."""
        laws = len(self.mechanisms)
        if self.discrete:
            weights = 2 ** np.arange(laws)
            return jnp.sum(jnp.where(self.bonded(memory), weights, 0))
        return jnp.where(unloading, min(laws, 1), 0)

    @abc.abstractmethod
    def state(self, separation: jax.Array, memory: Memory) -> State:
        """The contact at a rigid separation, reached monotonically from ``memory``."""

    def branch(self, ends: jax.Array, places: jax.Array, memory: Memory) -> State:
        """The contact on the major branch of ``memory``, at ascending places [m].

        Shape (panels, places), on panels with the given ``ends``.
        """
        return jax.vmap(jax.vmap(lambda d: self.state(d, memory)))(places)

    def curves(self, ends: jax.Array, places: jax.Array) -> State:
        """The contact on all :meth:`branches` along a new first axis, else as :meth:`branch`."""
        memories = self.branches()
        stacked = jax.tree_util.tree_map(lambda *leaves: jnp.stack(leaves), *memories)
        if jax.tree_util.tree_leaves(stacked):
            return jax.lax.map(lambda memory: self.branch(ends, places, memory), stacked)
        states = self.branch(ends, places, memories[0])
        return jax.tree_util.tree_map(lambda leaf: leaf[None], states)

    def scanning_curve(
        self, memory: Memory, start: jax.Array, unloading: jax.Array, within: tuple[Any, Any]
    ) -> ScanningCurve | None:
        """The way from a reversal at ``start`` to the major branch, ``within`` bounds [m].

        None for a contact that is always on a branch.
        """
        return None

    @property
    def reversals(self) -> int:
        """Scanning curves in each direction that stand for all; 0 where none is worth keeping."""
        return 0

    @property
    def scale(self) -> jax.Array:
        """Length [m] over which forces fall off, by which ranges of reversals are cut."""
        raise TypeError(
            f"{type(self).__name__} has no scanning curves to tabulate: its `reversals` is 0"
        )

    @property
    def lagging(self) -> int:
        """How many numbers :attr:`State.field` holds."""
        return 0

    @property
    def passed(self) -> tuple[int, int]:
        """Pieces of a :class:`ScanningCurve`, and places on each."""
        raise TypeError(
            f"{type(self).__name__} has no scanning curves to tabulate: its `reversals` is 0"
        )

    def alike(self, low: jax.Array, high: jax.Array) -> jax.Array:
        """Whether few ways stand for those from all reversals between two separations [m]."""
        return jnp.zeros(jnp.shape(low), bool)

    def scanning_curve_from(
        self, start: jax.Array, held: Held, wanted: jax.Array, within: tuple[Any, Any]
    ) -> ScanningCurve:
        """The way from a reversal on a major branch, that came there as ``held`` says.

        Size and field of ``held`` need not be those of the branch. Nothing is solved where it is
        not ``wanted``. Only of contacts whose :attr:`reversals` are more than 0.
        """
        raise TypeError(
            f"{type(self).__name__} has no scanning curves to tabulate: its `reversals` is 0"
        )

    def on_branch(self, memory: Memory) -> jax.Array:
        """Whether the last reversal was on a major branch, for :meth:`scanning_curve_from`."""
        return jnp.asarray(False)

    @abc.abstractmethod
    def remember(self, memory: Memory, separation: jax.Array) -> Memory:
        """Memory after a monotone motion from ``memory`` to ``separation``."""

    def update_memory(self, memory: Memory, separation: jax.Array, held: Held) -> Memory:
        """The same, where the state at ``separation`` is known already."""
        return self.remember(memory, separation)

    @abc.abstractmethod
    def bonded(self, memory: Memory) -> jax.Array:
        """For a discrete contact: which laws are bonded, shape (laws,)."""

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
