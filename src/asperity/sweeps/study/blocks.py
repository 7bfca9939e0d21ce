"""How a study is cut into tasks: blocks of its cases that follow each other."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class Blocks:
    """Blocks of a grid of cases; one is a task, and a chunk of each array of a store.

    Parameters
    ----------
    shape : tuple of int
        Sizes of the dimensions, the first varies slowest (C order).
    block : tuple of int
        Sizes of a block: 1 along the first dimensions, a part of one, all of the last ones.
    """

    shape: tuple[int, ...]
    block: tuple[int, ...]

    @classmethod
    def of(cls, shape: tuple[int, ...], most: int) -> Blocks:
        """Even blocks of at most so many cases."""
        block: list[int] = []
        for size in reversed(shape):
            part = max(1, min(size, most // math.prod(block)))
            block.insert(0, math.ceil(size / math.ceil(size / part)))
        return cls(shape, tuple(block))

    @property
    def count(self) -> int:
        """Number of blocks."""
        return math.prod(self._along)

    @property
    def largest(self) -> int:
        """Cases of a whole block."""
        return math.prod(self.block)

    def index(self, number: int) -> tuple[int, ...]:
        """Index of a block among all, along each dimension.

        Raises
        ------
        IndexError
            Where there is no such block.
        """
        if not 0 <= number < self.count:
            raise IndexError(f"of {self.count} tasks there is none with the number {number}")
        return tuple(map(int, np.unravel_index(number, self._along)))

    def extent(self, number: int) -> tuple[int, ...]:
        """Sizes of a block; the last along a dimension may be smaller."""
        sides = zip(self.index(number), self.block, self.shape, strict=True)
        return tuple(min(part, size - at * part) for at, part, size in sides)

    def cases(self, number: int) -> range:
        """Numbers of the cases of a block."""
        start = 0
        for at, part, size in zip(self.index(number), self.block, self.shape, strict=True):
            start = start * size + at * part
        return range(start, start + math.prod(self.extent(number)))

    @property
    def _along(self) -> tuple[int, ...]:
        return tuple(-(-size // part) for size, part in zip(self.shape, self.block, strict=True))
