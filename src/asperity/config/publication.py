"""The table [publication]: what the seed publication assumes, which no other case needs."""

from __future__ import annotations

import functools
from typing import Annotated, Any, ClassVar, Literal

from asperity.config.base_table import Table
from asperity.config.fields import Number, entry
from asperity.errors import InputError, check_each, refuse_all


class Publication(Table):
    """Assumptions of the publication that are not physics; its case alone has this table."""

    excludes: ClassVar[dict[str, str]] = {
        "roughness.files": "it knows Gaussian heights and one radius alone",
        "capillary.formation_time": "it replaces the other models",
        "capillary.adsorbed_film_thickness": "it replaces the other models",
        "plasticity": "its asperities are elastic",
        "gas": "it leaves the gas out",
        "waves": "it leaves waves out",
        "viscoelasticity": "it has no bulk that creeps",
        "suspension": "its body is free",
    }

    attraction_during_retraction_only: bool = entry(
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

    def check_beside(self, case: Any) -> None:
        if case.roughness is None:
            raise InputError(
                "a [roughness] table must be given with [publication]; got none", key="publication"
            )
        check_each(
            functools.partial(super().check_beside, case), functools.partial(self._alone, case)
        )

    def _alone(self, case: Any) -> None:
        """Refuse models that it replaces."""
        wanted = (
            ("counterface.deformation", case.counterface.deformation, ("rigid",)),
            ("adhesion.model", case.adhesion.model, ("dmt", "none")),
            ("capillary.model", case.capillary.model, ("equilibrium", "none")),
            ("capillary.formation", case.capillary.formation, ("on-contact",)),
        )
        refuse_all(
            InputError(
                f"`{key.split('.')[1]}` must be {' or '.join(map(repr, allowed))} with a "
                f"[publication] table, which replaces the other models; got {value!r}",
                key=key,
            )
            for key, value, allowed in wanted
            if value not in allowed
        )
