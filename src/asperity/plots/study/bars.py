"""Sobol's indices as bars, with their intervals of confidence."""

from __future__ import annotations

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Patch

from asperity.plots import style
from asperity.plots.study.panels import Block, Page
from asperity.results.colours import colour
from asperity.sweeps.analysis.sensitivity import CONFIDENCE, Index, Sensitivity

_KINDS = (("alone", "motion", -0.2), ("with others", "central", 0.2))
_LONGEST = 14


def pictures(found: Sensitivity) -> dict[str, bytes]:
    """The bars as PNG and SVG, by file name."""
    return style.images("sensitivity", figure(found))


def figure(found: Sensitivity) -> Figure:
    """First-order and total indices of every axis, side by side."""
    legend: list[tuple[Artist, str]] = [
        (Patch(facecolor=colour(tint), lw=0.0), name) for name, tint, _ in _KINDS
    ]

    def draw(axes: Axes) -> None:
        for (_, tint, shift), index in zip(_KINDS, (found.first, found.total), strict=True):
            _bars(axes, index, shift, colour(tint))
        axes.axhline(0.0, color=colour("quiet"), lw=0.4, zorder=0)
        axes.set_xticks(range(len(found.labels)), [_folded(label) for label in found.labels])
        axes.set_xlim(-0.6, len(found.labels) - 0.4)
        axes.set_ylabel("share of the variance [-]")

    about = f"{found.cases} cases, {100.0 * CONFIDENCE:g} % intervals"
    return Page(found.meaning, [Block(about, draw)], 1, legend).figure()


def _bars(axes: Axes, index: Index, shift: float, tint: str) -> None:
    place = np.arange(index.value.size) + shift
    axes.bar(place, index.value, 0.36, color=tint, lw=0.0)
    axes.vlines(place, index.low, index.high, color=colour("contact"), lw=0.8)


def _folded(label: str) -> str:
    """A label on two lines where it is long."""
    words = label.split()
    half = (len(words) + 1) // 2
    lines = [label] if len(label) <= _LONGEST else [" ".join(words[:half]), " ".join(words[half:])]
    return "\n".join(
        line if len(line) <= _LONGEST else f"{line[: _LONGEST - 2]}.." for line in lines
    )
