"""Describing a surface: summits, moments, Nayak's theory, the Gaussian, two surfaces, verdicts."""

from __future__ import annotations

import json
from math import pi, sqrt

import numpy as np
import pytest
from scipy import integrate, stats

from asperity.errors import InputError
from asperity.results.record_layout import plain
from asperity.surfaces import Topography
from asperity.surfaces.description.convolution import convolved
from asperity.surfaces.description.describe import describe
from asperity.surfaces.description.gaussianity import (
    Independent,
    gaussianity,
    independent_heights,
    independent_summits,
    p_value,
)
from asperity.surfaces.description.nayak import Nayak, mccool
from asperity.surfaces.description.pixel_size import discretisation_error, pixel_effect
from asperity.surfaces.description.spectrum import Moments, moments, profile_spectrum
from asperity.surfaces.description.sum_of_maps import added, adding_in_words
from asperity.surfaces.description.summits import find_summits
from asperity.surfaces.files.reading import Reading
from asperity.surfaces.generation.synthetic import gaussian_surface
from asperity.surfaces.measured_surface import Pair, Surface, pair
from asperity.surfaces.preparation.form_removal import levelled
from asperity.surfaces.preparation.prepare import Prepared

PIXEL = (2e-9, 3e-9)
RMS = 1e-9


def white(rows, columns, seed=0):
    return np.random.default_rng(seed).standard_normal((rows, columns))


def surface(points, length, seed, rms=RMS):
    return Topography(gaussian_surface((points, points), 1.0, rms, length, seed), (1e-9, 1e-9))


# Summits


def test_a_paraboloid_has_its_height_and_place_and_the_mean_of_its_curvatures():
    y, x = np.mgrid[:9, :11]
    along, across = ((x - 5.1) * PIXEL[0]) ** 2, ((y - 3.2) * PIXEL[1]) ** 2
    heights = -along / (2 * 10e-9) - across / (2 * 30e-9)
    found = find_summits(Topography(heights, PIXEL))
    assert found.positions.tolist() == [[3, 5]]
    assert found.curvatures == pytest.approx([0.5 * (1 / 10e-9 + 1 / 30e-9)])
    assert found.radii == pytest.approx([15e-9])
    assert found.heights == pytest.approx([heights[3, 5] - heights.mean()])
    assert found.density == pytest.approx(1.0 / (9 * PIXEL[0] * 7 * PIXEL[1]))


def test_a_summit_is_above_its_diagonal_neighbours_too():
    heights = np.zeros((5, 5))
    heights[2, 2] = 1.0
    assert find_summits(Topography(heights, PIXEL)).count == 1
    heights[1, 1] = 1.5
    assert find_summits(Topography(heights, PIXEL)).positions.tolist() == [[1, 1]]


def test_one_pixel_in_nine_of_white_noise_is_a_summit():
    """Each of nine independent heights is as likely the highest; a share that has no parameter."""
    found = find_summits(Topography(white(700, 800), PIXEL))
    assert found.density * PIXEL[0] * PIXEL[1] == pytest.approx(1.0 / 9.0, rel=0.01)


def test_pixels_on_the_edge_and_beside_missing_ones_are_no_summits():
    heights = np.zeros((9, 9))
    heights[0, 4] = heights[4, 4] = heights[6, 6] = 1.0
    heights[5, 3] = np.nan
    found = find_summits(Topography(heights, PIXEL))
    assert found.positions.tolist() == [[6, 6]]
    assert found.searched == pytest.approx(1.0 - 9.0 / 49.0)


def test_flat_tops_are_counted_apart_and_terraces_are_not():
    heights = np.zeros((12, 12))
    heights[2:4, 2:4] = 1.0
    heights[6:9, 6:9] = 1.0
    heights[6, 10] = heights[7, 10] = 2.0
    heights[8, 8] = 3.0  # makes a terrace of the second plateau
    found = find_summits(Topography(heights, PIXEL))
    assert found.positions.tolist() == [[8, 8]]
    assert found.plateaus == 2
    flat = find_summits(Topography(np.full((6, 6), 2e-9), PIXEL))
    assert (flat.count, flat.plateaus) == (0, 0)
    assert np.isnan(flat.radius)


