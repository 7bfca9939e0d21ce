"""Roots between two places: to rounding, from either side, where Newton's method would fail."""

import numpy as np
import pytest

from asperity._jax import jax, jnp
from asperity.numerics.roots import root_between


@pytest.mark.parametrize(
    ("function", "positive", "other", "root"),
    [
        (lambda x: 2.0 - x**2, 0.0, 2.0, np.sqrt(2.0)),
        (lambda x: x**3 - 5.0, 3.0, 1.0, np.cbrt(5.0)),
        (lambda x: jnp.exp(-x) - 0.5, -30.0, 40.0, np.log(2.0)),  # its steps lead out
        (lambda x: jnp.where(x > 0.25, 1.0, -1.0), 1.0, 0.0, 0.25),  # no slope at all
    ],
)
def test_a_root_is_found_to_rounding(function, positive, other, root):
    both = jnp.asarray(positive), jnp.asarray(other)
    found = jax.jit(lambda a, b: root_between(function, a, b, 1e-16))(*both)
    assert float(found) == pytest.approx(root, rel=1e-14)


def test_many_at_once_are_each_by_itself():
    levels = jnp.linspace(0.1, 3.9, 7)

    def one(level):
        return root_between(lambda x: x**2 - level, jnp.asarray(2.0), jnp.asarray(0.0), 1e-16)

    np.testing.assert_allclose(jax.jit(jax.vmap(one))(levels), np.sqrt(levels), rtol=1e-15)


def test_without_a_change_of_sign_the_end_is_the_other_place():
    found = root_between(lambda x: 1.0 + x**2, jnp.asarray(0.0), jnp.asarray(1.0), 1e-15)
    assert float(found) == pytest.approx(1.0, abs=1e-12)
