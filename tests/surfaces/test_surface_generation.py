"""Self-affine surfaces: spectrum, moments, scale and heights against what was asked for."""

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st
from scipy import stats
from scipy.integrate import quad

from asperity.surfaces.generation.generate import self_affine
from asperity.surfaces.generation.height_shape import standard_heights
from asperity.surfaces.generation.self_affine import spectrum_error
from refused_input import refusal

PIXEL = 1e-8
POINTS = 512
ROLLOFF, CUTOFF = POINTS * PIXEL / 16, 8 * PIXEL
SPECTRUM = {"hurst": 0.8, "rolloff": ROLLOFF, "cutoff": CUTOFF}
GIVEN = {**SPECTRUM, "rms_height": 1e-9, "seed": 1}


def made(points=(POINTS, POINTS), pixel_size=(PIXEL, PIXEL), **changes):
    return self_affine(points, pixel_size, **{**GIVEN, **changes})


def power(topography):
    """Wave vectors [1/m] and mean square height of every wave, from the full transform."""
    heights = topography.heights
    along_y, along_x = (
        2 * np.pi * np.fft.fftfreq(count, step)
        for count, step in zip(heights.shape, topography.pixel_size[::-1], strict=True)
    )
    return along_x, along_y[:, None], abs(np.fft.fft2(heights) / heights.size) ** 2


def rings(topographies):
    """Wave vector and power density, both averaged over rings and over surfaces."""
    total = 0.0
    for topography in topographies:
        x, y, squares = power(topography)
        total = total + squares
    wave = np.hypot(x, y)
    ring = np.rint(wave / x[1]).astype(int).ravel()
    count = np.bincount(ring)
    return np.bincount(ring, wave.ravel()) / count, np.bincount(ring, total.ravel()) / count


def moments_of(topography):
    """m0, m2, m4 of a profile along x, by Parseval."""
    x, _, squares = power(topography)
    return np.array([(squares * x**order).sum() for order in (0, 2, 4)])


def moments_asked(hurst, rolloff, cutoff):
    """The same from the integrals of the isotropic spectrum, but for a common factor."""
    bend, end = 2 * np.pi / rolloff, 2 * np.pi / cutoff

    def integral(order):
        flat = bend ** (order + 2) / (order + 2)
        return (
            flat + quad(lambda q: q ** (order + 1) * (q / bend) ** (-2 - 2 * hurst), bend, end)[0]
        )

    shares = {0: 1.0, 2: 1 / 2, 4: 3 / 8}
    return np.array([share * integral(order) for order, share in shares.items()])


def hurst_of(wave, density, inside):
    """Hurst exponent by the slope of the power density over part of the wave vectors."""
    slope = np.polyfit(np.log(wave[inside]), np.log(density[inside]), 1)[0]
    return -slope / 2 - 1


@pytest.mark.parametrize("hurst", [0.3, 0.8, 1.0])
def test_the_spectrum_falls_with_the_power_of_the_hurst_exponent(hurst):
    rolloff, cutoff = POINTS * PIXEL / 8, 4 * PIXEL
    surfaces = [made(hurst=hurst, rolloff=rolloff, cutoff=cutoff, seed=seed) for seed in range(8)]
    wave, density = rings(surfaces)
    sloped = (wave > 1.2 * 2 * np.pi / rolloff) & (wave < 0.95 * 2 * np.pi / cutoff)
    assert hurst_of(wave, density, sloped) == pytest.approx(hurst, abs=0.02)


def test_the_spectrum_is_flat_above_the_rolloff_and_zero_below_the_cutoff():
    wave, density = rings([made(seed=seed) for seed in range(12)])
    bend = 2 * np.pi / ROLLOFF
    low = density[(wave > 0) & (wave < 0.5 * bend)].mean()
    high = density[(wave > 0.5 * bend) & (wave < 0.95 * bend)].mean()
    assert low == pytest.approx(high, rel=0.1)
    assert density[wave > 1.02 * 2 * np.pi / CUTOFF].max() < 1e-25 * low


