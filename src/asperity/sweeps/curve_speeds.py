"""Speeds at which a curve of restitution is computed."""

from __future__ import annotations

import numpy as np

from ..errors import InputError

_NEAR = np.array([1e-4, 1e-3, 1e-2, 3e-2])  # relative: speeds on both sides of each edge
_BELOW, _ABOVE = 0.1, 100.0  # from and to how many critical velocities it is drawn


def checked(speeds: np.ndarray) -> np.ndarray:
    """Speeds [m/s] in order, once each."""
    found = np.unique(np.asarray(speeds, float))
    if not found.size or not np.all(np.isfinite(found)) or found[0] <= 0.0:
        raise InputError("`speeds` must be positive and finite, in m/s", key="speeds")
    return found


def chosen(
    ends: tuple[float, float] | None, points: int, edges: list[float], own: float
) -> np.ndarray:
    """Speeds [m/s] between two ends, else over decades about the edges of capture and its own."""
    if ends is not None:
        return np.geomspace(*ends, points)
    low, high = (edges[0], edges[-1]) if edges else (own, own)
    first, last = min(_BELOW * low, own), max(_ABOVE * high, own)
    # Where capture begins or ends restitution falls to 0 as a root does.
    near = np.outer(edges, 1.0 + np.concatenate([-_NEAR, _NEAR])).ravel()
    return np.unique(np.concatenate([np.geomspace(first, last, points), near]))


def left_out(missing: int, speeds: int) -> list[str]:
    """What is to be said of speeds at which nothing could be computed."""
    if not missing:
        return []
    return [
        f"{missing} of {speeds} speeds are left out: their force curves are not fine enough, or "
        "their motion could not be solved"
    ]
