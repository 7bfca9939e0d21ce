"""A page of panels with one title, one legend and one colour bar for all."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from math import ceil
from typing import NamedTuple

from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.cm import ScalarMappable
from matplotlib.figure import Figure

from asperity.plots import style
from asperity.plots.height_map import legible

_INCH = 25.4
_LEFT, _RIGHT, _BOTTOM, _GAP = 16.0, 3.0, 11.0, 18.0
_BAR_ROOM, _BAR, _BAR_GAP = 17.0, 2.5, 2.5
_HEIGHT, _EDGE, _LINE, _HEAD = 42.0, 2.0, 4.0, 5.0
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
        rows = ceil(len(self.blocks) / self.across)
        columns = self._legend_columns(wide)
        legend_rows = ceil(len(self.legend) / columns) if self.legend else 0
        head = _EDGE + _LINE * (bool(self.title) + legend_rows) + (1.0 if self.legend else 0.0)
        over = _HEAD if any(block.title for block in self.blocks) else _EDGE
        step = over + _HEIGHT + _BOTTOM
        tall = head + rows * step
        figure = style.Picture(figsize=(wide / _INCH, tall / _INCH), dpi=style.RESOLUTION)
        FigureCanvasAgg(figure)
        right = _RIGHT + (_BAR_ROOM if self.bar is not None else 0.0)
        width = (wide - _LEFT - right - _GAP * (self.across - 1)) / self.across
        for number, block in enumerate(self.blocks):
            row, column = divmod(number, self.across)
            left, top = _LEFT + column * (width + _GAP), head + over + row * step
            place = (left / wide, 1.0 - (top + _HEIGHT) / tall, width / wide, _HEIGHT / tall)
            axes = figure.add_axes(place)
            axes.set_title(legible(block.title, int(width / _TITLE_LETTER)), parse_math=False)
            block.draw(axes)
        self._head(figure, (wide, tall), columns)
        if self.bar is not None:
            left = wide - right + _BAR_GAP
            place = (left / wide, 1.0 - (head + over + _HEIGHT) / tall, _BAR / wide, _HEIGHT / tall)
            bar = figure.colorbar(self.bar, cax=figure.add_axes(place))
            bar.set_label(self.bar_label)
            bar.outline.set_visible(False)
        return figure

    def _head(self, figure: Figure, size: tuple[float, float], columns: int) -> None:
        """The title and the legend."""
        wide, tall = size
        top = _EDGE
        if self.title:
            longest = int((wide - 2.0 * _EDGE) / _TITLE_LETTER)
            figure.text(
                _EDGE / wide, 1.0 - top / tall, legible(self.title, longest), va="top",
                parse_math=False,
            )  # fmt: skip
            top += _LINE
        if self.legend:
            handles, names = zip(*self.legend, strict=True)
            figure.legend(
                handles, names, loc="upper left", ncols=columns, borderpad=0.0,
                bbox_to_anchor=(_LEFT / wide, 1.0 - (top + 0.5) / tall),
            )  # fmt: skip

    def _legend_columns(self, wide: float) -> int:
        """Entries side by side that fit over the panels."""
        longest = max((len(name) for _, name in self.legend), default=1)
        fit = int((wide - _LEFT - _RIGHT) / (_HANDLE + _LETTER * longest))
        return max(1, min(fit, len(self.legend)))
