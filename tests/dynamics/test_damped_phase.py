"""A motion through gas: beside an integration in time, its limits, its ledger, its gradient."""

import dataclasses

import numpy as np
import pytest

import asperity
from asperity._jax import jax, jnp
from asperity.config.resolve import resolve
from asperity.dynamics import simulate
from asperity.dynamics.gas_film import SqueezeFilm
from asperity.errors import ENDS, Outcome, Tolerance
from asperity.integration import integrate
from asperity.integration.single_case import cut_in_steps
from asperity.model import build
from asperity.results.conversion import measured
from in_time import next_turn

TURNS = ("closest_approach", "apex", "closest_approach_time", "apex_time")
IMPACTS = 4


GAS = {
    "counterface.deformation": "rigid",
    "gas.viscosity": "18.2 uPa s",
    "gas.slip_length": "75 nm",
    "numerics.max_impacts": IMPACTS,
}


@pytest.fixture(scope="module")
def case():
    return asperity.load("published-exact").replace(GAS)


@pytest.fixture(scope="module")
def problem(case):
    return cut_in_steps(build(resolve(case)))


def in_gas(problem, viscosity, slip, release=60e-9):
    old = problem.body.drags[0]
    film = SqueezeFilm(old.radius, viscosity, slip, old.closest)
    return dataclasses.replace(problem.body, drags=(film,), release=release)


def moved(problem, body):
    """Motion and measures of up to so many impacts, by the programs that runs use."""
    found = integrate(problem._replace(body=body))
    impacts = jax.tree_util.tree_map(lambda rows: rows[:IMPACTS], found.motion.impacts)
    return found.motion._replace(impacts=impacts), measured(found)


@pytest.fixture(scope="module")
def integrated(problem):
    """Motion and measures for a viscosity [Pa s], a slip length and a release [m]."""

    def run(viscosity, slip, release=60e-9):
        return moved(problem, in_gas(problem, viscosity, slip, release))

    return run


@pytest.fixture(scope="module")
def in_air(integrated):
    return integrated(18.2e-6, 75e-9)


def test_turns_and_times_are_those_of_an_integration_in_time(problem, in_air):
    motion, _ = in_air
    memory, place, time = problem.contact.initial_memory(), float(problem.body.release), 0.0
    for k in range(2):
        made = motion.impacts
        for sign, rows in ((-1, (made.closest_approach, made.closest_approach_time)),
                           (1, (made.apex, made.apex_time))):  # fmt: skip
            place, taken, _ = next_turn(*problem[:2], memory, place, sign, problem.body.drags[0])
            memory, time = problem.contact.update_memory(memory, place), time + taken
            assert float(rows[0][k]) == pytest.approx(place, rel=1e-8)
            assert float(rows[1][k]) == pytest.approx(time, rel=1e-7)


def test_what_the_gas_takes_is_missing_from_the_energy(in_air):
    motion, _ = in_air
    rows = motion.impacts
    assert float(jnp.max(rows.energy_balance_error) / rows.maximum_kinetic[0]) < 1e-11
    taken = np.diff(np.asarray(rows.lost)[:, -1])
    assert np.all(taken > 0.0)


def test_thin_gas_is_a_vacuum(problem, integrated):
    motion, _ = moved(problem, dataclasses.replace(problem.body, drags=()))
    thin, _ = integrated(1e-16, 0.0)
    for name in TURNS:
        np.testing.assert_allclose(
            getattr(thin.impacts, name), getattr(motion.impacts, name), rtol=1e-9
        )


def test_slip_takes_less_energy_than_none(integrated):
    lost = [
        float(integrated(18.2e-6, slip)[0].impacts.lost[0, -1]) for slip in (0.0, 75e-9, 480e-9)
    ]
    assert lost[0] > 1.5 * lost[1] > 1.5 * lost[2]


def test_restitution_counts_what_passes_the_end_of_contact(problem, integrated):
    """Speeds there, in and out, of an integration in time; less is lost than between apexes."""
    start = 200e-9
    motion, measures = integrated(18.2e-6, 75e-9, start)
    weight, place = float(problem.body.weight), float(measures.contact_end)
    film, memory = problem.body.drags[0], problem.contact.initial_memory()
    speeds = []
    speeds.append(next_turn(*problem[:2], memory, start, -1, film, until=place)[2])
    deepest = float(motion.impacts.closest_approach[0])
    memory = problem.contact.update_memory(memory, deepest)
    speeds.append(next_turn(*problem[:2], memory, deepest, 1, film, until=place)[2])
    found = float(measures.restitution[0])
    assert found == pytest.approx(speeds[1] / speeds[0], rel=1e-6)
    apex = float(motion.impacts.apex[0])
    assert found**2 > weight * (apex - place) / (weight * (start - place))


