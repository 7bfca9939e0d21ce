"""Measured summits, each with its own height and radius: forces, bonds, motions, gradients."""

import itertools
from math import pi, radians

import equinox as eqx
import numpy as np
import pytest

from asperity._jax import jax, jnp
from asperity.contact import RigidContact
from asperity.contact.profile import Sphere
from asperity.dynamics import Body, simulate
from asperity.errors import Tolerance
from asperity.interface.height_quadrature import Near
from asperity.interface.interface import Interface
from asperity.interface.layers import Layers
from asperity.interface.measured_summits import loss_error, measured_surface
from asperity.interface.radius_classes import RadiusClasses, members
from asperity.laws import Bradley, ByKelvinGap, ConstantVolume, Dmt, Hertz, Jkr, Maugis, Meniscus
from asperity.results.measures import measure
from asperity.surfaces.heights import Gaussian, spread_of
from chosen import long_but

E, W, SIGMA, N = 5e9, 0.05, 4e-9, 1e14
ANGLE = radians(40.0)
COUNT = 1000
_RANDOM = np.random.default_rng(5)
HEIGHTS = SIGMA * (_RANDOM.gamma(8.0, size=COUNT) - 8.0) / np.sqrt(8.0)
RADII = 2.5e-7 * np.exp(0.4 * _RANDOM.standard_normal(COUNT) - 0.1 * HEIGHTS / SIGMA)
RADIUS = float(1.0 / np.mean(1.0 / RADII))
PATH = np.array([4.0, 1.0, 2.5, -1.0, 3.0, 0.5, 1.2, 0.0, 4.5, -0.5, 2.0, 9.0]) * SIGMA


def JKR(radius):
    """Soft summits."""
    return Jkr(radius, E, W)


# --- the force of each radius ------------------------------------------------------------------

POWERED = {
    "hertz": lambda radius: Hertz(radius, E),
    "dmt": lambda radius: Dmt(radius, W),
    "bradley": lambda radius: Bradley(radius, W, 3e-10),
    "meniscus": lambda radius: Meniscus(radius, 0.0728, ANGLE, 1.3e-9),
    "kelvin meniscus": lambda radius: Meniscus(radius, 0.0728, ANGLE, 1.3e-9, ByKelvinGap()),
}


@pytest.mark.parametrize("make", POWERED.values(), ids=POWERED)
def test_a_law_grows_with_its_power_of_the_radius_and_keeps_its_gaps(make):
    """What lets one law, weighted, stand for all radii."""
    one, other = make(1e-7), make(3.7e-7)
    scale = 3.7**one.radius_power
    gap = jnp.linspace(-5e-9, 5e-9, 21)
    for branch in ("force", "energy", "bonded_force", "bonded_energy"):
        here, there = getattr(one, branch)(gap), getattr(other, branch)(gap)
        np.testing.assert_allclose(there, scale * here, rtol=1e-13)
    for name in ("forming_gap", "breaking_gap", "interaction_range"):
        assert float(getattr(one, name)) == float(getattr(other, name))


@pytest.mark.parametrize("make", [JKR, lambda r: Maugis(r, E, W, 1e-9)])
def test_jkr_and_maugis_have_gaps_of_their_own_for_each_radius(make):
    assert make(1e-7).radius_power == 0.0
    assert float(make(4e-7).breaking_gap) > 1.01 * float(make(1e-7).breaking_gap)


class Relays:
    """Brute force: every summit with its own law, its own gap and its own bond."""

    def __init__(self, make, heights, radii):
        self.heights, self.laws = heights, make(jnp.asarray(radii))
        self.losses = [np.asarray(self.laws.formation_loss), np.asarray(self.laws.rupture_loss)]
        self.gaps = [np.asarray(self.laws.forming_gap), np.asarray(self.laws.breaking_gap)]
        self.bonded, self.lost = np.zeros(heights.size, bool), 0.0

    def step(self, separation):
        """Pressure, energy, loss and bonds per area after a move to a separation [m]."""
        gap = separation - self.heights
        now = (gap <= self.gaps[0]) | (self.bonded & (gap < self.gaps[1]))
        formed, broken = now & ~self.bonded, self.bonded & ~now
        self.lost += np.mean(formed * self.losses[0] + broken * self.losses[1])
        self.bonded = now
        pressure, energy = _single(self.laws, jnp.asarray(gap), jnp.asarray(now))
        return N * np.array([float(pressure), float(energy), self.lost, np.mean(now)])


