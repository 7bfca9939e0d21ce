"""The table [waves]: what the contact sends into the counterface."""

from __future__ import annotations

from typing import ClassVar, Literal

from asperity.config.adhesion_tables import Capillary
from asperity.config.base_table import Table
from asperity.config.fields import entry
from asperity.config.publication import Publication
from asperity.errors import InputError
from asperity.materials.solids import Solid
from asperity.units import shown


class Waves(Table):
    """Elastic waves into the counterface; without this table none take energy."""

    loss: ClassVar[str] = "waves"

    model: Literal["none", "hunter"] = entry(
        "", "Waves that the contact radiates: 'none', or 'hunter'.", "hunter"
    )

    def refuse_beside(
        self, counterface: Solid, capillary: Capillary, publication: Publication | None
    ) -> None:
        """Refuse what waves cannot be computed from, and the tables that they cannot stand beside.

        Raises
        ------
        InputError
            With the rule; nothing is refused with the model 'none'.
        """
        if self.model == "none":
            return
        if publication is not None:
            raise InputError(
                "[waves] must not be given with a [publication] table, which leaves waves out; got "
                f"model = '{self.model}'",
                key="waves.model",
            )
        if counterface.density is None:
            raise InputError(
                "`density` must be given for the counterface with [waves] model = "
                f"'{self.model}': it sets how fast the waves are and what they carry; got nothing",
                key="counterface.density",
            )
        time = capillary.formation_time
        if time and capillary.model != "none":
            raise InputError(
                "`formation_time` must be absent with [waves], whose loss is computed where the "
                f"force depends on the separation alone; got {shown(f'{time:.6g} s')}",
                key="capillary.formation_time",
            )
