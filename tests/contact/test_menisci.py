"""Menisci that keep their volume, liquid on the surface, and which regime is which."""

from math import cos, pi, radians

import numpy as np
import pytest
from scipy.integrate import simpson

import asperity
from asperity import InputError
from asperity._jax import jax, jnp
from asperity.config.resolve import resolve
from asperity.contact import RigidContact, SmoothContact
from asperity.contact.profile import Sphere
from asperity.dynamics import Body, quasi_static, simulate
from asperity.errors import ENDS, Outcome, Tolerance
from asperity.interface.interface import Interface
from asperity.interface.layers import Layers
from asperity.laws import (
    ByContact,
    ByKelvinGap,
    ConstantVolume,
    Dmt,
    Hertz,
    KelvinFilling,
    Meniscus,
)
from asperity.laws.liquid import bridge
from asperity.laws.testing import check_law
from asperity.model import build
from asperity.regimes.liquid_regime import liquid_state
from asperity.results.measures import measure
from asperity.surfaces.heights import Gaussian
from chosen import long_but

ANGLE, TENSION, RADIUS = radians(40.0), 0.0728, 20e-9
SMALL = ConstantVolume(RADIUS, TENSION, ANGLE, 0.4e-9)
THIN = ConstantVolume(RADIUS, TENSION, ANGLE, 0.4e-9, edge=False)
FILLING = KelvinFilling(TENSION, ANGLE, 1e-9)
ASPERITIES = Interface(Hertz(0.25e-9, 56.8e9) + Dmt(0.25e-9, 0.03), Gaussian(10.5e-9), 1.69e16)


CONDENSED = ConstantVolume(RADIUS, TENSION, ANGLE, 0.4e-9, ByKelvinGap(), edge=False)


@pytest.mark.parametrize("law", [SMALL, CONDENSED], ids=["edge", "condensed"])
def test_a_bridge_of_constant_volume_is_a_law(law):
    check_law(law)


@pytest.mark.parametrize("formation", [ByContact(), ByKelvinGap()])
def test_a_filled_gap_is_a_law_per_area(formation):
    """Its force is a pressure: tension counts as a force per length of the other axis."""
    law = KelvinFilling(TENSION, ANGLE, 1e-9, formation)
    check_law(law, dimensions={"tension": (1.0, 1.0)})


def test_a_bridge_forms_with_the_volume_of_the_meniscus_at_touch():
    """pi R c^2, c = 2 r_k cos(angle): without its edge it starts with the same force."""
    same = Meniscus(RADIUS, TENSION, ANGLE, 0.4e-9)
    assert float(SMALL.volume) == pytest.approx(
        pi * RADIUS * float(same.interaction_range) ** 2, rel=1e-14
    )
    touch = jnp.zeros(())
    assert float(THIN.bonded_force(touch)) == pytest.approx(float(same.bonded_force(touch)))


def test_a_bridge_loses_what_drawing_it_out_has_cost():
    gaps = jnp.linspace(0.0, float(SMALL.breaking_gap), 20001)
    work = float(jnp.trapezoid(-SMALL.bonded_force(gaps), gaps))
    assert float(SMALL.formation_loss) == 0.0
    assert float(SMALL.rupture_loss) == pytest.approx(work, rel=1e-6)


def test_a_condensed_bridge_begins_where_equilibrium_ends():
    """Force and energy go on at touch; it loses what equilibrium did not give on the way in."""
    touch = jnp.zeros(())
    assert float(CONDENSED.bonded_force(touch)) == pytest.approx(float(CONDENSED.force(touch)))
    assert float(CONDENSED.formation_loss) == pytest.approx(0.0, abs=1e-30)
    given = 2.0 * pi * RADIUS * TENSION * cos(ANGLE) * float(CONDENSED.height)
    spent = float(THIN.rupture_loss)
    assert float(CONDENSED.rupture_loss) == pytest.approx(spent - given, rel=1e-12)


def test_a_bridge_that_would_break_within_the_kelvin_gap_stays_in_equilibrium():
    """On a tip much smaller than the meniscus."""
    law = ConstantVolume(0.05e-9, TENSION, ANGLE, 5e-9, ByKelvinGap(), edge=False)
    assert not bool(law.keeps)
    gaps = jnp.linspace(-1e-9, 1.2 * float(law.height), 50)
    np.testing.assert_array_equal(law.bonded_force(gaps), law.force(gaps))
    assert float(law.formation_loss + law.rupture_loss) == 0.0
    assert float(law.breaking_gap) == float(law.height)


