"""Materials: the publication's modulus, the Kelvin radius, and sources that can be recomputed."""

import dataclasses
import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from asperity.config import load
from asperity.config.resolve import resolve
from asperity.errors import InputError
from asperity.laws.plastic import ThorntonNing
from asperity.materials.liquids import (
    AVOGADRO,
    LIQUIDS,
    Liquid,
    kelvin_radius,
    water_density,
    water_tension,
)
from asperity.materials.solids import ADHESION, SOLIDS, Adhesion, Solid, contact_modulus

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


@given(st.floats(1e-3, 0.999))
def test_the_kelvin_radius_gives_back_its_humidity(humidity):
    radius = kelvin_radius(WATER, humidity, 293.15)
    assert radius > kelvin_radius(WATER, 0.0, 293.15) == 0.0
    exponent = WATER.tension * WATER.molar_volume / (8.31446261815324 * 293.15 * radius)
    assert math.exp(-exponent) == pytest.approx(humidity, rel=1e-12)


def test_a_humidity_or_a_temperature_that_cannot_be_is_refused():
    for humidity in (1.0, 1.2, -0.1, math.nan):
        with pytest.raises(InputError, match=r"`humidity` must lie in \[0, 1\)"):
            kelvin_radius(WATER, humidity, 293.15)
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


@pytest.mark.parametrize("solid", SOLIDS.values(), ids=list(SOLIDS))
def test_every_solid_has_a_strength_or_says_why_it_never_yields(solid):
    assert (solid.hardness or solid.yield_strength) or solid.never_yields
    assert not ((solid.hardness or solid.yield_strength) and solid.never_yields)
    for key in ("hardness", "yield_strength"):
        assert getattr(solid, key) is None or key.replace("_", " ") in solid.source


@pytest.mark.parametrize("solid", SOLIDS.values(), ids=list(SOLIDS))
def test_the_numbers_of_a_solid_are_possible(solid):
    """No dense solid is stiffer than diamond, as dense as osmium, or as strong as its bonds."""
    assert 1e5 < solid.youngs_modulus < 1050e9
    assert 0.0 <= solid.poisson <= 0.5
    assert 900.0 < solid.density < 22590.0
    hardness = solid.hardness or 2.8 * (solid.yield_strength or 0.0)
    assert hardness < 0.15 * solid.youngs_modulus
    if solid.hardness and solid.yield_strength:
        assert 1.3 < solid.hardness / solid.yield_strength < 4.0


def on_itself(name):
    """Text of a case of a sphere on a plane of one material."""
    return (
        f'[body]\nradius = "1 um"\nmaterial = "{name}"\n[counterface]\nmaterial = "{name}"\n'
        '[impact]\nspeed = "1 m/s"\n'
    )


@pytest.mark.parametrize("name", SOLIDS)
def test_a_case_can_name_every_solid(name):
    assert resolve(load(on_itself(name))).body == SOLIDS[name]


def test_the_catalogue_has_what_tribologists_ask_for():
    assert set(SOLIDS) >= {
        "stainless steel 304", "stainless steel 440C", "bearing steel 52100", "aluminium", "copper",
        "nickel", "platinum", "ruthenium", "titanium nitride", "silicon nitride", "alumina", "mica",
        "PMMA", "PDMS", "SU-8", "nylon 6,6", "polystyrene",
    }  # fmt: skip


def test_two_bearing_steels_have_the_modulus_of_their_lubrication():
    """228 GPa for twice the contact modulus: Hamrock and Dowson, ASME J. Lubr. Tech. 99 (1977)."""
    steel = SOLIDS["bearing steel 52100"]
    assert 2.0 * contact_modulus(steel, steel) == pytest.approx(228e9, rel=0.06)


def crystal(upper):
    """Stiffness matrix of a crystal by its upper triangle."""
    stiffness = np.zeros((6, 6))
    for (i, j), value in upper.items():
        stiffness[i, j] = stiffness[j, i] = value
    return stiffness


