"""How much liquid lies between two bodies: dry, pendular, coalesced, flooded."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from scipy.special import ndtr

FULL = 0.99
"""Share of the places at the axis that liquid bridges where the gap counts as full."""


class LiquidState(NamedTuple):
    """The state of the liquid, and why.

    Attributes
    ----------
    regime
        "dry", "pendular", "coalesced" or "flooded".
    reason
        The number and the rule that say so.
    """

    regime: str
    reason: str


def liquid_state(
    *,
    radius: float,
    span: float,
    tip_radius: float,
    spacing: float | None,
    central: float,
    rms_height: float,
) -> LiquidState:
    """State of the liquid at closest approach.

    Parameters
    ----------
    radius
        Radius of curvature of the liquid [m]: the Kelvin radius, or less where a film bounds it;
        0 without liquid.
    span
        Largest gap that the liquid bridges [m].
    tip_radius
        Radius of one asperity, or of the smooth body [m].
    spacing
        Mean distance of asperities, density^(-1/2) [m]; None for a smooth body.
    central
        Separation of the mean planes at the axis at closest approach [m].
    rms_height
        Rms of the heights that the liquid meets [m]; 0 for a smooth body.

    Notes
    -----
    Menisci on neighbouring asperities merge when their radius of curvature reaches the spacing.
    The gap is full when liquid bridges 99 % of the places at the axis, for Gaussian heights; a
    smooth sphere is flooded when the liquid's edge, at sqrt(2 R span) from the axis, comes to its
    equator.
    """
    if radius == 0.0:
        return LiquidState("dry", "there is no liquid")
    if spacing is None:
        if span >= 0.5 * tip_radius:
            return LiquidState("flooded", "the liquid's edge reaches the equator of the body")
        return LiquidState("pendular", "a smooth body has one meniscus")
    bridged = float(ndtr((span - central) / rms_height)) if np.isfinite(span) else 1.0
    if bridged >= FULL:
        return LiquidState(
            "flooded",
            f"liquid bridges {100.0 * bridged:.4g} % of the places at the axis at closest "
            f"approach, {100.0 * FULL:g} % or more",
        )
    if radius >= spacing:
        return LiquidState(
            "coalesced",
            f"the liquid's radius of curvature, {radius * 1e9:.3g} nm, reaches the asperity "
            f"spacing of {spacing * 1e9:.3g} nm",
        )
    return LiquidState(
        "pendular",
        f"the liquid's radius of curvature, {radius * 1e9:.3g} nm, is below the asperity spacing "
        f"of {spacing * 1e9:.3g} nm",
    )
