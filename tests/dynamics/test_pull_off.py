"""Pull-off and work of separation: properties of the unloading, whatever the impact before."""

from math import pi, sqrt

import numpy as np
import pytest
from scipy.integrate import quad

import asperity
from asperity.config import load_file
from asperity.errors import InputError
from jkr_spheres import MODULUS, RADIUS, UNIT, W, jkr, smooth


def jkr_work() -> float:
    """Work from zero force to rupture, for w = R = E* = 1."""
    free, rupture = (4.5 * pi) ** (1.0 / 3.0), (pi / 8.0) ** (1.0 / 3.0)
    return quad(lambda a: -jkr(a)[0] * (sqrt(0.5 * pi / a) - 2.0 * a), free, rupture)[0] * -1.0


OVERLAP = (1.5 * pi * W * RADIUS / (MODULUS * sqrt(RADIUS))) ** (2.0 / 3.0)
DMT_WORK = 0.6 * 2.0 * pi * W * RADIUS * OVERLAP  # Hertz's energy is two fifths of F delta
TAIL = 2.0 * pi * RADIUS * W * 0.2e-9 * 9.0 / 7.0  # of the 3-9 potential: (4/3 - 1/21) eps w


@pytest.mark.parametrize(
    ("model", "pull_off", "work"),
    [
        ("jkr", 1.5 * pi * W * RADIUS, UNIT * abs(jkr_work())),
        ("dmt", 2.0 * pi * W * RADIUS, DMT_WORK),
        ("bradley", 2.0 * pi * W * RADIUS, DMT_WORK + TAIL),
    ],
)
def test_pull_off_and_work_are_those_of_closed_forms(model, pull_off, work):
    """Whatever the speed: see `validation/test_pull_off_of_spheres.py`."""
    curve = asperity.curve(smooth(model, "20 m/s"))
    assert curve.pull_off == pytest.approx(pull_off, rel=1e-9)
    assert curve.work_of_separation == pytest.approx(work, rel=1e-9)
    assert curve.preload is None


def test_maugis_pull_off_lies_between_the_limits_and_has_no_speed():
    found = [asperity.curve(smooth("maugis", speed)).pull_off for speed in ("0.3 m/s", "20 m/s")]
    assert found[1] == pytest.approx(found[0], rel=1e-9)
    assert 1.5 < found[0] / (pi * W * RADIUS) < 2.0


def test_nothing_pulls_where_nothing_adheres():
    """Not even the rounding of the repulsion."""
    bare = smooth("jkr", "20 m/s").replace({"adhesion": None})
    measures = asperity.solve(bare, critical=False).measures
    assert (measures["pull_off"], measures["work_of_separation"]) == (0.0, 0.0)
    assert measures["pull_off_separation"] is None


def test_a_run_measures_what_its_curve_does():
    case = smooth("jkr")
    measures, curve = asperity.solve(case, critical=False).measures, asperity.curve(case)
    assert measures["preload"] is curve.preload is None
    for name in ("pull_off", "pull_off_separation", "work_of_separation"):
        # Two compiled programs may round differently.
        assert measures[name] == pytest.approx(getattr(curve, name), rel=1e-12)


def test_bonds_made_by_contact_pull_more_after_a_larger_load_and_say_so():
    case = load_file("examples/wet-drop.toml")
    loads = (1e-6, 1e-5, 1e-4)
    curves = [asperity.curve(case, load=load) for load in loads]
    assert [curve.preload for curve in curves] == pytest.approx(loads, rel=1e-6)
    assert curves[0].pull_off < curves[1].pull_off < curves[2].pull_off
    for curve in curves:
        tension = -curve.force_unloading
        assert curve.pull_off == pytest.approx(tension.max(), rel=1e-3)
        assert curve.pull_off >= tension.max() * (1.0 - 1e-9)
        there = curve.rigid_separation[np.argmax(tension)]
        assert curve.pull_off_separation == pytest.approx(there, abs=2e-10)
        area = -np.trapezoid(np.minimum(curve.force_unloading, 0.0), curve.rigid_separation)
        assert curve.work_of_separation == pytest.approx(area, rel=1e-2)


STILL = smooth("jkr").replace({"impact": None})


def test_a_case_without_an_impact_is_loaded_to_what_is_asked():
    for load in (0.0, 1e-7, 1e-3):
        curve = asperity.curve(STILL, load=load)
        assert curve.force_loading[0] == pytest.approx(load, rel=1e-9, abs=1e-15)
        assert curve.case.impact is None
    for depth in (1e-9, 3e-8):  # before and beyond where attraction alone draws it
        curve = asperity.curve(STILL, depth=depth)
        assert curve.minimum_separation == pytest.approx(-depth, rel=1e-9)
        assert curve.pull_off == pytest.approx(1.5 * pi * W * RADIUS, rel=1e-9)


@pytest.mark.parametrize(
    ("given", "words"),
    [
        ({}, r"an \[impact\] table must be given"),
        ({"load": 1e-6, "depth": 1e-9}, "either `load` or `depth`"),
        ({"load": -1e-6}, "`load` must be 0 N or more; got -1e-06 N"),
        ({"load": float("nan")}, "`load` must be 0 N or more; got nan N"),
        ({"depth": -1.0}, "`depth` must lie above .* where forces begin"),
    ],
)
def test_what_cannot_be_loaded_is_refused_in_one_line(given, words):
    with pytest.raises(InputError, match=words) as caught:
        asperity.curve(STILL, **given)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize("compute", [asperity.solve, asperity.restitution_curve])
def test_a_motion_needs_an_impact(compute):
    with pytest.raises(InputError, match=r"an \[impact\] table must be given"):
        compute(STILL)


def test_a_curve_warns_as_a_run_does():
    case = smooth("dmt")
    curve, result = asperity.curve(case), asperity.solve(case, critical=False)
    assert curve.warnings == result.warnings
    assert any("Tabor number" in line for line in curve.warnings)
    assert curve.warnings[0] in " ".join(curve.summary().split())
