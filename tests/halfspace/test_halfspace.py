"""Displacement of an elastic half-space under pressures whose answer is known."""

from math import erf, pi, sqrt

import numpy as np
import pytest
from scipy.special import ellipe

from asperity.halfspace import ring_mesh


def hertz_displacement(r):
    """Under sqrt(1 - r^2), times E* (Johnson 1985, eqs. 3.41a and 3.42a)."""
    inside = pi / 4.0 * (2.0 - np.minimum(r, 1.0) ** 2)
    far = np.maximum(r, 1.0)
    outside = 0.5 * ((2.0 - far**2) * np.arcsin(1.0 / far) + np.sqrt(far**2 - 1.0))
    return np.where(r < 1.0, inside, outside)


def disc(mesh):
    return np.where(mesh.radius < 1.0, 1.0, 0.0)


def at_axis(mesh, pressure):
    """Displacement at the axis, times E*."""
    return mesh.axis @ (mesh.compliance @ pressure)


def test_rings_carry_the_load_of_their_pressure():
    mesh = ring_mesh(96)
    pressure = np.exp(-2.5 * mesh.radius**2)  # as wide as the mesh of a Gaussian contact
    assert mesh.area @ pressure == pytest.approx(pi / 2.5, rel=1e-8)
    assert mesh.area @ disc(mesh) == pytest.approx(pi, rel=1e-13)


def test_uniform_pressure_sinks_the_centre_by_two_p_a_over_the_modulus():
    mesh = ring_mesh(96)
    assert at_axis(mesh, disc(mesh)) == pytest.approx(2.0, rel=1e-11)


def test_uniform_pressure_displaces_by_the_elliptic_integral():
    """u = (4/pi) E(r^2) inside, -> (1/2)/r far outside (Johnson 1985, eqs. 3.29)."""
    mesh = ring_mesh(96)
    found = mesh.compliance @ disc(mesh)
    inside = mesh.radius < 1.0
    exact = 4.0 / pi * ellipe(mesh.radius[inside] ** 2)
    np.testing.assert_allclose(found[inside], exact, rtol=1e-10)


@pytest.mark.parametrize(("rings", "bound"), [(96, 1e-5), (192, 1e-6)])
def test_hertz_pressure_gives_the_hertz_displacement(rings, bound):
    mesh = ring_mesh(rings)
    pressure = np.sqrt(np.maximum(1.0 - mesh.radius**2, 0.0))
    found = mesh.compliance @ pressure
    np.testing.assert_allclose(found, hertz_displacement(mesh.radius), rtol=bound)
    assert at_axis(mesh, pressure) == pytest.approx(pi / 2.0, rel=bound)


def gaussian_error(rings):
    """Of the displacement at the axis under exp(-r^2), sqrt(pi)/E* on an endless mesh."""
    mesh = ring_mesh(rings)
    exact = sqrt(pi) * erf(mesh.end)
    return abs(at_axis(mesh, np.exp(-(mesh.radius**2))) / exact - 1.0)


def test_smooth_pressure_converges_with_a_high_order():
    coarse, fine = gaussian_error(32), gaussian_error(64)
    assert np.log2(coarse / fine) > 3.5
    assert gaussian_error(96) < 1e-6
    assert gaussian_error(192) < 1e-9


def test_far_displacement_is_that_of_a_point_load():
    """u -> load / (pi E* r)."""
    mesh = ring_mesh(96)
    pressure = np.exp(-4.0 * mesh.radius**2)
    load, far = mesh.area @ pressure, mesh.radius[-1]
    correction = 1.0 + 0.25 * 0.25 / far**2
    exact = load / (pi * far) * correction
    assert mesh.compliance[-1] @ pressure == pytest.approx(exact, rel=1e-3)


def test_displacements_are_reciprocal():
    """Betti: the work of one pressure on another's displacement is mutual."""
    mesh = ring_mesh(96)
    one, other = np.exp(-(mesh.radius**2)), mesh.radius**2 * np.exp(-2.0 * mesh.radius**2)
    there = (mesh.area * one) @ (mesh.compliance @ other)
    back = (mesh.area * other) @ (mesh.compliance @ one)
    assert there == pytest.approx(back, rel=1e-7)


def test_stored_energy_is_positive_for_any_pressure():
    mesh = ring_mesh(48)
    for seed in range(20):
        pressure = np.random.default_rng(seed).standard_normal(len(mesh.radius))
        assert (mesh.area * pressure) @ (mesh.compliance @ pressure) > 0.0