@jax.jit
def _single(laws, gap, bonded):
    force = jnp.where(bonded, laws.bonded_force(gap), laws.force(gap))
    energy = jnp.where(bonded, laws.bonded_energy(gap), laws.energy(gap))
    return jnp.mean(force), jnp.mean(energy)


@eqx.filter_jit
def _step(surface, memory, separation):
    return surface.measure(separation, memory), surface.remember(memory, separation)


def followed(surface, path):
    """Pressure, energy, loss and bonds along a path, a row a step; the memory at its end."""
    memory, bonds, lost, rows = surface.initial_memory(), 0.0, 0.0, []
    formation, rupture = (np.asarray(each) for each in surface.losses())
    for separation in path:
        means, memory = _step(surface, memory, jnp.asarray(separation))
        change, bonds = np.asarray(means.bonds) - bonds, np.asarray(means.bonds)
        lost += np.maximum(change, 0.0) @ formation + np.maximum(-change, 0.0) @ rupture
        rows.append([float(jnp.sum(means.parts)), float(means.energy), lost, bonds.sum()])
    return np.array(rows), memory


def test_one_memory_weighted_by_radii_is_the_bonds_of_all_summits_over_reversals():
    """Hertz + DMT + meniscus of 1000 radii against a relay each, along twelve reversals.

    To the sampling error's twentieth, the kernel's: the meniscus by its counted bonds.
    """
    meniscus = POWERED["meniscus"]
    make = lambda radius: Hertz(radius, E) + Dmt(radius, W) + meniscus(radius)  # noqa: E731
    surface = measured_surface(make, HEIGHTS, RADII, N, radius=RADIUS)
    assert isinstance(surface, Interface)
    relays = Relays(meniscus, HEIGHTS, RADII)
    law = [Relays(POWERED[name], HEIGHTS, RADII) for name in ("hertz", "dmt")]
    exact = np.array(
        [relays.step(h) + sum(each.step(h) for each in law)[[0, 1, 2, 2]] for h in PATH]
    )
    ours, _ = followed(surface, PATH)
    scale = np.max(abs(exact), axis=0)
    off = np.max(abs(ours - exact), axis=0)[:3] / scale[:3]
    assert max(off) < 5e-3


# --- classes of radius -------------------------------------------------------------------------


def test_every_summit_belongs_to_one_class_and_classes_to_separate_ranges():
    for classes in (1, 2, 6, 64):
        parts = members(RADII, classes)
        np.testing.assert_array_equal(np.sort(np.concatenate(parts)), np.arange(COUNT))
        ends = [(RADII[part].min(), RADII[part].max()) for part in parts]
        assert all(low[1] <= high[0] for low, high in itertools.pairwise(ends))


def test_the_error_of_classes_falls_with_the_square_of_their_number():
    errors = [loss_error(JKR, RADII, classes) for classes in (1, 2, 4, 8)]
    assert max(errors) < 0.0
    assert all(2.0 < a / b < 6.0 for a, b in itertools.pairwise(errors))
    assert loss_error(JKR, np.full(50, 1e-7), 6) == pytest.approx(0.0, abs=1e-14)

    # Quantiles stand for many radii.
    many = np.concatenate([RADII] * 9)
    assert loss_error(JKR, many, 2) == pytest.approx(errors[1], rel=0.02)


def test_laws_weighted_summit_by_summit_have_no_error_of_classes():
    for make in POWERED.values():
        assert loss_error(make, RADII, 1) == 0.0


CYCLE = np.array([30.0, -12.0, 30.0]) * SIGMA


