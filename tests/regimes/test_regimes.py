"""The adhesion map in the limits that are known, the choice of the law, and verdicts."""

from math import pi, sqrt
from types import SimpleNamespace

import numpy as np
import pytest
from scipy.optimize import brentq

from asperity.regimes import (
    ELASTICITY_PER_TABOR,
    Frame,
    Place,
    Regime,
    adhesion_map,
    choose_adhesion,
    hertz_load,
    region,
    verdicts,
)

ELASTICITY, LOAD = np.logspace(-3.0, 2.0, 101), np.logspace(-2.0, 6.0, 161)


@pytest.fixture(scope="module")
def lines():
    return {line.between: line for line in adhesion_map(ELASTICITY, LOAD)}


def at_load(line, load):
    """Elasticity parameter of a line at a load."""
    return line.elasticity[np.argmin(np.abs(np.log(line.load / load)))]


def test_adhesion_of_rigid_spheres_is_five_percent_of_forty(lines):
    """DMT adds 2 pi w R: 5 % of 40 pi w R."""
    assert lines["Hertz", "adhesive"].load[0] == pytest.approx(40.0, rel=0.03)
    assert hertz_load(1e-5) == pytest.approx(40.0, rel=2e-3)


def test_adhesion_of_soft_spheres_is_five_percent_where_jkr_says(lines):
    """3 + sqrt(6 P + 9) = 0.05 P."""
    load = lines["Hertz", "adhesive"].load[-1]
    assert 3.0 + sqrt(6.0 * load + 9.0) == pytest.approx(0.05 * load, rel=2e-3)
    assert hertz_load(1e4) == pytest.approx(2520.0, rel=1e-3)


@pytest.mark.parametrize("load", [1.0, 10.0, 100.0])
def test_rigid_spheres_are_those_that_compression_does_not_reach(lines, load):
    """With DMT's a^3 = P + 2: a^2 = 0.05 times 2/(pi lambda)."""
    expected = 0.05 * 2.0 / pi / (load + 2.0) ** (2.0 / 3.0)
    assert at_load(lines["Bradley", "DMT"], load) == pytest.approx(expected, rel=0.02)


def test_dmt_ends_where_a_ring_as_wide_as_its_reach_lifts_the_rim(lines):
    """Without load c^2 = 4/(pi lambda), delta_a = 4/3 lambda c: (4/3) sqrt(pi) lambda^1.5."""
    expected = (0.05 * 3.0 / (4.0 * sqrt(pi))) ** (2.0 / 3.0)
    assert at_load(lines["DMT", "Maugis-Dugdale"], 0.01) == pytest.approx(expected, rel=0.02)


def test_dmt_of_a_large_contact_ends_where_its_narrow_rim_lifts(lines):
    """With c close to a: delta_a = 4/3 lambda (3 a/(2 lambda))^(1/3), a^3 = P."""
    radius = 1e6 ** (1.0 / 3.0)
    expected = (0.15 / (2.0 * pi * (1.5 * radius) ** (1.0 / 3.0))) ** 0.6
    assert at_load(lines["DMT", "Maugis-Dugdale"], 1e6) == pytest.approx(expected, rel=0.02)


def test_jkr_begins_where_its_own_displacement_is_twenty_ranges(lines):
    """delta_a = sqrt(8 a/3), a^3 = 6 without load: 20 times 2/(pi lambda), a Tabor number of 4.99.

    JKR's error is (c - a)/lambda = 0.05 in the rim's equation there.
    """
    expected = 40.0 / (pi * sqrt(8.0 * 6.0 ** (1.0 / 3.0) / 3.0))
    assert at_load(lines["Maugis-Dugdale", "JKR"], 0.01) == pytest.approx(expected, rel=0.025)


@pytest.mark.parametrize("load", [1.0, 100.0, 1e3, 1e5])
def test_jkr_begins_where_a_narrow_rim_is_lifted_by_twenty_ranges(lines, load):
    """With m close to 1, x = a sqrt(m^2 - 1): 2/3 (lambda x^3 + lambda^2 x^2) = a."""

    def excess(elasticity):
        x = 30.0 / (pi * elasticity**2)  # 4/3 lambda x = 20 * 2/(pi lambda)
        radius = 2.0 / 3.0 * (elasticity * x**3 + (elasticity * x) ** 2)
        return radius**3 - 2.0 * elasticity * radius * x - load

    expected = brentq(excess, 0.5, 10.0)
    assert at_load(lines["Maugis-Dugdale", "JKR"], load) == pytest.approx(expected, rel=0.03)


def test_the_maps_regions_lie_in_order_where_the_publication_says(lines):
    """Tabor numbers below 0.1 and above 5, to the accuracy of such a rule."""
    pairs = (("Bradley", "DMT"), ("DMT", "Maugis-Dugdale"), ("Maugis-Dugdale", "JKR"))
    at = [at_load(lines[pair], 0.1) for pair in pairs]
    assert at == sorted(at)
    _, dmt, jkr = (at_load(lines[pair], 0.01) / ELASTICITY_PER_TABOR for pair in pairs)
    assert 0.05 < dmt < 0.1
    assert jkr == pytest.approx(5.0, rel=0.03)


