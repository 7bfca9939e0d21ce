"""One asperity: each law's branches, losses and limits."""

from math import cos, pi, radians

import equinox as eqx
import numpy as np
import pytest

from asperity._jax import jax, jnp
from asperity.errors import InputError
from asperity.laws import Bradley, ByKelvinGap, Dmt, Hertz, Jkr, Meniscus, Sum

R, E, W, EPS = 2.5e-7, 5e9, 0.05, 3e-10  # m, Pa, J/m^2, m
TENSION, ANGLE, KELVIN = 0.0728, radians(40.0), 1.3e-9

LAWS = {
    "hertz": Hertz(R, E),
    "bradley": Bradley(R, W, EPS),
    "dmt": Dmt(R, W),
    "jkr": Jkr(R, E, W),
    "meniscus by contact": Meniscus(R, TENSION, ANGLE, KELVIN),
    "meniscus by Kelvin gap": Meniscus(R, TENSION, ANGLE, KELVIN, ByKelvinGap()),
}
every_law = pytest.mark.parametrize("law", LAWS.values(), ids=LAWS)


def gaps(law, low=-5e-9, high=5e-9):
    """Gaps away from the places where a branch is not smooth."""
    kinks = [float(k) for k in law.kinks]
    if law.hysteretic:
        kinks += [float(law.forming_gap), float(law.breaking_gap)]
    at = np.linspace(low, high, 201) + 1.7e-12
    return jnp.asarray(at[np.all([np.abs(at - k) > 2e-12 for k in kinks], axis=0)])


def slope_of(energy, places):
    return jax.jit(jax.vmap(jax.grad(energy)))(places)


@every_law
def test_free_force_is_the_slope_of_the_free_energy(law):
    g = gaps(law)
    scale = float(jnp.max(jnp.abs(law.force(g))))
    # In contact a bond exists, so the free branch of a bonding law is asked for its gaps only.
    g = g[g > float(law.forming_gap)] if law.hysteretic else g
    np.testing.assert_allclose(
        law.force(g), -slope_of(law.energy, g), rtol=1e-10, atol=1e-12 * scale
    )


@every_law
def test_bonded_force_is_the_slope_of_the_bonded_energy(law):
    g = gaps(law)
    g = g[g < float(law.breaking_gap)] if law.hysteretic else g
    force = law.bonded_force(g)
    slope = slope_of(law.bonded_energy, g)
    np.testing.assert_allclose(
        force, -slope, rtol=1e-9, atol=1e-10 * float(jnp.max(jnp.abs(force)))
    )


@every_law
def test_bonds_never_create_energy_and_without_them_nothing_is_lost(law):
    losses = [float(law.formation_loss), float(law.rupture_loss)]
    if law.hysteretic:
        assert float(law.breaking_gap) >= float(law.forming_gap)
        assert min(losses) >= 0.0
    else:
        assert losses == [0.0, 0.0]


@every_law
def test_free_energy_vanishes_far_away(law):
    deep = abs(float(law.bonded_energy(jnp.asarray(-EPS))))
    assert abs(float(law.energy(jnp.asarray(1.0)))) < 1e-8 * deep


def scaled_laws(length, energy):
    modulus, tension = energy / length**3, energy / length**2
    r, e, w, eps = R * length, E * modulus, W * tension, EPS * length
    meniscus = (r, TENSION * tension, ANGLE, KELVIN * length)
    return (
        Hertz(r, e), Bradley(r, w, eps), Dmt(r, w), Jkr(r, e, w), Meniscus(*meniscus),
        Meniscus(*meniscus, ByKelvinGap()),
    )  # fmt: skip