@pytest.mark.parametrize("viscosity", [2e-4, 1e-2, 1.0, 1e4, 1e7])
def test_a_body_that_the_gas_holds_creeps_to_rest(problem, integrated, viscosity):
    motion, measures = integrated(viscosity, 0.0)
    assert ENDS[int(motion.end.outcome)] is Outcome.REST
    assert np.isnan(measures.rebound_height[0])
    rest = float(motion.reference.equilibrium)
    goal = rest + 1e-3 * (float(problem.body.release) - rest)
    film = SqueezeFilm(problem.body.drags[0].radius, viscosity, 0.0, problem.body.drags[0].closest)
    memory, release = problem.contact.initial_memory(), float(problem.body.release)
    _, time, _ = next_turn(*problem[:2], memory, release, -1, film, until=goal)
    assert float(measures.time_to_rest) == pytest.approx(time, rel=2e-4)
    fall = float(problem.body.weight) * (release - rest)
    assert float(motion.impacts.energy_balance_error[0]) < 1e-11 * fall
    if viscosity < 0.05:  # else its kinetic energy is lost in the rounding of the other
        fastest = motion.impacts.maximum_kinetic[0]
        assert float(motion.impacts.energy_balance_error[0] / fastest) < 1e-8


def test_gradient_of_the_first_apex_with_respect_to_the_viscosity(problem, integrated):
    def apex(viscosity):
        body = in_gas(problem, viscosity, 75e-9)
        return simulate(problem.contact, body, tolerance=Tolerance(max_impacts=1)).impacts.apex[0]

    _, slope = jax.jit(lambda x: jax.jvp(apex, (x,), (jnp.ones(()),)))(jnp.asarray(1.82e-5))
    step = 1e-9
    low, high = (
        float(integrated(1.82e-5 + way * step, 75e-9)[0].impacts.apex[0]) for way in (-1, 1)
    )
    middle = (high - low) / (2.0 * step)
    assert float(slope) == pytest.approx(middle, rel=1e-6)


def test_a_drawn_motion_runs_in_time_and_keeps_its_energy():
    """On a half-space, to rest: every sample later than the one before, all energies summed."""
    case = asperity.load("published-exact").replace(
        {"gas.name": "air", "gas.pressure": "1 bar", "gas.temperature": "20 degC"}
    )
    result = asperity.solve(case, critical=False)
    assert result.outcome is Outcome.REST
    assert np.all(np.diff(result.time) >= 0.0)
    assert result.time[-1] == pytest.approx(result.measures["time_to_rest"], rel=1e-9)
    total = sum(result.energies.values())
    assert np.ptp(total) < 1e-6 * result.ledger["initial"]
    steps = np.diff(result.time) * 0.5 * (result.speed[1:] + result.speed[:-1])
    travelled = result.separation[0] + np.concatenate([[0.0], np.cumsum(steps)])
    np.testing.assert_allclose(travelled, result.separation, atol=1e-3 * np.ptp(travelled))
    assert set(result.ledger["lost"]) == {"capillary", "gas"}


def test_a_rebound_that_gas_keeps_low_is_no_capture(case):
    """Released near the end of contact: it bounces on, whether its rebound comes back there."""
    for release in ("60 nm", "80 nm", "120 nm"):
        measures = asperity.solve(
            case.replace({"impact.release_separation": release}), critical=False
        ).measures
        assert measures["captured"] is False
        assert measures["restitution"][0] is None or measures["restitution"][0] > 0.3
        assert measures["rebound_height"][0] > 8e-9


def test_the_force_of_the_gas_is_part_of_the_total(problem, case):
    result = asperity.solve(case, critical=False)
    forces = result.forces
    whole = forces["contact"] + forces["weight"] + forces["gas"]
    np.testing.assert_allclose(forces["total"], whole, rtol=1e-12, atol=1e-20)
    assert np.all(forces["gas"] * result.speed <= 0.0)
    gained = np.diff(0.5 * float(problem.body.mass) * result.speed**2)
    middle = 0.5 * (forces["total"][1:] + forces["total"][:-1])
    worked = middle * np.diff(result.separation)
    assert np.sum(np.abs(gained - worked)) < 2e-2 * np.sum(np.abs(gained))


def test_a_stiff_body_bounces_in_thin_gas():
    """It turns within 1e-3 of its fall's height below its rest, and at full speed all the same."""
    case = asperity.load("published-exact").replace(
        {
            "roughness": None,
            "capillary": None,
            "adhesion": None,
            "gas.viscosity": "1e-9 Pa s",
            "gas.slip_length": "0 nm",
            "gas.cutoff_separation": "1 nm",
            "impact.release_separation": "1 mm",
            "numerics.max_impacts": 2,
        }
    )
    result = asperity.solve(case, critical=False)
    assert result.outcome is Outcome.MAX_IMPACTS
    assert result.measures["restitution"][0] > 0.999
