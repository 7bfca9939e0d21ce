"""A motion that was stepped in time, as a time series."""

from __future__ import annotations

import numpy as np
from numpy.polynomial.legendre import legval

from .._jax import jnp
from ..laws.law import as_float64
from .common_shapes import filled_up
from .curve_table import CENTRAL, CONTACTING, FORCE
from .record import Body, resistances_apart
from .stepped_phase import Samples
from .time_collocation import STAGES
from .time_series import Series
from .time_stepping import KNOTS, TO_SERIES
from .unloading import Unloading

_LONE = 0.03  # of both steps beside it: a step as short counts for nothing


class Trajectory(Series):
    """The samples of a motion that was stepped in time, and what is read between them."""

    @classmethod
    def of(cls, body: Body, release: Samples, each: list[Samples]) -> Trajectory:
        """The trajectory from the release; two phases an impact, each without its start."""
        whole = Samples.joined([release, *each])
        counts = [samples.time.size for samples in each]
        phase = np.append(0, np.repeat(np.arange(len(each)), counts))
        # Where phases meet, rounding may set the clock back.
        whole = whole._replace(time=np.maximum.accumulate(whole.time))
        drag = np.zeros((whole.time.size, len(body.mechanisms)))
        if body.damped:
            central = filled_up(whole.rows[:, CENTRAL])
            drag[:] = np.asarray(resistances_apart(body, central)).T[: whole.time.size]
        return cls(*whole, drag, phase)

    def passing(self, place: float, mass: float) -> tuple[np.ndarray, np.ndarray]:
        """Kinetic energies [J] at a separation [m] on each way in and out; NaN where not passed."""
        x, phase = self.separation, self.phase
        count = 2 * (1 + int(phase[-1]) // 2)
        found = np.full(count, np.nan)
        passed = np.flatnonzero((x[:-1] - place) * (x[1:] - place) <= 0.0)
        for k in passed[::-1]:
            found[phase[k + 1]] = self._kinetic(k, place, mass)
        return found[0::2], found[1::2]

    def contact_time(self, place: float) -> float:
        """Time between passing a separation [m] on the first way in and out [s]; NaN where not.

        Between samples by Hermite's cubic of separation and speed.
        """
        from scipy.interpolate import CubicHermiteSpline

        found = []
        for phase in (0, 1):
            x = self.separation - place
            passed = np.flatnonzero((x[:-1] * x[1:] <= 0.0) & (self.phase[1:] == phase))
            if not passed.size:
                return np.nan
            k = passed[-1 if phase else 0]
            here = slice(k, k + 2)
            cubic = CubicHermiteSpline(self.time[here], x[here], self.speed[here])
            roots = cubic.roots(extrapolate=False)
            found.append(roots[0] if roots.size else self.time[k + 1])
        return float(found[1] - found[0])

    def unloading(self, bonds: slice, *, discrete: bool) -> Unloading:
        """The tension on the first way out, as it was met: it depends on load and rate.

        Between samples force, power and separation are cubic splines of time; of a ``discrete``
        contact, whose force jumps where a bond breaks, Akima's polynomials, which do not overshoot
        there. ``bonds`` are the columns of the bonds.
        """
        from scipy.interpolate import Akima1DInterpolator, CubicSpline

        there = np.flatnonzero(self.phase == 1)
        points = np.concatenate([there[:1] - 1, there])
        acting = np.flatnonzero(self.rows[points, FORCE])  # in flight nothing acts
        points = points[: acting[-1] + 1] if acting.size else points[:0]
        points = points[_apart(self.time[points])]
        time, force = self.time[points], self.rows[points, FORCE]
        if time.size < 2 or not np.min(force) < 0.0:
            return _unloading(0.0, np.nan, 0.0, 0.0, False)
        between = Akima1DInterpolator if discrete else CubicSpline
        along = between(time, force)
        power = between(time, force * self.speed[points]).antiderivative()
        rates = along.derivative().roots(extrapolate=False)
        turns = np.concatenate([time, rates[np.isfinite(rates)]])
        lowest = turns[np.argmin(along(turns))]
        zeros = along.roots(extrapolate=False)
        begins = np.concatenate([time[:1], zeros[np.isfinite(zeros)]])
        place = between(time, self.separation[points])(lowest)
        work = float(np.max(power(begins)) - power(time[-1]))
        rows = self.rows[points[np.argmin(np.abs(time - lowest))]]
        held = float(max(rows[CONTACTING], np.max(rows[bonds], initial=0.0)))
        return _unloading(-float(along(lowest)), float(place), work, held, True)

    def maximum_force(self) -> float:
        """Largest force of the first impact [N], by a parabola of time through three samples."""
        force = self.rows[self.phase < 2, FORCE]
        k = int(np.argmax(force))
        about = slice(k - 1, k + 2)
        span = np.ptp(self.time[about]) if 0 < k < force.size - 1 else 0.0
        if not span > 0.0 or not force[k] > 0.0:
            return float(force[k])
        time = (self.time[about] - self.time[k]) / span
        if np.min(np.diff(time)) < _LONE:
            return float(force[k])
        bend, slope, value = np.polyfit(time, force[about], 2)
        return float(value - 0.25 * slope**2 / bend) if bend < 0.0 else float(force[k])

    def _kinetic(self, k: int, place: float, mass: float) -> float:
        """Kinetic energy [J] between two samples, by the polynomials of their step."""
        from scipy.optimize import brentq

        first = STAGES * (k // STAGES)
        points = slice(first, first + STAGES + 1)
        there = TO_SERIES @ (self.separation[points] - place)
        speed = TO_SERIES @ self.speed[points]
        low, high = 2.0 * KNOTS[k - first] - 1.0, 2.0 * KNOTS[k - first + 1] - 1.0
        x = brentq(lambda x: legval(x, there), low, high, xtol=1e-15)
        return float(0.5 * mass * legval(x, speed) ** 2)


def _apart(time: np.ndarray) -> np.ndarray:
    """Which samples at ascending times a spline may go through.

    Not those that an event has put beside another: rounding makes a slope between them.
    """
    span = np.diff(time)
    around = np.pad(span, 1, constant_values=np.inf)
    lone = span <= _LONE * np.minimum(around[:-2], around[2:])
    return np.concatenate([np.ones(min(time.size, 1), bool), ~lone & (span > 0.0)])


def _unloading(
    pull_off: float, separation: float, work: float, held: float, depends: bool
) -> Unloading:
    return Unloading(
        as_float64(pull_off), as_float64(separation), as_float64(work), as_float64(held),
        jnp.asarray(depends),
    )  # fmt: skip
