"""First impacts of single bodies whose asperities yield: against forces summed finely."""

import dataclasses
from math import pi

import numpy as np
import pytest

import asperity
from asperity._jax import jax, jnp
from asperity.config import load_file
from asperity.contact.asperity_table import asperity_table
from asperity.dynamics import Body
from asperity.dynamics.single_impact import Yielding, single_impacts
from asperity.dynamics.summit_path import Launch
from asperity.dynamics.suspension import Dashpot
from asperity.interface.summit_field import GaussianField
from asperity.laws import Dmt, Meniscus
from asperity.laws.law import Sum
from asperity.laws.plastic import JacksonGreen, KogutEtsion, ThorntonNing
from asperity.numerics.trees import stacked
from chosen import long_but

TIP, MODULUS = 450e-9, 6.6e10  # m, Pa
CONTACTS = {
    "kogut-etsion": KogutEtsion(TIP, MODULUS, 1.5e9, 0.3),
    "jackson-green": JacksonGreen(TIP, MODULUS, 0.5e9, 0.3),
    "thornton-ning": ThorntonNing(TIP, MODULUS, 1.5e9),
}
ADHESIVE = Sum([Dmt(TIP, 0.05), Meniscus(TIP, 0.072, 0.2, 5e-10)])
HARDLY = Sum([Dmt(TIP, 1e-12), Meniscus(TIP, 1e-12, 0.2, 5e-10)])
RADIUS = 25e-6  # m
MASS = 4.0 / 3.0 * pi * RADIUS**3 * 2200.0  # kg
BODIES, SUMMITS = 16, 16
BODY = Body(MASS, 0.0, 0.0)


def twice(law):
    """The same of a tip of twice the radius."""
    if isinstance(law, Sum):
        return Sum([twice(part) for part in law.parts])
    return dataclasses.replace(law, radius=2.0 * law.radius)


def impacts(contact, law, speeds, offsets, before=np.inf, body=BODY, kind=0):
    """First impacts, or later ones of bodies that came as close before.

    On tips of a class ``kind`` of two, of which the second has twice the radius.
    """
    count = len(offsets)
    offsets = np.pad(offsets, ((0, 0), (0, SUMMITS - offsets.shape[1])), constant_values=-1.0)
    some = np.minimum(np.arange(BODIES), count - 1)
    speeds, before = (np.broadcast_to(x, count)[some] for x in (speeds, before))
    launches = Launch(0.5 * MASS * speeds**2, np.full(BODIES, np.inf))
    kinds = jnp.full((BODIES, SUMMITS), kind, jnp.int32)
    contacts = [contact, twice(contact)]
    found = single_impacts(
        asperity_table([law, twice(law)], 1e-11, contacts), body, launches,
        jnp.asarray(offsets[some]), kinds, True, Yielding(stacked(contacts), jnp.asarray(before)),
    )  # fmt: skip
    return jax.tree_util.tree_map(lambda leaf: np.asarray(leaf)[:count], found)


def summed(contact, law, speed, offsets):
    """Capture, restitution and pull-off from the forces of all at 60,000 separations."""
    dmt, meniscus = law.parts
    top = offsets.max() + float(asperity_table([law], 1e-11, [contact]).interaction_range[0])

    def beside(gap, bonded):
        pull = np.where(bonded, np.asarray(meniscus.bonded_force(gap)), 0.0)
        return np.asarray(dmt.force(gap)) + pull

    gaps = np.linspace(top, offsets.max() - 8e-9, 60_001)[:, None] - offsets
    force = np.asarray(contact.loading_force(jnp.maximum(-gaps, 0.0)))
    force = (force + beside(jnp.asarray(gaps), gaps <= 0.0)).sum(axis=1)
    work = np.append(0.0, np.cumsum(0.5 * (force[1:] + force[:-1]))) * -np.diff(gaps[:2, 0])
    kinetic = 0.5 * MASS * speed**2
    turn = int(np.argmax(work > kinetic))
    deepest = jnp.maximum(-gaps[turn], 0.0)
    left = contact.residual(deepest)
    flat = np.where(deepest > 0.0, deepest / np.where(deepest > left, deepest - left, 1.0), 1.0)
    from_tip = jnp.asarray(gaps[: turn + 1]) + left
    held = (np.asarray(from_tip) < float(meniscus.breaking_gap)) & np.asarray(deepest > 0.0)
    out = np.asarray(contact.force(jnp.asarray(-gaps[: turn + 1]), deepest))
    out = (out + np.where(deepest > 0.0, flat, 1.0) * beside(from_tip, held)).sum(axis=1)[::-1]
    gained = np.append(0.0, np.cumsum(0.5 * (out[1:] + out[:-1]))) * -np.diff(gaps[:2, 0])
    captured = gained[5:].min() < 0.0
    return captured, 0.0 if captured else np.sqrt(gained[-1] / kinetic), -out.min()


@pytest.mark.parametrize("kind", [0, 1])
@pytest.mark.parametrize("name", long_but(CONTACTS, "kogut-etsion"))
def test_one_hardly_adhesive_summit_keeps_what_its_contact_gives_back(name, kind):
    contact = CONTACTS[name] if kind == 0 else twice(CONTACTS[name])
    deepest = jnp.geomspace(1e-9, 2e-8, 8)
    speeds = np.sqrt(2.0 * np.asarray(contact.loading_work(deepest)) / MASS)
    found = impacts(CONTACTS[name], HARDLY, speeds, np.zeros((8, 1)), kind=kind)
    kept = np.asarray(contact.returned(deepest) / contact.loading_work(deepest))
    assert kept[0] > kept[-1]
    assert kept[-1] < 0.9
    np.testing.assert_allclose(-found.closest_approach, deepest, rtol=1e-7)
    np.testing.assert_allclose(found.restitution**2, kept, rtol=1e-7)


