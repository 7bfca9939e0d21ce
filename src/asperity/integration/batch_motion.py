"""Cases of one structure from their release to their end: the one loop that single runs share."""

from __future__ import annotations

import dataclasses
from collections.abc import Iterator
from typing import Any, cast

import numpy as np

from .._jax import jax
from ..dynamics.record import IN_MOTION, Begun
from ..dynamics.release import TRIES, farther, negligible_force
from ..errors import InputError
from .batch_records import (
    Batch,
    Checks,
    FirstImpact,
    ImpactRows,
    Slice,
    packed,
    slices,
    taken,
)
from .clock import Clock
from .panel_cuts import PATIENCE, RESIDUAL, CutPanels, curve_failure
from .steps import Steps

RELEASE_KEY = "impact.release_separation"
"""The key of a release that lies inside contact."""

_FAR_WITHIN = 10.0  # times the force allowed at a release: coarse curves are closer than that


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
    finer
        Whether curves that miss the tolerance are cut further. That is compiled anew.
    checked
        Whether the cases must be released outside contact.
    launched
        Whether speeds alone are given: the release lies as far out as the forces ask for.
    patience
        As :data:`~asperity.integration.panel_cuts.PATIENCE`.

    Attributes
    ----------
    made
        Number of impacts of each case, shape (cases,).
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
        finer: bool = True,
        checked: bool = True,
        launched: bool = False,
        patience: int = PATIENCE,
    ) -> None:
        self.batch, self.steps, self.clock = batch, steps, clock
        self.made = np.zeros(tolerance.size, int)
        self.failures: dict[int, Exception] = {}
        self._tolerance = tolerance
        self._refinements = steps.refinements if finer else steps.refinements[:1]
        self._checked, self._launched, self._patience = checked, launched, patience
        self._waiting = np.arange(tolerance.size)  # for curves that are fine enough
        self._panels = [CutPanels()] * tolerance.size
        self._tries = np.zeros(tolerance.size, int)
        self._rows: list[tuple[np.ndarray, np.ndarray, ImpactRows]] = []
        self._ends: list[np.ndarray] = []
        self._structure: Any = None

    def integrate(self, begun: Slice | None = None) -> None:
        """Integrate all cases; `Stopped` is raised in between where the clock says so.

        From their release, with curves that are computed first unless they are given.
        """
        if begun is not None:
            self._finish([begun])
            return
        for factor in self._refinements:
            pool = [self._go_on(some) for some in self._at(factor, moving=True)]
            self._finish([some for some in pool if some is not None])

    def curves(self) -> Iterator[Slice]:
        """The cases at their release, with curves that hold; nothing else is compiled."""
        for factor in self._refinements:
            yield from self._at(factor, moving=False)

    def _at(self, factor: int, *, moving: bool) -> Iterator[Slice]:
        """Those that so many times the panels are fine enough for; the others wait."""
        most = self._most_cuts(factor)
        fits = np.array([self._panels[place].cuts.size <= most for place in self._waiting], bool)
        places, self._waiting = self._waiting[fits], self._waiting[~fits]
        while places.size:
            again = [places[:0]]
            for some in slices(places, self.steps.width):
                here = taken(self.batch, some)
                # Most that are cut further are cut again: their impacts wait for curves that hold.
                begun, checks = self._curves(
                    here, self._cuts(some, factor), moving=moving and factor == self._refinements[0]
                )
                moved = self._move_out(some, here, checks)
                again.append(some[moved])
                some = np.where(moved, -1, some)
                # Far within contact a release is refused before curves are cut further.
                some = np.where(self._are_outside(some, here, checks, _FAR_WITHIN), some, -1)
                fine, cut = self._are_fine(some, here, checks, factor)
                again.append(some[cut])
                some = np.where(fine, some, -1)
                some = np.where(self._are_outside(some, here, checks), some, -1)
                if np.any(some >= 0):
                    yield Slice(some, here, begun, self.steps.before)
            places = np.concatenate(again)

    def _curves(self, here: Batch, cuts: np.ndarray, *, moving: bool) -> tuple[Begun, Checks]:
        clock, steps = self.clock, self.steps
        clock.look()
        clock.report(0.02, "tracing")
        if moving and self._checked:  # what is launched runs programs that are compiled already
            steps.compile_ahead(here, cuts)
        call = clock.ready(0.04, "the force curves", steps.curves, here, cuts, steps.tabulated)
        clock.report(0.06, "force curves")
        answer: tuple[Begun, Checks] = clock.timed(call)
        return answer

    def _cuts(self, places: np.ndarray, factor: int) -> np.ndarray:
        """Where the panels of cases are cut, as often as ``factor`` times their number allows."""
        count, cases = self._most_cuts(factor), np.where(places < 0, places.max(), places)
        return np.stack([self._panels[k].padded(count) for k in cases.tolist()])

    def _most_cuts(self, factor: int) -> int:
        return self.steps.most_cuts(self.batch.contact, factor)

    def _are_fine(
        self, places: np.ndarray, here: Batch, checks: Checks, factor: int
    ) -> tuple[np.ndarray, np.ndarray]:
        """Whether the curves of each case hold, and whether those of others are cut further.

        Where no more cuts have room at this factor, a case waits for the next one, or has failed.
        """
        ends, errors, residual, reach = (np.asarray(leaf) for leaf in checks[:4])
        error, real, tolerance = np.max(errors, axis=1), places >= 0, self._tolerance[places]
        allowed = np.maximum(tolerance, here.contact.resolved.error_floor)
        fine, solved = error <= allowed, residual <= RESIDUAL
        cut, most = np.zeros(places.shape, bool), self._most_cuts(self._refinements[-1])
        for slot in np.flatnonzero(real & ~(fine & solved)).tolist():
            before = self._panels[place := int(places[slot])]
            last = ends[slot], errors[slot], reach[slot]
            after = before.finer(*last, allowed[slot], most, solved=bool(solved[slot]))
            if fine[slot] or after.stuck(self._patience) or after.cuts.size == before.cuts.size:
                self.failures[place] = curve_failure(error[slot], tolerance[slot], residual[slot])
                continue
            self._panels[place] = after
            cut[slot] = after.cuts.size <= self._most_cuts(factor)
            if not cut[slot]:
                self._waiting = np.append(self._waiting, place)
        return np.asarray(real & fine & solved), cut

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

    def _are_outside(
        self, places: np.ndarray, here: Batch, checks: Checks, times: float = 1.0
    ) -> np.ndarray:
        """Whether each case is released outside contact; others have failed.

        Those whose force there is more than so many ``times`` what is allowed.
        """
        if not self._checked:
            return np.ones(places.shape, bool)
        held = bool(here.body.forces)
        force, _power, largest, load = (np.asarray(leaf) for leaf in checks.at_release)
        limit = negligible_force(load, largest, chosen=self._launched or held)
        inside = ~(force <= limit) if times == 1.0 else force > times * limit
        release = np.asarray(here.body.release)
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
            left = self._go_on(packed(gathered, self.steps.width), patient=not pool)
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
