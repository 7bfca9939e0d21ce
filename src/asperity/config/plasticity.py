"""The table [plasticity]: asperities that yield, and how hard what yields is."""

from __future__ import annotations

from typing import Any, ClassVar, Literal, Self

from pydantic import model_validator

from asperity.config import fields
from asperity.config.adhesion_tables import Adhesion, Capillary
from asperity.config.base_table import Table, acts
from asperity.config.bodies import solids_of
from asperity.config.fields import entry
from asperity.errors import InputError, check_each
from asperity.inputs import Yielding
from asperity.materials.solids import HARDNESS_PER_YIELD_STRENGTH, Solid, refuse_softer_than_yield

PRESSURE_PER_YIELD_STRENGTH = 1.61
"""Peak pressure of a Hertz contact that just yields, over the yield strength.

The largest shear stress, 0.31 of the peak pressure at a Poisson's ratio of 0.3, is then half the
yield strength (Tresca). Johnson, Contact Mechanics (1985), sections 4.2 and 6.1, has 1.60 for it.
"""

_BESIDE_CONTACT = ("dmt", "none")


class Plasticity(Table):
    """Asperities that yield; without this table every contact is elastic."""

    loss: ClassVar[str] = "plastic"
    excludes: ClassVar[dict[str, str]] = {
        "capillary.formation_time": "its menisci would need a memory of their own"
    }

    model: Literal["none", "kogut-etsion", "jackson-green", "thornton-ning"] = entry(
        "",
        "Law of a contact that yields: 'none', 'kogut-etsion', 'jackson-green' or 'thornton-ning'.",
        "kogut-etsion",
    )
    hardness: fields.Modulus | None = entry(
        "Pa", "Hardness, in place of the softer material's.", "1 GPa", default=None
    )
    yield_strength: fields.Modulus | None = entry(
        "Pa", "Yield strength, in place of the softer material's.", "350 MPa", default=None
    )
    yield_pressure: fields.Modulus | None = entry(
        "Pa",
        "With 'thornton-ning': pressure at which a contact yields; 1.61 times the yield strength.",
        "560 MPa",
        default=None,
    )

    @model_validator(mode="after")
    def _possible(self) -> Self:
        refuse_softer_than_yield(self.hardness, self.yield_strength)
        if self.yield_pressure is not None and self.model != "thornton-ning":
            raise InputError(
                "`yield_pressure` must be absent without model = 'thornton-ning', the one law that "
                f"takes it; got {self.yield_pressure / 1e6:.6g} MPa",
                key="yield_pressure",
            )
        return self

    def check_beside(self, case: Any) -> None:
        """Refuse what the law cannot stand beside, and solids that have no strength."""
        if self.model == "none":
            return
        check_each(lambda: self.refuse_models(case), lambda: yielding_of(self, solids_of(case)))

    def refuse_models(self, case: Any) -> None:
        """Refuse the models of a case that the law cannot stand beside.

        Raises
        ------
        InputError
            With the rule.
        """
        check_each(lambda: self._refuse_tables(case), lambda: self._refuse_bulk(case))

    def _refuse_tables(self, case: Any) -> None:
        """Refuse the tables that the law has no room for."""
        super().check_beside(case)
        self._refuse_adhesion(case.adhesion, smooth=case.roughness is None)
        self._refuse_liquid(case.capillary)
        if case.roughness is not None and case.roughness.source == "summits":
            raise InputError(
                "`source` must be 'gaussian' with [plasticity] model = "
                f"'{self.model}', since each summit would need a memory of its own; got 'summits'",
                key="roughness.source",
            )

    def _refuse_bulk(self, case: Any) -> None:
        """Refuse a bulk that deforms under asperities that yield."""
        deformation = case.counterface.deformation
        if case.roughness is not None and deformation != "rigid":
            raise InputError(
                "`deformation` must be 'rigid' where asperities yield: every place of a half-space "
                f"would keep an approach of its own; got '{deformation}'",
                key="counterface.deformation",
            )

    def _refuse_adhesion(self, adhesion: Adhesion, *, smooth: bool) -> None:
        """Refuse an adhesion that changes the contact itself, unless a law has it inside."""
        inside = ("jkr",) if smooth and self.model == "thornton-ning" else ()
        allowed = (*inside, *_BESIDE_CONTACT)
        if adhesion.model not in allowed:
            *first, last = map(repr, allowed)
            raise InputError(
                f"`model` must be {', '.join(first)} or {last} with [plasticity] model = "
                f"'{self.model}'{'' if smooth else ' on a rough body'}: a plastic law needs an "
                f"adhesion that acts beside contact; got '{adhesion.model}'",
                key="adhesion.model",
            )

    def _refuse_liquid(self, capillary: Capillary) -> None:
        """Refuse bridges that need a memory of their own beside that of the yielded contacts."""
        if capillary.model == "constant-volume":
            raise InputError(
                "`model` must be 'equilibrium', 'kelvin-filling' or 'none' with [plasticity] model "
                f"= '{self.model}'; got 'constant-volume'",
                key="capillary.model",
            )


