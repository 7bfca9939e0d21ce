"""Heights as they were measured: no distribution is assumed."""

from __future__ import annotations

from functools import partial
from typing import Any, ClassVar, NamedTuple

import equinox as eqx
import numpy as np
from scipy.special import binom

from ..._jax import jax, jnp
from ...laws.law import Powers, Real, quantity
from ...numerics.height_integrals import order_ratio
from ...numerics.polynomials import quintic
from ...numerics.splines import kernel_rule, kernels
from .distribution import Heights
from .panel_length import MEASURED_FLOOR, PanelLengths, fineness_of

SIZES = (0.0, 0.5, 1.0)
"""Powers of the tip radius by which means are weighted."""

_KEPT = (-1.0, 0.0, 1.0, 1.5, 2.0, 2.5, 3.0, 3.5)
"""Orders that are tabulated: of Hertz's law, of steps and of parabolas, integrated once."""

_NARROW = 0.4
"""Distance of the nodes, in rms times the number of heights to the power -1/5."""

_FINE = PanelLengths(0.45, (0.05, 0.1, 0.45, 0.6), MEASURED_FLOOR)
"""What most measured heights need."""

_MARGIN = 4  # nodes above the highest and below the lowest
_MOMENTS = 24  # of the series below the nodes, where it falls by at least 1/3 a term


class Spread(NamedTuple):
    """How measured heights are laid on nodes.

    Attributes
    ----------
    first
        Lowest node [m].
    step
        Distance of the nodes [m].
    nodes
        Their number (static).
    panel_lengths
        How finely the curves are cut (static): by default enough for most heights, not for heaps
        of them; :func:`spread_of` finds it by trial.
    """

    first: float
    step: float
    nodes: int
    panel_lengths: PanelLengths = _FINE


