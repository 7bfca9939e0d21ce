"""Trees of arrays as a whole: one of two, one of many, and one of zeros."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, TypeVar

import numpy as np

from .._jax import jax, jnp

Tree = TypeVar("Tree")


def choose(first: Any, one: Tree, other: Tree) -> Tree:
    """One of two alike trees, the first where ``first`` is true."""
    chosen: Tree = jax.tree_util.tree_map(lambda a, b: jnp.where(first, a, b), one, other)
    return chosen


def stacked(each: Sequence[Tree]) -> Tree:
    """Alike trees as one, whose leaves have an axis more, the first one."""
    whole: Tree = jax.tree_util.tree_map(lambda *leaves: np.stack(leaves), *each)
    return whole


def zeros_of(shapes: Tree) -> Tree:
    """Zeros of the shapes and kinds that :func:`jax.eval_shape` found."""
    zeros: Tree = jax.tree_util.tree_map(lambda leaf: jnp.zeros(leaf.shape, leaf.dtype), shapes)
    return zeros
