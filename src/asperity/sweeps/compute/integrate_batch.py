"""All cases of one structure, from their release to their end."""

from __future__ import annotations

import dataclasses
from collections.abc import Iterator
from typing import Any, NamedTuple

import numpy as np

from asperity._jax import jax
from asperity.dynamics import Impacts
from asperity.dynamics.record import ENDS, IN_MOTION
from asperity.dynamics.release import TRIES, farther, negligible_force
from asperity.errors import Outcome
from asperity.results.measures import Measures
from asperity.sweeps.compute import batch_steps
from asperity.sweeps.compute.batch_steps import Begun, Checks, Clock
from asperity.sweeps.compute.building import Batch, Group

_REFINEMENTS = (1, 2, 4, 8)
_RESIDUAL = 1e-6
_LEAST = 16


class BatchSolution(NamedTuple):
    """What became of the cases of a group, each array with the cases along its first axis.

    Attributes
    ----------
    outcome
        Codes of `asperity.dynamics.record.ENDS`.
    made
        Number of impacts.
    last_apex_time
        Time of the last apex [s].
    lost
        Energy lost in all, by mechanism [J].
    history
        Impacts by name, as in :class:`asperity.dynamics.Impacts`, shape (cases, impacts).
    measures
        By name, as in :class:`asperity.results.measures.Measures`.
    at_depth
        :class:`asperity.regimes.validity.AtDepth` of the first impact, shape (cases, 3).
    reasons
        Why a case failed, by its place in the group.
    release
        Mechanical energy at the release [J].
    """

    outcome: np.ndarray
    made: np.ndarray
    last_apex_time: np.ndarray
    lost: np.ndarray
    history: dict[str, np.ndarray]
    measures: dict[str, np.ndarray]
    at_depth: np.ndarray
    reasons: dict[int, str]
    release: np.ndarray


class _Filled(NamedTuple):
    """Cases of a compiled call; places beyond the last are -1 and repeat it."""

    places: np.ndarray
    batch: Batch
    begun: Begun


def integrate_batch(
    group: Group, clock: Clock, *, checked: bool = True, width: int | None = None
) -> BatchSolution:
    """Integrate all cases of a group.

    Parameters
    ----------
    group
        The cases.
    clock
        Told of the time in compiled code.
    checked
        Whether they must be released outside contact. Nothing finer is compiled for others, which
        are launched where forces begin.
    width
        Cases of a compiled call; without it, what suits the group.
    """
    cases = _Cases(group, clock, checked=checked, width=width)
    places = np.arange(group.rows.size)
    refinements = _REFINEMENTS if checked else _REFINEMENTS[:1]
    for factor in refinements:
        places = cases.begin(places, factor, last=factor == refinements[-1])
        if not places.size:
            break
    return cases.solution()


def compile_ahead(groups: list[Group]) -> None:
    """Compile the steps of groups of cases, where they are not yet."""
    for group in groups:
        count = group.rows.size
        width = batch_steps.width(group.batch, count)
        here = taken(group.batch, next(_slices(np.arange(count), width)))
        steps = batch_steps.steps(width)
        begun, _checks, _rows = steps.begin.ahead(here)
        steps.go_on.ahead(here, begun)


