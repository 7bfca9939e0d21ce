"""Where the models end: cases that none of them can describe."""

from __future__ import annotations

from typing import TYPE_CHECKING

from asperity.case.bodies import named
from asperity.errors import InputError

if TYPE_CHECKING:
    from asperity.case.asperities import Asperities
    from asperity.case.schema import Case
    from asperity.materials import Solid

SMALLEST_BODY = 1e-9
"""Smallest radius of a body [m]: such a one has some 200 atoms, and is no continuum."""

LARGEST_ASPERITY = 1.0
"""Asperity radius over body radius: what is larger than the body is no bump on it."""

ROUGHEST = 0.5
"""Rms height over body radius: 1 in 44 asperities is then as high as the body's radius."""


def refuse_outside(case: Case) -> None:
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


def refuse_asperities(radius: float, rough: Asperities) -> None:
    """Refuse asperities larger than the body, or nearly as high.

    Parameters
    ----------
    radius
        Radius of the body [m].
    rough
        Its asperities.

    Raises
    ------
    InputError
        With the rule and its number.
    """
    tip, height = rough.asperity_radius, rough.rms_height
    measured = rough.facts is not None
    if tip > LARGEST_ASPERITY * radius:
        raise InputError(
            f"`asperity_radius` must be at most the body's radius ({radius * 1e6:.6g} um): an "
            f"asperity larger than the body is not a bump on it; got {tip * 1e6:.6g} um",
            key="roughness.files" if measured else "roughness.asperity_radius",
        )
    if height >= ROUGHEST * radius:
        raise InputError(
            f"`rms_height` must be smaller than {ROUGHEST:g} of the body's radius "
            f"({radius * 1e6:.6g} um): 1 in 44 asperities would be as high as that radius; got "
            f"{height * 1e6:.6g} um",
            key="roughness.files" if measured else "roughness.rms_height",
        )


def wave_speed(case: Case) -> tuple[float, Solid]:
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


def _refuse_waves(case: Case) -> None:
    """Refuse impacts as fast as waves in the softer solid."""
    impact, (slowest, solid) = case.impact, wave_speed(case)
    if impact is None:
        return
    fall = 2.0 * impact.gravity * (impact.release_gap or 0.0)
    speed = ((impact.speed or 0.0) ** 2 + fall) ** 0.5
    if speed < slowest:
        return
    raise InputError(
        f"`speed` at impact must be smaller than that of waves in a bar of {named(solid)}, "
        f"{slowest:.4g} m/s, since contact is taken to be quasi-static; got {speed:.4g} m/s",
        key="impact.speed" if impact.speed else "impact.release_gap",
    )
