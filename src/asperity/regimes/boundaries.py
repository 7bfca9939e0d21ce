"""The adhesion map of Johnson and Greenwood: its boundaries, and the region of a place on it."""

from __future__ import annotations

from collections.abc import Sequence
from math import ceil, floor, log10, pi
from typing import NamedTuple

import numpy as np

SHARE = 0.05
"""What counts as little on the map, and its inverse as much: 5 %."""

_Ends = tuple[float, float]

USUAL: tuple[_Ends, _Ends] = ((1e-3, 1e2), (1e-1, 1e5))
"""Elasticity and load parameters that the map shows in any case."""

FARTHEST: tuple[_Ends, _Ends] = ((1e-5, 1e4), (1e-3, 1e9))
"""Those that it shows at most."""

_POINTS = 200
_SMALL_RIM = 0.03


class Boundary(NamedTuple):
    """A line of the adhesion map, between two models."""

    between: tuple[str, str]
    elasticity: np.ndarray
    load: np.ndarray


class Place(NamedTuple):
    """A case on the map.

    Attributes
    ----------
    name
        What the case is called.
    elasticity
        Its elasticity parameter.
    load
        Its load parameter; NaN where nothing touches.
    """

    name: str
    elasticity: float
    load: float


class Frame(NamedTuple):
    """What a picture of the map shows: its ends in both parameters."""

    elasticity: tuple[float, float]
    load: tuple[float, float]

    @classmethod
    def around(cls, places: Sequence[Place]) -> Frame:
        """Johnson and Greenwood's own, in whole decades wider where places need it.

        A place that lies farther off than `FARTHEST` stays outside.
        """
        return cls(
            _widened(USUAL[0], FARTHEST[0], [place.elasticity for place in places]),
            _widened(USUAL[1], FARTHEST[1], [place.load for place in places]),
        )

    def boundaries(self) -> list[Boundary]:
        """The map's lines within the frame."""
        return adhesion_map(
            np.geomspace(*self.elasticity, _POINTS), np.geomspace(*self.load, _POINTS)
        )


def _widened(usual: _Ends, farthest: _Ends, values: Sequence[float]) -> _Ends:
    known = [min(max(value, farthest[0]), farthest[1]) for value in values if value > 0.0]
    low, high = min([usual[0], *known]), max([usual[1], *known])
    return 10.0 ** floor(log10(low)), 10.0 ** ceil(log10(high))


def adhesion_map(elasticity: np.ndarray, load: np.ndarray) -> list[Boundary]:
    """Boundaries of the models of one adhesive sphere, over its elasticity parameter and load.

    After Johnson and Greenwood (1997), computed from Maugis's two equations (1992) for the
    contact. With P the load, P_1 the Hertz load of the same contact radius a, and delta_a the
    part of the displacement that adhesion of the range h_0 = w/sigma_0 causes:

    - adhesion adds less than 5 % to the load, P_1 - P < 0.05 P: Hertz;
    - the compression a^2/R is below 0.05 h_0: rigid (Bradley);
    - delta_a is below 0.05 h_0: DMT; above 20 h_0: JKR.

    Parameters
    ----------
    elasticity
        Elasticity parameters lambda to look at, positive, ascending.
    load
        Load parameters P/(pi w R), positive, ascending.
    """
    hertz, rigid, adhesive = np.moveaxis(
        np.array([_criteria(float(value), load) for value in elasticity]), 1, 0
    )
    sides = ((rigid, SHARE), (adhesive, SHARE), (adhesive, 1.0 / SHARE))
    names = (("Bradley", "DMT"), ("DMT", "Maugis-Dugdale"), ("Maugis-Dugdale", "JKR"))
    lines = [Boundary(("Hertz", "adhesive"), elasticity, _crossing(load, hertz, SHARE))]
    for between, (field, level) in zip(names, sides, strict=True):
        lines.append(Boundary(between, _crossing(elasticity, field.T, level), load))
    return lines


def region(elasticity: float, load: float) -> str:
    """Name of the map's region at an elasticity parameter and a load parameter, both positive."""
    return str(regions(elasticity, np.array([load]))[0])


def regions(elasticity: float, load: np.ndarray) -> np.ndarray:
    """Names of the regions at one elasticity parameter, as `region`, for each load parameter."""
    hertz, rigid, adhesive = _criteria(elasticity, load)
    rules = (hertz < SHARE, rigid < SHARE, adhesive < SHARE, adhesive > 1.0 / SHARE)
    return np.select(rules, ("Hertz", "Bradley", "DMT", "JKR"), "Maugis-Dugdale")


def hertz_load(elasticity: float) -> float:
    """Load parameter above which adhesion adds less than 5 % to the load.

    From 40 for rigid spheres (2 = 0.05 P) to 2520 for soft ones (3 + sqrt(6 P + 9) = 0.05 P).
    """
    load = np.geomspace(20.0, 5e3, 400)
    hertz, _, _ = _criteria(elasticity, load)
    return float(_crossing(load, hertz[None, :], SHARE)[0])


def _criteria(elasticity: float, load: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Added load over the load, compression and adhesive displacement over h_0, at each load."""
    excess = 10.0 ** np.linspace(9.0, -20.0, 3500)  # c/a - 1, from no load to high ones
    root = np.sqrt(excess * (2.0 + excess))
    angle = np.arctan(root)
    fixed, bent = _rim(excess, root, angle)
    square, linear = 0.5 * elasticity * fixed, 4.0 / 3.0 * elasticity**2 * bent
    radius = 2.0 / (linear + np.sqrt(linear**2 + 4.0 * square))
    pull = elasticity * radius**2 * (root + (1.0 + excess) ** 2 * angle)
    found = radius**3 - pull
    rising = int(np.argmin(found))  # a load that pulls has two contacts; none is on the map
    adhesive = 4.0 / 3.0 * elasticity * radius * root
    scale = 2.0 / (pi * elasticity)

    def at_load(values: np.ndarray) -> np.ndarray:
        return np.interp(load, found[rising:], values[rising:])

    return (
        at_load(pull) / load,
        at_load(radius**2) / scale,
        at_load(adhesive) / scale,
    )


def _rim(excess: np.ndarray, root: np.ndarray, angle: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The brackets of Maugis's equation for the gap at the rim, with m = c/a.

    sqrt(m^2-1) + (m^2-2) arctan(sqrt(m^2-1)), and sqrt(m^2-1) arctan(sqrt(m^2-1)) - m + 1; by
    their series where m is close to 1, since there the terms cancel.
    """
    s = np.minimum(root, _SMALL_RIM)
    near = root < _SMALL_RIM
    fixed = s**3 * (4.0 / 3.0 - 8.0 / 15.0 * s**2 + 12.0 / 35.0 * s**4)
    bent = excess + excess**2 - s**4 * (1.0 / 3.0 - s**2 / 5.0 + s**4 / 7.0)
    return (
        np.where(near, fixed, root + (root**2 - 1.0) * angle),
        np.where(near, bent, root * angle - excess),
    )


def _crossing(places: np.ndarray, fields: np.ndarray, level: float) -> np.ndarray:
    """Place at which each row of ``fields`` crosses a level, on logarithmic scales; or NaN."""
    out = np.full(len(fields), np.nan)
    for row, values in enumerate(np.log(fields / level)):
        found = np.flatnonzero(values[:-1] * values[1:] <= 0.0)
        if found.size:
            k = int(found[0])
            share = values[k] / (values[k] - values[k + 1])
            out[row] = places[k] * (places[k + 1] / places[k]) ** share
    return out