def test_tops_midway_between_pixels_are_plateaus_and_the_verdict_says_so():
    """A lattice in step with the pixels: four pixels are equally high at each top."""
    away = (np.arange(96) % 8) - 3.5
    heights = -(away[:, None] ** 2 + away**2) * 1e-10
    found = describe(Topography(heights, PIXEL))
    assert found.summits.count == 0
    assert found.summits.plateaus == 144
    assert any("quantised: 144 of 144 tops" in verdict for verdict in found.verdicts)


# Moments and spectra


def test_moments_of_a_wave_along_x_are_those_of_its_finite_differences():
    points, pixel, amplitude = 4000, 1e-9, 3e-9
    wave = 2 * pi * 40 / (points * pixel)
    row = amplitude * np.cos(wave * pixel * np.arange(points))
    found = moments(Topography(np.tile(row, (5, 1)), (pixel, 2 * pixel)))
    seen = (2.0 - 2.0 * np.cos(wave * pixel)) / pixel**2
    assert found.m0 == pytest.approx(amplitude**2 / 2)
    assert found.m2 == pytest.approx(amplitude**2 / 4 * seen, rel=1e-3)
    assert found.m4 == pytest.approx(amplitude**2 / 4 * seen**2, rel=1e-3)
    assert found.slopes == pytest.approx((amplitude * sqrt(seen / 2), 0.0), rel=1e-3)


def test_moments_of_white_noise_are_those_of_independent_pixels():
    """Variance 2 of a first and 6 of a second difference, so a bandwidth of 1.5."""
    found = moments(Topography(white(600, 700), (1.0, 1.0)))
    assert (found.m0, found.m2, found.m4) == pytest.approx((1.0, 2.0, 6.0), rel=0.01)
    assert found.bandwidth == pytest.approx(1.5, rel=0.01)


def test_moments_ignore_missing_pixels_only():
    heights = gaussian_surface((300, 300), 1.0, 1.0, 6.0, 1)
    known = moments(Topography(heights, (1.0, 1.0)))
    heights[20:40, 50:60] = np.nan
    found = moments(Topography(heights, (1.0, 1.0)))
    assert (found.m0, found.m2, found.m4) == pytest.approx((known.m0, known.m2, known.m4), rel=0.02)


@pytest.mark.parametrize("columns", [256, 255])
@pytest.mark.parametrize("direction", ["x", "y"])
def test_the_spectrum_integrates_to_the_variance(columns, direction):
    made = Topography(gaussian_surface((200, columns), 1.0, RMS, 5.0, 2), PIXEL)
    spectrum = profile_spectrum(made, direction)
    step = spectrum.wavenumber[1]
    assert np.sum(spectrum.density) * step == pytest.approx(made.rms_height**2)
    assert spectrum.wavenumber[-1] <= pi / PIXEL["xy".index(direction)] * (1 + 1e-12)


def test_the_spectrum_of_a_gaussian_surface_is_the_known_one():
    """S(q) = m0 L/sqrt(pi) exp(-(q L/2)^2), one-sided, of the correlation exp(-(r/L)^2)."""
    length = 6.0
    made = surface(1024, length, 3)
    spectrum = profile_spectrum(made, "x")
    q = spectrum.wavenumber * 1e-9
    known = RMS**2 * length * 1e-9 / sqrt(pi) * np.exp(-((q * length / 2.0) ** 2))
    inside = (q > 0.05) & (q < 0.7)
    ratio = spectrum.density[inside] / known[inside]
    assert np.mean(ratio) == pytest.approx(1.0, abs=0.03)
    assert np.std(ratio) < 0.15


def test_profiles_with_missing_pixels_have_no_part_in_the_spectrum():
    heights = white(40, 50)
    whole = profile_spectrum(Topography(heights[:30], PIXEL), "x")
    heights[30:, 7] = np.nan
    heights[30:] += np.nanmean(heights[:30]) - np.nanmean(heights[30:])
    part = profile_spectrum(Topography(heights, PIXEL), "x")
    np.testing.assert_allclose(part.density, whole.density, rtol=1e-10)
    heights[:, 7] = np.nan
    assert profile_spectrum(Topography(heights, PIXEL), "x") is None


