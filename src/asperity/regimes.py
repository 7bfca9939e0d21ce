"""Which model holds: the dimensionless numbers of an adhesive rough contact."""

from __future__ import annotations

from math import pi, sqrt
from typing import NamedTuple

import numpy as np

ELASTICITY_PER_TABOR = 1.16
"""Elasticity parameter per Tabor number, as in the publication (Johnson 1998)."""


class Regime(NamedTuple):
    """The numbers of one contact; None where one does not apply.

    Attributes
    ----------
    tabor_number
        (R w^2 / (E*^2 eps^3))^(1/3), the publication's eq. 2.
    elasticity_parameter
        1.16 times the Tabor number.
    plasticity_index
        (E*/H) sqrt(sigma/beta), the publication's eq. 3; above 1 asperities yield.
    load_parameter
        Mean contact force per touching asperity at closest approach over pi w beta.
    adhesion_law
        Name of the law in use.
    """

    tabor_number: float | None
    elasticity_parameter: float | None
    plasticity_index: float | None
    load_parameter: float | None
    adhesion_law: str


def tabor_number(radius: float, work: float, modulus: float, spacing: float) -> float:
    """Tabor number: radius [m], work of adhesion [J/m^2], modulus [Pa], spacing [m]."""
    return (radius * work**2 / (modulus**2 * spacing**3)) ** (1.0 / 3.0)


def plasticity_index(modulus: float, hardness: float, rms_height: float, radius: float) -> float:
    """Plasticity index of Greenwood and Williamson (1966): SI values."""
    return modulus / hardness * sqrt(rms_height / radius)


def load_parameter(force: float, touching: float, work: float, radius: float) -> float:
    """Mean contact force per asperity [N] over the pull of a rigid one, pi w beta."""
    return force / touching / (pi * work * radius)


class Boundary(NamedTuple):
    """A line of the adhesion map, between two models."""

    between: tuple[str, str]
    elasticity: np.ndarray
    load: np.ndarray


_SHARE = 0.05
"""What counts as little on the map, and its inverse as much: 5 %."""


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
    sides = ((rigid, _SHARE), (adhesive, _SHARE), (adhesive, 1.0 / _SHARE))
    names = (("Bradley", "DMT"), ("DMT", "Maugis-Dugdale"), ("Maugis-Dugdale", "JKR"))
    lines = [Boundary(("Hertz", "adhesive"), elasticity, _crossing(load, hertz, _SHARE))]
    for between, (field, level) in zip(names, sides, strict=True):
        lines.append(Boundary(between, _crossing(elasticity, field.T, level), load))
    return lines


def _criteria(elasticity: float, load: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Added load over the load, compression and adhesive displacement over h_0, at each load."""
    ratio = 1.0 + 10.0 ** np.linspace(9.0, -8.0, 2000)  # c/a, from no load to high ones
    root, angle = np.sqrt((ratio - 1.0) * (ratio + 1.0)), np.arccos(1.0 / ratio)
    square = 0.5 * elasticity * (root + (ratio**2 - 2.0) * angle)
    linear = 4.0 / 3.0 * elasticity**2 * (root * angle - ratio + 1.0)
    radius = 2.0 / (linear + np.sqrt(linear**2 + 4.0 * square))
    pull = elasticity * radius**2 * (root + ratio**2 * angle)
    found = radius**3 - pull
    rising = int(np.argmin(found))  # a load that pulls has two contacts; none is on the map
    adhesive = 4.0 / 3.0 * elasticity * radius * root
    reach = 2.0 / (pi * elasticity)

    def at_load(values: np.ndarray) -> np.ndarray:
        return np.interp(load, found[rising:], values[rising:])

    return at_load(pull) / load, at_load(radius**2) / reach, at_load(adhesive) / reach


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
