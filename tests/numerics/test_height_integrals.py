"""Height integrals against quadrature, closed forms and a published table."""

from math import erfc, exp, gamma, pi, sqrt
from pathlib import Path

import numpy as np
import pytest
from scipy.integrate import quad

from asperity._jax import jax, jnp
from asperity.numerics.height_integrals import height_integral, integrals_at

ORDERS = (0.0, 0.5, 1.0, 1.5, 2.0, 2.5)
PLACES = np.concatenate([np.linspace(-8.0, 12.0, 41), [-1.0 - 1e-9, -0.9999, 0.123, 11.987]])
NODES, WEIGHTS = np.polynomial.legendre.leggauss(20)
TABLE = Path(__file__).parents[1] / "data" / "height_integrals.csv"


def by_quadrature(order: float, separation: float) -> float:
    """F_n(l) in x = sqrt(s - l), in which the integrand is smooth, on 60 Gauss panels.

    Where l > 0 the factor exp(-l^2/2) is taken out.
    """
    outside, inside = max(separation, 0.0), min(separation, 0.0)
    end = sqrt(12.0 - inside) if separation < 3.0 else sqrt(40.0 / separation)
    ends = np.linspace(0.0, end, 61)
    x = 0.5 * (ends[:-1] + ends[1:])[:, None] + 0.5 * np.diff(ends)[:, None] * NODES
    t = x * x
    integrand = 2.0 * x ** (2.0 * order + 1.0) * np.exp(-0.5 * (t + inside) ** 2 - outside * t)
    total = np.sum(integrand * 0.5 * np.diff(ends)[:, None] * WEIGHTS)
    return float(total) * exp(-0.5 * outside**2) / sqrt(2.0 * pi)


def _scaled(t: float, order: float, separation: float) -> float:
    return t**order * exp(-0.5 * t * t - separation * t)


def test_quadrature_of_this_file_agrees_with_an_adaptive_one():
    for order, l in ((0.5, -8.0), (1.5, -1.0), (2.5, 0.0), (1.5, 4.0), (0.5, 12.0)):
        ends = (0.0, 12.0 - min(l, 0.0))
        marks = [0.05, max(-l, 0.5)]
        adaptive = quad(
            _scaled, *ends, args=(order, l), epsabs=0.0, epsrel=1e-10, points=marks, limit=400
        )[0]
        value = adaptive * exp(-0.5 * l * l) / sqrt(2.0 * pi)
        assert by_quadrature(order, l) == pytest.approx(value, rel=1e-9)


@pytest.fixture(scope="module")
def reference():
    wanted = (-0.5, *ORDERS)
    return {n: np.array([by_quadrature(n, l) for l in PLACES]) for n in wanted}


@pytest.mark.parametrize("order", ORDERS)
def test_height_integral_equals_its_quadrature(order, reference):
    found = np.asarray(height_integral(order, jnp.asarray(PLACES)))
    np.testing.assert_allclose(found, reference[order], rtol=1e-11, atol=0.0)


@pytest.mark.parametrize("order", ORDERS)
def test_gradient_lowers_the_order(order, reference):
    slope = np.asarray(jax.vmap(jax.grad(lambda l: height_integral(order, l)))(jnp.asarray(PLACES)))
    density = np.exp(-0.5 * PLACES**2) / sqrt(2.0 * pi)
    exact = -density if order == 0.0 else -order * reference[order - 1.0]
    np.testing.assert_allclose(slope, exact, rtol=1e-11, atol=0.0)


@pytest.mark.parametrize("separation", [-8.0, -5.5, -2.0, -1.0, -0.25, 0.0, 0.5, 2.0, 6.0, 12.0])
def test_integer_orders_have_closed_forms_in_the_error_function(separation):
    """Those of orders 1 and 2 cancel where the separation is positive."""
    tail = 0.5 * erfc(separation / sqrt(2.0))
    density = exp(-0.5 * separation**2) / sqrt(2.0 * pi)
    exact = (tail, density - separation * tail, (1 + separation**2) * tail - separation * density)
    for order, value in enumerate(exact if separation <= 0.0 else exact[:1]):
        assert float(height_integral(order, separation)) == pytest.approx(value, rel=1e-12)


