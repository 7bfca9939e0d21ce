"""What the two bodies of a case are made of, and which of them yields."""

from __future__ import annotations

from typing import TYPE_CHECKING

from asperity.config.plasticity import Plasticity, yielding_of
from asperity.inputs import Yielding
from asperity.materials.solids import Solid

if TYPE_CHECKING:
    from asperity.config.tables import CaseTables


def solids_of(case: CaseTables) -> tuple[Solid, Solid]:
    """The solids of the body and of the counterface, by their own numbers or the catalogue."""
    own = case.materials
    return case.body.solid(own, "body"), case.counterface.solid(own, "counterface")


def case_yielding(table: Plasticity | None, solids: tuple[Solid, Solid]) -> Yielding | None:
    """What yields in a contact: the softer solid, with the [plasticity] table's own values.

    None where no solid's strength is known and no law of yielding is in use.

    Raises
    ------
    InputError
        Where a law is in use and neither the table nor a solid has a strength.
    """
    if table is None or table.model == "none":
        if not any(solid.hardness or solid.yield_strength for solid in solids):
            return None
        table = Plasticity(model="none")
    return yielding_of(table, solids)
