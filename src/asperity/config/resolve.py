"""From a case to its physical quantities: each is computed here, once."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from asperity.config.asperities import asperities_of
from asperity.config.base_table import acts
from asperity.config.bodies import solids_of
from asperity.config.limits import refuse_rough
from asperity.config.plasticity import Plasticity, case_yielding
from asperity.config.roughness import BESIDE, REALISATIONS, Roughness
from asperity.errors import InputError, Tolerance
from asperity.inputs import (
    CLASSES,
    Asperities,
    Assumptions,
    Gas,
    Inputs,
    Placement,
    Release,
    Structure,
    Suspension,
)
from asperity.materials.liquids import kelvin_radius
from asperity.materials.solids import contact_modulus
from asperity.regimes.choice import AdhesionChoice, choose_adhesion
from asperity.regimes.dimensionless_numbers import tabor_number

if TYPE_CHECKING:
    from asperity.config.tables import CaseTables

_DRY: dict[str, Any] = {
    "liquid": None,
    "contact_angle": 0.0,
    "kelvin_radius": 0.0,
    "liquid_radius": 0.0,
    "liquid_span": 0.0,
    "liquid_temperature": None,
    "formation_time": 0.0,
}
"""The quantities of menisci where there are none."""


def resolve(case: CaseTables) -> Inputs:
    """The physical quantities of a case.

    Parameters
    ----------
    case
        The case. Its numbers may be arrays of many cases that are alike in all else.

    Raises
    ------
    InputError
        If a file of a surface cannot be used, or its asperities are as large as the body,
        or made one contact by adhesion.
    """
    body, counterface = solids_of(case)
    rough, radius = _asperities(case), case.body.radius
    tip = radius if rough is None else rough.asperity_radius
    modulus = contact_modulus(body, counterface)
    adhesion = _adhesion(case, tip, modulus)
    air, wet = case.capillary, _menisci(case)
    assert body.density is not None
    relaxing = acts(case.viscoelasticity)
    table = case.roughness
    return Inputs(
        structure=Structure(
            adhesion=adhesion.law,
            liquid=air.model if wet else "none",
            formation=air.formation if wet else "on-contact",
            plasticity="none" if case.plasticity is None else case.plasticity.model,
            deformation=case.counterface.deformation,
            viscoelastic=relaxing,
            waves=acts(case.waves),
            gas=case.gas is not None,
            suspension="none" if case.suspension is None else case.suspension.model,
            heights="smooth" if table is None else table.source or "gaussian",
            published=case.publication is not None,
        ),
        body=body,
        counterface=counterface,
        radius=radius,
        mass=body.density * 4.0 / 3.0 * math.pi * radius**3,
        modulus=modulus,
        tip_radius=tip,
        yielding=case_yielding(case),
        strength_given=_strength_given(case),
        plasticity_allowed=_plasticity_allowed(case),
        work_of_adhesion=0.0 if adhesion.law == "none" else _given(case.adhesion.work),
        equilibrium_spacing=_or_zero(case.adhesion.equilibrium_spacing),
        adhesion_reason=adhesion.reason,
        border_warnings=adhesion.border_warnings,
        asperities=rough,
        surface_rms_height=_surface_rms_height(case, rough),
        radius_classes=CLASSES if table is None else table.radius_classes or CLASSES,
        **(wet or _DRY),
        gas=_gas(case, rough),
        suspension=_suspension(case),
        relaxed_modulus_ratio=_relaxation(case, "relaxed_modulus_ratio") if relaxing else 1.0,
        relaxation_time=_relaxation(case, "relaxation_time") if relaxing else 0.0,
        release=_release(case),
        placement=_placement(table),
        beside=_beside(case),
        published=_assumptions(case),
        tolerance=_tolerance(case),
    )


def _asperities(case: CaseTables) -> Asperities | None:
    """The asperities, read from the files if there are any; None for a smooth body."""
    if case.roughness is None:
        return None
    rough = asperities_of(case.roughness)
    refuse_rough(case, rough)
    return rough


def _adhesion(case: CaseTables, tip: float, modulus: float) -> AdhesionChoice:
    """The law of adhesion that the case names, or the one that holds where it leaves the choice."""
    given = case.adhesion
    if given.model != "auto":
        return AdhesionChoice(given.model)
    work, spacing = _given(given.work), _given(given.equilibrium_spacing)
    return choose_adhesion(tabor_number(tip, work, modulus, spacing))


def _menisci(case: CaseTables) -> dict[str, Any]:
    """The quantities of the menisci; none of them in dry air or without menisci."""
    air = case.capillary
    if air.model == "none":
        return {}
    liquid, humidity, angle = air.substance(), _given(air.humidity), _given(air.contact_angle)
    temperature, film = _given(air.temperature), air.adsorbed_film_thickness
    kelvin = math.inf if humidity == 1.0 else kelvin_radius(liquid, humidity, temperature)
    radius = kelvin if film is None else min(kelvin, film / _cosine(angle))
    if radius == 0.0:
        return {}
    return {
        "liquid": liquid,
        "contact_angle": angle,
        "kelvin_radius": kelvin,
        "liquid_radius": radius,
        "liquid_span": 2.0 * radius * _cosine(angle),
        "liquid_temperature": temperature,
        "formation_time": _or_zero(air.formation_time),
    }


def _surface_rms_height(case: CaseTables, rough: Asperities | None) -> float:
    """Rms height [m] of the surface, given or measured, or else of its summits."""
    if rough is None:
        return 0.0
    given = case.capillary.surface_rms_height
    if given is None:
        return rough.rms_height if rough.surface is None else rough.surface.rms_height
    return given


def _gas(case: CaseTables, rough: Asperities | None) -> Gas | None:
    """The gas in the gap, whose film thins down to the rms height where nothing else is said."""
    table = case.gas
    if table is None:
        return None
    closest = table.cutoff_separation
    if closest is None:
        closest = 0.0 if rough is None else rough.rms_height
    return Gas(*table.film(), closest, table.pressure, table.temperature)


def _suspension(case: CaseTables) -> Suspension | None:
    table = case.suspension
    return None if table is None else Suspension(**table.model_dump())


def _relaxation(case: CaseTables, key: str) -> float:
    return _given(getattr(case.viscoelasticity, key))


def _release(case: CaseTables) -> Release | None:
    impact = case.impact
    if impact is None:
        return None
    return Release(impact.release_separation, _or_zero(impact.speed), impact.gravity)


def _placement(table: Roughness | None) -> Placement | None:
    if table is None or not table.single_bodies:
        return None
    count = table.realisations or REALISATIONS
    return Placement(table.placement == "measured", count, table.seed or 0)


def _beside(case: CaseTables) -> Placement | None:
    """Single bodies beside a mean of few asperities, where the case leaves that open."""
    table = case.roughness
    if table is None or table.placement is not None:
        return None
    try:
        table.model_copy(update={"placement": "random"}).check_beside(case)
    except InputError:
        return None
    return Placement(table.files is not None, BESIDE, seed=0, required=False)


def _tolerance(case: CaseTables) -> Tolerance:
    table = case.numerics
    limit = math.inf if table.time_limit is None else table.time_limit
    ratio, most = table.rest_height_ratio, table.max_impacts
    return Tolerance(table.tolerance, ratio, limit, most, table.rings)


def _assumptions(case: CaseTables) -> Assumptions | None:
    table = case.publication
    return None if table is None else Assumptions(**table.model_dump())


def _strength_given(case: CaseTables) -> bool:
    table = case.plasticity
    if table is None or table.model == "none":
        return False
    return any((table.hardness, table.yield_strength, table.yield_pressure))


def _plasticity_allowed(case: CaseTables) -> bool:
    """Whether a law of yielding could stand beside the other tables."""
    try:
        Plasticity(model="kogut-etsion").refuse_models(case)
    except InputError:
        return False
    return True


def _cosine(angle: Any) -> Any:
    """Cosine of an angle [rad], or of those of many cases."""
    return math.cos(angle) if isinstance(angle, float) else np.cos(angle)


def _or_zero(value: float | None) -> float:
    return 0.0 if value is None else value


def _given(value: float | None) -> float:
    """A value that the schema requires with the model in use."""
    assert value is not None
    return value