# Nayak and McCool


@pytest.mark.parametrize("bandwidth", [1.5, 1.6, 3.0, 10.0, 1000.0])
def test_density_of_summit_heights_integrates_to_its_own_moments(bandwidth):
    """The closed moments against the density, which is integrated from Nayak's joint one."""
    known = Nayak(1.0, 1.0, bandwidth)
    z = np.linspace(-9.0, 9.0, 20001)
    density = known.probability(z)
    mean = integrate.simpson(z * density, x=z)
    central = [integrate.simpson((z - mean) ** n * density, x=z) for n in range(5)]
    assert central[0] == pytest.approx(1.0, abs=1e-6)
    assert mean == pytest.approx(known.mean_height, abs=1e-6)
    assert sqrt(central[2]) == pytest.approx(known.rms_height, rel=1e-5)
    assert central[3] / central[2] ** 1.5 == pytest.approx(known.skewness, abs=1e-4)
    assert central[4] / central[2] ** 2 == pytest.approx(known.kurtosis, rel=1e-4)


@pytest.mark.parametrize("bandwidth", [1.6, 3.0, 30.0])
def test_curvature_at_a_height_averages_to_the_mean_curvature(bandwidth):
    known = Nayak(2.0, 3.0, bandwidth * 4.5)
    z = np.linspace(-12.0, 14.0, 20001)
    density, curvature = known.probability(z), known.curvature_at(z)
    mean = integrate.simpson(curvature * density, x=z)
    assert mean == pytest.approx(known.mean_curvature, rel=1e-6)
    tied = integrate.simpson((z - known.mean_height) * (curvature - mean) * density, x=z)
    spread = known.mean_curvature * sqrt(6.0 * pi / 64.0 * (2.0 * sqrt(3.0) + 1.0 / 3.0) - 1.0)
    assert tied / (known.rms_height * spread) == pytest.approx(
        known.curvature_correlation, rel=1e-5
    )


def test_all_waves_of_one_length_make_the_curvature_follow_the_height():
    """Bandwidth 1.5: z_xx + z_yy = -(m2/m0) 2 z, and no summit lies below the mean."""
    known = Nayak(1.0, 2.0, 6.0)
    z = np.array([0.3, 1.0, 2.5])
    assert known.curvature_at(z) == pytest.approx(2.0 * z, rel=1e-4)
    assert known.probability(np.array([-0.1])) == pytest.approx([0.0], abs=1e-12)
    expected = 2.0 * sqrt(3.0) * (z**2 - 1.0 + np.exp(-(z**2))) * stats.norm.pdf(z)
    assert known.probability(z) == pytest.approx(expected, rel=1e-4)


def test_a_broad_spectrum_frees_summits_from_their_heights():
    """As the bandwidth grows summits become as Gaussian as the surface, and as high."""
    known = Nayak(1.0, 1.0, 1e8)
    assert known.mean_height == pytest.approx(4.0 / sqrt(pi * 1e8))
    assert (known.rms_height, known.kurtosis) == pytest.approx((1.0, 3.0), rel=1e-6)
    assert abs(known.skewness) < 1e-9
    z = np.array([-2.0, 0.0, 2.0])
    assert known.probability(z) == pytest.approx(stats.norm.pdf(z), rel=1e-3)
    assert known.curvature_at(z) == pytest.approx(np.full(3, known.mean_curvature), rel=1e-3)


def test_summits_far_below_the_mean_keep_a_curvature():
    curvature = Nayak(1.0, 1.0, 1.6).curvature_at(np.array([-40.0, -10.0, -3.0]))
    assert np.all(np.diff(curvature) > 0.0)
    assert curvature[0] > 0.0


def test_mccools_values_are_nayaks_and_his_printed_constant_is_right():
    spectral = Moments(m0=4e-18, m2=0.02, m4=4e14, slopes=(0.1, 0.1))
    short, exact = mccool(spectral), Nayak(spectral.m0, spectral.m2, spectral.m4)
    assert short.density == pytest.approx(exact.density)
    assert short.radius == pytest.approx(exact.radius)
    assert short.mean_height == pytest.approx(exact.mean_height)
    assert short.rms_height == pytest.approx(exact.rms_height, rel=2e-5)


