"""An axis of a study: a key of a case and the values that it takes."""

from __future__ import annotations

import functools
from dataclasses import dataclass
from typing import Literal

import numpy as np

from asperity.sweeps.study.keys import Key, Value

Scale = Literal["linear", "log"]


@dataclass(frozen=True)
class Axis(Key):
    """A key of a case and the values that it takes in a study.

    Attributes
    ----------
    key, unit, label, whole
        As of a `Key`.
    listed
        The values in SI where the study lists them; () for a range.
    low, high
        First and last value [unit] of a range, or the least and largest listed number.
    steps
        Number of values of a range on a grid; 0 for a list, and for a range that is sampled.
    scale
        How a range is divided: "linear" or "log".
    """

    listed: tuple[Value, ...]
    low: float
    high: float
    steps: int
    scale: Scale

    @property
    def size(self) -> int:
        """Number of values on a grid; 0 for a range that is sampled."""
        return len(self.listed) or self.steps

    @property
    def values(self) -> np.ndarray:
        """All values on a grid, in order; shape (size,)."""
        return self.at(np.arange(self.size))

    def at(self, index: np.ndarray) -> np.ndarray:
        """Values by their number on a grid.

        Parameters
        ----------
        index : ndarray of int
            Numbers from 0, any shape.

        Returns
        -------
        ndarray
            SI floats, whole numbers (int64), switches (bool) or text (object); shape of `index`.
        """
        if self.listed:
            return self._array[index]
        return self._between(index / (self.steps - 1.0), whole_steps=True)

    def from_unit(self, u: np.ndarray) -> np.ndarray:
        """Values of a sample.

        Parameters
        ----------
        u : ndarray of float
            Evenly distributed numbers in [0, 1), any shape.

        Returns
        -------
        ndarray
            As from `at`: each listed value, each whole number, or each part of the range (of its
            logarithm) as often as any other.
        """
        if self.listed:
            last = len(self.listed) - 1
            return self.at(np.minimum((u * len(self.listed)).astype(np.int64), last))
        return self._between(u, whole_steps=False)

    @functools.cached_property
    def _array(self) -> np.ndarray:
        """The listed values."""
        kinds = set(map(type, self.listed))
        dtypes: dict[type, type] = {float: np.float64, int: np.int64, bool: np.bool_}
        dtype = dtypes.get(kinds.pop(), object) if len(kinds) == 1 else object
        return np.array(self.listed, dtype)

    def _between(self, part: np.ndarray, *, whole_steps: bool) -> np.ndarray:
        """Values at fractions of the range, both ends exact."""
        low, high = self.low, self.high
        if self.whole and not whole_steps:  # the last whole number has as wide a part as others
            high += 1.0
        if self.scale == "log":
            inner = low * (high / low) ** part
        else:
            inner = low * (1.0 - part) + high * part
        value = np.where(part >= 1.0, high, np.clip(inner, low, high))
        if not self.whole:
            return value
        rounded = np.floor(value + 0.5 if whole_steps else value)
        return np.minimum(rounded, self.high).astype(np.int64)
