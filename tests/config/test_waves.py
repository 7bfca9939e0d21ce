"""A case whose contact radiates waves: its motion, its ledger, what is refused and warned of."""

from types import SimpleNamespace

import equinox as eqx
import numpy as np
import pytest
from scipy.integrate import solve_ivp

import asperity
from asperity._jax import jax, jnp
from asperity.config import load
from asperity.config.resolve import resolve
from asperity.errors import InputError
from asperity.model import build
from asperity.regimes.wave_limits import MOST, refuse_stopped, wave_warnings
from refused_input import refusal

ROUGH = load("""
schema = 1
[body]
radius = "5 um"
material = "silica"
[counterface]
material = "silicon"
deformation = "rigid"
[roughness]
asperity_density = "60 1/um^2"
asperity_radius = "0.1 um"
rms_height = "5 nm"
[capillary]
model = "equilibrium"
liquid = "water"
humidity = 0.6
temperature = "20 degC"
contact_angle = "30 deg"
[gas]
viscosity = "18.2 uPa s"
slip_length = "75 nm"
[waves]
model = "hunter"
[impact]
speed = "0.5 m/s"
release_separation = "100 nm"
gravity = "1e6 m/s^2"
[numerics]
max_impacts = 2
""")
SMOOTH = ROUGH.replace(
    {
        "roughness": None,
        "gas": None,
        "capillary": None,
        "counterface.deformation": "half-space",
        "adhesion.model": "jkr",
        "adhesion.work": "50 mJ/m^2",
    }
)


STIFF = {"youngs_modulus": "100 GPa", "poisson": 0.2}


@pytest.fixture(scope="module")
def result():
    return asperity.solve(ROUGH, critical=False)


@pytest.fixture(scope="module")
def problem():
    return build(resolve(ROUGH))


@eqx.filter_jit
def _felt(contact, film, place, memory):
    """Force of the contact, its slope, and the drag of the gas."""
    force, slope = jax.value_and_grad(lambda d: contact.state(d, memory).force)(place)
    return force, slope, film.drag(contact.state(place, memory).central)


def _leg(problem, start, speed, memory):
    """Place of the next turn of an integration in time, in nm and us."""
    contact, body = problem.contact, problem.body
    mass, weight, waves = (float(x) for x in (body.mass, body.weight, body.drags[-1].coefficient))

    def rate(_, y):
        place = jnp.asarray(y[0] * 1e-9)
        push, slope, film = (float(x) for x in _felt(contact, body.drags[0], place, memory))
        drag = film + waves * slope**2
        return [y[1], (push - weight - drag * y[1] * 1e-3) / mass * 1e-3]

    def turns(_, y):
        return y[1]

    turns.terminal, turns.direction = True, 1.0 if speed < 0.0 else -1.0
    found = solve_ivp(rate, (0, 1e3), [start * 1e9, speed * 1e3], "DOP853", events=turns,
                      rtol=1e-10, atol=1e-10)  # fmt: skip
    return found.y_events[0][0][0] * 1e-9, found.t_events[0][0] * 1e-6


def test_motion_is_that_of_an_integration_in_time_with_gas_and_waves(problem, result):
    memory, time = problem.contact.initial_memory(), 0.0
    place, speed = float(problem.body.release), -0.5
    for name in ("closest_approach", "apex"):
        place, taken = _leg(problem, place, speed, memory)
        memory, time = problem.contact.update_memory(memory, place), time + taken
        speed = 1e-9 if name == "closest_approach" else -1e-9
        assert result.events[f"{name}_separation"][0] == pytest.approx(place, rel=1e-6)
        assert result.events[f"{name}_time"][0] == pytest.approx(time, rel=1e-6)


def test_waves_are_booked_apart_from_gas_and_menisci_and_part_of_the_force(result):
    lost, forces = result.ledger["lost"], result.forces
    assert set(lost) == {"capillary", "gas", "waves"}
    assert all(energy > 0.0 for energy in lost.values())
    assert result.ledger["energy_balance_error"] < 1e-9
    whole = sum(result.energies.values())
    assert np.ptp(whole) < 1e-9 * result.ledger["initial"]
    assert result.energies["lost_waves"][-1] == pytest.approx(lost["waves"], rel=1e-9)
    assert np.all(np.diff(result.energies["lost_waves"]) > -1e-15 * lost["waves"])
    parts = sum(forces[name] for name in ("contact", "weight", "gas", "waves"))
    np.testing.assert_allclose(forces["total"], parts, rtol=1e-12)
    assert np.all(forces["waves"] * result.speed <= 0.0)