@pytest.fixture(scope="module")
def jkr_path():
    """What relays of 1000 JKR summits do along the path, and what classes of them do."""
    relays = Relays(JKR, HEIGHTS, RADII)
    exact = np.array([relays.step(h) for h in PATH])
    classed = {}
    for classes in (1, 4):
        surface = measured_surface(JKR, HEIGHTS, RADII, N, radius=RADIUS, classes=classes)
        classed[classes] = followed(surface, PATH)[0], followed(surface, CYCLE)[0]
    return exact, classed


def test_more_classes_come_closer_to_a_relay_for_each_jkr_summit(jkr_path):
    """Pressure, energy and loss, over their largest; the loss by counted bonds, one by one."""
    exact, classed = jkr_path
    scale = np.max(abs(exact), axis=0)[:3]
    off = {
        classes: np.max(abs(rows - exact), axis=0)[:3] / scale
        for classes, (rows, _) in classed.items()
    }
    assert max(off[1]) < 0.1
    assert max(off[4]) < 0.02
    assert (off[4] < np.array([0.25, 0.25, 0.75]) * off[1]).all()


def test_the_stated_error_is_that_of_the_energy_which_jkr_bonds_lose(jkr_path):
    """In until all touch and out until none does: R^(4/3) a summit, exactly."""
    work = 7.092196 * np.mean((W**5 * RADII**4 / E**2) ** (1.0 / 3.0)) * N
    for classes, (_, rows) in jkr_path[1].items():
        assert rows[-1, 2] / work == pytest.approx(1.0 + loss_error(JKR, RADII, classes), rel=1e-6)


def test_where_each_class_holds_one_radius_its_threshold_is_that_of_its_relays():
    """Exact: three radii, three classes, random reversals; also their counts and elastic laws."""
    radii = np.array([1e-7, 2e-7, 4e-7])[np.arange(COUNT) % 3]
    cut = [np.flatnonzero(radii == radius) for radius in (1e-7, 2e-7, 4e-7)]
    surface = measured_surface(JKR, HEIGHTS, radii, N, radius=2e-7, classes=cut)
    assert isinstance(surface, RadiusClasses)
    relays, memory = Relays(JKR, HEIGHTS, radii), surface.initial_memory()
    remember = eqx.filter_jit(surface.remember)
    for separation in SIGMA * np.random.default_rng(1).uniform(-3.0, 4.0, 200):
        relays.step(separation)
        memory = remember(memory, jnp.asarray(separation))
        for part, threshold in zip(cut, memory, strict=True):
            np.testing.assert_array_equal(relays.bonded[part], HEIGHTS[part] > float(threshold))


TABULATED = {
    "jkr": JKR,
    "stiff jkr": lambda radius: Jkr(radius, 50e9, W),
    "maugis": lambda radius: Maugis(radius, E, W, 1e-9),
}


@pytest.fixture(scope="module", params=long_but(TABULATED, "maugis"))
def two_ways(request):
    """Two classes whose branches are tabulated, and the same by quadrature throughout."""
    parts = measured_surface(
        TABULATED[request.param], HEIGHTS, RADII, N, radius=RADIUS, classes=2
    ).parts
    tabulated, plain = RadiusClasses(parts), RadiusClasses(parts, tabulated=False)
    assert tabulated.tables
    assert not plain.tables
    return tabulated, plain


@eqx.filter_jit
def _all_means(surface, places, memory, integrated):
    return surface.measure(places, memory, integrated)


@pytest.mark.parametrize("integrated", [0, 1])
def test_tabulated_branches_are_the_quadratures_from_far_below_the_heights_to_the_top(
    two_ways, integrated
):
    """Pressures to the quadrature's 1e-5 of what is there 2 rms up, forces on
    paraboloids to the 1e-6 that quintic cells leave."""
    places = jnp.asarray(SIGMA * np.concatenate([-np.geomspace(400, 8, 9), np.linspace(-7, 6, 27)]))
    for memory in (
        two_ways[0].initial_memory(),
        two_ways[0].saturated_memory(),
        (jnp.asarray(1e-9),) * 2,
    ):
        ours, exact = (_all_means(each, places, memory, integrated) for each in two_ways)
        for one, other in zip(ours, exact, strict=True):
            one, other = np.atleast_2d(one), np.atleast_2d(other)
            least = np.max(np.abs(other[:, places > 2.0 * SIGMA]), axis=1, keepdims=True)
            off = np.abs(one - other) / (np.abs(other) + least)
            assert off.max() < (1e-6 if integrated else 1e-5)


