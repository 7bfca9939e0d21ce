"""Rings on a half-space find their equilibrium, and the linear systems on the way there."""

from math import radians

import equinox as eqx
import numpy as np
import pytest

import asperity
from asperity._jax import jax, jnp
from asperity.config.resolve import resolve
from asperity.contact import ElasticContact
from asperity.contact.equilibrium import profile_of, rates, solve_equilibrium
from asperity.contact.profile import Sphere
from asperity.halfspace import ring_mesh
from asperity.interface.interface import Interface
from asperity.laws import Dmt, Hertz, Meniscus
from asperity.model import build
from asperity.numerics.krylov import CLOSE, nearly_solved
from asperity.surfaces.heights import Gaussian
from chosen import long_but

RADIUS, BETA, SIGMA, E, N = 50e-6, 0.25e-9, 10.5e-9, 56.8e9, 1.69e16
MENISCUS = Meniscus(BETA, 0.0728, radians(73.0), 2e-9)
RINGS = 32
PUBLISHED = asperity.load("published-exact")
FILLED = {"capillary.model": "kelvin-filling", "capillary.surface_rms_height": "11 nm"}


def contact(modulus):
    layer = Interface(Hertz(BETA, E) + Dmt(BETA, 0.03) + MENISCUS, Gaussian(SIGMA), N)
    return ElasticContact(layer, Sphere(RADIUS), modulus, RINGS)


found = eqx.filter_jit(solve_equilibrium)
paces = eqx.filter_jit(rates)


def residual(here, place, thresholds, size, displacement):
    """What is left of h = d + rise + u(p(h)), by dense products of NumPy; u is 0 at the end."""
    mesh = ring_mesh(here.rings)
    h = place + profile_of(here, size) + displacement
    pressure = np.asarray(here.interface.pressure(h, thresholds))[:-1]
    displaced = size / here.modulus * (mesh.compliance @ pressure)
    return np.asarray(displacement) - np.append(displaced, 0.0)


@pytest.mark.parametrize("bonded", [False, True], ids=["fresh", "torn"])
@pytest.mark.parametrize("modulus", [1e13, 57e9, 0.5e9], ids=["stiff", "as silica", "soft"])
@pytest.mark.parametrize("depth", [4.5, 0.5, -10.0])
def test_rings_settle_from_nothing_and_from_a_guess_nearby(modulus, depth, bonded):
    here, place, size = contact(modulus), jnp.asarray(depth * SIGMA), jnp.asarray(9e-7)
    thresholds, flat = here.branches()[int(bonded)].thresholds, jnp.zeros(RINGS + 1)
    rest = found(here, place, thresholds, size, flat)
    assert float(rest.error) < 1e-10
    left = residual(here, place, thresholds, 9e-7, rest.displacement)
    np.testing.assert_allclose(left, 0.0, atol=3e-12 * (SIGMA + float(jnp.max(rest.displacement))))
    near = found(here, place + 0.1 * SIGMA, thresholds, size, flat)
    again = found(here, place, thresholds, size, near.displacement)
    np.testing.assert_allclose(
        again.displacement, rest.displacement, atol=1e-11 * SIGMA, rtol=1e-11
    )


def test_rates_are_those_of_rings_at_two_places():
    here, place, size = contact(57e9), jnp.asarray(-2.0 * SIGMA), jnp.asarray(9e-7)
    thresholds, flat = here.initial_memory().thresholds, jnp.zeros(RINGS + 1)
    step = 1e-4 * SIGMA
    lifts = [found(here, place + k * step, thresholds, size, flat).displacement for k in (-1, 0, 1)]
    measured = 1.0 + (lifts[2] - lifts[0]) / (2.0 * step)
    rate = paces(here, place, thresholds, size, lifts[1])
    np.testing.assert_allclose(rate, measured, rtol=1e-4)
    assert 0.05 < float(jnp.min(rate)) < 0.6  # the bulk gives way there
    assert float(rate[-1]) == 1.0  # but not where the mesh ends


@pytest.mark.parametrize("humidity", [0.05, 0.6])
@pytest.mark.parametrize("rms", long_but(["2 nm", "10.5 nm"], "10.5 nm"))
def test_ledgers_close_where_liquid_fills_the_surface_about_a_small_contact(rms, humidity):
    """Liquid wets far more than what asperities carry: mesh and scanning curve take it in."""
    case = PUBLISHED.replace(
        {
            **FILLED,
            "capillary.humidity": humidity,
            "impact.release_separation": "400 nm",
            "roughness.rms_height": rms,
            "numerics.max_impacts": 3,
        }
    )
    assert asperity.solve(case, critical=False).ledger["energy_balance_error"] < 1e-6


@pytest.mark.long
def test_a_ledger_closes_where_liquid_fills_a_surface_that_creeps():
    """At a hundredth of the speed: liquid, and all it leaves on the mesh's end, counts for most."""
    case = PUBLISHED.replace(
        {
            **FILLED,
            "capillary.humidity": 0.05,
            "impact.speed": "0.01 m/s",
            "impact.release_separation": "60 nm",
            "roughness.rms_height": "2 nm",
            "viscoelasticity.model": "standard-linear-solid",
            "viscoelasticity.relaxed_modulus_ratio": 0.5,
            "viscoelasticity.relaxation_time": "200 ns",
            "numerics.max_impacts": 1,
        }
    )
    assert asperity.solve(case, critical=False).ledger["energy_balance_error"] < 1e-6


