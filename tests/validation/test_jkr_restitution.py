"""Rebound and capture of smooth JKR spheres without gravity against the work of one cycle."""

from functools import cache
from math import pi, sqrt

import equinox as eqx
import numpy as np
import pytest

from asperity import restitution_curve
from asperity.config import load
from asperity.config.resolve import resolve
from asperity.contact import SmoothContact
from asperity.dynamics import Body, simulate
from asperity.errors import Tolerance
from asperity.laws import Jkr
from asperity.results.measures import measure
from asperity.solver import curve
from figures import Figure, misses
from validation.known import rows

ROWS = rows("jkr_restitution", 4, 5)
SPHERES = {"hard": (50e-6, 56.8e9, 0.05, 2200.0), "soft": (10e-6, 3e6, 0.03, 1050.0)}
CASES = {"hard": ("70 GPa", 0.2), "soft": ("1 MPa", 0.49)}


@eqx.filter_jit
def restitution(contact, body):
    return measure(simulate(contact, body, tolerance=Tolerance(max_impacts=1)), body).restitution


@cache
def found(name, ratio):
    radius, modulus, work, density = SPHERES[name]
    mass = density * 4.0 / 3.0 * pi * radius**3
    cycle = 7.092196 * (work**5 * radius**4 / modulus**2) ** (1.0 / 3.0)
    law = Jkr(radius, modulus, work)
    release = 3.0 * float(law.breaking_gap)
    body = Body(mass, 0.0, release, ratio * sqrt(2.0 * cycle / mass))
    return float(restitution(SmoothContact(law), body)[0])


def figure(name, ratio, expected):
    problem = f"JKR sphere, {name}: restitution at {ratio:g} V_c"
    return Figure(problem, "sqrt(1 - (V_c/V)^2)", expected, found(name, ratio), "", 1e-5)


def from_cases(name):
    """Pull-off force, and the speed below which a sphere of a case file is captured."""
    modulus, poisson = CASES[name]
    case = load(
        f"""
        [body]
        radius = "5 um"
        youngs_modulus = "{modulus}"
        poisson = {poisson}
        density = "1200 kg/m^3"
        [counterface]
        material = "sapphire"
        [adhesion]
        model = "jkr"
        work = "50 mJ/m^2"
        [impact]
        speed = "1 m/s"
        gravity = "0 m/s^2"
        """
    )
    radius, work, density = case.body.radius, case.adhesion.work, resolve(case).body.density
    stiff = float(resolve(case).modulus)
    speed = 1.84018 * (work**5 / (radius**5 * density**3 * stiff**2)) ** (1.0 / 6.0)
    critical = restitution_curve(case, np.array([2.0 * speed])).critical_velocity
    problem, source = f"JKR sphere, {name}", "sqrt(2 W/m), W of one JKR cycle"
    pull = Figure(
        f"{problem}: pull-off force", "Johnson, Kendall and Roberts (1971), 1.5 pi w R",
        1.5 * pi * work * radius, curve(case).pull_off, "N", 1e-9,
    )  # fmt: skip
    return Figure(f"{problem}: critical velocity", source, speed, critical, "m/s", 1e-5), pull


def figures():
    rebounds = [figure(name, *row) for name in SPHERES for row in ROWS]
    return [*rebounds, *(row for name in CASES for row in from_cases(name))]


def test_known_figures_are_met():
    assert misses(figures()) == []


def test_restitution_is_that_of_the_closed_form():
    for ratio, _ in ROWS:
        for name in SPHERES:
            assert found(name, ratio) == pytest.approx(sqrt(1.0 - 1.0 / ratio**2), rel=1e-5)
