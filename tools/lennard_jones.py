"""Equilibria of a sphere and a half-space under the Lennard-Jones pressure of their surfaces.

``python -m tools.lennard_jones`` makes the table that :class:`asperity.laws.LennardJones` reads.

In reduced units (gaps in the interatomic spacing eps, radii in sqrt(R eps), pressures in w/eps,
forces in w R, energies in w R eps) the gap at a radius is H = G + r^2/2 + mu^(3/2) u(r), with u the
displacement of a half-space of unit modulus under the pressure (8/3) (H^-9 - H^-3), and mu the
Tabor number. G is the gap at the axis were nothing deformed. For mu above 0.7 the curve of force
against G is S-shaped: three equilibria at one G. It is followed by a measure of how far the
surfaces have come together, which grows all along it, as Greenwood (1997) and Feng (2000) followed
it by the gap at the axis and by its arc length.
"""

from __future__ import annotations

import argparse
from collections.abc import Callable
from multiprocessing import Pool
from typing import Any, NamedTuple

import numpy as np
from numpy.polynomial import chebyshev
from scipy.optimize import brentq

from asperity.halfspace import Rings, mesh_on
from asperity.laws.lennard_jones_path import DEGREES, MEASURES, NODES, TABLE, TABOR_NUMBERS

_FIRST = -22.0
"""Measure where the path begins, some 490 spacings apart."""


class Point(NamedTuple):
    """One equilibrium, in reduced units.

    Attributes
    ----------
    gap
        G.
    force, pressed
        Force, positive apart, and its part where the pressure presses.
    energy
        Of the surfaces and of both bodies.
    """

    gap: float
    force: float
    pressed: float
    energy: float


class _Lost(Exception):
    """Newton's method found no equilibrium near its first guess."""


def _pressure(gap: np.ndarray) -> np.ndarray:
    return 8.0 / 3.0 * (gap**-9 - gap**-3)


def _closeness(gap: np.ndarray, near: float, power: int) -> tuple[np.ndarray, np.ndarray]:
    """1 where surfaces are much nearer than ``near``, 0 far away; and its slope."""
    ratio = (np.minimum(gap, 1e20) / near) ** power
    value = 1.0 / (1.0 + ratio)
    return value, -power * ratio / gap * value**2


def size_of(measure: float) -> float:
    """Length by which the mesh is scaled: 1, and the radius of a larger contact."""
    area = np.exp(measure) / np.pi - 1.0
    return float((area**2 + 1.0) ** 0.25)


def panels(finest: float = 4e-4, growth: float = 1.7, widest: float = 0.025) -> np.ndarray:
    """Ends of the mesh's panels: narrow at 1, where contact ends, and never wide within."""
    inner, outer, width = [1.0], [1.0], finest
    while inner[-1] - width > 0.0:
        inner.append(inner[-1] - width)
        width = min(width * growth, widest)
    width = finest
    while outer[-1] < 60.0:
        outer.append(outer[-1] + width)
        width = min(width * growth, max(widest, 0.3 * outer[-1]))
    return np.array([0.0, *inner[::-1][1:], *outer])