@pytest.mark.parametrize("k", range(len(LAWS)), ids=list(LAWS))
def test_laws_do_not_depend_on_the_units(k):
    length, energy = 1e9, 3.7e18
    law, scaled = tuple(LAWS.values())[k], scaled_laws(length, energy)[k]
    g = gaps(law)
    for name, factor in (("force", energy / length), ("energy", energy)):
        for branch in (name, f"bonded_{name}"):
            here = np.asarray(getattr(law, branch)(g)) * factor
            there = np.asarray(getattr(scaled, branch)(g * length))
            np.testing.assert_allclose(there, here, rtol=1e-9, atol=1e-11 * np.max(np.abs(here)))
    assert float(scaled.formation_loss) == pytest.approx(float(law.formation_loss) * energy)
    assert float(scaled.rupture_loss) == pytest.approx(float(law.rupture_loss) * energy)
    assert float(scaled.interaction_range) == pytest.approx(float(law.interaction_range) * length)


@every_law
@pytest.mark.parametrize("share", [0.0, 0.37, 1.0])
def test_truncated_powers_are_the_law_itself(law, share):
    edge = jnp.asarray(law.forming_gap + share * (law.breaking_gap - law.forming_gap))
    powers = law.powers(edge)
    if powers is None:
        return
    g = gaps(law)
    bonded = g < edge
    for terms, free, held in (
        (powers[0], law.force, law.bonded_force),
        (powers[1], law.energy, law.bonded_energy),
    ):
        direct = jnp.where(bonded, held(g), free(g)) if law.hysteretic else free(g)
        total = sum(term(g) for term in terms)
        scale = float(jnp.max(jnp.abs(direct)))
        np.testing.assert_allclose(total, direct, rtol=1e-11, atol=1e-13 * scale)


@every_law
def test_response_is_the_force_and_the_energy(law):
    g = gaps(law)
    for bonded in (False, True):
        if bonded and not law.hysteretic:
            continue
        parts = law.response(g, jnp.full(g.shape, bonded))
        energy = law.bonded_energy(g) if bonded else law.energy(g)
        np.testing.assert_allclose(parts.pop("energy"), energy, rtol=1e-12)
        whole = law.bonded_force(g) if bonded else law.force(g)
        scale = float(jnp.max(jnp.abs(whole))) + 1e-30
        np.testing.assert_allclose(sum(parts.values()), whole, rtol=1e-12, atol=1e-13 * scale)


def test_hertz_contact_radius_follows_from_the_slope():
    """dF/d(overlap) = 2 E* a with a = sqrt(R overlap) (Johnson 1985, eq. 4.22)."""
    law, overlap = LAWS["hertz"], 2e-9
    stiffness = float(jax.grad(lambda d: law.force(-d))(overlap))
    assert stiffness == pytest.approx(2.0 * E * np.sqrt(R * overlap), rel=1e-12)


def test_bradley_pull_is_largest_at_touch_and_spends_the_work_of_adhesion():
    law = LAWS["bradley"]
    assert float(law.force(jnp.asarray(0.0))) == pytest.approx(-2.0 * pi * R * W, rel=1e-14)
    far = float(law.force(jnp.asarray(1e3 * EPS))) / (-2.0 * pi * R * W)
    assert far == pytest.approx(4.0 / 3.0 / 1001.0**2, rel=1e-6)


def test_dmt_pulls_by_its_full_force_inside_and_nothing_outside():
    law = LAWS["dmt"]
    np.testing.assert_allclose(law.force(jnp.asarray([-3e-9, -1e-15])), -2.0 * pi * R * W)
    np.testing.assert_array_equal(law.force(jnp.asarray([1e-15, 3e-9])), 0.0)


def test_jkr_forces_at_formation_and_rupture_and_its_largest_tension():
    law, unit = LAWS["jkr"], pi * W * R
    at_touch = float(law.bonded_force(jnp.asarray(0.0)))
    at_break = float(law.bonded_force(jnp.asarray(law.breaking_gap)))
    assert at_touch == pytest.approx(-4.0 / 3.0 * unit, rel=1e-12)
    assert at_break == pytest.approx(-5.0 / 6.0 * unit, rel=1e-7)
    places = jnp.linspace(-float(law.breaking_gap), float(law.breaking_gap), 200_001)
    assert float(-jnp.min(law.bonded_force(places))) == pytest.approx(1.5 * unit, rel=1e-9)


