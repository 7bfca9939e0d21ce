"""Materials: the publication's modulus, the Kelvin radius, and sources that can be recomputed."""

import dataclasses
import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from asperity.errors import InputError
from asperity.materials import (
    AVOGADRO,
    LIQUIDS,
    SOLIDS,
    Liquid,
    Solid,
    contact_modulus,
    kelvin_radius,
    water_density,
    water_tension,
)

WATER = LIQUIDS["water"]
PUBLISHED_WATER = dataclasses.replace(WATER, tension=75e-3, molar_volume=1.805e-5)

moduli = st.floats(1e3, 1e13)
ratios = st.floats(-0.99, 0.5)
solids = st.builds(Solid, st.just("any"), moduli, ratios)


def test_table_1_gives_a_contact_modulus_of_56_814_gpa():
    modulus = contact_modulus(SOLIDS["silica"], SOLIDS["silicon carbide"])
    assert modulus == pytest.approx(56.814e9, rel=1e-5)


@given(solids, solids)
def test_the_contact_modulus_is_symmetric_and_below_both_plane_strain_moduli(a, b):
    modulus = contact_modulus(a, b)
    assert modulus == pytest.approx(contact_modulus(b, a))
    for solid in (a, b):
        assert modulus <= solid.youngs_modulus / (1 - solid.poisson**2) * (1 + 1e-12)


@given(moduli, ratios)
def test_against_a_rigid_solid_the_contact_modulus_is_the_plane_strain_modulus(modulus, ratio):
    rigid = Solid("rigid", 1e300, 0.0)
    alone = contact_modulus(Solid("any", modulus, ratio), rigid)
    assert alone == pytest.approx(modulus / (1 - ratio**2))


@pytest.mark.parametrize(
    ("humidity", "radius"), [(0.50, 0.801e-9), (0.90, 5.27e-9), (0.99, 55.3e-9)]
)
def test_the_kelvin_radius_of_water_at_75_mn_per_m(humidity, radius):
    # Computed from gamma V_m/(R T ln(1/RH)) at 293.15 K with V_m = 1.805e-5 m^3/mol.
    assert kelvin_radius(PUBLISHED_WATER, humidity, 293.15) == pytest.approx(radius, rel=1e-3)


def test_dry_air_has_no_kelvin_radius():
    assert kelvin_radius(WATER, 0.0, 293.15) == 0.0


@given(st.floats(1e-6, 1 - 1e-9), st.floats(1e-6, 1 - 1e-9))
def test_the_kelvin_radius_grows_with_humidity(a, b):
    low, high = sorted((a, b))
    assert 0.0 < kelvin_radius(WATER, low, 293.15) <= kelvin_radius(WATER, high, 293.15)


@given(st.floats(1e-3, 0.999))
def test_the_kelvin_radius_gives_back_its_humidity(humidity):
    radius = kelvin_radius(WATER, humidity, 293.15)
    exponent = WATER.tension * WATER.molar_volume / (8.31446261815324 * 293.15 * radius)
    assert math.exp(-exponent) == pytest.approx(humidity, rel=1e-12)


@pytest.mark.parametrize("humidity", [1.0, 1.2, -0.1, math.nan])
def test_a_humidity_outside_zero_to_one_is_refused(humidity):
    with pytest.raises(InputError, match=r"`humidity` must lie in \[0, 1\)"):
        kelvin_radius(WATER, humidity, 293.15)


def test_a_temperature_that_is_not_positive_is_refused():
    with pytest.raises(InputError, match="`temperature` must be positive"):
        kelvin_radius(WATER, 0.5, 0.0)


@pytest.mark.parametrize(
    ("celsius", "tension"), [(0.01, 75.65), (20, 72.74), (50, 67.94), (100, 58.91)]
)
def test_the_tension_of_water_is_that_of_the_iapws_release(celsius, tension):
    # IAPWS R1-76(2014), table 1 [mN/m].
    assert round(water_tension(273.15 + celsius) * 1e3, 2) == tension


@pytest.mark.parametrize(
    ("celsius", "density"), [(3.98, 999.972), (25, 997.045), (40, 992.21), (100, 958.36)]
)
def test_the_density_of_water_is_kells(celsius, density):
    # Kell, J. Chem. Eng. Data 20, 97 (1975) [kg/m^3].
    assert water_density(273.15 + celsius) == pytest.approx(density, abs=0.006)


def test_the_molar_volume_of_water_at_20_celsius():
    assert WATER.molar_volume == pytest.approx(1.805e-5, rel=3e-4)
    warm = WATER.at(333.15)
    assert warm.molar_volume * warm.density == pytest.approx(WATER.molar_volume * WATER.density)


@pytest.mark.parametrize("liquid", LIQUIDS.values(), ids=list(LIQUIDS))
def test_the_catalogues_tension_is_its_laws_at_20_celsius(liquid):
    assert liquid.at(293.15).tension == liquid.tension
    assert liquid.at(313.15).tension < liquid.tension
    with pytest.raises(InputError, match="`temperature` must lie in"):
        liquid.at(1000.0)


