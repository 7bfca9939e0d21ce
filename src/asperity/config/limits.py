"""Where the models end: cases that none of them can describe."""

from __future__ import annotations

from asperity.config.bodies import named
from asperity.config.tables import CaseTables
from asperity.errors import InputError
from asperity.materials.solids import Solid

SMALLEST_BODY = 1e-9
"""Smallest radius of a body [m]: such a one has some 200 atoms, and is no continuum."""


def refuse_outside(case: CaseTables) -> None:
    """Refuse a case that lies outside every model of contact.

    Parameters
    ----------
    case
        The case. Measured surfaces are not looked at here, since that reads their files.

    Raises
    ------
    InputError
        With the rule and its number.
    """
    radius = case.body.radius
    if radius < SMALLEST_BODY:
        raise InputError(
            f"`radius` must be at least {SMALLEST_BODY * 1e9:g} nm: a body of fewer than some 200 "
            f"atoms is no continuum; got {radius * 1e9:.6g} nm",
            key="body.radius",
        )
    if case.roughness is not None and case.roughness.files is None:
        _ = case.asperities  # which refuses those larger than the body
    _refuse_waves(case)


def wave_speed(case: CaseTables) -> tuple[float, Solid]:
    """Smaller speed [m/s] of waves in bars of the two solids, sqrt(E/rho), and whose it is.

    Parameters
    ----------
    case
        The case; a counterface without a density does not count.
    """
    known = [
        ((solid.youngs_modulus / solid.density) ** 0.5, solid)
        for solid in (case.body_solid, case.counterface_solid)
        if solid.density is not None
    ]
    return min(known, key=lambda each: each[0])


def _refuse_waves(case: CaseTables) -> None:
    """Refuse impacts as fast as waves in the softer solid."""
    impact, (slowest, solid) = case.impact, wave_speed(case)
    if impact is None:
        return
    fall = 2.0 * impact.gravity * (impact.release_separation or 0.0)
    speed = ((impact.speed or 0.0) ** 2 + fall) ** 0.5
    if speed < slowest:
        return
    raise InputError(
        f"`speed` at impact must be smaller than that of waves in a bar of {named(solid)}, "
        f"{slowest:.4g} m/s, since contact is taken to be quasi-static; got {speed:.4g} m/s",
        key="impact.speed" if impact.speed else "impact.release_separation",
    )