@eqx.filter_jit
def fall(surface, places, memory):
    """The pressure, and the slope of the paraboloid's force."""
    force = lambda places: surface.pressure(places, memory, 1)  # noqa: E731
    return surface.pressure(places, memory), jax.jvp(force, (places,), (1 + 0 * places,))[1]


@eqx.filter_jit
def first_approach(surface, places):
    """The work of it, and the energy of surfaces that came no closer before."""
    return surface.work_of_approach(places), surface.energy(places, surface.initial_memory())


measured_at = eqx.filter_jit(lambda surface, *given: surface.measure(*given))


def test_the_pressure_of_tabulated_branches_is_a_fall_of_the_paraboloids_force(two_ways):
    """p = -dF/dh at fixed gaps of the bonds, and a work of approach that is the energy."""
    surface, _ = two_ways
    places = jnp.asarray(SIGMA * np.linspace(-20.0, 3.0, 24))
    for unloading in (surface.initial_memory(), surface.saturated_memory()):
        pressure, slope = fall(surface, places, unloading)
        largest = float(jnp.max(jnp.abs(pressure)))
        np.testing.assert_allclose(-slope, pressure, rtol=1e-5, atol=1e-7 * largest)
    np.testing.assert_array_equal(*first_approach(surface, places))


@pytest.mark.parametrize("unloading", [True, False])
def test_on_scanning_curves_the_bonds_of_each_class_add_to_tabulated_branches(two_ways, unloading):
    """Both ends and all pieces of the way, against quadratures of all bonds, which are the
    less exact of the two."""
    surface, start = two_ways[0], 0.5 * SIGMA
    gaps = [part.law.forming_gap if unloading else part.law.breaking_gap for part in surface.parts]
    memory = tuple(jnp.asarray(start - gap) for gap in gaps)
    ends = np.sort([float(end) for end in surface.rejoining(memory, jnp.asarray(unloading))])
    marks = np.array([start, *(ends if unloading else ends[::-1])])
    steps = np.array([1e-6, 0.1, 0.4, 0.7, 0.9, 1.0 - 1e-6])
    places = jnp.asarray(marks[:-1, None] + np.diff(marks)[:, None] * steps)
    ours = measured_at(surface, places, memory, 1, Near(level=False))
    exact = _all_means(two_ways[1], places, memory, 1)
    for one, other in ((ours.parts, exact.parts), (ours.energy, exact.energy)):
        np.testing.assert_allclose(one, other, rtol=0.0, atol=2e-8 * np.max(np.abs(other)))
    np.testing.assert_allclose(ours.bonds, exact.bonds, rtol=1e-12)


def test_bonds_that_stretch_over_many_rms_heights_are_integrated_in_pieces():
    """Bridges of 4 to 5 rms, along a scanning curve, against quadratures of all bonds."""
    make = lambda radius: ConstantVolume(radius, 0.0728, ANGLE, 1.3e-9)  # noqa: E731
    parts = measured_surface(make, HEIGHTS, RADII, N, radius=RADIUS, classes=2).parts
    surface, plain = RadiusClasses(parts), RadiusClasses(parts, tabulated=False)
    assert surface.pieces > 2
    start = -1.0 * SIGMA
    memory = (jnp.asarray(start),) * 2
    end = float(max(surface.rejoining(memory, jnp.asarray(True))))
    places = jnp.linspace(start, end, 101)[None]
    ours = measured_at(surface, places, memory, 1, Near(level=False))
    exact = measured_at(plain, places, memory, 1)
    for one, other, off in ((ours.parts, exact.parts, 1e-6), (ours.energy, exact.energy, 5e-6)):
        np.testing.assert_allclose(one, other, rtol=0.0, atol=off * np.max(np.abs(other)))


