"""From rigid to soft spheres: pull-off force and hysteresis over the Tabor number."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from asperity.plots import style
from asperity.plots.style import Panel
from asperity.results.colours import colour

_LIMITS = {"Bradley, DMT": 2.0, "JKR": 1.5}

Curves = Mapping[str, tuple[np.ndarray, np.ndarray, np.ndarray]]
"""By law: Tabor numbers, pull-off force over pi w R, and energy lost in a cycle over JKR's [-]."""


def figure(curves: Curves) -> Figure:
    """Two panels over the Tabor number: pull-off force, and energy lost in a cycle.

    Parameters
    ----------
    curves : mapping of str to triples of numpy.ndarray
        By the name of a law; Tabor numbers are ascending.
    """

    def pull_off(axes: Axes) -> None:
        for name, height in _LIMITS.items():
            axes.axhline(height, color=colour("contact"), lw=0.8, zorder=0)
            axes.annotate(
                name, (0.98, height), (0.0, 2.0), xycoords=("axes fraction", "data"),
                textcoords="offset points", ha="right", va="bottom",
            )  # fmt: skip
        laws = {name: (tabor, pull) for name, (tabor, pull, _) in curves.items()}
        style.lines(axes, laws, "Tabor number [-]")
        axes.set_ylabel("pull-off force / (π w R) [-]")
        axes.set_ylim(1.4, 2.12)
        style.legend_above(axes)

    def lost(axes: Axes) -> None:
        laws = {name: (tabor, share) for name, (tabor, _, share) in curves.items()}
        style.lines(axes, laws, "Tabor number [-]")
        axes.set_ylabel("energy lost / JKR's [-]")
        axes.set_ylim(-0.03, 1.03)

    with style.look():
        return style.figure_of([[Panel(1.0, pull_off)], [Panel(1.0, lost)]])
