"""Menisci that take time on the rings of a half-space: limits, the rigid body, the ledger."""

import dataclasses

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import asperity
from asperity import Outcome
from asperity.config.resolve import resolve
from asperity.contact.delayed_formation import DelayedContact
from asperity.dynamics.viscoelastic.ring_menisci import FreeFlight
from asperity.integration import integrate, silently
from asperity.model import build

TURNS = ("closest_approach", "apex", "closest_approach_time", "apex_time")


@pytest.fixture(scope="module")
def case():
    return asperity.load("published-exact").replace(
        {"numerics.rings": 48, "numerics.max_impacts": 2, "capillary.formation_time": "10 us"}
    )


def impacts(case):
    return integrate(build(resolve(case)), silently, None).motion.impacts


def lost(case):
    """On menisci, in the first impact [J]."""
    return float(impacts(case).lost[0, 0])


@pytest.mark.long
def test_short_formation_tends_to_formation_at_once_in_proportion_to_the_time(case):
    at_once = lost(case.replace({"capillary.formation_time": None}))
    more = [
        lost(case.replace({"capillary.formation_time": t})) - at_once for t in ("10 ns", "2 ns")
    ]
    assert more[0] == pytest.approx(5.0 * more[1], rel=0.02)
    assert 0.0 < more[0] < 0.02 * at_once


def test_long_formation_tends_to_the_dry_motion(case):
    """From where no asperity is wet at the release."""
    case = case.replace({"impact.release_separation": "100 nm"})
    dry = impacts(case.replace({"capillary.model": "none"}))
    delayed = impacts(case.replace({"capillary.formation_time": "1000 s"}))
    for turn in TURNS:
        found, wanted = float(getattr(delayed, turn)[0]), float(getattr(dry, turn)[0])
        assert found == pytest.approx(wanted, rel=5e-8)
    assert 0.0 < float(delayed.lost[0, 0]) < 1e-8 * lost(case)


@pytest.mark.parametrize("time", ["300 ns", "10 us"])
def test_a_stiff_half_space_is_the_rigid_body(case, time):
    """Another method, of order 15: one threshold for all places, polynomials in time."""
    here = case.replace({"capillary.formation_time": time})
    problem = build(resolve(here))
    hard = dataclasses.replace(problem.contact, modulus=1e7 * problem.contact.modulus)
    delayed = DelayedContact(hard, problem.delayed.time)
    problem = problem._replace(contact=hard, delayed=delayed)
    found = integrate(problem, silently, None).motion.impacts
    wanted = impacts(here.replace({"counterface.deformation": "rigid"}))
    for turn in TURNS:
        np.testing.assert_allclose(getattr(found, turn), getattr(wanted, turn), rtol=1e-7)
    np.testing.assert_allclose(found.lost, wanted.lost, rtol=1e-5)


@pytest.mark.parametrize(
    "changes",
    [
        {},
        {
            "numerics.rings": 24,
            "capillary.model": "kelvin-filling",
            "capillary.surface_rms_height": "11 nm",
            "impact.release_separation": "200 nm",
        },
        pytest.param(
            {
                "adhesion.model": "jkr",
                "adhesion.work": "50 mJ/m^2",
                "roughness.asperity_radius": "200 nm",
                "impact.release_separation": "120 nm",
            },
            marks=pytest.mark.long,
        ),
    ],
    ids=["wet", "filling", "beside JKR"],
)
def test_the_ledger_closes(case, changes):
    result = asperity.solve(
        case.replace({**changes, "capillary.formation_time": "2 us"}), critical=False
    )
    assert result.ledger["energy_balance_error"] < 2e-7
    assert result.outcome is Outcome.MAX_IMPACTS
    assert all(value > 0.0 for value in result.ledger["lost"].values())


@pytest.mark.parametrize("pace", [1e-3, 0.3, 3.0, 300.0])
@pytest.mark.parametrize(("speed", "span"), [(-0.5, 1.2), (1.5, 1.2), (0.0, 2.0), (-1.0, 0.0)])
def test_thresholds_in_flight_are_those_of_an_integration(pace, speed, span):
    """Falling, and rising until they are met; from beside, above and below where they lag."""
    begun, gravity = np.array([0.4, 1.0, 1.3, 2.0]), 1.0
    flight = FreeFlight(np.ones(4), speed, gravity)

    def rate(t, b):
        goal = 1.0 + speed * t - 0.5 * gravity * t**2
        return pace * np.minimum(goal - b, 0.0)

    found = flight.follow(begun, span, pace)
    if span == 0.0:
        np.testing.assert_array_equal(found, begun)
        return
    judge = solve_ivp(rate, (0.0, span), begun, "Radau", rtol=1e-10, atol=1e-12, max_step=0.01)
    np.testing.assert_allclose(found, judge.y[:, -1], atol=1e-7)
