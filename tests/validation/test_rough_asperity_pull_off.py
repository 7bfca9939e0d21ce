"""Pull-off of a plane with Gaussian asperity heights: JKR and DMT asperities."""

from functools import cache
from math import pi
from pathlib import Path

import equinox as eqx
import numpy as np
import pytest

from asperity._jax import jnp
from asperity.interface.interface import Interface
from asperity.laws import Dmt, Hertz, Jkr
from asperity.surfaces.heights import Gaussian
from figures import Figure

FILE = Path(__file__).parent.parent / "data" / "rough_asperity_pull_off.csv"
ROWS = np.genfromtxt(FILE, delimiter=",", comments="#", skip_header=6, dtype=None, encoding="utf8")
RADIUS, E, W = 1e-6, 5e9, 0.05


@eqx.filter_jit
def pressures(interface, separations, memory):
    return interface.pressure(separations, memory)


def largest_tension(interface, sigma, span, torn):
    """Of one asperity's mean force [N], by two grids, the second around the first's minimum."""
    memory = interface.saturated_memory() if torn else interface.initial_memory()
    low, high = -3.0 * sigma - 6.0 * span, 8.0 * sigma + 3.0 * span
    for _ in range(3):
        h = np.linspace(low, high, 601)
        p = np.asarray(pressures(interface, jnp.asarray(h), memory))
        k = int(np.argmin(p))
        low, high = h[max(k - 1, 0)], h[min(k + 1, 600)]
    return -float(p.min())


NAMES = {
    "gw_jkr_unloading": ("JKR asperities after contact", "1.5 pi w beta"),
    "gw_jkr_loading": ("JKR asperities on approach", "1.5 pi w beta"),
    "gw_dmt": ("DMT asperities", "2 pi w beta"),
}


@cache
def figure(model, roughness, ratio):
    if model == "gw_dmt":
        span = (RADIUS * W**2 / E**2) ** (1.0 / 3.0)
        law, unit = Hertz(RADIUS, E) + Dmt(RADIUS, W), 2.0 * pi * W * RADIUS
    else:
        span = 0.75 * (pi**2 * W**2 * RADIUS / E**2) ** (1.0 / 3.0)
        law, unit = Jkr(RADIUS, E, W), 1.5 * pi * W * RADIUS
    sigma = roughness * span
    interface = Interface(law, Gaussian(sigma), 1.0)
    found = largest_tension(interface, sigma, span, torn=model == "gw_jkr_unloading") / unit
    name, scale = NAMES[model]
    problem = f"rough plane, {name}, reduced rms {roughness:g}: pull-off of each over {scale}"
    return Figure(problem, "independent quadrature", ratio, found, "", 1e-4)


def figures():
    return [figure(*row) for row in ROWS.tolist()]


@pytest.mark.parametrize("row", ROWS.tolist(), ids=str)
def test_pull_off_per_asperity(row):
    assert figure(*row).holds


def test_all_ratios_are_read():
    assert len(ROWS) == 8