def test_jkr_breaks_at_the_fold_of_its_branch():
    law = LAWS["jkr"]
    fold = 0.75 * (pi**2 * W**2 * R / E**2) ** (1.0 / 3.0)
    assert float(law.breaking_gap) == pytest.approx(fold, rel=1e-14)


def test_jkr_cycle_loses_the_known_work():
    law, unit = LAWS["jkr"], (W**5 * R**4 / E**2) ** (1.0 / 3.0)
    assert float(law.formation_loss) / unit == pytest.approx(6.418315, abs=1e-6)
    assert float(law.rupture_loss) / unit == pytest.approx(0.673881, abs=1e-6)


def test_jkr_contact_radius_inverts_the_overlap():
    law = LAWS["jkr"]
    g = jnp.linspace(-2e-8, 0.999 * float(law.breaking_gap), 101)
    a = law.contact_radius(g)
    overlap = a**2 / R - jnp.sqrt(2.0 * pi * a * W / E)
    np.testing.assert_allclose(overlap, -g, rtol=1e-11, atol=1e-13 * 2e-8)


def test_jkr_tends_to_hertz_without_adhesion():
    g = jnp.linspace(-5e-8, -1e-8, 11)
    weak = Jkr(R, E, 1e-14)
    np.testing.assert_allclose(weak.bonded_force(g), Hertz(R, E).force(g), rtol=1e-5)
    np.testing.assert_allclose(weak.bonded_energy(g), Hertz(R, E).energy(g), rtol=1e-5)


def test_meniscus_made_by_contact_loses_the_work_of_stretching_it():
    """2 pi R gamma cos(theta) c a cycle, half the pull times the range."""
    law = LAWS["meniscus by contact"]
    c = 2.0 * KELVIN * cos(ANGLE)
    cycle = float(law.formation_loss + law.rupture_loss)
    assert cycle == pytest.approx(2.0 * pi * R * TENSION * cos(ANGLE) * c, rel=1e-13)


def test_meniscus_pulls_by_the_classical_capillary_force_at_touch():
    for name in ("meniscus by contact", "meniscus by Kelvin gap"):
        pull = float(LAWS[name].bonded_force(jnp.asarray(0.0)))
        assert pull == pytest.approx(-4.0 * pi * R * TENSION * cos(ANGLE), rel=1e-14)


def test_meniscus_never_repels_beyond_its_range():
    g = jnp.linspace(0.0, 1e-8, 101)
    for name in ("meniscus by contact", "meniscus by Kelvin gap"):
        assert float(jnp.max(LAWS[name].bonded_force(g))) <= 0.0


@pytest.mark.parametrize(
    "pair",
    [
        (Hertz(R, E), Jkr(R, E, W)), (Jkr(R, E, W), Dmt(R, W)),
        (Dmt(R, W), Bradley(R, W, EPS)), (Hertz(R, E), Hertz(R, E)),
    ],
    ids=["hertz+jkr", "jkr+dmt", "dmt+bradley", "hertz+hertz"],
)  # fmt: skip
def test_a_force_is_never_counted_twice(pair):
    with pytest.raises(InputError, match="twice"):
        pair[0] + pair[1]


def test_a_sum_acts_by_the_sum_of_its_parts():
    parts = (LAWS["hertz"], LAWS["bradley"], LAWS["meniscus by Kelvin gap"])
    whole = parts[0] + parts[1] + parts[2]
    assert isinstance(whole, Sum)
    g = gaps(parts[0])
    np.testing.assert_allclose(whole.force(g), sum(law.force(g) for law in parts), rtol=1e-14)
    np.testing.assert_allclose(whole.energy(g), sum(law.energy(g) for law in parts), rtol=1e-14)


@every_law
def test_laws_work_under_jit_vmap_and_grad(law):
    g = gaps(law)
    np.testing.assert_allclose(eqx.filter_jit(law.bonded_force)(g), law.bonded_force(g), rtol=1e-12)
    np.testing.assert_allclose(jax.vmap(law.force)(g), law.force(g), rtol=1e-12)
    assert np.all(np.isfinite(jax.vmap(jax.grad(law.bonded_force))(g)))