def test_without_a_rolloff_the_power_law_reaches_the_size_of_the_map():
    wave, density = rings([made(rolloff=None, seed=seed) for seed in range(12)])
    found = hurst_of(wave, density, (wave > 0) & (wave < 10 * wave[1]))
    assert found == pytest.approx(0.8, abs=0.15)


@pytest.mark.parametrize("hurst", [0.5, 0.8])
def test_spectral_moments_are_the_integrals_of_the_spectrum(hurst):
    found = np.mean([moments_of(made(hurst=hurst, seed=seed)) for seed in range(12)], axis=0)
    asked = moments_asked(hurst, ROLLOFF, CUTOFF)
    assert found[1] / found[0] == pytest.approx(asked[1] / asked[0], rel=0.02)
    assert found[2] / found[1] == pytest.approx(asked[2] / asked[1], rel=0.02)
    assert found[0] == pytest.approx(1e-18, rel=1e-12)


@pytest.mark.parametrize("heights", [None, (1.0, 4.5)])
def test_the_map_made_has_exactly_the_rms_height_asked_for(heights):
    topography = made((128, 128), rolloff=None, heights=heights)
    assert topography.rms_height == pytest.approx(1e-9, rel=1e-12)
    assert abs(topography.heights.mean()) < 1e-22
    oblong = made((96, 64), (PIXEL, 2 * PIXEL), rolloff=None, heights=heights)
    assert oblong.heights.shape == (64, 96)
    assert oblong.physical_size == pytest.approx((96 * PIXEL, 128 * PIXEL))


@pytest.mark.parametrize("points", [(64, 81), (81, 64), (96, 96)])
@pytest.mark.parametrize("heights", [None, (1.0, 4.5)])
def test_the_map_made_has_exactly_the_rms_slope_asked_for(points, heights):
    """From the derivatives along x and y of the full Fourier series."""
    changes = {"rolloff": None, "rms_height": None, "rms_slope": 0.3, "heights": heights}
    topography = made(points, (PIXEL, 1.5 * PIXEL), cutoff=4 * PIXEL, **changes)
    x, y, squares = power(topography)
    assert np.sqrt((squares * (x**2 + y**2)).sum()) == pytest.approx(0.3, rel=1e-12)


def test_the_surface_is_isotropic_on_oblong_pixels():
    found = []
    for seed in range(6):
        x, y, squares = power(made((512, 256), (PIXEL, 2 * PIXEL), seed=seed))
        found.append([(squares * x**2).sum(), (squares * y**2).sum()])
    along_x, along_y = np.mean(found, axis=0)
    assert along_x == pytest.approx(along_y, rel=0.03)


def test_heights_are_gaussian_unless_given():
    """Skewness and excess kurtosis in the mean over surfaces, within three standard errors."""
    shapes = [
        (stats.skew(heights), stats.kurtosis(heights))
        for heights in (made(seed=seed).heights.ravel() for seed in range(16))
    ]
    error = 3 * np.std(shapes, axis=0) / np.sqrt(15)
    assert (abs(np.mean(shapes, axis=0)) < error).all()


@pytest.mark.parametrize("pair", [(0, 3), (1, 4.5), (-1, 5), (2, 9), (0, 2)])
def test_skewness_and_kurtosis_are_those_asked_for(pair):
    heights = made((256, 256), heights=pair).heights.ravel()
    assert stats.skew(heights) == pytest.approx(pair[0], rel=0.01, abs=0.001)
    assert stats.kurtosis(heights, fisher=False) == pytest.approx(pair[1], rel=0.01)


def test_measured_heights_keep_their_distribution_but_not_their_scale():
    measured = np.random.default_rng(0).gamma(2.0, size=5000)
    heights = made((128, 128), heights=measured).heights.ravel()
    known = (measured - measured.mean()) / measured.std()
    assert stats.ks_2samp(heights / 1e-9, known).statistic < 0.003
    larger = made((128, 128), heights=7e-6 * measured).heights.ravel()
    np.testing.assert_allclose(larger, heights, rtol=0, atol=1e-20)


