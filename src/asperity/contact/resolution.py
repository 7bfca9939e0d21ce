"""How finely a rough contact's curves are cut, from the lengths of its forces."""

from __future__ import annotations

from collections.abc import Iterable
from math import asinh, ceil, hypot
from typing import NamedTuple

from .._jax import jax, jnp
from ..interface.height_quadrature import EVEN
from ..interface.rough_planes import RoughPlanes
from ..laws import KelvinFilling
from ..laws.law import Law
from ..numerics.compilation import AT_ONCE, Program

LINEAR = 8.0
"""Panels are even in asinh(separation / (LINEAR rms))."""

LATER = 3
"""Pieces at most, but for finer ones, in which rings that lag behind reach the branch."""

_DEEP = 5.0  # rms below the mean plane, down to where a body may come
_SHORTEST = 4.0  # rms, where heights end soon above the mean plane: some lie below it
_NEAR = 20.0  # rms, up to which kinks count evenly
_LONGER = 4.0  # times, that panels are beyond
_HEIGHTS = 17.2  # rms between the lowest and the highest
_PIECE = 6.4  # rms of a quadrature's piece
_MOST_SHARED = 16 * EVEN  # as many as 16 places have that share none


class Resolution(NamedTuple):
    """Numbers that are fixed before anything is traced.

    Attributes
    ----------
    panels
        Panels of the curves within the interaction range.
    nodes
        Solutions on a piece of the way from a reversal to the major branch.
    pieces
        Number of these pieces, for each law.
    shared
        Even pieces of the quadratures that the places of one panel share; 0 where each has its own.
    reversals
        Scanning curves that are solved for each direction, where they stand for all.
    error_floor
        Relative error of the curves below which more panels gain nothing.
    later
        Of the pieces, those in which rings that lag behind reach the branch; of a contact that
        deforms half of all at most, and :data:`LATER`, where it is 0. On a rigid bulk those that
        narrow towards the inner end, where the forces of menisci bend.
    """

    panels: int
    nodes: int = 16
    pieces: int = 1
    shared: int = EVEN
    reversals: int = 10
    error_floor: float = 0.0
    later: int = 0

    def rounded(self) -> Resolution:
        """At least as fine, in numbers that few cases differ in: each is compiled."""
        return self._replace(
            panels=_doubled(self.panels),
            nodes=max(self.nodes, 16),
            pieces=max(1 << (self.pieces - 1).bit_length(), 2),
            shared=_doubled(self.shared),
        )