@pytest.mark.parametrize("name", long_but(CONTACTS, "kogut-etsion"))
@pytest.mark.parametrize("speed", [4e-3, 12e-3])
def test_many_summits_are_the_sum_of_all(name, speed):
    contact = CONTACTS[name]
    offsets = GaussianField(RADIUS, 2e13, 1.2e-9).summits(1, 0, 16)[0][:16]
    found = impacts(contact, ADHESIVE, speed, offsets)
    for k, row in enumerate(offsets[:8]):
        captured, restitution, pull = summed(contact, ADHESIVE, speed, row)
        assert bool(found.captured[k]) == captured
        assert float(found.restitution[k]) == pytest.approx(restitution, abs=3e-4)
        assert float(found.pull_off[k]) == pytest.approx(pull, rel=5e-3)


def test_losses_and_restitution_are_one_balance():
    offsets = GaussianField(RADIUS, 2e13, 1.2e-9).summits(3, 0, 16)[0][:16]
    found = impacts(CONTACTS["kogut-etsion"], ADHESIVE, 12e-3, offsets)
    free = ~found.captured
    assert np.sum(free) > 8
    lost = found.lost[free] / found.impact_energy[free, None]
    np.testing.assert_allclose(1.0 - found.restitution[free] ** 2, lost.sum(axis=1), atol=1e-8)
    assert lost[:, 1].min() > 0.02  # by yielding, and by menisci that flatter tips make larger:
    each = found.lost[free, 0] / found.bonds[free, 0]
    assert np.all(each > float(sum(ADHESIVE.parts[1].losses)))


def test_a_dashpot_and_tips_that_yield_share_the_loss():
    """One balance for each body that leaves; a dashpot of nothing takes nothing."""
    contact = CONTACTS["kogut-etsion"]
    offsets = GaussianField(RADIUS, 2e13, 1.2e-9).summits(3, 0, 16)[0][:16]
    found = impacts(contact, ADHESIVE, 12e-3, offsets)
    loose, damped = (Body(MASS, 0.0, 0.0, drags=(Dashpot(each),)) for each in (0.0, 2e-5))
    still = impacts(contact, ADHESIVE, 12e-3, offsets, body=loose)
    np.testing.assert_array_equal(still.captured, found.captured)
    np.testing.assert_allclose(still.restitution, found.restitution, rtol=1e-7)
    slowed = impacts(contact, ADHESIVE, 12e-3, offsets, body=damped)
    free = ~slowed.captured
    assert np.sum(free) > 8
    kept = slowed.impact_energy * slowed.restitution**2
    whole = (kept + slowed.lost.sum(axis=1))[free] / (0.5 * MASS * 12e-3**2)
    np.testing.assert_allclose(whole, 1.0, rtol=1e-8)
    assert np.all(slowed.lost[:, -1] > 0.0)
    assert np.all(slowed.restitution[free] < found.restitution[free])


def test_what_was_pressed_flat_yields_no_more():
    """A body that falls on the same summits again loses what its menisci take, and no more."""
    contact = CONTACTS["kogut-etsion"]
    offsets = GaussianField(RADIUS, 2e13, 1.2e-9).summits(5, 0, 16)[0][:16]
    first = impacts(contact, HARDLY, 12e-3, offsets)
    assert np.all(first.restitution < 0.995)
    again = impacts(contact, HARDLY, 12e-3 * first.restitution, offsets, first.closest_approach)
    np.testing.assert_allclose(again.restitution, 1.0, rtol=1e-7)
    np.testing.assert_allclose(again.closest_approach, first.closest_approach, rtol=0, atol=1e-16)
    wet = impacts(contact, ADHESIVE, 12e-3, offsets)
    free = ~wet.captured
    speeds = 12e-3 * wet.restitution[free]
    later = impacts(contact, ADHESIVE, speeds, offsets[free], wet.closest_approach[free])
    free = ~later.captured
    assert np.sum(free) > 4
    np.testing.assert_allclose(later.lost[free, 1] / later.impact_energy[free], 0.0, atol=1e-8)
    kept = 1.0 - later.lost[free, 0] / later.impact_energy[free]
    np.testing.assert_allclose(later.restitution[free] ** 2, kept, rtol=1e-7)


def test_many_asperities_yield_as_the_mean_field_says():
    """Of laws as in the example of yielding: it serves them both."""
    case = load_file("examples/yielding-drop.toml").replace(
        {
            "body.radius": "25 um",
            "roughness": {
                "asperity_density": "6.3e13 1/m^2",
                "asperity_radius": "450 nm",
                "rms_height": "1.64 nm",
                "placement": "random",
                "realisations": 64,
            },
            "adhesion.work": "5 mJ/m^2",
            "plasticity.hardness": "2 GPa",
            "capillary.contact_angle": "85 deg",
            "impact.speed": "0.1 m/s",
            "numerics.max_impacts": 1,
        }
    )
    result = asperity.solve(case, critical=False)
    bodies, mean = result.realisations, result.measures["restitution"][0]
    assert result.regime["contacting_asperities"] > 10.0
    assert mean < 0.96
    assert np.mean(bodies.values["restitution"]) == pytest.approx(mean, rel=5e-3)
    assert set(bodies.lost) == {"capillary", "plastic"}
