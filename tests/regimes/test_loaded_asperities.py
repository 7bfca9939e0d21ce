"""The effective number of loaded asperities in a mean, beside sums over drawn summits."""

import numpy as np
import pytest

from asperity.inputs import Asperities
from asperity.interface.summit_field import GaussianField
from asperity.regimes import clustering, loaded_asperities

RADIUS, RMS = 25e-6, 1.64e-9
ROUGH = Asperities(6.3e13, 450e-9, RMS)


def drawn_number(separation, blocks=40):
    """Means over bodies at one separation: of the sum of Hertz's loads, and of their squares."""
    field = GaussianField(RADIUS, ROUGH.asperity_density, RMS)
    loads, squares = [], []
    for block in range(blocks):
        offsets, _ = field.summits(7, block, 256)
        each = np.maximum(offsets - separation, 0.0) ** 1.5
        loads.append(np.sum(each, axis=1))
        squares.append(np.sum(each**2, axis=1))
    return float(np.mean(loads) ** 2 / np.mean(squares)), float(field.expected_above(separation))


@pytest.mark.parametrize("separation", [2.0 * RMS, 1.0 * RMS, -RMS])
def test_it_is_that_of_summits_drawn_at_random(separation):
    drawn, touching = drawn_number(separation)
    found = loaded_asperities(ROUGH, touching, separation, measured=False)
    assert found == pytest.approx(drawn, rel=0.06)


def test_it_tends_to_the_limits_of_few_and_of_all():
    """Offsets fall off like an exponential far out; deep down they are even."""
    shares = [
        loaded_asperities(ROUGH, 1.0, separation, measured=False)
        for separation in (8.0 * RMS, 3.0 * RMS, -1000.0 * RMS)
    ]
    assert 0.2945 < shares[0] < 0.32
    assert shares[0] < shares[1] < shares[2] == pytest.approx(0.64, rel=1e-4)
    assert loaded_asperities(ROUGH, 0.0, 10.0 * RMS, measured=False) == 0.0


def test_measured_summits_count_with_their_heights_and_radii():
    from types import SimpleNamespace

    heights = np.random.default_rng(1).normal(0.0, RMS, 400_000)
    summits = SimpleNamespace(heights=heights, radii=np.full(heights.size, 450e-9))
    rough = Asperities(6.3e13, 450e-9, RMS, summits=summits)  # type: ignore[arg-type]
    gaussian = loaded_asperities(rough, 5.0, 1.5 * RMS, measured=False)
    assert loaded_asperities(rough, 5.0, 1.5 * RMS, measured=True) == pytest.approx(
        gaussian, rel=0.02
    )
    # A few blunt tips carry more than others, so that fewer carry the load.
    summits.radii = np.where(np.arange(heights.size) % 10 == 0, 4.5e-6, 450e-9)
    assert loaded_asperities(rough, 5.0, 1.5 * RMS, measured=True) < gaussian


def test_summits_that_stand_together_count_as_one():
    """Four at each place carry as a fourth of their number; on independent ones nothing changes."""
    from types import SimpleNamespace

    side, pixel, random = 60e-6, 1e-9, np.random.default_rng(2)
    counts = [16, 4]  # thousand places with one summit, or four
    found = []
    for together, number in zip((1, 4), counts, strict=True):
        places = random.uniform(0.0, side / pixel, (1000 * number, 2)).repeat(together, axis=0)
        heights = random.normal(0.0, RMS, 1000 * number).repeat(together)
        order = np.argsort(places[:, 0])
        summits = SimpleNamespace(
            heights=heights[order],
            radii=np.full(heights.size, 450e-9),
            positions=places[order],
            pixel_size=(pixel, pixel),
        )
        surface = SimpleNamespace(physical_size=(side, side))
        rough = Asperities(6.3e13, 450e-9, RMS, surface=surface, summits=summits)  # type: ignore[arg-type]
        found.append(clustering(rough, RADIUS, RMS))
    assert found[0] > 0.8
    assert found[1] == pytest.approx(0.25, rel=0.2)
