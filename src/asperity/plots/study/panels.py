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
from matplotlib.transforms import BboxBase

from asperity.plots import style
from asperity.plots.height_map import legible

_LEFT, _RIGHT, _BOTTOM, _BETWEEN = 16.0, 3.0, 11.0, 2.0
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
        figure = style.sheet(wide, tall)
        size = (0.0, 0.0, 1.0, _HEIGHT / tall)
        panels = [figure.add_axes(size) for _ in self.blocks]
        for axes, block in zip(panels, self.blocks, strict=True):
            block.draw(axes)
        place = (0.0, 0.0, _BAR / wide, _HEIGHT / tall)
        bar = style.colour_bar(figure, self.bar, place, self.bar_label) if self.bar else None
        right = _RIGHT + (_room_after(bar) if bar is not None else 0.0)
        room = _room_beside(panels)
        width = (wide - right - room * self.across - _BETWEEN * (self.across - 1)) / self.across
        for number, (axes, block) in enumerate(zip(panels, self.blocks, strict=True)):
            row, column = divmod(number, self.across)
            left = room + column * (width + _BETWEEN + room)
            foot = 1.0 - (head + over + row * step + _HEIGHT) / tall
            axes.set_position((left / wide, foot, width / wide, _HEIGHT / tall))
            ahead = room - _LEFT  # titles keep the length that usual labels leave them
            text = legible(block.title, int((width + ahead) / _TITLE_LETTER))
            axes.set_title(text, x=-ahead / width, parse_math=False)
        self._head(figure, (wide, tall), columns)
        if bar is not None:
            foot = 1.0 - (head + over + _HEIGHT) / tall
            left = (wide - right + _BAR_GAP) / wide
            bar.set_position((left, foot, _BAR / wide, _HEIGHT / tall))
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


def _room_beside(panels: Sequence[Axes]) -> float:
    """Width that the widest labels left of a panel need [mm], the usual one at least."""
    wide = max(panel.bbox.x0 - _labels(panel).x0 for panel in panels)
    return max(_LEFT, wide / style.RESOLUTION * style.INCH + 1.0)


def _room_after(bar: Axes) -> float:
    """Width of a colour bar with its labels [mm], the usual one at least."""
    wide = (_labels(bar).x1 - bar.bbox.x0) / style.RESOLUTION * style.INCH
    return max(_BAR_ROOM, _BAR_GAP + wide + 1.0 - _RIGHT)


def _labels(axes: Axes) -> BboxBase:
    """Place of the axis upwards with all its text [pixel]."""
    return axes.yaxis.get_tightbbox() or axes.bbox
