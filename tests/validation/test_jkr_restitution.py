"""Rebound and capture of smooth JKR spheres without gravity against the work of one cycle."""

from functools import cache
from math import pi, sqrt
from pathlib import Path

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

FILE = Path(__file__).parent.parent / "data" / "jkr_restitution.csv"
ROWS = np.genfromtxt(FILE, delimiter=",", comments="#", skip_header=4)
SPHERES = {"hard": (50e-6, 56.8e9, 0.05, 2200.0), "soft": (10e-6, 3e6, 0.03, 1050.0)}
CASES = {"hard": ("70 GPa", 0.2), "soft": ("1 MPa", 0.49)}


@eqx.filter_jit
def restitution(contact, body):
    return measure(simulate(contact, body, tolerance=Tolerance(max_impacts=1)), body).restitution


@cache
def figure(name, ratio, expected):
    radius, modulus, work, density = SPHERES[name]
    mass = density * 4.0 / 3.0 * pi * radius**3
    cycle = 7.092196 * (work**5 * radius**4 / modulus**2) ** (1.0 / 3.0)
    law = Jkr(radius, modulus, work)
    release = 3.0 * float(law.breaking_gap)
    body = Body(mass, 0.0, release, ratio * sqrt(2.0 * cycle / mass))
    found = float(restitution(SmoothContact(law), body)[0])
    problem = f"JKR sphere, {name}: restitution at {ratio:g} V_c"
    return Figure(problem, "sqrt(1 - (V_c/V)^2)", expected, found, "", 1e-5)


@cache
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
    found = restitution_curve(case, np.array([2.0 * speed])).critical_velocity
    problem, source = f"JKR sphere, {name}", "sqrt(2 W/m), W of one JKR cycle"
    pull = Figure(
        f"{problem}: pull-off force", "Johnson, Kendall and Roberts (1971), 1.5 pi w R",
        1.5 * pi * work * radius, curve(case).pull_off, "N", 1e-9,
    )  # fmt: skip
    return Figure(f"{problem}: critical velocity", source, speed, found, "m/s", 1e-5), pull


def figures():
    found = [figure(name, *row) for name in SPHERES for row in ROWS]
    return [*found, *(row for name in CASES for row in from_cases(name))]


@pytest.mark.parametrize("name", SPHERES)
@pytest.mark.parametrize("row", ROWS, ids=str)
def test_restitution_at_a_speed(row, name):
    known = figure(name, *row)
    assert known.holds
    assert known.found == pytest.approx(sqrt(1.0 - 1.0 / row[0] ** 2), rel=1e-5)


@pytest.mark.parametrize("name", CASES)
def test_critical_velocity_and_pull_off_of_a_case(name):
    assert not misses(from_cases(name))


def test_all_speeds_are_read():
    assert ROWS.shape == (5, 2)
