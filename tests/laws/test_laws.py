"""One asperity: each law's branches, losses and limits."""

from math import cos, pi, radians

import numpy as np
import pytest

from asperity._jax import jax, jnp
from asperity.errors import InputError
from asperity.laws import Bradley, ByKelvinGap, Dmt, Hertz, Jkr, Maugis, Meniscus, Sum

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
def test_forces_are_slopes_of_their_energies(law):
    """A hundred times closer than `check_law` looks, which holds every other rule of a law."""
    g = gaps(law)
    # In contact a bond exists, so the free branch of a bonding law is asked for its gaps only.
    free = g[g > float(law.forming_gap)] if law.hysteretic else g
    scale = float(jnp.max(jnp.abs(law.force(g))))
    slope = slope_of(law.energy, free)
    np.testing.assert_allclose(law.force(free), -slope, rtol=1e-10, atol=1e-12 * scale)
    bonded = g[g < float(law.breaking_gap)] if law.hysteretic else g
    force, slope = law.bonded_force(bonded), slope_of(law.bonded_energy, bonded)
    scale = float(jnp.max(jnp.abs(force)))
    np.testing.assert_allclose(force, -slope, rtol=1e-9, atol=1e-10 * scale)


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


def test_meniscus_never_repels_beyond_its_range():
    g = jnp.linspace(0.0, 1e-8, 101)
    for name in ("meniscus by contact", "meniscus by Kelvin gap"):
        assert float(jnp.max(LAWS[name].bonded_force(g))) <= 0.0


@pytest.mark.parametrize(
    "pair",
    [
        (Hertz(R, E), Jkr(R, E, W)), (Jkr(R, E, W), Dmt(R, W)),
        (Dmt(R, W), Bradley(R, W, EPS)), (Hertz(R, E), Hertz(R, E)),
        *((Maugis(R, E, W, EPS), other) for other in (Hertz(R, E), Dmt(R, W), Jkr(R, E, W))),
    ],
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
