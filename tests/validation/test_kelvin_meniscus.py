"""Menisci of the humid air: Kelvin radius, capillary force and its mean over heights."""

from math import cos, pi, radians

import numpy as np
import pytest

from asperity._jax import jnp
from asperity.interface.interface import Interface
from asperity.laws import ByKelvinGap, Meniscus
from asperity.materials.liquids import Liquid, kelvin_radius
from asperity.surfaces.heights import Gaussian
from figures import Figure, misses

WATER = Liquid("water", tension=0.075, molar_volume=1.805e-5, source="the publication's Table 1")
ANGLE = radians(73.0)


RADII = {0.5: 0.801, 0.9: 5.27, 0.99: 55.3}  # nm
HUMIDITIES = (0.3, 0.6, 0.95)


def radius(humidity):
    found = kelvin_radius(WATER, humidity, 293.15) * 1e9
    problem, source = f"Kelvin radius of water, {humidity:.0%} humidity", "Kelvin's equation, apart"
    return Figure(problem, source, RADII[humidity], found, "nm", 1e-3)


def touch(humidity):
    r_k = kelvin_radius(WATER, humidity, 293.15)
    found = float(Meniscus(50e-6, 0.075, ANGLE, r_k, ByKelvinGap()).force(jnp.asarray(0.0)))
    problem = f"meniscus at touch, {humidity:.0%} humidity"
    known = -4.0 * pi * 50e-6 * 0.075 * cos(ANGLE)
    return Figure(problem, "-4 pi R gamma cos(angle)", known, found, "N", 1e-13)


def work():
    law = Meniscus(50e-6, 0.075, ANGLE, 1e-9)
    found = float(-law.bonded_force(jnp.asarray(0.0))) / (2.0 * pi * 50e-6)
    problem = "meniscus: work of wet separation"
    return Figure(problem, "2 gamma cos(angle)", 2.0 * 0.075 * cos(ANGLE), found, "J/m^2", 1e-13)


def figures():
    return [*map(radius, RADII), *map(touch, HUMIDITIES), work()]


def test_known_figures_are_met():
    assert misses(figures()) == []


@pytest.mark.parametrize("humidity", HUMIDITIES)
def test_range_of_the_capillary_force_depends_on_humidity(humidity):
    """Zero at the Kelvin gap 2 r_k cos(theta)."""
    r_k = kelvin_radius(WATER, humidity, 293.15)
    law = Meniscus(50e-6, 0.075, ANGLE, r_k, ByKelvinGap())
    assert float(law.interaction_range) == pytest.approx(2.0 * r_k * cos(ANGLE), rel=1e-14)
    assert float(law.force(law.interaction_range * 1.000001)) == 0.0


def banded(h, sigma, density, law, bands):
    """The publication's eqs. 13-15 with the asperities that touch, heights in bands."""
    c, pull = float(law.interaction_range), float(law.pull)
    edges = np.linspace(0.0, c, bands + 1)
    gap = 0.5 * (edges[:-1] + edges[1:])
    phi = np.exp(-0.5 * ((h - gap) / sigma) ** 2) / (np.sqrt(2.0 * pi) * sigma)
    node, weight = np.polynomial.legendre.leggauss(80)
    deep = 0.5 * 9.0 * (node + 1.0) * sigma
    inside = np.exp(-0.5 * ((h + deep) / sigma) ** 2) / (np.sqrt(2.0 * pi) * sigma)
    contacting = 4.5 * sigma * np.sum(weight * inside)
    return -density * pull * (np.sum(phi * (1.0 - gap / c)) * c / bands + contacting)


@pytest.mark.parametrize("reduced", [0.0, 2.0, 4.37])
def test_banded_sum_tends_to_the_integral_with_second_order(reduced):
    sigma, density = 10.5e-9, 1.69e16
    law = Meniscus(0.25e-9, 0.075, ANGLE, 5.27e-9, ByKelvinGap())
    exact = float(
        Interface(law, Gaussian(sigma), density).pressure(jnp.asarray(reduced * sigma), ())
    )
    h = reduced * sigma
    errors = [abs(banded(h, sigma, density, law, n) / exact - 1.0) for n in (4, 8, 16)]
    assert errors[0] / errors[1] == pytest.approx(4.0, rel=0.1)
    assert errors[1] / errors[2] == pytest.approx(4.0, rel=0.1)
    assert banded(h, sigma, density, law, 20_000) == pytest.approx(exact, rel=1e-9)