def _doubled(count: int) -> int:
    """The least of 7, 14, 28, ... that is not below a count; 0 of 0."""
    return EVEN << (-(-count // EVEN) - 1).bit_length() if count else 0


def resolution(interface: RoughPlanes, *, deforms: bool) -> Resolution:
    """More than the ledger needs to close to 1e-6 of the impact energy.

    By the interaction range of forces and bonds over the rms height. On a rigid bulk, where curves
    are cheap, one of a few: cases that differ in values run the same compiled functions. Where the
    lengths are traced, enough for a few rms.
    """
    if any(isinstance(leaf, jax.core.Tracer) for leaf in jax.tree_util.tree_leaves(interface)):
        lengths = interface.panel_lengths
        finer = lengths.grain**-0.5
        return Resolution(ceil(10 * finer), 16, ceil(2 * finer), error_floor=lengths.error_floor)
    in_rms = tuple(float(length) for length in _lengths(interface))
    found = resolution_of(interface, in_rms, deforms=deforms)
    return found if deforms else found.rounded()


def resolution_of(
    interface: RoughPlanes, lengths: tuple[float, ...], *, deforms: bool
) -> Resolution:
    """What the lengths of the forces ask for, see :func:`lengths_in_rms`, to a single panel."""
    panel_lengths = interface.panel_lengths
    floor = panel_lengths.error_floor
    share, kinked, interaction_range, bends = lengths
    nodes, pieces = panel_lengths.along(share)
    if bends > 1.5:
        nodes, pieces = 16, max(pieces, ceil(bends / 4.0))
    if interface.yields:  # what is left of the heights is steeper than they were
        nodes, pieces = 16, max(pieces, 2)
    # What is smooth counts as the panels do, which widen with the separation. Far out they are
    # longer still: where curves ask for it, as at the ends of bonds that stretch far, they are cut.
    even, near = min(kinked, _NEAR), min(interaction_range, _NEAR)
    smooth = LINEAR * (asinh(near / LINEAR) - asinh(even / LINEAR))
    far = LINEAR * (asinh(interaction_range / LINEAR) - asinh(near / LINEAR))
    length = max(even + max(smooth, 0.0) + far / _LONGER, _SHORTEST)
    if not deforms:
        # One more where a law bends (Maugis and Dugdale's), which else misses 1e-8 at first.
        panels = ceil(length / panel_lengths.panel) + (bends > 0.0)
        shared = _shared(interaction_range, panels)
        shared = shared if shared <= _MOST_SHARED else 0
        return Resolution(panels, max(nodes, 8), pieces, shared, error_floor=floor)
    # Rings that lag behind have pieces of their own, where what they hold counts for much: where
    # bonds stretch over several rms, their forces change while contact opens from its edge inwards.
    fills = fills_by_contact(interface.hysteretic)
    panels = ceil(length / (1.7 * panel_lengths.grain))
    later = min(ceil(share), LATER) if share > 0.1 else int(fills)
    nodes, pieces = 16 if fills else nodes, max(pieces + later, 2 * later)
    return Resolution(panels, nodes, pieces, error_floor=floor)


def fills_by_contact(bonds: Iterable[Law]) -> bool:
    """Whether contact leaves liquid between the surfaces, far wider than itself. Without values.

    Liquid that forms at the Kelvin gap leaves as it came, and holds nothing.
    """
    return any(isinstance(law, KelvinFilling) for law in bonds)


FEW_DEFORMING = (
    Resolution(9, 16, 3),
    Resolution(9, 16, 6),
    Resolution(18, 16, 6, 14),
    Resolution(36, 16, 12, 28),
    Resolution(72, 16, 24, 56),
)
"""From coarse to fine; of one case after the other on a half-space."""

FEW_OF_MANY = (
    Resolution(8, 16, 1, 7),
    Resolution(16, 16, 2, 14),
    Resolution(32, 16, 4, 28),
    Resolution(64, 16, 8, 56),
)
"""From coarse to fine; of many cases side by side."""


def one_of_few(found: Resolution, few: tuple[Resolution, ...]) -> Resolution:
    """The first of a few resolutions that is at least as fine, since each is compiled.

    Where none is, one of powers of two.
    """
    for one in few:
        if all(number <= most for number, most in zip(found[:4], one[:4], strict=True)):
            break
    else:
        one = Resolution(*(1 << (number - 1).bit_length() for number in found[:4]))
    shared = one.shared if found.shared else 0
    return one._replace(shared=shared, error_floor=found.error_floor, later=found.later)


def _shared(interaction_range: float, panels: int) -> int:
    """Even pieces of quadratures that the places of the outermost panel share."""
    step = (asinh(interaction_range / LINEAR) + asinh(_DEEP / LINEAR)) / panels
    return max(EVEN, ceil((step * hypot(interaction_range, LINEAR) + _HEIGHTS) / _PIECE))


def lengths_in_rms(interface: RoughPlanes) -> tuple[jax.Array, jax.Array, jax.Array, jax.Array]:
    """How far a bond stretches, and how far forces have kinks and reach, over the rms height.

    And how far a bond stretches over the length on which its force changes.
    """
    widths = [law.breaking_gap - law.forming_gap for law in interface.hysteretic]
    widest = jnp.max(jnp.stack([jnp.zeros(()), *widths]))
    rms = interface.scale.rms
    bends = [width / law.length for width, law in zip(widths, interface.hysteretic, strict=True)]
    most = jnp.max(jnp.stack([jnp.zeros(()), *bends]))
    kinked = (interface.scale.top + interface.last_kink) / rms
    interaction_range = (interface.scale.top + jnp.maximum(interface.interaction_range, 0.0)) / rms
    return widest / rms, kinked, interaction_range, most


_lengths = Program(lengths_in_rms, AT_ONCE)
