"""What holds of every pull, whatever the numbers: roughness, contact angle, humidity."""

from functools import cache
from math import pi, radians

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from asperity._jax import jax, jnp
from asperity.interface.interface import Interface
from asperity.laws import (
    Bradley,
    ByContact,
    ByKelvinGap,
    ConstantVolume,
    Dmt,
    Hertz,
    Jkr,
    KelvinFilling,
    Maugis,
    Meniscus,
)
from asperity.materials.liquids import LIQUIDS, kelvin_radius
from asperity.surfaces.heights import Gaussian

BETA, E, W, EPS = 50e-9, 50e9, 0.05, 0.3e-9
WATER = LIQUIDS["water"].at(293.15)
STEPS = np.linspace(-6.0, 8.0, 241)

some_rms = st.floats(-1.5, 1.5).map(lambda power: 10.0**power)
an_angle = st.floats(0.0, 85.0)
a_humidity = st.floats(0.1, 0.97)


@jax.jit
def pull_off(law, rms, interaction_range):
    """Largest mean pull per asperity [N] on the way out, over separations."""
    plane = Interface(law, Gaussian(rms), 1.0)
    h = STEPS * jnp.maximum(rms, interaction_range)
    return -jnp.min(plane.pressure(h, plane.saturated_memory(h)))


LAWS = {
    "dmt": (lambda: Hertz(BETA, E) + Dmt(BETA, W), 2.0 * pi * BETA * W),
    "bradley": (lambda: Hertz(BETA, E) + Bradley(BETA, W, EPS), 2.0 * pi * BETA * W),
    "jkr": (lambda: Jkr(BETA, E, W), 1.5 * pi * BETA * W),
    "maugis": (lambda: Maugis(BETA, E, W, EPS), 2.0 * pi * BETA * W),
    "meniscus": (
        lambda: Hertz(BETA, E) + Meniscus(BETA, 0.0728, 0.5, 1e-9),
        4.0 * pi * BETA * 0.0728 * np.cos(0.5),
    ),
    "bridge": (
        lambda: Hertz(BETA, E) + ConstantVolume(BETA, 0.0728, 0.5, 1e-9),
        4.0 * pi * BETA * 0.0728 * np.cos(0.5),
    ),
}


made = cache(lambda name: LAWS[name][0]())


@pytest.mark.parametrize("name", LAWS)
@settings(max_examples=15)
@given(rms=some_rms)
def test_roughness_never_raises_the_pull_off_of_an_asperity(name, rms):
    """The mean over heights of a force never exceeds its extreme."""
    found = float(pull_off(made(name), rms * 1e-9, 2e-9))
    assert found <= LAWS[name][1] * (1.0 + 1e-9)


FORMATIONS = {"contact": ByContact(), "kelvin": ByKelvinGap()}


@jax.jit
def pressures(law, rms, density):
    plane = Interface(law, Gaussian(rms), density)
    h = STEPS * rms
    return plane.pressure(h, plane.saturated_memory(h))


def filling(angle, humidity, formation):
    radius = kelvin_radius(WATER, humidity, 293.15)
    return KelvinFilling(WATER.tension, radians(angle), radius, FORMATIONS[formation])


def meniscus(angle, humidity, formation):
    radius = kelvin_radius(WATER, humidity, 293.15)
    return Meniscus(BETA, WATER.tension, radians(angle), radius, FORMATIONS[formation])


@pytest.mark.parametrize("liquid", [filling, meniscus])
@pytest.mark.parametrize("formation", FORMATIONS)
@settings(max_examples=20)
@given(first=an_angle, second=an_angle, humidity=a_humidity)
def test_a_larger_contact_angle_never_pulls_more(liquid, formation, first, second, humidity):
    small, large = sorted((first, second))
    more = pressures(liquid(small, humidity, formation), 3e-9, 1.0)
    less = pressures(liquid(large, humidity, formation), 3e-9, 1.0)
    rounding = 1e-12 * float(jnp.max(jnp.abs(more)))
    assert np.all(np.asarray(less) >= np.asarray(more) - rounding)


@pytest.mark.parametrize("liquid", [filling, meniscus])
@settings(max_examples=40)
@given(first=a_humidity, second=a_humidity, angle=an_angle)
def test_more_humidity_never_shortens_the_range(liquid, first, second, angle):
    dry, humid = sorted((first, second))
    assert float(liquid(angle, humid, "contact").interaction_range) >= float(
        liquid(angle, dry, "contact").interaction_range
    )
