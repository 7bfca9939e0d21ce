"""The panels of a surface's page: distributions, spectrum, summits."""

from __future__ import annotations

from collections.abc import Sequence
from math import ceil, floor, log10, pi, sqrt

import numpy as np
from matplotlib.axes import Axes
from matplotlib.ticker import MaxNLocator, NullFormatter

from asperity.plots import style
from asperity.results.colours import colour
from asperity.surfaces.description.convolution import HeightDistribution
from asperity.surfaces.description.describe import Description
from asperity.surfaces.description.spectrum import ProfileSpectrum
from asperity.surfaces.measured_surface import Pair

_REACH = 6.0
"""Standard deviations on either side that a histogram shows at most."""

_MOST_BINS = 80
_DOTS = 2500
_SPECTRUM_POINTS = 160
_GUIDES = ((0.5, "--"), (1.0, ":"))
_GUIDED = 8
_DECADE = 10.0
_ROUNDING = 1e-12


def heading(axes: Axes, words: str, rows: int = 1) -> None:
    """A title above the legend, which has one row or two."""
    axes.set_title(words, pad=9.0 + 11.0 * rows)


def empty(axes: Axes, words: str) -> None:
    """A panel that has nothing to show, and why."""
    axes.text(0.5, 0.5, words, transform=axes.transAxes, ha="center", va="center", color="#444444")
    axes.set(xticks=[], yticks=[])


def draw_heights(axes: Axes, description: Description, both: Pair | None = None) -> None:
    """Heights about their mean as a histogram, with the Gaussian of the same rms."""
    shape = description.heights
    if shape is None:
        heading(axes, "Heights")
        empty(axes, "the map is flat")
        return
    heading(axes, f"Heights: skewness {shape.skewness:.3g}, kurtosis {shape.kurtosis:.3g}")
    heights = description.topography.heights
    known = heights[np.isfinite(heights)]
    known = known - known.mean()
    factor, unit, edges = _histogram(axes, known, shape.rms, "heights", "central")
    if both is not None:
        _convolved(axes, both.heights, edges, factor)
    _gaussian(axes, edges, 0.0, shape.rms, factor)
    _height_axes(axes, "height", unit, _beyond(known, edges))
    style.legend_above(axes, 1)


def draw_spectrum(axes: Axes, description: Description) -> None:
    """Power spectral density of the profiles, with the slopes of self-affine surfaces."""
    heading(axes, "Power spectral density of profiles", 2)
    shown = []
    for name, one, tint in (
        ("along x", description.along_x, "motion"),
        ("along y", description.along_y, "unloading"),
    ):
        if one is not None and (points := _binned(one))[0].size:
            axes.plot(*points, color=colour(tint), label=name,
                      marker="o" if points[0].size < _GUIDED else None)  # fmt: skip
            shown.append(points)
    if not shown:
        empty(axes, "no profile is complete and rough")
        return
    axes.set(xscale="log", yscale="log")
    _guides(axes, shown)
    for axis, ends, limit in (
        (axes.xaxis, axes.get_xlim(), axes.set_xlim),
        (axes.yaxis, axes.get_ylim(), axes.set_ylim),
    ):
        axis.set_minor_formatter(NullFormatter())
        if ends[1] < _DECADE * ends[0]:
            limit(10.0 ** floor(log10(ends[0])), 10.0 ** ceil(log10(ends[1])))
    axes.set_xlabel("wavenumber q [rad/m]")
    axes.set_ylabel("density C(q) [m³]")
    style.legend_above(axes, 2)


def draw_quantiles(axes: Axes, description: Description, both: Pair | None = None) -> None:
    """Quantiles of the heights and of the summits against the Gaussian's."""
    heading(axes, "Quantiles; straight: Gaussian")
    shown = [
        ("heights", description.heights, "motion", "o"),
        ("summits", description.summit_heights, "unloading", "^"),
        ("convolution", both and both.height_gaussianity, "capillary", "s"),
    ]
    ends = [shape.quantiles for _, shape, _, _ in shown if shape]
    if not ends:
        empty(axes, "the map is flat")
        return
    low, high = (float(pick([pick(pairs[:, 0]) for pairs in ends])) for pick in (min, max))
    axes.plot((low, high), (low, high), color=colour("contact"), lw=0.8)
    for name, shape, tint, mark in shown:
        if shape:
            axes.plot(*shape.quantiles.T, mark, ms=2.0, mew=0.0, color=colour(tint), label=name)
    axes.set_xlabel("quantile of the Gaussian [-]")
    axes.set_ylabel("(height - mean)/rms [-]")
    style.legend_above(axes, 1)


def draw_summit_heights(axes: Axes, description: Description, both: Pair | None = None) -> None:
    """Summit heights above the map's mean, with the Gaussian and Nayak's distribution."""
    shape, tops = description.summit_heights, description.summits
    heading(axes, f"{tops.count} summits: heights above the mean", 1 if both is None else 2)
    if shape is None:
        empty(axes, "too few summits for a distribution")
        return
    mean = tops.mean_height
    factor, unit, edges = _histogram(axes, tops.heights - mean, shape.rms, "summits", "apex", mean)
    _gaussian(axes, edges, mean, shape.rms, factor)
    if description.nayak is not None:
        z = np.linspace(edges[0], edges[-1], 200)
        density = description.nayak.probability(z) * factor
        axes.plot(z / factor, density, color=colour("capillary"), label="Nayak")
    if both is not None and both.summits is not None:
        _convolved(axes, both.summits, edges, factor, mean)
    _height_axes(axes, "summit height", unit, _beyond(tops.heights, edges))
    style.legend_above(axes, 1 if both is None else 2)


