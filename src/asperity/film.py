"""Gas squeezed between a sphere and a plane."""

from __future__ import annotations

from math import pi

import numpy as np

AIR_VISCOSITY = 1.82e-5
"""Of air at 20 degC [Pa s] (CRC Handbook of Chemistry and Physics)."""

AIR_FREE_PATH = 65.4e-9
"""Mean free path in air at 20 degC and 101 kPa [m].

From the viscosity, eta/(0.499 rho c) with rho = 1.204 kg/m^3 and c = 463 m/s, the mean speed of
its molecules (Chapman and Cowling 1970); the value of Jennings (1988).
"""


def slip_factor(separation: np.ndarray | float, slip_length: float) -> np.ndarray:
    """Share of the squeeze force that first-order slip on both surfaces leaves, 0 to 1.

    Parameters
    ----------
    separation
        Central separation [m], positive, any shape.
    slip_length
        Slip length b of both surfaces [m], 0 or more. Vinogradova (1995).
    """
    separation = np.asarray(separation, dtype=float)
    if slip_length == 0.0:
        return np.ones_like(separation)
    x = 6.0 * slip_length / separation
    # By its series where x is small: the difference below would cancel.
    small = 1.0 - x / 3.0 + x**2 / 6.0
    factor = 2.0 / x * ((1.0 + 1.0 / x) * np.log1p(x) - 1.0)
    return np.where(x < 1e-4, small, factor)


def squeeze_drag(
    separation: np.ndarray | float, radius: float, viscosity: float, slip_length: float = 0.0
) -> np.ndarray:
    """Force over speed [N s/m] of the gas between an approaching sphere and a plane.

    6 pi viscosity radius^2 f/separation, against the motion in both directions (Brenner 1961,
    f is :func:`slip_factor`). A continuum with first-order slip: it holds below a Knudsen number,
    mean free path over separation, of 0.1; :data:`AIR_FREE_PATH` is that of air.

    Parameters
    ----------
    separation
        Central separation [m], positive and much smaller than the radius.
    radius
        Radius of the sphere [m].
    viscosity
        Viscosity of the gas [Pa s].
    slip_length
        Slip length [m].
    """
    film = 6.0 * pi * viscosity * radius**2 / np.asarray(separation, dtype=float)
    drag: np.ndarray = film * slip_factor(separation, slip_length)
    return drag


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
        As for :func:`squeeze_drag`.

    Returns
    -------
    The decrement ln(X_0/X_1) of heights above the rebound, and the speed there [m/s].
    """
    from scipy.integrate import solve_ivp

    # In nanometres and microseconds.
    unit, clock = 1e-9, 1e-6

    def rate(_: float, y: np.ndarray) -> list[float]:
        damping = float(squeeze_drag(y[0] * unit, radius, viscosity, slip_length)) / mass * clock
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
