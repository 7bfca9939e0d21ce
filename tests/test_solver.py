"""From a case to a result: regimes, rest, ledger, refusals and early ends."""

import dataclasses
import json
import threading
from pathlib import Path

import numpy as np
import pytest

import asperity
from asperity import InputError, Outcome, SimulationError, integration, solver
from asperity.config.resolve import resolve
from asperity.integration import finer_scanning
from records import never_goes_back

EXAMPLES = Path(__file__).parents[1] / "examples"

CHANGES = {"counterface.deformation": "rigid", "numerics.max_impacts": 5}


@pytest.fixture(scope="module")
def case():
    return asperity.load("published-exact").replace(CHANGES)


@pytest.fixture(scope="module")
def result(case):
    return solver.solve(case, name="published")


def test_regime_numbers_of_the_publication(result):
    assert result.regime["tabor_number"] == pytest.approx(0.0206, abs=5e-5)
    assert result.regime["elasticity_parameter"] == pytest.approx(0.0239, abs=5e-5)
    assert result.regime["plasticity_index"] == pytest.approx(41.0, abs=0.2)
    assert result.regime["adhesion_law"] == "dmt"
    assert result.regime["load_parameter"] > 1e3


def test_outcome_is_the_limit_that_was_met(result):
    assert result.outcome is Outcome.MAX_IMPACTS
    assert len(result.measures["rebound_height"]) == 5
    assert result.measures["captured"] is False
    assert result.measures["time_to_rest"] is None


def test_ledger_closes(result):
    assert result.ledger["energy_balance_error"] < 1e-6
    assert set(result.ledger["lost"]) == {"capillary"}
    assert result.ledger["lost"]["capillary"] > 0.0


def test_forces_of_the_whole_motion_add_up(result):
    forces = result.forces
    contact = sum(forces[name] for name in ("elastic", "adhesion", "capillary"))
    scale = np.max(np.abs(forces["elastic"]))
    np.testing.assert_allclose(contact, forces["contact"], atol=1e-9 * scale)
    np.testing.assert_allclose(forces["contact"] + forces["weight"], forces["total"], atol=1e-18)


def test_a_rigid_body_has_the_same_separation_everywhere(result):
    np.testing.assert_allclose(result.central_separation, result.separation, rtol=1e-7)


def test_measures_are_plain_json(result):
    for part in (result.measures, result.regime, result.ledger, result.warnings):
        assert json.loads(json.dumps(part, allow_nan=False)) == part


def test_there_is_an_event_for_each_impact(result):
    assert result.events["closest_approach_time"].shape == (5,)
    never_goes_back(result)


def test_release_inside_contact_is_refused_with_the_separation_at_rest(case):
    inside = case.replace({"impact.release_separation": "40 nm"})
    with pytest.raises(InputError, match=r"at rest the separation is 45\.\d+ nm") as refused:
        solver.solve(inside)
    assert refused.value.key == "impact.release_separation"


def test_a_stop_set_before_the_first_impact_leaves_nothing(case):
    stop = threading.Event()
    stop.set()
    with pytest.raises(SimulationError, match="stopped"):
        solver.solve(case, stop=stop)


def test_a_stop_set_on_the_way_keeps_what_was_computed(case):
    stop = threading.Event()
    longer = case.replace({"numerics.max_impacts": 250, "numerics.rest_height_ratio": 1e-12})

    def report(fraction, text):
        if text.startswith("impact"):
            stop.set()

    found = solver.solve(longer, progress=report, stop=stop, critical=False)
    assert found.outcome is Outcome.INTERRUPTED
    assert 0 < len(found.measures["rebound_height"]) < 250
    assert found.ledger["energy_balance_error"] < 1e-6


def test_progress_rises_to_one(case):
    seen = []
    solver.solve(case, progress=lambda fraction, text: seen.append(fraction))
    assert seen == sorted(seen)
    assert seen[-1] == 1.0


