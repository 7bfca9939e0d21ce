"""Where the sphere of the publication rests, by the exact model."""

from functools import cache

import equinox as eqx

import asperity
from asperity._jax import jnp
from asperity.config.resolve import resolve
from asperity.dynamics import prepare
from asperity.model import build
from figures import Figure, misses

SOURCE = "independent computation"


@eqx.filter_jit
def equilibrium(contact, body):
    return prepare(contact, body)[1].equilibrium


@cache
def dry():
    changes = {"counterface.deformation": "rigid", "capillary.model": "none"}
    return asperity.load("published-exact").replace(changes)


def modulus():
    found = resolve(dry()).modulus
    problem = "published case: contact modulus of its Table 1"
    return Figure(problem, SOURCE, 56.814, found * 1e-9, "GPa", 1e-4)


def resting():
    """Where it rests, 45.9 nm or lambda' = 4.37; how many asperities touch; what bears it."""
    problem = build(resolve(dry()))
    rest = equilibrium(problem.contact, problem.body)
    at_rest = problem.contact.state(rest, problem.contact.initial_memory())
    reduced = float(rest) / dry().roughness.rms_height
    weight, force = float(problem.body.weight), float(at_rest.force)
    contacting = float(at_rest.contacting)
    return (
        Figure("published case, dry: rests at", SOURCE, 45.9, float(rest) * 1e9, "nm", 0.05 / 45.9),
        Figure("published case, dry: rests at", SOURCE, 4.37, reduced, "rms", 0.005 / 4.37),
        Figure("published case, dry: touch at rest", SOURCE, 0.07, contacting, "", 0.005 / 0.07),
        Figure("published case, dry: force at rest", "weight", weight, force, "N", 1e-8),
    )


def at_three():
    """Adhesion of about 1 nN against a contact force of 4.9 uN at lambda' = 3."""
    problem = build(resolve(dry()))
    found = problem.contact.state(jnp.asarray(3.0 * 10.5e-9), problem.contact.initial_memory())
    parts = dict(zip(problem.contact.components, map(float, found.parts), strict=True))
    contact, pull = parts["elastic"] * 1e6, -parts["adhesion"] * 1e9
    return (
        Figure("published case, dry: contact force at 3 rms", SOURCE, 4.9, contact, "uN", 0.01),
        Figure("published case, dry: adhesion at 3 rms", SOURCE, 1.0, pull, "nN", 0.1),
    )


def figures():
    return [modulus(), *resting(), *at_three()]


def test_known_figures_are_met():
    assert misses(figures()) == []
