"""Bodies that a gas film stops where nothing else acts: where, and what is said of it."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.integrate import quad, solve_ivp
from scipy.optimize import brentq

import asperity
from asperity.config import load
from asperity.dynamics.gas_film import SqueezeFilm
from asperity.errors import Outcome
from asperity.results.verdict import verdict
from records import never_goes_back

RADIUS, DENSITY, VISCOSITY, RELEASE = 5e-6, 2500.0, 18.2e-6, 1e-6
MASS = 4.0 / 3.0 * math.pi * RADIUS**3 * DENSITY
SMOOTH = """
[body]
radius = "5 um"
youngs_modulus = "70 GPa"
poisson = 0.2
density = "2500 kg/m^3"
[counterface]
material = "silica"
[gas]
viscosity = "18.2 uPa s"
slip_length = "0 m"
cutoff_separation = "1 nm"
[impact]
release_separation = "1 um"
speed = "10 mm/s"
gravity = "0 m/s^2"
[numerics]
max_impacts = 3
"""
ROUGH = {
    "counterface.deformation": "rigid",
    "roughness": {
        "asperity_density": "1e14 1/m^2",
        "asperity_radius": "50 nm",
        "rms_height": "2 nm",
    },
    "adhesion": {"model": "jkr", "work": "50 mJ/m^2"},
}
WATER = {
    "model": "equilibrium",
    "liquid": "water",
    "humidity": 0.6,
    "temperature": "20 degC",
    "contact_angle": "40 deg",
    "formation_time": "1 us",
}


def solved(changes):
    return asperity.solve(load(SMOOTH).replace(changes), critical=False)


def stopping_gap(speed: float, slip: float, start: float = RELEASE) -> float:
    """Gap [m] at which the drag has taken the momentum m v."""
    film = SqueezeFilm(RADIUS, VISCOSITY, slip)

    def left(logarithm: float) -> float:
        def taken(x: float) -> float:
            return float(film.drag(math.exp(x))) * math.exp(x)

        return quad(taken, logarithm, math.log(start), epsrel=1e-11)[0] - MASS * speed

    return math.exp(brentq(left, math.log(1e-8), math.log(start), xtol=1e-13))


@pytest.mark.parametrize(
    ("changes", "speed"), [({}, 1e-3), ({}, 10e-3), (ROUGH, 10e-3)], ids=["slow", "", "rough"]
)
def test_a_film_without_slip_stops_a_body_at_the_gap_of_the_closed_form(changes, speed):
    result = solved({**changes, "impact.speed": f"{speed} m/s"})
    expected = RELEASE * math.exp(-MASS * speed / (6.0 * math.pi * VISCOSITY * RADIUS**2))
    assert result.outcome is Outcome.STOPPED
    assert result.outcome.ok
    (place,), (apex,) = (
        result.events[f"{name}_separation"] for name in ("closest_approach", "apex")
    )
    assert place == pytest.approx(expected, rel=1e-9)
    assert apex == place
    assert verdict(result) == (
        f"is stopped by the gas film at {place * 1e9:.4g} nm before it touched; the gas film takes "
        "all of the energy lost"
    )
    assert "The gas film stopped the body" in result.summary()
    assert result.ledger["lost"]["gas"] == pytest.approx(0.5 * MASS * speed**2, rel=1e-9)
    assert result.measures["captured"] is False
    assert result.measures["restitution"] == result.measures["rebound_period"] == [None]
    assert any("never touches" in line for line in result.warnings)
    never_goes_back(result)


def test_with_slip_adhesion_and_roughness_the_film_stops_the_body_by_its_momentum():
    """The rough JKR case of 10 mm/s in air was no answer, but an error."""
    result = solved({**ROUGH, "gas.slip_length": "75 nm"})
    assert result.outcome is Outcome.STOPPED
    assert result.events["closest_approach_separation"][0] == pytest.approx(
        stopping_gap(10e-3, 75e-9), rel=1e-8
    )


def test_menisci_on_their_way_change_nothing_for_a_body_that_never_comes_near():
    """The same stepped in time, by another method."""
    result = solved({**ROUGH, "adhesion": None, "capillary": WATER})
    assert result.outcome is Outcome.STOPPED
    assert result.events["closest_approach_separation"][0] == pytest.approx(
        stopping_gap(10e-3, 0.0), rel=1e-6
    )


def test_a_body_that_bounces_is_stopped_on_its_way_out():
    """From the speed with which it leaves 3 nm behind, where no contact force is left."""
    result = solved({"impact.speed": "100 mm/s"})
    assert result.outcome is Outcome.STOPPED
    (apex,) = result.events["apex_separation"]
    out = np.argmin(result.separation) + np.searchsorted(
        result.separation[np.argmin(result.separation) :], 3e-9
    )
    speed, start = result.speed[out], result.separation[out]
    momentum = MASS * speed / (6.0 * math.pi * VISCOSITY * RADIUS**2)
    assert apex == pytest.approx(start * math.exp(momentum), rel=1e-6)
    assert f"is stopped by the gas film at {apex * 1e9:.4g} nm on its way out" in verdict(result)
    assert result.measures["captured"] is False


def test_with_gravity_the_body_creeps_on_until_it_rests():
    changes = {"impact.speed": "1 mm/s", "impact.gravity": "9.81 m/s^2"}
    assert solved(changes).outcome is Outcome.REST


def test_a_film_takes_the_momentum_and_the_weight_goes_on_as_integrated_in_time():
    """It fell 30 um, and ended with an error: the speed changes by 200 within half a nanometre."""
    impact = {"impact.gravity": "9.81 m/s^2", "impact.release_separation": "30 um"}
    result = solved({**ROUGH, **impact})
    assert result.outcome is Outcome.REST
    assert result.ledger["energy_balance_error"] < 1e-9
    film = SqueezeFilm(RADIUS, VISCOSITY, 0.0)
    sample = np.argmax(result.separation < 60e-9)  # no contact force is felt there
    place = float(result.separation[sample])

    def rates(_: float, y: np.ndarray) -> list[float]:
        return [y[1], -9.81 - float(film.drag(y[0])) * y[1] / MASS]

    def there(_: float, y: np.ndarray) -> float:
        return float(y[0]) - place

    there.terminal = True
    start = [30e-6, -10e-3]
    fall = solve_ivp(rates, (0.0, 1.0), start, "Radau", events=there, rtol=1e-10, atol=1e-20)
    assert result.time[sample] == pytest.approx(fall.t_events[0][0], rel=1e-6)
    assert result.speed[sample] == pytest.approx(fall.y_events[0][0][1], rel=1e-6)