def test_a_bridge_of_constant_volume_reaches_further_than_one_in_equilibrium():
    """It cannot evaporate."""
    assert float(SMALL.breaking_gap) > 2.0 * float(SMALL.height)
    assert float(SMALL.breaking_gap) == pytest.approx(
        float(bridge.rupture_distance(SMALL.volume, RADIUS, ANGLE))
    )


def test_layers_add_up():
    surface = Interface(FILLING, Gaussian(12e-9), 1.0)
    both = Layers((ASPERITIES, surface))
    h = jnp.linspace(0.0, 6.0, 7) * 10.5e-9
    memory = both.saturated_memory()
    for lift in (0, 1):
        alone = [
            (ASPERITIES.pressure(h, (), lift), ASPERITIES.energy(h, (), lift)),
            (surface.pressure(h, memory, lift), surface.energy(h, memory, lift)),
        ]
        pressure, energy = (sum(pair) for pair in zip(*alone, strict=True))
        np.testing.assert_allclose(both.pressure(h, memory, lift), pressure, rtol=1e-13)
        np.testing.assert_allclose(both.energy(h, memory, lift), energy, rtol=1e-13)
        means = both.measure(h, memory, lift)
        np.testing.assert_allclose(means.parts.sum(axis=0), pressure, rtol=1e-12)
        contacting = ASPERITIES.measure(h, (), lift).contacting
        np.testing.assert_allclose(means.contacting, contacting, rtol=1e-14)


def test_layers_that_count_a_force_twice_are_refused():
    with pytest.raises(InputError, match="capillary force; it would count twice"):
        Layers((Interface(FILLING, Gaussian(1e-9), 1.0), Interface(FILLING, Gaussian(2e-9), 1.0)))


def test_a_conservative_filling_returns_all_energy():
    surface = KelvinFilling(TENSION, radians(85.0), 1e-9, ByKelvinGap())
    contact = RigidContact(
        Layers((ASPERITIES, Interface(surface, Gaussian(11e-9), 1.0))), Sphere(50e-6)
    )
    body = Body(2200.0 * 4.0 / 3.0 * pi * (50e-6) ** 3, 9.81, 200e-9)
    motion = jax.jit(lambda: simulate(contact, body, tolerance=Tolerance(max_impacts=2)))()
    assert ENDS[int(motion.end.outcome)] is Outcome.OSCILLATING
    measures = measure(motion, body)
    assert float(measures.restitution[0]) == pytest.approx(1.0, abs=1e-8)


def test_a_smooth_sphere_loses_one_bridge_an_impact():
    law = Hertz(5e-6, 50e9) + ConstantVolume(5e-6, TENSION, ANGLE, 1e-9)
    bridge_ = law.parts[1]
    mass = 2000.0 * 4.0 / 3.0 * pi * (5e-6) ** 3
    body = Body(mass, 0.0, 100e-9, 0.5)
    motion = jax.jit(
        lambda: simulate(SmoothContact(law), body, tolerance=Tolerance(max_impacts=1))
    )()
    assert ENDS[int(motion.end.outcome)] is Outcome.ESCAPED
    assert float(motion.impacts.lost[0, 0]) == pytest.approx(float(bridge_.rupture_loss), rel=1e-12)
    assert float(motion.impacts.energy_balance_error[0] / motion.impacts.maximum_kinetic[0]) < 1e-8


CASE = asperity.load("published-exact")
SURFACE = {"capillary.surface_rms_height": "11 nm"}
FILLED = {"capillary.model": "kelvin-filling", **SURFACE}


def regime_at(humidity, **changes):
    case = CASE.replace({"capillary.humidity": humidity, **changes})
    return liquid_state(resolve(case), central=40e-9)[0]


def test_regimes_follow_each_other_from_dry_to_flooded():
    """Menisci merge where the Kelvin radius reaches the spacing, 7.7 nm: at about 93 %."""
    thick = {"capillary.adsorbed_film_thickness": "50 nm"}
    found = [regime_at(humidity, **thick) for humidity in (0.0, 0.5, 0.9, 0.95, 0.999, 1.0)]
    assert found == ["dry", "pendular", "pendular", "coalesced", "flooded", "flooded"]
    assert [regime_at(humidity) for humidity in (0.92, 0.94)] == ["pendular", "coalesced"]


