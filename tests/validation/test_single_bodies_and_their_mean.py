"""Single bodies and the mean field: they differ as one over the number of summits that touch."""

import dataclasses
from functools import partial

import numpy as np
import pytest
from scipy.optimize import brentq

import asperity
from asperity._jax import jax, jnp
from asperity.config import load
from asperity.config.resolve import resolve
from asperity.dynamics.damped_summits import damped_kinetic_apart
from asperity.dynamics.gas_film import SqueezeFilm
from asperity.dynamics.summit_path import Launch
from asperity.integration import integrate, silently
from asperity.model import build
from asperity.regimes.error_of_mean import losses_of_bodies
from asperity.results.conversion import measured
from asperity.single_bodies import SingleBodies
from chosen import long_but
from test_single_bodies import CASE, PLACED

SPEED = 0.012  # m/s
FAST = CASE.replace('speed = "3 mm/s"', f'speed = "{SPEED} m/s"\ngravity = "0 m/s^2"')
SOFT = FAST.replace('"rigid"', '"half-space"')


def mean_field(text=FAST):
    """Restitution of the first impact; it is the same where density and energy grow alike."""
    alone = load(text.replace(PLACED, ""))
    return asperity.solve(alone, critical=False).measures["restitution"][0]


def launched(density, count, text=FAST):
    """First impacts with so many times the density and the energy: as much on each summit."""
    problem = build(resolve(load(text)))
    bodies = SingleBodies(problem, 0.0)
    bodies.field = dataclasses.replace(bodies.field, density=density * bodies.field.density)
    energy = density * 0.5 * float(problem.body.mass) * SPEED**2
    launches = Launch(np.full(count, energy), np.full(count, np.inf))
    return bodies.impacts(launches, with_pull_off=False)


@pytest.mark.parametrize(
    ("density", "count"), long_but([(1, 4096), (3, 4096), (10, 20480), (100, 2048)], (3, 4096))
)
def test_the_mean_field_is_off_by_one_over_the_number_that_touch(density, count):
    found = launched(density, count)
    squares, touching = np.asarray(found.restitution) ** 2, np.mean(found.contacting)
    scatter = touching * np.std(squares) / np.sqrt(count)
    apart = touching * (np.mean(squares) - mean_field() ** 2)
    assert apart == pytest.approx(-0.35, abs=0.05 + 3.0 * scatter)
    assert touching * np.var(squares) == pytest.approx(0.102, rel=0.03 + 4.0 * np.sqrt(2 / count))


@pytest.mark.parametrize(
    ("summits", "speed", "off"),
    long_but(
        [
            (1, 8, 0.123), (1, 12, 0.0331), (1, 20, 0.0067), (4, 12, 0.0788), (4, 20, 0.013),
            (10, 12, 0.187), (10, 15, 0.0686), (10, 40, 0.0023), (40, 20, 0.0835),
            (40, 30, 0.0148), (40, 50, 0.0025),
        ],
        (1, 12, 0.0331),
    ),
)  # fmt: skip
def test_the_error_of_a_mean_is_that_of_the_theory(summits, speed, off):
    """So many times the summits, at a speed in mm/s: the mean over 1024 bodies, and the theory."""
    text = FAST.replace("6.3e13", f"{6.3e13 * summits}").replace(f"{SPEED} m/s", f"{speed} mm/s")
    result = asperity.solve(load(text.replace("= 300", "= 1024")), critical=False)
    kept = np.asarray(result.realisations.values["restitution"])
    alone = result.measures["restitution"][0]
    scatter = np.std(kept) / np.mean(kept) / np.sqrt(kept.size)
    assert alone / np.mean(kept) - 1.0 == pytest.approx(off, abs=0.05 * off + 4.0 * scatter)
    inputs, touching = resolve(load(text)), result.regime["contacting_asperities"]
    field = SingleBodies(build(inputs), 0.0).field
    closest = brentq(lambda d: float(field.expected_above(d)) - touching, -1e-8, 1e-8)
    losses = losses_of_bodies(inputs, closest, touching)
    assert losses.error(alone**2, 1.0 - alone**2) == pytest.approx(off, rel=0.17)


@pytest.fixture(scope="module")
def on_half_space():
    """512 first impacts on summits that feel one another."""
    return launched(1, 512, SOFT)


