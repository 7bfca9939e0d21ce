"""Names beside points of a picture, none on another."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import product
from math import cos, pi, sin

import numpy as np
from matplotlib.axes import Axes
from matplotlib.text import Text
from matplotlib.transforms import Bbox

_DISTANCES = (0.8, 2.0, 4.0, 6.5, 9.5, 13.0, 17.0, 22.0, 28.0)
_DIRECTIONS = 24
_PAD = 0.4
_LED = 1.5
_ACROSS, _ON = 10.0, 1000.0
_LONGEST = 30


def name_points(
    axes: Axes,
    points: np.ndarray,
    names: Sequence[str],
    colours: Sequence[str],
    taken: Sequence[Text],
) -> None:
    """Write a name beside each point, with a thin line to it where it stands away from it.

    Names stay within the axes and off each other, off the points and off other texts, and off
    drawn lines where there is room.

    Parameters
    ----------
    axes
        With its limits set and its lines drawn.
    points
        Places in units of the axes, (0, 0) to (1, 1), shape (points, 2).
    names, colours
        One for each point; a long name is cut.
    taken
        Texts to keep off.
    """
    millimetre = axes.figure.dpi / 25.4
    spots = axes.transAxes.transform(points)
    boxes = [text.get_window_extent() for text in taken]
    boxes += [Bbox.from_extents(*(spot - millimetre), *(spot + millimetre)) for spot in spots]
    lines = np.concatenate([axes.transData.transform(line.get_xydata()) for line in axes.lines])
    for spot, name, tint in zip(spots, names, colours, strict=True):
        text = _text(axes, name, tint)
        size = text.get_window_extent()
        others = [box for box in boxes if not box.contains(*spot)]
        costs = [
            (distance + _hindrance(box, spot, boxes, others, lines), box, distance)
            for distance, box in _boxes(spot, size, axes.bbox, millimetre)
        ]
        _, box, distance = min(costs, key=lambda cost: cost[0])
        boxes.append(box)
        led = distance > _LED
        _settle(axes, text, box, spot if led else None)
        if led:
            lines = np.concatenate([lines, _leader(box, spot)])


def _text(axes: Axes, name: str, tint: str) -> Text:
    short = name if len(name) <= _LONGEST else f"{name[: _LONGEST - 3]}..."
    return axes.text(
        0.5, 0.5, short, transform=axes.transAxes, ha="center", va="center", fontsize=6.5,
        color=tint, bbox={"facecolor": "white", "lw": 0.0, "pad": 0.6},
    )  # fmt: skip


def _settle(axes: Axes, text: Text, box: Bbox, spot: np.ndarray | None) -> None:
    """Put a text into its box, and draw the line from it to its point."""
    inverse = axes.transAxes.inverted()
    text.set_position(tuple(inverse.transform((0.5 * (box.x0 + box.x1), 0.5 * (box.y0 + box.y1)))))
    if spot is not None:
        ends = inverse.transform([_nearest(box, spot), spot])
        axes.plot(*ends.T, transform=axes.transAxes, color=text.get_color(), lw=0.4)


def _boxes(
    spot: np.ndarray, size: Bbox, room: Bbox, millimetre: float
) -> Iterator[tuple[float, Bbox]]:
    """Places for a text about a point that lie within the room, with their distance [mm]."""
    half = 0.5 * np.array([size.width, size.height]) + _PAD * millimetre
    for distance, step in product(_DISTANCES, range(_DIRECTIONS)):
        way = np.array([cos(2.0 * pi * step / _DIRECTIONS), sin(2.0 * pi * step / _DIRECTIONS)])
        middle = spot + way * ((distance + 1.0) * millimetre + half)
        low, high = middle - half, middle + half
        if np.all(low >= room.min) and np.all(high <= room.max):
            yield distance, Bbox.from_extents(*low, *high)


def _hindrance(
    box: Bbox,
    spot: np.ndarray,
    boxes: Sequence[Bbox],
    others: Sequence[Bbox],
    lines: np.ndarray,
) -> float:
    """What speaks against a place: texts and points under it, lines across it or its leader."""
    cost = _ON * sum(box.overlaps(other) for other in boxes)
    inside = np.all((lines >= box.min) & (lines <= box.max), axis=1)
    leader = _leader(box, spot)[:, None]
    low = np.array([other.min for other in others]).reshape(-1, 2)
    high = np.array([other.max for other in others]).reshape(-1, 2)
    struck = np.any(np.all((leader >= low) & (leader <= high), axis=2), axis=0).sum()
    return float(cost + _ACROSS * inside.any() + _ACROSS * struck)


def _leader(box: Bbox, spot: np.ndarray) -> np.ndarray:
    """Points along the line from a text to its point."""
    return np.linspace(_nearest(box, spot), spot, 20)


def _nearest(box: Bbox, spot: np.ndarray) -> np.ndarray:
    nearest: np.ndarray = np.clip(spot, box.min, box.max)
    return nearest