def test_moments_that_no_isotropic_surface_has_are_refused():
    with pytest.raises(InputError, match=r"at least 1\.5"):
        Nayak(1.0, 1.0, 1.4)
    with pytest.raises(InputError, match="positive moments"):
        Nayak(1.0, 1.0, float("nan"))


# Pixel size


def test_the_effect_of_the_pixel_size_is_that_of_a_coarser_measurement():
    made = surface(256, 4.0, 5)
    effects = pixel_effect(made)
    assert [effect.every for effect in effects] == [1, 2, 4, 8, 16]
    thinned = Topography(made.heights[::4, ::4], (4e-9, 4e-9))
    assert effects[2].density == find_summits(thinned).density
    assert effects[2].rms_slope == pytest.approx(sqrt(moments(thinned).m2))


def test_error_of_the_pixel_is_estimated_from_every_second_one():
    """Against Nayak's exact figures, where the error of the radius is 4 and 2 %."""
    for length, limit in ((5.0, 0.3), (7.0, 0.5)):
        made = surface(1536, length, 6)
        exact = 3.0 * sqrt(pi) / (8.0 * sqrt(12.0 * RMS**2 / (length * 1e-9) ** 4))
        _, estimate = discretisation_error(pixel_effect(made))
        assert estimate == pytest.approx(find_summits(made).radius / exact - 1.0, rel=limit)


def test_a_map_too_small_to_thin_has_no_estimate():
    assert discretisation_error(pixel_effect(Topography(white(20, 20), PIXEL))) is None


# Against the Gaussian


def test_p_values_of_fitted_gaussian_samples_are_uniform():
    """Lilliefors's distribution: the table of the program against fresh samples."""
    rng = np.random.default_rng(11)
    worth = Independent(200.0, 200.0, 200.0)
    found = [gaussianity(rng.normal(3.0, 2.0, 200), worth, "heights").p_value for _ in range(4000)]
    for level in (0.02, 0.05, 0.2, 0.5, 0.8):
        share = np.mean(np.array(found) < level)
        assert share == pytest.approx(level, abs=0.12 * level + 3 * sqrt(level / 4000))


@pytest.mark.parametrize(("statistic", "level"), [(0.819, 0.10), (0.895, 0.05), (1.035, 0.01)])
def test_p_values_are_near_stephens_points(statistic, level):
    """Stephens (1974), table 1A, case 3; his points are rounded from samples of 20 to 100."""
    root = sqrt(50.0)
    found = p_value(statistic / (root - 0.01 + 0.85 / root), 50.0)
    assert found == pytest.approx(level, rel=0.25)


def test_statistic_and_moments_are_those_of_scipy():
    values = np.random.default_rng(3).gamma(3.0, size=500)
    found = gaussianity(values, Independent(500.0, 500.0, 500.0), "heights")
    known = stats.kstest((values - values.mean()) / values.std(), "norm")
    assert found.statistic == pytest.approx(known.statistic)
    assert found.skewness == pytest.approx(stats.skew(values))
    assert found.kurtosis == pytest.approx(stats.kurtosis(values, fisher=False))


def test_heights_rounded_to_the_step_of_an_instrument_stay_gaussian():
    values = np.random.default_rng(5).normal(0.0, RMS, 20_000)
    worth = Independent(20_000.0, 20_000.0, 20_000.0)
    exact = gaussianity(values, worth, "heights")
    rounded = gaussianity(np.round(values / (0.2 * RMS)) * 0.2 * RMS, worth, "heights")
    assert rounded.statistic <= exact.statistic + 1e-3
    assert "are Gaussian within the sampling error" in rounded.verdict


def test_quantiles_of_gaussian_heights_lie_on_the_line():
    values = stats.norm.ppf((np.arange(5000) + 0.5) / 5000) * RMS + 5e-6
    pairs = gaussianity(values, Independent(5000.0, 5000.0, 5000.0), "heights").quantiles
    np.testing.assert_allclose(pairs[:, 1], pairs[:, 0], atol=2e-3)
    assert pairs[-1, 0] == pytest.approx(stats.norm.ppf(1 - 0.5 / 5000))


