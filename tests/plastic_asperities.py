"""Many asperities that yield, and their means at many separations: what tests of them share."""

from math import pi, radians, sqrt

import equinox as eqx
import numpy as np
import pytest

from asperity._jax import jnp
from asperity.interface.plastic_interface import PlasticInterface
from asperity.laws import Dmt, Meniscus
from asperity.laws.law import Sum
from asperity.laws.plastic import KogutEtsion
from asperity.surfaces.heights import Gaussian

BETA, E, NU, SIGMA, N = 2.5e-7, 5e9, 0.3, 4e-9, 1e14
ATTRACTION = (
    E * sqrt(SIGMA / BETA) * SIGMA
)  # of adhesion against elasticity, times the next [J/m^2]
DMT, MENISCUS = Dmt(BETA, 0.02 * ATTRACTION), Meniscus(BETA, 0.0728, radians(40.0), 1.3e-9)
BESIDE = {"alone": Sum(()), "dmt": Sum((DMT,)), "dmt + meniscus": DMT + MENISCUS}
REACH = float(MENISCUS.interaction_range)
YIELD = [0.003, 0.3, 30.0]  # rms
BATCH = 16

every_law = pytest.mark.parametrize("beside", BESIDE)
every_sum = pytest.mark.parametrize(
    ("beside", "integrated"), [("alone", 0), *(("dmt + meniscus", n) for n in (0, 1))]
)
every_yield = pytest.mark.parametrize("overlap", YIELD)


def hardness(overlap):
    """Of a Kogut-Etsion contact that yields at this overlap, in rms [Pa]."""
    strain = 0.5 * pi * (0.454 + 0.41 * NU)
    return E / strain * sqrt(overlap * SIGMA / BETA)


def asperities(beside, overlap, rms=SIGMA):
    contact = KogutEtsion(BETA, E, hardness(overlap), NU)
    return PlasticInterface(contact, BESIDE[beside], Gaussian(rms), N)


@eqx.filter_jit
def _compiled(interface, separation, memory, integrated):
    return interface.measure(separation, memory, integrated)


def measured(interface, separation, memory, integrated=0, call=_compiled):
    """Means at many separations, in batches of one shape: compiled once for each law."""
    h = np.asarray(separation, float)
    rows = [np.broadcast_to(b, h.shape) for b in memory]
    parts = []
    for first in range(0, h.size, BATCH):
        pick = np.minimum(np.arange(first, first + BATCH), h.size - 1)
        batch = call(interface, jnp.asarray(h[pick]), tuple(jnp.asarray(b[pick]) for b in rows),
                     integrated)  # fmt: skip
        parts.append([np.asarray(x)[..., : h.size - first] for x in batch])
    return type(batch)(*(np.concatenate(x, axis=-1) for x in zip(*parts, strict=True)))


def after(interface, *places):
    """The memory after these reversals."""
    memory = interface.initial_memory()
    for h in places:
        memory = interface.remember(memory, jnp.asarray(h))
    return memory


def worst(found, exact, floor=1e-9, sizes=None):
    """Largest error over the sizes, or over ``floor`` times the largest size if that is more."""
    found, exact = np.asarray(found), np.asarray(exact)
    sizes = np.abs(exact if sizes is None else np.asarray(sizes))
    scale = np.maximum(sizes, floor * np.max(sizes, initial=0.0))
    return float(np.max(np.abs(found - exact) / np.where(scale > 0.0, scale, 1.0), initial=0.0))
