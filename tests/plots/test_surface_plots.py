"""The page of a surface and the publication's Figures 2 and 3 from measured ones."""

from __future__ import annotations

import re
from collections.abc import Callable
from functools import cache
from itertools import combinations
from typing import Any

import numpy as np
import pytest
from matplotlib.figure import Figure
from scipy.special import ndtr

from asperity.plots import height_map, published_figures, style, surface
from asperity.plots.height_map import coarse, colour_limits, legible, round_length
from asperity.publication import surface_figures
from asperity.surfaces import Topography
from asperity.surfaces.description.convolution import convolved
from asperity.surfaces.files.write_surface import write_topography
from asperity.surfaces.generation.generate import self_affine
from asperity.surfaces.measured_surface import Pair, Treatment, pair
from asperity.surfaces.measured_surface import surface as measured
from asperity.surfaces.preparation.prepare import Preparation


def gaussian(seed: int = 1, points: tuple[int, int] = (96, 64)) -> Topography:
    return self_affine(
        points, (10e-9, 10e-9), hurst=0.8, rolloff=150e-9, cutoff=60e-9, rms_height=3e-9, seed=seed
    )


def changed(topography: Topography, how: Any) -> Topography:
    heights = topography.heights.copy()
    how(heights)
    return topography.with_heights(heights)


def _hole(heights: np.ndarray) -> None:
    heights[5:9, 3:20] = np.nan


def _spikes(heights: np.ndarray) -> None:
    heights[10:60:20, 20:80:30] += 400e-9


SURFACES = {
    "gaussian.nc": gaussian(),
    "with a hole.nc": changed(gaussian(), _hole),
    "with spikes.nc": changed(gaussian(), _spikes),
    "tiny.nc": Topography(np.arange(25.0).reshape(5, 5) % 7 * 1e-9, (200e-9, 200e-9)),
    "flat.nc": Topography(np.zeros((12, 9)), (1e-6, 1e-6)),
    "strip.nc": Topography(gaussian(points=(400, 16)).heights, (1e-6, 1e-6)),
    "tower.nc": Topography(gaussian(points=(16, 400)).heights, (1e-6, 0.5e-6)),
    "slim.nc": Topography(gaussian(points=(64, 64)).heights, (1e-6, 1e-8)),
    "large.nc": Topography(1e4 * gaussian().heights, (1e-3, 1e-3)),
    f"$long_{'name^' * 20}$ \u6f22 \u00e4.nc": gaussian(2),
}


@pytest.fixture(scope="module", name="described")
def _described(tmp_path_factory: pytest.TempPathFactory) -> Callable[[str], Any]:
    """A surface by its name, prepared and described once."""
    folder = tmp_path_factory.mktemp("surfaces")

    @cache
    def described(name: str) -> Any:
        write_topography(SURFACES[name], folder / name)
        return measured(str(folder / name), Treatment(preparation=Preparation(missing="keep")))

    return described


@pytest.fixture(scope="module", name="page")
def _page(described: Callable[[str], Any]) -> Callable[[str], Figure]:
    return cache(lambda name: surface.of_surface(described(name)))


@pytest.fixture(scope="module")
def two(described: Callable[[str], Any]) -> Pair:
    return pair(described("gaussian.nc"), described("with spikes.nc"))


def assert_apart(figure: Figure) -> None:
    """All letters lie within the figure, and no axes' letters on another's."""
    figure.canvas.draw()
    width, height = figure.canvas.get_width_height()
    renderer = figure.canvas.get_renderer()  # type: ignore[attr-defined]
    with_notes = figure.axes[: 2 if figure.texts else 0]  # a map, and its colour bar
    boxes = [axes.get_tightbbox(renderer) for axes in figure.axes if axes not in with_notes]
    for axes in with_notes:
        boxes.append(axes.get_window_extent(renderer))
        boxes += [one.get_window_extent(renderer) for one in [*axes.texts, axes.yaxis.label]]
    boxes = [box for box in boxes if box.width > 0.0]
    boxes += [text.get_window_extent(renderer) for text in figure.texts]
    for box in boxes:
        assert box.x0 >= -1.0
        assert box.y0 >= -1.0
        assert box.x1 <= width + 1.0
        assert box.y1 <= height + 1.0
    for one, other in combinations(boxes, 2):
        assert not one.overlaps(other)


@pytest.mark.parametrize("name", SURFACES)
def test_letters_of_the_page_lie_within_it_and_apart(name: str, page: Callable[[str], Figure]):
    assert_apart(page(name))


def test_letters_of_the_composites_page_lie_within_it_and_apart(two: Pair):
    assert_apart(surface.of_composite(two))


def test_the_page_is_170_mm_wide_fits_on_paper_and_is_true_to_scale(page: Callable[[str], Figure]):
    wide, tall = page("gaussian.nc").get_size_inches() * 25.4
    assert wide == pytest.approx(style.PAGE)
    assert tall < 250.0
    box = page("gaussian.nc").axes[0].get_window_extent()
    assert box.width / box.height == pytest.approx(96.0 / 64.0, rel=1e-6)


