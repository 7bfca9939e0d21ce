"""Where the sphere of the publication rests, by the exact model."""

import pytest

import asperity
from asperity._jax import jnp
from asperity.case.build import build
from asperity.impact import prepare
from asperity.materials import contact_modulus


@pytest.fixture(scope="module")
def dry():
    changes = {"counterface.deformation": "rigid", "capillary.model": "none"}
    return asperity.load("published-exact").replace(changes)


def test_contact_modulus_of_table_1(dry):
    modulus = contact_modulus(dry.body_solid, dry.counterface_solid)
    assert modulus == pytest.approx(56.814e9, rel=1e-4)


def test_sphere_rests_on_its_highest_asperities(dry):
    """At 45.9 nm, lambda' = 4.37."""
    problem = build(dry)
    rest = float(prepare(problem.contact, problem.body)[1].equilibrium)
    assert rest * 1e9 == pytest.approx(45.9, abs=0.05)
    assert rest / dry.roughness.rms_height == pytest.approx(4.37, abs=0.005)


def test_fewer_than_one_asperity_touches_at_rest_on_average(dry):
    problem = build(dry)
    rest = prepare(problem.contact, problem.body)[1].equilibrium
    found = problem.contact.state(rest, problem.contact.fresh())
    assert float(found.touching) == pytest.approx(0.07, abs=0.005)
    assert float(found.force) == pytest.approx(float(problem.body.weight), rel=1e-8)


def test_dry_adhesion_is_negligible_beside_contact(dry):
    """About 1 nN against a contact force of 4.9 uN at lambda' = 3."""
    problem = build(dry)
    found = problem.contact.state(jnp.asarray(3.0 * 10.5e-9), problem.contact.fresh())
    parts = dict(zip(problem.contact.components, found.parts, strict=True))
    assert float(parts["elastic"]) == pytest.approx(4.9e-6, rel=0.01)
    assert float(-parts["adhesion"]) == pytest.approx(1e-9, rel=0.1)
