"""What each number of a case says, in words."""

from __future__ import annotations

from math import isinf
from typing import NamedTuple

from ..inputs import Inputs
from .boundaries import hertz_load, region
from .choice import DMT_BELOW, JKR_ABOVE
from .dimensionless_numbers import Regime
from .loaded_asperities import LOADED_FOR_A_MEAN

ELASTIC_BELOW = 0.6
"""Plasticity index below which asperities stay elastic at ordinary loads (Greenwood and
Williamson 1966); above 1 they yield."""

NARROW_BELOW = 0.1
"""Kelvin radius over the tip's radius below which a meniscus is narrow beside its tip."""


class Verdict(NamedTuple):
    """A number and what it says.

    Attributes
    ----------
    value
        The number, or a word; None where it does not apply.
    unit
        Its SI unit; "1" for a plain number, "" for a word.
    verdict
        What it says; of a value that is None, why.
    """

    value: float | str | None
    unit: str
    verdict: str


CARRIED = "a single body falls until a summit carries it"
"""What is not said by a mean of which fewer than one asperity is expected to touch."""


def verdicts(inputs: Inputs, regime: Regime, contacting: float) -> dict[str, Verdict]:
    """A verdict on each number, by the number's name.

    Parameters
    ----------
    inputs
        The quantities of a case.
    regime
        Its dimensionless numbers.
    contacting
        Expected number of contacting asperities at closest approach of the first impact.
    """
    reason = regime.adhesion_reason
    return {
        "tabor_number": _tabor(regime),
        "elasticity_parameter": _elasticity(regime),
        "load_parameter": _load(regime, contacting),
        "adhesion_law": Verdict(
            regime.adhesion_law, "", f"chosen: {reason}" if reason else "as the case says"
        ),
        "plasticity_index": _plasticity(inputs, regime.plasticity_index),
        "contacting_asperities": _touching(inputs, contacting),
        "loaded_asperities": _loaded(regime.loaded_asperities),
        "kelvin_radius": _kelvin(inputs),
        "kelvin_radius_over_spacing": _over_spacing(inputs),
        "kelvin_radius_over_tip_radius": _over_tip(inputs),
        "liquid_regime": Verdict(regime.liquid_regime, "", regime.liquid_regime_reason),
    }


def _missing(regime: Regime) -> str:
    """Why there is no Tabor number."""
    if regime.adhesion_law == "none":
        return "the case has no adhesion"
    return "`adhesion.equilibrium_spacing` is not given"


def _tabor(regime: Regime) -> Verdict:
    value = regime.tabor_number
    if value is None:
        return Verdict(None, "1", _missing(regime))
    if value < DMT_BELOW:
        said = f"below {DMT_BELOW:g}: adhesion does not bend the contact (Bradley, DMT)"
    elif value <= JKR_ABOVE:
        said = f"between {DMT_BELOW:g} and {JKR_ABOVE:g}: neither DMT nor JKR (Maugis-Dugdale)"
    else:
        said = f"above {JKR_ABOVE:g}: adhesion bends the contact over far more than its range (JKR)"
    return Verdict(value, "1", said)


def _elasticity(regime: Regime) -> Verdict:
    value, load = regime.elasticity_parameter, regime.load_parameter
    if value is None:
        return Verdict(None, "1", _missing(regime))
    if load is None or load <= 0.0:
        return Verdict(value, "1", "no load, so no place on the adhesion map")
    return Verdict(value, "1", f"the adhesion map's region at this load: {region(value, load)}")


