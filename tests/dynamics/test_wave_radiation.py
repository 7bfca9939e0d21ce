"""What a force on a half-space radiates: Lamb's problem beside other roads to its answer."""

import numpy as np
import pytest
from scipy.integrate import quad, solve_ivp
from scipy.optimize import brentq

from asperity._jax import jax
from asperity.dynamics.wave_radiation import (
    WaveRadiation,
    hertz_share,
    radiated,
    rayleigh_ratio,
    shear_speed,
)

RATIOS = (-0.5, 0.0, 0.25, 0.3, 0.45)


def _ratio(poisson):
    return (1.0 - 2.0 * poisson) / (2.0 - 2.0 * poisson)


@pytest.mark.parametrize("poisson", RATIOS)
def test_the_whole_is_lambs_integral_on_another_path(poisson):
    """Round the branch points and the pole at once, through the complex plane."""
    least = _ratio(poisson)

    def along(angle):
        s = 1.25 - 1.25 * np.cos(angle) + 0.5j * np.sin(angle)
        step = 1.25 * np.sin(angle) + 0.5j * np.cos(angle)
        # Both roots on the sheet on which waves leave, continued from the real axis.
        alpha, beta = (1j * np.sqrt(end - s * s) for end in (least, 1.0))
        whole = (2.0 * s * s - 1.0) ** 2 - 4.0 * s * s * alpha * beta
        return (s * alpha / whole * step).imag

    found = quad(along, 0.0, np.pi, epsabs=1e-12, limit=200)[0] / (2.0 * np.pi)
    assert float(radiated(poisson).whole) == pytest.approx(abs(found), rel=1e-9)


@pytest.mark.parametrize("poisson", RATIOS)
def test_the_rayleigh_wave_is_a_root(poisson):
    least = _ratio(poisson)

    def rayleigh(s):
        alpha, beta = np.sqrt(s * s - least), np.sqrt(s * s - 1.0)
        return (2.0 * s * s - 1.0) ** 2 - 4.0 * s * s * alpha * beta

    root = brentq(rayleigh, 1.0 + 1e-9, 3.0, xtol=1e-15)
    assert float(rayleigh_ratio(poisson)) == pytest.approx(1.0 / root, rel=1e-12)


def test_the_rayleigh_wave_at_a_ratio_of_a_quarter_is_known_in_closed_form():
    assert float(rayleigh_ratio(0.25)) == pytest.approx(np.sqrt(2.0 - 2.0 / 3.0**0.5), rel=1e-14)


def test_an_incompressible_half_space_carries_no_compression_waves():
    parts = radiated(0.5)
    assert float(parts.compression) == 0.0
    assert float(parts.whole) == pytest.approx(float(radiated(0.5 - 1e-9).whole), rel=1e-6)


def test_stiff_and_light_half_spaces_radiate_less():
    """As the root of the density and as the modulus to the power -3/2."""
    one = float(WaveRadiation.into(100e9, 0.3, 2500.0).coefficient)
    assert float(WaveRadiation.into(100e9, 0.3, 10000.0).coefficient) == pytest.approx(2.0 * one)
    assert float(WaveRadiation.into(400e9, 0.3, 2500.0).coefficient) == pytest.approx(one / 8.0)


def test_the_factor_has_a_gradient():
    whole = lambda nu: radiated(nu).whole  # noqa: E731
    step = 1e-5
    middle = (float(whole(0.2 + step)) - float(whole(0.2 - step))) / (2.0 * step)
    assert float(jax.grad(whole)(0.2)) == pytest.approx(middle, rel=1e-7)


def _hertz_in_time():
    """Integral of (dF/dt)^2 over a Hertz impact, in units of its mass, speed and depth."""
    stiffness = 1.25  # force F = 1.25 x^(3/2) stops a unit mass of unit speed at 1

    def rate(_, y):
        overlap = max(y[0], 0.0)
        slope = 1.5 * stiffness * overlap**0.5 * y[1]
        return [y[1], -stiffness * overlap**1.5, slope**2]

    def apart(_, y):
        return y[0] + 1e-14

    apart.terminal, apart.direction = True, -1.0
    found = solve_ivp(rate, (0.0, 4.0), [0.0, 1.0, 0.0], "DOP853", events=apart, rtol=1e-11,
                      atol=1e-13)  # fmt: skip
    return found.y[2, -1], found.t[-1]


def test_share_of_a_hertz_impact_is_that_of_its_force_in_time():
    modulus, radius, mass, speed = 40e9, 2e-6, 7e-14, 0.3
    radiation = WaveRadiation(3e-9)
    depth = (15.0 * mass * speed**2 / (16.0 * modulus * radius**0.5)) ** 0.4
    rates, _ = _hertz_in_time()
    whole = 3e-9 * rates * (mass * speed**2 / depth) ** 2 * speed / depth
    found = hertz_share(radiation, modulus, radius, mass, speed)
    assert found == pytest.approx(whole / (0.5 * mass * speed**2), rel=1e-8)


def test_hunters_constant_for_sphere_and_half_space_of_one_material():
    """Johnson (1985), section 11.4, quotes 1.04 (V/c_0)^(3/5), c_0 = sqrt(E/density).

    Hertz's own force gives 1.112 at a ratio of 0.25, a half-sine of its length and height 1.171.
    """
    young, poisson, density, radius, speed = 200e9, 0.25, 7800.0, 1e-3, 1e-3
    modulus = young / (2.0 * (1.0 - poisson**2))
    mass = density * 4.0 / 3.0 * np.pi * radius**3
    radiation = WaveRadiation.into(young, poisson, density)
    share = hertz_share(radiation, modulus, radius, mass, speed)
    constant = share / (speed / np.sqrt(young / density)) ** 0.6
    assert constant == pytest.approx(1.04, rel=0.08)
    rates, time = _hertz_in_time()
    sine = 1.25**2 * np.pi**2 / (2.0 * time)
    assert constant == pytest.approx(1.1115, abs=1e-4)
    assert constant * sine / rates == pytest.approx(1.171, abs=1e-3)


def test_a_crossing_time_is_that_of_the_contacts_radius():
    """The coefficient times the stiffness 2 E* a of a contact: 0.79 a/c_s on a rigid body."""
    young, poisson, density, half = 70e9, 0.25, 2500.0, 1e-6
    stiffness = 2.0 * young / (1.0 - poisson**2) * half
    time = float(WaveRadiation.into(young, poisson, density).coefficient) * stiffness
    crossing = half / float(shear_speed(young, poisson, density))
    assert time == pytest.approx(0.79 * crossing, rel=1e-3)


def test_changes_within_the_crossing_time_are_cut_off():
    radiation, stiffness = WaveRadiation(1e-10), np.array(10.0)
    slow = float(radiation.drag(stiffness, np.array(1e3), np.array(1.0)))
    assert slow == pytest.approx(1e-8, rel=1e-9)
    assert float(radiation.drag(stiffness, np.array(1e10), np.array(1.0))) == pytest.approx(5e-9)