def averaged(stiffness):
    """Young's modulus and Poisson's ratio of many grains: the mean of Voigt and Reuss."""

    def sums(matrix):
        normal, cross = matrix[:3, :3].trace(), matrix[0, 1] + matrix[0, 2] + matrix[1, 2]
        return normal, cross, matrix[3:, 3:].trace()

    a, b, c = sums(stiffness)
    p, q, r = sums(np.linalg.inv(stiffness))
    bulk = ((a + 2 * b) / 9 + 1 / (p + 2 * q)) / 2
    shear = ((a - b + 3 * c) / 15 + 15 / (4 * p - 4 * q + 3 * r)) / 2
    youngs = 9 * bulk * shear / (3 * bulk + shear)
    return youngs, youngs / (2 * shear) - 1


def hexagonal(c11, c33, c44, c12, c13, c14=0.0):
    """Stiffnesses of a hexagonal crystal; with ``c14`` of a trigonal one."""
    return crystal({
        (0, 0): c11, (1, 1): c11, (2, 2): c33, (3, 3): c44, (4, 4): c44,
        (5, 5): (c11 - c12) / 2, (0, 1): c12, (0, 2): c13, (1, 2): c13,
        (0, 3): c14, (1, 3): -c14, (4, 5): c14,
    })  # fmt: skip


# Wachtman et al. (1960), Fisher and Dever (1967), Kim et al. (1992) [GPa].
SAPPHIRE = hexagonal(496.8, 498.1, 147.4, 163.6, 110.9, -23.5)
RUTHENIUM = hexagonal(562.6, 624.2, 180.6, 187.8, 168.2)
NITRIDE = crystal(
    {(i, j): 625.0 if i == j else 165.0 for i in range(3) for j in range(i, 3)}
    | {(i, i): 163.0 for i in range(3, 6)}
)


@pytest.mark.parametrize(
    ("name", "stiffness"),
    [("sapphire", SAPPHIRE), ("ruthenium", RUTHENIUM), ("titanium nitride", NITRIDE)],
)
def test_a_polycrystal_is_the_mean_of_its_crystals_constants(name, stiffness):
    youngs, poisson = averaged(stiffness)
    assert SOLIDS[name].youngs_modulus == pytest.approx(youngs * 1e9, rel=2e-3)
    assert SOLIDS[name].poisson == pytest.approx(poisson, abs=1e-3)


@pytest.mark.parametrize(
    ("name", "mass", "volume"),
    [
        ("sapphire", 6 * 101.961e-3, math.sqrt(3) / 2 * 0.4758e-9**2 * 1.2991e-9),
        ("ruthenium", 2 * 101.07e-3, math.sqrt(3) / 2 * 0.27058e-9**2 * 0.42816e-9),
        ("titanium nitride", 4 * 61.874e-3, 0.42417e-9**3),
    ],
)
def test_a_crystals_density_is_that_of_its_unit_cell(name, mass, volume):
    assert SOLIDS[name].density == pytest.approx(mass / AVOGADRO / volume, rel=1e-3)


def test_mica_is_as_stiff_to_a_press_on_its_cleavage_as_its_crystal():
    """Vaughan and Guggenheim (1986) [GPa], sheets taken as hexagonal."""

    def pressed(c11, c33, c44, c13):
        # Delafargue and Ulm (2004), eq. 26: exact along the axis of symmetry.
        both = math.sqrt(c11 * c33)
        square = (c11 * c33 - c13**2) / c11 / (1 / c44 + 2 / (both + c13))
        return 2.0 * math.sqrt(square)

    assert pressed(3.0, 3.0, 1.0, 1.0) == pytest.approx(4.0 * 2.0 / 3.0)
    mica = SOLIDS["mica"]
    modulus = pressed((181.0 + 178.4) / 2, 58.6, (16.5 + 19.5) / 2, (25.6 + 21.2) / 2)
    assert mica.youngs_modulus / (1 - mica.poisson**2) == pytest.approx(modulus * 1e9, rel=2e-3)


def rebound(strength, speed):
    """Restitution of a polystyrene sphere on silica, Thornton and Ning (1998), closed form."""
    body, flat = SOLIDS["polystyrene"], SOLIDS["silica"]
    radius = 10e-6
    law = ThorntonNing(radius, contact_modulus(body, flat), 1.61 * strength)
    mass = 4.0 / 3.0 * math.pi * radius**3 * body.density
    ratio = math.sqrt(2.0 * float(law.loading_work(law.yield_overlap)) / mass) / speed
    part = ratio / (ratio + 2.0 * math.sqrt(6.0 / 5.0 - ratio**2 / 5.0))
    return math.sqrt(6.0 * math.sqrt(3.0) / 5.0 * (1.0 - ratio**2 / 6.0)) * part**0.25


