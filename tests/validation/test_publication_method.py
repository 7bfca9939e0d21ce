"""The publication's own method tends to the chain's motion when both assume the same."""

import importlib.util
import sys
from pathlib import Path

import numpy as np
import pytest

import asperity
from asperity.case.build import build

FILE = Path(__file__).parents[2] / "benchmarks" / "published_method.py"


@pytest.fixture(scope="module")
def method():
    spec = importlib.util.spec_from_file_location("published_method", FILE)
    module = importlib.util.module_from_spec(spec)
    sys.modules[spec.name] = module  # a dataclass looks its module up
    spec.loader.exec_module(module)
    return module


@pytest.fixture(scope="module")
def case():
    return asperity.load("published")


def first_decrement(method, case, **options):
    model = method.of_problem(build(case), deforms=False, **options)
    apexes, _ = method.fly(model, 1)
    edge = model.edge * model.rms
    return float(np.log((model.release - edge) / (apexes[0] - edge)))


def test_its_decrement_converges_to_ours_with_grid_and_step(method, case):
    """64 x 64 at 0.1 us, then three times as fine in both: 0.5 % and 0.02 %."""
    ours = asperity.solve(case).measures["log_decrement"][0]
    coarse = abs(first_decrement(method, case, points=64) / ours - 1.0)
    fine = abs(first_decrement(method, case, points=192, step=2.5e-8) / ours - 1.0)
    assert coarse < 0.01
    assert fine < 5e-4
    assert fine < 0.2 * coarse


def test_with_the_printed_polynomials_both_stick_at_the_first_impact(method, case):
    printed = {"f0": method.PRINTED_F0, "f32": method.PRINTED_F32}
    model = method.of_problem(build(case), deforms=False, **printed)
    apexes, _ = method.fly(model, 1)
    assert apexes[0] < model.edge * model.rms
    ours = asperity.solve(case.replace({"publication.polynomials": "printed"}))
    assert ours.measures["log_decrement"] == [None]
    assert ours.measures["captured"]


def test_its_displacement_is_that_of_the_half_space(method, case):
    """A uniform pressure on a disc of radius a displaces its centre by 2 p a/E* (Johnson 3.29a)."""
    model = method.of_problem(build(case), points=128)
    middle = (np.arange(128) + 0.5) / 128 * 2.0 * model.half_width - model.half_width
    x, y = np.meshgrid(middle, middle)
    radius = 0.5 * model.half_width
    found = model.displacement(np.where(np.hypot(x, y) < radius, 1e6, 0.0))
    assert found[64, 64] == pytest.approx(2.0 * 1e6 * radius / model.modulus, rel=5e-3)
