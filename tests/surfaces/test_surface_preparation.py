"""Preparation: gaps, scan lines, form and wavelengths of surfaces whose answer is known."""

import json

import numpy as np
import pytest
from scipy.integrate import quad

from asperity.errors import InputError
from asperity.surfaces.generation.synthetic import gaussian_surface
from asperity.surfaces.preparation.form_removal import levelled
from asperity.surfaces.preparation.gaussian_filter import band_limited
from asperity.surfaces.preparation.line_levelling import lines_aligned
from asperity.surfaces.preparation.missing_pixels import filled
from asperity.surfaces.preparation.prepare import Preparation, prepared
from asperity.surfaces.preparation.step import length
from asperity.surfaces.topography import Topography
from refused_input import refusal

STEP = (10e-9, 15e-9)
SHAPE = (90, 120)


def places(shape=SHAPE, step=STEP):
    """Coordinates x and y [m] of the pixels from the centre of the map."""
    y, x = ((np.arange(n) - (n - 1) / 2) * d for n, d in zip(shape, step[::-1], strict=True))
    return np.meshgrid(x, y)


def surface(heights, step=STEP):
    return Topography(heights, step, "a.npy")


def roughness(shape=SHAPE, rms=1e-9, seed=0):
    return np.random.default_rng(seed).standard_normal(shape) * rms


def with_gaps(heights, share, seed=0):
    holed = heights.copy()
    holed[np.random.default_rng(seed).random(heights.shape) < share] = np.nan
    return holed


def cap(radius, centre=(0.0, 0.0), side=1.0, shape=SHAPE, step=STEP):
    """A sphere seen from above: bulging up for a positive side, hollow for a negative one."""
    x, y = places(shape, step)
    return side * np.sqrt(radius**2 - (x - centre[0]) ** 2 - (y - centre[1]) ** 2)


# --- missing pixels ------------------------------------------------------------------------


def holed(heights):
    gap = np.zeros(SHAPE, bool)
    gap[20:30, 30:50] = gap[60, 70] = gap[61:64, 71] = True
    return surface(np.where(gap, np.nan, heights)), gap


def test_a_round_hole_in_a_paraboloid_is_filled_with_the_height_of_its_rim():
    """Laplace's equation inside a circle of constant height: constant, a^2/(2R) off."""
    x, y = places((121, 121), (1e-8, 1e-8))
    square, hole, radius = x**2 + y**2, 40e-8, 1e-4
    heights = -square / (2 * radius)
    made, _ = filled(surface(np.where(square < hole**2, np.nan, heights), (1e-8, 1e-8)), "fill")
    depth = heights[60, 60] - made.heights[60, 60]
    assert depth == pytest.approx(hole**2 / (2 * radius), rel=0.03)
    inside = made.heights[square < hole**2]
    assert np.ptp(inside) < 0.03 * depth


def test_filled_heights_lie_between_those_around_so_that_no_summit_is_made():
    bare, gap = holed(roughness())
    made, step = filled(bare, "fill")
    heights = made.heights
    assert step.values["pixels"] == 204
    around = np.stack(
        [np.roll(heights, (i, j), (0, 1)) for i in (-1, 0, 1) for j in (-1, 0, 1) if i or j]
    )
    assert (heights[gap] <= around.max(axis=0)[gap]).all()
    assert (heights[gap] >= around.min(axis=0)[gap]).all()
    np.testing.assert_array_equal(heights[~gap], bare.heights[~gap])


def test_a_gap_at_the_edge_of_the_map_is_filled():
    heights = np.full(SHAPE, 3e-9)
    heights[:5, :] = heights[:, -4:] = np.nan
    np.testing.assert_allclose(filled(surface(heights), "fill")[0].heights, 3e-9, rtol=1e-12)


def test_missing_pixels_are_refused_before_anything_is_done_or_can_be_kept():
    bare, gap = holed(roughness())
    for given in (Preparation(missing="refuse"), Preparation(line_levelling="median")):
        with pytest.raises(InputError, match=r"a\.npy: 204 of 10800 .* missing; .*'fill'") as e:
            prepared(bare, given)
        assert e.value.file == "a.npy"
    made, step = filled(bare, "keep")
    np.testing.assert_array_equal(made.missing, gap)
    assert "204 of 10800" in step.words


