"""The table [publication]: what the seed publication assumes, which no other case needs."""

from __future__ import annotations

from typing import Annotated, Literal

from asperity.config.base_table import Table
from asperity.config.fields import Number, entry


class Publication(Table):
    """Assumptions of the publication that are not physics; its case alone has this table."""

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
