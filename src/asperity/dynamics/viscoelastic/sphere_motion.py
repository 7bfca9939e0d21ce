"""A mass on a viscoelastic half-space from turn to turn, in units of its impact."""

from __future__ import annotations

from math import inf, isfinite, sqrt
from typing import Any, NamedTuple

import numpy as np

from ...errors import SimulationError
from ...halfspace.residual_indentation import ResidualIndentation
from ...halfspace.viscoelastic_paraboloid import (
    ADVANCES,
    DEPTH,
    EXTENSION,
    PULLED,
    RECEDES,
    SPEED,
    SPENT,
    SQUARED,
    Phase,
    Solid,
)
from ..stepped_phase import AT_REST, FAILED, LEFT, TURNED
from .sample_times import flight_times

_TOLERANCE, _LEAST = 1e-11, 1e-15  # of the integration, relative and absolute
_STIFF = 0.05  # relaxation time over that of an impact below which explicit steps are too many
_SPAN = 30.0  # impacts' times that are integrated at once
_MOST = 4000  # such spans in a phase
_FADED = 1e-15  # an indentation that counts as gone
_POINTS = 48  # samples of a stretch
_SLOW = 1e-9  # an edge that counts as turning


class Track(NamedTuple):
    """Samples of a stretch: time, depth, its rate, force, energies stored and taken.

    ``stored`` is that in the springs pressed, ``dented`` that in the springs left behind.
    """

    time: np.ndarray
    depth: np.ndarray
    speed: np.ndarray
    force: np.ndarray
    stored: np.ndarray
    dented: np.ndarray
    spent: np.ndarray


