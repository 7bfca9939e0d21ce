"""Summits that feel one another: against boundary elements."""

from pathlib import Path
from typing import NamedTuple

import equinox as eqx
import numpy as np
import pytest
from scipy import fft, ndimage

from asperity._jax import jnp
from asperity.config import load
from asperity.config.resolve import resolve
from asperity.contact.asperity_table import asperity_table
from asperity.contact.coupled_summits import CoupledSummits, influence_between
from asperity.dynamics.summit_path import Launch
from asperity.laws import Hertz
from asperity.model import build
from asperity.single_bodies import SingleBodies
from asperity.single_bodies.placement import place_summits
from chosen import long_but

TIP, MODULUS = 450e-9, 6.6e10  # m, Pa
CELLS = 12  # across the radius of the widest contact
DEPTH = 1e-9  # m
BODIES = 5
MAP = Path(__file__).parents[2] / "examples" / "surface.csv"
ON_MAP = f"""
[body]
material = "soda-lime glass"
radius = "25 um"
[counterface]
material = "silicon"
deformation = "half-space"
[roughness]
files = ["{MAP}"]
source = "summits"
form_removal = "tilt"
placement = "measured"
[adhesion]
model = "none"
[impact]
speed = "10 mm/s"
gravity = "0 m/s^2"
"""


def love(x, y, half):
    """Displacement times E* at (x, y) under unit pressure on a square cell (Love 1929)."""

    def term(u, v):
        return u * np.arcsinh(v / np.abs(u))

    total = 0.0
    for sign_x in (1.0, -1.0):
        for sign_y in (1.0, -1.0):
            u, v = x + sign_x * half, y + sign_y * half
            total = total + sign_x * sign_y * (term(u, v) + term(v, u))
    return total / np.pi


def forces_on_cells(overlap, side, modulus):
    """Force on square cells [N] where a rigid map overlaps an elastic half-space by that [m].

    Conjugate gradients on the cells that press (Polonsky and Keer 1999); displacements by Fourier
    transforms on twice the grid (Hockney 1970).
    """
    wide = [fft.next_fast_len(2 * length, real=True) for length in overlap.shape]
    x, y = (side * np.minimum(np.arange(n), n - np.arange(n)) for n in wide)
    kernel = fft.rfft2(love(x[:, None], y, 0.5 * side) / modulus)
    inside = tuple(slice(length) for length in overlap.shape)
    pressure, close = np.where(overlap > 0.0, 1e-2 * modulus, 0.0), 1e-6 * overlap.max()
    direction, before, kept = 0.0, 1.0, 0.0
    while True:
        gap = fft.irfft2(kernel * fft.rfft2(pressure, wide), wide)[inside] - overlap
        on = pressure > 0.0
        if np.all(gap > -close) and np.all(gap[on] < close):
            return side**2 * pressure
        square = np.sum(gap[on] ** 2)
        direction = np.where(on, gap + kept * square / before * direction, 0.0)
        moved = fft.irfft2(kernel * fft.rfft2(direction, wide), wide)[inside]
        step = np.sum((gap * direction)[on]) / np.sum((moved * direction)[on])
        pressure = np.maximum(pressure - step * direction, 0.0)
        met = (pressure == 0.0) & (gap < 0.0)
        pressure = np.where(met, -step * gap, pressure)
        before, kept = square, 0.0 if np.any(met) else 1.0


def on_paraboloids(positions, offsets, tips, side, modulus=MODULUS):
    """Force on each summit [N] at separation 0, and how many patches press, by such cells."""
    radii = np.sqrt(tips * offsets)
    low, high = np.min(positions.T - 1.6 * radii, axis=1), np.max(positions.T + 1.6 * radii, axis=1)
    x, y = (np.arange(a, b, side) for a, b in zip(low, high, strict=True))
    away = (x[:, None] - positions[:, :1, None]) ** 2 + (y - positions[:, 1:, None]) ** 2
    heights = offsets[:, None, None] - away / (2.0 * tips[:, None, None])
    forces = forces_on_cells(heights.max(axis=0), side, modulus)
    summit = heights.argmax(axis=0).ravel()
    return np.bincount(summit, forces.ravel(), len(offsets)), patches(forces)


def patches(forces):
    """Number of patches of cells that press."""
    return ndimage.label(forces > 0.0, np.ones((3, 3)))[1]


@eqx.filter_jit
def _forces(summits, positions, offsets):
    radii = jnp.sqrt(TIP * offsets)
    influence = influence_between(positions, radii, jnp.asarray(MODULUS))
    some = CoupledSummits.on(summits, offsets, influence, radii > 0.0)
    none = jnp.zeros((0, len(offsets)), bool)
    return some.equilibrium(jnp.zeros(()), none, -offsets).forces