def case_yielding(case: Any) -> Yielding | None:
    """What yields in a contact of a ``CaseTables``: the softer solid, with the table's own values.

    None where no solid's strength is known and no law of yielding is in use.
    """
    solids = solids_of(case)
    if acts(case.plasticity):
        return yielding_of(case.plasticity, solids)
    if not any(solid.hardness or solid.yield_strength for solid in solids):
        return None
    return yielding_of(Plasticity(model="none"), solids)


def yielding_of(table: Plasticity, solids: tuple[Solid, Solid]) -> Yielding:
    """What yields: the softer of two solids, with a table's values in place of its own.

    Softer is the solid of smaller hardness among those whose hardness or yield strength is known;
    where neither is, the one of smaller Young's modulus. One value in the table stands for both. Of
    hardness and yield strength the one that is missing follows from the other: H = 2.8 Y (Tabor,
    The Hardness of Metals, 1951).

    Parameters
    ----------
    table : Plasticity
        The table; its values come first, each for itself.
    solids : tuple of Solid
        The two solids in contact.

    Returns
    -------
    Yielding
        Its numbers, none missing.

    Raises
    ------
    InputError
        Where neither the table nor a solid has a strength.
    """
    known = [solid for solid in solids if _indentation(solid) is not None]
    softer = min(known or solids, key=lambda solid: _indentation(solid) or solid.youngs_modulus)
    own = (softer.hardness, softer.yield_strength)
    # One value in the table stands for both: what it leaves out does not come from the solid.
    given = (table.hardness, table.yield_strength)
    hardness, strength = own if given == (None, None) else given
    if strength is None:
        strength = _strength(table, hardness)
    return Yielding(
        hardness=hardness or HARDNESS_PER_YIELD_STRENGTH * strength,
        yield_strength=strength,
        yield_pressure=table.yield_pressure or PRESSURE_PER_YIELD_STRENGTH * strength,
        poisson=softer.poisson,
    )


def _strength(table: Plasticity, hardness: float | None) -> float:
    """Yield strength [Pa] from a hardness, or else from a yield pressure."""
    if hardness is not None:
        return hardness / HARDNESS_PER_YIELD_STRENGTH
    if table.yield_pressure is not None:
        return table.yield_pressure / PRESSURE_PER_YIELD_STRENGTH
    raise InputError(
        f"`hardness` or `yield_strength` must be given with model = '{table.model}', here or for a "
        "material, since neither material has one; got nothing",
        key="plasticity.hardness",
    )


def _indentation(solid: Solid) -> float | None:
    """Hardness of a solid [Pa], by Tabor where only its yield strength is known."""
    if solid.hardness is not None or solid.yield_strength is None:
        return solid.hardness
    return HARDNESS_PER_YIELD_STRENGTH * solid.yield_strength
