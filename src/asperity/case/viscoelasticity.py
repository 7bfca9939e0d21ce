"""The table [viscoelasticity]: a bulk that creeps."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, Literal, Self

from pydantic import model_validator

from asperity.case import fields
from asperity.case.fields import Number, entry
from asperity.case.table import Table, need
from asperity.errors import InputError

if TYPE_CHECKING:
    from asperity.case.schema import Case


class Viscoelasticity(Table):
    """A bulk that creeps under the contact; without this table it is elastic."""

    model: Literal["none", "standard-linear-solid"] = entry(
        "",
        "How the bulk relaxes: 'none', or 'standard-linear-solid'.",
        "standard-linear-solid",
    )
    relaxed_modulus_ratio: Annotated[float, Number("[0.001, 1]")] | None = entry(
        "1",
        "Modulus after a long time over that of a sudden load, in [0.001, 1].",
        0.5,
        default=None,
        shown=True,
    )
    relaxation_time: fields.Time | None = entry(
        "s",
        "Time in which the stress at a constant strain relaxes.",
        "1 us",
        default=None,
        shown=True,
    )

    @model_validator(mode="after")
    def _complete(self) -> Self:
        if self.model == "none":
            return self
        return need(self, ("relaxed_modulus_ratio", "relaxation_time"))

    def refuse_beside(self, case: Case) -> None:
        """Refuse the tables of a case that a creeping bulk cannot stand beside.

        Raises
        ------
        InputError
            With the rule; nothing is refused with the model 'none'.
        """
        if self.model == "none":
            return
        with_it = f"with [viscoelasticity] model = '{self.model}'"
        self._refuse_tables(case, with_it)
        if case.counterface.deformation == "rigid":
            raise InputError(
                f"`deformation` must be 'half-space' {with_it}: a rigid bulk has nothing that "
                "creeps; got 'rigid'",
                key="counterface.deformation",
            )
        if case.capillary.model != "none" and case.capillary.formation_time:
            raise InputError(
                f"`formation_time` must be absent {with_it}; got "
                f"{case.capillary.formation_time:.6g} s",
                key="capillary.formation_time",
            )
        if case.roughness is None:
            self._refuse_pulls(case, with_it)

    @staticmethod
    def _refuse_tables(case: Case, with_it: str) -> None:
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
        if case.plasticity_model != "none":
            raise InputError(
                f"`model` must be 'none' in [plasticity] {with_it}; got '{case.plasticity_model}'",
                key="plasticity.model",
            )

    @staticmethod
    def _refuse_pulls(case: Case, with_it: str) -> None:
        """Refuse adhesion and menisci of a smooth body."""
        for key, model in (("adhesion", case.adhesion.model), ("capillary", case.capillary.model)):
            if model != "none":
                raise InputError(
                    f"`model` must be 'none' for a smooth body {with_it}: how its edge heals and "
                    f"peels is not described; got '{model}'",
                    key=f"{key}.model",
                )