class Sampled(Heights):
    """Measured heights, each spread over a narrow kernel, with the tip radius of each.

    Parameters
    ----------
    heights
        Heights of the summits [m], shape (summits,).
    radii
        Their tip radii [m], likewise.
    radius
        Tip radius [m] of the law that they are given to: a law that grows with a power of the
        radius is weighted by that power of ``radii / radius``, summit by summit.
    spread
        Nodes that carry the heights; by default :func:`spread_of` them.

    Notes
    -----
    The density is a cubic spline on even nodes: a mean of cubic B-splines about the heights,
    about 0.8 steps wide (rms). Its variance is taken back by drawing the heights together, so
    that mean and rms are theirs exactly. Integrals over the density are exact at the nodes, and
    quintic between. Compiles under ``jit`` and has derivatives in heights and radii if the
    ``spread`` is given.
    """

    cuts: ClassVar[int] = 5

    share: jax.Array
    tables: jax.Array
    moments: jax.Array
    longest_panels: PanelLengths = eqx.field(static=True)
    first: Real = quantity()
    step: Real = quantity()
    mean: Real = quantity()
    deviation: Real = quantity()

    def __init__(
        self, heights: Real, radii: Real, radius: Real, spread: Spread | None = None
    ) -> None:
        on = spread or spread_of(np.asarray(heights))
        self.first, self.step = (jnp.asarray(x, jnp.float64) for x in (on.first, on.step))
        self.longest_panels = on.panel_lengths
        # In lengths of powers of two, so that few of them are compiled, and padding never.
        traced = any(isinstance(x, jax.Array) for x in (heights, radii, radius))
        on_host: Any = jnp if traced else np
        values, ratios = on_host.asarray(heights), on_host.asarray(radii) / radius
        count = values.size
        rest = (0, (1 << (count - 1).bit_length()) - count)
        counts = np.pad(np.full(count, 1.0 / count), rest)
        values, ratios = (on_host.pad(x, rest, mode="edge") for x in (values, ratios))
        laid = _laid((values, ratios, counts), self.first, self.step, on.nodes)
        self.mean, self.deviation, self.share = laid
        self.tables, self.moments = _tabulated(self.share, self.step, kernels(on.nodes, _KEPT))

    @property
    def panel_lengths(self) -> PanelLengths:
        return self.longest_panels

    @property
    def rms(self) -> jax.Array | float:
        return self.deviation

    @property
    def nodes(self) -> int:
        """Number of nodes that carry the heights."""
        return self.share.shape[-1]

    @property
    def top(self) -> jax.Array:
        return self.first + (self.nodes + 1) * self.step

    @property
    def bottom(self) -> jax.Array:
        return self.first - 2.0 * self.step

    def highest_beside(self, height: jax.Array) -> jax.Array:
        return jnp.maximum(self.top, height)

    def tail(self, order: int, height: jax.Array, size: float = 0.0) -> jax.Array:
        scale = order_ratio(0.0, order - 1) if order else 1.0
        return scale * self._integrals((order - 1.0,), (size,), height[None])[0]

    def mean_powers(
        self,
        terms: Powers,
        order: int,
        separation: jax.Array,
        sizes: tuple[float, ...] | None = None,
    ) -> jax.Array:
        places = jnp.stack([jnp.broadcast_to(separation - t.edge, separation.shape) for t in terms])
        orders = tuple(t.exponent + order for t in terms)
        values = self._integrals(orders, sizes or (0.0,) * len(terms), places)
        factors = [t.coefficient * order_ratio(t.exponent, order) for t in terms]
        return jnp.stack([c * v for c, v in zip(factors, values, strict=True)])

    def _integrals(
        self, orders: tuple[float, ...], sizes: tuple[float, ...], places: jax.Array
    ) -> jax.Array:
        """Means of (z - place)^order over the heights z above it, one row an order.

        Evaluated together: one body of code to compile.
        """
        kinds = [SIZES.index(size) for size in sizes]
        others = tuple(sorted({order for order in orders if order not in _KEPT}))
        tables = self.tables
        if others:
            pairs = zip(others, kernels(self.nodes, others), strict=True)
            more = [_cells(self.share, self.step, order, each) for order, each in pairs]
            tables = jnp.concatenate([tables, jnp.stack(more)])
        number = [(*_KEPT, *others).index(order) for order in orders]
        shape = (len(orders),) + (1,) * (places.ndim - 1)
        row = np.reshape(
            [n * len(SIZES) + kind for n, kind in zip(number, kinds, strict=True)], shape
        )
        x = (places - self.first) / self.step + self.nodes
        inside = self._quintic(tables.reshape(-1, tables.shape[-1]), row, x)
        below = x < 0.0
        depth = jnp.where(below, 1.5 * self.nodes - x, 2.0 * self.nodes)
        beneath = [
            self._beneath(n, self.moments[kind], depth[k])
            for k, (n, kind) in enumerate(zip(orders, kinds, strict=True))
        ]
        return jnp.where(below, jnp.stack(beneath), inside)

    def _beneath(self, order: float, moments: jax.Array, depth: jax.Array) -> jax.Array:
        """Integral of one order from so many steps below the middle of the nodes."""
        if order < 0.0:  # of the density nothing lies there
            return jnp.zeros_like(depth)
        # A series in the moments of the others, which ends where the order is whole.
        count = _MOMENTS if order % 1.0 else int(order)
        ratio, series = self.nodes / depth, jnp.zeros_like(depth)
        for k in range(count, -1, -1):
            series = series * ratio + binom(order, k) * moments[k]
        below = depth * self.step
        root = jnp.sqrt(below) if order % 1.0 else 1.0
        return below ** int(order) * root * series

    def _quintic(self, cells: jax.Array, row: np.ndarray, x: jax.Array) -> jax.Array:
        """Polynomials of the cells in which ``x`` lies, 0 above all of them."""
        count = 2 * self.nodes + 2
        cell = jnp.clip(jnp.floor(x), 0, count - 1)
        found = cells.at[row * count + cell.astype(int)].get(mode="promise_in_bounds")
        t = x - cell
        value = found[..., -1]
        for k in range(cells.shape[1] - 2, -1, -1):
            value = value * t + found[..., k]
        return jnp.where(t <= 1.0, value, 0.0)


