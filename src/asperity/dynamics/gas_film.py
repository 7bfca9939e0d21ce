"""Gas squeezed between a sphere and a plane."""

from __future__ import annotations

from math import pi
from typing import ClassVar

import numpy as np

from .._jax import jax, jnp
from ..laws.law import Real, quantity
from .external_forces import Along, Drag


def slip_factor(separation: Real, slip_length: Real) -> jax.Array:
    """Share of the squeeze force that first-order slip on both surfaces leaves, 0 to 1.

    Parameters
    ----------
    separation
        Central separation [m], positive, any shape.
    slip_length
        Slip length b of both surfaces [m], 0 or more. Vinogradova (1995).
    """
    x = 6.0 * slip_length / jnp.asarray(separation, dtype=jnp.float64)
    # By its series where x is small: the difference below would cancel.
    little = x < 1e-4
    large = jnp.where(little, 1.0, x)
    whole = 2.0 / large * ((1.0 + 1.0 / large) * jnp.log1p(large) - 1.0)
    return jnp.where(little, 1.0 - x / 3.0 + x**2 / 6.0, whole)


class SqueezeFilm(Drag):
    """Gas between a sphere and a plane: a drag in both directions.

    Parameters
    ----------
    radius
        Radius of the sphere [m].
    viscosity
        Viscosity of the gas [Pa s].
    slip_length
        Slip length on both surfaces [m].
    closest
        Separation [m] below which the film does not thin: the rms height of rough surfaces. At
        0 the film thins without end, for bodies that never touch: the drag is not finite at
        separations of 0 and below, so that a contact that reaches them needs it above 0.

    Notes
    -----
    Force over speed 6 pi viscosity radius^2 f/separation with f of :func:`slip_factor`: the
    limit of Brenner's solution (1961) for a gap that is small beside the radius, 1 % off at
    0.4 % of it. A continuum with first-order slip: it holds below a Knudsen number, mean free
    path over separation, of 0.1, and while the pressure in the film, about
    3 viscosity radius speed f/separation^2, is small beside the gas's own.
    """

    radius: Real = quantity()
    viscosity: Real = quantity()
    slip_length: Real = quantity(0.0)
    closest: Real = quantity(0.0)

    name: ClassVar[str] = "gas"

    @property
    def thinnest(self) -> Real | None:
        return self.closest

    def resistance(self, along: Along) -> jax.Array:
        return self.drag(along.central)

    def drag(self, separation: Real) -> jax.Array:
        """Force over speed [N s/m] at a central separation [m], any shape."""
        gap = jnp.maximum(jnp.asarray(separation, dtype=jnp.float64), self.closest)
        film = 6.0 * pi * self.viscosity * self.radius**2 / gap
        return film * slip_factor(gap, self.slip_length)


def gas_decrement(
    *,
    release: float,
    rebound: float,
    mass: float,
    gravity: float,
    radius: float,
    viscosity: float,
    slip_length: float,
) -> tuple[float, float]:
    """Logarithmic decrement of the first rebound that the gas alone causes, and impact speed.

    Parameters
    ----------
    release, rebound
        Separations [m] of the release at rest and of an elastic rebound.
    mass, gravity
        Of the sphere [kg], [m/s^2].
    radius, viscosity, slip_length
        As for :class:`SqueezeFilm`.

    Returns
    -------
    The decrement ln(X_0/X_1) of heights above the rebound, and the speed there [m/s].
    """
    from scipy.integrate import solve_ivp

    # In nanometres and microseconds.
    unit, clock = 1e-9, 1e-6
    film = SqueezeFilm(radius, viscosity, slip_length)
    drag = jax.jit(lambda separation: jnp.asarray(film.drag(separation)))

    def rate(_: float, y: np.ndarray) -> list[float]:
        damping = float(drag(y[0] * unit)) / mass * clock
        return [y[1], -gravity * clock**2 / unit - damping * y[1]]

    def lands(_: float, y: np.ndarray) -> float:
        return float(y[0] - rebound / unit)

    def turns(_: float, y: np.ndarray) -> float:
        return float(y[1])

    lands.terminal, lands.direction = True, -1.0  # type: ignore[attr-defined]
    turns.terminal, turns.direction = True, -1.0  # type: ignore[attr-defined]

    def until(event, start: list[float]) -> np.ndarray:  # type: ignore[no-untyped-def]
        answer = solve_ivp(rate, (0.0, 1e6), start, "DOP853", events=event, rtol=1e-9, atol=1e-12)
        state: np.ndarray = answer.y_events[0][0]
        return state

    speed = -until(lands, [release / unit, 0.0])[1]
    top = until(turns, [rebound / unit, speed])[0]
    return float(np.log((release - rebound) / (top * unit - rebound))), float(speed * unit / clock)
