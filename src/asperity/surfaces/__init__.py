"""Measured surfaces: from a file of heights to summits and statistics.

Heights lie on a grid of pixels, in metres, rows along y and columns along x; a missing one is NaN.

`files`: reading and writing; `preparation`: missing pixels, line levelling, form removal, filters;
`description`: summits, spectrum, statistics, two surfaces as one; `generation`: made surfaces;
`heights`: distributions of asperity heights, Gaussian or as measured, for the rooms above;
`measured_surface`: these steps in a row. What is read is never guessed: a unit or a size that a
file does not state is asked for.
"""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING, Any

from .topography import Topography

if TYPE_CHECKING:
    from .description.composite import Composite, composite
    from .description.describe import Description, describe
    from .description.nayak import McCool, Nayak, mccool
    from .description.spectrum import Moments, ProfileSpectrum, moments, profile_spectrum
    from .description.sum_of_maps import added
    from .description.summits import Summits, find_summits
    from .files.read_surface import read_surface, read_topography
    from .files.reading import Reading
    from .files.write_surface import write_topography
    from .generation.generate import self_affine
    from .preparation.prepare import Preparation, Prepared, prepared

_HOMES = {
    "Composite": "description.composite",
    "Description": "description.describe",
    "McCool": "description.nayak",
    "Moments": "description.spectrum",
    "Nayak": "description.nayak",
    "Preparation": "preparation.prepare",
    "Prepared": "preparation.prepare",
    "ProfileSpectrum": "description.spectrum",
    "Reading": "files.reading",
    "Summits": "description.summits",
    "added": "description.sum_of_maps",
    "composite": "description.composite",
    "describe": "description.describe",
    "find_summits": "description.summits",
    "mccool": "description.nayak",
    "moments": "description.spectrum",
    "prepared": "preparation.prepare",
    "profile_spectrum": "description.spectrum",
    "read_surface": "files.read_surface",
    "read_topography": "files.read_surface",
    "self_affine": "generation.generate",
    "write_topography": "files.write_surface",
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
