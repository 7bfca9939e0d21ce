"""How cases ended, as colours and marks that all pictures of studies share."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from asperity.errors import ENDS, Outcome
from asperity.results.colours import colour

if TYPE_CHECKING:
    import xarray

CAPTURED, REBOUNDS, FAILED = colour("closest_approach"), colour("motion"), "#DDDDDD"
"""Colours of cases whose first impact captures, that rebound from it, that failed."""

WORDS = {"captured": "captured at the first impact", "rebounds": "rebounds"}
"""What legends call them, however often a body rebounds before it comes to rest."""

SHADE = "#F7E3D8"
"""Behind lines where the first impact captures."""

FAILED_CELL: Any = {"facecolor": FAILED, "edgecolor": "white", "hatch": "//////", "lw": 0.0}
"""Of the cells of failed cases on a map."""

SERIES = ("motion", "apex", "capillary", "closest_approach", "gas", "central")
"""Names of the colours of series, in order."""

BOUNDARY: Any = {"color": colour("contact"), "lw": 1.2}
"""Of the line between capture and rebound."""


def failed(dataset: xarray.Dataset) -> np.ndarray:
    """Whether a case failed."""
    found: np.ndarray = dataset["outcome"].values == ENDS.index(Outcome.FAILED)
    return found


def captured(dataset: xarray.Dataset) -> np.ndarray | None:
    """Whether the first impact captures: 1, 0, -1 where that is not known; None if not kept."""
    if "captured" not in dataset:
        return None
    values: np.ndarray = dataset["captured"].values
    return values


def incomplete(dataset: xarray.Dataset) -> str:
    """What a title says of cases that are not computed or that failed; "" where all is well."""
    cases = int(dataset["outcome"].size)
    missing = int(np.count_nonzero(dataset["outcome"].values < 0))
    lost = int(np.count_nonzero(failed(dataset)))
    parts = [f"{missing} of {cases} cases not computed"] if missing else []
    if lost:
        parts.append(f"{lost} failed" if parts else f"{lost} of {cases} cases failed")
    return ", ".join(parts)
