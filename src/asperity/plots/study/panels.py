"""A page of panels with one title, one legend and one colour bar for all."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from math import ceil
from typing import NamedTuple

from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.figure import Figure

from asperity.plots import style
from asperity.plots.height_map import legible

_LEFT, _RIGHT, _EDGE, _LINE, _HEAD, _HEIGHT = 16.0, 3.0, 2.0, 4.0, 4.0, 55.0
_PAD, _GAP = 1.0 / style.INCH, 0.04
_SLIM = 17.0
_LETTER, _HANDLE = 1.45, 8.0
_TITLE_LETTER = 1.55


class Block(NamedTuple):
    """One pair of axes: its title, and what draws into it."""

    title: str
    draw: Callable[[Axes], None]


@dataclass
class Page:
    """What stands on a page.

    Parameters
    ----------
    title
        One line over everything; "" for none.
    blocks
        The panels, row by row.
    across
        Panels a row.
    legend
        Handles with their names, for all panels.
    bar
        Colours of the bar beside the panels.
    bar_label
        What they measure.
    """

    title: str
    blocks: Sequence[Block]
    across: int = 1
    legend: list[tuple[Artist, str]] = field(default_factory=list)
    bar: ScalarMappable | None = None
    bar_label: str = ""

    def figure(self) -> Figure:
        """The page drawn; one column wide where it has one panel a row."""
        with style.look():
            return self._drawn()

    def _drawn(self) -> Figure:
        wide = style.COLUMN if self.across == 1 else style.PAGE
        rows, columns = ceil(len(self.blocks) / self.across), self._legend_columns(wide)
        lines = bool(self.title) + ceil(len(self.legend) / columns)
        over = _HEAD * any(block.title for block in self.blocks)
        figure = style.sheet(wide, _EDGE + _LINE * lines + rows * (_HEIGHT + over))
        figure.set_layout_engine("constrained", w_pad=_PAD, h_pad=_PAD, hspace=_GAP)
        panels = []
        for number, block in enumerate(self.blocks, start=1):
            axes = figure.add_subplot(rows, self.across, number)
            block.draw(axes)
            longest = int((wide / self.across - _LEFT - _RIGHT) / _TITLE_LETTER)
            axes.set_title(legible(block.title, longest), parse_math=False)
            panels.append(axes)
        if self.bar is not None:
            bar = figure.colorbar(self.bar, ax=panels, label=self.bar_label, aspect=_SLIM)
            bar.outline.set_visible(False)
        if lines:
            legend = figure.legend(
                [handle for handle, _ in self.legend],
                [name for _, name in self.legend],
                loc="outside upper left",
                ncols=columns,
                alignment="left",
                borderaxespad=0.7,
                title=legible(self.title, int((wide - 2.0 * _EDGE) / _TITLE_LETTER)),
            )
            legend.get_title().set_parse_math(False)
        figure.draw_without_rendering()
        figure.set_layout_engine("none")  # laid out once, or each drawing would differ a little
        return figure

    def _legend_columns(self, wide: float) -> int:
        """Entries side by side that fit over the panels."""
        longest = max((len(name) for _, name in self.legend), default=1)
        fit = int((wide - _LEFT - _RIGHT) / (_HANDLE + _LETTER * longest))
        return max(1, min(fit, len(self.legend)))
