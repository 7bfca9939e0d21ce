"""Cases side by side are the cases one by one: same ends, same measures, same reasons."""

from __future__ import annotations

import threading

import numpy as np
import pytest

from asperity.contact import ElasticContact
from asperity.errors import ENDS, InputError, Outcome, SimulationError
from asperity.integration.clock import Stopped
from asperity.integration.panel_cuts import Unsolved
from asperity.solver import solve
from asperity.sweeps.compute import batch
from asperity.sweeps.compute.batch import compute, evaluate
from asperity.sweeps.compute.building import built
from asperity.sweeps.compute.integrate_batch import BatchSolution
from asperity.sweeps.study.study import parse
from chosen import long_but

KEEP = """keep = ["captured", "impact_speed", "restitution", "rebound_height", "log_decrement",
 "rebound_period", "power_loss", "capture_time", "time_to_rest", "last_apex_time",
 "minimum_separation", "energy_lost", "lost_adhesion", "lost_capillary", "lost_gas",
 "lost_plastic", "lost_waves", "lost_viscous"]
keep_impacts = 3
"""
SINGLE = ("impact_speed", "capture_time", "time_to_rest")
EACH = ("restitution", "rebound_height", "log_decrement", "rebound_period", "power_loss")
ROUGH = """
[base]
body = {shape = "sphere", radius = "50 um", material = "silica"}
counterface = {material = "silicon carbide", deformation = "rigid"}
adhesion = {model = "dmt", work = "30 mJ/m^2", equilibrium_spacing = "0.2 nm"}
impact = {release_separation = "120 nm"}
numerics = {max_impacts = 12, rings = 24}
[base.roughness]
asperity_density = "1.69e16 1/m^2"
asperity_radius = "0.25 nm"
rms_height = "10.5 nm"
[base.capillary]
model = "equilibrium"
formation = "on-contact"
liquid = "water"
humidity = 0.6
temperature = "20 degC"
contact_angle = "73 deg"
"""
SMOOTH = """
[base]
body = {shape = "sphere", radius = "1 um", material = "silica"}
counterface = {material = "silicon carbide"}
adhesion = {model = "jkr", work = "30 mJ/m^2", equilibrium_spacing = "0.2 nm"}
impact = {speed = "0.5 m/s", gravity = "0 m/s^2"}
"""
STUDIES = {
    "published": 'base = "published"\n' + KEEP + """
[axes]
"roughness.rms_height" = {from = "9 nm", to = "12 nm", steps = 3}
"capillary.humidity" = {values = [0.996, 0.998, 1.0]}
""",
    "rough": KEEP + """
[axes]
"roughness.rms_height" = {from = "8 nm", to = "12 nm", steps = 3}
"capillary.humidity" = {values = [0.0, 0.3, 0.9]}
""" + ROUGH,
    "smooth": KEEP + """
[axes]
"adhesion.model" = {values = ["none", "jkr"]}
"impact.speed" = {from = "0.05 m/s", to = "2 m/s", steps = 4, scale = "log"}
""" + SMOOTH,
    "gas": KEEP + """
[axes]
"gas.pressure" = {from = "1 Pa", to = "1000 hPa", steps = 3, scale = "log"}
""" + ROUGH + """
[base.gas]
name = "air"
pressure = "1 Pa"
temperature = "20 degC"
""",
}  # fmt: skip


def studied(text):
    return parse("schema = 1\n" + text)


def said(columns):
    return [bytes(row).rstrip(b"\0").decode() for row in columns["reason"]]


def plain(values):
    return [np.nan if value is None else float(value) for value in values]


