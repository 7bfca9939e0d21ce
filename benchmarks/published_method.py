"""The opponent: the publication's own method, section 4, with NumPy alone.

A square grid, pressures from polynomials in lambda' (eqs. 9, 13-17), deformation by a fixed
point until eq. 22 holds, fourth-order Runge-Kutta in steps of 0.1 us. It knows nothing of
asperity. Where the text leaves a choice it is taken in the method's favour: the profile is a
sphere's, displacements are convolved by FFT, cells beyond the edge are skipped, and far from
contact no force is computed at all. Adhesion and menisci pull while the sphere parts, and
nothing acts beyond the edge of the conjunction: without these its tables do not follow.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from scipy.integrate import quad
from scipy.special import ndtr

Function = Callable[[np.ndarray], np.ndarray]

PRINTED_F0 = np.polynomial.Polynomial(
    [0.5, -0.3912, -0.03592, 0.1275, -0.048, 0.006278, 0.00003763, -0.00004965]
)
PRINTED_F32 = np.polynomial.Polynomial(
    [0.43, -0.6167, 0.3215, -0.04654, -0.02193, 0.01106, -0.001913, 0.0001217]
)


@dataclass(frozen=True)
class Conjunction:
    """The sphere over a grid, in SI units.

    ``tension`` is gamma cos(theta) times the factor on the menisci, at an infinite Kelvin
    radius, where eq. 15 telescopes.
    """

    radius: float
    modulus: float
    density: float
    summit_radius: float
    rms: float
    work: float
    tension: float
    edge: float
    mass: float
    gravity: float
    release: float
    f0: Function
    f32: Function
    points: int = 64
    half_width: float = 300e-9
    deforms: bool = True
    tolerance: float = 1e-3
    step: float = 1e-7
    rise: np.ndarray = field(init=False)
    influence: np.ndarray = field(init=False)
    area: float = field(init=False)

    def __post_init__(self) -> None:
        cell = 2.0 * self.half_width / self.points
        middle = (np.arange(self.points) + 0.5) * cell - self.half_width
        x, y = np.meshgrid(middle, middle)
        object.__setattr__(self, "area", cell**2)
        object.__setattr__(self, "rise", (x**2 + y**2) / (2.0 * self.radius))
        object.__setattr__(self, "influence", np.fft.rfft2(_influence(self.points, cell)))

    def pressure(self, gap: np.ndarray, unloading: bool) -> np.ndarray:
        """Net pressure of every cell [Pa], eqs. 9, 15 and 16 per area."""
        reduced = gap / self.rms
        inside = reduced < self.edge
        reduced = np.where(inside, reduced, self.edge)
        scale = 4.0 / 3.0 * self.density * np.sqrt(self.summit_radius) * self.rms**1.5
        total = self.modulus * scale * self.f32(reduced)
        if unloading:
            share = self.f0(reduced)
            around = 2.0 * np.pi * self.summit_radius * self.density
            total = total - around * self.work * share
            total = total - 2.0 * around * self.tension * (0.5 - share)
        return np.where(inside, total, 0.0)

    def displacement(self, pressure: np.ndarray) -> np.ndarray:
        """Eq. 19, by FFT on a grid of twice the size."""
        count = self.points
        padded = np.zeros((2 * count, 2 * count))
        padded[:count, :count] = pressure
        whole = np.fft.irfft2(np.fft.rfft2(padded) * self.influence, s=padded.shape)
        found: np.ndarray = whole[:count, :count] / self.modulus
        return found

    def force(self, place: float, unloading: bool, guess: np.ndarray) -> tuple[float, np.ndarray]:
        """Sum over the grid [N], steps 1 to 5, and the displacement for the next guess."""
        lift = guess
        pressure = self.pressure(place + self.rise + lift, unloading)
        if not self.deforms:
            return float(np.sum(pressure)) * self.area, lift
        for _ in range(200):
            lift = 0.5 * (lift + self.displacement(pressure))
            new = self.pressure(place + self.rise + lift, unloading)
            # Eq. 22 divides by zero elsewhere; and a cell that its own pressure lifts over the
            # edge comes back without it, for ever.
            known = (pressure != 0.0) & (new != 0.0)
            change = np.sum(np.abs((new[known] - pressure[known]) / pressure[known]))
            pressure = new
            if change <= self.tolerance:
                break
        else:
            raise RuntimeError(f"eq. 22 is not met to {self.tolerance:g} at {place:.4g} m")
        return float(np.sum(pressure)) * self.area, lift


def _influence(points: int, cell: float) -> np.ndarray:
    """Displacement times E* of a cell under unit pressure (Love 1929), wrapped for the FFT."""
    index = np.arange(2 * points)
    away = np.minimum(index, 2 * points - index) * cell
    x, y = np.meshgrid(away, away)
    total = np.zeros_like(x)
    for i in (-0.5, 0.5):
        for j in (-0.5, 0.5):
            a, b = x + i * cell, y + j * cell
            total += 4.0 * i * j * (a * np.arcsinh(b / np.abs(a)) + b * np.arcsinh(a / np.abs(b)))
    return total / np.pi


def integrate(model: Conjunction, impacts: int) -> tuple[list[float], list[float]]:
    """Apex separations [m] and their times [s], by Runge-Kutta until so many impacts are over."""
    state, time = np.array([model.release, 0.0]), 0.0
    lift = np.zeros_like(model.rise)
    apexes: list[float] = []
    times: list[float] = []
    end = model.edge * model.rms

    def rate(y: np.ndarray) -> np.ndarray:
        nonlocal lift
        if y[0] > end + 1e-10:
            lift = np.zeros_like(lift)
            return np.array([y[1], -model.gravity])
        force, lift = model.force(float(y[0]), bool(y[1] > 0.0), lift)
        return np.array([y[1], force / model.mass - model.gravity])

    while len(apexes) < impacts and time < 2e-3:
        h = model.step
        a = rate(state)
        b = rate(state + 0.5 * h * a)
        c = rate(state + 0.5 * h * b)
        d = rate(state + h * c)
        new = state + h / 6.0 * (a + 2.0 * b + 2.0 * c + d)
        if state[1] > 0.0 >= new[1]:
            share = state[1] / (state[1] - new[1])
            apexes.append(float(state[0] + 0.5 * share * h * state[1]))
            times.append(time + share * h)
        state, time = new, time + h
    return apexes, times


def fitted(order: int = 10) -> tuple[Function, Function]:
    """F_0 and F_3/2 as polynomials fitted to the integrals, to 1e-10 for lambda' from 2 to 3."""

    def moment(l: float) -> float:
        def density(s: float) -> float:
            return (s - l) ** 1.5 * np.exp(-0.5 * s * s) / np.sqrt(2.0 * np.pi)

        return float(quad(density, l, l + 12.0, epsabs=1e-14, epsrel=1e-12)[0])

    interpolate = np.polynomial.Chebyshev.interpolate
    domain = [2.0, 3.05]
    return (
        interpolate(lambda l: ndtr(-l), order, domain),
        interpolate(np.vectorize(moment), order, domain),
    )


def of_problem(problem: Any, **options: Any) -> Conjunction:
    """The method on the numbers of a built case of asperity, with fitted polynomials.

    With those printed the sphere sticks at the first impact, here as there.
    """
    pressure, body = problem.contact.pressure, problem.body
    f0, f32 = fitted()
    return Conjunction(
        radius=float(problem.contact.shape.radius),
        modulus=float(pressure.modulus),
        density=float(pressure.density),
        summit_radius=float(pressure.radius),
        rms=float(pressure.rms_height),
        work=float(pressure.work_of_adhesion),
        tension=float(pressure.tension),
        edge=float(pressure.edge),
        mass=float(body.mass),
        gravity=float(body.gravity),
        release=float(body.release),
        **{"f0": f0, "f32": f32, **options},
    )