def coupled(positions, offsets):
    """Force on each summit [N]; nothing on those without an offset."""
    table = asperity_table([Hertz(TIP, MODULUS)], 1e-12)
    summits = table.of(jnp.zeros(len(offsets), jnp.int32))
    return np.asarray(_forces(summits, jnp.asarray(positions), jnp.asarray(offsets)))


@pytest.mark.parametrize(("apart", "close"), [(8.0, 1.5e-3), (3.5, 5e-3), (2.3, 2e-2)])
def test_three_summits_take_from_one_another_what_boundary_elements_find(apart, close):
    """At distances in contact radii, each as a share of what it would carry alone."""
    offsets, tips = DEPTH * np.array([1.0, 0.8, 0.5]), np.full(3, TIP)
    radius = np.sqrt(TIP * DEPTH)
    positions = apart * radius * np.array([[0.0, 0.0], [1.0, 0.0], [0.3, 1.1]])
    each = offsets * np.eye(3)
    side = radius / CELLS
    alone = sum(on_paraboloids(positions, some, tips, side)[0] for some in each)
    hertz = 4.0 / 3.0 * MODULUS * TIP**0.5 * offsets**1.5
    np.testing.assert_allclose(alone, hertz, rtol=3e-3)
    np.testing.assert_allclose(sum(coupled(positions, some) for some in each), hertz, rtol=1e-7)
    wanted = on_paraboloids(positions, offsets, tips, side)[0] / alone
    found = coupled(positions, offsets) / hertz
    assert np.all(wanted < 1.0 - 0.1 / apart)
    np.testing.assert_allclose(found, wanted, rtol=close)


class Pressed(NamedTuple):
    """A body on a map at its closest approach, and the summits that overlap it there."""

    force: float  # N
    touching: float
    separation: float  # m
    centre: np.ndarray  # m
    positions: np.ndarray  # m, from there
    depths: np.ndarray  # m
    tips: np.ndarray  # m

    @property
    def side(self):
        """Of square cells [m]."""
        return np.sqrt(self.tips * self.depths).max() / CELLS


@pytest.fixture(scope="module")
def problem():
    return build(resolve(load(ON_MAP)))


@pytest.fixture(scope="module", params=long_but([0.003, 0.01, 0.03], 0.01))
def pressed(request, problem):
    """Bodies that come at a speed [m/s]: two, eight and twenty summits of each touch."""
    inputs = problem.inputs
    bodies = SingleBodies(problem, inputs.asperities.rms_height)
    energy = 0.5 * float(problem.body.mass) * request.param**2
    found = bodies.impacts(Launch(np.full(BODIES, energy), np.full(BODIES, np.inf)))
    field, radii = bodies.field, np.array(place_summits(inputs, inputs.placement, 0.0).tips)
    offsets, classes = field.summits(0, 0, field.heights.size)
    positions, some = field.positions(0, 0, field.heights.size), []
    for k, separation in enumerate(found.closest_approach):
        on, centre = offsets[k] > separation, np.mean(field.measured - positions[k], axis=0)
        where, depths, tips = positions[k][on], offsets[k][on] - separation, radii[classes[k][on]]
        one = found.maximum_force[k], found.contacting[k], separation, centre, where, depths, tips
        some.append(Pressed(*one))
    return some


def test_bodies_on_a_map_press_its_summits_as_boundary_elements_do(pressed, problem):
    """On paraboloids in place of summits, from 1.1 to 2.6 times lower than on a rigid bulk."""
    modulus, off, missed = float(problem.contact.modulus), [], []
    for body in pressed:
        wanted, number = on_paraboloids(body.positions, body.depths, body.tips, body.side, modulus)
        off.append(body.force / wanted.sum() - 1.0)
        missed.append(body.touching - number)
    np.testing.assert_allclose(off, 0.0, atol=0.015)
    assert abs(np.mean(off)) < 0.01
    np.testing.assert_allclose(missed, 0.0, atol=1.0)


@pytest.mark.long
def test_summits_carry_less_than_the_map_that_they_were_found_on(pressed, problem):
    """Between its pixels the map follows cubic splines: what paraboloids for asperities cost."""
    surface, radius = problem.inputs.asperities.surface, problem.inputs.radius
    heights, pixel = surface.heights - np.mean(surface.heights), np.array(surface.pixel_size)
    for body in pressed:
        far = np.sqrt(2.0 * radius * (heights.max() - body.separation))
        x = np.arange(-far, far, body.side)
        at = np.stack(np.meshgrid(x, x))[::-1] + body.centre[::-1, None, None]
        overlap = ndimage.map_coordinates(heights, at / pixel[::-1, None, None], mode="nearest")
        overlap -= body.separation + (x[:, None] ** 2 + x**2) / (2.0 * radius)
        overlap = overlap[ndimage.find_objects((overlap > 0.0).astype(int))[0]]
        found = forces_on_cells(overlap, body.side, float(problem.contact.modulus))
        assert 0.7 < body.force / found.sum() < 0.9