@pytest.mark.parametrize("name", long_but(STUDIES, "rough"))
def test_cases_side_by_side_are_the_cases_one_by_one(name):
    study = studied(STUDIES[name])
    columns, effort = compute(study, 0)
    assert effort.cases == study.size
    assert 0.0 < effort.batch_use <= 1.0
    for number in range(study.size):
        result = solve(study.case(number), critical=False)
        count = len(result.measures["restitution"])
        assert ENDS[columns["outcome"][number]] is result.outcome
        assert columns["impacts"][number] == count
        assert columns["energy_balance_error"][number] < 1e-6
        for key in SINGLE:
            expected = plain([result.measures[key]])[0]
            # In gas the largest speed is that at a point of the collocation.
            close = 1e-5 if name == "gas" else 1e-9
            assert columns[key][number] == pytest.approx(expected, rel=close, nan_ok=True), key
        for key in EACH:
            expected = (plain(result.measures[key]) + 3 * [np.nan])[:3]
            # A decrement and a power are differences of energies that are known to 1e-12.
            period = result.measures["rebound_period"][0]
            power = result.ledger["initial"] / (1.0 if period is None else period)
            floor = {"power_loss": 1e-11 * power, "log_decrement": 1e-11}.get(key, 0.0)
            close = {"rel": 1e-7, "abs": floor}
            assert columns[key][number].tolist() == pytest.approx(expected, nan_ok=True, **close)
        assert columns["captured"][number] == int(result.measures["captured"])
        lost = result.ledger["lost"]
        whole = sum(lost.values())
        assert columns["energy_lost"][number] == pytest.approx(whole, rel=1e-9)
        for mechanism in ("adhesion", "capillary", "gas", "plastic", "waves", "viscous"):
            found = columns[f"lost_{mechanism}"][number]
            if mechanism in lost:
                assert found == pytest.approx(lost[mechanism], rel=1e-9, abs=1e-12 * whole)
            else:
                assert np.isnan(found)
        assert columns["last_apex_time"][number] == pytest.approx(result.time[-1], rel=1e-9)
        if number in study.corners:
            warned = [line for at, line in effort.warned if at == number]
            assert warned == sorted(result.warnings)
    assert effort.looked == len(study.corners)


def refusal(study, number):
    try:
        solve(study.case(number), critical=False)
    except InputError as error:
        return error
    return None


def test_values_that_break_a_rule_fail_alone_and_say_why():
    axes = """
[axes]
"impact.release_separation" = {values = ["1 nm", "120 nm"]}
"capillary.contact_angle" = {values = ["30 deg", "60 deg", "70 deg", "95 deg"]}
"""
    study = studied(KEEP + axes + ROUGH)
    columns, _ = compute(study, 0)
    for number, reason in enumerate(said(columns)):
        outcome = ENDS[columns["outcome"][number]]
        error = refusal(study, number)
        if error is None:
            assert reason == ""
            assert outcome is not Outcome.FAILED
        else:
            assert outcome is Outcome.FAILED
            assert len(reason) >= 25
            assert str(error)[:25] == reason[:25]
            assert np.isnan(columns["restitution"][number]).all()
            assert columns["captured"][number] == -1


def test_a_case_has_the_same_columns_wherever_it_stands_in_its_lanes():
    """A value does not depend on the neighbours by more than rounding."""
    study = studied(STUDIES["rough"])
    values = study.values(0, study.size)
    whole = evaluate(study, values)
    some = evaluate(study, {key: array[[4, 2]] for key, array in values.items()})
    for name, array in whole.items():
        if array.dtype.kind == "f":
            np.testing.assert_allclose(some[name], array[[4, 2]], rtol=1e-9, err_msg=name)
        else:
            assert (some[name] == array[[4, 2]]).all(), name


def test_a_case_without_an_equilibrium_is_solved_by_itself(monkeypatch):
    """It may jump from one equilibrium to another; one that fails otherwise has failed."""
    failed = np.full(3, ENDS.index(Outcome.FAILED))
    reasons = {0: Unsolved("no equilibrium"), 2: SimulationError("too coarse")}

    def none(group, clock):
        assert type(group.batch.contact) is ElasticContact
        body = group.batch.body
        empty = np.zeros(3, int), np.zeros(3), np.zeros((3, 1)), {}, {}, np.zeros((3, 3))
        return BatchSolution(failed, *empty, dict(reasons), np.zeros(3), body)

    def alone(case, **_):
        assert case.capillary.humidity == 0.3
        raise SimulationError("solved by itself")

    monkeypatch.setattr(batch, "integrate_batch", none)
    monkeypatch.setattr(batch, "compile_ahead", lambda groups: None)
    monkeypatch.setattr(batch, "solve", alone)
    axis = "[axes]\n'capillary.humidity' = {values = [0.3, 0.5, 0.7]}\n"
    text = axis + ROUGH.replace('"rigid"', '"half-space"')
    columns, _ = compute(studied('keep = ["captured"]\n' + text), 0)
    assert said(columns) == ["solved by itself", "", "too coarse"]


