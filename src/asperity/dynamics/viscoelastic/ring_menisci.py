r"""Menisci that take time on rings: each ring has its own threshold, which lags behind its gap.

While h - g_form is below a threshold b, db/dt = (h - g_form - b)/time; above that b stays, until
breaking takes it along.
"""

from __future__ import annotations

from collections.abc import Callable
from math import factorial
from typing import NamedTuple

import numpy as np
from scipy.special import hyp1f1

from ..._jax import jax, jnp
from ...contact.delayed_formation import DelayedContact
from ...interface.rough_planes import Memory as Thresholds
from ...interface.rough_planes import RoughPlanes

Holding = Callable[[jax.Array], Thresholds]
"""The memory at given separations of the rings."""

_HALVINGS = 60


class Waiting(NamedTuple):
    """The menisci of rings at rest relative to one another, within a step.

    Attributes
    ----------
    delayed
        What takes time.
    surfaces
        The surfaces with prescribed menisci.
    """

    delayed: DelayedContact
    surfaces: RoughPlanes

    def goal(self, gaps: jax.Array) -> jax.Array:
        """What the thresholds fall towards [m]."""
        return gaps - self.delayed.law.forming_gap

    def rate(self, gaps: jax.Array, held: Thresholds) -> jax.Array:
        """Rate of the thresholds [m/s], 0 or negative."""
        behind = self.goal(gaps) - held[self.delayed.meniscus_index]
        return jnp.minimum(behind, 0.0) / self.delayed.time

    def holding(self, held: Thresholds, known: jax.Array, span: jax.Array) -> Holding:
        """Thresholds at a stage, by what is ``known`` of their change and its rate for ``span``."""
        begun, gain = held[self.delayed.meniscus_index] + known, span / self.delayed.time

        def at(gaps: jax.Array) -> Thresholds:
            goal = self.goal(gaps)
            lags = (begun + gain * goal) / (1.0 + gain)
            return self.delayed.with_threshold(held, jnp.where(goal < begun, lags, begun))

        return at

    def power(
        self, gaps: jax.Array, held: Thresholds, rate: jax.Array, around: jax.Array
    ) -> tuple[jax.Array, jax.Array]:
        """Power lost per area on menisci that form [W/m^2] at the rings, and beyond them [W]."""
        k = self.delayed.meniscus_index
        loss = self.delayed.loss(gaps - held[k])

        def bonds(threshold: jax.Array) -> tuple[jax.Array, jax.Array]:
            base = self.delayed.with_threshold(held, threshold)
            last = tuple(b[-1:] for b in base)
            outside = self.surfaces.measure(gaps[-1:], last, integrated=1).bonds[k, 0]
            return self.surfaces.measure(gaps, base).bonds[k], outside

        _, (inside, outside) = jax.jvp(bonds, (held[k],), (rate,))
        return inside[:-1] * loss[:-1], around * outside * loss[-1]

    def pressing(self, gaps: jax.Array, held: Thresholds, change: jax.Array) -> jax.Array:
        """Pressure [Pa] that a change of the thresholds [m] makes."""

        def pressure(threshold: jax.Array) -> jax.Array:
            return self.surfaces.pressure(gaps, self.delayed.with_threshold(held, threshold))

        pressed: jax.Array = jax.jvp(pressure, (held[self.delayed.meniscus_index],), (change,))[1]
        return pressed


class FreeFlight(NamedTuple):
    """A goal that moves on a parabola: where it starts [m], its speed, and how that changes."""

    begin: np.ndarray
    speed: float | np.ndarray
    gravity: float

    def goal(self, time: np.ndarray) -> np.ndarray:
        """The goal after a time [s]."""
        return self.begin + time * (self.speed - 0.5 * self.gravity * time)

    def follow(self, threshold: np.ndarray, span: float, pace: float) -> np.ndarray:
        """Thresholds after ``span`` [s], on a way that turns nowhere, with a ``pace`` [1/s]."""
        if span <= 0.0:
            return threshold
        lags = self.goal(np.asarray(0.0)) < threshold
        if np.all(self.speed - 0.5 * self.gravity * span > 0.0):
            end = self._lag(threshold, np.asarray(span), pace)
            met = self._met(threshold, span, pace)
            end = np.where(self.goal(np.asarray(span)) < end, end, self._lag(threshold, met, pace))
            return np.where(lags, end, threshold)
        fall = np.maximum(self.begin - threshold, 0.0)
        root = np.sqrt(self.speed**2 + 2.0 * self.gravity * fall)
        start = np.where(fall > 0.0, 2.0 * fall / np.where(fall > 0.0, root - self.speed, 1.0), 0.0)
        start = np.minimum(start, span)
        later = FreeFlight(self.goal(start), self.speed - self.gravity * start, self.gravity)
        end = later._lag(threshold, span - start, pace)
        return np.where(self.goal(np.asarray(span)) < threshold, end, threshold)

    def _lag(self, threshold: np.ndarray, time: np.ndarray, pace: float) -> np.ndarray:
        """Thresholds that lag behind throughout."""
        s = pace * time
        # Integrals of exp(-s (1 - x)) x^(k-1)/(k-1)! over x from 0 to 1.
        once, twice, thrice = (hyp1f1(1, k + 1, -s) / factorial(k) for k in (1, 2, 3))
        bent: np.ndarray = self.speed * time * twice - self.gravity * time**2 * thrice
        return threshold + s * ((self.begin - threshold) * once + bent)

    def _met(self, threshold: np.ndarray, span: float, pace: float) -> np.ndarray:
        """When a goal that rises meets its threshold."""
        low, high = np.zeros_like(threshold), np.full_like(threshold, span)
        for _ in range(_HALVINGS):
            middle = 0.5 * (low + high)
            below = self.goal(middle) < self._lag(threshold, middle, pace)
            low, high = np.where(below, middle, low), np.where(below, high, middle)
        return low
