"""Rings of a deforming contact along a path: each solution the first guess of the next."""

from __future__ import annotations

from typing import Any, NamedTuple, TypeVar

import equinox as eqx
import numpy as np

from .._jax import jax, jnp
from ..interface.branch_pressure import BranchPressure
from ..interface.rough_planes import Memory as Thresholds
from ..numerics.compilation import kept
from ..numerics.polynomials import points_between
from ..numerics.roots import fixed_point
from .equilibrium import (
    RingEquilibrium,
    asked_size,
    beyond,
    equilibrium_displacement,
    profile_of,
    rates,
    solve_equilibrium,
)
from .resolution import LATER, LINEAR, fills_by_contact
from .rough import DeformingContact
from .scanning_curve import by_mechanism, pieces_for, pieces_to

_BELOW = 5.0  # rms below the deepest separation, where the tables of means begin
_TO = 8.0  # times the outermost separation, where they end: rings lie as far apart
_FINER = 4  # panels of these tables for each of the curves
_MEASURED = 8  # times as many over measured heights, whose density is a cubic spline
_ABOUT = np.linspace(-8.0, 8.0, 12)  # rms, panels about the ends of bonds
_FIT = 0.02  # how closely the mesh fits the pressure
_PASSES = 12  # of that fit, at most
_TRAIL = 4  # places behind from which the next is guessed
_BENDS = 2.0  # rms heights: later pieces are even in asinh(separation / this)
_MORE = 1.02  # than the way at the first rate
_MUCH_MORE = 1.2  # where liquid fills the surface: the rate falls as the bulk springs back

Tabulated = TypeVar("Tabulated", bound=DeformingContact)


@kept
class RingMemory(NamedTuple):
    """Thresholds on the rings of a mesh of a given size.

    Attributes
    ----------
    thresholds
        One array a hysteretic law, shape (rings + 1,); the last belongs to the mesh's end.
    size
        Length [m] of the mesh; 0 where all thresholds are infinite and the mesh is free.
    displacement
        Displacement [m] of the rings at the last reversal, shape (rings + 1,).
    outer
        Whether that was on a major branch.
    """

    thresholds: Thresholds
    size: jax.Array
    displacement: jax.Array
    outer: jax.Array


class ContinuationPath(NamedTuple):
    """The last few places and displacements of the rings there, newest first."""

    places: jax.Array
    displacements: jax.Array

    @classmethod
    def straight(
        cls, place: jax.Array, displacement: jax.Array, rate: jax.Array, step: jax.Array | float
    ) -> ContinuationPath:
        """Rings that came by ``rate`` in steps of ``step`` [m]."""
        back = -step * np.arange(float(_TRAIL))
        return cls(place + back, displacement + back[:, None] * rate)

    def guess(self, place: jax.Array) -> jax.Array:
        """The polynomial through them, at a place further on."""
        one = np.eye(_TRAIL)
        apart = self.places[:, None] - self.places + one
        known = jnp.all(apart != 0.0)
        ratios = (place - self.places) * (1.0 - one) + one
        weights = jnp.prod(ratios / jnp.where(known, apart, 1.0), axis=1)
        return jnp.where(known, weights @ self.displacements, self.displacements[0])

    def append(self, place: jax.Array, displacement: jax.Array) -> ContinuationPath:
        """With one more, the oldest dropped."""
        return ContinuationPath(
            jnp.concatenate([place[None], self.places[:-1]]),
            jnp.concatenate([displacement[None], self.displacements[:-1]]),
        )


def first_size(contact: DeformingContact, separation: jax.Array) -> jax.Array:
    """Size of the mesh before anything is solved: light contact, and Hertz's radius."""
    sigma, radius = contact.interface.scale.rms, contact.shape.radius
    light = 3.0 * radius * sigma / (1.0 + jnp.maximum(separation / sigma, 0.0))
    return jnp.sqrt(light + radius * jnp.maximum(-separation, 0.0))