def spread_of(heights: np.ndarray) -> Spread:
    """Nodes for measured heights [m]: the closer, the more there are."""
    values = np.asarray(heights, dtype=float)
    low, high = float(values.min()), float(values.max())
    step = _NARROW * float(values.std()) * values.size**-0.2
    wanted = int(np.clip((high - low) / step if step > 0.0 else 1, 32, 1024 - 2 * _MARGIN))
    nodes = -(-(wanted + 2 * _MARGIN) // 32) * 32
    step = max((high - low) / (nodes - 1 - 2 * _MARGIN), 1e-6 * abs(high), 1e-18)
    first = low - _MARGIN * step
    counts = np.bincount(np.rint((values - first) / step).astype(int), minlength=nodes)
    share = np.convolve(counts, (1.0 / 6.0, 2.0 / 3.0, 1.0 / 6.0), mode="same")
    return Spread(first, step, nodes, fineness_of(share, float(values.std()) / step))


@partial(jax.jit, static_argnums=3)
def _laid(
    summits: tuple[jax.Array, jax.Array, jax.Array], first: jax.Array, step: jax.Array, nodes: int
) -> tuple[jax.Array, jax.Array, jax.Array]:
    """Mean and rms of heights, and their share at each node, shape (SIZES, nodes).

    ``summits`` are heights, radii over the law's, and the share of each.
    """
    heights, ratios, counts = summits
    mean = counts @ heights
    variance = counts @ (heights - mean) ** 2
    # Laying on and reading off widen the variance by step^2/3 each.
    narrowed = jnp.maximum(variance - 2.0 / 3.0 * step**2, 0.0)
    drawn = mean + (heights - mean) * jnp.sqrt(narrowed / jnp.where(variance > 0.0, variance, 1.0))
    x = (drawn - first) / step
    cell = jnp.clip(jnp.floor(x), 1, nodes - 3)
    t = x - cell
    parts = ((1 - t) ** 3, 3 * t**3 - 6 * t**2 + 4, -3 * t**3 + 3 * t**2 + 3 * t + 1, t**3)
    index = cell.astype(int)
    sized = jnp.stack([ratios**size for size in SIZES]) * counts / 6.0
    share = jnp.zeros((len(SIZES), nodes))
    for k, part in enumerate(parts):
        share = share.at[:, index + k - 1].add(sized * part)
    return mean, jnp.sqrt(variance), share


@jax.jit
def _tabulated(
    share: jax.Array, step: jax.Array, kernels: jax.Array
) -> tuple[jax.Array, jax.Array]:
    """Polynomials of all kept orders, (orders, sizes, cells, 6), and moments about the middle."""
    # One after the other: a matrix a kernel, and one body of code to compile.
    tables = jax.lax.map(lambda each: _cells(share, step, *each), (np.array(_KEPT), kernels))
    nodes = share.shape[1]
    # Five places stand for the kernel: all its moments below the tenth.
    within, weight = kernel_rule()
    place = (np.arange(nodes)[:, None] + within - 0.5 * nodes) / nodes
    powers = np.stack([np.sum(weight * place**k, axis=1) for k in range(_MOMENTS + 1)])
    return tables, share @ powers.T


def _cells(
    share: jax.Array, step: jax.Array, order: float | jax.Array, kernels: jax.Array
) -> jax.Array:
    """Taylor coefficients of the integral of one order on each cell, (sizes, cells, 6)."""
    value, slope, bend = jax.lax.map(lambda kernel: _at_nodes(share, kernel), kernels)
    f0, d0, c0 = (x[:, :-1] for x in (value, slope, bend))
    f1, d1, c1 = (x[:, 1:] for x in (value, slope, bend))
    return step**order * quintic((f0, d0, c0), (f1, d1, c1))


def _at_nodes(share: jax.Array, kernel: jax.Array) -> jax.Array:
    """Integral of one kernel at places from far below the nodes to above them."""
    nodes = share.shape[1]
    place = jnp.arange(-nodes, nodes + 3)
    return share @ kernel[jnp.arange(nodes)[:, None] - place + nodes + 2]
