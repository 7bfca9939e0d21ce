"""Static jump-in and jump-out of a body on a spring: where dF/dd is the stiffness."""

from __future__ import annotations

from math import pi, sqrt

import pytest
from numpy.polynomial import Chebyshev
from scipy.optimize import brentq

import asperity
from asperity.config.case_file import load
from asperity.dynamics.jumps import Segment, first_jump, jumps
from jkr_spheres import RADIUS, SMOOTH, SPRUNG, UNIT, W, jkr

FORCE, LENGTH = W * RADIUS, UNIT / (W * RADIUS)
FOLD = (pi / 8.0) ** (1.0 / 3.0)


def pressed(stiffness, model="jkr"):
    """The curve to a load of 1 uN of one of :mod:`jkr_spheres`, on a spring."""
    case = load(SPRUNG.replace('"jkr"', f'"{model}"'))
    return asperity.curve(case.replace({"suspension.stiffness": stiffness}), load=1e-6)


def energy(a):
    """Stored energy of JKR at a contact radius, for w = R = E* = 1, less than that apart.

    Elastic: Hertz to that radius, then the flat punch back (Johnson 1985, ch. 5.5); and the
    surface that is gained.
    """
    back = sqrt(2.0 * pi * a)
    return 8.0 * a**5 / 15.0 - 4.0 / 3.0 * a**3 * back + a * back**2 - pi * a**2


def stiffness_of(a):
    """dF/d(overlap) of JKR at a contact radius, for w = R = E* = 1."""
    return (4.0 * a * a - sqrt(18.0 * pi * a)) / (2.0 * a - sqrt(0.5 * pi / a))


@pytest.mark.parametrize("stiffness", [0.5, 50.0, 5e4])
def test_a_jkr_sphere_jumps_where_the_slope_of_its_force_is_the_stiffness(stiffness):
    found = pressed(f"{stiffness} N/m").jumps
    assert found["note"] is None
    k = stiffness * LENGTH / FORCE
    # The slope against the separation is that against the overlap with the other sign.
    at = brentq(lambda a: stiffness_of(a) + k, FOLD * (1.0 + 1e-13), 1.53, xtol=1e-16, rtol=1e-15)
    force, overlap = jkr(at)
    out = found["out"]
    assert out["separation"] == pytest.approx(-overlap * LENGTH, rel=1e-8)
    assert out["force"] == pytest.approx(force * FORCE, rel=1e-8)
    assert out["landing_separation"] == pytest.approx((-overlap - force / k) * LENGTH, rel=1e-8)
    assert out["landing_force"] == 0.0
    lost = energy(at) + 0.5 * force**2 / k
    assert out["energy"] == pytest.approx(lost * UNIT, rel=1e-7)
    # It jumps in at first contact, where the force is none, onto the line of the spring.
    landed = brentq(lambda a: jkr(a)[0] + k * jkr(a)[1], 1.0, 60.0, xtol=1e-15, rtol=1e-15)
    into = found["in"]
    assert (into["separation"], into["force"]) == pytest.approx((0.0, 0.0), abs=1e-18)
    assert into["landing_separation"] == pytest.approx(-jkr(landed)[1] * LENGTH, rel=1e-8)
    assert into["landing_force"] == pytest.approx(jkr(landed)[0] * FORCE, rel=1e-8)
    lost = -energy(landed) - 0.5 * k * jkr(landed)[1] ** 2
    assert into["energy"] == pytest.approx(lost * UNIT, rel=1e-7)


def test_a_bradley_sphere_jumps_in_where_its_tail_is_as_steep_as_the_spring():
    """Force -2 pi w R (4 y^2 - y^8)/3 with y = eps/(gap + eps), slope by hand."""
    spacing, stiffness = 0.2e-9, 20.0
    slope = lambda y: 2.0 * pi * W * RADIUS * (8.0 * y**3 - 8.0 * y**9) / 3.0 / spacing  # noqa: E731
    steep = brentq(lambda y: slope(y) - stiffness, 1e-6, 0.5, xtol=1e-18, rtol=1e-15)
    found = pressed(f"{stiffness} N/m", "bradley").jumps["in"]
    assert found["separation"] == pytest.approx(spacing / steep - spacing, rel=1e-8)


def test_a_spring_that_is_too_stiff_holds_the_body_and_that_is_said():
    """The largest slope of Bradley's force, at y^6 = 1/3."""
    y = (1.0 / 3.0) ** (1.0 / 6.0)
    largest = 2.0 * pi * W * RADIUS * 8.0 * (y**3 - y**9) / 3.0 / 0.2e-9
    found = pressed("100 kN/m", "bradley").jumps
    assert found["in"] is None
    assert found["out"] is None
    assert found["note"].startswith("no jump-in and no jump-out: the stiffness of 1e+05 N/m")
    assert found["note"].endswith(f"{largest:.4g} N/m")


def test_a_curve_without_a_spring_has_no_jumps():
    case = load(SMOOTH)
    assert asperity.curve(case, load=1e-6).jumps is None


def line(low, high, near, far):
    """A segment with a force that is linear, and no stored energy."""
    middle, half = 0.5 * (near + far), 0.5 * (far - near)
    force = Chebyshev([middle, half], (low, high))
    return Segment(low, high, force, Chebyshev([0.0], (low, high)))


def test_a_contact_that_pulls_more_and_more_lets_go_at_its_edge():
    """Linear from 0 at 0 to -2 at 2, then none: a spring of 0.5 jumps out from 2 to 6."""
    way = [line(0.0, 2.0, 0.0, -2.0), line(2.0, 100.0, 0.0, 0.0)]
    jump = first_jump(way, 0.5, True)
    assert jump is not None
    assert jump[:4] == pytest.approx((2.0, -2.0, 6.0, 0.0))
    assert jump.energy == pytest.approx(0.5 * 0.5 * 4.0**2)
    inwards = first_jump(way, 0.5, False)
    assert inwards is not None
    assert inwards[:4] == pytest.approx((2.0, 0.0, 2.0 / 3.0, -2.0 / 3.0))


def test_unloading_that_begins_before_the_jump_in_lands_is_not_looked_at():
    way = [line(0.0, 2.0, 0.0, -2.0), line(2.0, 100.0, 0.0, 0.0)]
    found = jumps(way, [line(1.9, 2.0, -1.9, -2.0), line(2.0, 100.0, 0.0, 0.0)], 0.5)
    assert found["out"] is None
    assert str(found["note"]).startswith("jump-out not sought: loading ends at")
