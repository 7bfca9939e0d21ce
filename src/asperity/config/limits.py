"""Where the models end: cases that none of them can describe."""

from __future__ import annotations

from math import pi

from asperity.config.asperities import asperities_of, refuse_asperities
from asperity.config.bodies import solids_of
from asperity.config.tables import CaseTables
from asperity.errors import InputError
from asperity.inputs import Asperities
from asperity.materials.solids import bar_wave_speed, contact_modulus, named

ONE_CONTACT = 1.0
"""Contacts of asperities at zero load, over the area, from which they count as one."""

_DEFORMED = ("jkr", "maugis", "auto")  # laws in which adhesion deforms the contact

LENNARD_JONES = (0.01, 5.0)
"""Tabor numbers between which the equilibria under the Lennard-Jones pressure are tabulated."""

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
    if case.roughness is None:
        _refuse_tabor_numbers(case, (radius,))
    elif case.roughness.files is None:
        refuse_rough(case, asperities_of(case.roughness))
    _refuse_waves(case)


def refuse_rough(case: CaseTables, rough: Asperities) -> None:
    """Refuse asperities that are no bumps on the body, or that adhesion makes one contact.

    On a half-space the latter have no equilibrium short of full contact, since its surface follows
    theirs. At zero load one asperity has a contact of the radius of Derjaguin, Muller and Toporov,
    (3 pi w R^2/(2 E*))^(1/3); that of Johnson, Kendall and Roberts is 3^(1/3) times as large, which
    holds in their law, and in others for Tabor numbers above 5.

    Parameters
    ----------
    case
        The case.
    rough
        Its asperities.

    Raises
    ------
    InputError
        With the rule and its number.
    """
    refuse_asperities(case.body.radius, rough)
    tips: tuple[float, ...] = (rough.asperity_radius,)
    if rough.summits is not None:
        tips = float(rough.summits.radii.min()), float(rough.summits.radii.max())
    _refuse_tabor_numbers(case, tips)
    if case.adhesion.model == "lennard-jones" and case.counterface.deformation != "rigid":
        raise InputError(
            "`deformation` must be 'rigid' where asperities adhere by 'lennard-jones', whose means "
            "over all heights would take minutes on every ring of a half-space: take 'rigid', or "
            f"`model` = 'maugis'; got '{case.counterface.deformation}'",
            key="counterface.deformation",
        )
    adhesion = case.adhesion
    if adhesion.model == "none" or case.counterface.deformation == "rigid":
        return
    assert adhesion.work is not None
    tip, modulus = rough.asperity_radius, contact_modulus(*solids_of(case))
    cube = 1.5 * pi * adhesion.work * tip**2 / modulus
    if adhesion.model in _DEFORMED and _is_soft(case, tip):
        cube *= 3.0
    contact = cube ** (1.0 / 3.0)
    share = pi * contact**2 * rough.asperity_density
    if share >= ONE_CONTACT:
        raise InputError(
            "`work` must leave the asperities on a half-space apart: adhesion alone presses each "
            f"to a contact of radius {contact * 1e9:.3g} nm, all to {share:.3g} times the whole "
            f"area (the limit is {ONE_CONTACT:g}), and they touch as one smooth surface does, a "
            f"case without [roughness]; got {adhesion.work * 1e3:.6g} mJ/m^2",
            key="adhesion.work",
        )


def _is_soft(case: CaseTables, tip: float) -> bool:
    """Whether a tip of this radius [m] adheres as in Johnson, Kendall and Roberts' law."""
    from asperity.regimes.choice import JKR_ABOVE  # imports numpy

    return case.adhesion.model == "jkr" or _tabor_number(case, tip) > JKR_ABOVE


def _tabor_number(case: CaseTables, radius: float) -> float:
    """Tabor number of a tip of this radius [m], where a case gives an equilibrium spacing."""
    from asperity.regimes.dimensionless_numbers import tabor_number  # imports numpy

    work, spacing = case.adhesion.work, case.adhesion.equilibrium_spacing
    assert work is not None
    assert spacing is not None
    return tabor_number(radius, work, contact_modulus(*solids_of(case)), spacing)


def _refuse_tabor_numbers(case: CaseTables, radii: tuple[float, ...]) -> None:
    """Refuse tips of such radii [m] whose equilibria are not tabulated."""
    adhesion = case.adhesion
    if adhesion.model != "lennard-jones":
        return
    least, most = LENNARD_JONES
    for radius in radii:
        tabor = _tabor_number(case, radius)
        if not least <= tabor <= most:
            other = "'bradley' or 'dmt'" if tabor < least else "'maugis' or 'jkr'"
            raise InputError(
                f"`model` = 'lennard-jones' is for Tabor numbers from {least:g} to {most:g}; a "
                f"tip of radius {radius * 1e9:.4g} nm has {tabor:.4g}: take {other}",
                key="adhesion.model",
            )


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