# --- form ----------------------------------------------------------------------------------


def test_levelling_restores_what_is_left_of_a_surface_without_tilt():
    """Least squares are a projection: the residual of residual plus plane is the residual."""
    x, y = places()
    flat, _ = levelled(surface(with_gaps(roughness(), 0.3)), "tilt")
    tilted = surface(flat.heights + 2e-3 + 0.02 * x - 0.01 * y)
    made, step = levelled(tilted, "tilt")
    np.testing.assert_allclose(made.heights, flat.heights, rtol=0, atol=1e-17)
    assert step.values["tilt_x"] == pytest.approx(np.arctan(0.02), rel=1e-9)
    assert step.values["tilt_y"] == pytest.approx(-np.arctan(0.01), rel=1e-9)
    assert step.rms_after == pytest.approx(flat.rms_height)
    assert "1.15 deg along x, -0.573 deg along y" in step.words


def test_what_levelling_leaves_is_orthogonal_to_what_it_removes():
    x, y = places()
    made, _ = levelled(surface(with_gaps(roughness(), 0.2)), "curvature")
    for form in (np.ones_like(x), x, y, x**2, x * y, y**2):
        scale = np.nansum(abs(made.heights * form))
        assert abs(np.nansum(made.heights * form)) < 1e-12 * scale


def test_the_mean_is_taken_over_the_pixels_that_are_there():
    heights = with_gaps(roughness() + 5e-9, 0.5)
    made, step = levelled(surface(heights), "mean")
    assert np.nanmean(made.heights) == pytest.approx(0.0, abs=1e-22)
    assert step.values["mean"] == pytest.approx(np.nanmean(heights))


def test_a_paraboloid_is_removed_and_its_principal_radii_are_found():
    x, y = places()
    turn = np.deg2rad(30)
    u, v = x * np.cos(turn) + y * np.sin(turn), y * np.cos(turn) - x * np.sin(turn)
    heights = 0.01 * x - u**2 / (2 * 1e-4) + v**2 / (2 * 3e-4)
    made, step = levelled(surface(with_gaps(heights, 0.2)), "curvature")
    assert made.rms_height < 1e-12 * np.std(heights)
    assert step.values["radius_1"] == pytest.approx(1e-4, rel=1e-9)
    assert step.values["radius_2"] == pytest.approx(-3e-4, rel=1e-9)


@pytest.mark.parametrize("side", [1.0, -1.0], ids=["bulging up", "hollow"])
@pytest.mark.parametrize("steepness", [1e-3, 0.3, 0.9, 0.99])
def test_a_cap_of_a_sphere_is_removed_exactly_however_steep(side, steepness):
    """Steepness: the farthest pixel's distance from the apex, in radii."""
    x, y = places()
    radius = np.hypot(x, y).max() / steepness
    heights = 1e-6 + cap(radius, side=side)
    made, step = levelled(surface(heights), "sphere")
    assert step.values["radius"] == pytest.approx(side * radius, rel=1e-8)
    assert made.rms_height < 1e-9 * np.std(heights)


def test_a_sphere_whose_apex_lies_outside_the_map_is_found():
    made, step = levelled(surface(cap(2e-6, centre=(1.1e-6, -0.3e-6))), "sphere")
    assert step.values["radius"] == pytest.approx(2e-6, rel=1e-8)
    assert made.rms_height < 1e-16


def test_no_parabola_is_enough_for_a_steep_cap():
    heights = surface(cap(1.1e-6))
    parabola, sphere = (levelled(heights, form)[0].rms_height for form in ("curvature", "sphere"))
    assert parabola > 1e-3 * heights.rms_height
    assert sphere < 1e-9 * parabola


def test_a_rough_cap_with_gaps_keeps_its_roughness_and_gives_its_radius():
    rough = roughness((200, 200), 2e-9)
    heights = with_gaps(cap(5e-6, (0.2e-6, 0.1e-6), shape=(200, 200)) + rough, 0.1)
    made, step = levelled(surface(heights), "sphere")
    assert step.values["radius"] == pytest.approx(5e-6, rel=1e-3)
    assert made.rms_height == pytest.approx(2e-9, rel=0.02)


