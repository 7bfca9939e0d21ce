"""Which model holds: dimensionless numbers, the choice of the law, the adhesion map, verdicts."""

from .boundaries import Boundary, Frame, Place, adhesion_map, hertz_load, region, regions
from .choice import (
    BORDER_FACTOR,
    DMT_BELOW,
    JKR_ABOVE,
    LAW_NAMES,
    choose_adhesion,
)
from .parameters import (
    ELASTICITY_PER_TABOR,
    Regime,
    load_parameter,
    plasticity_index,
    tabor_number,
)
from .verdicts import FEW, Situation, Verdict, missed, verdicts

__all__ = [
    "BORDER_FACTOR",
    "DMT_BELOW",
    "ELASTICITY_PER_TABOR",
    "FEW",
    "JKR_ABOVE",
    "LAW_NAMES",
    "Boundary",
    "Frame",
    "Place",
    "Regime",
    "Situation",
    "Verdict",
    "adhesion_map",
    "choose_adhesion",
    "hertz_load",
    "load_parameter",
    "missed",
    "plasticity_index",
    "region",
    "regions",
    "tabor_number",
    "verdicts",
]
