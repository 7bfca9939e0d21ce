"""Every example loads, runs, closes its ledger and ends as its first lines say."""

import runpy
from pathlib import Path

import pytest

import asperity
from asperity.errors import Outcome
from records import never_goes_back

EXAMPLES = Path(__file__).parents[1] / "examples"
CASES = sorted(path.stem for path in EXAMPLES.glob("*.toml"))


@pytest.fixture(scope="module")
def solved():
    """Each example solved once; the built-in case for a few impacts only.

    In air the critical velocity is that of `test_critical_velocity.py`.
    """
    results = {}

    def solve(name):
        if name not in results:
            case = asperity.load(str(EXAMPLES / f"{name}.toml"))
            if name == "published-exact":
                case = case.replace({"numerics.max_impacts": 3})
            critical = name not in ("drop-in-air", "published-exact")
            results[name] = asperity.solve(case, name=name, critical=critical, beside=True)
        return results[name]

    return solve


@pytest.mark.parametrize("name", CASES)
def test_every_example_says_what_to_expect_closes_its_ledger_and_never_goes_back(solved, name):
    first = (EXAMPLES / f"{name}.toml").read_text(encoding="utf-8").splitlines()[0]
    assert first.startswith("# Expect")
    assert solved(name).ledger["energy_balance_error"] < 1e-6
    never_goes_back(solved(name))


@pytest.mark.parametrize("name", ["glass-bead", "published-exact"])
def test_example_of_a_built_in_case_is_that_case(name):
    assert asperity.load(str(EXAMPLES / f"{name}.toml")) == asperity.load(name)


SUBJECTS = {
    "drop-in-air": (
        "Knudsen number of the gas film",
        "pressure in the gas film",
    ),
    "yielding-drop": ("beyond yield", "without yielding"),
}
"""What an example warns of because that is what it is about, or by what it is about."""


@pytest.mark.parametrize("name", [name for name in CASES if name != "published-exact"])
def test_examples_warn_of_nothing_but_their_subject(solved, name):
    told = solved(name).warnings
    assert [line for line in told if not any(s in line for s in SUBJECTS.get(name, ()))] == []


def test_dry_drop_is_the_wet_drop_without_menisci():
    wet = asperity.load(str(EXAMPLES / "wet-drop.toml"))
    assert asperity.load(str(EXAMPLES / "dry-drop.toml")) == wet.replace({"capillary": None})


def test_built_in_case_loses_little_at_each_impact(solved):
    result = solved("published-exact")
    assert result.outcome is Outcome.MAX_IMPACTS
    assert result.measures["restitution"] == pytest.approx([0.999958] * 3, abs=1e-6)


def test_wet_drop_leaves_its_first_impact_and_is_captured_by_menisci_later(solved):
    result = solved("wet-drop")
    measures = result.measures
    assert result.outcome is Outcome.REST
    assert not measures["captured"]
    assert measures["restitution"][-1] == 0.0
    assert measures["capture_time"] is not None
    assert measures["critical_velocity"] == pytest.approx(1.31e-3, rel=0.01)
    assert len(measures["restitution"]) == 6
    assert measures["restitution"][0] == pytest.approx(0.811883, abs=1e-5)
    assert measures["time_to_rest"] == pytest.approx(3.641e-3, rel=1e-3)
    assert set(result.ledger["lost"]) == {"capillary"}


def test_a_switch_sticks_at_its_third_touch(solved):
    result = solved("switch")
    assert result.outcome is Outcome.REST
    assert result.measures["restitution"][:3] == pytest.approx([0.8044, 0.4835, 0.0], abs=1e-4)
    assert not result.measures["captured"]
    lost = result.ledger["lost"]
    assert lost["damping"] == pytest.approx(0.8966 * result.ledger["initial"], rel=1e-3)
    stiff = result.case.replace({"suspension.stiffness": "2 N/m"})
    assert asperity.solve(stiff, critical=False).measures["capture_time"] is None


def test_glass_bead_is_captured_by_menisci_at_its_sixth_touch(solved):
    result = solved("glass-bead")
    measures = result.measures
    assert not measures["captured"]
    assert measures["critical_velocity"] == pytest.approx(1.136e-3, rel=1e-2)
    assert measures["restitution"][0] == pytest.approx(0.8222, abs=1e-3)
    assert measures["restitution"][-1] == 0.0
    assert len(measures["restitution"]) == 6
    assert measures["capture_time"] == pytest.approx(2.60e-3, rel=1e-2)