def test_axes_of_the_page_have_units_and_missing_pixels_are_told(page: Callable[[str], Figure]):
    axes = page("with a hole.nc").axes
    labels = [text for one in axes for text in (one.get_xlabel(), one.get_ylabel())]
    shown = [text for text in labels if text]
    assert len(shown) == 11  # five panels and the colour bar
    assert all(re.search(r"\[.+\]", text) for text in shown)
    assert any("68 pixels missing" in text.get_text() for text in axes[0].texts)


def test_the_same_surface_gives_the_same_bytes(described: Callable[[str], Any]):
    found = described("tiny.nc")
    first = surface.files(found)
    assert first == surface.files(found)
    assert set(first) == {"surface.png", "surface.svg"}
    assert b"summits" in first["surface.svg"]


def test_the_scale_bar_has_the_length_beside_it(page: Callable[[str], Figure]):
    axes = page("strip.nc").axes[0]
    (bar,) = axes.lines
    note, scale = [text.get_text() for text in axes.texts]
    length, unit = note.split()
    share = float(np.diff(bar.get_xdata())[0])
    assert unit == "µm"
    assert share * 400.0 == pytest.approx(float(length))
    assert "not to scale" in scale


@pytest.mark.parametrize(
    ("most", "bar"), [(1.0, 1.0), (9.9e-7, 5e-7), (2.4e-6, 2e-6), (5e-9, 5e-9), (1.9e3, 1e3)]
)
def test_a_scale_bar_is_a_round_length(most: float, bar: float):
    assert round_length(most) == pytest.approx(bar)


def test_a_map_of_fewer_pixels_keeps_the_mean_and_the_holes():
    heights = np.random.default_rng(0).standard_normal((1290, 64))
    small = coarse(heights)
    assert small.shape == (645, 64)
    assert small.mean() == pytest.approx(heights.mean(), abs=1e-12)
    heights[:2, 0] = np.nan
    heights[2, 1] = np.nan
    small = coarse(heights)
    assert np.isnan(small[0, 0])
    assert small[1, 1] == heights[3, 1]


def test_spikes_share_a_colour_and_the_bar_says_so():
    heights = np.random.default_rng(0).standard_normal(10_000)
    assert colour_limits(heights)[2] == "neither"
    heights[:3] = 100.0
    low, high, ends = colour_limits(heights)
    assert ends == "max"
    assert high < 4.0
    assert low == heights.min()
    assert colour_limits(-heights)[2] == "min"
    assert colour_limits(np.zeros(9)) == (0.0, 0.0, "neither")


def test_signs_without_letters_and_long_names_are_legible():
    assert legible("a\u6f22b\n") == "a?b"
    assert legible("x" * 100, 10) == "xxxxxxx..."
    assert height_map.legible("\u00b5m \u03bb") == "\u00b5m \u03bb"


def test_bins_of_a_convolution_hold_the_gaussians_share():
    """Two Gaussians of rms 3 and 4 make one of 5."""
    draw = np.random.default_rng(0).standard_normal
    both = convolved(3.0 * draw(200_000), 4.0 * draw(200_000))
    edges = np.linspace(-20.0, 20.0, 41)
    density = both.in_bins(edges)
    assert float(np.sum(density)) == pytest.approx(1.0, abs=1e-3)
    wanted = np.diff(ndtr(edges / 5.0))
    np.testing.assert_allclose(density, wanted, atol=1e-3)


def test_figures_2_and_3_name_the_files_and_are_85_mm_wide(two: Pair):
    drawings = {"figure-2": surface_figures.heights(two),
                "figure-3": surface_figures.distribution(two)}  # fmt: skip
    for figure in published_figures.figures(drawings).values():
        assert_apart(figure)
    contents = published_figures.files(drawings)
    for name, drawing in drawings.items():
        assert "gaussian.nc + with spikes.nc" in drawing.title
        width = int.from_bytes(contents[f"{name}.png"][16:20], "big")
        assert width / 200 * 25.4 == pytest.approx(85.0, abs=0.2)
        assert b"gaussian.nc + with" in contents[f"{name}.svg"]


def test_figure_3_is_the_convolution_beside_the_gaussian_of_its_rms(two: Pair):
    drawing = surface_figures.distribution(two)
    whole, gauss = (drawing.series[name] for name in (two.name, "Gaussian"))
    shape = two.height_gaussianity
    squares = sum(one.topography.rms_height**2 for one in two.surfaces)
    assert shape.rms**2 == pytest.approx(squares, rel=1e-3)
    assert gauss[1].max() == pytest.approx(0.398942 / shape.rms, rel=1e-3)
    assert np.trapezoid(whole[1], whole[0]) == pytest.approx(1.0, abs=0.02)


def test_figure_2_of_a_map_has_a_height_at_each_pixel_of_its_grid(two: Pair):
    drawing = surface_figures.heights(two)
    rows, columns = (int(drawing.about[key]) for key in ("rows", "columns"))
    ((x, y, z),) = drawing.series.values()
    assert x.size == y.size == z.size == rows * columns
    assert (rows, columns) == (64, 96)