def test_a_motion_that_fails_raises_with_what_was_computed_or_returns_it(case, monkeypatch):
    """The failure is put in: the flight itself has no case that fails."""

    def failing(*args):
        return integration.integrate(*args)._replace(outcome=Outcome.FAILED)

    monkeypatch.setattr(solver, "integrate", failing)
    kept = solver.solve(case, throw=False, critical=False)
    assert kept.outcome is Outcome.FAILED
    with pytest.raises(SimulationError) as raised:
        solver.solve(case, critical=False)
    assert raised.value.partial.outcome is Outcome.FAILED


def test_curve_loses_what_the_first_impact_loses(case, result):
    drawn = solver.curve(case)
    assert drawn.minimum_separation == pytest.approx(
        result.events["closest_approach_separation"][0], rel=1e-9
    )
    energy = result.measures["power_loss"][0] * result.measures["rebound_period"][0]
    assert drawn.loss == pytest.approx(energy, rel=1e-4)
    assert drawn.pull_off >= 0.0
    gap = drawn.force_loading - drawn.force_unloading
    area = np.sum(0.5 * (gap[1:] + gap[:-1]) * np.diff(drawn.rigid_separation))
    assert area == pytest.approx(drawn.loss, rel=0.02)


def test_a_ledger_that_does_not_close_is_said(case, monkeypatch):
    """Menisci that stretch over many rms heights, with too few solutions on the way."""
    wide = case.replace({"capillary.humidity": 0.97, "counterface.deformation": "rigid"})
    wide = wide.replace({"impact.release_separation": "400 nm", "numerics.max_impacts": 3})
    closed = solver.solve(wide, critical=False)
    assert closed.ledger["energy_balance_error"] < 1e-6
    assert not any("ledger" in line for line in closed.warnings)
    problem = solver.build(resolve(wide))
    coarse = dataclasses.replace(
        problem.contact, resolved=problem.contact.resolved._replace(nodes=3, pieces=1)
    )
    monkeypatch.setattr(solver, "build", lambda case: problem._replace(contact=coarse))
    again = solver.solve(wide, critical=False)  # with finer scanning curves
    assert again.ledger["energy_balance_error"] < 1e-6
    monkeypatch.setattr(finer_scanning, "with_finer_scanning", lambda problem, motion: None)
    open_ = solver.solve(wide, critical=False)
    assert open_.ledger["energy_balance_error"] > 1e-6
    assert any("ledger" in line for line in open_.warnings)


@pytest.mark.parametrize("speed", ["0.1 m/s", "2 m/s"])
def test_a_rebound_of_many_millimetres_is_resolved_within_nanometres(speed):
    """A smooth JKR sphere of 1 um under gravity, whose bond ends within 3 nm."""
    bounce = asperity.load(str(EXAMPLES / "jkr-bounce.toml"))
    falls = {"body.radius": "1 um", "impact.gravity": "9.81 m/s^2"}
    thrown = bounce.replace({**falls, "impact.speed": speed})
    found = solver.solve(thrown, critical=False)
    assert found.outcome in (Outcome.REST, Outcome.OSCILLATING)
    assert found.ledger["energy_balance_error"] < 1e-10


def test_every_drawn_sample_conserves_energy():
    """Bridges of nanometres on a sphere that rebounds by micrometres: panels narrower than
    the rounding of the way to them.
    """
    bounce = asperity.load(str(EXAMPLES / "jkr-bounce.toml"))
    wet = bounce.replace(
        {
            "capillary.model": "equilibrium",
            "capillary.liquid": "water",
            "capillary.humidity": 0.6,
            "capillary.temperature": "20 degC",
            "capillary.contact_angle": "40 deg",
        }
    )
    found = solver.solve(wet, critical=False)
    total = sum(found.energies.values())
    assert np.ptp(total) < 1e-7 * np.max(found.energies["kinetic"])
