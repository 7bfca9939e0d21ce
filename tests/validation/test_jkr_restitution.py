"""Rebound of smooth JKR spheres without gravity against the work of one cycle."""

from functools import cache
from math import pi, sqrt
from pathlib import Path

import equinox as eqx
import numpy as np
import pytest

from asperity.contact import SmoothContact
from asperity.errors import Tolerance
from asperity.impact import Body, simulate
from asperity.laws import Jkr
from asperity.measures import measure
from figures import Figure

FILE = Path(__file__).parent.parent / "data" / "jkr_restitution.csv"
ROWS = np.genfromtxt(FILE, delimiter=",", comments="#", skip_header=4)
SPHERES = {"hard": (50e-6, 56.8e9, 0.05, 2200.0), "soft": (10e-6, 3e6, 0.03, 1050.0)}


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
    problem = f"JKR sphere, {name}: restitution at {ratio:g} V_s"
    return Figure(problem, "sqrt(1 - (V_s/V)^2)", expected, found, "", 1e-5)


def figures():
    return [figure(name, *row) for name in SPHERES for row in ROWS]


@pytest.mark.parametrize("name", SPHERES)
@pytest.mark.parametrize("row", ROWS, ids=str)
def test_restitution_at_a_speed(row, name):
    known = figure(name, *row)
    assert known.holds
    assert known.found == pytest.approx(sqrt(1.0 - 1.0 / row[0] ** 2), rel=1e-5)


def test_all_speeds_are_read():
    assert ROWS.shape == (5, 2)
