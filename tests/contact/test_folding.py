"""A rough sphere on a soft half-space jumps into contact and out of it."""

import dataclasses
from functools import cache
from types import SimpleNamespace

import numpy as np
import pytest

import asperity
from asperity._jax import jax, jnp
from asperity.config import load
from asperity.config.resolve import resolve
from asperity.contact.equilibrium import compliance, pressed, profile_of
from asperity.contact.folding import FoldingContact, folding
from asperity.errors import SimulationError
from asperity.model import build
from asperity.sweeps.compute import batch
from asperity.sweeps.compute.batch import compute
from asperity.sweeps.compute.building import built
from asperity.sweeps.compute.cases_alone import without_jumps
from asperity.sweeps.study.study import parse

RMS = 5e-9
DEEP = -20.0 * RMS


def text(modulus, speed=100.0, rings=40):
    return f"""
    schema = 1
    [body]
    radius = "10 um"
    youngs_modulus = "{modulus} MPa"
    poisson = 0.3
    density = "1200 kg/m^3"
    [counterface]
    youngs_modulus = "{modulus} MPa"
    poisson = 0.3
    density = "1200 kg/m^3"
    [roughness]
    asperity_density = "2e14 1/m^2"
    asperity_radius = "50 nm"
    rms_height = "5 nm"
    [adhesion]
    model = "dmt"
    work = "50 mJ/m^2"
    equilibrium_spacing = "0.3 nm"
    [impact]
    speed = "{speed} mm/s"
    gravity = "0 m/s^2"
    [numerics]
    max_impacts = 1
    rings = {rings}
    """


@cache
def contact(modulus, rings=40):
    return build(resolve(load(text(modulus, rings=rings)))).contact


@cache
def folded(modulus=60.0, rings=40):
    found = folding(contact(modulus, rings), DEEP)
    assert isinstance(found, FoldingContact)
    return found


@cache
def thrown():
    return asperity.solve(load(text(60.0)), critical=False)


def followed(one, size, steps):
    """Central separations of plain Newton steps from one separation to the next, until they end."""
    flat = np.zeros(one.rings + 1)
    profile = np.asarray(profile_of(one, jnp.asarray(size)))
    matrix = size / float(one.modulus) * compliance(one.rings)
    law = jax.jit(lambda h: pressed(one, (), h))
    displacement, path = flat, []
    for place in steps:
        h = place + profile + displacement
        for _ in range(30):
            pressure, slope = (np.asarray(x) for x in law(h))
            left = h - place - profile - matrix @ pressure
            move = np.linalg.solve(np.eye(h.size) - matrix * slope, left)
            h = h - move
            if np.max(np.abs(move)) < 1e-13 * RMS:
                break
        else:
            return path
        if not np.max(np.abs(h - place - profile - displacement)) < 0.5 * RMS:
            return path
        displacement = h - place - profile
        path.append((place, h[0]))
    return path


def test_it_folds_where_plain_steps_find_no_equilibrium_near_by():
    one = folded()
    fold, size = float(one.folds[0]), float(one.sizes[0])
    ahead = np.append(np.linspace(1.0, 0.2, 40, endpoint=False), np.linspace(0.2, -2e-3, 203))
    path = followed(one, size, fold + ahead * RMS)
    last = path[-1][0]
    assert len(path) < ahead.size
    assert abs(last - fold) < 2e-3 * RMS
    # The change of the central separation with the rigid one goes to infinity there.
    places, central = np.array(path[-200:]).T
    rate = np.gradient(central, places)
    assert rate[-3] > 5.0 * rate[0] > 5.0


def test_it_jumps_out_further_out_than_in_the_more_the_softer_it_is():
    stiff = folding(contact(200.0), DEEP)
    assert stiff is None
    widths = []
    for modulus in (60.0, 30.0):
        inwards, outwards = np.asarray(folded(modulus).folds) / RMS
        widths.append(outwards - inwards)
    assert 0.0 < widths[0] < widths[1]


def test_folds_do_not_depend_on_the_number_of_rings():
    fine, coarse = folded(), folded(rings=24)
    np.testing.assert_allclose(coarse.folds, fine.folds, rtol=0.0, atol=1e-4 * RMS)


def test_what_it_loses_by_the_jumps_is_what_its_energies_lack():
    result = thrown()
    assert result.outcome.value == "escaped"
    lost = result.ledger["lost"]
    assert set(lost) == {"instability"}
    assert result.ledger["energy_balance_error"] < 1e-7
    e = result.measures["restitution"][0]
    assert 1.0 - e**2 == pytest.approx(lost["instability"] / result.ledger["initial"], rel=1e-6)
    # They are drawn as steps.
    drawn = result.energies["lost_instability"]
    assert drawn[0] == 0.0
    assert drawn[-1] == pytest.approx(lost["instability"], rel=1e-9)
    assert len(np.unique(np.round(drawn / drawn[-1], 9))) == 3


