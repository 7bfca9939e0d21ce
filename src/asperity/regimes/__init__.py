"""Which model holds: dimensionless numbers, the choice of law, the adhesion map, every warning.

`dimensionless_numbers`: Tabor number, plasticity index and the like. `choice`: the adhesion law
for a Tabor number. `boundaries`: the adhesion map of Johnson and Greenwood. `verdicts`: what a
number says, in words. `loaded_asperities`: how many carry the load, effectively.
`error_of_mean`: by how much single bodies lose more than the mean, and how their losses scatter.
`liquid_regime`: dry, pendular, coalesced, flooded.
`validity` collects the warnings of `accuracy`, `ambient`, `few_asperities`, `model_domain`,
`plastic_validity` and `wave_limits`: each threshold is a constant beside the warning that uses it.
"""

from .boundaries import Boundary, Frame, Place, adhesion_map, hertz_load, region, regions
from .choice import BORDER_FACTOR, DMT_BELOW, JKR_ABOVE, LAW_NAMES, choose_adhesion
from .dimensionless_numbers import (
    ELASTICITY_PER_TABOR,
    Regime,
    load_parameter,
    plasticity_index,
    tabor_number,
)
from .loaded_asperities import clustering, loaded_asperities
from .verdicts import CARRIED, Verdict, verdicts

__all__ = [
    "BORDER_FACTOR",
    "CARRIED",
    "DMT_BELOW",
    "ELASTICITY_PER_TABOR",
    "JKR_ABOVE",
    "LAW_NAMES",
    "Boundary",
    "Frame",
    "Place",
    "Regime",
    "Verdict",
    "adhesion_map",
    "choose_adhesion",
    "clustering",
    "hertz_load",
    "load_parameter",
    "loaded_asperities",
    "plasticity_index",
    "region",
    "regions",
    "tabor_number",
    "verdicts",
]