def test_a_plane_is_a_sphere_of_no_curvature():
    x, y = places()
    made, step = levelled(surface(0.3 * x - 0.1 * y + roughness(rms=1e-12)), "sphere")
    assert made.rms_height < 1.1e-12
    assert abs(step.values["radius"]) > 1e-3
    assert step.values["tilt_x"] == pytest.approx(np.arctan(0.3), rel=1e-4)


@pytest.mark.parametrize("form_removal", ["tilt", "curvature", "sphere"])
def test_pixels_on_one_line_determine_no_form(form_removal):
    heights = np.full(SHAPE, np.nan)
    heights[10] = roughness()[10]
    with pytest.raises(InputError, match=r"a\.npy: .*got 120 pixels"):
        levelled(surface(heights), form_removal)


# --- scan lines ----------------------------------------------------------------------------


def stripes(direction, shape=SHAPE):
    """Offsets [m] of the lines, with the mean zero."""
    offsets = np.random.default_rng(7).standard_normal(shape[0 if direction == "rows" else 1])
    offsets = (offsets - offsets.mean()) * 5e-9
    return offsets[:, None] if direction == "rows" else offsets[None, :]


@pytest.mark.parametrize("direction", ["rows", "columns"])
@pytest.mark.parametrize("how", ["median", "median-difference", "polynomial"])
def test_offsets_between_lines_are_removed_and_sq_before_and_after_is_told(how, direction):
    """Symmetric bumps on a flat ground: all lines have the same median, so it can be exact."""
    x, y = places()
    bumps = 1e-9 * np.sin(2 * np.pi * x / 100e-9) * np.sin(2 * np.pi * y / 90e-9)
    made, step = lines_aligned(surface(bumps + stripes(direction)), how, direction, degree=0)
    assert np.std(made.heights - bumps) < 0.02e-9
    assert step.rms_before == pytest.approx(5e-9, rel=0.2)
    assert step.rms_after == pytest.approx(np.std(bumps), rel=1e-3)
    assert "Sq" in step.sentence


def test_a_high_island_disturbs_the_mean_of_a_line_and_not_its_median():
    flat = roughness(rms=1e-12)
    flat[30:60, 20:60] += 50e-9
    off = {
        how: np.std(lines_aligned(surface(flat + stripes("rows")), how, degree=0)[0].heights - flat)
        for how in ("median", "median-difference", "polynomial")
    }
    assert max(off["median"], off["median-difference"]) < 1e-11
    assert off["polynomial"] > 5e-9


@pytest.mark.parametrize("how", ["median", "median-difference", "polynomial"])
def test_missing_pixels_and_lines_stay_missing_and_the_rest_is_aligned(how):
    heights = with_gaps(roughness(rms=1e-12) + stripes("rows"), 0.1)
    heights[40] = heights[55:60] = np.nan
    made, _ = lines_aligned(surface(heights), how)
    np.testing.assert_array_equal(made.missing, np.isnan(heights))
    assert made.rms_height < 3e-12


@pytest.mark.parametrize("how", ["median", "median-difference", "polynomial"])
def test_roughness_along_the_slow_axis_is_lost(how):
    """The danger: a true wave whose crests lie along the lines is taken for their offsets."""
    _, y = places()
    made, _ = lines_aligned(surface(1e-9 * np.sin(2 * np.pi * y / 270e-9)), how)
    assert made.rms_height < 1e-20


def test_medians_take_from_a_random_surface_what_the_docstring_says():
    """rms sqrt(int asin(rho) dx / W), rho = exp(-(x/l)^2): the sign correlation's arcsine law."""
    correlation, points, step = 60e-9, (1000, 1000), 10e-9
    heights = gaussian_surface(points, step, 1e-9, correlation, seed=2)
    made, _ = lines_aligned(surface(heights, (step, step)))
    overlap = 2 * quad(lambda x: np.arcsin(np.exp(-(x**2))), 0, 8)[0]
    assert np.sqrt(overlap) == pytest.approx(1.46, abs=0.005)
    expected = 1e-9 * np.sqrt(overlap * correlation / (points[1] * step))
    assert np.std(made.heights - heights) == pytest.approx(expected, rel=0.1)


