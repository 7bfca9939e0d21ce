"""Figures 2 and 3 of the publication from two measured surfaces."""

from __future__ import annotations

import numpy as np

from ..surfaces.measured_surface import Pair
from .figure_data import Columns, Drawing, gaussian, map_columns

_FINEST = 150
"""Pixels a side that Figure 2 shows and its table holds, of more every second, third and so on."""

_BINS = 51
_TAIL = 1e-5
_REACH = 8.0


def heights(found: Pair) -> Drawing:
    """Figure 2: the heights of the composite, both maps added."""
    surface = found.description.topography
    every = max(-(-count // _FINEST) for count in surface.heights.shape)
    shown = surface.heights[::every, ::every]
    steps = [every * step for step in surface.pixel_size]
    rows, columns = shown.shape
    return Drawing(
        f"Figure 2: heights of {found.name}, {found.how}",
        ("x [m]", "y [m]", "height [m]"),
        {found.name: map_columns(shown, steps)},
        {"rows": rows, "columns": columns, "pixels left out between two": every - 1,
         "rms height [m]": surface.rms_height},
    )  # fmt: skip


def distribution(found: Pair) -> Drawing:
    """Figure 3: the convolution of the two distributions of heights against the Gaussian."""
    both, peaks = found.heights, found.summits
    shape = found.height_gaussianity
    low, high = np.interp((_TAIL, 1.0 - _TAIL), both.cumulative, both.heights)
    half_width = _REACH * shape.rms
    edges = np.linspace(max(low, -half_width), min(high, half_width), _BINS + 1)
    middle = 0.5 * (edges[1:] + edges[:-1])
    series: dict[str, Columns] = {found.name: (middle, both.in_bins(edges))}
    about = {
        "rms height [m]": shape.rms,
        "skewness [-]": shape.skewness,
        "kurtosis [-]": shape.kurtosis,
        "Kolmogorov-Smirnov statistic [-]": shape.statistic,
    }
    if peaks is not None:
        series["summits"] = (middle, peaks.in_bins(edges))
        about["summits' rms [m]"] = peaks.rms
    series["Gaussian"] = gaussian(edges[0], edges[-1], shape.rms)
    return Drawing(
        f"Figure 3: heights of {found.name} by convolution of their distributions, each about "
        "its mean, against the Gaussian",
        ("height [m]", "probability density [1/m]"),
        series,
        about,
    )