def test_polystyrene_says_what_the_strain_rate_of_an_impact_does_to_it():
    """Eyring: k T ln 10 over the activation volume, in shear; sqrt(3) times that in tension."""
    decade = 1.380649e-23 * 293.15 * math.log(10.0) / 1.1e-27 * math.sqrt(3.0)
    assert decade == pytest.approx(15e6, rel=0.03)
    slow = SOLIDS["polystyrene"].yield_strength
    assert slow + 7.0 * decade == pytest.approx(150e6, rel=0.03)  # from 1e-3 to 1e4 1/s
    assert slow + 9.0 * decade == pytest.approx(180e6, rel=0.03)
    assert "150 to 180 MPa" in SOLIDS["polystyrene"].source
    assert rebound(slow, 10.0) == pytest.approx(0.475, abs=1e-3)
    assert rebound(150e6, 10.0) == pytest.approx(0.92, abs=5e-3)
    assert rebound(180e6, 10.0) == pytest.approx(0.98, abs=5e-3)


@pytest.mark.parametrize("entry", ADHESION, ids=lambda entry: "-".join(entry.pair))
def test_a_measured_work_of_adhesion_names_its_pair_its_environment_and_its_source(entry):
    beyond = {"diamond", "glass", "natural rubber", "water ice"}
    assert set(entry.pair) <= {*SOLIDS, *beyond}
    assert 1e-3 < entry.work < 10.0
    assert entry.environment
    assert entry.method
    assert any(f"({year})" in entry.source for year in range(1971, 2026))
    assert entry.bounds is None or len(entry.bounds) == 2


def measured(first, second, environment):
    """A measured work of adhesion."""
    return next(
        entry
        for entry in ADHESION
        if entry.pair == (first, second) and environment in entry.environment
    )


def test_the_work_of_mica_gives_the_pull_off_that_was_measured():
    """1.2 to 1.6 N/m over the radius of crossed cylinders (Christenson 1993), by JKR."""
    low, high = (1.5 * math.pi * work for work in measured("mica", "mica", "dry").bounds)
    assert (low, high) == (pytest.approx(1.2, rel=0.03), pytest.approx(1.6, rel=0.03))


def test_the_work_of_wet_cantilevers_is_twice_the_tension_of_water():
    assert measured("silicon", "silicon", "100 %").work == pytest.approx(
        2 * WATER.tension, rel=0.02
    )


def test_no_case_assumes_a_work_of_adhesion_that_was_measured():
    case = load(on_itself("mica"))
    assert (case.adhesion.model, case.adhesion.work) == ("none", None)
    with pytest.raises(InputError, match="work"):
        load(on_itself("mica") + '[adhesion]\nmodel = "jkr"\n')


@pytest.mark.parametrize(("work", "bounds"), [(0.0, None), (0.1, (0.2, 0.3)), (0.1, (0.0, 0.2))])
def test_a_work_that_cannot_have_been_measured_is_refused(work, bounds):
    with pytest.raises(InputError):
        Adhesion(("mica", "mica"), work, "air", "pull-off", "nobody", bounds)


@pytest.mark.parametrize(
    ("numbers", "rule"),
    [
        ({"youngs_modulus": 0.0}, "`youngs_modulus` must be positive"),
        ({"youngs_modulus": math.nan}, "`youngs_modulus` must be positive"),
        ({"poisson": 0.7}, r"`poisson` must lie in \(-1, 0.5\]; got 0.7"),
        ({"poisson": -1.0}, "`poisson` must lie in"),
        ({"density": -1.0}, "`density` must be positive"),
        ({"hardness": 0.0}, "`hardness` must be positive"),
        ({"yield_strength": 0.0}, "`yield_strength` must be positive"),
        (
            {"hardness": 1e8, "yield_strength": 2e8},
            r"at least the yield strength \(200 MPa\).*; got",
        ),
    ],
)
def test_a_solid_that_cannot_be_is_refused(numbers, rule):
    with pytest.raises(InputError, match=rule):
        Solid("any", **{"youngs_modulus": 1e9, "poisson": 0.2, **numbers})


def test_a_liquid_without_tension_is_refused():
    with pytest.raises(InputError, match="`tension` must be positive"):
        Liquid("any", tension=0.0, molar_volume=1e-5)