def test_turning_points_are_kept_in_order_of_time():
    text = STUDIES["rough"].replace("keep_impacts", "motions = true\nkeep_impacts")
    study = studied(text)
    columns, _ = compute(study, 0)
    result = solve(study.case(1), critical=False)
    count = 2 * len(result.measures["restitution"])
    times = columns["turning_time"][1]
    assert (np.diff(times[:count]) > 0.0).all()
    assert np.isnan(times[count:]).all()
    apexes = columns["turning_separation"][1][1:count:2]
    assert apexes == pytest.approx(result.events["apex_separation"], rel=1e-7)
    assert times[count - 1] == pytest.approx(result.time[-1])


@pytest.mark.long
def test_cases_that_are_stepped_in_time_have_the_same_columns():
    text = KEEP.replace("keep_impacts", "motions = true\nkeep_impacts") + """
[axes]
"capillary.formation_time" = {from = "0.1 us", to = "10 us", steps = 2, scale = "log"}
"numerics.time_limit" = {values = ["0.35 ms", "1 s"]}
""" + ROUGH.replace("max_impacts = 12", "max_impacts = 3")  # fmt: skip
    study = studied(text)
    columns, effort = compute(study, 0)
    for number in range(study.size):
        result = solve(study.case(number), critical=False)
        warned = [line for at, line in effort.warned if at == number]
        assert number not in study.corners or warned == sorted(result.warnings)
        assert ENDS[columns["outcome"][number]] is result.outcome
        count = len(result.measures["restitution"])
        assert columns["impacts"][number] == count
        assert columns["restitution"][number].tolist() == pytest.approx(
            (plain(result.measures["restitution"]) + 3 * [np.nan])[:3], nan_ok=True
        )
        assert columns["lost_capillary"][number] == result.ledger["lost"]["capillary"]
        # That of the last apex, which a limit on the time may lie before.
        assert columns["last_apex_time"][number] == result.events["apex_time"][-1]
        times = columns["turning_time"][number][: 2 * count]
        apexes = columns["turning_separation"][number][1 : 2 * count : 2]
        heights = plain(result.measures["rebound_height"])
        assert (np.diff(times) > 0.0).all()
        assert np.isnan(columns["turning_time"][number][2 * count :]).all()
        # Heights count from the equilibrium, the same for all impacts.
        assert np.diff(apexes).tolist() == pytest.approx(np.diff(heights).tolist(), rel=1e-6)
        periods = plain(result.measures["rebound_period"])
        assert np.diff(times[1::2]).tolist() == pytest.approx(periods[1:], rel=1e-6)


def test_a_task_that_is_asked_to_stop_gives_nothing():
    stop = threading.Event()
    stop.set()
    study = studied(STUDIES["rough"])
    with pytest.raises(Stopped):
        compute(study, 0, stop)
    with pytest.raises(Stopped):
        evaluate(study, study.values(0, study.size), stop=stop)


@pytest.mark.parametrize("base", ["published-exact", "published"])
def test_every_number_of_a_case_is_built_for_many_cases_at_once(base):
    """Groups come without a case each: nothing fell back to one by one."""
    axes = {
        "body.radius": ("20 um", "60 um"),
        "roughness.asperity_density": ("1e16 1/m^2", "2e16 1/m^2"),
        "roughness.asperity_radius": ("0.2 nm", "0.3 nm"),
        "roughness.rms_height": ("9 nm", "12 nm"),
        "adhesion.work": ("20 mJ/m^2", "40 mJ/m^2"),
        "capillary.humidity": (0.6, 0.9),
        "capillary.contact_angle": ("60 deg", "75 deg"),
        "capillary.temperature": ("10 degC", "30 degC"),
        "impact.release_separation": ("60 nm", "90 nm"),
        "impact.gravity": ("1 m/s^2", "10 m/s^2"),
    }
    for key, ends in axes.items():
        low, high = (f'"{end}"' if isinstance(end, str) else end for end in ends)
        axis = f'"{key}" = {{from = {low}, to = {high}, steps = 5}}'
        study = studied(f'base = "{base}"\n[axes]\n{axis}')
        found = built(study, study.values(0, 5))
        assert (found.refused, found.alone) == ({}, []), key
        assert sum(group.rows.size for group in found.groups) == 5
        assert all(group.problems == () for group in found.groups), key
