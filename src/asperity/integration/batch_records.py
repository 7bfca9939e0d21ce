"""Cases side by side: what is integrated, what a motion goes on from, what is kept of it."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, NamedTuple

import numpy as np

from .._jax import jax
from ..contact import Contact
from ..dynamics import Begun, Body, Impacts, Limits, Motion
from ..dynamics.release import AtRelease
from ..numerics.compilation import kept
from ..results.first_contact import FirstContact, Passing


class Batch(NamedTuple):
    """Cases of one structure: each array has the cases along its first axis.

    Attributes
    ----------
    contact, body
        The contacts and bodies.
    limits
        Ends of the motions.
    """

    contact: Contact
    body: Body
    limits: Limits

    @classmethod
    def of_one(cls, contact: Contact, body: Body, limits: Limits) -> Batch:
        """One case as a batch."""
        one: Batch = jax.tree_util.tree_map(_raised, cls(contact, body, limits))
        return one


@kept
class Checks(NamedTuple):
    """What must hold before a motion is believed.

    Attributes
    ----------
    ends, errors
        Ends of the panels [m], and the relative error of the interpolation on each.
    residual
        Relative error of the contact's equilibrium.
    reach
        Separation [m] from which on no panel is cut.
    at_release
        The forces at the release.
    """

    ends: jax.Array
    errors: jax.Array
    residual: jax.Array
    reach: jax.Array
    at_release: AtRelease


@kept
class FirstImpact(NamedTuple):
    """What is kept of the first impact where phases are not.

    Attributes
    ----------
    contact
        The first contact.
    at_depth
        :class:`asperity.regimes.validity.AtDepth` of its closest approach.
    """

    contact: FirstContact
    at_depth: jax.Array

    @classmethod
    def unknown(cls, count: int) -> FirstImpact:
        """That of so many cases before it takes place."""
        return cls(FirstContact.unknown(count), np.full((count, 3), np.nan))  # type: ignore[arg-type]


@kept
class ImpactRows(NamedTuple):
    """Impacts of a compiled call.

    Attributes
    ----------
    impacts
        A row an impact. Their phases are None in a batch of several cases.
    passing
        Energies with which each passes the end of contact; None where phases tell them, or
        nothing drags outside contact.
    """

    impacts: Impacts
    passing: Passing | None = None


class Slice(NamedTuple):
    """Cases of a compiled call; places beyond the last are -1 and repeat it."""

    places: np.ndarray
    batch: Batch
    begun: Begun
    first: FirstImpact | None

    @property
    def size(self) -> int:
        """Number of cases."""
        return int(np.sum(self.places >= 0))


def _raised(leaf: Any) -> Any:
    is_array = isinstance(leaf, np.ndarray | np.generic | jax.Array)
    return np.asarray(leaf)[None] if is_array else leaf


def unbatched(tree: Any) -> Any:
    """What a batch of one has of its one case, as arrays of NumPy: JAX would compile."""
    return jax.tree_util.tree_map(lambda leaf: np.asarray(leaf).reshape(np.shape(leaf)[1:]), tree)


def unbatched_shapes(tree: Any) -> Any:
    """The shapes of what a batch of one has of its one case; what is no array stays."""

    def one(leaf: Any) -> Any:
        if not (is_array(leaf) or isinstance(leaf, jax.ShapeDtypeStruct)):
            return leaf
        return jax.ShapeDtypeStruct(leaf.shape[1:], leaf.dtype)

    return jax.tree_util.tree_map(one, tree)


def whole(ends: Begun, rows: ImpactRows) -> Motion:
    """The motion of one case, of its impacts and of where it ended; or the shapes of both."""
    return Motion(rows.impacts, ends.progress, ends.table, ends.reference, ends.origin)


def slices(places: np.ndarray, width: int) -> Iterator[np.ndarray]:
    """The places, so many at a time; the last are filled up with -1."""
    for begin in range(0, places.size, width):
        some = places[begin : begin + width]
        yield np.concatenate([some, np.full(width - some.size, -1, int)])


def taken(tree: Any, places: np.ndarray) -> Any:
    """Cases by their places in a tree of arrays; where there is none, the last of the places."""
    index = np.where(places >= 0, places, places.max())
    return jax.tree_util.tree_map(
        lambda leaf: np.asarray(leaf)[index] if is_array(leaf) else leaf, tree
    )


def is_array(leaf: Any) -> bool:
    """Whether a leaf of a tree is an array, which has the cases along its first axis."""
    return isinstance(leaf, np.ndarray | jax.Array)


def packed(parts: list[Slice], width: int) -> Slice:
    """The cases still in motion, side by side."""
    places = np.concatenate([part.places[part.places >= 0] for part in parts])
    index = np.append(np.arange(places.size), np.zeros(width - places.size, int))

    def joined(*leaves: Any) -> Any:
        if not is_array(leaves[0]):
            return leaves[0]
        kept = [np.asarray(x)[p.places >= 0] for x, p in zip(leaves, parts, strict=True)]
        return np.concatenate(kept)[index]

    tree = jax.tree_util.tree_map(joined, *(part[1:] for part in parts))
    filled = np.concatenate([places, np.full(width - places.size, -1, int)])
    return Slice(filled, *tree)
