"""Cases as objects, many at once: groups of one structure, ready to be integrated side by side."""

from __future__ import annotations

import dataclasses
from collections.abc import Hashable, Iterator, Mapping
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from asperity._jax import jax, jnp
from asperity.config import Case
from asperity.config.resolve import resolve
from asperity.contact import ElasticContact
from asperity.contact.resolution import (
    FEW_OF_MANY,
    Resolution,
    lengths_in_rms,
    one_of_few,
    resolution_of,
)
from asperity.contact.rough import RoughContact
from asperity.dynamics import Limits
from asperity.dynamics.problem import Problem
from asperity.errors import InputError
from asperity.integration.batch_records import Batch, is_array, taken
from asperity.model import build
from asperity.numerics.compilation import Program
from asperity.sweeps.compute.batch_values import BatchValues, Mixed

if TYPE_CHECKING:
    from asperity.sweeps.study.study import Study

Values = Mapping[str, np.ndarray]

_ROUNDING = 1e-12  # relative, between one case built alone and among others
_UNRESOLVED = Resolution(1, 8, 1)


class Group(NamedTuple):
    """Cases of one structure.

    Attributes
    ----------
    rows
        Their places among the values that were asked for.
    batch
        What is integrated.
    tolerance
        Relative error allowed to each one's force curves [-].
    problems
        What was built of each case, where they were built one by one; else empty.
    launched
        Whether speeds alone are given, and the release is to be found.
    """

    rows: np.ndarray
    batch: Batch
    tolerance: np.ndarray
    problems: tuple[Problem, ...] = ()
    launched: bool = False

    def some(self, places: np.ndarray) -> Group:
        """Some of the cases, by their places in the group."""
        problems = tuple(self.problems[place] for place in places) if self.problems else ()
        return Group(
            self.rows[places],
            taken(self.batch, places),
            self.tolerance[places],
            problems,
            self.launched,
        )


class Built(NamedTuple):
    """All cases that were asked for.

    Attributes
    ----------
    groups
        Those that are integrated side by side.
    alone
        Places of those that are solved one by one, with their cases.
    refused
        Why a case cannot be, by its place.
    """

    groups: list[Group]
    alone: list[tuple[int, Case]]
    refused: dict[int, str]


class _Differs(Exception):
    """A model that cannot be built of many values at once."""


def built(study: Study, values: Values) -> Built:
    """The cases with some values of a study's axes, as groups of one structure.

    Parameters
    ----------
    study
        The study.
    values
        Values of its axes by key, shape (cases,).
    """
    count = next(iter(values.values())).shape[0]
    out = Built([], [], {})
    one_by_one = study.base.roughness is not None and study.base.roughness.files is not None
    if one_by_one or not study.in_tables:
        _each(study, values, np.arange(count), out)
    else:
        for rows in _kinds(values, count):
            _together(study, values, rows, out)
    return out._replace(groups=[_joined(same) for same in _alike(out.groups)])


def _kinds(values: Values, count: int) -> Iterator[np.ndarray]:
    """Rows with equal text, switches and whole numbers."""
    kinds: dict[tuple[Any, ...], list[int]] = {}
    fixed = [array.tolist() for array in values.values() if array.dtype.kind != "f"]
    if not fixed:
        yield np.arange(count)
        return
    for row, kind in enumerate(zip(*fixed, strict=True)):
        kinds.setdefault(kind, []).append(row)
    for found in kinds.values():
        yield np.asarray(found)


def _together(study: Study, values: Values, rows: np.ndarray, out: Built) -> None:
    """Build rows as one case, and in parts where they turn out to be of several kinds."""
    if rows.size < 3:
        _each(study, values, rows, out)
        return
    try:
        group, delayed = _as_one(study, values, rows)
    except Mixed as mixed:
        _together(study, values, rows[mixed.holds], out)
        _together(study, values, rows[~mixed.holds], out)
    except (InputError, _Differs):
        _each(study, values, rows, out)  # for each one's own message, too
    else:
        if delayed:
            out.alone.extend((int(row), case_at(study, values, row)) for row in rows)
        else:
            out.groups.extend(_by_resolution(group))


def _as_one(study: Study, values: Values, rows: np.ndarray) -> tuple[Group, bool]:
    """Rows built as one case; and whether they are to be solved one by one after all."""
    chosen: dict[str, Any] = {}
    for key, array in values.items():
        some = array[rows]
        chosen[key] = some.view(BatchValues) if some.dtype.kind == "f" else some.tolist()[0]
    try:
        case = study.case_of(chosen)
        problem = build(resolve(case), _UNRESOLVED)
    except (InputError, Mixed):
        raise
    except (TypeError, ValueError, AttributeError) as error:  # what takes one number alone
        raise _Differs from error
    inputs = problem.inputs
    whole = Batch(problem.contact, problem.body, Limits.of(inputs.tolerance))
    both = [case_at(study, values, row) for row in (rows[0], rows[-1])]
    alone = [_batch_of_one(build(resolve(each), _UNRESOLVED)) for each in both]
    batch = _spread(whole, alone, rows.size)
    tolerance = np.broadcast_to(np.asarray(inputs.tolerance.relative, float), rows.shape)
    group = Group(rows, batch, tolerance, launched=inputs.chosen_release)
    return group, problem.in_time