@pytest.mark.parametrize("elasticity", [1e-4, 0.03, 0.7, 30.0, 1e4])
def test_the_map_solves_maugiss_equations(elasticity):
    """An independent root of both equations at the load on the Hertz line: adhesion adds 5 %."""
    load = hertz_load(elasticity)

    def rim(m, radius):
        root, angle = sqrt(m * m - 1.0), np.arccos(1.0 / m)
        first = 0.5 * elasticity * radius**2 * (root + (m * m - 2.0) * angle)
        return first + 4.0 / 3.0 * elasticity**2 * radius * (root * angle - m + 1.0) - 1.0

    def added(radius):
        m = brentq(rim, 1.0 + 1e-12, 1e6, args=(radius,), xtol=1e-14)
        return elasticity * radius**2 * (sqrt(m * m - 1.0) + m * m * np.arccos(1.0 / m))

    radius = brentq(lambda a: a**3 - added(a) - load, load ** (1 / 3), 2.0 * load ** (1 / 3))
    assert added(radius) == pytest.approx(0.05 * load, rel=2e-3)


def test_a_place_lies_in_the_region_between_its_lines():
    places = {(2e-3, 1.0): "Bradley", (0.04, 1.0): "DMT", (0.5, 1.0): "Maugis-Dugdale",
              (30.0, 1.0): "JKR", (0.024, 7e3): "Hertz", (1e4, 1e8): "Hertz"}  # fmt: skip
    assert {place: region(*place) for place in places} == places


def test_the_frame_takes_in_every_case_by_whole_decades():
    assert Frame.around([]) == Frame((1e-3, 1e2), (1e-1, 1e5))
    wide = Frame.around([Place("a", 3e-4, 2e6), Place("b", 0.1, float("nan"))])
    assert wide == Frame(pytest.approx((1e-4, 1e2)), pytest.approx((1e-1, 1e7)))
    assert Frame.around([Place("far", 1e-9, 1e20)]).load[1] == pytest.approx(1e9)


@pytest.mark.parametrize(
    ("tabor", "law"),
    [(0.01, "bradley"), (0.0206, "dmt"), (0.0999, "dmt"), (0.1, "maugis"), (5.0, "maugis"),
     (5.01, "jkr"), (80.0, "jkr")],
)  # fmt: skip
def test_the_tabor_number_chooses_the_law(tabor, law):
    """That of the publication's asperities, 0.0206, chooses DMT as it says."""
    choice = choose_adhesion(tabor)
    assert choice.law == law
    assert f"{tabor:.3g}" in choice.reason or f"{1.16 * tabor:.3g}" in choice.reason


def test_bradley_ends_where_the_pull_of_a_resting_sphere_compresses_it():
    """The foot of the map's line, at no load: a^2 = 2^(2/3) = 0.05 times 2/(pi lambda)."""
    foot = 0.1 / (pi * 2.0 ** (2.0 / 3.0)) / ELASTICITY_PER_TABOR
    assert choose_adhesion(0.999 * foot).law == "bradley"
    assert choose_adhesion(1.001 * foot).law == "dmt"


@pytest.mark.parametrize("border", [0.1, 5.0])
def test_a_border_within_a_factor_of_one_and_a_half_is_named(border):
    for share, near in ((1.0 / 1.52, False), (1.0 / 1.48, True), (1.48, True), (1.52, False)):
        warnings = choose_adhesion(share * border).border_warnings
        assert any(f"Tabor number is {border:g} there" in text for text in warnings) is near
    (text,) = choose_adhesion(0.9 * border).border_warnings
    other = {0.1: "maugis", 5.0: "jkr"}[border]
    assert f"model = '{other}'" in text
    assert f"{ELASTICITY_PER_TABOR * border:.3g}" in text


DMT = Regime(0.02, 0.0232, 0.5, 7e3, "dmt")


def said(regime=DMT, kelvin_radius=1e-9):
    inputs = SimpleNamespace(
        asperities=SimpleNamespace(spacing=70e-9), tip_radius=25e-9, yields=False,
        liquid=SimpleNamespace(molecule_size=0.28e-9), kelvin_radius=kelvin_radius,
        liquid_radius=kelvin_radius, structure=SimpleNamespace(liquid="equilibrium"),
    )  # fmt: skip
    return verdicts(inputs, regime, 30.0)


def test_every_number_that_does_not_apply_says_why():
    nothing = Regime(None, None, None, None, "none")
    smooth = SimpleNamespace(asperities=None, tip_radius=1e-6, liquid=None, liquid_radius=0.0)
    found = verdicts(smooth, nothing, 1.0)
    missing = {name: one.verdict for name, one in found.items() if one.value is None}
    assert set(missing) == set(found) - {"adhesion_law", "liquid_regime"}
    assert all(missing.values())
    assert missing["load_parameter"] == "the case has no adhesion"


def test_the_state_of_the_liquid_is_said_with_its_reason():
    regime = DMT._replace(liquid_regime="coalesced", liquid_regime_reason="7 nm reach 6 nm")
    found = said(regime=regime, kelvin_radius=30e-9)
    assert found["liquid_regime"][::2] == ("coalesced", "7 nm reach 6 nm")
    ratio = found["kelvin_radius_over_tip_radius"]
    assert ratio.value == pytest.approx(1.2)
    assert "wider than their tips" in ratio.verdict


def test_load_says_whether_adhesion_counts_beside_contact():
    heavy = said()["load_parameter"].verdict
    light = said(regime=Regime(0.02, 0.0232, 0.5, 3.0, "dmt"))["load_parameter"]
    unknown = said(regime=Regime(None, None, 0.5, 300.0, "jkr"))["load_parameter"]
    assert "negligible" in heavy
    assert "counts" in light.verdict
    assert "`adhesion.equilibrium_spacing` decides" in unknown.verdict


def test_a_chosen_law_comes_with_its_reason():
    law = said(regime=Regime(0.02, 0.02, None, 1.0, "dmt", "because"))
    assert law["adhesion_law"] == ("dmt", "", "chosen: because")
