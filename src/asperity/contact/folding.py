"""A rough body on a half-space so soft, or that adheres so strongly, that it jumps."""

from __future__ import annotations

import dataclasses
from math import pi
from typing import Any

import numpy as np

from .._jax import jax, jnp
from ..errors import SimulationError
from ..interface.rough_planes import Memory as Thresholds
from ..interface.rough_planes import RoughPlanes
from ..laws.law import Real, quantity
from ..numerics.trees import choose
from .contact import Potential, ReversalSampling, ScanningCurve, State
from .continuation import (
    ContinuationPath,
    RingMemory,
    first_size,
    with_table,
)
from .elastic import ElasticContact
from .equilibrium import RingEquilibrium, solve_equilibrium
from .folds import folds_of
from .landing import fit, settle
from .profile import Sphere
from .resolution import Resolution

_LADDER = 4.0 ** -np.arange(11.0)  # of rms heights: ends of panels ahead of a fold
_BESIDE = 1e-3  # rms heights beside a fold, where the mesh about it is found
_RINGS = 2  # times those of a case: the edge of a contact that adheres is sharp
_SOLVED = 1e-6  # relative force error of a scanning curve that has equilibria
_BELOW, _SEEN = 40.0, 161  # rms heights below the range within which planes are looked at
_DRAWN = 8  # steps to the depth to which adhesion draws a body
_SHORT = 0.25  # rms heights before a fold, where scanning curves end
_SOON, _LATER = 5, 27  # pieces of a scanning curve for each law
_PANELS = 4  # times those without folds


