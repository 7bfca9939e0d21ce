"""What makes a study: its base case, its axes, what is kept, and how many cases that gives."""

from __future__ import annotations

import functools
import math
from dataclasses import dataclass

from asperity.config import Case
from asperity.sweeps.study import columns
from asperity.sweeps.study.axes import Axis
from asperity.sweeps.study.columns import Column
from asperity.sweeps.study.samples import Sample

CASE = "case"
"""Dimension of the cases of a sample; a grid has its axes' keys instead."""


@dataclass(frozen=True)
class StudyDefinition:
    """What makes a study, not yet its cases: those has a `Study`, which says what each field is."""

    base: Case
    base_name: str
    axes: tuple[Axis, ...]
    sample: Sample | None
    keep: tuple[str, ...]
    keep_impacts: int
    motions: bool

    @functools.cached_property
    def columns(self) -> tuple[Column, ...]:
        """What is kept of each case."""
        return columns.columns(self.keep, motions=self.motions)

    @functools.cached_property
    def shape(self) -> tuple[int, ...]:
        """Sizes of the axes, the first slowest (C order); of a sample (size,)."""
        if self.sample is not None:
            return (self.sample.size,)
        return tuple(axis.size for axis in self.axes)

    @property
    def dims(self) -> tuple[str, ...]:
        """Names of the dimensions of its results: the axes' keys, or "case" of a sample."""
        return (CASE,) if self.sample is not None else tuple(axis.key for axis in self.axes)

    @functools.cached_property
    def size(self) -> int:
        """Number of cases."""
        return math.prod(self.shape)
