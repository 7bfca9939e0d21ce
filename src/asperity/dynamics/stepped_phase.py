"""What a phase of a motion in time leaves: its samples, and how it ends."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

TURNED, LEFT, AT_REST, FAILED = "turned", "left", "at rest", "failed"
STOPPED = "stopped"
"""How a phase ends: by a turn, at the end of the table, at rest without a turn, not at all, or
where the film alone stops the body."""


class Ended(Exception):
    """The motion was asked to end."""


class Samples(NamedTuple):
    """A motion at the points of its steps; the leading axis is the sample.

    Attributes
    ----------
    time, separation, speed
        [s], [m], [m/s].
    rows
        Quantities of the contact.
    lost
        Energy lost since the release, by law, then in the gas if any [J].
    """

    time: np.ndarray
    separation: np.ndarray
    speed: np.ndarray
    rows: np.ndarray
    lost: np.ndarray

    @classmethod
    def joined(cls, parts: list[Samples]) -> Samples:
        """Samples one after the other."""
        return cls(*(np.concatenate(column) for column in zip(*parts, strict=True)))


class SteppedPhase(NamedTuple):
    """A phase of an impact, from one turning point to the next.

    Attributes
    ----------
    end
        How it ends: TURNED, LEFT, AT_REST, FAILED or STOPPED.
    samples
        Its samples, without its start.
    pull_work
        Work against the attractive forces [J]; None where the samples give it.
    """

    end: str
    samples: Samples
    pull_work: float | None = None
