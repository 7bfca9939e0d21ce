"""The table [waves]: what the contact sends into the counterface."""

from __future__ import annotations

from typing import Any, ClassVar, Literal

from asperity.config.base_table import Table, acts
from asperity.config.bodies import solids_of
from asperity.config.fields import entry
from asperity.errors import InputError


class Waves(Table):
    """Elastic waves into the counterface; without this table none take energy."""

    loss: ClassVar[str] = "waves"
    excludes: ClassVar[dict[str, str]] = {
        "capillary.formation_time": "their loss is computed where the force depends on the "
        "separation alone"
    }

    model: Literal["none", "hunter"] = entry(
        "", "Waves that the contact radiates: 'none', or 'hunter'.", "hunter"
    )

    def check_beside(self, case: Any) -> None:
        super().check_beside(case)
        if acts(self) and solids_of(case)[1].density is None:
            raise InputError(
                "`density` must be given for the counterface with [waves] model = "
                f"'{self.model}': it sets how fast the waves are and what they carry; got nothing",
                key="counterface.density",
            )