def _load(regime: Regime, contacting: float) -> Verdict:
    value, elasticity = regime.load_parameter, regime.elasticity_parameter
    if value is None:
        touches = contacting > 0.0
        why = "the case has no adhesion" if touches else "nothing touches at closest approach"
        return Verdict(None, "1", why)
    # Without a range the limit is known only to lie between those of rigid and of soft bodies.
    low = hertz_load(1e-4 if elasticity is None else elasticity)
    high = hertz_load(1e4) if elasticity is None else low
    if value > high:
        said = f"above {high:.3g}: adhesion is negligible beside contact at closest approach"
    elif value < low:
        said = f"below {low:.3g}: adhesion counts beside contact at closest approach"
    else:
        said = f"adhesion is negligible above a limit between {low:.3g} and {high:.3g}, which "
        said += "`adhesion.equilibrium_spacing` decides"
    return Verdict(value, "1", said)


def _plasticity(inputs: Inputs, value: float | None) -> Verdict:
    if value is None:
        unknown = "neither material has a hardness or yield strength"
        return Verdict(None, "1", unknown if inputs.asperities else "the body is smooth")
    if value < ELASTIC_BELOW:
        said = f"below {ELASTIC_BELOW:g}: asperities stay elastic"
    elif value <= 1.0:
        said = f"between {ELASTIC_BELOW:g} and 1: some asperities yield under load"
    else:
        said = "above 1: asperities yield, "
        said += "as they do here" if inputs.yields else "and the models keep them elastic"
    return Verdict(value, "1", said)


def _touching(inputs: Inputs, value: float) -> Verdict:
    if inputs.asperities is None:
        return Verdict(None, "1", "the body is smooth: it is its own one asperity")
    if value < 1.0:
        return Verdict(value, "1", f"below 1: {CARRIED}; only means over many are told")
    return Verdict(value, "1", "expected at closest approach, in the mean")


def _loaded(value: float | None) -> Verdict:
    if value is None:
        return Verdict(None, "1", "the body is smooth: it is its own one asperity")
    if value < LOADED_FOR_A_MEAN:
        return Verdict(value, "1", f"below {LOADED_FOR_A_MEAN:g}: single bodies differ from a mean")
    said = f"{LOADED_FOR_A_MEAN:g} or more: a mean stands for single bodies, but not near capture"
    return Verdict(value, "1", said)


def _kelvin(inputs: Inputs) -> Verdict:
    value = inputs.liquid_radius
    if value == 0.0 or inputs.liquid is None:
        return Verdict(None, "m", "no menisci: dry")
    if isinf(value):
        return Verdict(None, "m", "infinite: the vapour is saturated")
    molecule = inputs.liquid.molecule_size
    said = f"{value / molecule:.2g} molecules of {molecule * 1e9:.2g} nm"
    if value < molecule:
        said = f"less than a molecule ({molecule * 1e9:.2g} nm): no continuum"
    if value < inputs.kelvin_radius:
        said += "; bounded by the adsorbed film, below Kelvin's"
    return Verdict(value, "m", said)


def _over_spacing(inputs: Inputs) -> Verdict:
    value, rough = inputs.liquid_radius, inputs.asperities
    if value == 0.0 or isinf(value):
        return Verdict(None, "1", _kelvin(inputs).verdict)
    if rough is None:
        return Verdict(None, "1", "the body is smooth: its one meniscus has no neighbour")
    said = f"of {rough.spacing * 1e9:.3g} nm between asperities: menisci "
    said += "stay apart" if value < rough.spacing else "merge"
    return Verdict(value / rough.spacing, "1", said)


def _over_tip(inputs: Inputs) -> Verdict:
    value = inputs.liquid_radius
    if value == 0.0 or isinf(value):
        return Verdict(None, "1", _kelvin(inputs).verdict)
    if inputs.structure.liquid == "kelvin-filling" and inputs.asperities is not None:
        return Verdict(None, "1", "the liquid fills the surface, whatever its tips")
    ratio = value / inputs.tip_radius
    if ratio < NARROW_BELOW:
        said = f"below {NARROW_BELOW:g}: menisci are narrow beside their tips, as their law assumes"
    elif ratio < 1.0:
        said = "menisci are about as wide as their tips: their law is rough"
    else:
        said = "above 1: menisci are wider than their tips, against what their law assumes"
    return Verdict(ratio, "1", said)
