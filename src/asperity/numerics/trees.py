"""Trees of arrays as a whole: one of two, and one of zeros."""

from __future__ import annotations

from typing import Any, TypeVar

from .._jax import jax, jnp

Tree = TypeVar("Tree")


def choose(first: Any, one: Tree, other: Tree) -> Tree:
    """One of two alike trees, the first where ``first`` is true."""
    chosen: Tree = jax.tree_util.tree_map(lambda a, b: jnp.where(first, a, b), one, other)
    return chosen


def zeros_of(shapes: Tree) -> Tree:
    """Zeros of the shapes and kinds that :func:`jax.eval_shape` found."""
    zeros: Tree = jax.tree_util.tree_map(lambda leaf: jnp.zeros(leaf.shape, leaf.dtype), shapes)
    return zeros