def test_lines_that_cannot_be_compared_or_fitted_are_refused():
    apart, short = roughness(), roughness()
    apart[:40, :60] = apart[40:, 60:] = short[12, 2:] = np.nan
    with pytest.raises(InputError, match=r"lines 39 and 40 share no pixel.*'median'"):
        lines_aligned(surface(apart), "median-difference")
    with pytest.raises(InputError, match="degree 2; line 12 has 2"):
        lines_aligned(surface(short), "polynomial", degree=2)


# --- wavelengths ---------------------------------------------------------------------------


def transmission(cut, wavelength):
    """Of a sine wave's amplitude, ISO 16610-21."""
    return np.exp(-np.log(2.0) * (cut / wavelength) ** 2)


@pytest.mark.parametrize("axis", ["x", "y"])
@pytest.mark.parametrize("ratio", [0.5, 1.0, 2.0, 5.0])
def test_a_wave_passes_as_the_standard_says(axis, ratio):
    """Far from the edges; half of the amplitude at the cut-off."""
    x, y = places((360, 400))
    wavelength = 300e-9
    wave = np.sin(2 * np.pi * (x if axis == "x" else y) / wavelength) * 1e-9
    cut = ratio * wavelength
    inner = (
        (slice(140, -140), slice(180, -180)) if ratio > 2 else (slice(90, -90), slice(120, -120))
    )
    passed = transmission(cut, wavelength)
    low, _ = band_limited(surface(wave), s_filter=cut)
    high, _ = band_limited(surface(wave), l_filter=cut)
    atol = 2e-12
    np.testing.assert_allclose(low.heights[inner], passed * wave[inner], rtol=0, atol=atol)
    np.testing.assert_allclose(high.heights[inner], (1 - passed) * wave[inner], rtol=0, atol=atol)


def test_a_cut_at_two_pixels_passes_half_of_the_shortest_wave():
    zigzag = np.broadcast_to((-1.0) ** np.arange(64), (64, 64)) * 1e-9
    low, _ = band_limited(surface(zigzag, (1e-8, 1e-8)), s_filter=2e-8)
    np.testing.assert_allclose(low.heights[20:-20, 20:-20], 0.5 * zigzag[20:-20, 20:-20], rtol=0.01)


@pytest.mark.parametrize("share", [0.0, 0.3])
def test_a_constant_passes_the_short_cut_up_to_the_edge_and_nothing_the_long_one(share):
    level = surface(with_gaps(np.full(SHAPE, 7e-9), share))
    low, _ = band_limited(level, s_filter=200e-9)
    high, _ = band_limited(level, l_filter=200e-9)
    np.testing.assert_array_equal(low.missing, level.missing)
    np.testing.assert_allclose(low.heights[~low.missing], 7e-9, rtol=1e-12)
    np.testing.assert_allclose(high.heights[~low.missing], 0.0, atol=1e-20)


def test_the_filter_is_the_weighted_mean_of_the_pixels_that_are_there():
    """Against the sum written out, with gaps, at a corner and inside."""
    heights, cut = with_gaps(roughness(), 0.3), 200e-9
    low, _ = band_limited(surface(heights), s_filter=cut)
    x, y = places()
    there = np.isfinite(heights)
    for row, column in np.argwhere(there)[[0, 1, 4000, -1]]:
        square = (x - x[row, column]) ** 2 + (y - y[row, column]) ** 2
        weight = np.where(there, np.exp(-np.pi * square / (np.log(2) / np.pi * cut**2)), 0.0)
        mean = np.sum(weight * np.where(there, heights, 0.0)) / weight.sum()
        assert low.heights[row, column] == pytest.approx(mean, abs=1e-15)


