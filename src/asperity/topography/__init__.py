"""Measured surfaces: from a file of heights to summits and statistics.

Heights lie on a grid of pixels, in metres, rows along y and columns along x; a missing one is NaN.
"""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING, Any

from .map import Topography

if TYPE_CHECKING:
    from .describing.adding import added
    from .describing.composite import Composite, composite
    from .describing.description import Description, describe
    from .describing.nayak import McCool, Nayak, mccool
    from .describing.spectrum import Moments, ProfileSpectrum, moments, profile_spectrum
    from .describing.summits import Summits, find_summits
    from .files.reading import Reading, read_surface, read_topography
    from .files.writing import write_topography
    from .making.generation import self_affine
    from .preparing.preparation import Preparation, Prepared, prepared

_HOMES = {
    "Composite": "describing.composite",
    "Description": "describing.description",
    "McCool": "describing.nayak",
    "Moments": "describing.spectrum",
    "Nayak": "describing.nayak",
    "Preparation": "preparing.preparation",
    "Prepared": "preparing.preparation",
    "ProfileSpectrum": "describing.spectrum",
    "Reading": "files.reading",
    "Summits": "describing.summits",
    "added": "describing.adding",
    "composite": "describing.composite",
    "describe": "describing.description",
    "find_summits": "describing.summits",
    "mccool": "describing.nayak",
    "moments": "describing.spectrum",
    "prepared": "preparing.preparation",
    "profile_spectrum": "describing.spectrum",
    "read_surface": "files.reading",
    "read_topography": "files.reading",
    "self_affine": "making.generation",
    "write_topography": "files.writing",
}

__all__ = [
    "Composite",
    "Description",
    "McCool",
    "Moments",
    "Nayak",
    "Preparation",
    "Prepared",
    "ProfileSpectrum",
    "Reading",
    "Summits",
    "Topography",
    "added",
    "composite",
    "describe",
    "find_summits",
    "mccool",
    "moments",
    "prepared",
    "profile_spectrum",
    "read_surface",
    "read_topography",
    "self_affine",
    "write_topography",
]


def __getattr__(name: str) -> Any:
    """Import what is asked for when it is: SciPy's image tools take a third of a second."""
    if name not in _HOMES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(importlib.import_module(f".{_HOMES[name]}", __name__), name)
