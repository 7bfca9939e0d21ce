"""Equilibria under the Lennard-Jones pressure: both branches, their jumps and their limits."""

from math import pi

import numpy as np
import pytest
from tools.lennard_jones import Contact, panels

import asperity
from asperity._jax import jax, jnp
from asperity.config import load
from asperity.config.limits import LENNARD_JONES
from asperity.errors import InputError
from asperity.halfspace import mesh_on
from asperity.laws import Bradley, Jkr, LennardJones
from asperity.laws.lennard_jones_equilibria import _measures_at, solved
from asperity.laws.lennard_jones_path import TABOR_NUMBERS, largest_gap, smallest_gap
from asperity.laws.testing import check_law
from chosen import long_but

R, W, EPS = 1e-6, 0.05, 3e-10  # m, J/m^2, m


def law_of(tabor):
    return LennardJones(R, W * (R / (tabor * EPS) ** 3) ** 0.5, W, EPS)


@pytest.mark.long
@pytest.mark.parametrize("tabor", [0.6, 1.2])
def test_it_is_a_law(tabor):
    check_law(law_of(tabor))


@pytest.mark.parametrize("tabor", long_but([0.2, 1.1, 3.7], 1.1))
def test_the_table_is_what_another_mesh_finds(tabor):
    """At measures where few steps lead, and at Tabor numbers between those of the table."""
    law = law_of(tabor)
    found = Contact(tabor, mesh_on(panels(1e-3, 2.0, 0.04), 7)).follow(
        np.array([-6.0, -2.5, 3.0, 5.0])
    )
    for (gap, force, _, energy), bonded in zip(found, (False, False, True, True), strict=True):
        place = jnp.asarray((gap - 1.0) * EPS)
        here = law.bonded_force(place) if bonded else law.force(place)
        stored = law.bonded_energy(place) if bonded else law.energy(place)
        assert float(here) / (W * R) == pytest.approx(force, rel=2e-5, abs=2e-5)
        assert float(stored) / (W * R * EPS) == pytest.approx(energy, rel=2e-5, abs=2e-5)


@pytest.mark.parametrize("tabor", [0.2, 1.1])
def test_equilibria_have_the_gaps_that_they_were_asked_for(tabor):
    """All of many, near folds and far; one in 10,000 was off by 1e-5 of its gap."""
    path, folds = solved(jnp.log(tabor))
    away = np.random.default_rng(1).uniform(np.log(1e-9), np.log(1e3), 40_000)
    first, last = float(folds.inwards[0]), float(folds.outwards[0])
    outer = np.clip(first + np.exp(away), first, largest_gap())
    inner = np.clip(last - np.exp(away), smallest_gap(), last)
    gaps = jnp.stack([jnp.asarray(outer), jnp.asarray(inner)])
    found, _ = path.gap(_measures_at(gaps, path, folds))
    np.testing.assert_allclose(found, gaps, rtol=1e-10, atol=1e-10)


def test_a_stiff_sphere_pulls_as_a_rigid_one():
    law, rigid = law_of(0.01), Bradley(R, W, EPS)
    gap = jnp.asarray(np.geomspace(1e-11, 1e-8, 20))
    bonded = gap < law.forming_gap
    force = jnp.where(bonded, law.bonded_force(gap), law.force(gap))
    np.testing.assert_allclose(force, rigid.force(gap), rtol=5e-3)


def test_a_soft_sphere_tends_to_jkr():
    law = law_of(5.0)
    soft = Jkr(R, law.modulus, W)
    gap = jnp.asarray([-300.0, -1000.0]) * EPS
    np.testing.assert_allclose(law.bonded_force(gap), soft.bonded_force(gap), rtol=0.02)


def test_hysteresis_begins_at_a_tabor_number_near_1():
    """Greenwood (1997) and Feng (2000) found the curve S-shaped from about 1 on; here 0.695."""
    laws = [law_of(tabor) for tabor in (0.5, 0.69, 0.7, 1.0)]
    lost = [float((law.formation_loss + law.rupture_loss) / (W * R * EPS)) for law in laws]
    assert lost[:2] == [0.0, 0.0]
    assert 0.0 < lost[2] < 1e-4
    assert lost[3] == pytest.approx(0.25, abs=0.01)


