"""What reading a file of heights gives: the surface, and what was chosen on the way."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

from ..topography import Topography


class Asked(NamedTuple):
    """What is said of a file beside what it says itself; None where nothing is.

    Attributes
    ----------
    size
        Size (x, y) [m] of the whole map, pixels times their size.
    unit
        Unit of the heights, e.g. ``"nm"``; of points also that of x and y.
    channel
        Number or name of the channel.
    """

    size: tuple[float, float] | None
    unit: str | None
    channel: str | int | None


@dataclass(frozen=True)
class Reading:
    """A surface read, and what was chosen on the way.

    Parameters
    ----------
    topography
        The surface.
    format
        The format it was read as, in words.
    channel
        Number and name of the channel read, e.g. ``"0 ZSensor"``; empty where there is one alone.
    channels
        All channels of heights in the file.
    notes
        What the reader warns of, a line each.
    """

    topography: Topography
    format: str
    channel: str = ""
    channels: tuple[str, ...] = ()
    notes: tuple[str, ...] = ()
