"""Major branches of measured summits, as tables over the separation."""

from __future__ import annotations

from functools import partial
from math import ceil, log2

import equinox as eqx
import numpy as np
from numpy.polynomial import chebyshev, legendre

from .._jax import jax, jnp
from ..laws.law import Law, terms
from ..numerics.polynomials import from_points, quintic
from ..numerics.splines import kernel_rule
from ..surfaces.heights.measured_heights import Sampled
from .height_quadrature import points
from .interface import Interface

_OCTAVE = 8  # cells an octave of the depth, below the even ones
_DEEP = 48 * _OCTAVE
_STAND = 16  # heights that stand for all below, where the law falls by at least 1/5.8 each
_MOST = 8192  # even cells below the end of the longest bond
_STEPS = 10  # of the ladders below a law's kinks, up to two even cells
_NODES, _WEIGHTS = legendre.leggauss(6)
_AT = 0.5 * (_NODES + 1.0)  # places in a deep cell
_TO_POWERS = np.linalg.inv(np.vander(_AT, increasing=True))
_INTEGRALS = np.vander(_AT, 7, increasing=True)[:, 1:] / np.arange(1.0, 7.0) @ _TO_POWERS


class BranchTable(eqx.Module):
    """Means of a law without truncated powers over measured heights, on its major branches.

    Polynomials of the fifth degree on even cells from far below the heights to their top, with
    the exact value, slope and curvature at both ends of each; below those on cells that grow in
    geometric progression, where few heights stand for all. Summed over several interfaces.

    Attributes
    ----------
    cells
        Coefficients of powers, shape (lifts, branches, cells, rows, 6): lift 0 and 1, the branch
        of loading and that of unloading, the mechanisms of the force and then the energy.
    origin
        Separation [m] at which the even cells begin.
    step
        Their width [m].
    depth
        Depth of the first of them, in its widths, below where the middle of the heights meets the
        lowest gap at which a law is not smooth.
    names
        Mechanisms of the force (static).
    """

    cells: jax.Array
    origin: jax.Array
    step: jax.Array
    depth: jax.Array
    names: tuple[str, ...] = eqx.field(static=True)

    def __call__(
        self, separation: jax.Array, integrated: int, unloading: jax.Array | bool = False
    ) -> jax.Array:
        """The forces and the energy at separations [m] of any shape, one row each."""
        count = self.cells.shape[2]
        even = count - _DEEP
        x = (separation - self.origin) / self.step
        deep = x < 0.0
        place = jnp.where(deep, _OCTAVE * jnp.log2(1.0 - jnp.where(deep, x, 0.0) / self.depth), x)
        cell = jnp.clip(jnp.floor(place), 0, jnp.where(deep, _DEEP, even) - 1)
        t = (place - cell)[..., None]
        index = jnp.asarray(unloading) * count + jnp.where(deep, even, 0) + cell
        table = self.cells[integrated].reshape(-1, *self.cells.shape[3:])
        found = table.at[index.astype(int)].get(mode="promise_in_bounds")
        value = found[..., -1]
        for k in range(4, -1, -1):
            value = value * t + found[..., k]
        return jnp.moveaxis(jnp.where(deep[..., None] | (t <= 1.0), value, 0.0), -1, 0)


def branch_tables(parts: Interface) -> tuple[BranchTable, ...]:
    """A table for each law of interfaces along a first axis, summed over them; or none.

    Their heights must be :class:`~asperity.surfaces.heights.Sampled` on the same nodes, and the
    free branches of their laws nothing. Bonds that stretch over more cells than ``_MOST`` have
    none, nor have laws whose values are traced.
    """
    laws, heights = terms(parts.law), parts.heights
    if not isinstance(heights, Sampled):
        return ()
    if not all(law.hysteretic and law.only_bonded for law in laws):
        return ()
    if any(isinstance(leaf, jax.core.Tracer) for leaf in jax.tree_util.tree_leaves(parts)):
        return ()
    nodes = heights.nodes
    ends = [_ends(law) for law in laws]
    cells = nodes + max(float((end - lowest) / heights.step[0]) for lowest, end in ends)
    if not cells <= _MOST:
        return ()
    return _tabulated(parts, nodes << ceil(log2(cells / nodes)))


@jax.jit
def _ends(laws: Law) -> tuple[jax.Array, jax.Array]:
    """The lowest gap [m] at which one of some laws is not smooth, and where the last bond ends."""
    kinks = jax.vmap(lambda law: jnp.stack(_kinks_of(law)))(laws)
    return jnp.min(kinks), jnp.max(kinks)