@pytest.mark.parametrize("order", [-0.5, *ORDERS, 3.0, 3.5])
def test_far_out_it_follows_its_asymptotic_series(order):
    """n! phi(l) l^-(n+1) (1 - (n+1)(n+2)/(2 l^2) + ...), DLMF 12.9.1."""
    for l in (14.0, 25.0, 37.0):
        total, term = 0.0, 1.0
        for k in range(8):
            total += term
            term *= -(order + 2 * k + 1) * (order + 2 * k + 2) / (2.0 * (k + 1) * l * l)
        exact = gamma(order + 1.0) * exp(-0.5 * l * l) / sqrt(2.0 * pi) / l ** (order + 1.0) * total
        assert float(height_integral(order, l)) == pytest.approx(exact, rel=1e-8, abs=0.0)


@pytest.mark.parametrize("order", [0.25, 1.0 / 3.0, 0.7])
def test_other_orders_than_halves_too(order):
    found = np.asarray(height_integral(order, jnp.asarray(PLACES)))
    exact = np.array([by_quadrature(order, l) for l in PLACES])
    np.testing.assert_allclose(found, exact, rtol=1e-9, atol=0.0)


def test_published_table_is_met_to_its_last_figure():
    rows = np.genfromtxt(TABLE, delimiter=",", comments="#", skip_header=3)
    assert rows.shape == (9, 5)
    for column, order in enumerate((0.0, 1.0, 1.5, 2.5), start=1):
        found = height_integral(order, jnp.asarray(rows[:, 0]))
        np.testing.assert_allclose(found, rows[:, column], rtol=2e-6)


@pytest.mark.parametrize("order", [0.5, 1.5, 2.5])
def test_far_inside_the_integral_is_the_moment_of_a_point(order):
    """F_n(l) -> |l|^n (1 + n (n-1)/(2 l^2)) as l -> -infinity."""
    l = -1e4
    leading = abs(l) ** order * (1.0 + order * (order - 1.0) / (2.0 * l * l))
    assert float(height_integral(order, l)) == pytest.approx(leading, rel=1e-12)


@pytest.mark.parametrize("order", ORDERS)
def test_far_apart_the_integral_vanishes_without_becoming_negative(order):
    values = np.asarray(height_integral(order, jnp.asarray([20.0, 38.0, 60.0, 1e4])))
    assert np.all(values >= 0.0)
    assert values[-1] == 0.0
    assert values[0] < 1e-80


def test_second_derivative_follows_too():
    curvature = jax.vmap(jax.grad(jax.grad(lambda l: height_integral(1.5, l))))
    l = jnp.asarray([-3.0, -1.0, 0.0, 2.0, 6.0])
    np.testing.assert_allclose(curvature(l), 0.75 * height_integral(-0.5, l), rtol=1e-11)


def test_order_of_minus_one_or_less_is_refused():
    with pytest.raises(ValueError, match="order"):
        height_integral(-1.0, 0.0)


GROUPS = ((0.0, 1.0, 2.5), (-0.5,), (1.5, 0.0))


def alone(x):
    """Each order of each group by itself."""
    return jnp.stack([height_integral(n, x[k]) for k, group in enumerate(GROUPS) for n in group])


def test_orders_at_shared_places_are_those_alone_with_two_derivatives():
    x = jnp.asarray([[0.3, -2.0], [1.7, -0.4], [-0.9, 6.0]])
    change = jnp.asarray([[1.0, -0.5], [0.3, 2.0], [-1.0, 0.7]])

    def derivatives(function):
        def first(x):
            return jax.jvp(function, (x,), (change,))[1]

        return jax.jit(lambda x: (function(x), *jax.jvp(first, (x,), (change,))))(x)

    pairs = zip(derivatives(lambda x: integrals_at(GROUPS, x)), derivatives(alone), strict=True)
    for together, one_by_one in pairs:
        np.testing.assert_allclose(together, one_by_one, rtol=1e-12)


def test_derivatives_pass_a_loop_over_batches_of_shared_places():
    """JAX takes the batch axis of the derivative to be where the value has its own."""
    places = jnp.linspace(-2.0, 3.0, 12).reshape(4, 3)

    def total(shift, function):
        rows = jax.lax.map(jax.vmap(lambda p: function(shift + p * jnp.ones(3))), places)
        return jnp.sum(rows**2)

    def slope(function):
        return float(jax.jit(jax.grad(lambda shift: total(shift, function)))(0.1))

    assert slope(lambda x: integrals_at(GROUPS, x)) == pytest.approx(slope(alone), rel=1e-12)
