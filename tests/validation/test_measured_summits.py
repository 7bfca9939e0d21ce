"""Measured summits beside Gaussian heights and one radius: where they agree and by how much not."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from math import pi, radians, sqrt
from typing import NamedTuple

import equinox as eqx
import numpy as np
import pytest
from scipy.special import ndtri

from asperity._jax import jax, jnp
from asperity.contact import RigidContact
from asperity.contact.profile import Sphere
from asperity.dynamics import Body, simulate
from asperity.errors import Tolerance
from asperity.interface.interface import Interface
from asperity.interface.measured_summits import measured_surface
from asperity.laws import Dmt, Hertz, Meniscus
from asperity.results.measures import measure
from asperity.surfaces import Topography
from asperity.surfaces.description.nayak import Nayak
from asperity.surfaces.description.summits import find_summits
from asperity.surfaces.generation.generate import self_affine
from asperity.surfaces.generation.synthetic import gaussian_surface
from asperity.surfaces.heights import Gaussian, Sampled, Spread, spread_of
from figures import Figure, misses

E, W = 50e9, 0.03
TENSION, ANGLE, KELVIN = 0.0728, radians(50.0), 0.8e-9
PIXEL, RMS = 2e-9, 2e-9
PLACES = (1.0, 2.0, 3.0)
"""Separations from the mean plane of the summits, in their rms heights."""


def law(radius):
    return Hertz(radius, E) + Dmt(radius, W) + Meniscus(radius, TENSION, ANGLE, KELVIN)


@eqx.filter_jit
def pressures(surface, separations):
    """Elastic pressure and pull of surfaces that come closer, two rows."""
    means = surface.measure(separations, surface.initial_memory(separations), 0)
    elastic = means.parts[surface.components.index("elastic")]
    return jnp.stack([elastic, elastic - jnp.sum(means.parts, axis=0)])


# --- summits drawn with Gaussian heights and one radius ----------------------------------------

NUMBERS = (100, 1000, 10_000, 100_000, 1_000_000)
DRAWS = 12


@cache
def drawn(count: int) -> np.ndarray:
    """Deviation of the elastic pressure from `gaussian`'s, in its sampling errors: draws, places.

    The sampling error is that of a mean over ``count`` independent summits:
    sqrt(mean(f^2)/mean(f)^2 - 1)/sqrt(count), and mean(f^2)/mean(f)^2 is about the inverse of the
    share that touch.
    """
    radius, sigma = 1e-7, RMS
    places = sigma * np.array([-1.0, 0.0, *PLACES[:2]])
    exact = np.asarray(pressures(Interface(law(radius), Gaussian(sigma), 1.0), jnp.asarray(places)))
    scatter = _scatter(places) / sqrt(count)
    out = []
    for seed in range(DRAWS if count < 1_000_000 else 3):
        heights = sigma * np.random.default_rng(seed).standard_normal(count)
        sampled = Sampled(heights, np.full(count, radius), radius, _nodes(heights))
        found = np.asarray(pressures(Interface(law(radius), sampled, 1.0), jnp.asarray(places)))
        out.append((found[0] / exact[0] - 1.0) / scatter)
    return np.array(out)


def _scatter(places: np.ndarray) -> np.ndarray:
    """Standard deviation over mean of Hertz's force on one Gaussian summit, at places [m]."""
    z = RMS * ndtri((np.arange(200_000) + 0.5) / 200_000)
    force = np.maximum(z - places[:, None], 0.0) ** 1.5
    return force.std(axis=1) / force.mean(axis=1)


def _nodes(heights: np.ndarray) -> Spread:
    """Nodes as by default, their number the same for all draws: one compilation."""
    usual = spread_of(heights)
    nodes = {2: 96, 3: 128, 4: 192, 5: 288, 6: 448}[round(np.log10(heights.size))]
    low, high = heights.min(), heights.max()
    step = max((high - low) / (nodes - 9), 0.5 * usual.step)
    return Spread(low - 4.0 * step, step, nodes)


# --- summits of Gaussian random fields ---------------------------------------------------------


class Field(NamedTuple):
    """Summits of several maps of one random field, and what Nayak's theory says of them."""

    heights: np.ndarray
    radii: np.ndarray
    density: float
    known: Nayak

    @property
    def radius(self) -> float:
        return float(1.0 / np.mean(1.0 / self.radii))

    @property
    def scatter(self) -> float:
        return float(self.heights.std())


HURST, ROLLOFF, CUTOFF, LENGTH = 0.8, 180e-9, 36e-9, 16e-9


