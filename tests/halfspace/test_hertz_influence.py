"""Displacement beside a Hertz contact: Johnson's ratios, and the integral over its pressure."""

import numpy as np
import pytest

from asperity._jax import jnp
from asperity.halfspace import hertz_influence


@pytest.mark.parametrize(("radii", "ratio"), [(1.0, 1.178), (2.0, 1.027), (3.0, 1.012)])
def test_it_is_johnsons_share_of_a_point_load(radii, ratio):
    """Johnson (1985), below eq. 3.42a."""
    found = float(hertz_influence(jnp.asarray(radii * 2e-8), jnp.asarray(2e-8)))
    assert found * np.pi * radii * 2e-8 == pytest.approx(ratio, abs=5e-4)


@pytest.mark.parametrize("distance", [0.3, 0.9999, 1.4, 9.0, 11.0])
def test_it_is_the_integral_of_point_loads(distance):
    """Over rings of the pressure; that of a ring is (2/pi) K(m)/(r + s) for each newton."""
    from scipy.integrate import quad
    from scipy.special import ellipkm1

    def ring(s):
        pressure = 1.5 / np.pi * np.sqrt(1.0 - s * s)
        complement = ((distance - s) / (distance + s)) ** 2
        return 4.0 / np.pi * s * pressure / (distance + s) * ellipkm1(complement)

    inner = [distance] if distance < 1.0 else None
    whole = quad(ring, 0.0, 1.0, points=inner, epsrel=1e-11)[0]
    found = float(hertz_influence(jnp.asarray(distance), jnp.asarray(1.0)))
    assert found == pytest.approx(whole, rel=1e-9)


def test_a_point_load_has_no_radius():
    found = hertz_influence(jnp.asarray([1e-7, 3e-7]), jnp.asarray(0.0))
    np.testing.assert_allclose(found, [1e7 / np.pi, 1e7 / 3.0 / np.pi], rtol=1e-14)
