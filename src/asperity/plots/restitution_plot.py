"""Coefficient of restitution against speed of approach, with the critical velocity on it."""

from __future__ import annotations

from itertools import pairwise
from math import isclose
from typing import Any

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from asperity.plots import style
from asperity.plots.study import outcomes
from asperity.plots.study.drawn_quantities import Quantity
from asperity.plots.study.panels import Block, Page
from asperity.results.colours import colour
from asperity.results.realisations import QUANTILES
from asperity.sweeps.capture_probability import CaptureProbability

_DOTTED = 40
_MARGIN = 1.15
_EDGE: Any = {"color": colour("contact"), "lw": 0.6, "ls": (0, (4, 3))}
_OWN: Any = {"color": colour("apex"), "lw": 0.8, "marker": "v", "ms": 4.0, "mew": 0.0}
_BODIES = colour("gas")
_BAND: Any = {"color": _BODIES, "alpha": 0.35, "lw": 0.0}
_HALF: Any = {"color": _BODIES, "lw": 1.0, "ls": (0, (1, 1))}


def pictures(drawn: Figure) -> dict[str, bytes]:
    """The `figure` as PNG and SVG, by file name."""
    return style.images("restitution", drawn)


def figure(
    speeds: np.ndarray,
    restitution: np.ndarray,
    captured: np.ndarray,
    *,
    edges: tuple[float, ...] = (),
    critical: float | None = None,
    own_speed: float | None = None,
    single_bodies: CaptureProbability | None = None,
    name: str = "",
) -> Figure:
    """Restitution of the first impact over speeds of approach.

    Parameters
    ----------
    speeds : numpy.ndarray
        Speeds of approach [m/s], ascending, shape (n,).
    restitution : numpy.ndarray
        Coefficients of restitution [-], shape (n,). One is left out where it is NaN: gas stopped
        the body, which neither was captured nor came back.
    captured : numpy.ndarray
        Whether the first impact captures, which is drawn at 0, shape (n,).
    edges : tuple of float
        Speeds at which capture gives way to rebound or the reverse [m/s], ascending; the
        intervals between them that captured speeds lie in are shaded.
    critical : float or None
        Critical velocity [m/s]; None where every speed rebounds.
    own_speed : float or None
        Speed of approach of the case itself [m/s].
    single_bodies : CaptureProbability or None
        What single bodies do at these speeds, drawn as bands and in a panel of its own.
    name : str
        What it belongs to, for the title.
    """
    marks = [mark for mark in (own_speed, critical, *edges) if mark is not None]
    ends = np.array([min([speeds[0], *marks]), max([speeds[-1], *marks])])
    # The unit suits the critical velocity, or the middle of the decades.
    typical = np.array([np.sqrt(ends[0] * ends[1]) if critical is None else critical])
    factor, unit = style.scale_of(typical, unit="m/s")
    x = Quantity(speeds / factor, style.label("speed of approach", unit), True, (), factor)
    bands = _bands(speeds, captured, edges)
    others = [edge for edge in edges if critical is None or not isclose(edge, critical)]

    def dress(axes: Axes) -> None:
        x.dress(axes, "x")
        axes.set_xlim(*(ends / factor * np.array([1.0 / _MARGIN, _MARGIN])))
        if critical is not None:
            axes.axvline(critical / factor, **outcomes.BOUNDARY)

    def draw(axes: Axes) -> None:
        dress(axes)
        axes.set(ylabel="coefficient of restitution [-]", ylim=(-0.03, 1.03))
        for low, high in bands:
            span = (axes.get_xlim()[0] if low is None else low / factor,
                    axes.get_xlim()[1] if high is None else high / factor)  # fmt: skip
            axes.axvspan(*span, color=outcomes.SHADE, lw=0.0, zorder=0)
        for edge in others:
            axes.axvline(edge / factor, **_EDGE)
        if own_speed is not None:
            axes.plot([own_speed / factor] * 2, [-0.03, 1.0], markevery=[1], **_OWN)
        if single_bodies is not None:
            _bodies_restitution(axes, x.values, single_bodies)
        _values(axes, x.values, np.where(captured, np.nan, restitution), captured)

    def draw_share(axes: Axes) -> None:
        dress(axes)
        assert single_bodies is not None
        _captured_share(axes, x.values, single_bodies, factor)

    blocks = [Block("", draw), *([] if single_bodies is None else [Block("", draw_share)])]
    legend = [
        *_legend(critical, others, own_speed, held=bool(bands)),
        *([] if single_bodies is None else _of_bodies(single_bodies)),
        *_of_stopped(np.isnan(restitution) & ~captured),
    ]
    return Page(name, blocks, 1, legend).figure()


