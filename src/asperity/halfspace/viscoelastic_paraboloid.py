"""A paraboloid on a viscoelastic half-space, exactly, for any history of its approach.

By the method of dimensionality reduction, Abel's transform takes the half-space to a row of
independent springs, a one-dimensional Winkler foundation (Popov and Hess 2015). A spring at x
carries q = E* phi * dw/dt, is pressed to w = delta - x^2/R within the contact radius a, and is free
beyond it; the contact ends where q is 0. Each is a standard linear solid: a spring k E* beside a
Maxwell element (1 - k) E*, whose own spring is extended by z.

Units: one length for delta, z and x^2/R; energies and forces over E* and the units' powers.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import exp, inf, sqrt
from typing import Any, NamedTuple

import numpy as np

from .residual_indentation import ResidualIndentation

ADVANCES, RECEDES = 1, -1
"""Whether the edge of contact moves outwards or inwards."""

DEPTH, SPEED, EXTENSION, SQUARED, PULLED, SPENT = range(6)
"""What is integrated in time: delta, its rate, the integrals of z and z^2 over all springs, z since
the phase began of a spring in contact all along, energy that the dashpots took."""

_CLOSE = 1e-15
_NEWTON = 1e-10  # a step of Newton's method after which nothing is left to gain
_STEPS = 80
_FORGOTTEN = 1e-15  # share of an extension that is left


class Solid(NamedTuple):
    """A standard linear solid under a mass, in units of its impact.

    Attributes
    ----------
    ratio
        Relaxed over instantaneous modulus, k.
    time
        Relaxation time over the unit of time.
    weight
        Gravity over the unit of acceleration.
    """

    ratio: float
    time: float
    weight: float


class Pressed(NamedTuple):
    """The contact at one instant: radius, force, integrals of z and of z^2 within the radius."""

    radius: float
    force: float
    extension: float
    squared: float


MODULUS_SCALE = 15.0 / 8.0
"""Twice E* over the units' force: an elastic impact at unit speed then goes to depth 1."""