def gaussian_correlation(seed: int) -> Topography:
    return Topography(gaussian_surface((1024, 1024), PIXEL, RMS, LENGTH, seed), (PIXEL, PIXEL))


def self_affine_map(seed: int) -> Topography:
    return self_affine(
        (1024, 1024), (PIXEL, PIXEL), hurst=HURST, rolloff=ROLLOFF, cutoff=CUTOFF,
        rms_height=RMS, seed=seed,
    )  # fmt: skip


def self_affine_moments() -> Nayak:
    """Profile moments of the spectrum, flat below the roll-off and 0 above the cut-off."""
    bend, end = 2.0 * pi / ROLLOFF, 2.0 * pi / CUTOFF

    def integral(order: int) -> float:
        power = order - 2.0 * HURST
        beyond = ((end / bend) ** power - 1.0) / power
        return bend ** (order + 2) * (1.0 / (order + 2) + beyond)

    shares = {0: 1.0, 2: 0.5, 4: 0.375}
    scale = RMS**2 / integral(0)
    return Nayak(*(share * scale * integral(order) for order, share in shares.items()))


FIELDS = {
    "Gaussian correlation": (
        gaussian_correlation, Nayak(RMS**2, 2 * RMS**2 / LENGTH**2, 12 * RMS**2 / LENGTH**4), 8,
    ),
    "self-affine": (self_affine_map, self_affine_moments(), 24),
}  # fmt: skip


@cache
def field(name: str) -> Field:
    make, known, maps = FIELDS[name]
    found = [find_summits(make(seed)) for seed in range(maps)]
    return Field(
        np.concatenate([one.heights for one in found]),
        np.concatenate([one.radii for one in found]),
        float(np.mean([one.density for one in found])),
        known,
    )


def surfaces(name: str, of_radius: Callable = law) -> tuple[Interface, Interface]:
    """Interfaces of the summits, and of their Gaussian fit."""
    found = field(name)
    gaussian = Gaussian(found.scatter, float(found.heights.mean()))
    return (
        measured_surface(of_radius, found.heights, found.radii, found.density, radius=found.radius),
        Interface(of_radius(found.radius), gaussian, found.density),
    )


def expected(known: Nayak, power: float, exponent: float, separation: float) -> float:
    """Mean of R^power (z - h)^exponent over Nayak's summits that stand above h.

    His joint density of height s and curvature u, both reduced: `describing.nayak`.
    """
    node, weight = np.polynomial.legendre.leggauss(200)
    low, r = separation / sqrt(known.m0), known.correlation
    t = 0.5 * (node + 1.0)
    s, rise = low + (9.0 - low) * t**2, (9.0 - low) * t * weight
    u, wide = 9.0 * t, 4.5 * weight
    beside = np.exp(-(s[:, None] ** 2 - 2 * r * s[:, None] * u + u**2) / (2 * (1 - r**2)))
    share = 2.0 * sqrt(3.0) * (u**2 + np.expm1(-(u**2))) * beside / (2 * pi * sqrt(1 - r**2))
    radius = (u * sqrt(2.0 * known.m4 / 3.0)) ** -power
    overlap = (s - low) ** exponent * known.m0 ** (0.5 * exponent)
    return float(np.einsum("i,j,ij->", overlap * rise, radius * wide, share))


@cache
def beside(name: str) -> np.ndarray:
    """Elastic pressure and pull of summits over those of the Gaussian fit: rows, places.

    Then the same of Nayak's summits, over the Gaussian fit of his mean, rms and radius.
    """
    found = field(name)
    places = jnp.asarray(found.heights.mean() + found.scatter * np.array(PLACES))
    ours = [np.asarray(pressures(each, places)) for each in surfaces(name)]
    known = found.known
    level = known.mean_height + known.rms_height * np.array(PLACES)
    plain = Interface(law(known.radius), Gaussian(known.rms_height, known.mean_height), 1.0)
    fit = np.asarray(pressures(plain, jnp.asarray(level)))
    pull = 2 * pi * W + 4 * pi * TENSION * np.cos(ANGLE)
    theory = [
        [4.0 / 3.0 * E * expected(known, 0.5, 1.5, h) for h in level],
        [pull * expected(known, 1.0, 0.0, h) for h in level],
    ]
    return np.concatenate([ours[0] / ours[1], np.array(theory) / fit])


SAMPLED = "Nayak (1971), joint density of height and curvature"


