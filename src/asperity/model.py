"""Physical objects of the inputs: laws, interface, contact and body."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable
from math import pi
from typing import Any

import numpy as np

from .asperity_laws import asperity_law, formation, laws_beside, plastic_law
from .contact import (
    Contact,
    ElasticContact,
    PublishedContact,
    RigidContact,
    RigidPlasticContact,
    SmoothContact,
    SmoothPlasticContact,
    interaction_range_of,
)
from .contact.delayed_formation import LATE, DelayedContact
from .contact.profile import Sphere
from .contact.resolution import Resolution
from .contact.rough import RoughContact
from .contact.viscoelastic import VISCOUS, Relaxation
from .dynamics import Body
from .dynamics.external_forces import Drag, ExternalForce
from .dynamics.gas_film import SqueezeFilm
from .dynamics.problem import CLEARANCE, Problem
from .dynamics.suspension import Dashpot, Spring
from .dynamics.wave_radiation import WaveRadiation
from .errors import InputError
from .inputs import Asperities, Inputs
from .interface.interface import Interface
from .interface.layers import Layers
from .interface.measured_summits import loss_error, measured_surface
from .interface.plastic_interface import PlasticInterface
from .interface.rough_planes import RoughPlanes
from .laws import (
    HeightFunctions,
    KelvinFilling,
    Law,
    PublishedPressure,
)
from .laws.law import Sum
from .laws.plastic import (
    AdhesiveThorntonNing,
    PlasticContact,
)
from .laws.published_pressures import FINE
from .surfaces.heights import Gaussian


def build(inputs: Inputs, resolved: Resolution | None = None) -> Problem:
    """The objects of physics that inputs describe.

    Parameters
    ----------
    inputs
        The quantities of a case.
    resolved
        How finely the curves of a rough contact are cut; by default as its forces ask for.

    Raises
    ------
    InputError
        If two laws contain the same force, or adhesion alone makes the body yield.
    """
    contact = _contact(inputs, resolved)
    clear = interaction_range_of(contact) + CLEARANCE
    edge = contact.pressure.end if isinstance(contact, PublishedContact) else None
    body = Body(inputs.mass, 0.0, clear, rebounds_from=edge)
    if (let_go := inputs.release) is not None:
        release = clear if let_go.separation is None else let_go.separation
        drags, forces = _drags(inputs), _forces(inputs)
        body = Body(inputs.mass, let_go.gravity, release, let_go.speed, drags, forces, edge)
    delayed, relaxation = _delayed(inputs, contact), None
    if inputs.structure.viscoelastic:
        relaxation = Relaxation(contact, inputs.relaxed_modulus_ratio, inputs.relaxation_time)
        contact = relaxation.relaxed()
        body = dataclasses.replace(body, in_bulk=(VISCOUS,))
    return Problem(contact, body, inputs, delayed, _class_error(inputs), relaxation)


def _contact(inputs: Inputs, resolved: Resolution | None) -> Contact:
    rough = inputs.asperities
    if rough is None and inputs.yields:
        return SmoothPlasticContact(
            _smooth_plastic(inputs), Sum(laws_beside(inputs, inputs.radius))
        )
    if rough is None:
        return SmoothContact(asperity_law(inputs, inputs.radius))
    if inputs.published is not None:
        return _published(inputs, rough)
    interface, shape = _interface(inputs, rough), Sphere(inputs.radius)
    if inputs.structure.deformation == "rigid":
        kind = RigidPlasticContact if interface.yields else RigidContact
        return kind(interface, shape, resolved)
    return ElasticContact(interface, shape, inputs.modulus, inputs.tolerance.rings, resolved)


def _smooth_plastic(inputs: Inputs) -> PlasticContact | AdhesiveThorntonNing:
    """The law of a smooth body, with JKR's adhesion in it where that is asked for."""
    if inputs.structure.adhesion != "jkr":
        return plastic_law(inputs, inputs.structure.plasticity)
    assert inputs.yielding is not None
    radius, modulus = inputs.radius, inputs.modulus
    work, pressure = inputs.work_of_adhesion, inputs.yielding.yield_pressure
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


