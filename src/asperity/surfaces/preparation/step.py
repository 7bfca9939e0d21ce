"""What one step of a preparation did, in words and numbers."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

from ...amounts import amount


@dataclass(frozen=True)
class Step:
    """One step of a preparation and what it did to the rms height.

    Parameters
    ----------
    name
        What was done: ``missing``, ``lines``, ``form``, ``s_filter`` or ``l_filter``.
    words
        The same in a sentence, with its numbers, but without the rms heights.
    rms_before, rms_after
        Rms height [m] of the surface before and after the step.
    values
        Numbers of the step by name, in SI units; None where there is no finite number.
    """

    name: str
    words: str
    rms_before: float
    rms_after: float
    values: Mapping[str, float | str | None]

    @property
    def sentence(self) -> str:
        """The step in words, with the rms height before and after it."""
        return f"{self.words}; Sq {length(self.rms_before)} -> {length(self.rms_after)}"

    def to_json(self) -> dict[str, object]:
        """The step as plain numbers and text, in SI units."""
        return {
            "name": self.name,
            "words": self.words,
            "rms_before": self.rms_before,
            "rms_after": self.rms_after,
            **self.values,
        }


def length(value: float) -> str:
    """A length [m] at three digits in a unit that suits it, e.g. ``35.2 nm``."""
    return amount(value, "m", 3) if math.isfinite(value) else f"{value:g} m"
