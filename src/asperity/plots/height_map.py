"""A map of heights: true to scale, with a scale bar, a colour bar and its missing pixels."""

from __future__ import annotations

from math import floor, isfinite, log10
from typing import NamedTuple

import numpy as np
from matplotlib import colormaps
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.font_manager import findfont, get_font
from matplotlib.image import AxesImage

from asperity.errors import one_line
from asperity.plots import style
from asperity.results.summary import amount
from asperity.surfaces import Topography

_FINEST = 640
"""Pixels a side that a picture shows; of a map with twice as many or more, blocks are averaged."""

_SLIMMEST = 8.0
"""Sides of a map whose ratio is larger are drawn alike, and the picture says so."""

_CLIPPED = 0.5
"""Percent of the heights at either end that may share a colour."""

_MISSING = "#D55E00"
_BAR, _LEAST_BAR = 2.5, 22.0


class Place(NamedTuple):
    """Where a map stands on a page: from its left and its top, and its room [mm]."""

    left: float
    top: float
    width: float
    height: float

    def share(self, page: tuple[float, float]) -> tuple[float, float, float, float]:
        """The place as matplotlib has it: in parts of a page [mm], from below."""
        wide, tall = page
        bottom = tall - self.top - self.height
        return self.left / wide, bottom / tall, self.width / wide, self.height / tall


def draw_map(
    figure: Figure, topography: Topography, room: Place, page: tuple[float, float]
) -> Axes:
    """Draw a map with its bars.

    Parameters
    ----------
    figure
        The page.
    topography
        The map.
    room
        What the map may take; the colour bar stands to the right of it and the scale bar below.
    page
        Width and height of the page [mm].
    """
    wide, tall = topography.physical_size
    place = _fitted(room, wide / tall)
    axes = figure.add_axes(place.share(page))
    factor, unit = style.scale_of(topography.heights, unit="m")
    image, clipped = _image(axes, topography, factor)
    bar_height = max(place.height, min(_LEAST_BAR, room.height))
    beside = Place(place.left + place.width + 2.0, place.top, _BAR, bar_height)
    style.colour_bar(figure, image, beside.share(page), style.label("height", unit), clipped)
    _scale_bar(axes, topography, place)
    return axes


def coarse(heights: np.ndarray) -> np.ndarray:
    """A map of as many pixels as a picture shows, each the mean of a block.

    A block is missing where more than half of it is; rows and columns that fill no block are
    left out.
    """
    steps = [max(1, count // _FINEST) for count in heights.shape]
    if max(steps) == 1:
        return heights
    rows, columns = (count // step for count, step in zip(heights.shape, steps, strict=True))
    blocks = heights[: rows * steps[0], : columns * steps[1]]
    blocks = blocks.reshape(rows, steps[0], columns, steps[1])
    known = np.isfinite(blocks)
    count = known.sum(axis=(1, 3))
    total = np.where(known, blocks, 0.0).sum(axis=(1, 3))
    enough = 2 * count >= steps[0] * steps[1]
    made: np.ndarray = np.divide(total, count, out=np.full(count.shape, np.nan), where=enough)
    return made


def legible(text: str, longest: int = 60) -> str:
    """Text on one line that the picture's letters can write, cut where it is long."""
    font = get_font(findfont("DejaVu Sans"))
    written = "".join(sign if font.get_char_index(ord(sign)) else "?" for sign in one_line(text))
    return written if len(written) <= longest else f"{written[: longest - 3]}..."


def colour_limits(heights: np.ndarray) -> tuple[float, float, str]:
    """Least and largest height with a colour of its own, and which ends of the bar go on.

    Peaks that few pixels hold would leave the rest in one colour.
    """
    known = heights[np.isfinite(heights)]
    least, most = float(known.min()), float(known.max())
    low, high = (float(value) for value in np.percentile(known, (_CLIPPED, 100.0 - _CLIPPED)))
    span = high - low
    if span <= 0.0:
        return least, most, "neither"
    below, above = least < low - 0.5 * span, most > high + 0.5 * span
    ends = {(False, False): "neither", (True, False): "min", (False, True): "max"}
    return (
        low if below else least, high if above else most, ends.get((below, above), "both")
    )  # fmt: skip


def _image(axes: Axes, topography: Topography, factor: float) -> tuple[AxesImage, str]:
    heights = coarse(topography.heights) / factor
    low, high, clipped = colour_limits(heights)
    colours = colormaps["cividis"].with_extremes(bad=_MISSING)
    image = axes.imshow(
        np.ma.masked_invalid(heights), origin="lower", cmap=colours, vmin=low, vmax=high,
        interpolation="nearest", aspect="auto", extent=(0.0, 1.0, 0.0, 1.0),
    )  # fmt: skip
    axes.set(xticks=[], yticks=[])
    for side in axes.spines.values():
        side.set_visible(False)
    return image, clipped


def _fitted(room: Place, ratio: float) -> Place:
    """The largest rectangle of a ratio of width to height within some room, top left."""
    ratio = min(max(ratio, 1.0 / _SLIMMEST), _SLIMMEST)
    width = min(room.width, room.height * ratio)
    return Place(room.left, room.top, width, width / ratio)


def _scale_bar(axes: Axes, topography: Topography, place: Place) -> None:
    """A bar of a round length below the map, and what its colours do not say."""
    width, length = topography.physical_size
    bar = round_length(width * min(0.5, 25.0 / place.width))
    share, low = bar / width, -2.2 / place.height
    axes.plot((0.0, share), (low, low), color="black", lw=2.0, transform=axes.transAxes,
              clip_on=False, solid_capstyle="butt")  # fmt: skip
    notes = [(amount(bar, "m").replace("um", "µm"), "black", (share, 4.0))]
    if not 1.0 / _SLIMMEST <= width / length <= _SLIMMEST:
        tall = amount(length, "m").replace("um", "µm")
        notes.append((f"height {tall}, not to scale", "black", (0.0, 0.0)))
    if topography.missing_pixels:
        missing = f"■ {topography.missing_pixels} pixels missing"
        notes.append((missing, _MISSING, (0.0, 0.0)))
    for line, (words, tint, (start, shift)) in enumerate(notes):
        axes.annotate(words, (start, low), (shift, -11.0 * line), "axes fraction", "offset points",
                      va="center", color=tint, annotation_clip=False, fontsize=7.0)  # fmt: skip


def round_length(most: float) -> float:
    """The largest of 1, 2, 5, 10, ... that does not exceed a positive length, in its unit."""
    if not (isfinite(most) and most > 0.0):
        return most
    decade = 10.0 ** floor(log10(most))
    part = max(step for step in (1.0, 2.0, 5.0) if step * decade <= most * (1.0 + 1e-9))
    return part * decade
