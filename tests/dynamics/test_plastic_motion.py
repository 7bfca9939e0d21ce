"""Impacts of rough bodies whose asperities yield, from a case to its result."""

import numpy as np
import pytest
from scipy.integrate import quad

import asperity
from asperity._jax import jax, jnp
from asperity.config import builtin, load_file
from asperity.config.resolve import resolve
from asperity.errors import InputError
from asperity.model import build
from asperity.results.read_record import read as read_record


@pytest.fixture(scope="module")
def case():
    """The example of yielding, faster and less wet, for a hundred impacts."""
    return load_file("examples/yielding-drop.toml").replace(
        {
            "capillary.contact_angle": "75 deg",
            "impact.speed": "60 mm/s",
            "numerics.max_impacts": 100,
            "numerics.tolerance": 1e-7,
        }
    )


@pytest.fixture(scope="module")
def solved(case):
    return asperity.solve(case, name="yielding", critical=False)


def lost_by_impact(result, mechanism):
    """Energy lost to a mechanism until each deepest and each highest point."""
    times, values = result.time, result.energies[f"lost_{mechanism}"]
    places = np.searchsorted(times, result.events["apex_time"]) - 1
    return values[places]


def test_the_first_impact_keeps_energy_and_later_ones_none(solved):
    kept = lost_by_impact(solved, "plastic")
    assert kept[0] > 0.05 * solved.ledger["initial"]
    assert np.abs(np.diff(kept)).max() < 1e-8 * kept[0]


def test_the_second_impact_loses_less_than_the_first(solved):
    first, second = solved.measures["restitution"][:2]
    assert first < 0.9 < second


def test_the_hundredth_impact_on_the_same_asperities_keeps_nothing_by_yield(solved):
    """Whatever the first one pressed flat; menisci take less and less from a body that slows."""
    impacts = {
        name: np.diff(lost_by_impact(solved, name), prepend=0.0) for name in solved.ledger["lost"]
    }
    assert set(impacts) == {"plastic", "capillary"}
    total = sum(impacts.values())
    assert total.size == 100
    assert total[1] < 0.1 * total[0]
    assert np.all(np.diff(total) < 0.0)
    assert abs(impacts["plastic"][99]) < 1e-9 * impacts["plastic"][0]


def test_the_ledger_of_a_hundred_impacts_closes(solved):
    assert solved.ledger["energy_balance_error"] < 1e-7


def test_the_run_says_how_many_yield_and_what_elastic_asperities_would_return(solved):
    text = "\n".join(solved.warnings)
    assert "% of the contacting asperities are beyond yield" in text
    assert "without yielding the first impact would have returned e = 0.9" in text
    assert "keeps them elastic" not in text


def test_a_record_holds_the_plastic_loss_and_comes_back(solved, tmp_path):
    solved.save(tmp_path)
    again = read_record(tmp_path / "record.nc")
    assert again.ledger["lost"]["plastic"] == solved.ledger["lost"]["plastic"]
    assert np.array_equal(again.energies["lost_plastic"], solved.energies["lost_plastic"])
    assert again.case == solved.case


def test_the_turn_of_the_first_impact_is_where_its_energy_is_spent(case, solved):
    """Work of the pressure on first approach by a quadrature of its own, against the speed."""
    problem = build(resolve(case))
    contact, body = problem.contact, problem.body
    force = jax.jit(lambda d: contact.state(d, contact.initial_memory()).force)
    deepest = float(solved.events["closest_approach_separation"][0])
    work, _ = quad(
        lambda d: float(force(jnp.asarray(d))), deepest, float(body.release), epsrel=1e-9,
        points=[deepest + k * 2e-9 for k in (0.5, 1.0, 2.0, 3.0)], limit=200,
    )  # fmt: skip
    gained = float(body.kinetic + body.weight * (body.release - deepest))
    assert work == pytest.approx(gained, rel=1e-7)


def test_asperities_that_yield_need_a_rigid_bulk(case):
    with pytest.raises(InputError, match="`deformation` must be 'rigid' where"):
        case.replace({"counterface.deformation": "half-space"})


def test_asperities_far_softer_than_stiff_meet_the_usual_tolerance(case):
    """A thousand times, as lead is."""
    soft = {"plasticity.hardness": "50 MPa", "numerics.max_impacts": 3, "numerics.tolerance": 1e-8}
    result = asperity.solve(case.replace(soft), critical=False)
    assert result.ledger["energy_balance_error"] < 1e-6
    assert result.ledger["lost"]["plastic"] > 0.9 * result.ledger["initial"]


def test_panels_are_cut_where_their_error_is():
    """Those on which flattened asperities spring back are too few for so small a tolerance."""
    base = []
    case = builtin("published-exact").replace(
        {
            "counterface.deformation": "rigid",
            "plasticity.model": "kogut-etsion",
            "plasticity.hardness": "30 MPa",
            "numerics.max_impacts": 1,
            "numerics.tolerance": 1e-10,
        }
    )
    result = asperity.solve(case, progress=lambda _, text: base.append(text), critical=False)
    assert result.ledger["energy_balance_error"] < 1e-9
    assert base.count("force curves") > 1
