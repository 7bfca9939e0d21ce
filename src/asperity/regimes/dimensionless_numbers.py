"""The dimensionless numbers of an adhesive rough contact."""

from __future__ import annotations

from math import pi, sqrt
from typing import NamedTuple

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
        Mean contact force per contacting asperity at closest approach over pi w beta.
    adhesion_law
        Name of the law in use.
    adhesion_reason
        Why this law, where the program chose it; None where the case names it.
    liquid_regime
        State of the liquid at closest approach: "dry", "pendular", "coalesced",
        "flooded".
    liquid_regime_reason
        The number and the rule that say so.
    contacting_asperities
        How many are expected to touch at closest approach; None for a smooth body.
    loaded_asperities
        How many carry the load there, effectively; likewise.
    """

    tabor_number: float | None
    elasticity_parameter: float | None
    plasticity_index: float | None
    load_parameter: float | None
    adhesion_law: str
    adhesion_reason: str | None = None
    liquid_regime: str = "dry"
    liquid_regime_reason: str = "there is no liquid"
    contacting_asperities: float | None = None
    loaded_asperities: float | None = None


def tabor_number(radius: float, work: float, modulus: float, spacing: float) -> float:
    """Tabor number: radius [m], work of adhesion [J/m^2], modulus [Pa], spacing [m]."""
    return (radius * work**2 / (modulus**2 * spacing**3)) ** (1.0 / 3.0)


def plasticity_index(modulus: float, hardness: float, rms_height: float, radius: float) -> float:
    """Plasticity index of Greenwood and Williamson (1966): SI values."""
    return modulus / hardness * sqrt(rms_height / radius)


def load_parameter(force: float, contacting: float, work: float, radius: float) -> float:
    """Mean contact force per asperity [N] over the pull of a rigid one, pi w beta."""
    return force / contacting / (pi * work * radius)