class Contact:
    """The two bodies at one Tabor number, on one mesh."""

    def __init__(self, tabor: float, mesh: Rings) -> None:
        self.soft = tabor**1.5
        self.mesh = mesh

    def closeness(self, gap: np.ndarray, size: float) -> tuple[float, np.ndarray]:
        """The measure's exponential, and its slopes with the gaps: area, and the axis itself."""
        mesh = self.mesh
        each, each_slope = _closeness(gap, 2.0, 8)
        axis, axis_slope = _closeness(np.atleast_1d(mesh.axis @ gap), 1.5, 4)
        value = size**2 * (mesh.area @ each) + np.pi * axis[0]
        return value, size**2 * mesh.area * each_slope + np.pi * axis_slope[0] * mesh.axis

    def rigid(self, measure: float) -> tuple[np.ndarray, float]:
        """First guess far apart: bodies that do not deform."""
        size = size_of(measure)
        shape = 0.5 * (size * self.mesh.radius) ** 2
        found = brentq(lambda g: np.log(self.closeness(g + shape, size)[0]) - measure, 0.5, 900.0)
        return np.log(found + shape), found

    def solve(self, measure: float, guess: np.ndarray) -> tuple[np.ndarray, int]:
        """Logarithms of the gaps, and G last, by Newton's method; and its steps."""
        mesh, size, count = self.mesh, size_of(measure), len(self.mesh.radius)
        push = self.soft * size * mesh.compliance
        gap, apart, before = np.exp(guess[:-1]), guess[-1], np.inf
        matrix = np.zeros((count + 1, count + 1))
        for step in range(14):
            value, slopes = self.closeness(gap, size)
            pressure = _pressure(gap)
            slope = 8.0 / 3.0 * (-9.0 * gap**-10 + 3.0 * gap**-4)
            off = gap - apart - 0.5 * (size * mesh.radius) ** 2 - push @ pressure
            right = np.append(off, value / np.exp(measure) - 1.0)
            matrix[:count, :count] = -push * (slope * gap)
            matrix[np.arange(count), np.arange(count)] += gap
            matrix[:count, count] = -1.0
            matrix[count, :count] = slopes * gap / np.exp(measure)
            scale = np.abs(matrix).max(axis=1)
            if not np.isfinite(scale).all():
                break
            move = np.linalg.solve(matrix / scale[:, None], -right / scale)
            change = np.abs(move[:count]).max()
            share = min(1.0, 0.5 / change) if change > 0.0 else 1.0
            gap, apart = gap * np.exp(share * move[:count]), apart + share * move[count]
            if change < 1e-13 or (change < 1e-7 and change > 0.3 * before):
                return np.append(np.log(gap), apart), step
            before = change
        raise _Lost

    def point(self, measure: float, solution: np.ndarray) -> Point:
        """What an equilibrium comes to; beyond the mesh the bodies are rigid."""
        mesh, size = self.mesh, size_of(measure)
        gap, apart = np.exp(solution[:-1]), float(solution[-1])
        area, pressure = size**2 * mesh.area, _pressure(gap)
        end = apart + 0.5 * (size * mesh.end) ** 2
        beyond = 16.0 / 3.0 * np.pi * (end**-8 / 8.0 - end**-2 / 2.0)
        surface = 8.0 / 3.0 * (gap**-8 / 8.0 - gap**-2 / 2.0)
        bulk = 0.5 * self.soft * size * area @ (pressure * (mesh.compliance @ pressure))
        energy = area @ surface + bulk + 16.0 / 3.0 * np.pi * (end**-7 / 56.0 - 0.5 / end)
        force = float(area @ pressure + beyond)
        return Point(apart, force, float(area @ np.maximum(pressure, 0.0)), float(energy))

    def follow(self, measures: np.ndarray) -> np.ndarray:
        """The path at ascending ``measures``, shape (measures, 4).

        Each equilibrium is guessed by a polynomial through the last ones; where that does not
        lead to it, steps in between are taken.
        """
        done: list[tuple[float, np.ndarray]] = []
        found = []
        guess, apart = self.rigid(_FIRST)
        done.append((_FIRST, self.solve(_FIRST, np.append(guess, apart))[0]))
        step = 0.2
        for measure in measures:
            while done[-1][0] < measure:
                at = min(done[-1][0] + step, float(measure))
                known = np.array([place for place, _ in done[-5:]])
                weights = np.array(
                    [np.prod((at - np.delete(known, k)) / (known[k] - np.delete(known, k)))
                     for k in range(len(known))]
                )  # fmt: skip
                guess = sum(w * one for w, (_, one) in zip(weights, done[-5:], strict=True))
                try:
                    solution, steps = self.solve(at, np.asarray(guess))
                except (_Lost, np.linalg.LinAlgError):
                    step *= 0.5
                    if step < 1e-5:
                        raise
                    continue
                done = [*done[-4:], (at, solution)]
                step = min(0.2, step * (1.5 if steps < 5 else 1.0))
            found.append(self.point(done[-1][0], done[-1][1]))
        return np.array(found)


def nodes_of(ends: np.ndarray, count: int) -> np.ndarray:
    """Chebyshev points of the panels between ascending ends, shape (panels, count)."""
    points = 0.5 + 0.5 * chebyshev.chebpts1(count)
    found: np.ndarray = ends[:-1, None] + np.diff(ends)[:, None] * points
    return found


def _path(tabor: float) -> np.ndarray:
    mesh = mesh_on(panels(), 6)
    return Contact(tabor, mesh).follow(nodes_of(MEASURES, NODES).ravel())


def table(paths: Callable[[Any, Any], Any] = map) -> np.ndarray:
    """Chebyshev coefficients: panel and degree in ln mu, panel and degree in the measure, row."""
    tabor = np.exp(nodes_of(np.log(TABOR_NUMBERS), DEGREES))
    rows = np.array(list(paths(_path, tabor.ravel())))
    rows = rows.reshape(*tabor.shape, len(MEASURES) - 1, NODES, 4)
    by_tabor, along = (
        np.linalg.inv(chebyshev.chebvander(chebyshev.chebpts1(count), count - 1))
        for count in (DEGREES, NODES)
    )
    found: np.ndarray = np.einsum("jn,kp,mnxpr->mjxkr", by_tabor, along, rows)
    return found


def main() -> int:
    """Write the table."""
    parser = argparse.ArgumentParser(prog="python -m tools.lennard_jones", description=__doc__)
    parser.add_argument("--processes", type=int, default=2)
    asked = parser.parse_args()
    with Pool(asked.processes) as pool:
        np.save(TABLE, table(pool.imap))
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
