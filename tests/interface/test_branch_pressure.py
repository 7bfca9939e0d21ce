"""The tabulated means of a branch are those of the planes, and go on beyond its ends."""

import numpy as np
import pytest

from asperity._jax import jax, jnp
from asperity.interface.branch_pressure import BranchPressure
from asperity.interface.interface import Interface
from asperity.laws import Bradley, Hertz, Maugis
from asperity.surfaces.heights import Gaussian

RMS, R, E, W, EPS = 2e-9, 5e-7, 3e10, 0.05, 3e-10
PLANES = {
    "bonds": Interface(Maugis(R, E, W, EPS), Gaussian(RMS), 1e12),
    "no bonds": Interface(Hertz(R, E) + Bradley(R, W, EPS), Gaussian(RMS), 1e12),
}


def _measured(one, places, memory):
    found = one.measure(places, memory)
    return found.energy, found.bonds, found.contacting


@pytest.mark.parametrize(
    ("name", "threshold"), [("bonds", np.inf), ("bonds", -np.inf), ("no bonds", np.inf)]
)
def test_it_is_that_of_the_planes(name, threshold):
    planes = PLANES[name]
    memory = tuple(jnp.asarray(threshold) for _ in planes.mechanisms)
    reach = float(planes.interaction_range) + 8.0 * RMS
    ends = 8.0 * RMS * jnp.sinh(jnp.linspace(-1.0, np.arcsinh(reach / (8.0 * RMS)), 33))
    table = BranchPressure(planes, memory, ends)
    places = jnp.linspace(ends[0], min(reach, 20.0 * RMS), 203)
    each = tuple(jnp.broadcast_to(b, places.shape) for b in memory)
    pressure, measure = jax.jit(lambda one, h, b: one.pressure(h, b)), jax.jit(_measured)
    exact = pressure(planes, places, each)
    scale = float(jnp.max(jnp.abs(exact[places > 0.0])))
    np.testing.assert_allclose(pressure(table, places, each), exact, rtol=1e-9, atol=1e-9 * scale)
    outside = jnp.asarray([ends[0] - 1e-12, 2.0 * ends[-1]])
    beyond = pressure(planes, outside, tuple(jnp.broadcast_to(b, (2,)) for b in memory))
    np.testing.assert_allclose(pressure(table, outside, each), beyond, rtol=1e-2, atol=1e-9 * scale)
    both = (measure(one, places, each) for one in (table, planes))
    for read, known in zip(*both, strict=True):
        size = float(jnp.max(jnp.abs(known))) if known.size else 0.0
        np.testing.assert_allclose(read, known, rtol=1e-9, atol=1e-9 * size)
    assert float(table.error) < 1e-9
