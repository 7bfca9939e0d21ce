"""From a case to its physical quantities, against formulas written out here."""

from math import cos, inf, log, pi, radians

import pytest

import asperity
from asperity.config import builtin
from asperity.errors import InputError
from asperity.materials import LIQUIDS, SOLIDS

SILICA, CARBIDE = SOLIDS["silica"], SOLIDS["silicon carbide"]
BASE = builtin("published-exact")


def resolved(**changes):
    return asperity.resolve(BASE.replace({key.replace("__", "."): v for key, v in changes.items()}))


def test_the_quantities_of_the_publication_by_their_formulas():
    found = asperity.resolve("published-exact")
    soft, hard = ((1.0 - s.poisson**2) / s.youngs_modulus for s in (SILICA, CARBIDE))
    assert found.modulus == pytest.approx(1.0 / (soft + hard), rel=1e-15)
    assert found.mass == pytest.approx(SILICA.density * 4.0 / 3.0 * pi * found.radius**3, rel=1e-15)
    assert (found.body, found.counterface) == (SILICA, CARBIDE)
    air, water = BASE.capillary, LIQUIDS["water"].at(BASE.capillary.temperature)
    vapour = 8.31446261815324 * air.temperature * abs(log(air.humidity))
    assert found.kelvin_radius == pytest.approx(water.tension * water.molar_volume / vapour)
    assert found.liquid_radius == found.kelvin_radius
    span = 2.0 * found.kelvin_radius * cos(air.contact_angle)
    assert found.liquid_span == pytest.approx(span, rel=1e-15)
    assert found.tip_radius == found.asperities.asperity_radius
    assert found.surface_rms_height == found.asperities.rms_height


def test_an_adsorbed_film_bounds_the_liquid():
    found = resolved(
        capillary__humidity=1, capillary__adsorbed_film_thickness="1 nm", capillary__contact_angle=0
    )
    assert found.kelvin_radius == inf
    assert found.liquid_radius == pytest.approx(1e-9)
    assert found.liquid_span == pytest.approx(2e-9)


def test_dry_air_is_a_structure_without_liquid():
    dry, none = resolved(capillary__humidity=0), resolved(capillary__model="none")
    off = resolved(
        capillary__model="none",
        capillary__adsorbed_film_thickness="1 nm",
        capillary__contact_angle="120 deg",
        capillary__formation_time="1 us",
    )
    assert dry.structure == none.structure == off.structure
    for found in (dry, none, off):
        assert (found.liquid, found.kelvin_radius, found.liquid_radius) == (None, 0.0, 0.0)
        assert (found.liquid_span, found.formation_time) == (0.0, 0.0)


def test_cases_that_differ_in_numbers_alone_are_of_one_structure():
    one, other = resolved(), resolved(body__radius="20 um", capillary__humidity=0.3)
    assert hash(one.structure) == hash(other.structure)
    assert one.structure == other.structure
    assert resolved(counterface__deformation="rigid").structure != one.structure
    film = {"viscosity": "18 uPa s", "slip_length": "75 nm"}
    assert resolved(gas=film).structure != one.structure


@pytest.mark.parametrize(("work", "law"), [("0.1 mJ/m^2", "bradley"), ("20 mJ/m^2", "maugis")])
def test_the_structure_names_the_law_that_auto_chose(work, law):
    found = asperity.resolve(
        asperity.load("glass-bead").replace({"adhesion.model": "auto", "adhesion.work": work})
    )
    assert found.structure.adhesion == law
    assert found.adhesion_reason is not None


def test_what_a_solver_asks_of_inputs():
    found = resolved(gas={"viscosity": "18 uPa s", "slip_length": "75 nm"}, waves__model="hunter")
    assert found.gas.cutoff_separation == found.asperities.rms_height
    still = found.without_motion()
    assert (still.release, still.gas, still.structure.waves) == (None, None, False)
    assert found.without_motion().structure == resolved(waves=None).structure
    first = found.one_impact()
    assert (first.tolerance.max_impacts, first.tolerance.time_limit) == (1, inf)
    assert first.tolerance.relative == found.tolerance.relative


def test_a_body_without_a_release_has_none_and_one_with_a_speed_alone_leaves_it_open():
    assert resolved(impact=None).release is None
    launched = resolved(impact={"speed": "1 m/s"})
    assert launched.chosen_release
    assert launched.release.speed == 1.0
    assert not resolved().chosen_release


def test_what_is_no_case_is_refused():
    with pytest.raises(InputError, match="glass-bead"):
        asperity.resolve("glas-bead")


def test_the_contact_angle_is_in_radians():
    assert resolved(capillary__contact_angle="20 deg").contact_angle == radians(20.0)


def test_a_model_that_is_off_leaves_its_numbers_without_effect():
    off = resolved(adhesion__model="none")
    assert BASE.adhesion.work > 0.0
    assert (off.work_of_adhesion, off.structure.adhesion) == (0.0, "none")
    hard = {"model": "none", "hardness": "1 GPa"}
    assert resolved(plasticity=hard).yielding == resolved().yielding
    assert not resolved(plasticity=hard).strength_given


def test_a_law_of_yielding_uses_the_strength_that_is_given():
    soft = {"model": "kogut-etsion", "hardness": "1 GPa"}
    found = resolved(plasticity=soft, counterface__deformation="rigid")
    assert (found.yields, found.strength_given, found.yielding.hardness) == (True, True, 1e9)
    assert found.elastic().structure == resolved(counterface__deformation="rigid").structure
    assert found.plasticity_allowed
    assert not resolved().plasticity_allowed  # on a half-space