def test_the_mesh_grows_to_bonds_beyond_it_not_to_what_never_ends():
    """Bradley's pull falls off as a power beyond any mesh, where it is counted as it is."""
    case = PUBLISHED.replace({**FILLED, "adhesion.model": "bradley", "capillary.humidity": 0.3})
    places = SIGMA * jnp.asarray([-2.0, 1.0, 3.0, 5.0])
    forces = []
    for rings in (48, 96):
        here = build(resolve(case.replace({"numerics.rings": rings}))).contact
        states = jax.jit(jax.vmap(lambda d, here=here: here.state(d, here.branches()[-1])))(places)
        assert np.all(states.size < 1e-5)
        forces.append(np.asarray(states.force))
    np.testing.assert_allclose(forces[0], forces[1], atol=1e-6 * np.max(np.abs(forces[1])))


def test_a_batch_settles_as_each_alone():
    here, size = contact(57e9), jnp.asarray(9e-7)
    thresholds, flat = here.initial_memory().thresholds, jnp.zeros(RINGS + 1)
    places = SIGMA * jnp.asarray([5.0, 1.0, -20.0])

    def one(place):
        return solve_equilibrium(here, place, thresholds, size, flat).displacement

    together = jax.jit(jax.vmap(one))(places)
    for row, place in zip(together, places, strict=True):
        alone = found(here, place, thresholds, size, flat).displacement
        np.testing.assert_allclose(row, alone, atol=1e-11 * SIGMA, rtol=1e-11)


@pytest.mark.parametrize("strength", [0.0, 1e-3, 1.0, 40.0, 1e7])
@pytest.mark.parametrize("pulls", [False, True])
def test_linear_systems_are_solved_as_far_as_asked(strength, pulls):
    """Slopes of both signs; a pull as strong as a stable contact has."""
    mesh = ring_mesh(48)
    slope: jax.Array | np.ndarray = strength * np.exp(-((mesh.radius / 0.8) ** 2))
    if pulls:
        slope = slope - 0.1 * np.exp(-(((mesh.radius - 1.5) / 0.3) ** 2))
    matrix = jnp.asarray(np.eye(48) + mesh.compliance * slope)
    right = jnp.asarray(1.0 + 0.3 * mesh.radius**2)
    answer = jax.jit(lambda s, b: nearly_solved(mesh.compliance, -s, b))(slope, right)
    judge = np.linalg.solve(matrix, right)
    left = np.linalg.norm(matrix @ answer - right) / np.linalg.norm(right)
    assert left <= 2.0 * CLOSE
    np.testing.assert_allclose(answer, judge, atol=20.0 * CLOSE * np.max(np.abs(judge)))


def test_only_what_steps_do_not_solve_is_factorized():
    """In a batch: the one solved exactly, the others as far as asked and no further."""
    mesh = ring_mesh(48)
    slopes = jnp.asarray([[1.0], [1e7], [40.0]]) * np.exp(-((mesh.radius / 0.8) ** 2))
    right = jnp.asarray(1.0 + 0.3 * mesh.radius**2)
    answers = jax.jit(jax.vmap(lambda s: nearly_solved(mesh.compliance, -s, right)))(slopes)
    for slope, answer, factorized in zip(slopes, answers, (False, True, False), strict=True):
        judge = np.linalg.solve(np.eye(48) + mesh.compliance * np.asarray(slope), right)
        off = float(np.max(np.abs(answer - judge)) / np.max(np.abs(judge)))
        assert (off < 1e-12) == factorized
        assert off < 20.0 * CLOSE


def test_nothing_to_solve_is_solved():
    assert not np.any(nearly_solved(np.eye(5), -jnp.ones(5), jnp.zeros(5)))


STRETCHED = {
    "body": {
        "radius": "0.66 mm", "youngs_modulus": "937 GPa", "poisson": 0.25,
        "density": "918 kg/m^3",
    },
    "counterface.material": None,
    "counterface.youngs_modulus": "937 GPa",
    "counterface.poisson": 0.25,
    "impact": {"speed": "3.42 mm/s", "gravity": "0 m/s^2"},
    "roughness.asperity_density": "1.93e13 1/m^2",
    "roughness.asperity_radius": "5.55 um",
    "roughness.rms_height": "0.157 nm",
    "adhesion": None,
    "capillary.humidity": 0.435,
    "capillary.temperature": "325 K",
    "capillary.contact_angle": "35.8 degrees",
    "numerics.max_impacts": 3,
}  # fmt: skip


def test_a_ledger_closes_where_menisci_stretch_over_many_rms_heights():
    """Rings deep in contact reach the branch last: one piece for all of them missed it by 3e-3."""
    result = asperity.solve(PUBLISHED.replace(STRETCHED), critical=False)
    assert result.ledger["lost"]["capillary"] > 0.05 * result.ledger["initial"]
    assert result.ledger["energy_balance_error"] < 2e-6
