"""Preparation and description beside SurfaceTopography, on one map with pixels of 3 nm x 2 nm."""

import functools
import warnings

import numpy as np
import pytest

from asperity.surfaces.description.spectrum import moments, profile_spectrum
from asperity.surfaces.preparation.form_removal import levelled
from asperity.surfaces.preparation.line_levelling import lines_aligned
from asperity.surfaces.preparation.missing_pixels import filled
from asperity.surfaces.topography import Topography

STEP = (3e-9, 2e-9)
SHAPE = (48, 64)
HEIGHTS = 1e-11 * np.random.default_rng(3).normal(size=SHAPE).cumsum(axis=0).cumsum(axis=1)
HEIGHTS -= HEIGHTS.mean()
OURS = Topography(HEIGHTS, STEP)
SQUARE = (STEP[0], STEP[0])


@functools.cache
def library():
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # it has no MPI
        import SurfaceTopography
    return SurfaceTopography


def theirs(heights=HEIGHTS, step=STEP):
    size = [count * length for count, length in zip(heights.shape[::-1], step, strict=True)]
    return library().Topography(np.ma.masked_invalid(heights).T, size, unit="m")


def assert_same(found, heights):
    """To a ten thousand millionth of the rms height, but for a constant."""
    apart = np.asarray(found.heights() if hasattr(found, "heights") else found).T - heights
    assert np.ptp(apart) < 1e-10 * OURS.rms_height


def test_rms_gradient():
    # Theirs averages the squares on triangles, ours on all pairs of neighbours.
    assert theirs().rms_gradient() == pytest.approx(np.hypot(*moments(OURS).slopes), rel=0.02)


@pytest.mark.parametrize(("form", "mode"), [("tilt", "height"), ("curvature", "curvature")])
def test_form_of_least_squares(form, mode):
    assert_same(theirs().detrend(mode), levelled(OURS, form)[0].heights)


@pytest.mark.parametrize(
    ("how", "degree", "mode"), [("median", 0, "median"), ("polynomial", 2, "mean")]
)
@pytest.mark.parametrize(("direction", "axis"), [("rows", "x"), ("columns", "y")])
def test_levelling_of_scan_lines(how, degree, mode, direction, axis):
    found = lines_aligned(OURS, how, direction, degree)[0]
    assert_same(theirs().scan_line_align(axis, mode, degree), found.heights)


@pytest.mark.parametrize("direction", ["x", "y"])
def test_density_of_profiles_is_theirs_but_for_its_scale(direction):
    ours = profile_spectrum(OURS, direction)
    turned = theirs() if direction == "x" else theirs(HEIGHTS.T, STEP[::-1])
    wavenumber, density = turned.power_spectrum_from_profile(
        window="hann", reliable=False, resampling_method=None
    )
    count = len(wavenumber)
    assert wavenumber == pytest.approx(ours.wavenumber[:count], rel=1e-12)
    ratio = density[1:] / ours.density[1:count]
    assert ratio == pytest.approx(ratio[0], rel=1e-10)
    # Ours integrates to the variance, whatever the window takes.
    whole = ours.density.sum() * ours.wavenumber[1]
    assert whole == pytest.approx(OURS.rms_height**2, rel=1e-12)


def test_filling_is_theirs_where_pixels_are_square():
    holes = HEIGHTS.copy()
    holes[10:15, 20:27] = holes[0, :4] = np.nan
    found = filled(Topography(holes, SQUARE), "fill")[0].heights
    assert_same(theirs(holes, SQUARE).interpolate_undefined_data(), found)


def test_filling_heeds_pixels_that_are_not_square_and_theirs_does_not():
    y, x = (length * np.arange(count) for count, length in zip(SHAPE, STEP[::-1], strict=True))
    harmonic = (x**2 - y[:, None] ** 2) / 1e-6
    holes = harmonic.copy()
    holes[10:15, 20:27] = np.nan
    found = filled(Topography(holes, STEP), "fill")[0].heights
    assert np.abs(found - harmonic).max() < 1e-12 * np.ptp(harmonic)
    other = theirs(holes).interpolate_undefined_data().heights().T
    assert np.abs(other - harmonic).max() > 1e-4 * np.ptp(harmonic)