def _bodies_restitution(axes: Axes, x: np.ndarray, found: CaptureProbability) -> None:
    """A band from the lowest to the highest of the quantiles of restitution, over speeds ``x``."""
    low, _, high = found.restitution.T
    axes.fill_between(x, low, high, **_BAND)


def _captured_share(axes: Axes, x: np.ndarray, found: CaptureProbability, factor: float) -> None:
    """The captured share with its interval, and the speed at which it falls below a half.

    Speeds ``x`` are in units of ``factor`` [m/s].
    """
    axes.set(ylabel="captured share of bodies [-]", ylim=(-0.03, 1.03))
    axes.fill_between(x, found.low, found.high, **_BAND)
    axes.plot(x, found.probability, color=_BODIES)
    if found.half_velocity is not None:
        axes.axvline(found.half_velocity / factor, **_HALF)


def _of_bodies(found: CaptureProbability) -> list[tuple[Artist, str]]:
    """What the legend says of single bodies."""
    low, _, high = QUANTILES
    band = f"{100 * low:g} to {100 * high:g} % of {found.bodies} bodies; share with 95 % interval"
    rows: list[tuple[Artist, str]] = [(Patch(facecolor=_BODIES, alpha=0.35, lw=0.0), band)]
    if found.half_velocity is not None:
        rows.append((Line2D([], [], **_HALF), f"half are captured at {_told(found.half_velocity)}"))
    return rows


def _of_stopped(stopped: np.ndarray) -> list[tuple[Artist, str]]:
    count = np.count_nonzero(stopped)
    told = f"no rebound, no capture at {count} of {stopped.size} speeds"
    return [(Line2D([], [], ls=""), told)] if count else []


def _values(axes: Axes, x: np.ndarray, bounce: np.ndarray, captured: np.ndarray) -> None:
    """A line through the rebounds, broken where there is none, and captures as points at 0."""
    marker = "o" if x.size <= _DOTTED else ""
    tints: Any = {"mew": 0.0, "clip_on": False}
    axes.plot(x, bounce, "-", marker=marker, color=outcomes.REBOUNDS, **tints)
    axes.plot(
        x[captured], np.zeros(np.count_nonzero(captured)), "o", color=outcomes.CAPTURED, **tints
    )


def _bands(
    speeds: np.ndarray, captured: np.ndarray, edges: tuple[float, ...]
) -> list[tuple[float | None, float | None]]:
    """Intervals of captured speeds [m/s]; None for an end beyond the speeds that are drawn."""
    bounds = [None, *edges, None]
    found = []
    held = bool(captured[0])
    for low, high in pairwise(bounds):
        inside = (speeds > (low or 0.0)) & (speeds < (np.inf if high is None else high))
        # An interval that no speed lies in is the other kind.
        held = bool(np.mean(captured[inside]) > 0.5) if inside.any() else not held
        if held:
            found.append((low, high))
    return found


def _legend(
    critical: float | None, others: list[float], own_speed: float | None, *, held: bool
) -> list[tuple[Artist, str]]:
    found: list[tuple[Artist, str]] = []
    if critical is not None:
        found.append((Line2D([], [], **outcomes.BOUNDARY), f"critical velocity {_told(critical)}"))
    if others:
        told = ", ".join(_told(edge) for edge in others)
        found.append((Line2D([], [], **_EDGE), f"other edges of capture {told}"))
    if own_speed is not None:
        found.append((Line2D([], [], **_OWN), f"speed of the case {_told(own_speed)}"))
    if held:
        found.append((Patch(facecolor=outcomes.SHADE, lw=0.0), outcomes.WORDS["captured"]))
    return found


def _told(speed: float) -> str:
    """A speed with its unit, e.g. ``12.3 mm/s``."""
    factor, unit = style.scale_of(np.array([speed]), unit="m/s")
    return f"{speed / factor:.4g} {unit}"
