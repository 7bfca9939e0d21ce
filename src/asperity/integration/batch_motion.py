"""Cases of one structure from their release to their end: the one loop that single runs share."""

from __future__ import annotations

import dataclasses
from collections.abc import Iterator
from typing import Any, NamedTuple, cast

import numpy as np

from .._jax import jax
from ..dynamics.record import IN_MOTION
from ..dynamics.release import TRIES, farther, negligible_force
from ..errors import InputError, SimulationError
from .batch_records import Batch, Begun, Checks, FirstImpact, ImpactRows, is_array, slices, taken
from .clock import Clock
from .steps import Steps

REFINEMENTS = (1, 2, 4, 8)
"""Times the panels, one after the other, until the curves meet the tolerance."""

RELEASE_KEY = "impact.release_separation"
"""The key of a release that lies inside contact."""

_GAIN = 0.9  # of the error is left by four times the panels: where more is, no more would help
_RESIDUAL = 1e-6  # relative force error of a contact that counts as solved


class Slice(NamedTuple):
    """Cases of a compiled call; places beyond the last are -1 and repeat it."""

    places: np.ndarray
    batch: Batch
    begun: Begun
    first: FirstImpact | None

    @property
    def size(self) -> int:
        """Number of cases."""
        return int(np.sum(self.places >= 0))


