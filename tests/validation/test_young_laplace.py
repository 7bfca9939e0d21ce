"""The solver that judges menisci, against closed forms and against itself by another way."""

from math import cos, pi, radians, sin, sqrt

import numpy as np
import pytest
from scipy.integrate import quad

import young_laplace as yl
from figures import Figure, misses

BRIDGES = [
    (yl.sphere_and_plane(radians(0.0)), 1e-3, 0.05),
    (yl.sphere_and_plane(radians(40.0)), 1e-2, 0.2),
    (yl.sphere_and_plane(radians(80.0)), 0.1, 0.02),  # bulges: it has no neck
    (yl.equal_spheres(radians(0.0)), 0.1, 0.4),
    (yl.equal_spheres(radians(70.0)), 1e-4, 0.06),
]
bridges = pytest.mark.parametrize(("bodies", "volume", "separation"), BRIDGES)


@bridges
def test_integration_along_the_arc_meets_both_bodies_and_the_volume(bodies, volume, separation):
    bridge = yl.stretched(bodies, volume, [separation])[0]
    _, _, (radius, height, slope, content) = yl.integrated(bridge)
    sags = yl.sag(bodies.lower, bridge.foot) + yl.sag(bodies.upper, bridge.head)
    caps = yl.cap_volume(bodies.lower, bridge.foot) + yl.cap_volume(bodies.upper, bridge.head)
    assert radius == pytest.approx(bridge.head, rel=1e-10)
    assert height - sags == pytest.approx(separation, rel=1e-9)
    assert slope == pytest.approx(bodies.upper_angle + np.arcsin(bodies.upper * radius), rel=1e-10)
    assert content - caps == pytest.approx(volume, rel=1e-9)


@bridges
def test_both_contact_lines_and_the_neck_carry_the_same_force(bodies, volume, separation):
    bridge = yl.stretched(bodies, volume, [separation])[0]
    for r, _, slope, _ in yl.integrated(bridge):
        if np.isfinite(r):
            carried = 2.0 * pi * r * sin(slope) - pi * r**2 * bridge.pressure
            assert carried == pytest.approx(bridge.pull, rel=1e-8)
    assert bridge.pull_on_upper == pytest.approx(bridge.pull, rel=1e-8)


@bridges
def test_the_pull_is_the_slope_of_the_surface_energy_at_constant_volume(bodies, volume, separation):
    step = 1e-3 * separation
    places = separation + step * np.array([-2.0, -1.0, 1.0, 2.0, 0.0])
    *around, middle = yl.stretched(bodies, volume, places)
    slope = np.array([1.0, -8.0, 8.0, -1.0]) @ [b.energy for b in around] / (12.0 * step)
    assert slope == pytest.approx(middle.pull, rel=1e-7)


@bridges
def test_the_solution_does_not_depend_on_the_unit_of_length(bodies, volume, separation):
    here = yl.stretched(bodies, volume, [separation])[0]
    large = yl.Bodies(
        bodies.lower_angle, bodies.upper_angle, 1e-3 * bodies.lower, 1e-3 * bodies.upper
    )
    there = yl.stretched(large, 1e9 * volume, [1e3 * separation])[0]
    assert there.pull == pytest.approx(1e3 * here.pull, rel=1e-9)
    assert there.pressure == pytest.approx(1e-3 * here.pressure, rel=1e-8)


def cylinder():
    """At 90 degrees: tension 2 pi r less the pressure 1/r on pi r^2."""
    upright = yl.Bodies(0.5 * pi, 0.5 * pi, 0.0, 0.0)
    bridge = yl.stretched(upright, 1.0, [0.7])[0]
    problem, known = "solver of menisci, cylinder between planes: pull", pi * sqrt(1.0 / (0.7 * pi))
    return Figure(problem, "closed form", known, bridge.pull, "gamma V^(1/3)", 1e-10)


def between_planes(degrees):
    """Vogel (2005): there it branches. With p = 1 it has r^2 = 1 + cos^2 - 2 cos(angle) cos(t)."""
    angle = radians(degrees)
    planes = yl.Bodies(angle, angle, 0.0, 0.0)

    def r(t):
        return sqrt(1.0 + cos(angle) ** 2 - 2.0 * cos(angle) * cos(t))

    def rise(t):
        return 0.5 * (sin(angle) ** 2 + r(t) ** 2) / r(t)

    height = quad(rise, -angle, angle, epsabs=1e-13)[0]
    volume = quad(lambda t: pi * r(t) ** 2 * rise(t), -angle, angle, epsabs=1e-13)[0]
    expected = height / volume ** (1.0 / 3.0)
    problem = f"solver of menisci, between planes, {degrees:g} degrees: rupture"
    found = yl.rupture(planes, 1.0).separation
    return Figure(problem, "branch point, Vogel (2005)", expected, found, "V^(1/3)", 1e-8)


