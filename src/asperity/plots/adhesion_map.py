"""Johnson and Greenwood's adhesion map, with cases on it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from math import inf, log

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.text import Text

from asperity.plots import style
from asperity.plots.point_labels import name_points
from asperity.plots.style import Panel
from asperity.publication.figure_data import Drawing, map_lines
from asperity.regimes import Boundary, Frame, Place, regions
from asperity.results.colours import colour

REGIONS = {
    "Bradley": (0.0045, 1.5),
    "DMT": (0.033, 6.0),
    "Maugis-Dugdale": (0.6, 6.0),
    "JKR": (25.0, 6.0),
    "Hertz": (0.15, 2e4),
}
"""Where the names of the regions stand if nothing is in the way."""

_ACROSS, _UP = 80, 60
_COLUMNS = ("elasticity parameter [1]", "load parameter [1]")
_TINTS = ("motion", "unloading", "capillary", "apex", "central", "quiet")
_MARKS = "osDhpP"


def files(
    frame: Frame, boundaries: Sequence[Boundary], places: Sequence[Place]
) -> tuple[bytes, bytes, bytes]:
    """The map as PNG and SVG, and its lines and places as CSV."""
    drawn = figure(frame, boundaries, places)
    return style.png(drawn), style.svg(drawn), drawing(boundaries, places).csv()


def drawing(boundaries: Sequence[Boundary], places: Sequence[Place]) -> Drawing:
    """The map's data: a series for each line, by the models on its sides, and for each place."""
    series = map_lines(boundaries)
    for place in places:
        series[f"case {place.name}"] = (np.array([place.elasticity]), np.array([place.load]))
    title = "Adhesion map (Johnson and Greenwood's, 5 % criteria) with cases on it"
    return Drawing(title, _COLUMNS, series, {})


def figure(frame: Frame, boundaries: Sequence[Boundary], places: Sequence[Place]) -> Figure:
    """The map, with each place labelled by its case's name."""
    lines = drawing(boundaries, ()).series

    def draw(axes: Axes) -> None:
        draw_lines(axes, lines, frame)
        spots = [_spot(frame, place) for place in places]
        taken = name_regions(axes, frame, [point for point, _ in spots])
        _mark(axes, spots, [place.name for place in places], taken)

    with style.look():
        return style.figure_of([[Panel(1.0, draw)]])


def draw_lines(axes: Axes, lines: Mapping[str, tuple[np.ndarray, ...]], frame: Frame) -> None:
    """Draw the map's lines, those below the Hertz line as far as it, on the map's axes."""
    limit = [np.log(values) for values in lines["Hertz | adhesive"]]
    for name, (x, y) in lines.items():
        if not name.startswith("Hertz"):
            below = np.log(y) < np.interp(np.log(x), *limit)
            x, y = x[below], y[below]
        axes.plot(x, y, color=colour("contact"), lw=0.8)
    axes.set(xscale="log", yscale="log", xlim=frame.elasticity, ylim=frame.load)
    axes.set_xlabel("elasticity parameter λ [-]")
    axes.set_ylabel("load parameter [-]")


def name_regions(axes: Axes, frame: Frame, points: Sequence[tuple[float, float]]) -> list[Text]:
    """Write each region's name inside it, off the points (in units of the axes)."""
    across, up = np.linspace(0.0, 1.0, _ACROSS), np.linspace(0.0, 1.0, _UP)
    loads = _value(up, frame.load)
    names = np.array([regions(float(x), loads) for x in _value(across, frame.elasticity)])
    grid = np.stack(np.meshgrid(across, up, indexing="ij"), axis=-1)
    marks = np.array(points).reshape(-1, 2)
    return [
        text
        for name, (x, y) in REGIONS.items()
        if (text := _name(axes, name, _spot(frame, Place("", x, y))[0], grid, names, marks))
    ]


def _name(
    axes: Axes,
    name: str,
    usual: tuple[float, float],
    grid: np.ndarray,
    names: np.ndarray,
    marks: np.ndarray,
) -> Text | None:
    """A region's name, as near to its usual place as it fits, upright or turned."""
    text = axes.text(
        *usual, name.replace("-", "-\n"), transform=axes.transAxes, ha="center", va="center",
        color="#444444", fontsize=7.0,
    )  # fmt: skip
    blocked = np.concatenate([grid[names != name], marks])
    own = grid[names == name]
    for turn in (0.0, 90.0):
        text.set_rotation(turn)
        box = text.get_window_extent()
        half = 0.55 * np.array([box.width, box.height]) / axes.bbox.size
        inside = own[np.all((own >= half) & (own <= 1.0 - half), axis=1)]
        places = np.concatenate([[usual], inside])
        for place in places[np.argsort(np.hypot(*(places - usual).T), kind="stable")]:
            if not np.any(np.all(np.abs(blocked - place) < half, axis=1)):
                text.set_position(place)
                return text
    text.remove()
    return None


def _mark(
    axes: Axes,
    spots: Sequence[tuple[tuple[float, float], str]],
    names: Sequence[str],
    taken: Sequence[Text],
) -> None:
    """A mark and a name for each place; an arrow head at the edge for one off the frame."""
    tints = [colour(_TINTS[number % len(_TINTS)]) for number in range(len(spots))]
    for number, ((point, arrow), tint) in enumerate(zip(spots, tints, strict=True)):
        axes.plot(
            *point, arrow or _MARKS[number % len(_MARKS)], transform=axes.transAxes, ms=4.0,
            mew=0.9, mec=tint, mfc=tint if arrow else "none", clip_on=False,
        )  # fmt: skip
    name_points(axes, np.array([point for point, _ in spots]), names, tints, taken)


def _spot(frame: Frame, place: Place) -> tuple[tuple[float, float], str]:
    """Where a place is drawn, in units of the axes, and the way to it if that is the edge."""
    across = _share(place.elasticity, frame.elasticity)
    up = _share(place.load, frame.load) if place.load > 0.0 else -inf
    arrow = ""
    if not 0.0 <= across <= 1.0:
        arrow = "<" if across < 0.0 else ">"
    if not 0.0 <= up <= 1.0:
        arrow = "v" if up < 0.0 else "^"
    return (min(max(across, 0.0), 1.0), min(max(up, 0.0), 1.0)), arrow


def _share(value: float, ends: tuple[float, float]) -> float:
    return log(value / ends[0]) / log(ends[1] / ends[0])


def _value(share: np.ndarray, ends: tuple[float, float]) -> np.ndarray:
    return ends[0] * (ends[1] / ends[0]) ** share