class BatchMotion:
    """The motions of cases of one structure.

    Parameters
    ----------
    batch
        The cases.
    tolerance
        Relative error allowed to each one's force curves [-], shape (cases,).
    steps
        The compiled steps.
    clock
        Its time, reports and stop.
    refinements
        As :data:`REFINEMENTS`, those that are tried.
    checked
        Whether the cases must be released outside contact.
    launched
        Whether speeds alone are given: the release lies as far out as the forces ask for.

    Attributes
    ----------
    made
        Number of impacts of each case, shape (cases,).
    factors
        Times the panels that each one's curves have, shape (cases,).
    failures
        Why a case failed, by its place.
    """

    def __init__(
        self,
        batch: Batch,
        tolerance: np.ndarray,
        steps: Steps,
        clock: Clock,
        *,
        refinements: tuple[int, ...] = REFINEMENTS,
        checked: bool = True,
        launched: bool = False,
    ) -> None:
        self.batch, self.steps, self.clock = batch, steps, clock
        self.made = np.zeros(tolerance.size, int)
        self.factors = np.ones(tolerance.size, int)
        self.failures: dict[int, Exception] = {}
        self._tolerance, self._refinements = tolerance, refinements
        self._checked, self._launched = checked, launched
        self._waiting = np.arange(tolerance.size)  # for curves that are fine enough
        self._errors = np.full((tolerance.size, 2), np.inf)  # of its last curves but one, its last
        self._tries = np.zeros(tolerance.size, int)
        self._rows: list[tuple[np.ndarray, np.ndarray, ImpactRows]] = []
        self._ends: list[np.ndarray] = []
        self._structure: Any = None

    def integrate(self) -> None:
        """Integrate all cases; `Stopped` is raised in between where the clock says so."""
        for factor in self._refinements:
            pool = [self._go_on(some) for some in self._at(factor, moving=True)]
            self._finish([some for some in pool if some is not None])

    def curves(self) -> Iterator[Slice]:
        """The cases at their release, with curves that hold; nothing else is compiled."""
        for factor in self._refinements:
            yield from self._at(factor, moving=False)

    def _at(self, factor: int, *, moving: bool) -> Iterator[Slice]:
        """Those that so many times the panels are fine enough for; the others wait."""
        places, self._waiting = self._waiting, self._waiting[:0]
        while places.size:
            again = [places[:0]]
            for some in slices(places, self.steps.width):
                contact = self.batch.contact
                contact = contact.refined(factor) if factor > 1 else contact
                here = taken(self.batch._replace(contact=contact), some)
                begun, checks = self._curves(here, moving=moving)
                last = factor == self._refinements[-1]
                some = np.where(self._are_fine(some, here, checks, last=last), some, -1)
                moved = self._move_out(some, here, checks)
                again.append(some[moved])
                some = np.where(moved, -1, some)
                some = np.where(self._are_outside(some, here, checks), some, -1)
                self.factors[some[some >= 0]] = factor
                if np.any(some >= 0):
                    yield Slice(some, here, begun, self.steps.before)
            places = np.concatenate(again)

    def _curves(self, here: Batch, *, moving: bool) -> tuple[Begun, Checks]:
        clock, steps = self.clock, self.steps
        clock.look()
        clock.report(0.02, "tracing")
        if moving and self._checked:  # what is launched runs programs that are compiled already
            steps.compile_ahead(here)
        call = clock.ready(0.04, "the force curves", steps.curves, here, steps.tabulated)
        clock.report(0.06, "force curves")
        answer: tuple[Begun, Checks] = clock.timed(call)
        return answer

    def _are_fine(
        self, places: np.ndarray, here: Batch, checks: Checks, *, last: bool
    ) -> np.ndarray:
        """Whether the curves of each case hold; others wait for more panels, or have failed."""
        error, residual = np.asarray(checks.error), np.asarray(checks.residual)
        real, tolerance = places >= 0, self._tolerance[places]
        fine = error <= np.maximum(tolerance, here.contact.resolved.error_floor)
        fails = last | (error > _GAIN * self._errors[places, 0])
        for slot in np.flatnonzero(real & ~fine & fails).tolist():
            self.failures[int(places[slot])] = SimulationError(
                f"force curves reach a relative error of {error[slot]:.1e}, "
                f"not `numerics.tolerance` = {tolerance[slot]:.1e}"
            )
        waits = real & ~fine & ~fails
        self._waiting = np.concatenate([self._waiting, places[waits]])
        self._errors[places[waits]] = np.stack([self._errors[places, 1], error], axis=1)[waits]
        solved = residual <= _RESIDUAL
        for slot in np.flatnonzero(real & fine & ~solved).tolist():
            self.failures[int(places[slot])] = SimulationError(
                "pressure and deformation do not agree: relative force error "
                f"{residual[slot]:.1e}. The contact has no equilibrium that follows "
                "from the one before (strong adhesion on soft bodies folds it)"
            )
        return np.asarray(real & fine & solved)

    def _move_out(self, places: np.ndarray, here: Batch, checks: Checks) -> np.ndarray:
        """Whether each case is begun anew, from a release further out, where none was given."""
        if not self._launched:
            return np.zeros(places.shape, bool)
        force, power, largest, load = (np.asarray(leaf) for leaf in checks.at_release)
        limit = negligible_force(load, largest, chosen=True)
        again = (force > limit) & (places >= 0) & (self._tries[places] < TRIES - 1)
        at = places[again]
        self._tries[at] += 1
        further = farther(np.asarray(here.body.release), force, power, limit)
        release = np.array(self.batch.body.release)
        release[at] = further[again]
        body = dataclasses.replace(self.batch.body, release=release)
        self.batch = self.batch._replace(body=body)
        return again

    def _are_outside(self, places: np.ndarray, here: Batch, checks: Checks) -> np.ndarray:
        """Whether each case is released outside contact; others have failed."""
        if not self._checked:
            return np.ones(places.shape, bool)
        held = bool(here.body.forces)
        force, _power, largest, load = (np.asarray(leaf) for leaf in checks.at_release)
        limit = negligible_force(load, largest, chosen=self._launched or held)
        inside, release = ~(force <= limit), np.asarray(here.body.release)
        for slot in np.flatnonzero(inside & (places >= 0)).tolist():
            share = "1e-3 of the weight" if load[slot] > 0.0 else "1e-6 of its peak"
            share = "1e-3 of the spring's force" if held else share
            self.failures[int(places[slot])] = InputError(
                "`release_separation` must lie outside contact: the contact force there must be "
                f"below {share} ({limit[slot]:.3g} N), and is {force[slot]:.3g} N; "
                f"got {release[slot] * 1e9:.6g} nm",
                key=RELEASE_KEY,
            )
        return ~inside

    def _finish(self, pool: list[Slice]) -> None:
        """Integrate what is left of several calls in fewer."""
        while pool:
            gathered: list[Slice] = []
            count = 0
            while pool and (not gathered or count + pool[-1].size <= self.steps.width):
                count += pool[-1].size
                gathered.append(pool.pop())
            left = self._go_on(_packed(gathered, self.steps.width), patient=not pool)
            if left is not None:
                pool.append(left)

    def _go_on(self, here: Slice, *, patient: bool = False) -> Slice | None:
        """Go on until half of the cases are at rest, or all; the others."""
        clock, steps = self.clock, self.steps
        while True:
            going = np.asarray(here.begun.progress.outcome) == IN_MOTION
            here = here._replace(places=np.where(going, here.places, -1))
            if here.size == 0:
                return None
            if here.size <= steps.width // 2 and not patient:
                return here
            clock.look()
            what = here.batch, here.begun, here.first, steps.together
            if self._rows:
                call = steps.impacts.ready(*what)
            else:
                call = clock.ready(0.08, "the impacts", steps.impacts, *what)
                clock.report(0.1, "motion")
            progress, first, rows = clock.timed(call)
            here = here._replace(begun=here.begun._replace(progress=progress), first=first)
            self._keep(here, rows)
            most, limit = int(self.made.max()), int(np.max(here.batch.limits.impacts))
            clock.report(0.1 + 0.75 * min(most / limit, 1.0), f"impact {most}")

    def _keep(self, here: Slice, rows: ImpactRows) -> None:
        """Write down the impacts of a call, and where it ended."""
        real = here.places >= 0
        at = here.places[real]
        made = np.asarray(rows.impacts.made)
        self.clock.count(np.where(real[:, None], made, False))
        made = made[real]
        row, column = np.nonzero(made)
        kept = jax.tree_util.tree_map(lambda leaf: np.asarray(leaf)[real][row, column], rows)
        self._rows.append((at[row], self.made[at][row] + column, kept))
        self.made[at] += made.sum(axis=1)
        begun, none = here.begun, cast("Any", None)
        if here.first is not None:  # of many cases the tables and memories are not kept
            progress = begun.progress._replace(memory=(), bonds=begun.progress.place)
            begun = begun._replace(table=none, progress=progress)
        leaves, self._structure = jax.tree_util.tree_flatten((begun, here.first))
        leaves = [np.asarray(leaf) for leaf in leaves]
        self._ends = self._ends or [
            np.zeros((self.made.size, *leaf.shape[1:]), leaf.dtype) for leaf in leaves
        ]
        for whole, leaf in zip(self._ends, leaves, strict=True):
            whole[at] = leaf[real]

    def ends(self) -> tuple[Begun, FirstImpact | None] | None:
        """Where all cases ended, zeros for those that failed; None where all did."""
        if not self._ends:
            return None
        found: tuple[Begun, FirstImpact | None]
        found = jax.tree_util.tree_unflatten(self._structure, self._ends)
        return found

    def history(self, size: int) -> ImpactRows | None:
        """All impacts, each array of shape (cases, size, ...); None where there is none."""
        if not self._rows:
            return None
        cases, columns, rows = zip(*self._rows, strict=True)
        case, column = np.concatenate(cases), np.concatenate(columns)

        def whole(*leaves: np.ndarray) -> np.ndarray:
            out = np.zeros((self.made.size, size, *leaves[0].shape[1:]), leaves[0].dtype)
            out[case, column] = np.concatenate(leaves)
            return out

        found: ImpactRows = jax.tree_util.tree_map(whole, *rows)
        return found


def _packed(parts: list[Slice], width: int) -> Slice:
    """The cases still in motion, side by side."""
    places = np.concatenate([part.places[part.places >= 0] for part in parts])
    index = np.append(np.arange(places.size), np.zeros(width - places.size, int))

    def packed(*leaves: Any) -> Any:
        if not is_array(leaves[0]):
            return leaves[0]
        kept = [np.asarray(x)[p.places >= 0] for x, p in zip(leaves, parts, strict=True)]
        return np.concatenate(kept)[index]

    tree = jax.tree_util.tree_map(packed, *(part[1:] for part in parts))
    filled = np.concatenate([places, np.full(width - places.size, -1, int)])
    return Slice(filled, *tree)