def test_branches_of_bonds_far_longer_than_the_heights_are_wide_are_the_quadratures():
    """Bridges that break 11 to 14 rms above touch: on approach none is there before touch."""
    make = lambda radius: ConstantVolume(radius, 0.0728, ANGLE, 6e-9)  # noqa: E731
    parts = measured_surface(make, HEIGHTS, RADII, N, radius=RADIUS, classes=2).parts
    surface, plain = RadiusClasses(parts), RadiusClasses(parts, tabulated=False)
    assert surface.tables
    places = jnp.asarray(
        SIGMA * np.concatenate([-np.geomspace(400, 8, 9), np.linspace(-7, 23, 61)])
    )
    for memory in (surface.initial_memory(), surface.saturated_memory()):
        ours, exact = (_all_means(each, places, memory, 1) for each in (surface, plain))
        for one, other in zip(ours, exact, strict=True):
            np.testing.assert_allclose(one, other, rtol=0.0, atol=4e-6 * np.max(np.abs(other)))


def test_laws_that_act_before_touch_have_no_table():
    """Bridges formed at the Kelvin gap: every mean is a quadrature."""
    make = lambda radius: ConstantVolume(radius, 0.0728, ANGLE, 1.3e-9, ByKelvinGap())  # noqa: E731
    surface = measured_surface(make, HEIGHTS, RADII, N, radius=RADIUS, classes=2)
    assert isinstance(surface, RadiusClasses)
    assert not surface.tables
    assert measured_surface(JKR, HEIGHTS, RADII, N, radius=RADIUS, classes=2).tables


@pytest.mark.long
def test_more_classes_come_closer_to_a_relay_for_each_maugis_summit():
    """Where its hysteresis is small it grows steeply with the radius: the loss is the worst."""
    make = lambda radius: Maugis(radius, E, W, 2e-9)  # noqa: E731
    relays = Relays(jax.vmap(make), HEIGHTS, RADII)
    exact = np.array([relays.step(h) for h in PATH])
    scale = np.max(abs(exact), axis=0)[:3]
    off = []
    for classes in (2, 4, 8):
        surface = measured_surface(make, HEIGHTS, RADII, N, radius=RADIUS, classes=classes)
        off.append(np.max(abs(followed(surface, PATH)[0] - exact), axis=0)[:3] / scale)
    assert (off[1] < 0.75 * off[0]).all()
    assert (off[2] < off[1]).all()
    assert max(off[2][:2]) < 5e-3
    assert off[2][2] < 0.08


def test_jkr_with_menisci_is_classes_beside_an_exact_layer():
    """Contacts are counted once, and the parts have the names of one interface."""
    make = lambda radius: JKR(radius) + POWERED["meniscus"](radius)  # noqa: E731
    surface = measured_surface(make, HEIGHTS, RADII, N, radius=RADIUS, classes=3)
    assert isinstance(surface, Layers)
    assert surface.components == Interface(make(RADIUS), Gaussian(SIGMA), N).components
    means, _ = _step(surface, surface.initial_memory(), jnp.asarray(0.5 * SIGMA))
    contacting = N * np.mean(HEIGHTS > 0.5 * SIGMA)
    assert float(means.contacting) == pytest.approx(contacting, rel=0.02)


# --- motions and their gradients ---------------------------------------------------------------

BALL = 20e-6
MASS = 2200.0 * 4.0 / 3.0 * pi * BALL**3
BODY = Body(MASS, 9.81, 200e-9, 1e-3)
STIFF = 50e9


def wet(radius):
    return Hertz(radius, STIFF) + Dmt(radius, 0.03) + Meniscus(radius, 0.0728, 0.9, 0.8e-9)


def moved(surface, impacts):
    """The motion of a rigid ball over so many impacts."""
    contact = RigidContact(surface, Sphere(BALL))
    return simulate(contact, BODY, tolerance=Tolerance(max_impacts=impacts))


