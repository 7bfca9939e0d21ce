"""Energies of one asperity, tabulated: they are read some thousand times for every impact."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from .._jax import jax, jnp
from ..laws.law import Law, Real, as_float64, terms
from ..laws.plastic import PlasticContact
from ..numerics.compilation import AT_ONCE, Program, kept
from ..numerics.polynomials import points_between
from ..numerics.trees import stacked
from .asperity_work import Along, work_on_branches, work_with_contact
from .smooth import kinks_of

_CELLS = 512  # between two gaps at which a law is not smooth
_POINTS = points_between(4)
_TO_POWERS = np.linalg.inv(np.vander(_POINTS, increasing=True)).T
_OTHERS = 4096  # asperities that may attract one, with all that each has to give
_BEYOND = 1.01  # times where forces end: there, the table ends with none
_AT_CONTACT = 1e-13  # of the shortest length of a law: a gap at which summits still touch
_EMPTY = 1e-9  # y: a segment between two gaps that are one
_LADDER = -1e-15 * 2.0 ** np.arange(0.0, 80.0)  # m, down to where a gap needs the largest energy

APPROACH, AGAIN = -1, -2
"""Branches of an asperity that comes from far away: the first time, and where tips yield again."""


@kept
class Asperities(NamedTuple):
    """Asperities of some classes of tip radius, and their energies as cubics on cells of the gap.

    Cells are even in y, |gap|/scale = exp |y| - 1 with the sign of the gap; their ends are gaps at
    which a law is not smooth. An energy holds what was lost on the way: at any gap it is the work
    done since the asperity was far away.

    Attributes
    ----------
    size_class
        Class of each, shape (n,).
    scale
        Length [m] below which cells are even in the gap itself, shape (n,).
    borders
        y at both ends and where a law is not smooth, ascending, shape (borders, n).
    rates
        Cells over y from each of these to the next, shape (borders - 1, n).
    energy, slope
        Energy [J] and its slope with the gap [N], shape (classes, branches, cells, 4): coefficients
        of powers of the share of a cell. There is a branch for each set of laws whose bond is
        formed, and the last is approach, on which each forms in its turn. Where tips yield, all
        but the last are of the laws beside contact, and the last but one is their approach.
    forming, breaking
        Gaps [m] at which the bond of each hysteretic law forms and breaks, shape (laws, n).
    lost
        Energy [J] that each loses once made and broken, shape (laws, n).
    pull_off_gap
        Gap [m] of the largest tension of an asperity with all bonds, shape (n,).
    approach_range
        Gap [m] beyond which an asperity that never touched feels nothing, shape (n,).
    """

    size_class: jax.Array
    scale: jax.Array
    borders: jax.Array
    rates: jax.Array
    energy: jax.Array
    slope: jax.Array
    forming: jax.Array
    breaking: jax.Array
    lost: jax.Array
    pull_off_gap: jax.Array
    approach_range: jax.Array

    def of(self, size_class: jax.Array) -> Asperities:
        """From one of each class, in their order: asperities of some classes, shape (n,)."""
        shared = {"energy": self.energy, "slope": self.slope}
        rest = self._asdict().keys() - shared.keys()
        return Asperities(**{name: getattr(self, name)[..., size_class] for name in rest}, **shared)

    @property
    def interaction_range(self) -> jax.Array:
        """Gap [m] beyond which each feels nothing, shape (n,)."""
        return self.gap_of_border(-1)

    def gap_of_border(self, number: int) -> jax.Array:
        """Gap [m] of a border of the segments: 0 for the lowest of the table, shape (n,)."""
        return self.scale * _stretched(self.borders[number])

    @property
    def cells(self) -> int:
        """Number of cells. Without values."""
        return self.energy.shape[2]

    def gaps_of_first(self, cells: np.ndarray) -> jax.Array:
        """Gap [m] of the first at a number of cells from the lowest on, shape (m,)."""
        borders = self.borders[:, 0]
        widths = jnp.diff(borders)
        shares = np.clip(cells[:, None] / _CELLS - np.arange(widths.size), 0.0, 1.0)
        return self.scale[0] * _stretched(borders[0] + shares @ widths)

    def between(
        self, start: jax.Array, end: jax.Array, origin: jax.Array, shares: np.ndarray
    ) -> jax.Array:
        """Separations [m] from one to another, spaced as the cells of the first about an origin."""
        scale = self.scale[0]
        low, high = (_even((position - origin) / scale) for position in (start, end))
        return origin + scale * _stretched(low + (high - low) * shares)

    def branch(self, gap: jax.Array) -> jax.Array:
        """Branch of each that came to a gap [m] and leaves again, shape (n,)."""
        formed = gap <= self.forming
        return jnp.tensordot(2 ** np.arange(formed.shape[0]), formed, axes=1)

    def work(self, gap: jax.Array, branch: jax.Array | int = APPROACH) -> jax.Array:
        """Work [J] of each from far away to a gap [m], shape (n,)."""
        return _work(self, gap, jnp.asarray(branch))

    def step_at_contact(self) -> jax.Array:
        """By how much the force of each rises where contact ends [N], with all bonds, shape (n,).

        What DMT's attraction pulls with; 0 of laws whose force goes on beyond contact.
        """
        bonded = jnp.asarray(2 ** self.forming.shape[0] - 1)
        touching = -_AT_CONTACT * self.scale
        apart = jnp.zeros_like(touching)
        return self.response(touching, bonded)[1] - self.response(apart, bonded)[1]

    def response(self, gap: jax.Array, branch: jax.Array) -> tuple[jax.Array, jax.Array, jax.Array]:
        """Work [J] of each to a gap [m], its slope [N] and the slope of that [N/m], shape (n,)."""
        cell, share = _cell(self, gap)
        at = (self.size_class, branch, cell)
        powers = self.slope[at]
        rate = self.rates[cell // _CELLS, np.arange(gap.shape[0])]
        curvature = powers[:, 1] + share * (2.0 * powers[:, 2] + share * 3.0 * powers[:, 3])
        curvature = curvature * rate / (self.scale + jnp.abs(gap))
        return _read(self.energy, *at, share), _read(self.slope, *at, share), curvature


def _stretched(y: jax.Array) -> jax.Array:
    return jnp.sign(y) * jnp.expm1(jnp.abs(y))


def _even(gap: jax.Array) -> jax.Array:
    """The inverse."""
    return jnp.sign(gap) * jnp.log1p(jnp.abs(gap))


@jax.custom_jvp
def _work(some: Asperities, gap: jax.Array, branch: jax.Array) -> jax.Array:
    return _read(some.energy, some.size_class, branch, *_cell(some, gap))


@_work.defjvp
def _work_jvp(primals: Any, tangents: Any) -> tuple[jax.Array, jax.Array]:
    """With respect to the gap alone."""
    some, gap, branch = primals
    at = (some.size_class, branch, *_cell(some, gap))
    return _read(some.energy, *at), _read(some.slope, *at) * tangents[1]


def _cell(some: Asperities, gap: jax.Array) -> tuple[jax.Array, jax.Array]:
    """Cell of a gap, and the share of it that lies below."""
    position, number = _even(gap / some.scale), jnp.zeros_like(gap)
    for low, rate in zip(some.borders, some.rates, strict=False):
        number = number + jnp.clip((position - low) * rate, 0.0, _CELLS)
    cell = jnp.clip(number.astype(jnp.int32), 0, some.cells - 1)
    return cell, number - cell


def _read(
    values: jax.Array, size_class: jax.Array, branch: jax.Array, cell: jax.Array, share: jax.Array
) -> jax.Array:
    powers = values[size_class, branch, cell]
    value = powers[..., 3]
    for k in (2, 1, 0):
        value = value * share + powers[..., k]
    return value


def _segments(
    law: Law, contact: PlasticContact | None, low: jax.Array
) -> tuple[jax.Array, jax.Array]:
    """Scale of a table from a gap ``low`` on, and the borders of its segments."""
    every, kinks = terms(law), kinks_of(law)
    if contact is not None:
        kinks = jnp.append(kinks, -jnp.stack(contact.kinks))
    sizes = jnp.stack([*jnp.abs(kinks), *(jnp.asarray(one.length, float) for one in every)])
    shortest = jnp.min(jnp.where((sizes > 0.0) & jnp.isfinite(sizes), sizes, jnp.inf))
    scale = jnp.minimum(shortest, -1e-3 * low)
    ranges = [jnp.asarray(one.interaction_range, float) for one in every]
    interaction_range = _BEYOND * jnp.max(jnp.stack([scale, jnp.max(kinks), *ranges]))
    outer = jnp.stack([low, interaction_range])
    gaps = jnp.sort(jnp.concatenate([jnp.clip(kinks, *outer), outer]))
    return scale, _even(gaps / scale)


def _table_of(
    size_class: jax.Array, law: Law, contact: PlasticContact | None, energy: jax.Array
) -> Asperities:
    """The table of a law, down to a gap that needs more energy [J] than a body and others give.

    The law is beside the ``contact`` where tips yield.
    """
    hysteretic, branches = (
        [one for one in terms(law) if one.hysteretic],
        work_on_branches(law, contact),
    )
    ladder = jnp.asarray(_LADDER)
    needed = branches[APPROACH](ladder)
    low = ladder[jnp.argmax(needed > energy - _OTHERS * jnp.minimum(jnp.min(needed), 0.0))]
    scale, borders = _segments(law, contact, low)
    widths = jnp.diff(borders)
    steps = np.arange(_CELLS)[:, None] + _POINTS
    positions = borders[:-1, None, None] + (widths / _CELLS)[:, None, None] * steps
    gap = scale * _stretched(positions).reshape(-1, _POINTS.size)

    def fitted(branch: Along) -> jax.Array:
        return jnp.stack(jax.jvp(branch, (gap,), (jnp.ones_like(gap),))) @ _TO_POWERS

    def each(values: list[Real]) -> jax.Array:
        return jnp.stack([jnp.asarray(x, float) for x in values]) if values else jnp.zeros(0)

    def range_on_approach(slope: jax.Array) -> jax.Array:
        """The end of the last segment in which there is a force, or the last gap of a bond."""
        felt = jnp.any(slope.reshape(-1, _CELLS * _POINTS.size) != 0.0, axis=1)
        end = jnp.max(jnp.where(felt, borders[1:], borders[0]))
        gaps = each([one.forming_gap for one in hysteretic])
        return jnp.max(gaps, initial=scale * _stretched(end))

    bonded = branches[2 ** len(hysteretic) - 1]
    tension = jax.grad(lambda x: jnp.sum(work_with_contact(bonded, contact)(x)))(gap)
    energy, slope = jnp.stack([fitted(branch) for branch in branches], axis=1)
    return Asperities(
        size_class,
        scale,
        borders,
        _CELLS / jnp.maximum(widths, _EMPTY),
        energy,
        slope,
        each([one.forming_gap for one in hysteretic]),
        each([one.breaking_gap for one in hysteretic]),
        each([jnp.sum(one.losses, axis=0) for one in hysteretic]),
        gap.ravel()[jnp.argmax(tension)],
        range_on_approach(slope[-1]),
    )


_class_axes: Any = Asperities(*[-1] * len(Asperities._fields))  # type: ignore[arg-type]
_tables = Program(
    jax.vmap(_table_of, (0, 0, 0, None), _class_axes._replace(energy=0, slope=0)), AT_ONCE
)


def asperity_table(
    laws: Sequence[Law], energy: float, contacts: Sequence[PlasticContact] = ()
) -> Asperities:
    """One asperity of each class, by its laws.

    Parameters
    ----------
    laws
        The laws of each class, alike but for their values.
    energy
        Energy [J] that no body comes with.
    contacts
        The contact of a tip of each class, where tips yield; the laws are then those beside it.
    """
    beside = stacked(contacts) if contacts else None
    return _tables(jnp.arange(len(laws)), stacked(laws), beside, as_float64(energy))
