"""A surface on one page: map, heights, spectrum, summits, quantiles."""

from __future__ import annotations

import re

from matplotlib.figure import Figure
from matplotlib.text import Text

from asperity.plots import style
from asperity.plots.height_map import Place, draw_map, legible
from asperity.plots.surface_panels import (
    draw_heights,
    draw_quantiles,
    draw_radii,
    draw_spectrum,
    draw_summit_heights,
)
from asperity.results.summary import amount
from asperity.results.surface_report import size_in_words
from asperity.surfaces.description.describe import Description
from asperity.surfaces.measured_surface import Pair, Surface

_SHEET = (style.PAGE, 230.0)
"""Width and height of the page [mm]."""

_SHORTEST = 10

MAP = Place(7.0, 24.0, 58.0, 58.0)
_PANELS = (
    Place(101.0, 32.0, 65.0, 50.0),
    Place(17.0, 110.0, 64.0, 42.0),
    Place(101.0, 110.0, 65.0, 42.0),
    Place(17.0, 177.0, 64.0, 42.0),
    Place(101.0, 177.0, 65.0, 42.0),
)
"""Heights, spectrum, quantiles, heights of the summits and their radii."""

_LINES = ((8.0, 10.0, 75), (12.5, 7.5, 118), (16.5, 7.5, 118))
"""Place from the top [mm], size of the letters [pt] and longest length of the page's head."""


def files(found: Surface | Pair) -> dict[str, bytes]:
    """The page of a surface, or those of a pair and of its composite, by file name."""
    pages = {"surface": of_surface(found)} if isinstance(found, Surface) else _of_pair(found)
    out: dict[str, bytes] = {}
    for name, page in pages.items():
        out |= style.images(name, page)
    return out


def _of_pair(found: Pair) -> dict[str, Figure]:
    pages = {f"surface-{k}": of_surface(one) for k, one in enumerate(found.surfaces, 1)}
    return pages | {"composite": of_composite(found)}


def of_surface(found: Surface) -> Figure:
    """The page of one surface."""
    done = "; ".join(step.words for step in found.prepared.steps) or "not prepared"
    return page(found.description, found.name, done)


def of_composite(found: Pair) -> Figure:
    """The page of two surfaces as one: of the added maps, with the distributions convolved."""
    convolved = f"by convolution Sq {amount(found.height_gaussianity.rms, 'm')}"
    return page(
        found.description,
        f"Composite of {found.name}",
        f"maps added; {convolved}",
        found,
    )


def page(description: Description, title: str, done: str, both: Pair | None = None) -> Figure:
    """One page on a map.

    Parameters
    ----------
    description
        The map and what it says.
    title
        Name of the surface.
    done
        How the map was made ready.
    both
        Where the map is a sum of two: both, whose distributions convolved are drawn too.
    """
    topography = description.topography
    with style.look():
        figure = style.sheet(*_SHEET)
        size = f"{size_in_words(topography)}; Sq {amount(topography.rms_height, 'm')}"
        for (top, letters, longest), line in zip(_LINES, (title, size, done), strict=True):
            text = figure.text(
                MAP.left / style.PAGE, 1.0 - top / _SHEET[1], "", fontsize=letters, parse_math=False
            )
            _write(text, _micro(line), longest)
        draw_map(figure, topography, MAP, _SHEET)
        heights, spectrum, quantiles, summits, radii = (
            figure.add_axes(place.share(_SHEET)) for place in _PANELS
        )
        draw_heights(heights, description, both)
        draw_spectrum(spectrum, description)
        draw_quantiles(quantiles, description, both)
        draw_summit_heights(summits, description, both)
        draw_radii(radii, description)
    return figure


def _write(text: Text, words: str, longest: int) -> None:
    """Write as much of a line as the page is wide."""
    room = (style.PAGE - 2.0 * MAP.left) / style.INCH * style.RESOLUTION
    text.set_text(legible(words, longest))
    while longest > _SHORTEST and text.get_window_extent().width > room:
        longest -= 3
        text.set_text(legible(words, longest))


def _micro(words: str) -> str:
    """Micrometres as print has them."""
    return re.sub(r"(?<= )um\b", "µm", words)
