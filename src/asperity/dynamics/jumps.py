"""Static jump-in and jump-out: where a spring can no longer hold a body against its contact.

Its base is moved so slowly that the body stays at rest. With the spring's stiffness k, the rest is
stable while dF/dd < k. Where dF/dd comes to k, or the force jumps, the body jumps along the
spring's line F + k (d - separation) to where the contact carries it again. Israelachvili,
Intermolecular and Surface Forces (2011), chapter 12.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.polynomial import Chebyshev

_STEP = 1e-5  # of the force near by: more is a jump of the force
_CUT = 2e-6  # of the largest pull: less is where forces are cut off, at the end of their range
_ROUNDING = 1e-11  # of the force: what a piece may be off by
_LOOKS = np.linspace(0.0, 1.0, 129)[1:]  # on a piece for where the contact carries a body again
_SEEN = 33  # places on a piece
_REAL = 1e-9  # imaginary part of a root that counts as none


class Segment(NamedTuple):
    """A piece of a force curve, used from ``low`` to ``high`` [m], ascending.

    Attributes
    ----------
    low, high
        Ends of what is used of it.
    force, stored
        Force [N] and stored energy [J].
    """

    low: float
    high: float
    force: Chebyshev
    stored: Chebyshev

    @property
    def size(self) -> float:
        """Size of its force [N]."""
        return float(np.max(np.abs(self.force.coef)))

    @property
    def noise(self) -> float:
        """What rounding may make of its slope [N/m]: all, on pieces that are too narrow."""
        return _ROUNDING * self.size / float(np.ptp(self.force.domain))

    @property
    def pull(self) -> float:
        """Its largest attraction [N], about."""
        seen = self.force(np.linspace(self.low, self.high, _SEEN))
        return max(-float(np.min(seen)), 0.0)

    def roots(self, series: Chebyshev) -> np.ndarray:
        """Zeros of a polynomial on what is used, ascending [m]."""
        found = series.trim().roots()
        real = np.abs(found.imag) < _REAL * 0.5 * np.ptp(series.domain)
        places = found.real[real]
        return np.sort(places[(places >= self.low) & (places <= self.high)])


class Jump(NamedTuple):
    """A jump of a body on a spring whose base stands still meanwhile.

    Attributes
    ----------
    separation, force
        Rigid separation [m] and contact force [N] before it.
    landing_separation, landing_force
        The same where the body comes to rest.
    energy
        What contact and spring hold less of afterwards [J].
    """

    separation: float
    force: float
    landing_separation: float
    landing_force: float
    energy: float


def jumps(
    inward: list[Segment], outward: list[Segment], stiffness: float
) -> dict[str, dict[str, float] | str | None]:
    """Jump-in and jump-out of a body on a spring, as plain numbers.

    Parameters
    ----------
    inward, outward
        The force curve while loading, all of it, and while unloading from the deepest point, each
        ascending in separation.
    stiffness
        Stiffness of the spring [N/m].

    Returns
    -------
    ``in`` and ``out``, the fields of :class:`Jump` or None where there is none, and ``note``: why
    not, or None.
    """
    pulled_in = first_jump(inward, stiffness, False)
    note, let_go, deepest = None, None, outward[0].low
    if pulled_in is not None and deepest > pulled_in.landing_separation:
        note = (
            f"jump-out not sought: loading ends at {deepest * 1e9:.4g} nm, before the jump-in does"
        )
    else:
        let_go = first_jump(outward, stiffness, True)
        missing = [name for name, one in (("in", pulled_in), ("out", let_go)) if one is None]
        if missing:
            largest = largest_slope(
                [branch for branch, one in ((inward, pulled_in), (outward, let_go)) if one is None]
            )
            note = (
                f"no jump-{' and no jump-'.join(missing)}: the stiffness of {stiffness:.4g} N/m "
                f"is above the largest dF/dd, {largest:.4g} N/m"
            )
    plain = [
        None if one is None else {name: float(value) for name, value in one._asdict().items()}
        for one in (pulled_in, let_go)
    ]
    return {"in": plain[0], "out": plain[1], "note": note}


def largest_slope(branches: list[list[Segment]]) -> float:
    """Largest derivative of the force with the separation on some branches [N/m]."""
    found = [0.0]
    for segment in (segment for branch in branches for segment in branch):
        ends = np.array([segment.low, segment.high])
        slope = segment.force.deriv()
        slopes = slope(np.concatenate([ends, segment.roots(slope.deriv())]))
        found.append(float(np.max(slopes)) - segment.noise)
    return max(found)


def first_jump(branch: list[Segment], stiffness: float, unloading: bool) -> Jump | None:
    """The first jump on a branch, None where the spring holds the body all along it.

    Parameters
    ----------
    branch
        The force curve along it, ascending in separation.
    stiffness
        Stiffness of the spring [N/m].
    unloading
        Whether the body is drawn outwards; else it comes in from the last segment.
    """
    ordered = branch if unloading else branch[::-1]
    off = _CUT * max(one.pull for one in branch)
    before: float | None = None
    for number, segment in enumerate(ordered):
        near, far = (segment.low, segment.high) if unloading else (segment.high, segment.low)
        force = float(segment.force(near))
        step = 0.0 if before is None else (force - before) * (1.0 if unloading else -1.0)
        if before is not None and step > max(_STEP * abs(before), _STEP * segment.size, off):
            start = near, before
            return _landing(ordered[number:], stiffness, start, ordered[number - 1], unloading)
        place = _unstable(segment, stiffness, near, unloading)
        if place is not None:
            at = float(segment.force(place))
            return _landing(ordered[number:], stiffness, (place, at), segment, unloading)
        before = float(segment.force(far))
    return None


def _unstable(segment: Segment, stiffness: float, near: float, unloading: bool) -> float | None:
    """The first place on a segment at which dF/dd rises to the stiffness [m]."""
    slope = segment.force.deriv()
    if segment.noise > stiffness:
        return None
    if float(slope(near)) > stiffness:
        return near
    found = segment.roots(slope - stiffness)
    return None if not found.size else float(found[0] if unloading else found[-1])


def _landing(
    ordered: list[Segment],
    stiffness: float,
    start: tuple[float, float],
    before: Segment,
    unloading: bool,
) -> Jump | None:
    """The jump from a place [m] and its force [N] on to where contact and spring balance again."""
    place, force = start
    stored = float(before.stored(place))
    for segment in ordered:
        # Less the spring's line.
        distance = Chebyshev.identity(segment.force.domain) - place
        net = segment.force - (force + stiffness * distance)
        near = np.clip(place, segment.low, segment.high)
        looks = near + ((segment.high if unloading else segment.low) - near) * _LOOKS
        held = net(looks) * (1.0 if unloading else -1.0) < 0.0
        if not np.any(held):
            continue
        first = int(np.argmax(held))
        inside = near if first == 0 else looks[first - 1]
        roots = segment.roots(net)
        between = (roots - inside) * (roots - looks[first]) <= 0.0
        landing = float(roots[between][-1 if unloading else 0] if np.any(between) else inside)
        after = float(segment.stored(landing))
        moved = place - landing
        energy = stored - after + force * moved - 0.5 * stiffness * moved**2
        there = float(segment.force(landing))
        return Jump(place, force, landing, there, energy)
    return None