@pytest.mark.parametrize(
    ("law", "spread"), long_but([(wet, 0.05), (wet, 1e-3), (JKR, 0.05)], (wet, 1e-3))
)
def test_the_ledger_closes_on_summits_of_two_levels(law, spread):
    """Such as steps that were etched: curves and ways are cut as finely as their heights ask."""
    random = np.random.default_rng(0)
    heights = np.where(random.random(COUNT) < 0.5, -1.0, 1.0)
    heights = SIGMA * (heights + spread * random.standard_normal(COUNT))
    surface = measured_surface(law, heights, RADII, N, radius=RADIUS)
    impacts = eqx.filter_jit(moved)(surface, 2).impacts
    energy_balance_error = impacts.energy_balance_error / (0.5 * MASS * 1e-3**2)
    assert np.asarray(impacts.made).all()
    assert float(jnp.max(energy_balance_error)) < 1e-6


def decrement(surface):
    return measure(moved(surface, 1), BODY).log_decrement[0]


def fourth_order(value, step):
    """Central difference of a function of one number at 0."""
    at = {k: float(value(k * step)) for k in (-2, -1, 1, 2)}
    return (8.0 * (at[1] - at[-1]) - (at[2] - at[-2])) / (12.0 * step)


def test_decrement_of_gaussian_summits_has_a_gradient_by_their_rms_height():
    """And by their mean height; against central differences to 1e-7."""

    def first(rms_height, mean_height):
        return decrement(Interface(wet(RADIUS), Gaussian(rms_height, mean_height), N))

    both = jax.jit(lambda *at: jax.jvp(first, at, (jnp.asarray(0.6), jnp.asarray(0.4))))
    value, slope = both(jnp.asarray(SIGMA), jnp.asarray(5e-9))
    assert float(value) > 0.0
    along = lambda x: both(jnp.asarray(SIGMA + 0.6 * x), jnp.asarray(5e-9 + 0.4 * x))[0]  # noqa: E731
    assert float(slope) == pytest.approx(fourth_order(along, 1e-12), rel=1e-7)


def along_heights_and_radii(law, **classes):
    """Decrement of 1000 summits and its slope, where both vectors change at once."""
    spread = spread_of(HEIGHTS)
    ways = np.random.default_rng(2).standard_normal((2, COUNT)) * [[1.0], [RADIUS / SIGMA]]

    def first(heights, radii):
        kind = {"radius": RADIUS, "spread": spread, **classes}
        return decrement(measured_surface(law, heights, radii, N, **kind))

    @jax.jit
    def both(x):
        moved = (HEIGHTS + x * ways[0], RADII + x * ways[1])
        return jax.jvp(first, moved, tuple(jnp.asarray(way) for way in ways))

    return both, first, ways


@pytest.mark.long
def test_decrement_of_summits_has_a_gradient_over_their_heights_and_radii():
    """Forward, 1000 heights and 1000 radii at once, against central differences to 1e-7.

    In reverse its product with a direction is the derivative along it, to 1e-9.
    """
    both, first, ways = along_heights_and_radii(wet)
    value, slope = both(jnp.zeros(()))
    assert float(value) > 0.0
    found = fourth_order(lambda x: both(jnp.asarray(x))[0], 1e-13)
    assert float(slope) == pytest.approx(found, rel=1e-7)
    slopes = jax.jit(jax.grad(first, (0, 1)))(jnp.asarray(HEIGHTS), jnp.asarray(RADII))
    product = sum(float(each @ way) for each, way in zip(slopes, ways, strict=True))
    assert product == pytest.approx(float(slope), rel=1e-9)


@pytest.mark.long
def test_decrement_of_jkr_classes_has_a_derivative_along_heights_and_radii():
    cut = members(RADII, 3)
    both, *_ = along_heights_and_radii(lambda radius: Jkr(radius, STIFF, W), classes=cut)
    slope = float(both(jnp.zeros(()))[1])
    assert slope == pytest.approx(fourth_order(lambda x: both(jnp.asarray(x))[0], 1e-12), rel=1e-6)
