"""The laws of one asperity, or of a smooth body, as the quantities of a case ask for them."""

from __future__ import annotations

import dataclasses
from math import pi

from .inputs import Inputs
from .laws import (
    Bradley,
    ByContact,
    ByKelvinGap,
    ConstantVolume,
    Dmt,
    Hertz,
    Jkr,
    Law,
    LennardJones,
    Maugis,
    Meniscus,
)
from .laws.law import Sum
from .laws.liquid.constant_volume import EDGE_ANGLE, EDGE_HOLDS
from .laws.liquid.meniscus import Formation
from .laws.plastic import JacksonGreen, KogutEtsion, PlasticContact, ThorntonNing


def plastic_law(inputs: Inputs, name: str, tip: float | None = None) -> PlasticContact:
    """The law of one contact that yields, without adhesion, by its name in a case.

    Parameters
    ----------
    inputs
        The quantities of a case in which the strength of a solid is known.
    name
        "kogut-etsion", "jackson-green" or "thornton-ning".
    tip
        Its tip radius [m]; by default that of the case.
    """
    soft, tip, modulus = inputs.yielding, tip or inputs.tip_radius, inputs.modulus
    assert soft is not None
    if name == "kogut-etsion":
        return KogutEtsion(tip, modulus, soft.hardness, soft.poisson)
    if name == "jackson-green":
        return JacksonGreen(tip, modulus, soft.yield_strength, soft.poisson)
    return ThorntonNing(tip, modulus, soft.yield_pressure)


def asperity_law(inputs: Inputs, tip: float, smallest: float | None = None) -> Law:
    """The laws of one asperity, side by side.

    Parameters
    ----------
    inputs
        The quantities of a case.
    tip
        Its tip radius [m].
    smallest
        The least radius [m] among all asperities, where they differ.
    """
    model, work, modulus = inputs.structure.adhesion, inputs.work_of_adhesion, inputs.modulus
    contact: Law = Hertz(tip, modulus)
    if model == "jkr":
        contact = Jkr(tip, modulus, work)
    elif model == "maugis":
        contact = Maugis(tip, modulus, work, inputs.equilibrium_spacing)
    elif model == "lennard-jones":
        contact = LennardJones(tip, modulus, work, inputs.equilibrium_spacing)
    beside = laws_beside(inputs, tip, smallest)
    return Sum([contact, *beside]) if beside else contact


def laws_beside(inputs: Inputs, tip: float, smallest: float | None = None) -> list[Law]:
    """The laws of one asperity that act beside its elastic or plastic contact.

    Parameters
    ----------
    inputs, tip, smallest
        As for :func:`asperity_law`.
    """
    model, work = inputs.structure.adhesion, inputs.work_of_adhesion
    menisci = _menisci(inputs, tip, smallest or tip)
    if model == "dmt":
        return [Dmt(tip, work), *menisci]
    if model == "bradley":
        return [Bradley(tip, work, inputs.equilibrium_spacing), *menisci]
    return menisci


def _menisci(inputs: Inputs, tip: float, smallest: float) -> list[Law]:
    """The meniscus of one asperity, or of the smooth body; none where liquid is on the surface."""
    if inputs.liquid is None:
        return []
    model, forms = inputs.structure.liquid, formation(inputs)
    tension, angle, radius = inputs.liquid.tension, inputs.contact_angle, inputs.liquid_radius
    if model == "constant-volume":
        bridge = ConstantVolume(tip, tension, angle, radius, forms)
        volume = pi * smallest * inputs.liquid_span**2
        tested = volume <= EDGE_HOLDS * smallest**3 and angle <= EDGE_ANGLE
        edge = tested and isinstance(forms, ByContact)
        return [dataclasses.replace(bridge, edge=edge)]
    if model == "kelvin-filling" and inputs.asperities is not None:
        return []
    return [Meniscus(tip, tension, angle, radius, forms)]


def formation(inputs: Inputs) -> Formation:
    """When a meniscus forms."""
    return ByContact() if inputs.structure.formation == "on-contact" else ByKelvinGap()