PLANES = (40.0, 60.0, 80.0, 90.0)  # degrees


def figures():
    return [cylinder(), *map(between_planes, PLANES)]


def test_known_figures_are_met():
    assert misses(figures()) == []


@pytest.mark.parametrize("degrees", [0.0, 20.0])
def test_a_well_wetting_bridge_between_planes_ends_at_its_fold_before_it_branches(degrees):
    angle = radians(degrees)
    planes = yl.Bodies(angle, angle, 0.0, 0.0)
    last = yl.rupture(planes, 1.0)
    half = yl.Bodies(0.5 * pi, angle, 0.0, 0.0)
    fold = yl.critical(yl.seed(half, 0.5), "volume", lambda b: yl.stability(b, "volume"))
    assert last.separation == pytest.approx(2.0 * fold.separation, rel=1e-9)


@pytest.mark.parametrize("degrees", [0.0, 50.0, 80.0])
def test_no_bridge_is_wider_than_the_one_at_rupture(degrees):
    bodies = yl.sphere_and_plane(radians(degrees))
    last = yl.rupture(bodies, 1e-2)
    near = last.separation * (1.0 - 1e-4 * np.arange(1, 4))
    before = yl.stretched(bodies, 1e-2, near)
    # The unknowns change as the root of the distance to a fold.
    feet = [(b.foot - last.foot) ** 2 for b in before]
    assert feet[1] / feet[0] == pytest.approx(2.0, rel=0.1)
    assert feet[2] / feet[0] == pytest.approx(3.0, rel=0.1)
    with pytest.raises(yl.NoBridge):
        yl.solved(last, bodies, volume=1e-2, separation=1.0001 * last.separation)


def edge_energy(angle):
    return (pi - 2.0 * angle + sin(2.0 * angle)) / (4.0 * cos(angle))


def kelvin_bridge(angle, kelvin_radius):
    """In equilibrium with the vapour, between a plane and a sphere of radius 1 that touch."""
    bodies = yl.sphere_and_plane(angle)
    near = yl.stretched(bodies, pi * (2.0 * kelvin_radius * cos(angle)) ** 2, [0.0])[0]
    return yl.solved(near, bodies, pressure=-1.0 / kelvin_radius, separation=0.0)


ANGLES = pytest.mark.parametrize("degrees", [0.0, 40.0, 80.0])


@ANGLES
def test_equilibrium_meniscus_at_touch_tends_to_the_classical_pull_as_its_root(degrees):
    """4 pi R cos(angle) less the edge: a share (e/2) sqrt(r_k/(R cos(angle))), e its energy."""
    angle = radians(degrees)
    for kelvin_radius, accuracy in ((1e-3, 0.06), (1e-4, 0.02), (1e-5, 0.006)):
        missing = 1.0 - kelvin_bridge(angle, kelvin_radius).pull / (4.0 * pi * cos(angle))
        expected = 0.5 * edge_energy(angle) * sqrt(kelvin_radius / cos(angle))
        assert missing == pytest.approx(expected, rel=accuracy)


@ANGLES
def test_equilibrium_pull_falls_in_a_straight_line_but_for_its_edge(degrees):
    """Eq. 12 on half of its range; the edge costs -e c R/(2 x), x its radius, of 4 pi R cos."""
    angle, kelvin_radius = radians(degrees), 1e-4
    bridge, interaction_range = (
        kelvin_bridge(angle, kelvin_radius),
        2.0 * kelvin_radius * cos(angle),
    )
    for share in (0.1, 0.2, 0.3, 0.4, 0.5):
        bridge = yl.solved(
            bridge,
            bridge.bodies,
            pressure=-1.0 / kelvin_radius,
            separation=share * interaction_range,
        )
        straight = 1.0 - share
        edge = 0.5 * edge_energy(angle) / cos(angle) * sqrt(0.5 * interaction_range / (1.0 - share))
        pull = bridge.pull / (4.0 * pi * cos(angle))
        assert pull == pytest.approx(straight - edge, abs=0.05 * edge)


@ANGLES
def test_equilibrium_meniscus_breaks_short_of_the_kelvin_gap_by_a_third_power(degrees):
    """By 1.5 e^(2/3) (r_k/(2 R cos(angle)))^(1/3) of the gap c: 5 to 10 % even at r_k = 1e-4 R."""
    angle = radians(degrees)
    for kelvin_radius, accuracy in ((1e-3, 0.02), (1e-4, 0.005)):
        first = kelvin_bridge(angle, kelvin_radius)
        last = yl.critical(first, "pressure", lambda b: yl.stability(b, "pressure"))
        short = 1.0 - last.separation / (2.0 * kelvin_radius * cos(angle))
        expected = 1.5 * (edge_energy(angle) ** 2 * kelvin_radius / (2.0 * cos(angle))) ** (1 / 3)
        assert short == pytest.approx(expected, rel=accuracy)
