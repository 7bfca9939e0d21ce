"""A case of a body on a spring: what is refused, what it answers, a study of it, its record."""

from __future__ import annotations

import numpy as np
import pytest

import asperity
import jkr_spheres
from asperity.config.case_file import load
from asperity.errors import Outcome
from asperity.results.verdict import verdict
from asperity.sweeps.compute.batch import compute
from asperity.sweeps.study.study import parse
from refused_input import refusal

SWITCH = (
    jkr_spheres.SPRUNG.replace('speed = "2 m/s"', 'gravity = "9.81 m/s^2"')
    + """damping = "1 nN s/m"
[numerics]
max_impacts = 5
"""
)


CREEPS = {"model": "standard-linear-solid", "relaxed_modulus_ratio": 0.5, "relaxation_time": "1 s"}
LATE = {"model": "equilibrium", "liquid": "water", "humidity": 0.6, "temperature": "20 degC",
        "contact_angle": "30 deg", "formation_time": "1 us"}  # fmt: skip


@pytest.mark.parametrize(
    ("changes", "key", "says"),
    [
        ({"suspension.stiffness": "0 N/m"}, "suspension.stiffness", "must be positive"),
        ({"suspension.stiffness": "2 GN/m"}, "suspension.stiffness", "must lie in [1e-09, 1e+09]"),
        ({"suspension.stiffness": "1 N"}, "suspension.stiffness", "a force per length"),
        ({"suspension.stiffness": None}, "suspension.stiffness", "is missing"),
        ({"suspension.stifness": "1 N/m"}, "suspension.stifness", "did you mean 'stiffness'"),
        ({"suspension.damping": "-1 N s/m"}, "suspension.damping", "must not be negative"),
        ({"suspension.rest_gap": "2 m"}, "suspension.rest_gap", "must lie in [-1, 1] m"),
        ({"suspension.rest_gap": None}, "suspension.rest_gap", "is missing"),
        (
            {"impact": {"speed": "1 m/s"}},
            "impact.release_separation",
            "since the spring's force depends on it",
        ),
        (
            {"impact.release_separation": "50 nm", "impact.gravity": "0 m/s^2"},
            "impact.release_separation",
            "must differ from 50 nm where there is no `speed`",
        ),
        ({"viscoelasticity": CREEPS, "adhesion": None}, "suspension", "knows no spring"),
        ({"capillary": LATE}, "capillary.formation_time", "must be absent with [suspension]"),
    ],
)
def test_what_a_suspension_cannot_be_is_refused_with_its_key(changes, key, says):
    error = refusal(load(SWITCH).replace, changes)
    assert says in str(error)
    assert error.key == key


def test_the_publication_has_no_spring():
    spring = {"suspension.stiffness": "1 N/m", "suspension.rest_gap": "0 nm"}
    assert "its body is free" in str(refusal(asperity.load("published").replace, spring))


def test_a_spring_alone_may_set_a_body_in_motion():
    """Without gravity and without a speed: only beside a spring."""
    resting = {"impact.gravity": "0 m/s^2"}
    assert load(SWITCH).replace(resting).suspension is not None
    fixed = refusal(load(SWITCH).replace, {**resting, "suspension": None})
    assert "the body would never fall" in str(fixed)


@pytest.fixture(scope="module")
def switch():
    return asperity.solve(load(SWITCH), critical=False)


def test_a_switch_bounces_and_says_what_its_dashpot_took(switch):
    lost = switch.ledger["lost"]
    assert switch.outcome is Outcome.MAX_IMPACTS
    assert set(lost) == {"adhesion", "damping"}
    assert switch.ledger["energy_balance_error"] < 1e-10
    total = sum(switch.forces[name] for name in ("contact", "weight", "spring", "damping"))
    np.testing.assert_allclose(total, switch.forces["total"], rtol=1e-12, atol=1e-18)
    np.testing.assert_allclose(
        switch.forces["spring"], -1.0 * (switch.separation - 50e-9), rtol=1e-12, atol=1e-18
    )
    whole = sum(switch.energies[name] for name in ("kinetic", "potential", "stored"))
    whole = whole + sum(np.asarray(switch.energies[f"lost_{name}"]) for name in lost)
    np.testing.assert_allclose(whole, switch.ledger["initial"], rtol=1e-9)


def test_a_record_reads_back(switch, tmp_path):
    switch.save(tmp_path / "out")
    again = asperity.read(tmp_path / "out" / "record.nc")
    assert again.case == switch.case
    np.testing.assert_array_equal(again.forces["spring"], switch.forces["spring"])


@pytest.mark.long
def test_a_study_of_springs_has_the_numbers_of_its_cases(switch):
    study = parse(
        "schema = 1\n"
        'keep = ["captured", "restitution", "lost_damping", "lost_adhesion", "energy_lost"]\n'
        '[axes]\n"suspension.stiffness" = {values = ["1 N/m", "1.1 N/m"]}\n'
        + SWITCH.replace("schema = 1\n", "").replace("[", "[base.")
    )
    columns, _ = compute(study, 0)
    for name in ("damping", "adhesion"):
        assert columns[f"lost_{name}"][0] == pytest.approx(switch.ledger["lost"][name], rel=1e-9)
    assert columns["lost_damping"][1] > 1.01 * columns["lost_damping"][0]
    assert columns["energy_balance_error"].max() < 1e-10


def test_a_spring_does_not_change_what_a_jkr_cycle_loses():
    """Undamped: the critical velocity, at the end of contact, is that of the free sphere."""
    held = {
        "impact.release_separation": "5 nm",
        "suspension.stiffness": "100 N/m",
        "suspension.rest_gap": "3 nm",
    }
    measures = asperity.solve(jkr_spheres.smooth("jkr", "2 m/s").replace(held)).measures
    assert measures["critical_velocity"] == pytest.approx(jkr_spheres.CRITICAL, rel=1e-8)
    lost = (jkr_spheres.CRITICAL / measures["impact_speed"]) ** 2
    assert measures["restitution"][0] == pytest.approx(np.sqrt(1.0 - lost), rel=1e-8)


def test_a_body_that_never_touches_has_no_restitution_and_says_that_it_swings():
    free = asperity.solve(
        load(SWITCH).replace({"impact.release_separation": "90 nm"}), critical=False
    )
    assert free.measures["impact_speed"] is None
    assert free.measures["restitution"] == [None] * 5
    assert not free.measures["captured"]
    assert verdict(free).startswith("never touches, and still swings on its spring")


def test_a_study_tells_of_a_body_that_never_touches_what_its_case_tells():
    study = parse(
        'schema = 1\nkeep = ["captured"]\n'
        '[axes]\n"impact.release_separation" = {values = ["90 nm", "91 nm"]}\n'
        + SWITCH.replace("schema = 1\n", "").replace("[", "[base.")
    )
    _, effort = compute(study, 0)
    alone = asperity.solve(study.case(0), critical=False, beside=False)
    assert [line for number, line in effort.warned if number == 0] == sorted(alone.warnings)
    assert not any("released within the end of contact" in line for line in alone.warnings)
