"""A case as physical objects: laws, interface, contact and body."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable
from math import pi
from typing import TYPE_CHECKING, Any

import numpy as np

from .config.plastic_law import plastic_contact, smooth_contact
from .contact import (
    Contact,
    ElasticContact,
    PublishedContact,
    RigidContact,
    SmoothContact,
    SmoothPlasticContact,
)
from .contact.delayed_formation import LATE, DelayedContact
from .contact.profile import Sphere
from .contact.resolution import Resolution
from .contact.viscoelastic import Relaxation
from .dynamics import Body
from .dynamics.gas_film import SqueezeFilm
from .dynamics.problem import CLEARANCE, Problem
from .dynamics.wave_radiation import WaveRadiation
from .interface.interface import Interface
from .interface.layers import Layers, Surfaces
from .interface.measured_summits import loss_error, measured_surface
from .interface.plastic_interface import PlasticInterface
from .interface.radius_classes import CLASSES
from .laws import (
    Bradley,
    ByContact,
    ByKelvinGap,
    ConstantVolume,
    Dmt,
    HeightFunctions,
    Hertz,
    Jkr,
    KelvinFilling,
    Law,
    Maugis,
    Meniscus,
    PublishedPressure,
)
from .laws.adhesion_choice import AdhesionChoice
from .laws.law import Sum
from .laws.liquid.constant_volume import EDGE_ANGLE, EDGE_HOLDS
from .laws.liquid.meniscus import Formation
from .laws.published_pressures import FINE
from .materials.solids import contact_modulus
from .regimes import choose_adhesion, tabor_number
from .surfaces.heights import Gaussian

if TYPE_CHECKING:
    from .config.adhesion_tables import Adhesion
    from .config.asperities import Asperities
    from .config.publication import Publication
    from .config.schema import Case


def build(case: Case, resolved: Resolution | None = None) -> Problem:
    """The objects that a case describes.

    Parameters
    ----------
    case
        The case.
    resolved
        How finely the curves of a rough contact are cut; by default as its forces ask for.

    Raises
    ------
    InputError
        If two laws contain the same force.
    """
    modulus = contact_modulus(case.body_solid, case.counterface_solid)
    rough = case.asperities
    tip = case.body.radius if rough is None else rough.asperity_radius
    adhesion = _adhesion(case, tip, modulus)
    contact: Contact
    if rough is None and case.plasticity_model != "none":
        beside = _beside(case, adhesion.law, tip, tip)
        contact = SmoothPlasticContact(smooth_contact(case, modulus), Sum(beside))
    elif rough is None:
        contact = SmoothContact(_law(case, adhesion.law, tip, modulus))
    elif case.publication is not None:
        contact = _published(case, rough, case.publication, modulus)
    else:
        interface = _interface(case, rough, adhesion.law, modulus)
        shape = Sphere(case.body.radius)
        if case.counterface.deformation == "rigid":
            contact = RigidContact(interface, shape, resolved)
        else:
            contact = ElasticContact(interface, shape, modulus, case.numerics.rings, resolved)
    mass = case.body_density * 4.0 / 3.0 * pi * case.body.radius**3
    body = Body(mass, 0.0, contact.interaction_range + CLEARANCE)
    if (impact := case.impact) is not None:
        release = body.release if impact.release_separation is None else impact.release_separation
        speed = impact.speed or 0.0
        body = Body(mass, impact.gravity, release, speed, _film(case), _waves(case))
    delayed, off = _delayed(case, contact), _class_error(case, adhesion.law, modulus)
    relaxation = _creep(case, contact)
    contact = contact if relaxation is None else relaxation.relaxed()
    return Problem(contact, body, modulus, tip, adhesion, delayed, off, relaxation)


def _creep(case: Case, contact: Contact) -> Relaxation | None:
    """How the bulk under a contact creeps, if it does."""
    table = case.viscoelasticity
    if table is None or table.model == "none":
        return None
    ratio, time = _given(table.relaxed_modulus_ratio), _given(table.relaxation_time)
    return Relaxation(contact, ratio, time)


def _class_error(case: Case, adhesion: str, modulus: float) -> float:
    """Relative error of classes of tip radius in the work of bonds; 0 without classes."""
    rough, table = case.asperities, case.roughness
    if rough is None or rough.summits is None or table is None or table.source != "summits":
        return 0.0
    radii = rough.summits.radii
    make = _law_of_radius(case, adhesion, modulus, radii)
    return loss_error(make, radii, table.radius_classes or CLASSES)


def _law_of_radius(
    case: Case, adhesion: str, modulus: float, radii: np.ndarray
) -> Callable[[Any], Law]:
    """The laws of one asperity of any of the radii [m]."""
    smallest = float(radii.min())
    return lambda radius: _law(case, adhesion, radius, modulus, smallest)


def _delayed(case: Case, contact: Contact) -> DelayedContact | None:
    """The contact with the formation time of its menisci, if they take any."""
    time = case.capillary.formation_time
    if not time or LATE not in contact.mechanisms:
        return None
    assert isinstance(contact, RigidContact | ElasticContact | SmoothContact)
    return DelayedContact(contact, time)


def _interface(case: Case, rough: Asperities, adhesion: str, modulus: float) -> Surfaces:
    """Asperities between two planes, and liquid on the surface if it is not on them."""
    asperities = _asperities(case, rough, adhesion, modulus)
    air, liquid = case.capillary, case.liquid
    if air.model != "kelvin-filling" or liquid is None or case.liquid_radius == 0.0:
        return asperities
    angle = _given(air.contact_angle)
    filling = KelvinFilling(liquid.tension, angle, case.liquid_radius, _formation(case))
    rms = rough.surface_rms_height or _given(air.surface_rms_height)
    liquid_layer = Interface(filling, Gaussian(rms), 1.0)
    if isinstance(asperities, Layers):
        return Layers((*asperities.parts, liquid_layer))
    return Layers((asperities, liquid_layer))


def _asperities(case: Case, rough: Asperities, adhesion: str, modulus: float) -> Surfaces:
    """The asperities: of one radius and Gaussian heights, or those that were measured."""
    table, summits = case.roughness, rough.summits
    assert table is not None
    if summits is None or table.source != "summits":
        law = _law(case, adhesion, rough.asperity_radius, modulus)
        heights = Gaussian(rough.rms_height, rough.mean_height)
        if case.plasticity_model != "none":
            tip = rough.asperity_radius
            beside, yields = _beside(case, adhesion, tip, tip), plastic_contact(case, tip, modulus)
            return PlasticInterface(yields, Sum(beside), heights, rough.asperity_density)
        return Interface(law, heights, rough.asperity_density)
    return measured_surface(
        _law_of_radius(case, adhesion, modulus, summits.radii),
        summits.heights,
        summits.radii,
        rough.asperity_density,
        radius=rough.asperity_radius,
        classes=table.radius_classes or CLASSES,
    )


def _adhesion(case: Case, tip: float, modulus: float) -> AdhesionChoice:
    """The law of adhesion that the case names, or the one that holds where it leaves the choice."""
    given = case.adhesion
    if given.model != "auto":
        return AdhesionChoice(given.model)
    return choose_adhesion(
        tabor_number(tip, _given(given.work), modulus, _given(given.equilibrium_spacing))
    )


def _film(case: Case) -> SqueezeFilm | None:
    """The gas in the gap; None in a vacuum."""
    gas = case.gas
    if gas is None:
        return None
    closest = gas.cutoff_separation
    if closest is None:
        assert case.asperities is not None
        closest = case.asperities.rms_height
    return SqueezeFilm(case.body.radius, gas.film_viscosity, gas.film_slip_length, closest)


def _waves(case: Case) -> WaveRadiation | None:
    """What the contact radiates into the counterface; None where that is left out."""
    if case.waves is None or case.waves.model == "none":
        return None
    solid = case.counterface_solid
    return WaveRadiation.into(solid.youngs_modulus, solid.poisson, _given(solid.density))


def _published(
    case: Case, rough: Asperities, assumed: Publication, modulus: float
) -> PublishedContact:
    """The contact that the publication assumes."""
    liquid, kelvin_radius = case.liquid, case.kelvin_radius
    tension, interaction_range = 0.0, None
    if liquid is not None and kelvin_radius > 0.0:
        cosine = np.cos(_given(case.capillary.contact_angle))
        tension = assumed.capillary_factor * liquid.tension * cosine
        interaction_range = None if np.isinf(kelvin_radius) else 2.0 * kelvin_radius * cosine
    work = _given(case.adhesion.work) if case.adhesion.model != "none" else 0.0
    pressure = PublishedPressure(
        density=rough.asperity_density,
        radius=rough.asperity_radius,
        rms_height=rough.rms_height,
        modulus=modulus,
        work_of_adhesion=work,
        tension=tension,
        edge=assumed.conjunction_ends,
        interaction_range=interaction_range,
        fine=bool(
            assumed.polynomials == "exact" and assumed.conjunction_ends <= FINE * assumed.bands
        ),
        functions=HeightFunctions(float(assumed.polynomials == "printed")),
        bands=assumed.bands,
    )
    return PublishedContact(
        pressure, Sphere(case.body.radius), float(assumed.attraction_during_retraction_only)
    )


def _law(case: Case, model: str, tip: float, modulus: float, smallest: float | None = None) -> Law:
    """The laws of one asperity, side by side; ``smallest`` is the least radius [m] among all."""
    adhesion: Adhesion = case.adhesion
    contact: Law = Hertz(tip, modulus)
    if model == "jkr":
        contact = Jkr(tip, modulus, _given(adhesion.work))
    elif model == "maugis":
        contact = Maugis(tip, modulus, _given(adhesion.work), _given(adhesion.equilibrium_spacing))
    beside = _beside(case, model, tip, smallest or tip)
    return Sum([contact, *beside]) if beside else contact


def _beside(case: Case, model: str, tip: float, smallest: float) -> list[Law]:
    """The laws of one asperity that act beside its contact."""
    adhesion = case.adhesion
    menisci = _menisci(case, tip, smallest)
    if model == "dmt":
        return [Dmt(tip, _given(adhesion.work)), *menisci]
    if model == "bradley":
        return [Bradley(tip, _given(adhesion.work), _given(adhesion.equilibrium_spacing)), *menisci]
    return menisci


def _menisci(case: Case, tip: float, smallest: float) -> list[Law]:
    """The meniscus of one asperity, or of the smooth body; none where liquid is on the surface."""
    air, liquid, liquid_radius = case.capillary, case.liquid, case.liquid_radius
    if liquid is None or liquid_radius == 0.0:
        return []
    angle = _given(air.contact_angle)
    if air.model == "constant-volume":
        formation = _formation(case)
        bridge = ConstantVolume(tip, liquid.tension, angle, liquid_radius, formation)
        volume = pi * smallest * case.liquid_span**2
        tested = volume <= EDGE_HOLDS * smallest**3 and angle <= EDGE_ANGLE
        edge = tested and isinstance(formation, ByContact)
        return [dataclasses.replace(bridge, edge=edge)]
    if air.model == "kelvin-filling" and case.roughness is not None:
        return []
    return [Meniscus(tip, liquid.tension, angle, liquid_radius, _formation(case))]


def _formation(case: Case) -> Formation:
    return ByContact() if case.capillary.formation == "on-contact" else ByKelvinGap()


def _given(value: float | None) -> float:
    """A value that the schema requires with the model in use."""
    assert value is not None
    return value
