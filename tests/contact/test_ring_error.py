"""Rings of a half-space: any number runs, and what it leaves of error is known and said."""

import dataclasses

import equinox as eqx
import numpy as np
import pytest

import asperity
from asperity._jax import jnp
from asperity.config.resolve import resolve
from asperity.contact.ring_error import ring_error
from asperity.halfspace import ring_mesh
from asperity.model import build
from chosen import long_but

PUBLISHED = asperity.load("published-exact").replace(
    {"body.radius": "10 um", "impact": {"speed": "0.1 m/s", "gravity": "0 m/s^2"}}
)
SMOOTHER = {
    "roughness.rms_height": "2 nm",
    "roughness.asperity_radius": "20 nm",
    "roughness.asperity_density": "1e15 1/m^2",
}
CASES = {
    "rms 10 nm": {"roughness.rms_height": "10 nm", "capillary": None},
    "rms 2 nm": {**SMOOTHER, "capillary": None},
    "menisci, soft": {**SMOOTHER, "body.material": "polystyrene"},
}


def case(rings, name="rms 2 nm"):
    return PUBLISHED.replace({**CASES[name], "numerics.rings": rings, "numerics.max_impacts": 1})


@pytest.mark.parametrize("name", long_but(CASES, "rms 2 nm"))
def test_the_estimated_error_of_the_rings_is_what_a_finer_mesh_changes(name):
    contact = build(resolve(case(40, name))).contact
    deepest = jnp.asarray(-2.0 * contact.interface.scale.rms)
    forces, errors = {}, {}
    for rings in (160, 80, 40):
        finer = dataclasses.replace(contact, rings=rings)
        rest = eqx.filter_jit(lambda one, d: one.state(d, one.initial_memory()))(finer, deepest)
        forces[rings] = float(rest.force)
        errors[rings] = ring_error(finer, float(deepest), float(rest.size), np.asarray(rest.field))
    for rings in (80, 40):
        true = abs(forces[rings] / forces[160] - 1.0)
        assert errors[rings] == pytest.approx(true, rel=0.3, abs=1e-11)
    assert errors[160] < 1e-12
    assert errors[80] < 1e-8 < errors[40]


def test_any_number_of_rings_runs_and_too_few_are_said():
    result = asperity.solve(case(17), critical=False)
    assert np.isfinite(result.measures["restitution"][0])
    (line,) = [line for line in result.warnings if "numerics.rings" in line]
    assert "24 rings leave an estimated error of" in line


def test_enough_rings_are_taken_without_a_word():
    contact = build(resolve(case(80))).contact
    assert contact.rings == len(ring_mesh(80).radius) == 80
    assert not any("rings" in line for line in asperity.solve(case(80), critical=False).warnings)
    assert [len(ring_mesh(n).radius) for n in (1, 8, 9, 17, 20, 24)] == [8, 8, 16, 24, 24, 24]
