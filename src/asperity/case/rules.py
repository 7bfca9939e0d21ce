"""The rules between the tables of a case."""

from __future__ import annotations

from typing import TYPE_CHECKING

from asperity import materials as catalogue
from asperity.case import problems
from asperity.case.domain import refuse_outside
from asperity.errors import InputError, check_each
from asperity.units import shown

if TYPE_CHECKING:
    from asperity.case.schema import Case


def check_rules(case: Case) -> None:
    """Refuse a case whose tables cannot stand beside each other, with all that is wrong.

    Raises
    ------
    InputError
        With the key at fault and its rule.
    """
    check_each(lambda: _known_material(case, "body"), lambda: _known_material(case, "counterface"))
    check_each(
        lambda: _publication_beside(case),
        lambda: _film_between_ends(case),
        lambda: _elastic_somewhere(case),
        lambda: _bounded_liquid(case),
        lambda: _late_liquid(case),
        lambda: _waves_beside(case),
        lambda: _creep_beside(case),
        lambda: _yielding_beside(case),
        lambda: refuse_outside(case),
    )


def _publication_beside(case: Case) -> None:
    """Refuse models that a [publication] table leaves no room for."""
    if case.publication is not None:
        case.publication.refuse_beside(case)


def _film_between_ends(case: Case) -> None:
    """Refuse a film that has no thinnest or no thickest place."""
    if case.gas is not None and case.impact is not None:
        case.gas.refuse_without_ends(case.impact, case.roughness)


def _known_material(case: Case, part: str) -> None:
    """Refuse the name of a material that neither the case nor the catalogue has."""
    known = [*case.materials, *catalogue.SOLIDS]
    name = getattr(case, part).material
    if name is not None and name not in known:
        raise InputError(
            "`material` must be a name of the catalogue or of a [materials.NAME] table; "
            f"got {shown(name)}{problems.did_you_mean(name, known)}",
            key=f"{part}.material",
        )


def _elastic_somewhere(case: Case) -> None:
    """Refuse a smooth body on a bulk that does not deform."""
    if case.roughness is None and case.counterface.deformation == "rigid":
        raise InputError(
            "`deformation` must be 'half-space' without a [roughness] table: a smooth rigid "
            "body has no elasticity at all; got 'rigid'",
            key="counterface.deformation",
        )


def _waves_beside(case: Case) -> None:
    """Refuse what waves cannot stand beside."""
    if case.waves is not None:
        case.waves.refuse_beside(case.counterface_solid, case.capillary, case.publication)


def _creep_beside(case: Case) -> None:
    """Refuse what a creeping bulk cannot stand beside."""
    if case.viscoelasticity is not None:
        case.viscoelasticity.refuse_beside(case)


def _yielding_beside(case: Case) -> None:
    """Refuse what a law of yielding cannot stand beside, and solids that have no strength."""
    table = case.plasticity
    if table is None or table.model == "none":
        return
    check_each(
        lambda: table.refuse_beside(
            case.adhesion, case.capillary, case.roughness, case.publication
        ),
        lambda: table.refuse_under(case.counterface, case.roughness),
        lambda: case.yielding,
    )


def _late_liquid(case: Case) -> None:
    """Refuse menisci that take time on a rough half-space beside gas."""
    time, rough = case.capillary.formation_time, case.roughness is not None
    if not time or case.capillary.model == "none" or case.publication is not None:
        return
    if rough and case.counterface.deformation != "rigid" and case.gas is not None:
        raise InputError(
            "[gas] must be absent beside `formation_time` on a rough half-space, whose motion "
            "is stepped without a film; take deformation = 'rigid', or no `formation_time`; "
            f"got {time:.6g} s",
            key="capillary.formation_time",
        )


def _bounded_liquid(case: Case) -> None:
    """Refuse liquid without end, or on a surface that is not described."""
    air = case.capillary
    if air.model == "none" or case.publication is not None:
        return
    if air.humidity == 1.0 and air.film_thickness is None:
        raise InputError(
            "`humidity` must lie in [0, 1) without a `film_thickness` (at 1 the Kelvin radius "
            "is infinite: menisci would reach to any gap, and only the adsorbed film that they "
            "draw from bounds them); got 1",
            key="capillary.humidity",
        )
    if air.model == "kelvin-filling":
        given, table = air.surface_rms_height is not None, case.roughness
        if (table is not None and table.files is None) != given:
            rule = "must be given with a [roughness] table of numbers"
            if table is None:
                rule = "must not be given for a smooth body, which has none"
            elif table.files is not None:
                rule = "must not be given beside `roughness.files`, which it is taken from"
            raise InputError(
                f"`surface_rms_height` {rule}; got {'a value' if given else 'nothing'}",
                key="capillary.surface_rms_height",
            )