@pytest.mark.parametrize(("pair", "curvature"), [((0, 3), 0.03), ((1, 4.5), 0.1), ((0, 6), 0.4)])
def test_given_heights_leave_the_spectrum_but_for_a_little_beyond_the_cutoff(pair, curvature):
    """The error is there, and told: it grows with the distance from a Gaussian."""
    gaussian, given = (
        spectrum_error(made((256, 256), heights=pair), **SPECTRUM) for pair in (None, pair)
    )
    assert gaussian.beyond < 1e-25
    assert 0 < given.beyond < 1e-3
    assert given.beyond < given.curvature_beyond < curvature


def test_a_gaussian_surface_has_the_spectrum_up_to_chance_and_another_is_told_from_it():
    """A ring of n waves has n/2 that are independent, each with exponential power."""
    ring = ROLLOFF / CUTOFF * 16
    chance = np.sqrt(2 * ring / (np.pi * ring**2))
    right = spectrum_error(made(), **SPECTRUM)
    assert right.rms == pytest.approx(chance, rel=0.25)
    assert spectrum_error(made(), **{**SPECTRUM, "hurst": 0.3}).rms > 3 * right.rms


def test_the_same_seed_gives_the_same_surface():
    np.testing.assert_array_equal(made().heights, made().heights)
    assert abs(np.corrcoef(made().heights.ravel(), made(seed=2).heights.ravel())[0, 1]) < 0.2


def test_a_surface_does_not_depend_on_the_unit_of_length():
    micro = self_affine(
        (128, 128), (1e-2, 1e-2), hurst=0.8, rolloff=0.32, cutoff=0.08, rms_height=1e-3, seed=1
    )
    metres = made((128, 128), rolloff=0.32e-6)
    np.testing.assert_allclose(micro.heights * 1e-6, metres.heights, rtol=0, atol=1e-20)


REFUSED = [
    {"hurst": 0.0}, {"hurst": 1.01}, {"hurst": np.nan}, {"cutoff": 1.9 * PIXEL},
    {"cutoff": 2 * ROLLOFF}, {"rolloff": 1.01 * POINTS * PIXEL}, {"rolloff": np.inf},
    {"rms_height": None}, {"rms_height": 0.0}, {"rms_height": 1e-9, "rms_slope": 0.1},
    {"rms_slope": -0.1, "rms_height": None},
    {"seed": -1}, {"seed": 1.5}, {"points": (2, 64)}, {"points": (64.0, 64)},
    {"pixel_size": (0.0, PIXEL)}, {"heights": (1.0, 2.0)}, {"heights": (1.0, 1.5)},
    {"heights": (np.nan, 3.0)}, {"heights": (0.0, 3.0, 1.0)}, {"heights": np.arange(15.0)},
    {"heights": np.full(100, 2.0)}, {"heights": np.append(np.arange(100.0), np.nan)},
    {"heights": (0.0, 1e6)},
]  # fmt: skip


@pytest.mark.parametrize("changes", REFUSED, ids=range(len(REFUSED)))
def test_bad_input_is_refused_by_its_key(changes):
    key = next(iter(changes))
    error = refusal(made, **changes)
    assert error.key == key
    assert f"`{key}`" in str(error)


@settings(max_examples=50)
@given(st.floats(-2.5, 2.5), st.floats(0.05, 8.0))
@example(1.7734375, 4.71875)  # just below the lognormal line
def test_every_possible_pair_of_skewness_and_kurtosis_has_heights(skewness, above):
    kurtosis = skewness**2 + 1.0 + above
    heights = standard_heights((skewness, kurtosis), 20_000)
    assert (np.diff(heights) >= 0.0).all()
    assert heights.std() == pytest.approx(1.0)
    assert stats.skew(heights) == pytest.approx(skewness, abs=0.01)
    assert stats.kurtosis(heights, fisher=False) == pytest.approx(kurtosis, rel=0.01)
