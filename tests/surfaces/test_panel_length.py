"""How finely the curves of measured heights are cut, against the curves themselves."""

import numpy as np
import pytest
from numpy.polynomial import chebyshev

from asperity._jax import jax, jnp
from asperity.surfaces.heights import Gaussian, Sampled, spread_of
from asperity.surfaces.heights.panel_length import SCANNING_NODES, PanelLengths, fineness_of

_RANDOM = np.random.default_rng(3)
RMS = 2e-9
HEIGHTS = {
    "normal": _RANDOM.standard_normal(20_000),
    "few": _RANDOM.standard_normal(30),
    "skewed": _RANDOM.gamma(2.0, size=1000),
    "two levels": np.where(_RANDOM.random(3000) < 0.5, -1.0, 1.0)
    + 0.01 * _RANDOM.standard_normal(3000),
}


@pytest.fixture(scope="module", params=HEIGHTS)
def sampled(request):
    heights = HEIGHTS[request.param]
    heights = RMS * (heights - heights.mean()) / heights.std()
    return Sampled(heights, np.ones(heights.size), 1.0)


@jax.jit
def first_moment(heights, places):
    return heights.tail(2, places)


def moments(heights, places):
    """First moments at places of any number, always computed for as many at once."""
    flat = np.ravel(places)
    rows = np.resize(flat, (-(-flat.size // 4096), 4096))
    found = np.concatenate([np.asarray(first_moment(heights, jnp.asarray(row))) for row in rows])
    return found[: flat.size].reshape(np.shape(places))


def largest_error(heights, length, nodes):
    """Of polynomials on pieces of the load of one force an asperity, over it at the mean."""
    rms = float(heights.rms)
    low, high = float(heights.bottom), float(heights.top)
    ends = np.arange(low - 0.37 * length * rms, high, length * rms)
    points, looks = chebyshev.chebpts1(nodes), np.linspace(-1.0, 1.0, 57)

    def load(x):
        return moments(heights, ends[:, None] + 0.5 * length * rms * (x + 1))

    read = chebyshev.chebval(looks, chebyshev.chebfit(points, load(points).T, nodes - 1))
    return np.max(np.abs(read - load(looks))) / float(moments(heights, 0.0))


def test_pieces_of_the_stated_lengths_read_the_curves_to_the_stated_error(sampled):
    """Wherever they begin: the trial's 4e-6 for panels and 2e-5 for ways, within a half more."""
    told = sampled.panel_lengths
    assert largest_error(sampled, told.panel, 16) < 6e-6
    for nodes, longest in zip(SCANNING_NODES, told.scanning, strict=True):
        assert largest_error(sampled, longest, nodes) < 3e-5


def test_longer_pieces_would_not_read_them(sampled):
    """Nothing is cut much finer than it has to be."""
    longer = min(1.6 * sampled.panel_lengths.panel, PanelLengths().panel)
    if longer < PanelLengths().panel:
        assert largest_error(sampled, longer, 16) > 4e-6


def test_a_smooth_density_is_cut_as_gaussian_heights_are():
    place = np.arange(-300.0, 301.0) / 40.0
    told = fineness_of(np.exp(-0.5 * place**2), 40.0)
    assert told.panel == PanelLengths().panel == Gaussian(RMS).panel_lengths.panel
    assert told.grain == 1.0
    assert told.scanning[-1] > 3.0


def test_a_way_takes_the_fewest_nodes_in_all():
    told = PanelLengths(0.5, (0.1, 0.25, 0.6, 0.7))
    assert told.along(0.0) == (6, 1)
    assert told.along(0.2) == (8, 1)  # not 6 on each of two
    assert told.along(0.7) == (16, 1)  # not 12 on each of two
    assert told.along(1.2) == (12, 2)  # not 16 on each of two
    assert told.along(1.9) == (16, 3)  # as many as 12 on each of four, in fewer pieces


def test_of_two_the_finer_counts():
    one, other = PanelLengths(0.5, (0.1, 0.2, 0.6, 0.7)), PanelLengths(0.7, (0.1, 0.25, 0.3, 0.5))
    assert one.and_of(other) == PanelLengths(0.5, (0.1, 0.2, 0.3, 0.5))


def test_a_single_height_and_two_far_apart_are_cut_in_a_bounded_number():
    for heights in ([0.0], [3e-9], [0.0, 1e-6], [0.0] * 1000 + [1e-6]):
        told = spread_of(np.asarray(heights)).panel_lengths
        assert 0.0 < told.panel <= PanelLengths().panel
        assert told.panel > 0.02
