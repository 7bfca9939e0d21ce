"""Where the models end: cases that none of them can describe."""

from __future__ import annotations

from asperity.config.asperities import asperities_of, refuse_asperities
from asperity.config.case_solids import solids_of
from asperity.config.tables import CaseTables
from asperity.errors import InputError
from asperity.materials.solids import bar_wave_speed, named

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
        refuse_asperities(radius, asperities_of(case.roughness))
    _refuse_waves(case)


def _refuse_waves(case: CaseTables) -> None:
    """Refuse impacts as fast as waves in the softer solid."""
    impact, (slowest, solid) = case.impact, bar_wave_speed(solids_of(case))
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