class FoldingContact(ElasticContact):
    """A rough sphere on a half-space whose equilibria fold.

    Each major branch has two sides: one is followed from outside in, until it folds and the body
    jumps into contact, and one from inside out, until it jumps out of contact.

    Parameters
    ----------
    folds, sizes
        Where each of the branches folds [m], NaN where it does not, and the size of the mesh
        there [m]; shape (branches,). The branches without and with all bonds from outside in, then
        from inside out.
    """

    folds: jax.Array = quantity()
    sizes: jax.Array = quantity()

    def __init__(
        self,
        interface: RoughPlanes,
        shape: Sphere,
        modulus: Real,
        rings: int,
        resolved: Resolution,
        folds: jax.Array,
        sizes: jax.Array,
        drawn: Real = 0.0,
    ) -> None:
        super().__init__(interface, shape, modulus, rings, resolved, drawn)
        self.folds, self.sizes = folds, sizes

    @property
    def sides(self) -> int:
        return 2

    @property
    def scale(self) -> jax.Array:
        return jnp.asarray(self.interface.scale.rms)

    @property
    def reversals(self) -> ReversalSampling | None:
        """Scanning curves are solved as they come."""
        return None

    def lower_bound(
        self, release: jax.Array, kinetic: jax.Array, potential: Potential
    ) -> jax.Array:
        """As without folds, with the work that the planes do on the area that adhesion draws in."""
        lowest = super().lower_bound(release, kinetic, potential)
        apart = jnp.linspace(-_BELOW, 0.0, _SEEN) * self.interface.scale.rms
        places = apart + self.interaction_range
        work = jnp.max(-self.interface.work_of_approach(places))
        stiff = self.modulus * jnp.sqrt(self.shape.radius)
        fall = jnp.maximum(kinetic + potential(release) - potential(lowest), 0.0)
        drawn = 2.0 * pi * self.shape.radius * jnp.maximum(work, 0.0)

        def deeper(_: int, depth: jax.Array) -> jax.Array:
            return (15.0 / 8.0 * (fall + drawn * depth) / stiff) ** 0.4

        begin = (15.0 / 8.0 * fall / stiff) ** 0.4 + (15.0 / 8.0 * drawn / stiff) ** (2.0 / 3.0)
        return lowest - 1.1 * jax.lax.fori_loop(0, _DRAWN, deeper, begin)

    def panels(self, low: jax.Array, high: jax.Array) -> jax.Array:
        """As without folds, and each fold twice, with panels that narrow to it."""
        usual = super().panels(low, high)
        outwards = np.arange(len(self.folds)) >= len(self.folds) // 2
        folds = jnp.where(jnp.isnan(self.folds), low, self.folds)
        steps = jnp.where(outwards, -1.0, 1.0)[:, None] * _LADDER * self.interface.scale.rms
        more = jnp.concatenate([folds, folds, (folds[:, None] + steps).ravel()])
        # Those beyond stand at the lower end, where all are as fine.
        more = jnp.where((more > low) & (more < high), more, low)
        return jnp.sort(jnp.concatenate([usual, more]))

    def curves(self, ends: jax.Array, places: jax.Array) -> State:
        memories = self.branches() * self.sides
        stacked = jax.tree_util.tree_map(lambda *leaves: jnp.stack(leaves), *memories)
        outwards = np.arange(len(memories)) >= len(memories) // 2
        jobs = stacked, self.folds, self.sizes, jnp.asarray(outwards)
        return jax.lax.map(lambda job: self._side(ends, places, *job), jobs)

    def _side(
        self,
        ends: jax.Array,
        places: jax.Array,
        memory: RingMemory,
        fold: jax.Array,
        size: jax.Array,
        outwards: jax.Array,
    ) -> State:
        """One side of a branch, in the direction of motion along it."""
        near = places.shape[0] - self.rigid.far
        corners, along = ends[: near + 1], places[:near].ravel()
        corners, along = (jnp.where(outwards, x, x[::-1]) for x in (corners, along))
        tabulated = with_table(self, jnp.min(corners), jnp.max(corners), memory.thresholds)
        frozen = jax.lax.stop_gradient((tabulated, corners, along, memory.thresholds, fold, size))
        sizes, rests = _followed(*frozen)
        states = tabulated._states(along, memory.thresholds, sizes, rests)
        inner = jax.tree_util.tree_map(
            lambda leaf: jnp.where(outwards, leaf, leaf[::-1]).reshape(
                near, places.shape[1], *leaf.shape[1:]
            ),
            states,
        )
        return self._with_far(inner, ends, places, memory)

    def _ahead(self, start: jax.Array, within: tuple[Any, Any]) -> tuple[Any, Any]:
        """The bounds [m] within which a scanning curve is followed: up to the next fold.

        There its rings have reached the branch, or nearly so.
        """
        short = _SHORT * self.interface.scale.rms
        inwards, outwards = self.folds[0] + short, self.folds[-1] - short
        low, high = within
        low = jnp.where(start > self.folds[0], jnp.maximum(low, jnp.minimum(inwards, start)), low)
        high = jnp.where(
            start < self.folds[-1], jnp.minimum(high, jnp.maximum(outwards, start)), high
        )
        return low, high

    def scanning_curve(
        self, memory: RingMemory, start: jax.Array, unloading: jax.Array, within: tuple[Any, Any]
    ) -> ScanningCurve | None:
        """As without folds; NaN where it has none, since it folds itself."""
        curve = super().scanning_curve(memory, start, unloading, self._ahead(start, within))
        if curve is None:
            return None
        solved = jnp.max(curve.states.error) < _SOLVED
        states = jax.tree_util.tree_map(lambda x: jnp.where(solved, x, jnp.nan), curve.states)
        return curve._replace(states=states)


def _coordinate(place: jax.Array, fold: jax.Array) -> jax.Array:
    """What rings that come to a fold change evenly with: the root of the distance to it."""
    apart = place - fold
    return jnp.where(jnp.isnan(fold), place, jnp.sign(apart) * jnp.sqrt(jnp.abs(apart)))


