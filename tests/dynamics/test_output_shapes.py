"""Shapes of curves that are foretold, beside those of curves that are traced."""

from pathlib import Path

import numpy as np
import pytest

import asperity
from asperity import integration
from asperity._jax import jax
from asperity.config import builtin, load_file
from asperity.config.resolve import resolve
from asperity.dynamics import prepare
from asperity.dynamics.output_shapes import shapes_of_curves
from asperity.integration import cut_in_steps
from asperity.model import build

EXAMPLES = Path(__file__).parents[2] / "examples"
RIGID = {"counterface.deformation": "rigid"}
KINDS = {
    "half-space": {},
    "half-space without menisci": {"capillary.model": "none"},
    "half-space with bonds twice": {"adhesion.model": "jkr"},
    "half-space with gas": {
        "gas.name": "air",
        "gas.pressure": "101325 Pa",
        "gas.temperature": "20 degC",
    },
    "half-space that creeps": {
        "capillary.model": "none",
        "viscoelasticity": {
            "model": "standard-linear-solid",
            "relaxed_modulus_ratio": 0.4,
            "relaxation_time": "500 ns",
        },
    },
    "rigid": RIGID,
    "rigid without losses": {**RIGID, "capillary.formation": "capillary-condensation"},
    "rigid with bonds twice": {**RIGID, "adhesion.model": "jkr"},
    "rigid with menisci that take time": {**RIGID, "capillary.formation_time": "1 us"},
}


def shapes(tree):
    leaves, structure = jax.tree_util.tree_flatten(tree)
    return structure, [(leaf.shape, np.dtype(leaf.dtype)) for leaf in leaves]


def traced(contact, body, many):
    return jax.eval_shape(lambda *given: prepare(*given, many), contact, body)


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("many", [False, True])
def test_the_shapes_of_curves_are_those_that_are_foreseen(kind, many):
    problem = build(resolve(builtin("published-exact").replace(KINDS[kind])))
    if many:
        problem = cut_in_steps(problem)
    found = shapes_of_curves(problem.contact, many)
    assert shapes(found) == shapes(traced(problem.contact, problem.body, many))
    assert bool(found[0].reversals) == (many and problem.contact.reversals > 0)


@pytest.mark.parametrize("file", sorted(EXAMPLES.glob("*.toml")), ids=lambda file: file.stem)
def test_so_are_those_of_every_example_unless_its_asperities_yield(file):
    problem = build(resolve(load_file(file)))
    found = shapes_of_curves(problem.contact)
    if problem.contact.yields:
        assert found is None
    else:
        assert shapes(found) == shapes(traced(problem.contact, problem.body, many=False))


def test_so_are_those_of_the_published_sums():
    problem = build(resolve(builtin("published")))
    given = problem.contact, problem.body
    assert shapes(shapes_of_curves(problem.contact)) == shapes(traced(*given, many=False))


def test_a_motion_is_compiled_once_for_the_shapes_that_were_foreseen():
    case = builtin("published-exact").replace({**RIGID, "numerics.max_impacts": 1})
    before = set(integration._integrate_some._held)
    asperity.solve(case)
    asperity.solve(case.replace({"roughness.rms_height": "10.6 nm"}))
    assert len(set(integration._integrate_some._held) - before) == 1
