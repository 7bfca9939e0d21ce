"""Curves and phases in few shapes: what measures them is compiled once for many kinds of case.

Panels and pieces are filled up with empty ones, which nothing passes, and rows that no measure
reads are left out.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from .._jax import jax
from .curve_table import Pieces, Quantities, Table
from .instability import Jumps
from .record import Body, Impacts, Motion, Phase, Progress

_ROWS = 256  # of impacts at least: more than most motions have
_BRANCHES, _LAWS = 2, 3  # at least, and in multiples
_PANELS, _PIECES = 32, 4  # at least, and doubled as often as needed


def without_curves(motion: Motion) -> Motion:
    """A motion without its curves, memory and phases, its losses summed over their mechanisms."""
    none: Any = ()
    impacts = motion.impacts._replace(fall=none, rise=none)
    impacts = jax.tree_util.tree_map(filled_up, impacts)
    lost = np.sum(impacts.lost, axis=1, keepdims=True)
    impacts = impacts._replace(bonds=np.zeros((lost.size, 0)), lost=lost)
    over = Progress.over(motion.end.time, motion.end.outcome, motion.end.made)
    return motion._replace(impacts=impacts, end=over, table=none)


def with_phases(motion: Motion, body: Body) -> tuple[Table, Impacts]:
    """The curves of a motion, and its impacts with the phases that measures need.

    Parameters
    ----------
    motion
        The motion.
    body
        What moved: where a drag acts outside contact, all phases are needed, else the first.
    """
    impacts, laws = motion.impacts, motion.impacts.bonds.shape[1]
    some = filled_up if body.damped_apart else _first
    fall, rise = (
        common_phases(jax.tree_util.tree_map(some, phase), laws)
        for phase in (impacts.fall, impacts.rise)
    )
    plain = without_curves(motion).impacts
    return common_table(motion.table, laws), plain._replace(fall=fall, rise=rise)


def common_table(table: Table, laws: int) -> Table:
    """Curves of a contact of so many laws without what moves a body on: forces, energies, bonds."""
    ends, values = np.asarray(table.ends), _columns(np.asarray(table.values), laws)
    branches, panels = values.shape[:2]
    first = _power(panels, _PANELS) - panels
    # A branch of zeros would end where the table does: the last one stands there twice.
    more = -branches % _BRANCHES
    values = np.pad(values, ((0, more), (0, 0), (0, 0), (0, 0)), mode="edge")
    none: Any = ()
    return Table(
        ends=np.pad(ends, (first, 0), mode="edge"),  # type: ignore[arg-type]
        values=np.pad(values, ((0, 0), (first, 0), (0, 0), (0, 0))),  # type: ignore[arg-type]
        works=none,
        errors=none,
        residual=none,
        losses=none,
        left=("yields",) if table.left else (),
    )


def common_phases(phases: Phase, laws: int) -> Phase:
    """Phases of such a contact, with an axis of phases first, and with empty pieces first."""
    inner: Any = phases.inner
    start = np.asarray(phases.start)
    first = _power(inner.low.shape[1], _PIECES) - inner.low.shape[1]
    before = np.broadcast_to(start[:, None], (start.size, first))
    ends: Any = [np.append(before, leaf, axis=1) for leaf in inner[:4]]
    values: Any = np.pad(_columns(inner.values, laws), ((0, 0), (first, 0), (0, 0), (0, 0)))
    none: Any = np.zeros((start.size, 0))
    return phases._replace(
        inner=Pieces(*[*ends, values]),
        lost=none,
        bonds=np.zeros((start.size, _laws(laws))),  # type: ignore[arg-type]
        jumps=Jumps(none, none),
    )


def _first(leaf: Any) -> np.ndarray:
    return np.asarray(leaf)[:1]


def filled_up(leaf: Any) -> np.ndarray:
    """An array of impacts with zeros in the rows of those that were not made: a power of two."""
    made = leaf.shape[0]
    size = max(_ROWS, 1 << (made - 1).bit_length())
    return np.pad(leaf, [(0, size - made), *[(0, 0)] * (leaf.ndim - 1)])


def _columns(values: Any, laws: int) -> np.ndarray:
    """Coefficients of the columns up to the bonds, with as many of these as are common."""
    bonds = Quantities(laws, 0).bonds
    more = _laws(laws) - laws
    return np.pad(values[..., : bonds.stop], [*[(0, 0)] * (values.ndim - 1), (0, more)])


def _laws(count: int) -> int:
    return max(-(-count // _LAWS), 1) * _LAWS


def _power(count: int, least: int) -> int:
    """``least`` times the power of two that a count needs."""
    while least < count:
        least *= 2
    return least