@pytest.mark.parametrize("tabor", [0.3, 3.0])
def test_the_energy_over_the_gap_adds_up(tabor):
    """From the fold, within the table, across its end at 484 spacings and beyond."""
    law = law_of(tabor)
    first = float(law.forming_gap)
    node, weight = np.polynomial.legendre.leggauss(200)
    t = 0.5 * (node + 1.0)
    for low, high in ((first, first + 1e-10), (1e-9, 2e-9), (1e-7, 2e-7), (2e-7, 1e-6)):
        gap = jnp.asarray(low + (high - low) * t * t)  # a square root at the fold
        area = jnp.sum(law.energy(gap) * (high - low) * t * weight)
        change = law.energy_beyond(jnp.asarray(low)) - law.energy_beyond(jnp.asarray(high))
        assert float(change) == pytest.approx(float(area), rel=1e-8)
    for place in (first + 1e-12, 1e-9, 1e-7, 1e-6):
        slope = jax.grad(law.energy_beyond)(place)
        assert float(slope) == pytest.approx(-float(law.energy(jnp.asarray(place))), rel=1e-9)


@pytest.mark.parametrize("tabor", [1.2, 2.0, 5.0])
def test_the_area_between_the_branches_is_what_both_jumps_lose(tabor):
    law = law_of(tabor)
    first, last = float(law.forming_gap), float(law.breaking_gap)
    node, weight = np.polynomial.legendre.leggauss(60)
    angle = 0.25 * pi * (node + 1.0)  # both ends are square roots
    gap = jnp.asarray(first + (last - first) * np.sin(angle) ** 2)
    width = (last - first) * np.sin(2.0 * angle) * 0.25 * pi * weight
    area = float(jnp.sum(width * (law.force(gap) - law.bonded_force(gap))))
    assert area == pytest.approx(float(law.formation_loss + law.rupture_loss), rel=1e-6)


def test_derivatives_are_those_of_differences():
    def force(modulus):
        return LennardJones(R, modulus, W, EPS).bonded_force(jnp.asarray(-2e-9))

    def lost(modulus):
        law = LennardJones(R, modulus, W, EPS)
        return law.formation_loss + law.rupture_loss

    at = float(law_of(2.2).modulus)
    for one in (force, lost):
        slope = (one(at * 1.0005) - one(at * 0.9995)) / (0.001 * at)
        assert float(jax.grad(one)(at)) == pytest.approx(float(slope), rel=1e-4)


CASE = """
schema = 1
[body]
radius = "1 um"
youngs_modulus = "{modulus} GPa"
poisson = 0.2
density = "2200 kg/m^3"
[counterface]
youngs_modulus = "{modulus} GPa"
poisson = 0.2
deformation = "half-space"
[impact]
speed = "0.5 m/s"
gravity = "0 m/s^2"
[adhesion]
model = "lennard-jones"
work = "50 mJ/m^2"
equilibrium_spacing = "0.3 nm"
"""
ROUGHNESS = """
[roughness]
asperity_density = "2e13 1/m^2"
asperity_radius = "50 nm"
rms_height = "2 nm"
"""


def test_an_impact_loses_what_both_jumps_lose():
    case = load(CASE.format(modulus=6.0))
    result = asperity.solve(case, critical=False)
    law = LennardJones(R, asperity.resolve(case).modulus, W, EPS)
    energy = result.ledger["initial"]
    lost = float(law.formation_loss + law.rupture_loss)
    assert result.ledger["energy_balance_error"] < 1e-8
    assert result.ledger["lost"]["adhesion"] == pytest.approx(lost, rel=1e-9)
    restitution = result.measures["restitution"][0]
    assert restitution == pytest.approx((1.0 - lost / energy) ** 0.5, rel=1e-7)
    assert 0.1 < restitution < 0.99


def test_tabor_numbers_beside_the_table_are_refused_with_another_law():
    assert tuple(TABOR_NUMBERS[[0, -1]]) == LENNARD_JONES
    with pytest.raises(InputError, match="take 'maugis' or 'jkr'") as soft:
        load(CASE.format(modulus=0.6))
    assert soft.value.key == "adhesion.model"
    with pytest.raises(InputError, match="where asperities adhere") as bulk:
        load(CASE.format(modulus=6.0) + ROUGHNESS)
    assert bulk.value.key == "counterface.deformation"
    load(CASE.format(modulus=6.0).replace('"half-space"', '"rigid"') + ROUGHNESS)
    with pytest.raises(InputError, match="take 'bradley' or 'dmt'"):
        load(CASE.format(modulus=90000.0))
