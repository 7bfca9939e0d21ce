"""What reading a file of heights gives: the surface, and what was chosen on the way."""

from __future__ import annotations

from dataclasses import dataclass

from ..topography import Topography


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