def test_white_noise_is_worth_all_its_pixels():
    found = independent_heights(Topography(white(200, 300), PIXEL))
    assert tuple(found) == pytest.approx((60000.0,) * 3, rel=0.02)


def test_a_correlated_surface_is_worth_its_correlation_areas():
    """rho^n = exp(-n r^2/L^2) covers pi L^2/n; arcsin rho - rho is the sum of odd powers."""
    length, points = 6.0, 1024
    found = independent_heights(surface(points, length, 8))
    area = pi * length**2
    assert found.skewness == pytest.approx(3.0 * points**2 / area, rel=0.05)
    assert found.kurtosis == pytest.approx(4.0 * points**2 / area, rel=0.05)
    sums = area * (pi / 2.0 * np.log(2.0) - 1.0) / (pi / 2.0 - 1.0)
    assert found.distribution == pytest.approx(points**2 / sums, rel=0.05)


def test_correlated_gaussian_fields_are_called_gaussian():
    """Mean, rms and correlation known from the map alone: at most 5 in 100 are refused."""
    verdicts = []
    for seed in range(60):
        made = gaussian_surface((192, 192), 1.0, RMS, 5.0, seed)[:96, :96]
        cut = Topography(made, PIXEL)
        verdicts.append(gaussianity(made, independent_heights(cut), "heights"))
    assert np.mean([one.p_value < 0.05 for one in verdicts]) <= 0.05
    assert np.mean(["are Gaussian within" in one.verdict for one in verdicts]) > 0.9
    scatter = np.std([one.skewness for one in verdicts])
    expected = sqrt(6.0 / np.mean([one.independent.skewness for one in verdicts]))
    assert scatter == pytest.approx(expected, rel=0.25)


def test_a_surface_with_cut_tops_is_skewed_to_valleys():
    heights = np.minimum(gaussian_surface((256, 256), 1.0, RMS, 3.0, 9), 0.2 * RMS)
    found = describe(Topography(heights, PIXEL))
    assert found.heights.p_value < 1e-3
    assert "heights are not Gaussian: skewed to valleys" in found.verdicts[0]


def test_of_maps_smaller_than_their_waves_nine_in_ten_are_not_judged():
    """Pieces of 64 pixels of surfaces with a correlation length of 60."""
    pieces = [gaussian_surface((256, 256), 1.0, RMS, 60.0, seed)[:64, :64] for seed in range(80)]
    worth = [independent_heights(Topography(piece, PIXEL)) for piece in pieces]
    found = [gaussianity(*pair, "heights") for pair in zip(pieces, worth, strict=True)]
    silent = [one for one in found if one.p_value is None]
    assert len(silent) / len(found) == pytest.approx(0.92, abs=0.06)
    assert all("too few to judge" in one.verdict for one in silent)


def test_summits_are_never_worth_more_than_their_number_or_the_surface():
    few = Independent(50.0, 40.0, 60.0)
    assert max(independent_summits(10**6, few)) < 61.0
    assert independent_summits(20, Independent(1e9, 1e9, 1e9))[0] == pytest.approx(20.0, rel=1e-6)


# Two surfaces


def test_convolution_adds_variances_and_cumulants():
    rng = np.random.default_rng(12)
    first, second = rng.gamma(2.0, 1e-9, 40_000), rng.normal(5e-9, 2e-9, 30_000)
    found = convolved(first, second)
    cumulants = [np.array([stats.kstat(part, n) for n in (2, 3, 4)]) for part in (first, second)]
    variance, third, fourth = cumulants[0] + cumulants[1]
    assert np.sum(found.density) * found.step == pytest.approx(1.0)
    assert found.rms == pytest.approx(sqrt(variance), rel=1e-4)
    assert found.skewness == pytest.approx(third / variance**1.5, rel=1e-3)
    assert found.kurtosis == pytest.approx(3.0 + fourth / variance**2, rel=1e-3)