def draw_radii(axes: Axes, description: Description) -> None:
    """Radius of each summit against its height; on a Gaussian surface higher ones are sharper."""
    tops = description.summits
    if tops.count == 0:
        heading(axes, "0 summits: radius")
        empty(axes, "no summits")
        return
    shown = np.arange(tops.count)
    if tops.count > _DOTS:
        shown = np.random.default_rng(0).choice(tops.count, _DOTS, replace=False)
    some = f", {shown.size} shown" if shown.size < tops.count else ""
    heading(axes, f"{tops.count} summits{some}: radius")
    across = style.scaled_axis(axes.xaxis, "summit height", tops.heights, unit="m")
    up = style.scaled_axis(axes.yaxis, "radius", np.array([tops.median_radius]), unit="m")
    axes.plot(tops.heights[shown] / across, tops.radii[shown] / up, "o", ms=1.6, mew=0.0,
              color=colour("apex"), alpha=0.5, rasterized=True, label="summits")  # fmt: skip
    axes.axhline(tops.radius / up, color=colour("contact"), lw=0.8, label="of mean curvature")
    if description.nayak is not None:
        half_width = 5.0 * sqrt(description.spectral.m0)
        z = np.linspace(
            max(tops.heights.min(), -half_width),
            min(tops.heights.max(), half_width),
            100,
        )
        sharp = description.nayak.curvature_at(z)
        axes.plot(z / across, 1.0 / (sharp * up), color=colour("capillary"), label="Nayak")
    axes.set_yscale("log")
    style.log_ticks(axes.yaxis)
    axes.xaxis.set_major_locator(MaxNLocator(6))
    style.legend_above(axes, 1)


def _histogram(
    axes: Axes, about: np.ndarray, rms: float, name: str, tint: str, middle: float = 0.0
) -> tuple[float, str, np.ndarray]:
    """Draw heights as probability density; the factor and unit of the axis, the bins' edges [m]."""
    low, high = max(about.min(), -_REACH * rms), min(about.max(), _REACH * rms)
    bins = int(min(max(5.0, 2.0 * about.size ** (1.0 / 3.0)), _MOST_BINS))
    edges = np.linspace(low, high, bins + 1)
    counts, _ = np.histogram(about, edges)
    density = counts / (about.size * (edges[1] - edges[0]))
    edges = edges + middle
    factor, unit = style.scale_of(edges, unit="m")
    axes.stairs(density * factor, edges / factor, fill=True, color=colour(tint), alpha=0.55,
                lw=0.0, label=name)  # fmt: skip
    return factor, unit, edges


def _gaussian(axes: Axes, edges: np.ndarray, mean: float, rms: float, factor: float) -> None:
    z = np.linspace(edges[0], edges[-1], 300)
    density = np.exp(-0.5 * ((z - mean) / rms) ** 2) / (rms * sqrt(2.0 * pi))
    axes.plot(z / factor, density * factor, color=colour("contact"), lw=0.9, label="Gaussian")


def _convolved(
    axes: Axes,
    distribution: HeightDistribution,
    edges: np.ndarray,
    factor: float,
    mean: float = 0.0,
) -> None:
    """The convolution of two distributions about a mean height [m], a point in each bin."""
    middle = 0.5 * (edges[1:] + edges[:-1])
    density = distribution.in_bins(edges - mean)
    axes.plot(middle / factor, density * factor, "o", ms=2.0, mew=0.0, color=colour("unloading"),
              label="convolution")  # fmt: skip


def _height_axes(axes: Axes, name: str, unit: str, beyond: str) -> None:
    axes.set_xlabel(style.label(name, unit) + beyond)
    axes.set_ylabel(style.label("probability density", f"1/{unit}"))
    axes.xaxis.set_major_locator(MaxNLocator(6))
    axes.set_ylim(bottom=0.0)


def _beyond(values: np.ndarray, edges: np.ndarray) -> str:
    """Which share of the values the bins leave out, in words; nothing where none is."""
    tiny = 1e-9 * (edges[-1] - edges[0])
    share = float(np.mean((values < edges[0] - tiny) | (values > edges[-1] + tiny)))
    return f", {100.0 * share:.2g} % beyond" if share > 0.0 else ""


def _binned(spectrum: ProfileSpectrum) -> tuple[np.ndarray, np.ndarray]:
    """Densities above rounding, averaged over even steps of the logarithm where they are many."""
    least = _ROUNDING * float(spectrum.density.max())
    keep = (spectrum.wavenumber > 0.0) & (spectrum.density > least)
    q, density = spectrum.wavenumber[keep], spectrum.density[keep]
    if q.size <= _SPECTRUM_POINTS:
        return q, density
    bins = np.geomspace(q[0], q[-1] * (1.0 + 1e-9), _SPECTRUM_POINTS + 1)
    which = np.digitize(q, bins) - 1
    count = np.bincount(which)
    there = count > 0
    means = [np.bincount(which, values)[there] / count[there] for values in (q, density)]
    return means[0], means[1]


def _guides(axes: Axes, shown: Sequence[tuple[np.ndarray, np.ndarray]]) -> None:
    """Slopes of profiles of self-affine surfaces, q^(-1 - 2H), over a decade above the curves."""
    q = shown[0][0]
    if q.size < _GUIDED:
        return
    middle = sqrt(q[0] * q[-1])
    line = np.array([middle / sqrt(10.0), middle * sqrt(10.0)])
    top = 8.0 * max(
        float(np.exp(np.interp(np.log(middle), np.log(q), np.log(density)))) for q, density in shown
    )
    for hurst, dashes in _GUIDES:
        power = 1.0 + 2.0 * hurst
        axes.plot(line, top * (line / middle) ** -power, color=colour("quiet"), ls=dashes,
                  label=f"q^-{power:g} (H = {hurst:g})")  # fmt: skip
