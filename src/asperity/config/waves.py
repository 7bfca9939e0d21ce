"""The table [waves]: what the contact sends into the counterface."""

from __future__ import annotations

from typing import Any, ClassVar, Literal

from asperity.config.base_table import Table
from asperity.config.bodies import solids_of
from asperity.config.fields import entry
from asperity.errors import InputError
from asperity.units import shown


class Waves(Table):
    """Elastic waves into the counterface; without this table none take energy."""

    loss: ClassVar[str] = "waves"

    model: Literal["none", "hunter"] = entry(
        "", "Waves that the contact radiates: 'none', or 'hunter'.", "hunter"
    )

    def check_beside(self, case: Any) -> None:
        if self.model == "none":
            return
        if case.publication is not None:
            raise InputError(
                "[waves] must not be given with a [publication] table, which leaves waves out; got "
                f"model = '{self.model}'",
                key="waves.model",
            )
        if solids_of(case)[1].density is None:
            raise InputError(
                "`density` must be given for the counterface with [waves] model = "
                f"'{self.model}': it sets how fast the waves are and what they carry; got nothing",
                key="counterface.density",
            )
        time = case.capillary.formation_time
        if time and case.capillary.model != "none":
            raise InputError(
                "`formation_time` must be absent with [waves], whose loss is computed where the "
                f"force depends on the separation alone; got {shown(f'{time:.6g} s')}",
                key="capillary.formation_time",
            )
