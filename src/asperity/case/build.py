"""A case as physical objects: laws, interface, contact and body."""

from __future__ import annotations

import math
from math import pi
from typing import TYPE_CHECKING, NamedTuple

from ..contact import (
    Contact,
    ElasticContact,
    PublishedContact,
    RigidContact,
    SmoothContact,
)
from ..impact import Body
from ..interface import Interface
from ..laws import (
    Bradley,
    ByContact,
    ByKelvinGap,
    Dmt,
    HeightFunctions,
    Hertz,
    Jkr,
    Law,
    Meniscus,
    PublishedPressure,
)
from ..laws.base import Sum
from ..materials import contact_modulus
from ..roughness import Gaussian
from ..shapes import Sphere

if TYPE_CHECKING:
    from .bodies import Roughness
    from .publication import Publication
    from .schema import Case

CLEARANCE = 1e-9
"""Gap [m] added to the reach of the forces where a case gives a speed but no release gap."""


class Problem(NamedTuple):
    """What the equation of motion needs.

    Attributes
    ----------
    contact
        Forces between the two bodies.
    body
        Mass and release.
    modulus
        Contact modulus E* [Pa].
    tip_radius
        Radius [m] of one asperity, or of the smooth body.
    """

    contact: Contact
    body: Body
    modulus: float
    tip_radius: float


def build(case: Case) -> Problem:
    """The objects that a case describes.

    Raises
    ------
    InputError
        If two laws contain the same force.
    """
    modulus = contact_modulus(case.body_solid, case.counterface_solid)
    rough = case.roughness
    tip = case.body.radius if rough is None else rough.asperity_radius
    contact: Contact
    if rough is None:
        contact = SmoothContact(_law(case, tip, modulus))
    elif case.publication is not None:
        contact = _published(case, rough, case.publication, modulus)
    else:
        law = _law(case, tip, modulus)
        interface = Interface(law, Gaussian(rough.rms_height), rough.asperity_density)
        shape = Sphere(case.body.radius)
        if case.counterface.deformation == "rigid":
            contact = RigidContact(interface, shape)
        else:
            contact = ElasticContact(interface, shape, modulus, case.numerics.rings)
    impact = case.impact
    release = impact.release_gap
    if release is None:
        release = float(contact.reach) + CLEARANCE
    mass = case.body_density * 4.0 / 3.0 * pi * case.body.radius**3
    body = Body(mass, impact.gravity, release, impact.speed or 0.0)
    return Problem(contact, body, modulus, tip)


def _published(
    case: Case, rough: Roughness, assumed: Publication, modulus: float
) -> PublishedContact:
    """The contact that the publication assumes."""
    liquid, kelvin_radius = case.liquid, case.kelvin_radius
    tension, reach = 0.0, None
    if liquid is not None and kelvin_radius > 0.0:
        cosine = math.cos(_given(case.capillary.contact_angle))
        tension = assumed.capillary_factor * liquid.tension * cosine
        reach = None if math.isinf(kelvin_radius) else 2.0 * kelvin_radius * cosine
    work = _given(case.adhesion.work) if case.adhesion.model != "none" else 0.0
    pressure = PublishedPressure(
        density=rough.asperity_density,
        radius=rough.asperity_radius,
        rms_height=rough.rms_height,
        modulus=modulus,
        work_of_adhesion=work,
        tension=tension,
        edge=assumed.conjunction_ends,
        reach=reach,
        functions=HeightFunctions(float(assumed.polynomials == "printed")),
        bands=assumed.bands,
    )
    return PublishedContact(
        pressure, Sphere(case.body.radius), float(assumed.pull_while_parting_only)
    )


def _law(case: Case, tip: float, modulus: float) -> Law:
    """The laws of one asperity, side by side."""
    laws: list[Law] = []
    adhesion = case.adhesion
    if adhesion.model == "jkr":
        laws.append(Jkr(tip, modulus, _given(adhesion.work)))
    else:
        laws.append(Hertz(tip, modulus))
        if adhesion.model == "dmt":
            laws.append(Dmt(tip, _given(adhesion.work)))
        elif adhesion.model == "bradley":
            laws.append(Bradley(tip, _given(adhesion.work), _given(adhesion.range)))
    liquid, kelvin_radius = case.liquid, case.kelvin_radius
    if liquid is not None and kelvin_radius > 0.0:
        angle = _given(case.capillary.contact_angle)
        formation = ByContact() if case.capillary.formation == "contact" else ByKelvinGap()
        laws.append(Meniscus(tip, liquid.tension, angle, kelvin_radius, formation))
    return laws[0] if len(laws) == 1 else Sum(laws)


def _given(value: float | None) -> float:
    """A value that the schema requires with the model in use."""
    assert value is not None
    return value