def _kinks_of(law: Law) -> list[jax.Array]:
    gaps = (*law.kinks, law.forming_gap, law.breaking_gap)
    return [jnp.asarray(gap, float) for gap in gaps]


@partial(jax.jit, static_argnums=1)
def _tabulated(parts: Interface, below: int) -> tuple[BranchTable, ...]:
    return tuple(_table(parts, k, below) for k in range(len(terms(parts.law))))


def _table(parts: Interface, number: int, below: int) -> BranchTable:
    """The table of one law of interfaces along a first axis.

    Its even cells begin ``below`` steps under where the lowest height meets the end of the last
    bond, and at least its heights' width under where it meets the lowest gap at which the law is
    not smooth: further down all are bonded, and few heights stand for all.
    """
    heights = parts.heights
    assert isinstance(heights, Sampled)
    laws = terms(parts.law)[number]
    first, step = heights.first[0], heights.step[0]
    lowest, end = _ends(laws)
    share = parts.density[:, None] * heights.share[:, 0]
    shortest = jax.vmap(lambda law, rms: jnp.minimum(law.length, rms))(laws, heights.rms)
    nodes = share.shape[1]

    def kernels(each: tuple[Law, jax.Array]) -> jax.Array:
        return _kernels(each[0], end, step, each[1], (nodes, below))

    # In turn: one body of code to compile, and a law's values at all gaps are many.
    flat = jax.lax.map(kernels, (laws, shortest))
    even = _even_cells(_convolved(flat, share), step)
    depth = below + 0.5 * nodes - (end - lowest) / step
    deep = _deep_cells(laws, share, (end - below * step, step, depth), even[..., 0, :, 0])
    cells = jnp.concatenate([even, deep], axis=2)
    return BranchTable(cells, first - below * step + end, step, depth, _names(laws))


def _names(law: Law) -> tuple[str, ...]:
    return tuple(sorted(law.counts or {law.mechanism}))


def _rows(law: Law, gap: jax.Array) -> jax.Array:
    """Parts of the force [N], and the energy [J], of bonds at gaps [m]; one row each."""
    found = law.response(gap, jnp.ones(gap.shape, bool))
    return jnp.stack([found[name] for name in (*_names(law), "energy")])


def _kernels(
    law: Law, end: jax.Array, step: jax.Array, shortest: jax.Array, counts: tuple[int, int]
) -> jax.Array:
    """Integrals of a law over one cubic B-spline at its whole distances from the gap ``end``.

    Shape (4, branches, rows, distances): what is above a distance, the value, slope and
    curvature there; with the ``counts`` of nodes and of cells below the end, distances from
    -nodes - below + 1 to nodes + 2 steps.
    """
    nodes, below_end = counts
    lowest = -nodes - below_end - 4
    kink = (jnp.stack(_kinks_of(law)) - end) / step
    first = jnp.minimum(0.25 * shortest / step, 1.0)
    ladder = first * (2.0 / first) ** (np.arange(_STEPS) / _STEPS)
    below = jnp.stack([jnp.min(kink), jnp.max(kink)])[:, None] - ladder
    bounds = jnp.concatenate([np.arange(lowest, 1.0), kink, below.ravel()])
    place, weight = points(jnp.sort(jnp.clip(bounds, lowest, (law.breaking_gap - end) / step)))
    gap = end + step * place
    values = weight * _rows(law, gap)
    values = jnp.stack([jnp.where(gap < law.forming_gap, values, 0.0), values])
    # A piece lies within one cell; the splines about it are a quartic or a cubic there.
    cell = jnp.clip(jnp.floor(place[:, 8]), lowest, -1)
    laid = jnp.einsum("brpn,kspn->ksbrp", values, _splines(place - cell[:, None]))
    index = cell.astype(int) - lowest
    count = -lowest + nodes + 4
    empty = jnp.zeros((4, *values.shape[:2], count))
    for k in range(4):
        empty = empty.at[..., index + k].add(laid[:, k])
    # Of what is above, whole cells count everywhere below.
    whole = jnp.zeros((*values.shape[:2], count)).at[..., index].add(jnp.sum(values, axis=-1))
    above = jnp.cumsum(whole[..., ::-1], axis=-1)[..., ::-1]
    empty = empty.at[0, ..., :-1].add(above[..., 1:])
    return empty[..., 6:]


