"""Curves and phases in few shapes say what those of a motion say."""

import jax
import numpy as np
import pytest

import asperity
from asperity.config.resolve import resolve
from asperity.dynamics.common_shapes import with_phases, without_curves
from asperity.integration import integrate
from asperity.model import build
from asperity.numerics.compilation import AT_ONCE, Program
from asperity.results.conversion import measured
from asperity.results.measures import measure

WHOLE = Program(measure, AT_ONCE)


@pytest.mark.parametrize("name", ["examples/jkr-bounce.toml", "examples/drop-in-air.toml"])
def test_measures_are_those_of_the_whole_motion(name: str):
    """With scanning curves, and with a drag outside contact."""
    problem = build(resolve(asperity.load(name)))
    problem = problem._replace(inputs=problem.inputs.one_impact())
    solution = integrate(problem)
    found, whole = measured(solution), WHOLE(solution.motion, solution.body, None, None)
    made = int(np.sum(solution.motion.impacts.made))
    for quantity, value, expected in zip(found._fields, found, whole, strict=True):
        value = np.asarray(value)[:made] if np.ndim(value) else value
        expected = np.asarray(expected)[:made] if np.ndim(expected) else expected
        np.testing.assert_allclose(value, expected, rtol=1e-12, err_msg=quantity)


def test_motions_of_other_panels_and_laws_have_one_shape():
    tables, shapes = [], []
    for name in ("glass-bead", "published"):
        problem = build(resolve(asperity.load(name)))
        problem = problem._replace(inputs=problem.inputs.one_impact())
        solution = integrate(problem, drawn=False)
        tables.append(solution.motion.table.values.shape)
        both = without_curves(solution.motion), *with_phases(solution.motion, problem.body)
        shapes.append(jax.tree_util.tree_map(np.shape, both))
    assert tables[0] != tables[1]
    assert shapes[0] == shapes[1]
