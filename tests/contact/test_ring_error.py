"""Rings of a half-space: any number runs, and what it leaves of error is known and said."""

import dataclasses

import numpy as np
import pytest

import asperity
from asperity.config.case_file import load
from asperity.config.resolve import resolve
from asperity.contact.ring_error import ring_error
from asperity.dynamics.curve_table import FORCE, SIZE, quantities, read_row
from asperity.halfspace import ring_mesh
from asperity.integration import first_impact, prepared
from asperity.model import build
from chosen import long_but

TEXT = """
schema = 1
[body]
shape = "sphere"
radius = "10 um"
material = "{body}"
[counterface]
material = "silicon carbide"
[roughness]
asperity_density = "{density} 1/m^2"
asperity_radius = "{tip}"
rms_height = "{rms}"
[adhesion]
model = "dmt"
work = "30 mJ/m^2"
equilibrium_spacing = "0.2 nm"
{menisci}
[impact]
speed = "0.1 m/s"
gravity = "0 m/s^2"
[numerics]
rings = {rings}
max_impacts = 1
"""
MENISCI = """
[capillary]
model = "equilibrium"
liquid = "water"
humidity = 0.6
temperature = "20 degC"
contact_angle = "73 deg"
"""
CASES = {
    "rms 10 nm": {"rms": "10 nm", "tip": "0.25 nm", "density": "1.69e16", "menisci": ""},
    "rms 2 nm": {"rms": "2 nm", "tip": "20 nm", "density": "1e15", "menisci": ""},
    "menisci, soft": {
        "rms": "2 nm", "tip": "20 nm", "density": "1e15", "menisci": MENISCI, "body": "polystyrene",
    },
}  # fmt: skip


def case(rings, name="rms 2 nm"):
    return load(TEXT.format(**{"body": "silica", **CASES[name]}, rings=rings))


@pytest.mark.parametrize("name", long_but(CASES, "rms 2 nm"))
def test_the_estimated_error_of_the_rings_is_what_a_finer_mesh_changes(name):
    problem = build(resolve(case(40, name)))
    deepest = float(first_impact(problem)[1].impacts.closest_approach[0])
    forces, errors = {}, {}
    for rings in (160, 80, 40):
        contact = dataclasses.replace(problem.contact, rings=rings)
        table, _ = prepared(contact, problem.body)
        row = read_row(table, 0, deepest)
        displacement = row[quantities(contact).field]
        forces[rings] = row[FORCE]
        errors[rings] = ring_error(contact, deepest, float(row[SIZE]), displacement)
    for rings in (80, 40):
        true = abs(forces[rings] / forces[160] - 1.0)
        assert errors[rings] == pytest.approx(true, rel=0.3, abs=1e-11)
    assert errors[160] < 1e-12
    assert errors[80] < 1e-8 < errors[40]


@pytest.mark.parametrize("rings", [17, 20])
def test_any_number_of_rings_runs_and_too_few_are_said(rings):
    result = asperity.solve(case(rings), critical=False)
    assert np.isfinite(result.measures["restitution"][0])
    (line,) = [line for line in result.warnings if "numerics.rings" in line]
    assert "24 rings leave an estimated error of" in line


def test_enough_rings_are_taken_without_a_word():
    contact = build(resolve(case(80))).contact
    assert contact.rings == len(ring_mesh(80).radius) == 80
    assert not any("rings" in line for line in asperity.solve(case(80), critical=False).warnings)
    assert [len(ring_mesh(n).radius) for n in (1, 8, 9, 17, 20, 24)] == [8, 8, 16, 24, 24, 24]
