"""Liquid bridges between two bodies by the Young-Laplace equation: the judge of menisci.

Axisymmetric, without gravity. Reduced: the surface tension is 1, and any unit of length will
do. Nothing of the package is used.

With the arc length s from the lower contact line, the slope angle phi and the pressure p
(inside less outside, over the tension), the equation is phi' = p - sin(phi)/r. Its first
integral f = 2 r sin(phi) - p r^2 says that the pull pi f is the same in every cross section, and
it makes the square of the radius a harmonic: (r^2)'' = 2 - p f - p^2 r^2. So the radius is known
in closed form (Delaunay 1841; Kenmotsu 1980); height and volume are integrals of smooth
functions, done by Gauss's rule. `integrated` solves the differential equation step by step.
"""

from dataclasses import dataclass
from math import pi

import numpy as np
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

NODES, WEIGHTS = np.polynomial.legendre.leggauss(64)
NODES, WEIGHTS = 0.5 * (NODES + 1.0), 0.5 * WEIGHTS
IMAGINARY = 1e-30  # step of a derivative by complex numbers, which is exact to rounding
SEED = 0.5  # separation in units of volume^(1/3) that is stable at every contact angle


class NoBridge(Exception):
    """No solution was found from where the search started."""


@dataclass(frozen=True)
class Bodies:
    """Contact angle [rad] and curvature of the lower and of the upper body; a plane has 0."""

    lower_angle: float
    upper_angle: float
    lower: float
    upper: float

    def at(self, share, unit):
        """On the way from planes that the liquid meets upright, share 0, to these, share 1."""
        angles = (0.5 * pi + share * (a - 0.5 * pi) for a in (self.lower_angle, self.upper_angle))
        return Bodies(*angles, share * self.lower * unit, share * self.upper * unit)


def sphere_and_plane(angle, radius=1.0):
    return Bodies(angle, angle, 0.0, 1.0 / radius)


def equal_spheres(angle, radius=1.0):
    return Bodies(angle, angle, 1.0 / radius, 1.0 / radius)


@dataclass(frozen=True)
class Bridge:
    """A solution: radii of its contact lines, its pressure, and the length of its meridian."""

    bodies: Bodies
    foot: float
    pressure: float
    head: float
    length: float

    @property
    def unknowns(self):
        return np.array([self.foot, self.pressure, self.head, self.length])

    @property
    def scale(self):
        """Natural size of each unknown."""
        return np.array([self.foot, 1.0 / self.length, self.head, self.length])

    @property
    def volume(self):
        return float(volume(self.bodies, self.unknowns))

    @property
    def separation(self):
        return float(separation(self.bodies, self.unknowns))

    @property
    def pull(self):
        """Force that pulls the bodies together."""
        return float(pi * flow(self.bodies, self.unknowns))

    @property
    def pull_on_upper(self):
        """Ring of tension less pressure at the upper contact line, by the contact angle there."""
        slope = self.bodies.upper_angle + np.arcsin(self.bodies.upper * self.head)
        return 2.0 * pi * self.head * np.sin(slope) - pi * self.pressure * self.head**2

    @property
    def energy(self):
        """Energy of the liquid's surface less the energy gained by wetting the bodies."""
        b = self.bodies
        r, _, _ = meridian(b, self.unknowns, self.length * NODES)
        free = 2.0 * pi * self.length * (WEIGHTS @ r)
        lower, upper = cap_area(b.lower, self.foot), cap_area(b.upper, self.head)
        return float(free - np.cos(b.lower_angle) * lower - np.cos(b.upper_angle) * upper)


def cap_area(curvature, r):
    return 2.0 * pi * r**2 / (1.0 + np.sqrt(1.0 - (curvature * r) ** 2))


def sag(curvature, r):
    """How far a body recedes from its apex out to the radius r."""
    return curvature * r**2 / (1.0 + np.sqrt(1.0 - (curvature * r) ** 2))


def cap_volume(curvature, r):
    h = sag(curvature, r)
    return pi * h * (3.0 * r**2 + h**2) / 6.0