def _follow(
    contact: ElasticContact,
    places: jax.Array,
    sizes: jax.Array,
    thresholds: Thresholds,
    path: ContinuationPath,
    fold: jax.Array,
    ahead: jax.Array,
) -> RingEquilibrium:
    """Rings at ``places`` in the direction ``ahead``, which jump at a fold on the way."""
    rms = contact.interface.scale.rms

    def step(carry: tuple[ContinuationPath, jax.Array], now: tuple[Any, ...]) -> Any:
        (path, gone), (place, size) = carry, now
        beyond = ahead * (place - fold) >= 0.0
        jumps = beyond & ~gone
        # At the fold itself nothing moves.
        there = jnp.where(beyond & (place == fold), fold + ahead * _BESIDE * rms, place)
        x = _coordinate(place, fold)
        guess = jax.lax.cond(
            jumps,
            lambda: settle(contact, there, thresholds, size, path.displacements[0]),
            lambda: path.guess(x),
        )
        rest = solve_equilibrium(contact, there, thresholds, size, guess)
        flat = jnp.zeros_like(rest.displacement)
        anew = ContinuationPath.straight(x, rest.displacement, flat, ahead * rms)
        after = path.append(x, rest.displacement)
        after = choose(jumps, anew, after)
        return (after, gone | beyond), rest

    _, rests = jax.lax.scan(step, (path, jnp.asarray(False)), (places, sizes))
    return rests


def _followed(
    contact: ElasticContact,
    corners: jax.Array,
    along: jax.Array,
    thresholds: Thresholds,
    fold: jax.Array,
    fold_size: jax.Array,
) -> tuple[jax.Array, RingEquilibrium]:
    """Sizes of the mesh and rings along one side of a branch, in the direction of motion.

    As :func:`asperity.contact.continuation.continue_branch`, but for the jump.
    """
    ahead = jnp.where(corners[-1] > corners[0], 1.0, -1.0)
    rms, flat = contact.interface.scale.rms, jnp.zeros(contact.rings + 1)

    def size_at(carry: tuple[jax.Array, ...], now: tuple[jax.Array, jax.Array]) -> Any:
        (displacement, last_size, first), (corner, doubled) = carry, now
        at_fold = corner == fold
        before = at_fold & doubled  # of the two ends there, the one that is passed first
        there = corner + jnp.where(at_fold, jnp.where(before, -ahead, ahead) * _BESIDE * rms, 0.0)
        jumps = first | (at_fold & ~before)
        displacement = jax.lax.cond(
            jumps,
            lambda: settle(contact, there, thresholds, last_size, displacement),
            lambda: displacement,
        )
        size, displacement = fit(contact, there, thresholds, last_size, displacement)
        # Over an rms height the mesh becomes that on which the fold lies. Were it to change at
        # once, energies would differ there by the error of the rings.
        apart = ahead * (fold - corner)
        near = jnp.clip(1.0 - apart / rms, 0.0, 1.0)
        share = jnp.where(before | (apart > 0.0), near**2 * (3.0 - 2.0 * near), 0.0)
        held = jnp.where(share > 0.0, share * fold_size + (1.0 - share) * size, size)
        return (displacement, size, jnp.asarray(False)), held

    again = jnp.append(corners[1:] == corners[:-1], False)
    begin = flat, first_size(contact, corners[0]), jnp.asarray(True)
    _, at_corners = jax.lax.scan(size_at, begin, (corners, again))
    sizes = jnp.interp(ahead * along, ahead * corners, at_corners)
    first = settle(contact, along[0], thresholds, sizes[0], flat)
    path = ContinuationPath.straight(_coordinate(along[0], fold), first, flat, ahead * rms)
    return sizes, _follow(contact, along, sizes, thresholds, path, fold, ahead)


def folding(contact: ElasticContact, low: float) -> FoldingContact | None:
    """The contact with its folds; None where no branch folds.

    Parameters
    ----------
    contact
        A contact.
    low
        Separation [m] down to which folds are sought.

    Raises
    ------
    SimulationError
        If the rings do not resolve the edge of the contact: they jump one after the other.
    """
    finer = dataclasses.replace(contact, rings=_RINGS * contact.rings)
    found = folds_of(finer, low)
    number = np.asarray(found.number)
    if not np.any(number):
        return None
    if np.any(number > 1):
        raise SimulationError(
            "adhesion draws the rough surfaces together as one contact, at whose edge the pressure "
            f"changes over less than {finer.rings} rings resolve"
        )
    each = {f.name: getattr(finer, f.name) for f in dataclasses.fields(finer)}
    panels = _PANELS * finer.resolved.panels
    each["resolved"] = finer.resolved._replace(panels=panels, pieces=_SOON + _LATER, later=_LATER)
    return FoldingContact(**each, folds=found.place, sizes=found.size)