def _from_forces(result, coefficient):
    """What the drawn force radiates: the integral of its rate squared, by differences."""
    time, force = result.time, result.forces["contact"]
    steps = np.diff(time)
    moved = steps > 0.0
    return coefficient * np.sum(np.diff(force)[moved] ** 2 / steps[moved])


def test_loss_is_that_of_the_drawn_force(problem, result):
    found = _from_forces(result, float(problem.body.drags[-1].coefficient))
    assert result.ledger["lost"]["waves"] == pytest.approx(found, rel=1e-2)


def test_a_rough_half_space_radiates_too():
    case = ROUGH.replace(
        {
            "gas": None,
            "capillary": None,
            "counterface.deformation": "half-space",
            "numerics.max_impacts": 1,
        }
    )
    result = asperity.solve(case, critical=False)
    found = _from_forces(result, float(build(resolve(case)).body.drags[-1].coefficient))
    assert set(result.ledger["lost"]) == {"waves"}
    assert result.ledger["lost"]["waves"] == pytest.approx(found, rel=1e-2)
    assert result.ledger["energy_balance_error"] < 1e-8


def test_without_waves_there_are_none():
    for table in (None, {"model": "none"}):
        assert build(resolve(ROUGH.replace({"waves": table}))).body.mechanisms == ("gas",)


def test_the_counterface_carries_the_waves_not_the_body(problem):
    coefficient = float(problem.body.drags[-1].coefficient)
    other = build(resolve(ROUGH.replace({"body.material": "gold"}))).body.drags[-1]
    assert float(other.coefficient) == coefficient
    other = build(resolve(ROUGH.replace({"counterface.material": "silica"}))).body.drags[-1]
    assert float(other.coefficient) > coefficient


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"waves.model": "huntr"}, "did you mean 'hunter'?"),
        ({"counterface": STIFF}, "`density` must be given for the counterface with [waves] model"),
        ({"capillary.formation_time": "1 us"}, "`formation_time` must be absent with [waves]"),
        ({"gas": None, "publication": {}}, "[waves] must be absent with [publication]"),
    ],
)
def test_what_waves_cannot_be_computed_from_is_refused(changes, words):
    assert words in str(refusal(ROUGH.replace, changes))
    if "counterface" in changes:
        ROUGH.replace({**changes, "waves.model": "none"})


def _warned(case, share, force):
    """The warnings of a first impact that radiates a share, with a force [N] at its depth."""
    problem = build(resolve(case))
    energy = 0.5 * float(problem.body.mass) * 0.5**2
    laws = np.full(len(problem.contact.mechanisms), 1e-3 * energy)
    impacts = SimpleNamespace(maximum_kinetic=[energy], lost=np.append(laws, share * energy)[None])
    motion = SimpleNamespace(impacts=impacts)
    return wave_warnings(problem, force, -1e-9, motion)


def test_few_and_many_waves_and_quick_forces_are_warned_of():
    (line,) = _warned(SMOOTH, 0.01, 1e-5)
    assert "part of the energy lost to adhesion" in line
    assert any("radiates 20 %" in line for line in _warned(SMOOTH, 0.2, 1e-5))
    lines = _warned(SMOOTH, 0.01, 1e-1)
    assert any("shear waves cross the contact's radius" in line for line in lines)
    assert any("it is left ringing" in line for line in lines)


def test_menisci_of_rough_bodies_and_a_body_that_only_pulls_are_not_judged():
    assert _warned(ROUGH.replace({"gas": None}), 0.01, 1e-5) == []
    assert _warned(SMOOTH, 0.2, 0.0) == []


def failed(radiated):
    """A motion that radiated a share of its largest kinetic energy before it was lost."""
    problem = SimpleNamespace(
        inputs=SimpleNamespace(structure=SimpleNamespace(waves=True)),
        contact=SimpleNamespace(mechanisms=("adhesion",)),
        body=SimpleNamespace(mechanisms=("waves",)),
    )
    impacts = SimpleNamespace(
        maximum_kinetic=np.array([2e-16]), lost=np.array([[5e-15, radiated * 2e-16]])
    )
    return problem, SimpleNamespace(impacts=impacts)


def test_waves_that_stop_a_body_which_could_not_be_followed_are_refused():
    refuse_stopped(*failed(0.99 * MOST))
    with pytest.raises(InputError, match=r"they take 3\.5e-16 J of one that has 2e-16 J") as caught:
        refuse_stopped(*failed(1.75))
    assert caught.value.key == "waves.model"
