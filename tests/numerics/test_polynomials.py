"""Chebyshev sums against NumPy's, whatever the degree and however the axes broadcast."""

import numpy as np
import pytest
from numpy.polynomial import chebyshev

from asperity._jax import jax, jnp
from asperity.numerics.polynomials import chebyshev_sum

RANDOM = np.random.default_rng(7)


@pytest.mark.parametrize("count", [1, 2, 3, 4, 7, 16, 17])
@pytest.mark.parametrize(
    ("columns", "places"),
    [
        ((), ()),
        ((), (5,)),
        ((3, 1), (3, 5)),
        ((3, 1), (5,)),
        ((4,), (4,)),
        ((4,), (1,)),
        ((0,), (0,)),
    ],
)
def test_a_sum_is_that_of_numpy(count, columns, places):
    coefficients = RANDOM.normal(size=(count, *columns))
    x = RANDOM.uniform(-1.0, 1.0, places)
    shape = np.broadcast_shapes(columns, places)
    alike = coefficients.reshape(count, *(1,) * (len(shape) - len(columns)), *columns)
    powers = chebyshev.chebvander(np.broadcast_to(x, shape), count - 1)
    wanted = np.sum(alike * np.moveaxis(powers, -1, 0).reshape(count, *shape), axis=0)
    found = chebyshev_sum(jnp.asarray(coefficients), jnp.asarray(x))
    assert found.shape == shape
    np.testing.assert_allclose(found, wanted, atol=1e-14 * count)


@pytest.mark.parametrize("count", [1, 2, 5, 16, 17])
def test_its_derivatives_are_those_of_the_polynomial(count):
    coefficients = RANDOM.normal(size=count)
    for x in (-1.0, -0.3, 0.0, 0.8, 1.0):
        slope = jax.grad(chebyshev_sum, argnums=1)(jnp.asarray(coefficients), jnp.asarray(x))
        wanted = chebyshev.chebval(x, chebyshev.chebder(coefficients)) if count > 1 else 0.0
        assert float(slope) == pytest.approx(wanted, rel=1e-11, abs=1e-12)
        each = jax.grad(chebyshev_sum)(jnp.asarray(coefficients), jnp.asarray(x))
        np.testing.assert_allclose(each, chebyshev.chebvander(x, count - 1).ravel(), atol=1e-13)