def test_a_ledger_closes_where_the_mesh_changes_before_a_fold():
    """A mesh that changed at once left 2e-5 of the energy, at this speed alone."""
    result = asperity.solve(load(text(60.0, speed=60.0)), critical=False)
    assert result.ledger["energy_balance_error"] < 1e-7


def test_restitution_against_speed_is_that_of_the_loss():
    """Bodies that are launched jump, and what is said of the case is said of that contact."""
    speeds = np.array([0.04, 0.06])
    found = asperity.restitution_curve(load(text(60.0)), speeds)
    share = thrown().ledger["lost"]["instability"] / thrown().ledger["initial"]
    left = 1.0 - share * (0.1 / speeds) ** 2
    assert found.captured.tolist() == [True, False]
    assert found.restitution[1] == pytest.approx(left[1] ** 0.5, rel=1e-5)
    np.testing.assert_allclose(found.critical_velocity, 0.1 * share**0.5, rtol=1e-5)


def test_the_loss_is_the_area_between_its_curves_whatever_the_load_at_which_loading_turns():
    found = asperity.curve(load(text(60.0)), load=1e-6)
    lost = thrown().ledger["lost"]["instability"]
    deepest = np.argmin(found.rigid_separation)
    assert found.force_loading[deepest] == pytest.approx(1e-6, rel=1e-7)
    assert found.loss == pytest.approx(lost, rel=1e-8)
    # Forces are drawn at some hundred separations, between which lines are drawn.
    area = np.trapezoid(found.force_loading - found.force_unloading, found.rigid_separation)
    assert area == pytest.approx(lost, rel=1e-4)
    # The pull-off lies between the limits of the work of the two planes.
    energy = contact(60.0).interface.energy(jnp.linspace(-10.0 * RMS, 10.0 * RMS, 2001), ())
    share = found.pull_off / (np.pi * -float(jnp.min(energy)) * 10e-6)
    assert 1.5 < share < 2.0


def test_a_slow_body_is_captured_and_stays_on_its_side_of_the_fold():
    result = asperity.solve(load(text(60.0, speed=40.0)), critical=False)
    assert result.measures["captured"]
    assert result.ledger["energy_balance_error"] < 1e-6
    # It jumped in once, and not out again.
    assert 0.0 < result.ledger["lost"]["instability"] < thrown().ledger["lost"]["instability"]


KEPT = ["captured", "restitution", "minimum_separation", "lost_instability"]


def study_of(key, values, placement="mean", keep=KEPT):
    """A study of such bodies over one key."""
    head, *tables = (
        text(60.0).replace("rms_height", f"placement = '{placement}'\nrms_height").split("[")
    )
    base = "".join(f"[base.{table}" for table in tables)
    axis = f"[axes.{key}]\nvalues = {values}\n"
    return parse(f"{head}keep = {keep}\nkeep_impacts = 1\n{axis}{base}")


def test_cases_of_a_study_jump_as_they_do_alone():
    found, alone = compute(study_of("'impact.speed'", ["100 mm/s"]), 0)[0], thrown()
    assert found["lost_instability"][0] == alone.ledger["lost"]["instability"]
    assert found["restitution"][0, 0] == alone.measures["restitution"][0]
    assert found["minimum_separation"][0] == alone.events["closest_approach_separation"][0]
    assert found["captured"][0] == 0


def test_of_a_study_those_that_jump_are_taken_from_their_group():
    works = np.array([50e-3, 1e-3, 2e-3, 0.5e-3])
    study = study_of("'adhesion.work'", [f"{work} J/m^2" for work in works])
    values = {"adhesion.work": works}
    found = without_jumps(study, values, built(study, values))
    assert [row for row, _ in found.alone] == [0]
    (group,) = found.groups
    assert group.rows.tolist() == [1, 2, 3]
    adhering = group.batch.contact.interface.laws[1]
    np.testing.assert_array_equal(adhering.work_of_adhesion, works[1:])


def test_single_bodies_of_a_case_that_jumps_are_kept(monkeypatch):
    bodies = SimpleNamespace(columns=lambda: {"capture_probability": 0.25})
    result = dataclasses.replace(thrown(), realisations=bodies)
    monkeypatch.setattr(batch, "solve", lambda case, **_: result)
    study = study_of("'impact.speed'", ["100 mm/s"], "random", ["capture_probability"])
    assert compute(study, 0)[0]["capture_probability"][0] == 0.25


def test_an_edge_that_rings_do_not_resolve_is_said():
    with pytest.raises(SimulationError, match="as one contact, at whose edge"):
        folding(contact(20.0, rings=16), DEEP)
