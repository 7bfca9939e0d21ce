"""Laws of yielding side by side: load and kept work of rough planes over the plasticity index."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from asperity.plots import style
from asperity.plots.style import Panel
from asperity.results.colours import colour

_BEYOND = "#eeeeee"

Curves = Mapping[str, tuple[np.ndarray, np.ndarray]]
"""By law: load over that of elastic asperities, and share of the work of loading kept [-]."""


def figure(index: np.ndarray, curves: Curves, fitted: float) -> Figure:
    """Two panels over the plasticity index: load, and share of the work that is kept.

    Parameters
    ----------
    index : numpy.ndarray
        Plasticity indices (E*/H) sqrt(rms/radius) [-], ascending.
    curves : mapping of str to pairs of numpy.ndarray
        Load and share of each law, by its name; elastic asperities have 1 and 0.
    fitted : float
        Index up to which the laws were fitted; what lies beyond is shaded.
    """

    def load(axes: Axes) -> None:
        _draw(axes, index, {name: pair[0] for name, pair in curves.items()}, 1.0, fitted)
        style.log_axis(axes, *(pair[0] for pair in curves.values()))
        axes.set_ylabel("load over Hertz's [-]")
        style.legend_above(axes)

    def kept(axes: Axes) -> None:
        _draw(axes, index, {name: pair[1] for name, pair in curves.items()}, 0.0, fitted)
        axes.set_ylabel("share of work kept [-]")
        axes.set_ylim(-0.03, 1.0)

    with style.look():
        return style.figure_of([[Panel(1.0, load)], [Panel(1.0, kept)]])


def _draw(
    axes: Axes, index: np.ndarray, lines: Mapping[str, np.ndarray], elastic: float, fitted: float
) -> None:
    """One line a law over the index, beside that of elastic asperities."""
    axes.plot(index, np.full(index.shape, elastic), color=colour("contact"), label="Hertz")
    laws = {name: (index, line) for name, line in lines.items()}
    style.lines(axes, laws, "plasticity index [-]")
    if fitted < index[-1]:
        axes.axvspan(fitted, index[-1], color=_BEYOND, lw=0.0, zorder=0, label="beyond the fits")
