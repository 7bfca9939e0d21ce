"""How finely a rough contact's curves are cut, from the lengths of its forces."""

from __future__ import annotations

from math import ceil
from typing import NamedTuple

from .._jax import jax, jnp
from ..layers import Surfaces
from ..program import Program


class Resolution(NamedTuple):
    """Numbers that are fixed before anything is traced.

    Attributes
    ----------
    panels
        Panels of the curves within the reach of the forces.
    nodes
        Solutions on a piece of the way from a reversal to the outermost branch.
    pieces
        Number of these pieces, for each law.
    """

    panels: int
    nodes: int
    pieces: int


def resolution(interface: Surfaces, *, deforms: bool) -> Resolution:
    """More than the ledger needs to close to 1e-6 of the impact energy.

    By the reach of the forces and of the bonds, over the rms height; where these are traced,
    enough for a few rms.
    """
    if any(isinstance(leaf, jax.core.Tracer) for leaf in jax.tree_util.tree_leaves(interface)):
        return Resolution(10, 16, 2)
    share, beyond, bends = (float(length) for length in _lengths(interface))
    reach = 9.0 + beyond
    nodes = next((n for end, n in ((0.1, 6), (0.5, 8), (2.0, 12)) if share < end), 16)
    pieces = ceil(share / 4.5) or 1
    if bends > 1.5:
        nodes, pieces = 16, max(pieces, ceil(bends / 4.0))
    if not deforms:
        return Resolution(ceil(reach / 2.2), max(nodes, 8), pieces)
    # Rings that lag behind have a piece of their own.
    return Resolution(ceil(reach / 1.7), nodes, pieces + (share > 0.1))


def _in_rms(interface: Surfaces) -> tuple[jax.Array, jax.Array, jax.Array]:
    """How far a bond stretches and a force reaches, over the rms height.

    And how far a bond stretches over the length on which its force changes.
    """
    widths = [law.breaking_gap - law.forming_gap for law in interface.hysteretic]
    widest = jnp.max(jnp.stack([jnp.zeros(()), *widths]))
    rms = interface.heights.rms
    bends = [width / law.length for width, law in zip(widths, interface.hysteretic, strict=True)]
    most = jnp.max(jnp.stack([jnp.zeros(()), *bends]))
    return widest / rms, jnp.maximum(interface.reach, 0.0) / rms, most


_lengths = Program(_in_rms)
