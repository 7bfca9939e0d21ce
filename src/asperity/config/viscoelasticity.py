"""The table [viscoelasticity]: a bulk that creeps."""

from __future__ import annotations

from typing import Annotated, ClassVar, Literal, Self

from pydantic import model_validator

from asperity.config import fields
from asperity.config.base_table import Table, need
from asperity.config.fields import Number, entry


class Viscoelasticity(Table):
    """A bulk that creeps under the contact; without this table it is elastic."""

    loss: ClassVar[str] = "viscous"

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