def test_low_and_high_parts_add_up_to_the_surface():
    rough = surface(roughness())
    low, high = band_limited(rough, s_filter=200e-9)[0], band_limited(rough, l_filter=200e-9)[0]
    np.testing.assert_allclose(low.heights + high.heights, rough.heights, rtol=0, atol=1e-22)


@pytest.mark.parametrize(
    ("cuts", "rule"),
    [
        ({"s_filter": 29e-9}, "`s_filter` must lie between two pixels, 30 nm, .* 1.2 um; got 29"),
        ({"l_filter": 1.3e-6}, "`l_filter` must lie between two pixels, 30 nm, .* 1.2 um; got 1.3"),
        ({"s_filter": 1e-6, "l_filter": 1e-7}, "`s_filter` must lie below `l_filter`, 100 nm; got"),
        ({"s_filter": 0.0}, "`s_filter` must be a positive length"),
        ({"l_filter": np.nan}, "`l_filter` must be a positive length"),
    ],
)
def test_a_cut_that_the_map_cannot_show_is_refused(cuts, rule):
    with pytest.raises(InputError, match=rule):
        prepared(surface(roughness()), Preparation(form_removal="none", **cuts))


# --- the whole preparation -----------------------------------------------------------------


def test_a_scan_is_prepared_in_order_and_says_what_was_done():
    x, y = places()
    rough = surface(roughness(rms=1e-9))
    raw = with_gaps(rough.heights + 0.02 * x - (x**2 + y**2) / 2e-4 + stripes("rows"), 0.05)
    cuts = {"s_filter": 4e-8, "l_filter": 6e-7}
    how = Preparation(missing="fill", form_removal="curvature", line_levelling="median", **cuts)
    made = prepared(surface(raw), how)
    order = [step.name for step in made.steps]
    assert order == ["lines", "form", "s_filter", "l_filter", "missing"]
    assert made.missing_pixels == np.isnan(raw).sum()
    assert made.topography.missing_pixels == 0
    for before, after in zip(made.steps[:-1], made.steps[1:], strict=True):
        assert after.rms_before == before.rms_after
    assert made.steps[-1].rms_after == made.topography.rms_height
    written = json.dumps(made.to_json(), allow_nan=False)
    assert json.loads(written)["steps"][1]["removed"] == "curvature"
    assert all("Sq" in sentence and len(sentence.splitlines()) == 1 for sentence in made.sentences)


def test_nothing_is_done_unless_asked_for_and_what_is_given_stays_as_it_is():
    rough = surface(roughness())
    before = rough.heights.copy()
    made = prepared(rough, Preparation(form_removal="none"))
    assert made.topography is rough
    assert made.steps == ()
    prepared(rough, Preparation("refuse", "sphere", "median-difference", s_filter=5e-8))
    np.testing.assert_array_equal(rough.heights, before)


def test_filled_heights_enter_no_fit():
    """A plane with an outlier's neighbourhood missing: the tilt is that of the pixels there."""
    x, y = places()
    heights = with_gaps(roughness() + 0.1 * x + 0.05 * y, 0.4)
    kept, full = (
        prepared(surface(heights), Preparation(missing=missing)) for missing in ("keep", "fill")
    )
    there = ~kept.topography.missing
    np.testing.assert_array_equal(full.topography.heights[there], kept.topography.heights[there])


REFUSED = [
    ("missing", "guess"), ("form_removal", "plane"), ("line_levelling", "mean"),
    ("direction", "diagonal"), ("degree", 6), ("degree", 1.5), ("degree", True),
    ("s_filter", -1e-9), ("l_filter", np.inf),
]  # fmt: skip


@pytest.mark.parametrize(("key", "value"), REFUSED)
def test_a_preparation_refuses_by_key(key, value):
    error = refusal(Preparation, **{key: value})
    assert error.key == key
    assert f"`{key}` must" in str(error)


def test_a_length_is_told_in_a_unit_that_suits_it():
    told = {35.2e-9: "35.2 nm", 1.82e-6: "1.82 um", 0.99996e-6: "1 um", -3.6e-1: "-360 mm",
            0.0: "0 m", np.inf: "inf m", 1e-30: "1e-06 ym"}  # fmt: skip
    assert {metres: length(metres) for metres in told} == told