def test_air_takes_most_of_the_drop_in_air(solved):
    result = solved("drop-in-air")
    assert result.outcome is Outcome.REST
    assert result.measures["restitution"][0] == pytest.approx(0.7685, abs=1e-4)
    assert result.measures["time_to_rest"] == pytest.approx(0.738e-3, rel=1e-3)
    lost = result.ledger["lost"]
    assert lost["gas"] == pytest.approx(0.639 * sum(lost.values()), rel=1e-3)


def test_water_in_every_gap_takes_more_energy_than_menisci_at_summits(solved):
    result = solved("wet-surface")
    assert result.measures["restitution"][0] == pytest.approx(0.80687, abs=1e-5)
    summits = {"capillary.model": "equilibrium", "capillary.surface_rms_height": None}
    alone = asperity.solve(
        result.case.replace({**summits, "numerics.max_impacts": 1}), critical=False
    )
    assert alone.measures["restitution"][0] == pytest.approx(0.96117, abs=1e-5)


def test_sphere_is_held_by_measured_summits(solved):
    result = solved("measured-surface")
    measures = result.measures
    assert result.outcome is Outcome.REST
    assert not measures["captured"]
    assert measures["restitution"][-1] == 0.0
    assert measures["capture_time"] is not None
    assert len(measures["rebound_height"]) == 9
    assert measures["restitution"][0] == pytest.approx(0.86731, abs=1e-4)
    assert measures["time_to_rest"] == pytest.approx(4.686e-3, rel=1e-3)
    assert result.surface["summits"] == 243


def test_asperities_yield_at_the_first_impact_and_never_again(solved):
    result = solved("yielding-drop")
    assert result.outcome is Outcome.MAX_IMPACTS
    first, *later = result.measures["restitution"]
    assert first == pytest.approx(0.8718, abs=1e-3)
    assert later == pytest.approx([0.9201, 0.9136, 0.9059, 0.8965], abs=5e-4)
    lost = result.ledger["lost"]["plastic"]
    assert lost == pytest.approx(0.113 * result.ledger["initial"], rel=1e-2)
    once = asperity.solve(result.case.replace({"numerics.max_impacts": 1}), critical=False)
    assert lost == pytest.approx(once.ledger["lost"]["plastic"], rel=1e-12)


def test_dry_drop_loses_nothing(solved):
    result = solved("dry-drop")
    assert result.outcome is Outcome.OSCILLATING
    assert not result.measures["captured"]
    assert result.measures["restitution"][0] == pytest.approx(1.0, abs=1e-8)


def test_fast_impact_deforms_the_bulk_and_escapes(solved):
    result = solved("fast-impact")
    assert result.outcome is Outcome.ESCAPED
    assert result.measures["restitution"][0] == pytest.approx(0.8928, abs=1e-4)
    indentation = result.central_separation - result.separation
    assert indentation.max() == pytest.approx(1.125e-9, rel=1e-2)


def test_jkr_sphere_bounces_above_the_critical_velocity_with_the_closed_form(solved):
    result = solved("jkr-bounce")
    assert result.outcome is Outcome.ESCAPED
    critical = result.measures["critical_velocity"]
    assert critical == pytest.approx(0.08455, rel=1e-4)
    expected = (1.0 - (critical / result.case.impact.speed) ** 2) ** 0.5
    assert result.measures["restitution"] == [pytest.approx(expected, abs=1e-5)]


def test_first_impact_captures_a_jkr_sphere_below_the_critical_velocity(solved):
    result = solved("jkr-stick")
    assert result.case.impact.speed < result.measures["critical_velocity"]
    assert result.outcome is Outcome.OSCILLATING
    assert result.measures["captured"]
    assert result.measures["restitution"][0] == 0.0


def test_own_law_is_checked_and_takes_energy_from_the_bounce():
    own = runpy.run_path(str(EXAMPLES / "own_law.py"))
    measures = own["main"]()
    assert [float(e) for e in measures.restitution[:2]] == pytest.approx(
        [0.95139, 0.94825], abs=1e-5
    )


def test_own_law_takes_at_most_twenty_lines():
    text = (EXAMPLES / "own_law.py").read_text(encoding="utf-8")
    body = text.split("# The law, from here")[1].split("# to here.")[0]
    assert len([line for line in body.splitlines() if line.strip()]) <= 20