class _Cases:
    """Cases on their way."""

    def __init__(self, group: Group, clock: Clock, *, checked: bool, width: int | None) -> None:
        self.group, self.clock, self.checked = group, clock, checked
        count = group.rows.size
        self.tries = np.zeros(count, int)
        self.width = width or batch_steps.width(group.batch, count)
        self.steps = batch_steps.steps(self.width)
        self.ended: dict[str, np.ndarray] = {}
        self.history: dict[str, np.ndarray] = {}
        self.made = np.zeros(count, int)
        self.at_depth = np.full((count, 3), np.nan)
        self.outcome = np.full(count, ENDS.index(Outcome.FAILED))
        self.reasons: dict[int, str] = {}
        self._ends: list[Any] | None = None

    def begin(self, places: np.ndarray, factor: int, *, last: bool) -> np.ndarray:
        """Integrate these cases with so many times the panels; those that need more yet."""
        coarse = []
        while places.size:
            coarser, places = self._begin(places, factor, last=last)
            coarse.append(coarser)
        return np.concatenate(coarse) if coarse else places

    def _begin(
        self, places: np.ndarray, factor: int, *, last: bool
    ) -> tuple[np.ndarray, np.ndarray]:
        """The same; of the others, those that need a release further out."""
        batch = self.group.batch
        contact = batch.contact.refined(factor) if factor > 1 else batch.contact
        batch = batch._replace(contact=contact)
        moved = []
        wanted = np.maximum(self.group.tolerance, contact.error_floor)
        coarse, pool = [], []
        for some in _slices(places, self.width):
            here = taken(batch, some)
            begun, checks, rows = self.clock.run(self.steps.begin, here)
            error = np.asarray(checks.error)
            fine = ~(error > wanted[some]) & (some >= 0)
            rough = ~fine & (some >= 0)
            if last:
                self._refuse_coarse(some[rough], error[rough], wanted)
            else:
                coarse.append(some[rough])
            some = np.where(fine, some, -1)
            inside = self._move_out(some, here, checks)
            moved.append(some[inside])
            some = np.where(inside, -1, some)
            some = np.where(self._sound(some, here, checks), some, -1)
            self.at_depth[some[some >= 0]] = np.asarray(checks.at_depth)[some >= 0]
            self._keep(some, begun, rows)
            pool.append(self._on(_Filled(some, here, begun)))
        self._finish([slot for slot in pool if slot is not None])
        none = np.zeros(0, int)
        return np.concatenate([none, *coarse]), np.concatenate([none, *moved])

    def _move_out(self, places: np.ndarray, here: Batch, checks: Checks) -> np.ndarray:
        """Whether each case is begun anew, from a release further out, where none was given."""
        if not self.group.launched:
            return np.zeros(places.shape, bool)
        force, power, largest, load = (np.asarray(leaf) for leaf in checks.at_release)
        limit = negligible_force(load, largest, chosen=True)
        again = (force > limit) & (places >= 0) & (self.tries[places] < TRIES - 1)
        at = places[again]
        self.tries[at] += 1
        further = farther(np.asarray(here.body.release), force, power, limit)
        batch = self.group.batch
        release = np.array(batch.body.release)
        release[at] = further[again]
        body = dataclasses.replace(batch.body, release=release)
        self.group = self.group._replace(batch=batch._replace(body=body))
        return again

    def _finish(self, pool: list[_Filled]) -> None:
        """Integrate what is left of several calls in fewer."""
        while pool:
            gathered: list[_Filled] = []
            count = 0
            while pool and (not gathered or count + _real(pool[-1]) <= self.width):
                count += _real(pool[-1])
                gathered.append(pool.pop())
            left = self._on(_packed(gathered, self.width), patient=not pool)
            if left is not None:
                pool.append(left)

    def _on(self, here: _Filled, *, patient: bool = False) -> _Filled | None:
        """Go on until half of the cases are at rest, or all; the others."""
        while True:
            going = np.asarray(here.begun.progress.outcome) == IN_MOTION
            here = here._replace(places=np.where(going, here.places, -1))
            active = _real(here)
            if active == 0:
                return None
            if active <= self.width // 2 and not patient:
                return here
            progress, rows = self.clock.run(self.steps.go_on, here.batch, here.begun)
            begun = here.begun._replace(progress=progress)
            here = here._replace(begun=begun)
            self._keep(here.places, begun, rows)

    def _keep(self, places: np.ndarray, begun: Begun, rows: batch_steps.Rows) -> None:
        """Write down the impacts of a call, and where it ended."""
        real = places >= 0
        at = places[real]
        impacts, passing = rows
        made = np.asarray(impacts.made)[real]
        self.clock.count(np.where(real[:, None], np.asarray(impacts.made), False))
        named = {name: value for name, value in impacts._asdict().items() if value is not None}
        if passing is not None:
            named["passing_in"], named["passing_out"] = passing
        row, column = np.nonzero(made)
        column_there = self.made[at][row] + column
        self._widen(named, int(column_there.max(initial=-1)) + 1)
        for name, value in named.items():
            self.history[name][at[row], column_there] = np.asarray(value)[real][row, column]
        self.made[at] += made.sum(axis=1)
        progress = begun.progress._replace(memory=(), bonds=begun.progress.place)
        ends = begun.reference, begun.origin, progress, begun.first
        leaves = [np.asarray(leaf) for leaf in jax.tree_util.tree_leaves(ends)]
        if self._ends is None:
            self._shape = jax.tree_util.tree_structure(ends)
            count = self.made.size
            self._ends = [np.zeros((count, *leaf.shape[1:]), leaf.dtype) for leaf in leaves]
        for whole, leaf in zip(self._ends, leaves, strict=True):
            whole[at] = leaf[real]

    def _widen(self, named: dict[str, Any], needed: int) -> None:
        """Make room for so many impacts."""
        there = self.history["made"].shape[1] if self.history else 0
        if needed <= there and self.history:
            return
        size = _power(needed)
        for name, value in named.items():
            array = np.asarray(value)
            wider = np.zeros((self.made.size, size, *array.shape[2:]), array.dtype)
            if there:
                wider[:, :there] = self.history[name]
            self.history[name] = wider

    def _sound(self, places: np.ndarray, here: Batch, checks: Checks) -> np.ndarray:
        """Whether each case is released outside contact, and in equilibrium; reasons else."""
        body = here.body
        force, _power, largest, load = (np.asarray(leaf) for leaf in checks.at_release)
        release, near = np.asarray(body.release), self.group.launched or bool(body.forces)
        limit = negligible_force(load, largest, chosen=near)
        inside = ~(force <= limit) & self.checked
        residual = np.asarray(checks.residual)
        unsolved = ~(residual <= _RESIDUAL)
        for slot in np.flatnonzero((inside | unsolved) & (places >= 0)).tolist():
            self.reasons[int(places[slot])] = (
                f"`release_separation` must lie outside contact: the force there must be below "
                f"{limit[slot]:.3g} N, and is {force[slot]:.3g} N; "
                f"got {release[slot] * 1e9:.6g} nm"
                if inside[slot]
                else "pressure and deformation do not agree: relative force error "
                f"{residual[slot]:.1e}"
            )
        return np.asarray(~(inside | unsolved))

    def _refuse_coarse(self, places: np.ndarray, error: np.ndarray, wanted: np.ndarray) -> None:
        for place, reached in zip(places.tolist(), error.tolist(), strict=True):
            self.reasons[place] = (
                f"force curves reach a relative error of {reached:.1e}, "
                f"not `numerics.tolerance` = {wanted[place]:.1e}"
            )

    def solution(self) -> BatchSolution:
        """What became of all cases."""
        moved = np.flatnonzero(self.made > 0)
        measures = self._measured(moved)
        ends: Any = (None,) * 4
        count = self.made.size
        lost, release = np.zeros((count, 0)), np.full(count, np.nan)
        outcome, last_apex_time = self.outcome, np.full(count, np.nan)
        if self._ends is not None:
            ends = jax.tree_util.tree_unflatten(self._shape, self._ends)
            release, progress = np.where(self.made > 0, ends[1], np.nan), ends[2]
            outcome = np.where(self.made > 0, progress.outcome, self.outcome)
            last_apex_time = np.where(self.made > 0, progress.time, np.nan)
            lost = progress.lost
        failed = ENDS.index(Outcome.FAILED)
        for place in moved[outcome[moved] == failed].tolist():
            self.reasons[place] = "the motion left the tabulated separations"
        return BatchSolution(
            outcome, self.made, last_apex_time, lost, self.history, measures, self.at_depth,
            self.reasons, release,
        )  # fmt: skip

    def _measured(self, places: np.ndarray) -> dict[str, np.ndarray]:
        """The measures of cases that were integrated, in calls of like lengths."""
        out: dict[str, np.ndarray] = {}
        for some in _slices(places, self.width):
            found = self._measures_of(some)
            real = some >= 0
            for name, value in found._asdict().items():
                array = np.asarray(value)[real]
                if name not in out:
                    size = (self.history["made"].shape[1],) if array.ndim > 1 else ()
                    fill = False if array.dtype == bool else np.nan
                    out[name] = np.full((self.made.size, *size), fill, array.dtype)
                if array.ndim > 1:
                    out[name][some[real], : array.shape[1]] = array
                else:
                    out[name][some[real]] = array
        return out

    def _measures_of(self, some: np.ndarray) -> Measures:
        ends = jax.tree_util.tree_unflatten(self._shape, taken(self._ends, some))
        size = _power(int(self.made[some].max()))
        past = {name: array[some, :size] for name, array in self.history.items()}
        passing = None
        if "passing_in" in past:
            passing = past.pop("passing_in"), past.pop("passing_out")
        impacts = Impacts(**past, fall=None, rise=None)  # type: ignore[arg-type]
        here = taken(self.group.batch, some)
        answer: Measures = self.clock.run(self.steps.measure, here, ends, (impacts, passing))
        return answer


