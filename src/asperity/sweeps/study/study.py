"""A study: a base case, the axes over which it varies, and what is kept of each case."""

from __future__ import annotations

import contextlib
import functools
import hashlib
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from pydantic import BaseModel

from asperity.config import Case
from asperity.config.case_file import read_text
from asperity.config.problems import place
from asperity.errors import InputError
from asperity.sweeps.study import (
    base_case,
    canonical,
    columns,
    structure,
    study_display,
    study_file,
)
from asperity.sweeps.study.axes import Axis
from asperity.sweeps.study.axis_text import axis_of
from asperity.sweeps.study.blocks import Blocks
from asperity.sweeps.study.case_variants import changed, parts
from asperity.sweeps.study.columns import Column
from asperity.sweeps.study.corners import corners_of
from asperity.sweeps.study.definition import StudyDefinition
from asperity.sweeps.study.keys import Value, find
from asperity.sweeps.study.refusing import refuse_unusable
from asperity.sweeps.study.samples import Sample

__all__ = ["Axis", "Sample", "Study", "parse", "read"]

_CORNERS = 16


@dataclass(frozen=True)
class Study(StudyDefinition):
    """A base case, the axes over which it varies, and what is kept of each case.

    Attributes
    ----------
    base
        The case of which each differs in the axes' keys alone.
    base_name
        Name of that case: a built-in's, or its file's without suffix.
    axes
        What varies; on a grid the first varies slowest.
    sample
        How the cases are drawn; None for a grid, every value with every other.
    keep
        Measures that are kept, names of `columns.MEASURES`.
    keep_impacts
        Number of impacts that are kept of a measure with one value an impact.
    motions
        Whether the turning points of every impact are kept too.
    """

    def width(self, along: str) -> int:
        """Number of values of a case along a dimension of a column: "impact", "turn", "byte"."""
        sizes = {
            "impact": self.keep_impacts,
            "turn": 2 * structure.largest_max_impacts(self),
            "byte": columns.REASON_SIZE,
        }
        return sizes[along]

    def blank(self, column: Column, cases: int) -> np.ndarray:
        """A column of so many cases of which nothing is known, shape (cases[, width])."""
        wide = (self.width(column.along),) if column.along else ()
        return np.full((cases, *wide), column.fill, column.dtype)

    @functools.cached_property
    def blocks(self) -> Blocks:
        """How its cases are cut into tasks, set by the study alone."""
        return Blocks.of(self.shape, structure.task_size(self))

    @property
    def tasks(self) -> int:
        """Number of tasks."""
        return self.blocks.count

    def task(self, number: int) -> range:
        """Numbers of the cases of a task.

        Raises
        ------
        IndexError
            Where there is no such task.
        """
        return self.blocks.cases(number)

    def values(self, start: int, stop: int) -> dict[str, np.ndarray]:
        """The axes' values of cases `start` to `stop` - 1.

        Returns
        -------
        dict
            By the axes' dotted keys: SI floats, whole numbers (int64), switches (bool) or text
            (object), shape (stop - start,); the same whatever part is asked for.

        Raises
        ------
        IndexError
            Where there are no such cases.
        """
        if not 0 <= start <= stop <= self.size:
            raise IndexError(f"a study of {self.size} cases has no cases {start} to {stop}")
        if self.sample is None:
            indices = np.unravel_index(np.arange(start, stop), self.shape)
            return {a.key: a.at(i) for a, i in zip(self.axes, indices, strict=True)}
        points = self.sample.points(start, stop, len(self.axes))
        columns = np.ascontiguousarray(points.T)
        return {a.key: a.from_unit(u) for a, u in zip(self.axes, columns, strict=True)}

    def case(self, number: int) -> Case:
        """A case by its number, checked like a file.

        Raises
        ------
        InputError
            Where its values break a rule, such as one between two keys.
        IndexError
            Where there is no such case.
        """
        found = self.values(number, number + 1)
        return self.case_of({key: array.tolist()[0] for key, array in found.items()})

    def case_of(self, values: Mapping[str, Value]) -> Case:
        """The base case with other values of some of the axes' keys, checked like a file.

        Parameters
        ----------
        values : mapping of str to float, int, bool or str
            By dotted key, each an axis', a value of that axis in SI.

        Raises
        ------
        InputError
            Where they break a rule.
        """
        axes = {axis.key: axis for axis in self.axes}
        changes = [
            (axes[key], value.item() if isinstance(value, np.generic) else value)
            for key, value in values.items()
        ]
        return changed(self._parts, changes)

    @property
    def in_tables(self) -> bool:
        """Whether all axes vary keys of tables that the base case has."""
        return all(isinstance(self._parts.get(place(a.key)[0]), BaseModel) for a in self.axes)

    @functools.cached_property
    def _parts(self) -> dict[str, Any]:
        return parts(self.base)

    @functools.cached_property
    def canonical(self) -> str:
        """The study as TOML that needs no other file; `parse` reads back an equal study."""
        return canonical.text(self)

    @functools.cached_property
    def fingerprint(self) -> str:
        """SHA-256 of the canonical text, in hexadecimal."""
        return hashlib.sha256(self.canonical.encode()).hexdigest()

    @property
    def warnings(self) -> list[str]:
        """What the study can be computed with, and yet should be known of it."""
        uneven = [] if self.sample is None else self.sample.warnings
        return [*uneven, *self._hopeless()]

    def _hopeless(self) -> list[str]:
        """What to say where a few cases all over the study break a rule; else nothing."""
        reasons = []
        for number in self.corners:
            try:
                self.case(number)
            except InputError as error:
                reasons.append(str(error))
            else:
                return []
        return [f"no case of those tried ({len(reasons)}) can be computed: {reasons[0]}"]

    @property
    def corners(self) -> list[int]:
        """Numbers of a few cases: of a grid its corners, of a sample its first."""
        if self.sample is not None:
            return list(range(min(self.size, _CORNERS)))
        return corners_of(self.shape, _CORNERS)

    def __repr__(self) -> str:
        return f"<Study of {self.base_name}: {study_display.sentence(self)}>"

    def _repr_html_(self) -> str:
        return study_display.html(self, self.warnings)


def read(path: str) -> Study:
    """A study from a TOML file.

    Raises
    ------
    InputError
        One line that names file, key, rule and value.
    """
    return parse(read_text(path, "a study"), file=path, folder=Path(path).parent)


def parse(text: str, *, file: str | None = None, folder: Path | None = None) -> Study:
    """A study from TOML text.

    Parameters
    ----------
    text : str
        The text.
    file : str, optional
        Name of its file, for messages.
    folder : Path, optional
        Folder in which files that it names are looked for; without it the current one.

    Raises
    ------
    InputError
        One line that names file, key, rule and value.
    """
    table = study_file.tables(text, file)
    with _named(file):
        base, name = base_case.base_of(table, folder or Path())
        axes = []
        for key, where, found in study_file.axes(table, text):
            try:
                sampled = table.sample is not None
                axes.append(axis_of(find(key, base.materials), found, sampled=sampled))
            except InputError as error:
                raise InputError(f"{where}: {error}", key=f"axes.{key}") from None
        kept, impacts = tuple(table.keep), table.keep_impacts
        study = Study(base, name, tuple(axes), table.sample, kept, impacts, table.motions)
        refuse_unusable(study, study.canonical)
    return study


@contextlib.contextmanager
def _named(file: str | None) -> Iterator[None]:
    """What is wrong within a study's text, with the name of its file in front."""
    try:
        yield
    except InputError as error:
        message = f"{file}: {error}" if file else str(error)
        raise InputError(message, file=file, key=error.key) from None
