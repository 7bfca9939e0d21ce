"""The critical velocity: below it the first impact captures."""

from types import SimpleNamespace

import numpy as np
import pytest

import asperity
from asperity.config import load_file
from asperity.config.resolve import resolve
from asperity.critical_velocity import Launcher, critical_measures, sought
from asperity.dynamics import Limits
from asperity.dynamics.capture_edges import FirstImpacts, capture_edges
from asperity.errors import InputError, Outcome
from asperity.integration import integrate
from asperity.integration.batch_motion import BatchMotion
from asperity.model import build
from jkr_spheres import CRITICAL, MODULUS, RADIUS, W, smooth


@pytest.mark.parametrize("speed", ["0.1 m/s", "0.6 m/s", "5 m/s"])
def test_a_jkr_sphere_is_captured_below_what_its_cycle_loses(speed):
    measures = asperity.solve(smooth("jkr", speed)).measures
    closed = 1.84018 * (W**5 / (RADIUS**5 * 2500.0**3 * MODULUS**2)) ** (1.0 / 6.0)
    assert pytest.approx(closed, rel=3e-6) == CRITICAL
    assert measures["critical_velocity"] == pytest.approx(CRITICAL, rel=1e-8)
    assert measures["capture_edges"] == [measures["critical_velocity"]]
    assert measures["critical_velocity_note"] is None
    assert measures["captured"] == (float(speed.split()[0]) < CRITICAL)


def test_the_speed_of_approach_is_the_launch_and_attraction_makes_a_larger_one():
    measures = asperity.solve(smooth("jkr", "0.7 m/s")).measures
    assert measures["impact_speed"] == pytest.approx(0.7, rel=1e-12)
    assert measures["maximum_speed"] == pytest.approx(1.284 * 0.7, rel=0.03)


def test_without_a_loss_every_speed_rebounds_and_that_is_said():
    measures = asperity.solve(smooth("dmt")).measures
    assert measures["critical_velocity"] is None
    assert measures["capture_edges"] == []
    assert measures["critical_velocity_note"] == "every speed rebounds: nothing takes energy"


def test_speeds_that_could_not_be_computed_are_counted():
    speeds = np.geomspace(1e-2, 10.0, 16)

    def launch(_: np.ndarray, launched: np.ndarray) -> FirstImpacts:
        known = np.where(launched > 1.0, np.nan, launched)
        return FirstImpacts(known, np.zeros(launched.size, bool), np.ones(launched.size))

    (edges,) = capture_edges(launch, np.array([1.0]), np.array([1.0]))
    assert edges.unknown == np.sum(speeds > 1.0)
    note = critical_measures(edges)["critical_velocity_note"]
    assert note.startswith("every speed tried rebounds, 10 mm/s to")
    assert note.endswith(f"; at {edges.unknown} others no first impact could be computed")


def test_an_edge_among_speeds_that_fail_is_not_placed_beside_it():
    def launch(_: np.ndarray, launched: np.ndarray) -> FirstImpacts:
        known = np.where((launched > 0.3) & (launched < 0.9), np.nan, launched)
        return FirstImpacts(known, launched < 0.5, launched**2 - 0.25)

    (edges,) = capture_edges(launch, np.array([1.0]), np.array([1.0]))
    assert (edges.speeds, edges.lost, edges.lowest) == ((), 1, True)
    assert edges.critical is None
    assert "an edge of capture lies" in critical_measures(edges)["critical_velocity_note"]
    # Nor is a higher edge the critical velocity where the lowest is lost.
    assert edges._replace(speeds=(2.0, 3.0)).critical is None
    assert edges._replace(speeds=(2.0, 3.0), lost=0).critical == 2.0


def test_restitution_follows_the_critical_velocity_of_jkr():
    curve = asperity.restitution_curve(smooth("jkr"), points=12)
    expected = np.sqrt(np.maximum(1.0 - (CRITICAL / curve.speed) ** 2, 0.0))
    np.testing.assert_allclose(curve.restitution, expected, atol=1e-7)
    np.testing.assert_array_equal(curve.captured, curve.speed < CRITICAL)
    assert curve.critical_velocity == pytest.approx(CRITICAL, rel=1e-8)
    assert curve.speed[0] == pytest.approx(0.1 * CRITICAL)
    assert "critical velocity" in curve.summary()


def test_a_rough_wet_body_just_above_its_critical_velocity_leaves_and_just_below_does_not():
    case = load_file("examples/wet-drop.toml")
    critical = asperity.solve(case).measures["critical_velocity"]
    curve = asperity.restitution_curve(case, critical * np.array([0.9, 0.95, 1.02, 1.1]))
    assert curve.captured.tolist() == [True, True, False, False]
    assert curve.critical_velocity == pytest.approx(critical, rel=1e-6)
    assert 0.0 < curve.restitution[2] < curve.restitution[3]