def _power(count: int) -> int:
    """A power of two that is enough: few shapes, so few compilations."""
    return max(_LEAST, 1 << max(count - 1, 0).bit_length())


def _slices(places: np.ndarray, width: int) -> Iterator[np.ndarray]:
    """The places, so many at a time; the last are filled up with -1."""
    for begin in range(0, places.size, width):
        some = places[begin : begin + width]
        yield np.concatenate([some, np.full(width - some.size, -1, int)])


def taken(tree: Any, places: np.ndarray) -> Any:
    """Cases by their places in a tree of arrays; where there is none, the last of the places."""
    index = np.where(places >= 0, places, places.max())
    return jax.tree_util.tree_map(
        lambda leaf: np.asarray(leaf)[index] if _is_array(leaf) else leaf, tree
    )


def _is_array(leaf: Any) -> bool:
    return isinstance(leaf, np.ndarray | jax.Array)


def _real(here: _Filled) -> int:
    return int(np.sum(here.places >= 0))


def _packed(parts: list[_Filled], width: int) -> _Filled:
    """The cases still in motion, side by side."""
    places = np.concatenate([part.places[part.places >= 0] for part in parts])
    index = np.append(np.arange(places.size), np.zeros(width - places.size, int))

    def packed(*leaves: Any) -> Any:
        if not _is_array(leaves[0]):
            return leaves[0]
        kept = [np.asarray(x)[p.places >= 0] for x, p in zip(leaves, parts, strict=True)]
        return np.concatenate(kept)[index]

    batch, begun = (jax.tree_util.tree_map(packed, *(part[k] for part in parts)) for k in (1, 2))
    filled = np.concatenate([places, np.full(width - places.size, -1, int)])
    return _Filled(filled, batch, begun)
