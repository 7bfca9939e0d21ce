"""When single bodies of the publication's case come to rest: by their losses at every energy."""

import numpy as np
import pytest

import asperity
from asperity.config import builtin
from asperity.config.resolve import resolve
from asperity.dynamics.summit_path import Launch
from asperity.model import build
from asperity.single_bodies import realising
from asperity.single_bodies.launching import SingleBodies

BODIES, ENERGIES = 256, 96
ABOVE = 38e-9  # m: no body turns far above
CASE = builtin("published-exact").replace(
    {
        "counterface.deformation": "rigid",
        "roughness.placement": "random",
        "roughness.realisations": BODIES,
        "numerics.max_impacts": 102,
    }
)


def flights_until_rest(case):
    """Time in flight [s] and impacts until each body is captured, as sums over its energies."""
    problem = build(resolve(case))
    bodies, body = SingleBodies(problem, ABOVE), problem.body.plain
    away = np.full(BODIES, np.inf)
    launches = Launch(np.full(BODIES, body.kinetic), np.full(BODIES, body.release))
    first = bodies.impacts(launches, with_pull_off=False)
    left = np.asarray(first.impact_energy) * np.asarray(first.restitution) ** 2
    energies = np.max(first.impact_energy) * np.geomspace(1e-6, 1.0, ENERGIES)
    before = np.asarray(first.closest_approach)
    found = [
        bodies.impacts(Launch(np.full(BODIES, e), away), with_pull_off=False, before=before)
        for e in energies
    ]
    brought, kept, captured = (
        np.array([getattr(one, name) for one in found])
        for name in ("impact_energy", "restitution", "captured")
    )
    lost = brought * (1.0 - kept**2)
    times, impacts = np.zeros((2, BODIES))
    for k in range(BODIES):
        slowest = np.max(energies[captured[:, k]], initial=energies[0])
        if left[k] <= slowest:
            continue
        e = np.geomspace(slowest, left[k], 400)
        rate = 1.0 / np.interp(e, energies, lost[:, k])
        flight = 2.0 * np.sqrt(2.0 * e * body.mass) / body.weight
        times[k], impacts[k] = np.trapezoid(flight * rate, e), np.trapezoid(rate, e)
    return times, impacts


@pytest.mark.long
def test_yielding_bodies_followed_to_rest_fly_as_long_as_their_losses_say(monkeypatch):
    monkeypatch.setattr(realising, "REBOUNDS", 100)
    case = CASE.replace({"plasticity": {"model": "kogut-etsion", "hardness": "9 GPa"}})
    followed = asperity.solve(case, critical=False).realisations.values
    times, impacts = flights_until_rest(case)
    found = np.median(followed["flight_time"]), np.median(followed["rebounds"])
    assert found == pytest.approx((np.median(times), np.median(impacts)), rel=0.03)
    assert found == pytest.approx((1.22e-3, 46.0), rel=0.1)


@pytest.mark.long
def test_elastic_bodies_come_to_rest_which_the_mean_field_never_does():
    times, impacts = flights_until_rest(CASE)
    assert np.median(times) == pytest.approx(0.41, rel=0.15)
    assert np.median(impacts) == pytest.approx(5400, rel=0.15)
