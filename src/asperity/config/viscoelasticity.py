"""The table [viscoelasticity]: a bulk that creeps."""

from __future__ import annotations

from typing import Annotated, Any, ClassVar, Literal, Self

from pydantic import model_validator

from asperity.config import fields
from asperity.config.base_table import Table, acts, need
from asperity.config.fields import Number, entry
from asperity.errors import InputError


class Viscoelasticity(Table):
    """A bulk that creeps under the contact; without this table it is elastic."""

    loss: ClassVar[str] = "viscous"
    excludes: ClassVar[dict[str, str]] = {
        "suspension": "its motion in time knows no spring",
        "gas": "its motion in time knows no drag",
        "waves": "its motion in time knows no drag",
        "plasticity": "the two are not solved together",
        "capillary.formation_time": "its menisci form at once",
    }

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

    def check_beside(self, case: Any) -> None:
        super().check_beside(case)
        if not acts(self):
            return
        with_it = f"with [viscoelasticity] model = '{self.model}'"
        if case.counterface.deformation == "rigid":
            raise InputError(
                f"`deformation` must be 'half-space' {with_it}: a rigid bulk has nothing that "
                "creeps; got 'rigid'",
                key="counterface.deformation",
            )
        if case.roughness is None:
            _refuse_pulls(case, with_it)


def _refuse_pulls(case: Any, with_it: str) -> None:
    """Refuse adhesion and menisci of a smooth body."""
    for key, model in (("adhesion", case.adhesion.model), ("capillary", case.capillary.model)):
        if model != "none":
            raise InputError(
                f"`model` must be 'none' for a smooth body {with_it}: how its edge heals and "
                f"peels is not described; got '{model}'",
                key=f"{key}.model",
            )
