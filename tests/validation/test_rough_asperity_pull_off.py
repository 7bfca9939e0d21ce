"""Pull-off of a plane with Gaussian asperity heights: JKR and DMT asperities."""

from math import pi

import equinox as eqx

from asperity.interface.interface import Interface
from asperity.laws import Dmt, Hertz, Jkr
from asperity.surfaces.heights import Gaussian
from figures import Figure, misses
from validation.known import largest_pull, rows

ROWS = rows("rough_asperity_pull_off", 6, 8, dtype=None, encoding="utf8")
RADIUS, E, W = 1e-6, 5e9, 0.05


@eqx.filter_jit
def pressures(interface, separations, memory):
    return interface.pressure(separations, memory)


def largest_tension(interface, sigma, span, torn):
    """Of one asperity's mean force [N]."""
    memory = interface.saturated_memory() if torn else interface.initial_memory()
    low, high = -3.0 * sigma - 6.0 * span, 8.0 * sigma + 3.0 * span
    return largest_pull(lambda h: pressures(interface, h, memory), low, high)


NAMES = {
    "gw_jkr_unloading": ("JKR asperities after contact", "1.5 pi w beta"),
    "gw_jkr_loading": ("JKR asperities on approach", "1.5 pi w beta"),
    "gw_dmt": ("DMT asperities", "2 pi w beta"),
}


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


def test_known_figures_are_met():
    assert misses(figures()) == []