def test_curves_of_a_fast_launch_serve_slower_ones(monkeypatch):
    """Down to a quarter of its speed, with the impacts that curves of their own give."""
    case = load_file("examples/wet-drop.toml")
    problem = build(resolve(case))
    solution = integrate(problem)
    made, prepared = [], BatchMotion.curves

    def counted(self):
        made.append(1)
        return prepared(self)

    monkeypatch.setattr(BatchMotion, "curves", counted)
    limits = Limits.of(problem.inputs.tolerance)
    speeds = np.array([0.3, 0.5, 1.0]) * 0.05
    shared = Launcher(problem, solution, limits)
    served = shared.together(np.zeros(3, int), speeds)
    assert len(made) == 1
    for k, speed in enumerate(speeds):
        alone = Launcher(problem, solution, limits)(float(speed))
        assert alone.speed == pytest.approx(served.speed[k], rel=1e-9)
        assert alone.captured == served.captured[k]
        assert alone.excess == pytest.approx(served.excess[k], rel=1e-6)
    assert len(made) == 4
    shared(float(0.2 * speeds[-1]))
    assert len(made) == 5


def model(captured, excess):
    """First impacts whose energy left is a function of their speed, of one body of 2 kg."""

    def launch(cases, speeds):
        return FirstImpacts.of(speeds, captured(speeds), excess(speeds), 2.0)

    return launch


def test_several_intervals_of_capture_give_all_edges():
    """Energy left, v^2 less what is lost, changes sign at 1, 3 and 10."""

    def left(v):
        return (v - 1.0) * (v - 3.0) * (v - 10.0)

    known = model(lambda v: left(v) < 0.0, left)
    unknown = model(lambda v: left(v) < 0.0, lambda v: np.full(v.shape, np.nan))
    for launch in (known, unknown):
        (edges,) = capture_edges(launch, np.array([0.5]), np.array([2.0]))
        assert edges.speeds == pytest.approx((1.0, 3.0, 10.0), rel=1e-10)
        assert edges.lowest


def test_speeds_that_cannot_be_computed_are_passed_over():
    def launch(cases, speeds):
        found = FirstImpacts.of(speeds, speeds < 1.0, speeds**2 - 1.0, 2.0)
        return found._replace(speed=np.where(speeds > 3.0, np.nan, found.speed))

    (edges,) = capture_edges(launch, np.array([0.5]), np.array([2.0]))
    assert edges.speeds == pytest.approx((1.0,), rel=1e-10)
    assert edges.tried[1] <= 3.0
    nothing = model(lambda v: v < 0.0, lambda v: v)
    (edges,) = capture_edges(nothing, np.array([0.5]), np.array([2.0]))
    assert (edges.speeds, edges.lowest) == ((), False)


@pytest.mark.parametrize("speeds", [[], [0.0, 1.0], [-1.0], [float("nan")], [float("inf")]])
def test_speeds_that_are_none_are_refused(speeds):
    with pytest.raises(InputError, match="`speeds` must be positive and finite"):
        asperity.restitution_curve(smooth("jkr"), np.array(speeds))


DRAGGED = {
    "gas": ("examples/drop-in-air.toml", {}),
    "waves": ("examples/jkr-stick.toml", {"waves": {"model": "hunter"}}),
}


def test_it_is_not_sought_where_each_impact_takes_seconds():
    contact = SimpleNamespace(sides=2, mechanisms=("adhesion",))
    solution = SimpleNamespace(outcome=Outcome.ESCAPED, contact=contact, trajectory=None)
    found = sought(solution, None, None, None)
    assert found["critical_velocity"] is None
    assert found["critical_velocity_note"].startswith("not sought: each impact on a half-space")


@pytest.mark.parametrize("drag", DRAGGED)
def test_with_drag_too_few_first_impacts_find_the_edge(monkeypatch, drag):
    """A root of the margin of the apex, or of the energy left; bisection would take forty."""
    file, change = DRAGGED[drag]
    tried, launch = [], Launcher.__call__

    def counted(self, speed):
        tried.append((self, speed, launch(self, speed)))
        return tried[-1][-1]

    monkeypatch.setattr(Launcher, "__call__", counted)
    problem = build(resolve(load_file(file).replace({**change, "numerics.max_impacts": 1})))
    limits = Limits.of(problem.inputs.tolerance)
    critical = sought(integrate(problem), problem, limits, None)["critical_velocity"]
    assert len(tried) <= 30
    launcher, speed, last = tried[-1]
    assert last.speed == pytest.approx(critical, rel=1e-10)
    assert launch(launcher, speed * (1.0 - 1e-8)).captured
    assert not launch(launcher, speed * (1.0 + 1e-8)).captured