@cache
def field_figures(name: str) -> tuple[Figure, ...]:
    """Limits: the sampling error of those that touch, twice, and 3 % for the pixel."""
    ratio, found = beside(name), field(name)
    rows = []
    for k, what in enumerate(("contact pressure", "pull of those that touch")):
        for j, place in enumerate(PLACES[:2]):
            contacting = np.count_nonzero(
                found.heights > found.heights.mean() + place * found.scatter
            )
            rows.append(
                Figure(
                    f"summits, {name}: {what} over that of their Gaussian fit, {place:g} rms up",
                    SAMPLED, ratio[2 + k, j], float(ratio[k, j]), "", 0.03 + 3.0 / sqrt(contacting),
                )
            )  # fmt: skip
    return tuple(rows)


BALL = 20e-6
MASS = 2200.0 * 4.0 / 3.0 * pi * BALL**3


@jax.jit
def _bounce(surface):
    contact = RigidContact(surface, Sphere(BALL))
    body = Body(MASS, 0.0, 60e-9, 5e-3)
    motion = simulate(contact, body, tolerance=Tolerance(max_impacts=1))
    return 1.0 - measure(motion, body).restitution[0] ** 2


def impact(name: str) -> float:
    """Share of energy that a rigid sphere of 20 um loses at 5 mm/s, over that on the fit."""
    loss = [float(_bounce(each)) for each in surfaces(name)]
    return loss[0] / loss[1]


@eqx.filter_jit
def _torn(surface, places):
    return jnp.min(surface.pressure(places, surface.saturated_memory(places), 1))


def pull_off(name: str, modulus: float) -> float:
    """Largest pull of the torn surface on a rigid sphere, over that of the Gaussian fit."""

    def soft(radius):
        return Hertz(radius, modulus) + law(radius).parts[1] + law(radius).parts[2]

    found = field(name)
    places = jnp.asarray(found.heights.mean() + found.scatter * np.linspace(-3.0, 8.0, 600))
    summits, fitted = (float(_torn(each, places)) for each in surfaces(name, soft))
    return summits / fitted


@cache
def drawn_figure(count: int) -> Figure:
    """Pressure 1 rms up, in the mean over the draws, within three of its sampling errors."""
    off = drawn(count)[:, 2]
    error = float(_scatter(np.array([RMS]))[0]) / sqrt(count)
    return Figure(
        f"{count} summits drawn with Gaussian heights: contact pressure 1 rms up, over gaussian's",
        f"mean of {off.size} draws; the limit is three of its sampling errors",
        1.0, 1.0 + float(off.mean()) * error, "", 3.0 * error / sqrt(off.size),
    )  # fmt: skip


def figures() -> list[Figure]:
    draws = [drawn_figure(count) for count in NUMBERS]
    return draws + [row for name in FIELDS for row in field_figures(name)]


@pytest.mark.parametrize("count", NUMBERS[:4])
def test_drawn_gaussian_summits_give_the_gaussian_force_within_their_sampling_error(count):
    off = drawn(count)
    assert drawn_figure(count).holds
    assert np.max(abs(off)) < 4.0
    assert np.sqrt(np.mean(off**2)) < 1.6


@pytest.mark.long
def test_a_million_drawn_summits_give_the_gaussian_force_within_their_sampling_error():
    assert np.max(abs(drawn(1_000_000))) < 4.0


@pytest.mark.parametrize("name", FIELDS)
def test_pressures_of_a_random_fields_summits_are_those_of_nayaks_joint_density(name):
    assert not misses(field_figures(name))


@pytest.mark.parametrize("name", FIELDS)
def test_higher_summits_of_a_random_field_are_sharper_so_that_they_pull_less(name):
    """Their radii are tied to their heights: less pull than one radius gives."""
    ratio = beside(name)
    assert (ratio[1, :2] < 0.95).all()
    assert (ratio[3, :2] < 0.95).all()


@pytest.mark.parametrize("name", FIELDS)
def test_summits_of_a_random_field_are_skewed_as_nayak_says(name):
    found = field(name)
    reduced = (found.heights - found.heights.mean()) / found.scatter
    error = sqrt(6.0 / reduced.size)
    assert found.known.skewness > 0.0
    assert np.mean(reduced**3) == pytest.approx(found.known.skewness, abs=4.0 * error)


@pytest.mark.long
@pytest.mark.parametrize("name", FIELDS)
def test_an_impact_on_the_summits_loses_less_than_on_their_fit(name):
    """Sharper tips have smaller menisci."""
    assert 0.7 < impact(name) < 0.95


@pytest.mark.parametrize("name", FIELDS)
def test_the_pull_off_of_soft_summits_is_near_that_of_their_fit_and_of_stiff_ones_is_not(name):
    """Where few touch, the highest summits decide, and a fit's tail has other ones."""
    assert pull_off(name, 1e9) == pytest.approx(1.0, abs=0.2)
    assert pull_off(name, 50e9) > 3.0
