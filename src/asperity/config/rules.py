"""The rules between the tables of a case."""

from __future__ import annotations

import functools

from asperity.config import problems
from asperity.config.base_table import Table
from asperity.config.limits import refuse_outside
from asperity.config.tables import CaseTables
from asperity.errors import InputError, check_each
from asperity.materials import solids as catalogue


def check_rules(case: CaseTables) -> None:
    """Refuse a case whose tables cannot stand beside each other, with all that is wrong.

    Raises
    ------
    InputError
        With the key at fault and its rule.
    """
    check_each(lambda: _known_material(case, "body"), lambda: _known_material(case, "counterface"))
    tables = [value for _, value in case if isinstance(value, Table)]
    check_each(
        lambda: _elastic_somewhere(case),
        lambda: _bounded_liquid(case),
        lambda: _delayed_liquid(case),
        lambda: _falls(case),
        *(functools.partial(table.check_beside, case) for table in tables),
        lambda: refuse_outside(case),
    )


def _falls(case: CaseTables) -> None:
    """Refuse a body that nothing moves."""
    impact = case.impact
    if impact is None or impact.speed is not None or impact.gravity != 0.0:
        return
    if case.suspension is None:
        raise InputError(
            "`gravity` must be positive where there is no `speed`: the body would never fall; "
            "got 0 m/s^2",
            key="impact.gravity",
        )


def _known_material(case: CaseTables, part: str) -> None:
    """Refuse the name of a material that neither the case nor the catalogue has."""
    known = [*case.materials, *catalogue.SOLIDS]
    name = getattr(case, part).material
    if name is not None:
        rule = "`material` must be a name of the catalogue or of a [materials.NAME] table"
        problems.among(name, known, rule, key=f"{part}.material")


def _elastic_somewhere(case: CaseTables) -> None:
    """Refuse a smooth body on a bulk that does not deform."""
    if case.roughness is None and case.counterface.deformation == "rigid":
        raise InputError(
            "`deformation` must be 'half-space' without a [roughness] table: a smooth rigid "
            "body has no elasticity at all; got 'rigid'",
            key="counterface.deformation",
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