def _splines(t: jax.Array) -> jax.Array:
    """Integral above, value, slope and curvature of B-splines about -1, 0, 1 and 2, at -t.

    Shape (4, splines, *t): seen from the spline, the place lies at its distance less t.
    """
    s = 1.0 - t
    rows = (
        (1.0 - s**4 / 24.0, 0.5 + _half(t), 0.5 - _half(s), t**4 / 24.0),
        (s**3 / 6.0, 2.0 / 3.0 - t**2 + 0.5 * t**3, 2.0 / 3.0 - s**2 + 0.5 * s**3, t**3 / 6.0),
        (0.5 * s**2, t * (2.0 - 1.5 * t), -s * (2.0 - 1.5 * s), -0.5 * t**2),
        (s, 3.0 * t - 2.0, 3.0 * s - 2.0, t),
    )
    return jnp.stack([jnp.stack(row) for row in rows])


def _half(y: jax.Array) -> jax.Array:
    """Integral of the B-spline from its middle to y in [0, 1]."""
    return y * (2.0 / 3.0 + y**2 * (0.125 * y - 1.0 / 3.0))


def _convolved(flat: jax.Array, share: jax.Array) -> jax.Array:
    """The same over all heights, at places from -below to nodes + 2 steps from the first.

    ``flat`` and ``share`` are one of each interface; ``share`` is asperities per area on a node.
    """
    rows = jnp.moveaxis(flat, 0, -2).reshape(-1, flat.shape[0], flat.shape[-1])
    found = jax.lax.conv_general_dilated(
        rows, share[None, :, ::-1], (1,), "VALID", precision=jax.lax.Precision.HIGHEST
    )
    return found.reshape(*flat.shape[1:-1], -1)


def _even_cells(found: jax.Array, step: jax.Array) -> jax.Array:
    """Coefficients on the even cells, as in :class:`BranchTable`."""
    above, value, slope, bend = found
    lifted = step * jnp.stack([above, -value, -slope])
    ends = jnp.stack([jnp.stack([value, slope, bend]), lifted])
    f0, d0, c0 = (ends[:, k, ..., :-1] for k in range(3))
    f1, d1, c1 = (ends[:, k, ..., 1:] for k in range(3))
    return jnp.moveaxis(quintic((f0, d0, c0), (f1, d1, c1)), -3, -2)


def _deep_cells(
    laws: Law, share: jax.Array, scale: tuple[jax.Array, jax.Array, jax.Array], start: jax.Array
) -> jax.Array:
    """Coefficients below the even cells, where all are bonded; ``start`` at the first of them.

    ``scale`` is the gap [m] of the lowest node there, the step [m] and the depth.
    """
    stand, weight = _standing(share.shape[1])
    first, step, depth = scale
    octaves = (np.arange(_DEEP)[:, None] + _AT) / _OCTAVE
    gap = first + step * (depth * (1.0 - 2.0**octaves)[..., None] - stand)

    def mean(each: tuple[Law, jax.Array]) -> jax.Array:
        law, share = each
        return _rows(law, gap) @ (share @ weight)

    values = jnp.sum(jax.lax.map(mean, (laws, share)), axis=0)
    rate = step * depth * np.log(2.0) / _OCTAVE * 2.0**octaves * values
    risen = rate @ _INTEGRALS.T
    whole = rate @ (0.5 * _WEIGHTS)
    before = jnp.cumsum(whole, axis=1) - whole
    both = jnp.broadcast_to(values, (2, *values.shape))
    lifted = start[1][..., None, None] + (before[..., None] + risen)
    powers = jnp.stack([both, lifted]) @ _TO_POWERS.T
    return jnp.moveaxis(powers, -3, -2)


def _standing(nodes: int) -> tuple[np.ndarray, np.ndarray]:
    """Heights, in steps from the first node, and how much of each node falls to each of them.

    Means of polynomials of a degree below their number are exact.
    """
    middle, half = 0.5 * (nodes - 1), 0.5 * (nodes + 3)
    within, share = kernel_rule()
    x = (np.arange(nodes)[:, None] + within - middle) / half
    basis = chebyshev.chebvander(x, _STAND - 1) @ from_points(_STAND)
    weight: np.ndarray = np.einsum("p,jpi->ji", share, basis)
    return middle + half * chebyshev.chebpts1(_STAND), weight
