"""Liquid in every narrow gap: the smooth sphere at any humidity, and the work of separation."""

from math import cos, pi, radians

import numpy as np
import pytest
from scipy.stats import norm

from asperity._jax import jnp
from asperity.contact import RigidContact
from asperity.contact.profile import Sphere
from asperity.interface.interface import Interface
from asperity.laws import ByContact, ByKelvinGap, KelvinFilling, Meniscus
from asperity.surfaces.heights import Gaussian
from figures import Figure, misses

RADIUS, TENSION, ANGLE = 10e-6, 0.0728, radians(30.0)
KELVIN = (0.3e-9, 1e-9, 10e-9, 100e-9)
ATTRACTION = 4.0 * pi * RADIUS * TENSION * cos(ANGLE)


def filling(kelvin_radius, formation=None):
    return KelvinFilling(TENSION, ANGLE, kelvin_radius, formation or ByKelvinGap())


def on_surface(kelvin_radius, rms, formation=None):
    return Interface(filling(kelvin_radius, formation), Gaussian(rms), 1.0)


def figures():
    """The largest pull of a nearly smooth sphere, and the work that parts unit area."""
    rows = []
    for radius in KELVIN:
        rms = 1e-4 * radius
        contact = RigidContact(on_surface(radius, rms), Sphere(RADIUS))
        depths = jnp.linspace(-8.0, 8.0, 65) * rms
        force = np.array([float(contact.state(d, contact.initial_memory()).force) for d in depths])
        source = "4 pi R gamma cos(angle): Derjaguin; Israelachvili (2011), ch. 17"
        name = f"pull of a filled gap, Kelvin radius {radius * 1e9:g} nm"
        rows.append(Figure(name, source, ATTRACTION, -force.min(), "N", 2e-3))
        plane = on_surface(radius, rms)
        touch = jnp.asarray(-20.0 * rms)
        work = -float(plane.energy(touch, plane.saturated_memory()))
        expected = 2.0 * TENSION * cos(ANGLE)
        name = f"work of wet separation, Kelvin radius {radius * 1e9:g} nm"
        rows.append(Figure(name, "2 gamma cos(angle)", expected, work, "J/m^2", 1e-12))
    return rows


def test_known_figures_are_met():
    assert misses(figures()) == []


@pytest.mark.parametrize("formation", [ByContact(), ByKelvinGap()])
def test_a_smooth_sphere_has_the_meniscus_of_the_equilibrium_law(formation):
    """The integral over the sphere is eq. 12 with the sphere's radius."""
    law = Meniscus(RADIUS, TENSION, ANGLE, 2e-9, formation)
    contact = RigidContact(on_surface(2e-9, 1e-14, formation), Sphere(RADIUS))
    bonded = contact.branches()[-1]
    for gap in np.array([0.1, 0.4, 0.9, 1.2]) * float(law.interaction_range):
        gap = jnp.asarray(gap)
        found = contact.state(gap, bonded)
        assert float(found.force) == pytest.approx(
            float(law.bonded_force(gap)), rel=1e-4, abs=1e-15
        )
        assert float(found.stored) == pytest.approx(
            float(law.bonded_energy(gap)), rel=2e-4, abs=1e-24
        )


@pytest.mark.parametrize("reduced", [-1.0, 0.5, 2.0, 4.0])
def test_the_tension_acts_on_the_share_of_places_below_the_kelvin_gap(reduced):
    rms, radius = 3e-9, 2e-9
    separation = reduced * rms
    span = 2.0 * radius * cos(ANGLE)
    share = norm.cdf(separation / rms) - norm.cdf((separation - span) / rms)
    plane = on_surface(radius, rms)
    found = float(plane.pressure(jnp.asarray(separation), plane.initial_memory()))
    assert found == pytest.approx(-TENSION / radius * share, rel=1e-12)


def test_more_humidity_reaches_further():
    interaction_range = [float(filling(radius).interaction_range) for radius in KELVIN]
    assert interaction_range == sorted(interaction_range)


def test_filling_by_contact_loses_what_filling_at_the_kelvin_gap_does_not():
    """Area between the branches: per area 2 gamma cos(angle) for places that have touched."""
    law = filling(2e-9, ByContact())
    lost = float(law.formation_loss + law.rupture_loss)
    assert lost == pytest.approx(2.0 * TENSION * cos(ANGLE), rel=1e-14)
    free = filling(2e-9)
    assert float(free.formation_loss + free.rupture_loss) == 0.0