def test_on_a_half_space_the_mean_field_has_a_like_error(on_half_space):
    """Its rings smear each load, so that a summit lowers itself too: it loses a little less."""
    squares = np.asarray(on_half_space.restitution) ** 2
    touching = np.mean(on_half_space.contacting)
    scatter = touching * np.std(squares) / np.sqrt(512)
    assert touching == pytest.approx(8.1, abs=0.3)
    apart = touching * (np.mean(squares) - mean_field(SOFT) ** 2)
    assert apart == pytest.approx(-0.22, abs=0.05 + 3.0 * scatter)


def test_on_a_half_space_summits_feel_one_another(on_half_space):
    """Fewer touch, deeper down, and a bond loses a little less beside others."""
    alone, coupled = launched(1, 512), on_half_space
    assert np.mean(coupled.contacting) < 0.97 * np.mean(alone.contacting)
    assert np.mean(coupled.closest_approach) < np.mean(alone.closest_approach)
    assert -0.01 < np.sum(coupled.interaction) / np.sum(coupled.lost) < -1e-5
    assert not np.any(alone.interaction)


LATE = FAST.replace("[impact]", '[impact]\nrelease_separation = "30 nm"').replace(
    "[capillary]", '[capillary]\nformation_time = "20 ns"'
)


@pytest.mark.long
@pytest.mark.parametrize(("density", "count"), [(1, 2048), (3, 2048), (10, 4096)])
def test_a_mean_whose_menisci_take_time_is_that_of_many_summits(density, count):
    """So many times the summits and the mass: as fast, and as much on each summit."""
    problem = build(resolve(load(LATE)))
    bodies = SingleBodies(problem, 0.0)
    bodies.field = dataclasses.replace(bodies.field, density=density * bodies.field.density)
    mass = density * float(problem.body.mass)
    bodies._body = dataclasses.replace(bodies._body, mass=mass)
    launches = Launch(np.full(count, 0.5 * mass * SPEED**2), np.full(count, 30e-9))
    found = bodies.impacts(launches, with_pull_off=False)
    squares, touching = np.asarray(found.restitution) ** 2, np.mean(found.contacting)
    scatter = touching * np.std(squares) / np.sqrt(count)
    apart = touching * (np.mean(squares) - mean_field(LATE) ** 2)
    assert apart == pytest.approx(-0.45, abs=0.04 + 3.0 * scatter)


GAS = FAST.replace("[impact]", '[impact]\nrelease_separation = "30 nm"') + (
    '[gas]\nname = "air"\npressure = "1 bar"\ntemperature = "20 degC"\n'
)


@pytest.mark.long
def test_a_mean_in_air_is_that_of_many_summits():
    """With three times the summits, mass and drag, where the forces of the mean field end.

    The film takes a quarter of what is lost. Beyond their last forces bodies coast there and back.
    """
    solution = integrate(build(resolve(load(GAS.replace(PLACED, "")))), silently)
    mean = measured(solution)
    problem = build(resolve(load(GAS)))
    body, (film,) = problem.body, problem.body.drags
    dense = SqueezeFilm(film.radius, 3.0 * film.viscosity, film.slip_length, film.closest)
    heavy = dataclasses.replace(body, mass=3.0 * body.mass, drags=(dense,))
    bodies = SingleBodies(problem._replace(body=heavy), 0.0)
    bodies.field = dataclasses.replace(bodies.field, density=3.0 * bodies.field.density)
    energy = 0.5 * float(heavy.mass) * SPEED**2
    found = bodies.impacts(Launch(np.full(512, energy), np.full(512, 30e-9)), with_pull_off=False)
    one = partial(damped_kinetic_apart, dataclasses.replace(heavy, release=0.0, speed=0.0))
    left = jnp.asarray(found.impact_energy * found.restitution**2)
    out = jax.jit(jax.vmap(one, (0, 0, None)))(left, jnp.asarray(found.end), mean.contact_end)
    squares = np.asarray(out) / float(one(energy, jnp.asarray(30e-9), mean.contact_end))
    touching = np.mean(found.contacting)
    apart = touching * (np.mean(squares) - float(mean.restitution[0]) ** 2)
    scatter = touching * np.std(squares) / np.sqrt(512)
    assert touching > 20.0
    assert apart == pytest.approx(-0.35, abs=0.05 + 3.0 * scatter)
