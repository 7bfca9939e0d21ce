"""The publication's own method tends to the chain's motion when both assume the same."""

import importlib.util
import sys
from functools import cache
from pathlib import Path

import numpy as np
import pytest

import asperity
from asperity.config.resolve import resolve
from asperity.model import build
from asperity.publication.evidence import PRINTED
from figures import Figure

FILE = Path(__file__).parents[2] / "benchmarks" / "published_method.py"


@cache
def loaded():
    spec = importlib.util.spec_from_file_location("published_method", FILE)
    module = importlib.util.module_from_spec(spec)
    sys.modules[spec.name] = module  # a dataclass looks its module up
    spec.loader.exec_module(module)
    return module


@pytest.fixture(scope="module")
def method():
    return loaded()


@pytest.fixture(scope="module")
def case():
    return asperity.load("published")


def rebounds(method, case, impacts=1, **options):
    """Heights above the edge [m], the release first, and times of the apexes [s]."""
    model = method.of_problem(build(resolve(case)), deforms=False, **options)
    apexes, times = method.integrate(model, impacts)
    return np.array([model.release, *apexes]) - model.edge * model.rms, np.array(times)


def decrement(heights):
    return float(np.log(heights[0] / heights[1]))


def test_its_motion_converges_to_ours_with_grid_and_step(method, case):
    """64 x 64 at 0.1 us, then three and four times as fine: three rebounds and their times."""
    result = asperity.solve(case, critical=False)
    ours = np.array(result.measures["rebound_height"][:3])
    coarse, _ = rebounds(method, case, points=64)
    fine, times = rebounds(method, case, 3, points=192, step=2.5e-8)
    first = result.measures["log_decrement"][0]
    assert abs(decrement(coarse) / first - 1.0) < 0.01
    assert abs(decrement(fine) / first - 1.0) < min(
        5e-4, 0.2 * abs(decrement(coarse) / first - 1.0)
    )
    np.testing.assert_allclose(fine[1:], ours, rtol=2e-3)
    np.testing.assert_allclose(times, result.events["apex_time"][:3], rtol=1e-3)


def test_with_the_printed_polynomials_too(method, case):
    """At the inputs with which those meet the tables."""
    printed = PRINTED.within(case).replace({"publication.polynomials": "printed"})
    ours = asperity.solve(printed, critical=False).measures["log_decrement"][0]
    functions = {"f0": method.PRINTED_F0, "f32": method.PRINTED_F32}
    fine, _ = rebounds(method, printed, points=192, step=2.5e-8, **functions)
    assert decrement(fine) == pytest.approx(ours, rel=1e-3)


def test_with_those_and_an_edge_at_3_both_stick_at_the_first_impact(method, case):
    printed = {"f0": method.PRINTED_F0, "f32": method.PRINTED_F32}
    model = method.of_problem(build(resolve(case)), deforms=False, **printed)
    apexes, _ = method.integrate(model, 1)
    assert apexes[0] < model.edge * model.rms
    ours = asperity.solve(case.replace({"publication.polynomials": "printed"}), critical=False)
    assert ours.measures["log_decrement"] == [None]
    assert ours.measures["captured"]


def disc():
    """A uniform pressure on a disc of radius a displaces its centre by 2 p a/E*."""
    model = loaded().of_problem(build(resolve(asperity.load("published"))), points=128)
    middle = (np.arange(128) + 0.5) / 128 * 2.0 * model.half_width - model.half_width
    x, y = np.meshgrid(middle, middle)
    radius = 0.5 * model.half_width
    found = model.displacement(np.where(np.hypot(x, y) < radius, 1e6, 0.0))
    known = 2.0 * 1e6 * radius / model.modulus
    problem = "the publication's method: displacement in the middle of a loaded disc"
    return Figure(problem, "Johnson (1985), eq. 3.29a", known, float(found[64, 64]), "m", 5e-3)


def figures():
    return [disc()]


def test_its_displacement_is_that_of_the_half_space():
    assert disc().holds
