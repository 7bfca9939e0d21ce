"""The table [publication]: what the seed publication assumes, which no other case needs."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, Literal

from asperity.case.fields import Number, entry
from asperity.case.table import Table
from asperity.errors import InputError, refuse_all

if TYPE_CHECKING:
    from asperity.case.schema import Case


class Publication(Table):
    """Assumptions of the publication that are not physics; its case alone has this table."""

    pull_while_parting_only: bool = entry(
        "", "Whether adhesion and menisci pull only while the bodies part.", True, default=True
    )
    conjunction_ends: Annotated[float, Number("[0.1, 8]")] = entry(
        "1", "Separation over the rms height beyond which nothing acts.", 3.0, default=3.0
    )
    capillary_factor: Annotated[float, Number("(0, 1000]")] = entry(
        "1", "Factor on the force of the menisci.", 4.05, default=1.0
    )
    polynomials: Literal["exact", "printed"] = entry(
        "", "Height integrals: 'exact', or the polynomials 'printed' as eqs. 10 and 17.", "exact",
        default="exact",
    )  # fmt: skip
    bands: Annotated[int, Number("[1, 10000]", whole=True)] = entry(
        "1", "Number N_s of the bands of menisci, eq. 13.", 100, default=100
    )

    def refuse_beside(self, case: Case) -> None:
        """Refuse models that a [publication] table leaves no room for.

        Raises
        ------
        InputError
            With the table or key that must be absent.
        """
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
            ("capillary.formation", case.capillary.formation, ("contact",)),
            ("capillary.formation_time", case.capillary.formation_time, (None,)),
            ("capillary.film_thickness", case.capillary.film_thickness, (None,)),
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
