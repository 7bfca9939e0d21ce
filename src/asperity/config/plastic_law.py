"""A case's contact that yields: the law of one asperity, or of the smooth body."""

from __future__ import annotations

from math import pi
from typing import TYPE_CHECKING

from ..errors import InputError
from ..laws.plastic import (
    AdhesiveThorntonNing,
    JacksonGreen,
    KogutEtsion,
    PlasticContact,
    ThorntonNing,
)

if TYPE_CHECKING:
    from .schema import Case


def plastic_contact(case: Case, tip: float, modulus: float) -> PlasticContact:
    """The law that a [plasticity] table names, whose ``model`` is not "none".

    Parameters
    ----------
    case
        The case.
    tip
        Radius [m] of an asperity's tip, or of the smooth body.
    modulus
        Contact modulus E* [Pa].
    """
    soft = case.yielding
    if case.plasticity_model == "kogut-etsion":
        return KogutEtsion(tip, modulus, soft.hardness, soft.poisson)
    if case.plasticity_model == "jackson-green":
        return JacksonGreen(tip, modulus, soft.yield_strength, soft.poisson)
    return ThorntonNing(tip, modulus, soft.yield_pressure)


def smooth_contact(case: Case, modulus: float) -> PlasticContact | AdhesiveThorntonNing:
    """The law of a smooth body, with JKR's adhesion in it where the case asks for that.

    Raises
    ------
    InputError
        If it would yield by adhesion alone as soon as it touches.
    """
    radius = case.body.radius
    if case.adhesion.model != "jkr":
        return plastic_contact(case, radius, modulus)
    work, pressure = case.adhesion.work, case.yielding.yield_pressure
    assert work is not None
    law = AdhesiveThorntonNing(radius, modulus, work, pressure)
    if float(law.yield_overlap) < 0.0:
        least = (2.0 * work * modulus**2 / (pi**2 * radius)) ** (1.0 / 3.0)
        raise InputError(
            f"`yield_pressure` must be at least {least / 1e6:.4g} MPa, or the body yields by "
            "adhesion alone before it is pressed, which the law does not describe; got "
            f"{pressure / 1e6:.4g} MPa",
            key="plasticity.yield_pressure",
        )
    return law