def test_convolution_of_two_gaussians_is_gaussian():
    even = stats.norm.ppf((np.arange(20_000) + 0.5) / 20_000)
    found = convolved(3e-9 * even, 4e-9 * even)
    known = stats.norm.pdf(found.heights, scale=5e-9)
    np.testing.assert_allclose(found.density, known, atol=3e-3 * known.max())


def test_two_flat_surfaces_have_no_composite_distribution():
    with pytest.raises(InputError, match="two flat ones"):
        convolved(np.zeros(9), np.ones(9))


def test_maps_of_one_pixel_size_are_added_about_their_centres():
    first, second = white(8, 10, 1), white(6, 14, 2)
    total = added(Topography(first, PIXEL, "a"), Topography(second, PIXEL, "b"))
    parts = [Topography(part, PIXEL) for part in (first[1:7], second[:, 2:12])]
    expected = sum(levelled(part, "tilt")[0].heights for part in parts)
    np.testing.assert_allclose(total.heights, expected, atol=1e-12)
    assert adding_in_words(Topography(first, PIXEL), Topography(second, PIXEL)).endswith(
        "the tilt of each removed there"
    )
    assert (total.pixel_size, total.source) == (PIXEL, "a + b")


def test_a_map_that_is_cropped_adds_no_tilt():
    """A wave ten times as long as the shared area, level on the whole of its map."""
    x = np.arange(400) * 1e-9
    long = Topography(np.tile(1e-7 * np.sin(2 * np.pi * x / 4e-7), (40, 1)), (1e-9, 1e-9))
    total = added(long, Topography(white(40, 40, 3) * 1e-12, (1e-9, 1e-9)))
    assert total.rms_height < 0.02 * long.rms_height


def test_pixels_in_a_whole_ratio_are_taken_as_they_are():
    """White noise keeps its rms; interpolation between pixels would smooth it."""
    fine = Topography(white(256, 256, 4), (1e-9, 1e-9))
    flat = Topography(np.zeros((128, 128)), (2e-9, 2e-9))
    total = added(fine, flat)
    assert total.rms_height == pytest.approx(fine.rms_height, rel=0.02)
    assert "taken at the coarser pixels" in adding_in_words(fine, flat)


def test_the_finer_map_is_taken_at_the_coarser_pixels():
    """The product x y is linear between pixels along either axis: interpolation is exact."""

    def saddle(rows, columns, step):
        x, y = ((np.arange(n) - 0.5 * (n - 1)) * step for n in (columns, rows))
        return Topography(1e6 * x * y[:, None], (step, step))

    coarse, fine = saddle(12, 15, 5e-9), saddle(40, 50, 1.7e-9)
    total = added(coarse, fine)
    rows, columns = total.heights.shape
    np.testing.assert_allclose(total.heights, 2.0 * saddle(rows, columns, 5e-9).heights, atol=1e-20)
    assert total.pixel_size == coarse.pixel_size
    assert "interpolated linearly at the coarser pixels" in adding_in_words(coarse, fine)
    assert added(fine, coarse).heights == pytest.approx(total.heights)


def test_a_pixel_missing_on_either_map_is_missing_on_the_sum():
    first, second = white(6, 6, 1), white(6, 6, 2)
    first[2, 3], second[4, 4] = np.nan, np.nan
    total = added(Topography(first, PIXEL), Topography(second, PIXEL))
    assert np.argwhere(total.missing).tolist() == [[2, 3], [4, 4]]


def test_too_small_a_common_area_is_refused_by_name():
    fine = Topography(white(6, 6), (1e-9, 1e-9), "fine.xyz")
    coarse = Topography(white(6, 6), (4e-9, 4e-9), "coarse.xyz")
    with pytest.raises(InputError, match=r"fine\.xyz \+ coarse\.xyz: .* 3 x 3 pixels"):
        added(fine, coarse)


def both(first: Topography, second: Topography) -> Pair:
    """Two maps as surfaces that face each other."""
    return pair(
        *(
            Surface(Reading(one, "made"), Prepared(one, (), 0), describe(one), "")
            for one in (first, second)
        )
    )