@pytest.mark.parametrize(
    ("name", "celsius", "tension"),
    [("ethanol", 25, 21.97), ("n-octane", 25, 21.14), ("toluene", 25, 27.93),
     ("n-hexadecane", 25, 27.05), ("ethanol", 30, 21.55)],
)  # fmt: skip
def test_the_tension_of_organic_liquids_is_the_crc_handbooks(name, celsius, tension):
    assert LIQUIDS[name].at(273.15 + celsius).tension == pytest.approx(tension * 1e-3, abs=1e-5)


def test_a_liquid_without_laws_is_the_same_at_any_temperature():
    oil = Liquid("oil", tension=0.03, molar_volume=3e-4)
    assert oil.at(350.0) == oil


@pytest.mark.parametrize("liquid", LIQUIDS.values(), ids=list(LIQUIDS))
def test_a_molecule_is_about_as_large_as_its_volume(liquid):
    side = (liquid.molar_volume / AVOGADRO) ** (1 / 3)
    assert liquid.molecule_size == pytest.approx(side, rel=0.11)


@pytest.mark.parametrize("name", [*SOLIDS, *LIQUIDS])
def test_everything_in_the_catalogue_has_its_name_and_source(name):
    thing = SOLIDS.get(name) or LIQUIDS[name]
    assert thing.name == name
    assert len(thing.source) > 15
    assert thing.density


def test_sapphire_is_the_mean_of_its_crystals_constants():
    # Wachtman et al., J. Res. NBS 64A, 213 (1960) [GPa]; Voigt and Reuss, halved.
    c11, c33, c44, c12, c13, c14 = 496.8, 498.1, 147.4, 163.6, 110.9, -23.5
    stiffness = np.diag([c11, c11, c33, c44, c44, (c11 - c12) / 2])
    for i, j, value in [
        (0, 1, c12), (0, 2, c13), (1, 2, c13), (0, 3, c14), (1, 3, -c14), (4, 5, c14),
    ]:  # fmt: skip
        stiffness[i, j] = stiffness[j, i] = value
    compliance = np.linalg.inv(stiffness)

    def sums(matrix):
        normal, cross = matrix[:3, :3].trace(), matrix[0, 1] + matrix[0, 2] + matrix[1, 2]
        return normal, cross, matrix[3:, 3:].trace()

    a, b, c = sums(stiffness)
    p, q, r = sums(compliance)
    bulk = ((a + 2 * b) / 9 + 1 / (p + 2 * q)) / 2
    shear = ((a - b + 3 * c) / 15 + 15 / (4 * p - 4 * q + 3 * r)) / 2
    youngs = 9 * bulk * shear / (3 * bulk + shear)
    assert SOLIDS["sapphire"].youngs_modulus == pytest.approx(youngs * 1e9, rel=2e-3)
    assert SOLIDS["sapphire"].poisson == pytest.approx(youngs / (2 * shear) - 1, abs=1e-3)


def test_sapphires_density_is_that_of_its_unit_cell():
    volume = math.sqrt(3) / 2 * 0.4758e-9**2 * 1.2991e-9
    density = 6 * 101.961e-3 / AVOGADRO / volume
    assert SOLIDS["sapphire"].density == pytest.approx(density, rel=1e-3)


@pytest.mark.parametrize(
    ("numbers", "rule"),
    [
        ({"youngs_modulus": 0.0, "poisson": 0.2}, "`youngs_modulus` must be positive"),
        ({"youngs_modulus": math.nan, "poisson": 0.2}, "`youngs_modulus` must be positive"),
        ({"youngs_modulus": 1e9, "poisson": 0.7}, r"`poisson` must lie in \(-1, 0.5\]; got 0.7"),
        ({"youngs_modulus": 1e9, "poisson": -1.0}, "`poisson` must lie in"),
        ({"youngs_modulus": 1e9, "poisson": 0.2, "density": -1.0}, "`density` must be positive"),
        ({"youngs_modulus": 1e9, "poisson": 0.2, "hardness": 0.0}, "`hardness` must be positive"),
        (
            {"youngs_modulus": 1e9, "poisson": 0.2, "yield_strength": 0.0},
            "`yield_strength` must be positive",
        ),
        (
            {"youngs_modulus": 1e9, "poisson": 0.2, "hardness": 1e8, "yield_strength": 2e8},
            r"`hardness` must be at least the yield strength \(200 MPa\).*; got 100 MPa",
        ),
    ],
)
def test_a_solid_that_cannot_be_is_refused(numbers, rule):
    with pytest.raises(InputError, match=rule):
        Solid("any", **numbers)


def test_a_liquid_without_tension_is_refused():
    with pytest.raises(InputError, match="`tension` must be positive"):
        Liquid("any", tension=0.0, molar_volume=1e-5)
