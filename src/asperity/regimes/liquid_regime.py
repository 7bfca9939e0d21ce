"""How much liquid lies between two bodies: dry, pendular, coalesced, flooded."""

from __future__ import annotations

import numpy as np
from scipy.special import ndtr

from ..inputs import Inputs

FULL = 0.99
"""Share of the places at the axis that liquid bridges where the gap counts as full."""


def liquid_state(inputs: Inputs, central: float) -> tuple[str, str]:
    """State of the liquid at closest approach, and the number and the rule that say so.

    Parameters
    ----------
    inputs
        The quantities of a case.
    central
        Separation of the mean planes at the axis at closest approach [m].

    Returns
    -------
    tuple
        "dry", "pendular", "coalesced" or "flooded", and why.

    Notes
    -----
    Menisci on neighbouring asperities merge when their radius of curvature (the Kelvin radius, or
    less where a film bounds it) reaches the spacing. The gap is full when liquid bridges 99 % of
    the places at the axis, for Gaussian heights; a smooth sphere is flooded when the liquid's edge,
    at sqrt(2 R span) from the axis, comes to its equator.
    """
    radius, span, rough = inputs.liquid_radius, inputs.liquid_span, inputs.asperities
    if radius == 0.0:
        return "dry", "there is no liquid"
    if rough is None:
        if span >= 0.5 * inputs.tip_radius:
            return "flooded", "the liquid's edge reaches the equator of the body"
        return "pendular", "a smooth body has one meniscus"
    rms = inputs.surface_rms_height
    bridged = float(ndtr((span - central) / rms)) if np.isfinite(span) else 1.0
    if bridged >= FULL:
        return (
            "flooded",
            f"liquid bridges {100.0 * bridged:.4g} % of the places at the axis at closest "
            f"approach, {100.0 * FULL:g} % or more",
        )
    what = f"the liquid's radius of curvature, {radius * 1e9:.3g} nm,"
    spacing = f"the asperity spacing of {rough.spacing * 1e9:.3g} nm"
    if radius >= rough.spacing:
        return "coalesced", f"{what} reaches {spacing}"
    return "pendular", f"{what} is below {spacing}"