@dataclass(eq=False)
class Phase:
    """The contact while its edge moves one way, from an instant on.

    Parameters
    ----------
    solid
        The solid.
    direction
        ADVANCES or RECEDES.
    begun
        When it began.
    indentation
        Extension of all springs then.
    edge
        Radius of contact at its start.
    """

    solid: Solid
    direction: int
    begun: float
    indentation: ResidualIndentation
    edge: float = 0.0

    def __post_init__(self) -> None:
        self._near = 0.0
        self._followed: list[Any] = []
        self._until: list[float] = []

    def faded(self, time: float) -> tuple[float, float]:
        """Shares left of the extensions that were, in contact and free."""
        gone = (time - self.begun) / self.solid.time
        return exp(-gone), exp(-self.solid.ratio * gone)

    def at_edge(self, time: float, depth: float, pulled: float, x: float) -> tuple[float, float]:
        """Pressure of a spring at x, and its slope, over E*, if the edge were there."""
        k = self.solid.ratio
        held, free = self.faded(time)
        z, slope = self.indentation.at(x)
        share, more = (free, 0.0) if self.direction == ADVANCES else (held, pulled)
        return (
            k * (depth - x * x) + (1.0 - k) * (share * z + more),
            -2.0 * k * x + (1.0 - k) * share * slope,
        )

    def radius(self, time: float, depth: float, pulled: float) -> float:
        """Radius of contact: where the springs' pressure, which falls outwards, ends."""
        outer = self.indentation.outer
        if self.direction == ADVANCES and depth >= outer * outer:
            return sqrt(depth)
        if self.at_edge(time, depth, pulled, 0.0)[0] <= 0.0:
            return 0.0
        low, high = 0.0, outer
        x = min(max(self._near, 0.1 * outer), 0.9999999 * outer)
        before = inf
        for _ in range(_STEPS):
            value, slope = self.at_edge(time, depth, pulled, x)
            low, high = (x, high) if value > 0.0 else (low, x)
            after = x - value / slope if slope < 0.0 else -1.0
            # Where the edge once turned, the surface is so steep that Newton's steps lead nowhere.
            halved = not low <= after <= high or abs(value) > 0.5 * before
            if halved:
                after = 0.5 * (low + high)
            before, moved, x = abs(value), abs(after - x), after
            small = not halved and before <= _NEWTON * self.solid.ratio * outer**2
            if (small and moved <= _NEWTON * outer) or high - low <= _CLOSE * outer:
                break
        self._near = x
        return x

    def pressed(self, time: float, state: np.ndarray) -> Pressed:
        """The contact in a state."""
        k = self.solid.ratio
        depth, pulled = float(state[DEPTH]), float(state[PULLED])
        a = self.radius(time, depth, pulled)
        once, twice = self.indentation.integrals(a)
        held, free = self.faded(time)
        if self.direction == ADVANCES:
            all_once, all_twice = self.indentation.whole
            extension = float(state[EXTENSION]) - free * (all_once - once)
            squared = float(state[SQUARED]) - free**2 * (all_twice - twice)
        else:
            extension = held * once + pulled * a
            squared = held**2 * twice + 2.0 * held * pulled * once + pulled**2 * a
        force = MODULUS_SCALE * (k * (depth * a - a**3 / 3.0) + (1.0 - k) * extension)
        return Pressed(a, force, extension, squared)

    def rates(self, time: float, state: np.ndarray) -> list[float]:
        """Rates of a state, of which none knows how fast the edge moves."""
        k, tau, weight = self.solid
        now = self.pressed(time, state)
        speed, squared = float(state[SPEED]), float(state[SQUARED])
        whole = float(state[EXTENSION])
        faded = now.extension + k * (whole - now.extension)
        return [
            speed,
            weight - now.force,
            speed * now.radius - faded / tau,
            2.0 * (speed * now.extension - (now.squared + k * (squared - now.squared)) / tau),
            speed - float(state[PULLED]) / tau,
            MODULUS_SCALE * (1.0 - k) * squared / tau,
        ]

    def stored(self, time: float, state: np.ndarray) -> tuple[float, float]:
        """Energy in the springs of the contact, and in those that are free."""
        k = self.solid.ratio
        now = self.pressed(time, state)
        a, depth = now.radius, float(state[DEPTH])
        bent = depth**2 * a - 2.0 * depth * a**3 / 3.0 + a**5 / 5.0
        pressed = 0.5 * MODULUS_SCALE * (k * bent + (1.0 - k) * now.squared)
        return pressed, self.springs(float(state[SQUARED]) - now.squared)

    def springs(self, squared: Any) -> Any:
        """Energy in free springs whose z^2 has a given integral."""
        k = self.solid.ratio
        return 0.5 * MODULUS_SCALE * (1.0 - k) / k * squared

    def turning(self, time: float, state: np.ndarray) -> float:
        """Speed at which the edge moves outwards, times something positive."""
        depth = float(state[DEPTH])
        a = self.radius(time, depth, float(state[PULLED]))
        # Where the pressure ends (1 - k) z is -k (delta - a^2).
        return float(state[SPEED]) + self.solid.ratio * (depth - a * a) / self.solid.time

    def touching(self, time: float, state: np.ndarray) -> float:
        """Pressure on the axis: below 0 the surface is left."""
        return self.at_edge(time, float(state[DEPTH]), float(state[PULLED]), 0.0)[0]

    def follow(self, path: Any, end: float) -> None:
        """Keep the states of this phase up to a time, as a function of the time."""
        self._followed.append(path)
        self._until.append(end)

    def left_behind(self, end: float, last: float) -> ResidualIndentation:
        """The extension of all springs at the phase's end, where the contact's radius is last."""
        held, free = self.faded(end)
        state = self._along(np.array([end]))[:, 0]
        pulled = float(state[PULLED])
        inner, outer = sorted((self.edge, last))
        radii = self._radii(inner, outer, held, free)

        def extension(x: np.ndarray) -> np.ndarray:
            old = self.indentation.over(x)
            z = np.where(x < inner, held * old + pulled, free * old)
            there = (inner <= x) & (x <= outer)
            z[there] = self._swept(x[there], old[there], end, pulled)
            return z

        return ResidualIndentation(radii, 0.5 * min(self.solid.time, 1.0), extension)

    def _swept(self, x: np.ndarray, old: np.ndarray, end: float, pulled: float) -> np.ndarray:
        """Extension of springs that the edge passed, by their age."""
        k, tau = self.solid.ratio, self.solid.time
        passed = self._passed(x, old, end)
        then = self._along(passed)[PULLED]
        ages, before = (end - passed) / tau, (passed - self.begun) / tau
        if self.direction == ADVANCES:
            return (old * np.exp(-k * before) - then) * np.exp(-ages) + pulled
        return (old * np.exp(-before) + then) * np.exp(-k * ages)

    def _radii(self, inner: float, outer: float, held: float, free: float) -> list[float]:
        """Radii between which the extension is smooth at the end; forgotten ones are dropped."""
        near = 1e-9 * outer
        kept = [0.0, inner, outer]
        for x in self.indentation.radii[1:]:
            share = held if x < inner else free
            if share > _FORGOTTEN and min(abs(x - y) for y in kept) > near:
                kept.append(x)
        kept.sort()
        return [x for x, y in zip(kept, [-1.0, *kept[:-1]], strict=True) if x - y > near]

    def _along(self, time: np.ndarray) -> np.ndarray:
        """States at times of the phase."""
        index = np.minimum(np.searchsorted(self._until, time), len(self._until) - 1)
        states = np.empty((6, time.size))
        for number in np.unique(index):
            there = index == number
            states[:, there] = self._followed[number](time[there])
        return states

    def _passed(self, x: np.ndarray, z: np.ndarray, end: float) -> np.ndarray:
        """Times at which the edge of contact passed radii x."""
        k, tau = self.solid.ratio, self.solid.time
        rate = k if self.direction == ADVANCES else 1.0
        # The phase may be followed from later on than its indentation is of.
        low, high = np.full(x.size, self._followed[0].t_min), np.full(x.size, end)
        time = 0.5 * (low + high)
        for _ in range(_STEPS):
            state = self._along(time)
            old = z * np.exp(-rate * (time - self.begun) / tau)
            pulled = state[PULLED] * (self.direction == RECEDES)
            value = k * (state[DEPTH] - x**2) + (1.0 - k) * (old + pulled)
            drift = -rate * old / tau
            if self.direction == RECEDES:
                drift = drift + state[SPEED] - state[PULLED] / tau
            slope = k * state[SPEED] + (1.0 - k) * drift
            late = self.direction * value > 0.0
            low, high = np.where(late, low, time), np.where(late, time, high)
            after = time - value / np.where(slope == 0.0, 1.0, slope)
            outside = ~((low < after) & (after < high)) | (slope == 0.0)
            after = np.where(outside, 0.5 * (low + high), after)
            moved = np.max(np.abs(after - time))
            time = after
            if moved <= _CLOSE * (1.0 + abs(end)):
                break
        return time