def test_a_film_bounds_what_menisci_span():
    case = CASE.replace({"capillary.humidity": 1.0, "capillary.adsorbed_film_thickness": "2 nm"})
    assert resolve(case).liquid_span == pytest.approx(4e-9)
    assert resolve(case).liquid_radius == pytest.approx(2e-9 / cos(radians(73.0)))
    dry = CASE.replace({"capillary.adsorbed_film_thickness": "2 nm"})
    assert resolve(dry).liquid_radius == pytest.approx(resolve(CASE).kelvin_radius)


@pytest.mark.parametrize(
    ("changes", "key", "message"),
    [
        ({"capillary.humidity": 1.0}, "capillary.humidity", "without an `adsorbed_film_thickness`"),
        ({"capillary.model": "kelvin-filling"}, "capillary.surface_rms_height", "must be given"),
        (SURFACE, "capillary.surface_rms_height", "'kelvin-filling' alone"),
        (
            {**FILLED, "roughness": None},
            "capillary.surface_rms_height",
            "must not be given for a smooth body",
        ),
    ],
)  # fmt: skip
def test_liquid_that_is_not_described_is_refused(changes, key, message):
    with pytest.raises(InputError, match=message) as caught:
        CASE.replace(changes)
    assert caught.value.key == key


def test_a_smooth_body_with_filled_gaps_has_one_meniscus():
    case = CASE.replace({"capillary.model": "kelvin-filling", "roughness": None})
    law = build(resolve(case)).contact.law
    assert any(isinstance(part, Meniscus) for part in law.parts)


def test_a_bridge_too_large_for_its_edge_is_taken_for_thin():
    """Volume over radius^3 is pi (c/radius)^2: 0.1 at c = 0.18 radius."""
    model = {"capillary.model": "constant-volume"}
    for radius, edge in (("0.25 nm", False), ("20 nm", True)):
        case = CASE.replace({**model, "roughness.asperity_radius": radius})
        assert build(resolve(case)).contact.interface.law.parts[-1].edge == edge


def test_no_humidity_is_dry():
    """Every model at a humidity of 0 gives the forces of the case without menisci."""
    dry = build(resolve(CASE.replace({"capillary.model": "none"}))).contact
    place = jnp.asarray(40e-9)
    expected = float(dry.state(place, dry.initial_memory()).force)
    for changes in (
        {},
        {"capillary.model": "constant-volume"},
        FILLED,
        {"capillary.formation": "capillary-condensation"},
    ):
        contact = build(resolve(CASE.replace({"capillary.humidity": 0.0, **changes}))).contact
        assert not contact.mechanisms
        assert float(contact.state(place, contact.initial_memory()).force) == expected


BRIDGES = {
    "capillary.model": "constant-volume",
    "roughness.asperity_radius": "20 nm",
    "roughness.asperity_density": "1e15 1/m^2",
}
AREAS = {
    "menisci": {},
    "bridges": BRIDGES,
    "condensed bridges": {**BRIDGES, "capillary.formation": "capillary-condensation"},
    "filling": FILLED,
    "maugis": {
        "capillary.model": "none",
        "adhesion.model": "maugis",
        "adhesion.work": "300 mJ/m^2",
        "roughness.asperity_radius": "100 nm",
        "roughness.asperity_density": "1e14 1/m^2",
    },
}


@pytest.mark.parametrize("name", long_but(AREAS, "filling"))
def test_the_loss_of_an_impact_is_the_area_between_the_branches(name, monkeypatch):
    """To its deepest point and back, with many places for Simpson's rule."""
    monkeypatch.setattr(quasi_static, "_POINTS", 8000)
    case = CASE.replace(
        {"counterface.deformation": "rigid", "numerics.max_impacts": 1, **AREAS[name]}
    )
    result, drawn = asperity.solve(case, critical=False), asperity.curve(case)
    lost = sum(result.ledger["lost"].values())
    assert lost > 0.0
    # The bonds that hold at the apex were not broken: the curve goes on until all are.
    assert drawn.loss == pytest.approx(lost, rel=1e-4)
    area = simpson(drawn.force_loading - drawn.force_unloading, x=drawn.rigid_separation)
    assert area == pytest.approx(lost, rel=1e-4)
