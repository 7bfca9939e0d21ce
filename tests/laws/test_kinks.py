"""Forces near a law's kinks: what is read off a curve is the law's own force."""

import equinox as eqx
import numpy as np
import pytest

import asperity
from asperity._jax import jax, jnp
from asperity.config.resolve import resolve
from asperity.contact import SmoothContact, SmoothPlasticContact
from asperity.dynamics.curve_table import FORCE, outer_row, tabulate, tabulate_again
from asperity.laws import Bradley, Dmt, Hertz, Jkr, Maugis
from asperity.laws.law import terms
from asperity.laws.plastic import JacksonGreen, KogutEtsion, ThorntonNing
from asperity.model import build

YIELDS = {
    "body": {
        "radius": "1 um", "youngs_modulus": "3 GPa", "poisson": 0.3, "density": "1.05 g/cc",
    },
    "counterface": {"youngs_modulus": "70 GPa", "poisson": 0.3},
    "roughness": None,
    "adhesion": None,
    "capillary": None,
    "plasticity": {"model": "jackson-green", "yield_strength": "100 MPa"},
    "impact": {"speed": "10 m/s", "gravity": "0 m/s^2"},
    "numerics.max_impacts": 1,
}  # fmt: skip
MAKERS = {
    "jackson-green": (JacksonGreen, 1.0, True),  # what its strength is over the yield strength
    "kogut-etsion": (KogutEtsion, 2.8, True),
    "thornton-ning": (ThorntonNing, 1.61, False),
}


def test_a_case_that_yields_is_drawn_with_the_force_of_its_law():
    case = asperity.load("published-exact").replace(YIELDS)
    law = build(resolve(case)).contact.contact
    made, drawn = asperity.solve(case, critical=False), asperity.curve(case)
    pushed = made.time <= made.time[np.argmin(made.separation)]
    for separation, force in (
        (made.separation[pushed], made.forces["elastic"][pushed]),
        (drawn.rigid_separation, drawn.force_loading),
    ):
        overlap = np.maximum(-separation, 0.0)
        exact = np.where(overlap > 0.0, law.loading_force(overlap), 0.0)
        np.testing.assert_allclose(force, exact, rtol=0, atol=1e-10 * exact.max())
    assert made.forces["elastic"].max() <= law.loading_force(-made.separation.min()) * (1 + 1e-12)


@eqx.filter_jit
def _read(contact, deep, places):
    """Curves down to 20 times where yield begins, before and after an impact of that depth."""
    low, high = -1.2 * deep, jnp.asarray(2e-8)
    table = tabulate(contact, low, high)
    memory = contact.update_memory(contact.initial_memory(), -deep)
    again = tabulate_again(contact, table, memory, -deep)
    forces = [jax.vmap(lambda d, t=t: outer_row(t, 0, d)[FORCE])(places) for t in (table, again)]
    widths = [jnp.diff(t.ends) / jnp.abs(t.ends[1:]) for t in (table, again)]
    return jnp.stack(forces), widths


@pytest.mark.parametrize("name", MAKERS)
def test_curves_of_spheres_that_yield_give_the_law_back_next_to_every_kink(name):
    make, factor, poisson = MAKERS[name]
    rng = np.random.default_rng(5)
    for _ in range(12):
        radius, modulus = 10 ** rng.uniform(-6.5, -4.5), 10 ** rng.uniform(9, 11)
        strength = modulus * factor * 10 ** rng.uniform(-2.6, -1.5)
        law = make(radius, modulus, strength, *([rng.uniform(0.0, 0.49)] if poisson else []))
        law = jax.tree_util.tree_map(jnp.asarray, law)
        kinks = np.array([float(kink) for kink in law.kinks])
        deep = 20.0 * kinks[0]
        near = kinks[:, None] * (1.0 + np.outer([-1.0, 1.0], 10.0 ** np.arange(-16.0, 0.0)).ravel())
        overlaps = np.sort(np.concatenate([near.ravel(), np.linspace(0.0, deep, 40)]))
        overlaps = overlaps[overlaps <= deep]
        overlaps = np.append(overlaps, np.full(150 - overlaps.size, deep))
        forces, widths = _read(SmoothPlasticContact(law), jnp.asarray(deep), jnp.asarray(-overlaps))
        exact = np.where(overlaps > 0.0, law.loading_force(overlaps), 0.0)
        for force in np.asarray(forces):
            np.testing.assert_allclose(force, exact, rtol=0, atol=1e-10 * exact.max())
        for width in widths:
            assert np.all((width == 0.0) | (width > 5e-14))


ELASTIC = {
    "jkr": lambda r: Jkr(r, 3e9, 0.1),
    "maugis": lambda r: Maugis(r, 3e9, 0.1, 0.4e-9),
    "dmt": lambda r: Hertz(r, 3e9) + Dmt(r, 0.1),
    "bradley": lambda r: Hertz(r, 3e9) + Bradley(r, 0.1, 0.2e-9),
}


@pytest.mark.parametrize("name", ELASTIC)
def test_curves_of_smooth_bodies_have_no_panel_that_rounding_outweighs(name):
    for radius in np.geomspace(1e-7, 1e-4, 7):
        contact = SmoothContact(ELASTIC[name](radius))
        for release in (1e-8, 1e-5):
            ends = np.asarray(contact.panels(jnp.asarray(-1e-8), jnp.asarray(release)))
            width = np.diff(ends)
            assert ends[0] == -1e-8
            assert ends[-1] == release
            assert np.all((width == 0.0) | (width > 5e-14 * np.abs(ends[1:])))
            for law in terms(contact.law):
                for kink in law.kinks:
                    assert np.min(np.abs(ends - float(kink))) <= 1e-13 * abs(float(kink))