def test_the_composite_of_two_gaussian_surfaces_is_gaussian_with_the_rms_of_both():
    first, second = surface(512, 5.0, 13), surface(512, 5.0, 14, rms=2.0 * RMS)
    found = both(first, second)
    whole = sqrt(first.rms_height**2 + second.rms_height**2)
    assert found.height_gaussianity.rms == pytest.approx(whole, rel=1e-4)
    assert found.description.topography.rms_height == pytest.approx(whole, rel=0.02)
    assert "are Gaussian within the sampling error" in found.height_gaussianity.verdict
    tops = [find_summits(one).rms_height for one in (first, second)]
    assert found.summit_gaussianity.rms == pytest.approx(np.hypot(*tops), rel=1e-3)


def test_the_composite_of_alike_surfaces_has_their_summit_density():
    """Moments add up, and density depends on m4/m2 alone; the curvature grows by sqrt(2)."""
    first, second = surface(1024, 6.0, 15), surface(1024, 6.0, 16)
    single, summits = find_summits(first), both(first, second).description.summits
    assert summits.density == pytest.approx(single.density, rel=0.03)
    assert summits.radius == pytest.approx(single.radius / sqrt(2.0), rel=0.03)


def test_a_rough_surface_on_a_flat_one_is_the_rough_one():
    rough = surface(256, 5.0, 13)
    found = both(rough, Topography(np.zeros((256, 256)), rough.pixel_size))
    assert found.height_gaussianity.rms == pytest.approx(rough.rms_height, rel=1e-4)
    assert found.summits is None
    worth = describe(rough).independent
    assert found.height_gaussianity.independent == pytest.approx(worth, rel=1e-12)


# The description


@pytest.mark.parametrize(
    "heights",
    [np.zeros((9, 9)), np.full((40, 40), 3.3e-6), white(3, 3), white(9, 9), np.eye(30) * 1e-9],
    ids=["flat", "flat and far", "smallest", "few summits", "one ridge"],
)
def test_figures_that_do_not_exist_are_null_and_a_verdict_says_why(heights):
    found = describe(Topography(heights, PIXEL))
    record = plain(found.as_json())
    json.dumps(record, allow_nan=False)
    assert record["summits"]["skewness"] is None
    assert record["summit_rms_height"] is None
    assert any("too few for their statistics" in verdict for verdict in found.verdicts)


def test_the_description_does_not_depend_on_units_or_level():
    made = gaussian_surface((128, 128), 1.0, 1.0, 4.0, 18)
    small = describe(Topography(made * 1e-9, (1e-9, 1e-9))).as_json()
    large = describe(Topography(made * 1e-3 + 0.5, (1e-3, 1e-3))).as_json()
    for name, power in (("rms_height", 1), ("summit_radius", 1), ("summit_density", -2)):
        assert large[name] == pytest.approx(small[name] * 1e6**power, rel=1e-6)
    for name in ("skewness", "kurtosis", "bandwidth"):
        assert large[name] == pytest.approx(small[name], rel=1e-6)
    assert large["summits"]["mean_height"] == pytest.approx(
        1e6 * small["summits"]["mean_height"], rel=1e-6
    )


def test_missing_pixels_are_counted_and_the_unsearched_part_is_said():
    heights = gaussian_surface((128, 128), 1.0, RMS, 4.0, 19)
    heights[:20, :20] = np.nan
    found = describe(Topography(heights, PIXEL))
    assert found.as_json()["missing_pixels"] == 400
    assert any("unsearched" in verdict for verdict in found.verdicts)


def test_noise_is_said_not_to_be_resolved_by_the_pixel():
    found = describe(Topography(white(256, 256) * RMS, PIXEL))
    assert any("does not resolve the summits" in verdict for verdict in found.verdicts)
    smooth = describe(surface(1024, 12.0, 20))
    assert any("the pixel resolves the summits" in verdict for verdict in smooth.verdicts)


def test_an_anisotropic_surface_is_said_to_be_one():
    heights = gaussian_surface((256, 256), 1.0, RMS, 6.0, 21)[:, ::3]
    found = describe(Topography(heights, (1e-9, 1e-9)))
    assert any(verdict.startswith("anisotropic") for verdict in found.verdicts)