class Bounce:
    """A mass that falls on a viscoelastic half-space, stretch by stretch.

    Parameters
    ----------
    solid
        The half-space and the weight.
    depth, speed
        Depth (negative outside) and speed inwards at time 0.
    goal
        Depth at which the body rests, and how close to it counts as there.
    top
        Depth (negative) at which a body that nothing turns back has left.
    """

    def __init__(
        self, solid: Solid, depth: float, speed: float, goal: tuple[float, float], top: float
    ) -> None:
        self.solid, self.goal, self.top = solid, goal, top
        self.time = self._clock = 0.0
        self.state = np.zeros(6)
        self.state[[DEPTH, SPEED]] = depth, speed
        self.phase = Phase(solid, ADVANCES, 0.0, ResidualIndentation())
        self.pressed = False

    def follow(self, inwards: bool) -> tuple[str, list[Track]]:
        """The tracks until the body turns, and how they end."""
        tracks: list[Track] = []
        for _ in range(_MOST):
            fate, track = (self._press if self.pressed else self._free_flight)(inwards)
            tracks.append(track)
            if fate:
                return fate, tracks
        return FAILED, tracks

    def _free_flight(self, inwards: bool) -> tuple[str, Track]:
        """Without contact: to the apex, or to where the surface is met."""
        g, depth, speed = self.solid.weight, float(self.state[DEPTH]), float(self.state[SPEED])
        apex = inf if inwards else (-speed / g if g > 0.0 else inf)
        out = inf if inwards or g > 0.0 else max((depth - self.top) / -speed, 0.0)
        met = self._met(min(apex, out))
        span = min(met, apex, out)
        fate = ""
        if span < met:
            fate = TURNED if apex <= out else LEFT
        track = self._free_flight_samples(span)
        self.time += span
        self.state[:] = self._aloft(np.array([span]))[:, 0]
        if fate == TURNED:
            self.state[SPEED] = 0.0
        if not fate:
            self._touch()
        return fate, track

    def _aloft(self, span: np.ndarray) -> np.ndarray:
        """States after times in flight: a parabola, and an indentation that fills up."""
        k, tau, g = self.solid
        begun = self.state[:, None]
        states = np.repeat(begun, span.size, axis=1)
        states[DEPTH] = begun[DEPTH] + span * (begun[SPEED] + 0.5 * g * span)
        states[SPEED] = begun[SPEED] + g * span
        states[EXTENSION] = begun[EXTENSION] * np.exp(-k * span / tau)
        states[SQUARED] = begun[SQUARED] * np.exp(-2.0 * k * span / tau)
        gone = -np.expm1(-2.0 * k * span / tau)
        states[SPENT] = begun[SPENT] + self.phase.springs(begun[SQUARED]) * gone
        return states

    def _free_flight_samples(self, span: float) -> Track:
        steps = flight_times(span, min(1.0, self.solid.time / self.solid.ratio))
        states = self._aloft(steps)
        none = np.zeros(steps.size)
        time = self._clock + self.time + steps
        dented = self.phase.springs(states[SQUARED])
        return Track(time, states[DEPTH], states[SPEED], none, none, dented, states[SPENT])

    def _met(self, end: float) -> float:
        """Time until the surface is met, infinite if not within ``end``."""
        from scipy.optimize import brentq

        k, tau, g = self.solid
        depth, speed = float(self.state[DEPTH]), float(self.state[SPEED])
        left = self.phase.touching(self.time, self.state) - k * depth

        def above(span: float) -> float:
            fall = depth + span * (speed + 0.5 * g * span)
            return k * fall + left * float(np.exp(-k * span / tau))

        flat = _falls(max(-left / k, 0.0) - depth, speed, g)
        if abs(left) < _FADED:
            return flat if flat <= end else inf
        # The surface comes back by its retardation time, the body on its parabola.
        last = min(end, flat) if isfinite(min(end, flat)) else 100.0 * tau / k
        fine = min(tau / k, last)
        looks = np.unique(
            np.concatenate([np.linspace(0.0, fine, 65), np.linspace(fine, last, 129)])
        )
        looks = np.append(looks[1:], min(end, flat)) if isfinite(min(end, flat)) else looks[1:]
        values = np.array([above(s) for s in looks])
        held = np.flatnonzero(values < 0.0)
        if not held.size:
            return float(looks[0])  # it never left by more than rounding
        first = held[0]
        back = np.flatnonzero(values[first:] >= 0.0)
        if not back.size:
            return inf
        index = first + int(back[0])
        return float(brentq(above, looks[index - 1], looks[index], xtol=1e-15, rtol=1e-14))

    def _touch(self) -> None:
        """The surface is met: the phase starts with what is left of an indentation, at time 0."""
        self.phase.begun -= self.time
        self._clock += self.time
        self.time = 0.0
        _, free = self.phase.faded(self.time)
        indentation, begun = self.phase.indentation, self.phase.begun
        if free * abs(indentation.at(0.0)[0]) < _FADED:
            indentation, begun, free = ResidualIndentation(), self.time, 1.0
        self.phase = Phase(self.solid, ADVANCES, begun, indentation)
        once, twice = indentation.whole
        self.state[[EXTENSION, SQUARED, PULLED]] = free * once, free**2 * twice, 0.0
        self.pressed = True

    def _press(self, inwards: bool) -> tuple[str, Track]:
        """In contact, while its edge moves one way: to the turn, or to where the edge turns."""
        from scipy.integrate import solve_ivp

        phase = self.phase
        speed = _event(lambda t, y: y[SPEED], -1.0 if inwards else 1.0)
        edge = _event(phase.turning, -phase.direction)
        events = [speed, edge]
        if phase.direction == RECEDES:
            events.append(_event(phase.touching, -1.0))
        stiff = self.solid.time < _STIFF
        try:
            done = solve_ivp(
                phase.rates, (self.time, self.time + self._span()), self.state,
                method="Radau" if stiff else "DOP853", rtol=_TOLERANCE, atol=_LEAST,
                events=events, dense_output=True,
            )  # fmt: skip
        except ValueError as error:  # of SciPy's search for the root of an event
            raise SimulationError(
                "the edge of a viscoelastic contact could not be followed: its relaxation, in "
                f"{self.solid.time:.2g} of the time of the impact to {self.solid.ratio:.2g} of the "
                "modulus, is too quick and too deep beside the motion"
            ) from error
        track = self._tracked(phase, done)
        phase.follow(done.sol, done.t[-1])
        self.time, self.state = float(done.t[-1]), done.y[:, -1].copy()
        if done.status < 0:
            return FAILED, track
        if done.status == 0:
            return (AT_REST if self._rests() else ""), track
        # Edge and body often turn together, and rounding may put either first.
        edge_turned = bool(done.t_events[1].size)
        turned = bool(done.t_events[0].size) or (edge_turned and abs(self.state[SPEED]) < _SLOW)
        if turned:
            self.state[SPEED] = 0.0
        if len(events) > 2 and done.t_events[2].size:
            self._part()
        elif edge_turned or self._turns_with_body(inwards):
            self._reverse()
        return (TURNED if turned else ""), track

    def _span(self) -> float:
        return max(_SPAN, 2.0 * self.solid.time / self.solid.ratio)

    def _turns_with_body(self, inwards: bool) -> bool:
        """Whether the edge turns where the body does, which rounding may hide."""
        direction = self.phase.direction
        against = direction == (ADVANCES if inwards else RECEDES)
        slow = direction * self.phase.turning(self.time, self.state) < _SLOW
        return against and float(self.state[SPEED]) == 0.0 and slow

    def _rests(self) -> bool:
        """Whether the body is at rest, but for what is too slow to matter."""
        depth, near = self.goal
        speed = float(self.state[SPEED])
        return abs(float(self.state[DEPTH]) - depth) <= near and 0.5 * speed**2 <= (
            1e-9 * self.solid.weight * near
        )

    def _reverse(self) -> None:
        """The edge of contact turns."""
        phase = self.phase
        edge = phase.radius(self.time, float(self.state[DEPTH]), float(self.state[PULLED]))
        self._begin(-phase.direction, edge)

    def _part(self) -> None:
        """The surface is left, with an indentation in it."""
        self._begin(ADVANCES, 0.0)
        self.pressed = False

    def _begin(self, direction: int, edge: float) -> None:
        """A phase begins where the last one ends, at a radius of contact."""
        indentation = self.phase.left_behind(self.time, edge)
        self.phase = Phase(self.solid, direction, self.time, indentation, edge)
        self.state[[EXTENSION, SQUARED]] = indentation.whole
        self.state[PULLED] = 0.0

    def _tracked(self, phase: Phase, done: Any) -> Track:
        """Samples of a stretch in contact, denser where it begins and ends."""
        share = 0.5 - 0.5 * np.cos(np.pi * np.linspace(0.0, 1.0, _POINTS + 1)[1:])
        time = np.clip(self.time + (float(done.t[-1]) - self.time) * share, *done.t[[0, -1]])
        states = done.sol(time)
        force = [phase.pressed(t, y).force for t, y in zip(time, states.T, strict=True)]
        stored = np.array([phase.stored(t, y) for t, y in zip(time, states.T, strict=True)])
        return Track(
            self._clock + time, states[DEPTH], states[SPEED], np.array(force), stored[:, 0],
            stored[:, 1], states[SPENT],
        )  # fmt: skip


def _event(function: Any, direction: float) -> Any:
    """An event of the integration that ends it."""

    def found(time: float, state: np.ndarray) -> float:
        return float(function(time, state))

    found.terminal = True  # type: ignore[attr-defined]
    found.direction = direction  # type: ignore[attr-defined]
    return found


def _falls(depth: float, speed: float, weight: float) -> float:
    """Time to fall by a depth from a speed inwards, infinite where it never does."""
    if weight == 0.0:
        return depth / speed if speed > 0.0 else inf
    root = sqrt(max(speed**2 + 2.0 * weight * depth, 0.0))
    return 2.0 * depth / (speed + root) if speed > 0.0 else (root - speed) / weight
