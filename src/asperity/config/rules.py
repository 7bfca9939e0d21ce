"""The rules between the tables of a case."""

from __future__ import annotations

import functools

from asperity.config import problems
from asperity.config.base_table import Table
from asperity.config.case_solids import case_yielding, solids_of
from asperity.config.limits import refuse_outside
from asperity.config.tables import CaseTables
from asperity.errors import InputError, check_each, refuse_all
from asperity.materials import solids as catalogue
from asperity.units import shown


def check_rules(case: CaseTables) -> None:
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
        lambda: _delayed_liquid(case),
        lambda: _waves_beside(case),
        lambda: _creep_beside(case),
        lambda: _yielding_beside(case),
        lambda: _falls(case),
        *(functools.partial(table.check_beside, case) for table in _tables(case)),
        lambda: refuse_outside(case),
    )


def _tables(case: CaseTables) -> list[Table]:
    """The tables that a case has."""
    found = (getattr(case, name) for name in CaseTables.model_fields)
    return [table for table in found if isinstance(table, Table)]


def _falls(case: CaseTables) -> None:
    """Refuse a body that nothing moves."""
    impact = case.impact
    if impact is None or impact.speed is not None or impact.gravity != 0.0:
        return
    if not any(table.drives for table in _tables(case)):
        raise InputError(
            "`gravity` must be positive where there is no `speed`: the body would never fall; "
            "got 0 m/s^2",
            key="impact.gravity",
        )


def _publication_beside(case: CaseTables) -> None:
    """Refuse models that a [publication] table leaves no room for."""
    if case.publication is None:
        return
    if case.roughness is None:
        raise InputError(
            "a [roughness] table must be given with [publication]; got none", key="publication"
        )
    if case.roughness.files is not None:
        raise InputError(
            "`files` must be absent with a [publication] table, which knows Gaussian heights "
            "and one radius alone",
            key="roughness.files",
        )
    if case.gas is not None:
        raise InputError(
            "[gas] must not be given with a [publication] table, which leaves the gas out",
            key="gas",
        )
    wanted = (
        ("counterface.deformation", case.counterface.deformation, ("rigid",)),
        ("adhesion.model", case.adhesion.model, ("dmt", "none")),
        ("capillary.model", case.capillary.model, ("equilibrium", "none")),
        ("capillary.formation", case.capillary.formation, ("on-contact",)),
        ("capillary.formation_time", case.capillary.formation_time, (None,)),
        ("capillary.adsorbed_film_thickness", case.capillary.adsorbed_film_thickness, (None,)),
    )
    refuse_all(
        InputError(
            f"`{key.split('.')[1]}` must be "
            f"{'absent' if allowed == (None,) else ' or '.join(map(repr, allowed))} with a "
            f"[publication] table, which replaces the other models; got {value!r}",
            key=key,
        )
        for key, value, allowed in wanted
        if value not in allowed
    )


def _film_between_ends(case: CaseTables) -> None:
    """Refuse a film that has no thinnest or no thickest place."""
    if case.gas is not None and case.impact is not None:
        case.gas.refuse_without_ends(case.impact, case.roughness)


def _known_material(case: CaseTables, part: str) -> None:
    """Refuse the name of a material that neither the case nor the catalogue has."""
    known = [*case.materials, *catalogue.SOLIDS]
    name = getattr(case, part).material
    if name is not None and name not in known:
        raise InputError(
            "`material` must be a name of the catalogue or of a [materials.NAME] table; "
            f"got {shown(name)}{problems.did_you_mean(name, known)}",
            key=f"{part}.material",
        )


def _elastic_somewhere(case: CaseTables) -> None:
    """Refuse a smooth body on a bulk that does not deform."""
    if case.roughness is None and case.counterface.deformation == "rigid":
        raise InputError(
            "`deformation` must be 'half-space' without a [roughness] table: a smooth rigid "
            "body has no elasticity at all; got 'rigid'",
            key="counterface.deformation",
        )


def _waves_beside(case: CaseTables) -> None:
    """Refuse what waves cannot stand beside."""
    if case.waves is not None:
        case.waves.refuse_beside(solids_of(case)[1], case.capillary, case.publication)


def _creep_beside(case: CaseTables) -> None:
    """Refuse what cannot stand beside a viscoelastic bulk."""
    table = case.viscoelasticity
    if table is None or table.model == "none":
        return
    with_it = f"with [viscoelasticity] model = '{table.model}'"
    _creep_alone(case, with_it)
    if case.counterface.deformation == "rigid":
        raise InputError(
            f"`deformation` must be 'half-space' {with_it}: a rigid bulk has nothing that "
            "creeps; got 'rigid'",
            key="counterface.deformation",
        )
    if case.capillary.model != "none" and case.capillary.formation_time:
        raise InputError(
            f"`formation_time` must be absent {with_it}; got {case.capillary.formation_time:.6g} s",
            key="capillary.formation_time",
        )
    if case.roughness is None:
        _creep_without_pulls(case, with_it)


def _creep_alone(case: CaseTables, with_it: str) -> None:
    """Refuse what takes energy in another way, and what has no bulk."""
    if case.publication is not None:
        raise InputError(
            f"a [publication] table must be absent {with_it}: it has no bulk that creeps",
            key="publication",
        )
    if case.gas is not None:
        raise InputError(
            f"a [gas] table must be absent {with_it}, whose motion knows no drag", key="gas"
        )
    if case.waves is not None and case.waves.model != "none":
        raise InputError(
            f"`model` must be 'none' in [waves] {with_it}, whose motion knows no drag; got "
            f"'{case.waves.model}'",
            key="waves.model",
        )
    yields = case.plasticity
    if yields is not None and yields.model != "none":
        raise InputError(
            f"`model` must be 'none' in [plasticity] {with_it}; got '{yields.model}'",
            key="plasticity.model",
        )


def _creep_without_pulls(case: CaseTables, with_it: str) -> None:
    """Refuse adhesion and menisci of a smooth body."""
    for key, model in (("adhesion", case.adhesion.model), ("capillary", case.capillary.model)):
        if model != "none":
            raise InputError(
                f"`model` must be 'none' for a smooth body {with_it}: how its edge heals and "
                f"peels is not described; got '{model}'",
                key=f"{key}.model",
            )


def _yielding_beside(case: CaseTables) -> None:
    """Refuse what a law of yielding cannot stand beside, and solids that have no strength."""
    table = case.plasticity
    if table is None or table.model == "none":
        return
    check_each(
        lambda: table.refuse_beside(
            case.adhesion, case.capillary, case.roughness, case.publication
        ),
        lambda: table.refuse_under(case.counterface, case.roughness),
        lambda: case_yielding(table, solids_of(case)),
    )


def _delayed_liquid(case: CaseTables) -> None:
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


def _bounded_liquid(case: CaseTables) -> None:
    """Refuse liquid without end, or on a surface that is not described."""
    air = case.capillary
    if air.model == "none" or case.publication is not None:
        return
    if air.humidity == 1.0 and air.adsorbed_film_thickness is None:
        raise InputError(
            "`humidity` must lie in [0, 1) without an `adsorbed_film_thickness` (at 1 the Kelvin "
            "radius is infinite: menisci would reach to any gap, and only the adsorbed film that "
            "they draw from bounds them); got 1",
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