def _class_error(inputs: Inputs) -> float:
    """Relative error of classes of tip radius in the work of bonds; 0 without classes."""
    rough = inputs.asperities
    if rough is None or rough.summits is None or inputs.structure.heights != "summits":
        return 0.0
    radii = rough.summits.radii
    return loss_error(_law_of_radius(inputs, radii), radii, inputs.radius_classes)


def _law_of_radius(inputs: Inputs, radii: np.ndarray) -> Callable[[Any], Law]:
    """The laws of one asperity of any of the radii [m]."""
    smallest = float(radii.min())
    return lambda radius: asperity_law(inputs, radius, smallest)


def _delayed(inputs: Inputs, contact: Contact) -> DelayedContact | None:
    """The contact with the formation time of its menisci, if they take any."""
    if not inputs.formation_time or LATE not in contact.mechanisms:
        return None
    assert isinstance(contact, RoughContact | SmoothContact)
    return DelayedContact(contact, inputs.formation_time)


def _interface(inputs: Inputs, rough: Asperities) -> RoughPlanes:
    """Asperities between two planes, and liquid on the surface if it is not on them."""
    asperities = _asperities(inputs, rough)
    if inputs.structure.liquid != "kelvin-filling":
        return asperities
    assert inputs.liquid is not None
    tension, angle, radius = inputs.liquid.tension, inputs.contact_angle, inputs.liquid_radius
    filling = KelvinFilling(tension, angle, radius, formation(inputs))
    liquid_layer = Interface(filling, Gaussian(inputs.surface_rms_height), 1.0)
    if isinstance(asperities, Layers):
        return Layers((*asperities.parts, liquid_layer))
    return Layers((asperities, liquid_layer))


def _asperities(inputs: Inputs, rough: Asperities) -> RoughPlanes:
    """The asperities: of one radius and Gaussian heights, or those that were measured."""
    summits = rough.summits
    if summits is None or inputs.structure.heights != "summits":
        heights = Gaussian(rough.rms_height, rough.mean_height)
        if inputs.yields:
            law = plastic_law(inputs, inputs.structure.plasticity)
            beside = Sum(laws_beside(inputs, rough.asperity_radius))
            return PlasticInterface(law, beside, heights, rough.asperity_density)
        return Interface(
            asperity_law(inputs, rough.asperity_radius), heights, rough.asperity_density
        )
    return measured_surface(
        _law_of_radius(inputs, summits.radii),
        summits.heights,
        summits.radii,
        rough.asperity_density,
        radius=rough.asperity_radius,
        classes=inputs.radius_classes,
    )


def _drags(inputs: Inputs) -> tuple[Drag, ...]:
    """What takes energy on the way, in the order of the ledger."""
    drags: list[Drag] = []
    if (gas := inputs.gas) is not None:
        film = SqueezeFilm(inputs.radius, gas.viscosity, gas.slip_length, gas.cutoff_separation)
        drags.append(film)
    if inputs.structure.waves:
        solid = inputs.counterface
        assert solid.density is not None
        drags.append(WaveRadiation.into(solid.youngs_modulus, solid.poisson, solid.density))
    if inputs.suspension is not None and inputs.structure.suspension == "damped":
        drags.append(Dashpot(inputs.suspension.damping))
    return tuple(drags)


def _forces(inputs: Inputs) -> tuple[ExternalForce, ...]:
    """What acts besides weight, contact and drags."""
    held = inputs.suspension
    return () if held is None else (Spring(held.stiffness, held.rest_gap),)


def _published(inputs: Inputs, rough: Asperities) -> PublishedContact:
    """The contact that the publication assumes."""
    assumed, tension, interaction_range = inputs.published, 0.0, None
    assert assumed is not None
    if inputs.liquid is not None:
        tension = assumed.capillary_factor * inputs.liquid.tension * np.cos(inputs.contact_angle)
        span = inputs.liquid_span
        interaction_range = None if np.isinf(span) else np.asarray(span)
    pressure = PublishedPressure(
        density=rough.asperity_density,
        radius=rough.asperity_radius,
        rms_height=rough.rms_height,
        modulus=inputs.modulus,
        work_of_adhesion=inputs.work_of_adhesion,
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
        pressure, Sphere(inputs.radius), float(assumed.attraction_during_retraction_only)
    )