def flow(bodies, x):
    """First integral f at the foot, where the surface meets the body at the contact angle."""
    foot, p, *_ = x
    return 2.0 * foot * np.sin(bodies.lower_angle + np.arcsin(bodies.lower * foot)) - p * foot**2


def meridian(bodies, x, s):
    """Radius, cos(phi) and sin(phi) at arc lengths s from the lower contact line."""
    foot, p, *_ = x
    slope = bodies.lower_angle + np.arcsin(bodies.lower * foot)
    first, second = -2.0 * foot * np.cos(slope), 2.0 - 2.0 * p * foot * np.sin(slope)
    sine = s * np.sinc(p * s / pi)
    versine = 0.5 * (s * np.sinc(0.5 * p * s / pi)) ** 2
    square = foot**2 + first * sine + second * versine
    r = np.sqrt(square)
    cosine = (first * np.cos(p * s) + second * sine) / (2.0 * r)
    return r, cosine, (flow(bodies, x) + p * square) / (2.0 * r)


def separation(bodies, x):
    """Distance of the apexes."""
    _, _, sine = meridian(bodies, x, np.multiply.outer(NODES, x[3]))
    return x[3] * (WEIGHTS @ sine) - sag(bodies.lower, x[0]) - sag(bodies.upper, x[2])


def volume(bodies, x):
    r, _, sine = meridian(bodies, x, np.multiply.outer(NODES, x[3]))
    caps = cap_volume(bodies.lower, x[0]) + cap_volume(bodies.upper, x[2])
    return pi * x[3] * (WEIGHTS @ (r**2 * sine)) - caps


MEASURES = {"volume": volume, "separation": separation, "pressure": lambda bodies, x: x[1]}


def missed(bodies, x, wanted):
    """Radius and contact angle at the upper contact line, and the wanted measures, as missed."""
    r, cosine, sine = meridian(bodies, x, x[3])
    slope = bodies.upper_angle + np.arcsin(bodies.upper * x[2])
    turned = sine * np.cos(slope) - cosine * np.sin(slope)
    rest = (MEASURES[name](bodies, x) - value for name, value in wanted.items())
    return np.array([r - x[2], turned, *rest])


def jacobian(function, x):
    """Derivatives of a function of the unknowns, which takes a column for each derivative."""
    return function(x[:, None] + 1j * IMAGINARY * np.eye(len(x))).imag / IMAGINARY


def newton(function, x, scale):
    for _ in range(40):
        try:
            step = np.linalg.solve(jacobian(function, x) * scale, function(x))
        except np.linalg.LinAlgError as error:
            raise NoBridge from error
        size = np.max(np.abs(step))
        x = x - scale * step * min(1.0, 0.3 / max(size, 0.3))
        # Beyond a body's equator, or where the radius vanishes, there is no surface.
        if not np.all(np.isfinite(function(x))):
            break
        # One step beyond this is as near as rounding allows.
        if size < 1e-9:
            return x
    raise NoBridge


def solved(near, bodies, **wanted):
    """The bridge near another; two of `volume`, `separation` and `pressure` are given."""
    with np.errstate(invalid="ignore"):
        x = newton(lambda x: missed(bodies, x, wanted), near.unknowns, near.scale)
    return Bridge(bodies, *x)


def seed(bodies, content):
    """The stable bridge at the separation SEED volume^(1/3), by way of a cylinder."""
    unit = content ** (1.0 / 3.0)
    foot = 1.0 / np.sqrt(pi * SEED)
    near = Bridge(bodies.at(0.0, 1.0), foot, 1.0 / foot, foot, SEED)
    for share in np.linspace(0.0, 1.0, 9)[1:]:
        near = solved(near, bodies.at(share, unit), volume=1.0, separation=SEED)
    return Bridge(
        bodies, near.foot * unit, near.pressure / unit, near.head * unit, near.length * unit
    )


