"""What single bodies do: bands of restitution, and the share that is captured against speed."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from asperity.results.colours import colour
from asperity.results.realisations import QUANTILES
from asperity.sweeps.capture_probability import CaptureProbability

_BODIES = colour("gas")
_BAND: Any = {"color": _BODIES, "alpha": 0.35, "lw": 0.0}
_HALF: Any = {"color": _BODIES, "lw": 1.0, "ls": (0, (1, 1))}


def draw_restitution(axes: Axes, x: np.ndarray, found: CaptureProbability) -> None:
    """A band from the lowest to the highest of the quantiles of restitution, over speeds ``x``."""
    low, _, high = found.restitution.T
    axes.fill_between(x, low, high, **_BAND)


def draw_share(axes: Axes, x: np.ndarray, found: CaptureProbability, factor: float) -> None:
    """The captured share with its interval, and the speed at which it falls below a half.

    Speeds ``x`` are in units of ``factor`` [m/s].
    """
    axes.set(ylabel="captured share of bodies [-]", ylim=(-0.03, 1.03))
    axes.fill_between(x, found.low, found.high, **_BAND)
    axes.plot(x, found.probability, color=_BODIES)
    if found.half_velocity is not None:
        axes.axvline(found.half_velocity / factor, **_HALF)


def legend(found: CaptureProbability, half: str) -> list[tuple[Artist, str]]:
    """What the legend says of both; ``half`` is the speed at which half are captured, in words."""
    low, _, high = QUANTILES
    band = f"{100 * low:g} to {100 * high:g} % of {found.bodies} bodies; share with 95 % interval"
    rows: list[tuple[Artist, str]] = [(Patch(facecolor=_BODIES, alpha=0.35, lw=0.0), band)]
    if found.half_velocity is not None:
        rows.append((Line2D([], [], **_HALF), f"half are captured at {half}"))
    return rows