def _spread(batch: Batch, alone: list[Batch], count: int) -> Batch:
    """Each array with all cases along its first axis; the first and the last are checked."""
    leaves, structure = jax.tree_util.tree_flatten(batch)
    first, last = (jax.tree_util.tree_flatten(each) for each in alone)
    if [structure] * 2 != [first[1], last[1]]:
        raise _Differs
    out = []
    for leaf, one, other in zip(leaves, first[0], last[0], strict=True):
        if not is_array(one):
            if leaf != one or leaf != other:
                raise _Differs
            out.append(leaf)
            continue
        array, shape = np.asarray(leaf), one.shape[1:]
        if array.shape == shape:
            array = np.broadcast_to(array, (count, *shape))
        if array.shape != (count, *shape) or not (
            _near(array[:1], one) and _near(array[-1:], other)
        ):
            raise _Differs
        out.append(array)
    spread: Batch = jax.tree_util.tree_unflatten(structure, out)
    return spread


def _near(value: np.ndarray, one: np.ndarray) -> bool:
    return np.allclose(value, one, rtol=_ROUNDING, atol=0.0, equal_nan=True)


def _each(study: Study, values: Values, rows: np.ndarray, out: Built) -> None:
    """Build rows one by one."""
    for row in rows.tolist():
        try:
            case = case_at(study, values, row)
            problem = build(resolve(case))
        except InputError as error:
            out.refused[row] = str(error)
            continue
        if problem.in_time:
            out.alone.append((row, case))
            continue
        batch = _batch_of_one(problem)
        tolerance, launched = problem.inputs.tolerance.relative, problem.inputs.chosen_release
        group = Group(np.asarray([row]), batch, np.asarray([tolerance]), (problem,), launched)
        out.groups.extend(_by_resolution(group))


def case_at(study: Study, values: Values, row: int) -> Case:
    """The case of one row of the values of a study's axes."""
    return study.case_of({key: array[row : row + 1].tolist()[0] for key, array in values.items()})


def problem_at(study: Study, values: Values, group: Group, place: int) -> Problem:
    """What was built of a case of a group, by its place there; else it is built now."""
    if group.problems:
        return group.problems[place]
    return build(resolve(case_at(study, values, int(group.rows[place]))))


def _batch_of_one(problem: Problem) -> Batch:
    return Batch.of_one(problem.contact, problem.body, Limits.of(problem.inputs.tolerance))


def _by_resolution(group: Group) -> list[Group]:
    """A group cut by how finely the curves are cut: as finely as each case asks for, and evenly."""
    contact = group.batch.contact
    if not isinstance(contact, RoughContact):
        return [group]
    deforms = isinstance(contact, ElasticContact)
    interface = jax.tree_util.tree_map(
        lambda leaf: jnp.asarray(leaf) if is_array(leaf) else leaf, contact.interface
    )
    lengths = np.stack([np.asarray(x) for x in _lengths(interface)], axis=1)
    kinds: dict[Resolution, list[int]] = {}
    for row, each in enumerate(lengths.tolist()):
        found = resolution_of(contact.interface, tuple(each), deforms=deforms)
        kinds.setdefault(one_of_few(found, FEW_OF_MANY), []).append(row)
    return [_resolved(group.some(np.asarray(rows)), kind) for kind, rows in kinds.items()]


def _lengths_of_each(interface: Any) -> Any:
    return jax.vmap(lengths_in_rms)(interface)


_lengths = Program(_lengths_of_each)


def _resolved(group: Group, kind: Resolution) -> Group:
    contact = group.batch.contact
    assert isinstance(contact, RoughContact)
    contact = dataclasses.replace(contact, resolved=kind)
    return group._replace(batch=group.batch._replace(contact=contact))


def _alike(groups: list[Group]) -> list[list[Group]]:
    """Groups of the same structure, together."""
    kinds: dict[Hashable, list[Group]] = {}
    for group in groups:
        leaves, structure = jax.tree_util.tree_flatten(group.batch)
        shapes = tuple(leaf.shape[1:] if is_array(leaf) else (leaf,) for leaf in leaves)
        kinds.setdefault((structure, shapes, group.launched), []).append(group)
    return list(kinds.values())


def _joined(groups: list[Group]) -> Group:
    """Groups of the same structure as one."""
    if len(groups) == 1:
        return groups[0]

    def joined(*leaves: Any) -> Any:
        return np.concatenate(leaves) if is_array(leaves[0]) else leaves[0]

    batch = jax.tree_util.tree_map(joined, *(group.batch for group in groups))
    rows = np.concatenate([group.rows for group in groups])
    tolerance = np.concatenate([group.tolerance for group in groups])
    whole = all(group.problems for group in groups)
    problems = tuple(one for group in groups for one in group.problems) if whole else ()
    return Group(rows, batch, tolerance, problems, groups[0].launched)