def stretched(bodies, content, separations):
    """Stable bridges of one volume at several separations below that of rupture."""
    start = seed(bodies, content)
    # Height of the liquid's edge when the bodies touch: the length on which a step is judged.
    edge = np.sqrt(content * (bodies.lower + bodies.upper) / pi)
    found = {}
    for sign in (1.0, -1.0):
        near = start
        for d in sorted(separations, key=lambda d: sign * d):
            if sign * d >= sign * start.separation:
                ends = near.separation + edge, d + edge
                steps = max(int(np.ceil(abs(np.log(ends[1] / ends[0])) / 0.4)), 1)
                for height in np.geomspace(*ends, steps + 1)[1:]:
                    near = solved(near, bodies, volume=content, separation=height - edge)
                found[d] = near
    return [found[d] for d in separations]


def stability(bridge, kept):
    """Changes its sign at every fold and every branching of a family in which `kept` is kept."""
    wanted = {kept: 0.0, "separation": 0.0}
    matrix = jacobian(lambda x: missed(bridge.bodies, x, wanted), bridge.unknowns)
    return np.linalg.det(matrix * bridge.scale)


def advanced(bridge, kept, ahead, step):
    """The bridge a step further along a family, and the direction taken."""
    b, scale, x = bridge.bodies, bridge.scale, bridge.unknowns
    wanted = {kept: MEASURES[kept](b, x)}
    matrix = jacobian(lambda y: missed(b, y, wanted), x)
    tangent = np.linalg.svd(matrix * scale)[2][-1] * scale
    tangent *= np.sign(ahead @ (tangent / scale**2))
    guess = x + step * tangent

    def on_plane(y):
        return np.array([*missed(b, y, wanted), (tangent / scale**2) @ (y.T - guess).T])

    with np.errstate(invalid="ignore"):
        return Bridge(b, *newton(on_plane, guess, scale)), tangent


def critical(bridge, kept, sign, step=0.12):
    """First bridge of its family, as it is drawn apart, at which `sign` of a bridge changes.

    Two changes within one step are missed: between equal bodies near 31 degrees.
    """
    widening = jacobian(lambda x: separation(bridge.bodies, x), bridge.unknowns)
    ahead, before = widening * bridge.scale**2, sign(bridge)
    for _ in range(200):
        new, tangent = advanced(bridge, kept, ahead, step)
        if sign(new) * before < 0.0:
            break
        bridge, ahead = new, tangent
    else:
        raise NoBridge

    def miss(h):
        return sign(advanced(bridge, kept, ahead, h)[0]) / before

    return advanced(bridge, kept, ahead, brentq(miss, 0.0, step, xtol=1e-10))[0]


def rupture(bodies, content):
    """The bridge of this volume at the largest separation at which it is stable.

    For two bodies that differ, a fold of the family. Two equal ones are halved at their plane
    of symmetry, so that the family can be followed through a branching, and the sign is that
    of the whole bridge: its antisymmetric mode may give way before the fold.
    """
    if bodies.lower != bodies.upper:
        return critical(seed(bodies, content), "volume", lambda b: stability(b, "volume"))
    half = seed(Bodies(0.5 * pi, bodies.upper_angle, 0.0, bodies.upper), 0.5 * content)
    return reflected(critical(half, "volume", lambda b: stability(reflected(b), "volume")))


def reflected(half):
    """The symmetric bridge of which this is the half above the plane of symmetry."""
    b = half.bodies
    bodies = Bodies(b.upper_angle, b.upper_angle, b.upper, b.upper)
    return Bridge(bodies, half.head, half.pressure, half.head, 2.0 * half.length)


def integrated(bridge):
    """Radius, height, slope angle and volume at the foot, the narrowest place and the head."""
    b, p = bridge.bodies, bridge.pressure

    def slopes(s, y):
        r, _, phi, _ = y
        return np.cos(phi), np.sin(phi), p - np.sin(phi) / r, pi * r**2 * np.sin(phi)

    def upright(s, y):
        return np.cos(y[2])

    first = [bridge.foot, 0.0, pi - b.lower_angle - np.arcsin(b.lower * bridge.foot), 0.0]
    way = solve_ivp(
        slopes, (0.0, bridge.length), first, "DOP853", events=upright, rtol=1e-12, atol=1e-15
    )
    narrow = way.y_events[0][0] if len(way.y_events[0]) else np.full(4, np.nan)
    return way.y[:, 0], narrow, way.y[:, -1]
