"""Force against separation without motion: in to a depth, and out again."""

from __future__ import annotations

from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np
from numpy.polynomial import Chebyshev, chebyshev

from .._jax import jax
from ..contact.contact import Contact, interaction_range_of
from ..numerics.compilation import AT_ONCE, Program
from ..numerics.polynomials import local
from .common_shapes import common_phases, common_table
from .curve_table import CENTRAL, FORCE, STORED, Table, quantities
from .jumps import Segment, jumps
from .record import Impacts
from .unloading import Unloading, unloading

_POINTS = 240
_FAR = 1e6  # times the separations of the curve: as far as a soft spring may let a body jump


class _Piece(NamedTuple):
    low: float
    high: float
    values: np.ndarray


def quasi_static_curve(
    contact: Contact, table: Table, impacts: Impacts, stiffness: float | None = None
) -> tuple[dict[str, Any], float]:
    """Both branches from where the forces begin to the depth of the first impact.

    Parameters
    ----------
    contact
        The contact.
    table
        Its curves.
    impacts
        A motion's impacts, of which the first is taken.
    stiffness
        Stiffness of the spring that holds the body [N/m]; None of a free one.

    Returns
    -------
    The arrays and numbers of :class:`asperity.results.result.Curve`, and the expected number of
    asperities that hold at pull-off.
    """
    deepest, pulled = float(impacts.closest_approach[0]), first_unloading(table, impacts)
    interaction_range = float(interaction_range_of(contact))
    top = min(float(impacts.fall.start[0]), interaction_range + 0.2 * (interaction_range - deepest))
    inward, outward = _branch(table, 0), _way_out(table, impacts)
    places = _places([*inward, *outward], deepest, top)
    approach, unloading = _read(inward, places), _read(outward, places)
    out = unloading[:, FORCE]
    layout = quantities(contact)
    names = contact.components
    found = {
        "rigid_separation": places,
        "central_separation": approach[:, CENTRAL],
        "force_loading": approach[:, FORCE],
        "force_unloading": out,
        "components_loading": dict(zip(names, approach[:, layout.components].T, strict=True)),
        "components_unloading": dict(zip(names, unloading[:, layout.components].T, strict=True)),
        "minimum_separation": deepest,
        "preload": float(impacts.force[0]) if pulled.depends else None,
        "pull_off": float(pulled.pull_off),
        "pull_off_separation": float(pulled.separation) if pulled.pull_off > 0.0 else None,
        "work_of_separation": float(pulled.work),
        "loss": _loss(table, approach[:, layout.bonds], unloading[:, layout.bonds])
        + _by_jumps(impacts, deepest),
        "jumps": None,
    }
    if stiffness is not None:
        branches = _segments(inward, inward[0].low), _segments(outward, deepest)
        found["jumps"] = jumps(*branches, stiffness)
    return found, float(pulled.held)


def _segments(pieces: list[_Piece], begin: float) -> list[Segment]:
    """Force and stored energy along pieces from a separation on [m], and the nothing beyond."""
    found, low = [], begin
    for piece in pieces:
        if piece.high > low:
            force, stored = (
                Chebyshev(piece.values[:, column], (piece.low, piece.high))
                for column in (FORCE, STORED)
            )
            found.append(Segment(low, piece.high, force, stored))
            low = piece.high
    far = low + _FAR * max(abs(low), abs(begin))
    none = Chebyshev([0.0], (low, far))
    return [*found, Segment(low, far, none, none)]


def _branch(table: Table, branch: int) -> list[_Piece]:
    """The panels of a major branch that are not empty, ascending."""
    values = np.asarray(table.values)[branch]
    ends = np.asarray(table.ends)
    pairs = zip(ends[:-1], ends[1:], values, strict=True)
    return [_Piece(low, high, rows) for low, high, rows in pairs if high > low]


def _way_out(table: Table, impacts: Impacts) -> list[_Piece]:
    """The pieces from the first deepest point to the branch, and then the branch."""
    rise = impacts.rise
    inner = [
        _Piece(float(low), float(high), rows)
        for low, high, rows in zip(
            *(np.asarray(leaf[0]) for leaf in (rise.inner.low, rise.inner.high, rise.inner.values)),
            strict=True,
        )
        if high > low
    ]
    begin = inner[-1].high if inner else float(rise.start[0])
    rest = [p for p in _branch(table, int(rise.branch[0])) if p.high > begin]
    return [*inner, *rest]


def _read(pieces: list[_Piece], places: np.ndarray) -> np.ndarray:
    """Rows of quantities at ascending places."""
    ends = np.array([p.high for p in pieces])
    index = np.minimum(np.searchsorted(ends, places), len(pieces) - 1)
    width = min(p.values.shape[1] for p in pieces)
    rows = np.empty((len(places), width))
    for k in np.unique(index):
        here = index == k
        low, high, values = pieces[k]
        rows[here] = chebyshev.chebval(local(low, high, places[here]), values[:, :width]).T
    return rows


def _places(pieces: list[_Piece], deepest: float, top: float) -> np.ndarray:
    """Separations from the deepest point up: even on each piece of the curves."""
    ends = np.array([end for p in pieces for end in (p.low, p.high)])
    inside = ends[(ends > deepest) & (ends < top)]
    ends = np.unique(np.concatenate([[deepest], inside, [top]]))
    share = max(3, _POINTS // (len(ends) - 1))
    steps = [np.linspace(a, b, share, endpoint=False) for a, b in pairwise(ends)]
    return np.concatenate([*steps, [top]])


def first_unloading(table: Table, impacts: Impacts) -> Unloading:
    """What the first of some impacts is pulled back by, as numbers."""
    laws = impacts.bonds.shape[1]
    phases = jax.tree_util.tree_map(lambda leaf: np.asarray(leaf)[:1], impacts.rise)
    first = jax.tree_util.tree_map(lambda leaf: leaf[0], common_phases(phases, laws))
    return unloading_of(common_table(table, laws), first)


unloading_of = Program(unloading, AT_ONCE)


def _by_jumps(impacts: Impacts, deepest: float) -> float:
    """Energy lost at jumps in, down to the deepest point, and out to the end [J]."""
    inward, outward = impacts.fall.jumps, impacts.rise.jumps
    passed = np.asarray(inward.place[0]) > deepest
    return float(np.sum(np.asarray(inward.energy[0])[passed]) + np.sum(outward.energy[0]))


def _loss(table: Table, approach: np.ndarray, unloading: np.ndarray) -> float:
    """Energy lost in and out: bonds made on the way in, and broken on the way out."""
    formation, rupture = np.asarray(table.losses)
    return float(
        (approach[0] - approach[-1]) @ formation + (unloading[0] - unloading[-1]) @ rupture
    )