def _marks(
    contact: DeformingContact,
    memory: RingMemory,
    start: jax.Array,
    unloading: jax.Array,
    rates: jax.Array,
    within: tuple[Any, Any],
) -> jax.Array:
    """Ends of the pieces of the scanning curve, for each law.

    Even ones until the fastest ring has passed from one branch to the other, and later ones until
    the slowest has: even too, or, of a contact that names their number, even in asinh(separation)
    as forces change. Classes of radius share them, cut where the first and the last ring of each
    has passed.
    """
    slowest = jnp.clip(jnp.min(rates), 1e-3, 1.0)
    fastest = jnp.maximum(jnp.max(rates), slowest)
    pieces, graded = contact.resolved.pieces, contact.resolved.later > 0
    later = contact.resolved.later or min(max(pieces // 2, 1), LATER)
    more = _MUCH_MORE if fills_by_contact(contact.interface.hysteretic) else _MORE
    ends = jnp.stack([1.0 / fastest, more / slowest])
    ahead = jnp.where(unloading, 1.0, -1.0) * (memory.size > 0.0)
    scale = _BENDS * contact.interface.scale.rms

    def of_one(stretch: jax.Array, soon: int, later: int) -> jax.Array:
        width = ahead * stretch
        even, further = (np.arange(1.0, n + 1.0) / max(n, 1) for n in (soon, later))
        marks = start + width * jnp.append(even * ends[0], ends[0] + further * (ends[1] - ends[0]))
        if graded:
            begin, end = jnp.clip(start + width * ends, *within)
            to_end = jnp.linspace(jnp.arcsinh(begin / scale), jnp.arcsinh(end / scale), later + 1)
            steps = scale * jnp.sinh(to_end)[1:-1]
            # No piece is a rounding wide: where nothing is left, all end at one separation.
            steps = jnp.clip(steps, jnp.minimum(begin, end), jnp.maximum(begin, end))
            marks = jnp.concatenate([marks[:soon], steps, marks[-1:]])
        return marks

    bonds = contact.interface.hysteretic
    rows = []
    for widths in by_mechanism(
        bonds, [jnp.asarray(law.breaking_gap - law.forming_gap) for law in bonds]
    ):
        soon, further = (pieces_for(widths, number) for number in (pieces - later, later))
        rows.append(of_one(jnp.max(widths), soon, later if graded else further))
        if widths.size > 1:
            rows.append((start + ahead * widths[:, None] * ends).ravel())
    return jnp.concatenate(rows)


def fitted(
    contact: DeformingContact,
    place: jax.Array,
    thresholds: Thresholds,
    size: jax.Array,
    displacement: jax.Array,
    free: jax.Array,
) -> tuple[jax.Array, RingEquilibrium]:
    """The rings at one place, on a mesh whose size fits the pressure where it is ``free``."""
    fills = fills_by_contact(contact.interface.hysteretic)

    def again(now: tuple[Any, ...]) -> tuple[Any, jax.Array]:
        size, ratio, rest = now
        size = size * ratio
        rest = solve_equilibrium(contact, place, thresholds, size, rest.displacement)
        end = place + profile_of(contact, size)[-1]
        more = beyond(contact, size, end) if fills else 0.0
        asked = asked_size(rest, more)
        ratio = jnp.where(free, asked, 1.0)
        return (size, ratio, rest), jnp.abs(ratio - 1.0)

    blank = RingEquilibrium(displacement, jnp.zeros_like(displacement[:-1]), jnp.zeros(()))
    (size, _, rest), _ = fixed_point(again, (size, jnp.ones(()), blank), _FIT, _PASSES)
    return size, rest


def continue_branch(
    contact: DeformingContact, corners: jax.Array, places: jax.Array, thresholds: Thresholds
) -> tuple[jax.Array, RingEquilibrium]:
    """Sizes and rings at descending ``places`` within panels that end at ``corners``.

    The size of the mesh is found at the corners.
    """
    sigma, flat = contact.interface.scale.rms, jnp.zeros(contact.rings + 1)

    def fit(carry: tuple[jax.Array, jax.Array], place: jax.Array) -> Any:
        displacement, factor = carry
        light = first_size(contact, place)
        free = jnp.asarray(True)
        size, rest = fitted(contact, place, thresholds, light * factor, displacement, free)
        return (rest.displacement, size / light), size

    def step(path: ContinuationPath, place: jax.Array) -> Any:
        size = jnp.interp(place, corners[::-1], sizes[::-1])
        rest = solve_equilibrium(contact, place, thresholds, size, path.guess(place))
        return path.append(place, rest.displacement), (size, rest)

    _, sizes = jax.lax.scan(fit, (flat, jnp.ones(())), corners)
    above = ContinuationPath.straight(corners[0] + sigma, flat, flat, -sigma)
    _, found = jax.lax.scan(step, above, places)
    return found


def with_table(
    contact: Tabulated, low: jax.Array, high: jax.Array, thresholds: Thresholds
) -> Tabulated:
    """The contact with the means of a branch tabulated, for rings of a body between separations."""
    ends, memory = table_ends(contact, low, high), tuple(b[-1] for b in thresholds)
    table = BranchPressure(contact.interface, memory, ends)
    tabulated: Tabulated = eqx.tree_at(lambda one: one.interface, contact, table)
    return tabulated


def table_ends(contact: DeformingContact, low: jax.Array, high: jax.Array) -> jax.Array:
    """Ends of panels [m] on which means of the planes are smooth, for a body between separations.

    Polynomials on them are off by some 1e-13 of the largest value, over measured heights by 1e-8.
    """
    rms = contact.interface.scale.rms
    scale, low, high = LINEAR * rms, low - _BELOW * rms, _TO * high
    measured = contact.interface.panel_lengths.error_floor > 0.0
    count = _FINER * contact.resolved.panels * (_MEASURED if measured else 1)
    even = jnp.linspace(jnp.arcsinh(low / scale), jnp.arcsinh(high / scale), count + 1)
    even = scale * jnp.sinh(even)
    bonds = contact.interface.hysteretic
    gaps = [jnp.asarray(end, float) for law in bonds for end in (law.forming_gap, law.breaking_gap)]
    marks = jnp.asarray(gaps)[:, None] + _ABOUT * rms
    # Those outside stand twice within, where no panel of no width is read.
    marks = jnp.where((marks > low) & (marks < high), marks, even[count // 2]).ravel()
    return jax.lax.stop_gradient(jnp.sort(jnp.concatenate([even, marks])))


def continue_scanning_curve(
    contact: DeformingContact,
    memory: RingMemory,
    start: jax.Array,
    size: jax.Array,
    unloading: jax.Array,
    within: tuple[Any, Any],
) -> tuple[jax.Array, jax.Array, jax.Array, RingEquilibrium]:
    """Pieces of the scanning curve, separations on them and the rings there, from the start on.

    Pieces are cut where rings reach the branch.
    """
    steps = points_between(contact.resolved.nodes)
    sigma = contact.interface.scale.rms
    held = memory.thresholds, size
    pace = rates(contact, start, *held, memory.displacement)
    marks = _marks(contact, memory, start, unloading, pace, within)
    enter, leave = pieces_to(marks, start, unloading, within)
    back = jnp.where(unloading, sigma, -sigma) * 1e-2
    path = ContinuationPath.straight(start, memory.displacement, pace - 1.0, back)

    def step(path: ContinuationPath, place: jax.Array) -> Any:
        rest = solve_equilibrium(contact, place, *held, path.guess(place))
        return path.append(place, rest.displacement), rest

    places = enter[:, None] + (leave - enter)[:, None] * jnp.asarray(steps)
    _, found = jax.lax.scan(step, path, places.ravel())
    rests = jax.tree_util.tree_map(lambda leaf: leaf.reshape(*places.shape, *leaf.shape[1:]), found)
    return enter, leave, places, rests


def with_derivatives(
    contact: DeformingContact,
    separation: jax.Array,
    thresholds: Thresholds,
    size: jax.Array,
    rest: RingEquilibrium,
) -> RingEquilibrium:
    """Rings in equilibrium, with the derivatives of where they lie."""
    held = jax.lax.stop_gradient((size, rest.displacement))
    displacement = equilibrium_displacement(contact, separation, thresholds, *held)
    return rest._replace(displacement=displacement)
