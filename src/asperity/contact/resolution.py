"""How finely a rough contact's curves are cut, from the lengths of its forces."""

from __future__ import annotations

from math import ceil
from typing import NamedTuple

from .._jax import jax
from ..interface import Interface


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


def resolution(interface: Interface, *, deforms: bool) -> Resolution:
    """More than the ledger needs to close to 1e-6 of the impact energy.

    By the reach of the forces and of the bonds, over the rms height; where these are traced,
    enough for a few rms.
    """
    try:
        rms = float(interface.heights.rms)
        widths = [float(law.breaking_gap - law.forming_gap) for law in interface.hysteretic]
        reach = 9.0 + max(float(interface.reach), 0.0) / rms
    except jax.errors.ConcretizationTypeError:
        return Resolution(10, 16, 2)
    share = max(widths, default=0.0) / rms
    nodes = next((n for end, n in ((0.1, 6), (0.5, 8), (2.0, 12)) if share < end), 16)
    if not deforms:
        return Resolution(ceil(reach / 2.2), max(nodes, 8), ceil(share / 4.5) or 1)
    # Rings that lag behind have a piece of their own.
    return Resolution(ceil(reach / 1.7), nodes, (ceil(share / 4.5) or 1) + (share > 0.1))
