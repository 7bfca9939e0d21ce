"""The adhesion map: its boundaries in the limits that are known."""

from math import pi, sqrt

import numpy as np
import pytest

from asperity.regimes import adhesion_map

ELASTICITY, LOAD = np.logspace(-3.0, 2.0, 101), np.logspace(-2.0, 5.0, 101)


@pytest.fixture(scope="module")
def lines():
    return {line.between: line for line in adhesion_map(ELASTICITY, LOAD)}


def test_adhesion_of_rigid_spheres_is_five_percent_of_forty(lines):
    """DMT adds 2 pi w R: 5 % of 40 pi w R."""
    assert lines["Hertz", "adhesive"].load[0] == pytest.approx(40.0, rel=0.03)


def test_adhesion_of_soft_spheres_is_five_percent_where_jkr_says(lines):
    """3 + sqrt(6 P + 9) = 0.05 P."""
    load = lines["Hertz", "adhesive"].load[-1]
    assert 3.0 + sqrt(6.0 * load + 9.0) == pytest.approx(0.05 * load, rel=2e-3)


@pytest.mark.parametrize("load", [1.0, 10.0, 100.0])
def test_rigid_spheres_are_those_that_compression_does_not_reach(lines, load):
    """With DMT's a^3 = P + 2: a^2 = 0.05 times 2/(pi lambda)."""
    line = lines["Bradley", "DMT"]
    index = np.searchsorted(line.load, load)
    expected = 0.05 * 2.0 / pi / (line.load[index] + 2.0) ** (2.0 / 3.0)
    assert line.elasticity[index] == pytest.approx(expected, rel=0.02)


def test_dmt_ends_and_jkr_begins_where_the_publication_says(lines):
    """Tabor numbers below 0.1 and above 5, to the accuracy of such a rule."""
    dmt = lines["DMT", "Maugis-Dugdale"].elasticity[0]
    jkr = lines["Maugis-Dugdale", "JKR"].elasticity[0]
    assert 0.05 < dmt / 1.16 < 0.1
    assert 4.0 < jkr / 1.16 < 6.0


def test_the_maps_regions_lie_in_order(lines):
    at = [lines[pair].elasticity[20] for pair in
          (("Bradley", "DMT"), ("DMT", "Maugis-Dugdale"), ("Maugis-Dugdale", "JKR"))]  # fmt: skip
    assert at == sorted(at)
