"""What a user must know before believing a result: regimes outside a model's validity."""

from __future__ import annotations

from collections.abc import Sequence
from math import pi
from typing import NamedTuple

import numpy as np
from scipy.special import ndtr

from .case import Case, Roughness
from .case.build import Problem
from .contact import Contact
from .film import slip_factor
from .impact import Motion
from .impact.sampling import Series
from .impact.table import CENTRAL, FORCE, PULL, TOUCHING, read_row
from .laws.constant_volume import EDGE_ANGLE, EDGE_HOLDS
from .regimes import DMT_BELOW, FEW, JKR_ABOVE, LAW_NAMES, Regime

SLIP_HOLDS = 0.1
"""Knudsen number below which first-order slip holds."""

_COMPRESSED = 0.1  # of the gas's own pressure
_CLOSE = 0.004  # of the radius: a gap at which the film is 1 % off (Brenner 1961)

APART = 1e-6
"""Share of its peak below which a contact force counts as none."""

CLOSED = 1e-6
"""Share of the impact energy to which a ledger that can be trusted closes."""


class AtDepth(NamedTuple):
    """The contact at the deepest point of the first impact.

    Attributes
    ----------
    touching
        Expected number of touching asperities.
    elastic
        Elastic part of the force [N].
    central
        Separation of the deformed mean planes at the axis [m].
    """

    touching: float
    elastic: float
    central: float

    @classmethod
    def of(cls, contact: Contact, motion: Motion) -> AtDepth:
        """Read off the curve of first approach."""
        row = read_row(motion.table, 0, float(motion.impacts.deepest[0]))
        elastic = row[FORCE] - row[PULL]
        return cls(float(row[TOUCHING]), float(elastic), float(row[CENTRAL]))


def warnings_of(
    case: Case, problem: Problem, regime: Regime, at_depth: AtDepth, motion: Motion
) -> list[str]:
    """One line for each way in which a case leaves the validity of its models.

    Parameters
    ----------
    case, problem
        The case and what was built from it.
    regime
        Its dimensionless numbers.
    at_depth
        The contact at closest approach.
    motion
        The motion.
    """
    return [
        *_asperities(case, at_depth),
        *_publication(case),
        *_adhesion(regime, problem.adhesion.near_borders),
        *_menisci(case, regime),
        *_gas(case, at_depth, motion),
        *_shape(case, motion),
        *_ledger(motion),
    ]


def _asperities(case: Case, at_depth: AtDepth) -> list[str]:
    rough = case.roughness
    if rough is None:
        return []
    out = []
    touching = at_depth.touching
    if touching < FEW:
        scatter = 100.0 / np.sqrt(touching) if touching > 0.0 else np.inf
        out.append(
            f"only {touching:.2g} asperities are expected to touch at closest approach: the "
            f"result is a mean over many places, single impacts scatter by about {scatter:.0f} % "
            "in that number (Poisson)"
        )
    central = at_depth.central
    share = rough.asperity_density * pi * rough.asperity_radius * _mean_overlap(rough, central)
    if share > 0.1:
        out.append(
            f"touching asperities cover {100 * share:.0f} % of the area at the axis at closest "
            "approach: neighbours interact, which the sum over single asperities leaves out"
        )
    return out


def _mean_overlap(rough: Roughness, central: float) -> float:
    """Mean overlap per asperity [m], sigma F_1(h/sigma), in closed form."""
    reduced = central / rough.rms_height
    density = np.exp(-0.5 * reduced**2) / np.sqrt(2.0 * pi)
    return float(rough.rms_height * (density - reduced * ndtr(-reduced)))


def _publication(case: Case) -> list[str]:
    assumed = case.publication
    if assumed is None:
        return []
    pulls = "adhesion and menisci pull only while the bodies part, " * (
        assumed.pull_while_parting_only
    )
    factor = assumed.capillary_factor
    menisci = f", and menisci pull {factor:g} times as much as their equation says" * (
        case.liquid is not None and factor != 1.0
    )
    return [
        f"[publication] follows a paper, not physics: {pulls}nothing acts beyond "
        f"{assumed.conjunction_ends:g} rms heights{menisci}"
    ]


def _adhesion(regime: Regime, near_borders: Sequence[str]) -> list[str]:
    out = list(near_borders)
    psi, mu = regime.plasticity_index, regime.tabor_number
    if psi is not None and psi > 1.0:
        out.append(
            f"the plasticity index is {psi:.3g}: above 1 the asperities yield, and this model "
            "keeps them elastic"
        )
    law = regime.adhesion_law
    if mu is not None and law in ("dmt", "bradley") and mu > DMT_BELOW:
        out.append(
            f"the Tabor number is {mu:.3g}: the {LAW_NAMES[law]} law holds below {DMT_BELOW:g}"
            + (f", JKR above {JKR_ABOVE:g}" if mu <= JKR_ABOVE else "; JKR is meant for this")
        )
    if mu is not None and law == "jkr" and mu < JKR_ABOVE:
        out.append(
            f"the Tabor number is {mu:.3g}: the JKR law holds above {JKR_ABOVE:g}, "
            f"DMT below {DMT_BELOW:g}"
        )
    return out


def _menisci(case: Case, regime: Regime) -> list[str]:
    liquid, kelvin_radius = case.liquid, case.kelvin_radius
    if liquid is None or kelvin_radius == 0.0:
        return []
    out = []
    on_asperities = case.capillary.model != "kelvin-filling" and case.roughness is not None
    molecule = f"less than a molecule of {liquid.name} ({liquid.molecule_size * 1e9:.2g} nm)"
    if case.liquid_radius < liquid.molecule_size:
        whose = "Kelvin radius" if case.liquid_radius == kelvin_radius else "liquid's radius"
        out.append(
            f"the {whose} is {case.liquid_radius * 1e9:.2g} nm, {molecule}: no meniscus of "
            "continuum liquid"
        )
    elif case.liquid_span < liquid.molecule_size:
        out.append(
            f"menisci span gaps up to {case.liquid_span * 1e9:.2g} nm, {molecule}: no meniscus of "
            "continuum liquid"
        )
    if np.isinf(case.liquid_span):
        out.append(
            "the Kelvin radius is infinite: menisci of any height, which would have coalesced long "
            "before, are kept isolated"
        )
    elif on_asperities and regime.wetting in ("coalesced", "flooded"):
        out.append(
            f"{regime.wetting}: {regime.wetting_reason}: menisci merge, and this model keeps them "
            "isolated ('kelvin-filling' is meant for this)"
        )
    elif regime.wetting == "flooded":
        out.append(f"flooded: {regime.wetting_reason}: the drag of the liquid itself is left out")
    return out + _wide(case)


def _wide(case: Case) -> list[str]:
    """Menisci that see more than the cap of their asperity."""
    rough, span = case.roughness, case.liquid_span
    tip = case.body.radius if rough is None else rough.asperity_radius
    filled = case.capillary.model == "kelvin-filling" and rough is not None
    if filled or np.isinf(span):
        return []
    what = "asperity" if rough is not None else "body"
    out = []
    if span > 0.5 * tip:
        out.append(
            f"menisci are wider than their {what}: the gap at their edge is {span * 1e9:.3g} nm, "
            f"and only up to {0.5 * tip * 1e9:.3g} nm, half its radius, does the edge lie on it"
        )
    angle = case.capillary.contact_angle
    if case.capillary.model == "constant-volume" and angle is not None and angle > EDGE_ANGLE:
        out.append(
            f"the contact angle is {np.degrees(angle):.4g} deg: menisci of constant volume are "
            f"tested up to {np.degrees(EDGE_ANGLE):.0f} deg, and taken for thin beyond that"
        )
    volume = pi * (span / tip) ** 2
    if case.capillary.model == "constant-volume" and volume > EDGE_HOLDS:
        out.append(
            f"the volume of a meniscus is {volume:.3g} radius^3: its law is tested up to "
            f"{EDGE_HOLDS:g} radius^3, and takes it for thin beyond that"
        )
    return out


def _gas(case: Case, at_depth: AtDepth, motion: Motion) -> list[str]:
    """A film outside first-order slip, or one whose gas is compressed."""
    gas = case.gas
    if gas is None:
        return []
    thinnest = max(at_depth.central, _film_stops(case))
    out = [*_far(case), *_two_temperatures(case)]
    knudsen = gas.free_path / thinnest
    if knudsen == 0.0:
        out.append(
            "the gas film has no slip (`slip_length` is 0): it holds where the gap is more than "
            "ten mean free paths, which in air at ambient pressure is 0.65 um"
        )
    if knudsen > SLIP_HOLDS:
        out.append(
            f"the Knudsen number of the gas film is {knudsen:.2g} at closest approach: first-order "
            f"slip holds below {SLIP_HOLDS:g}"
        )
    mass = case.body_density * 4.0 / 3.0 * pi * case.body.radius**3
    speed = np.sqrt(2.0 * float(motion.impacts.fastest[0]) / mass)
    slip = float(slip_factor(thinnest, gas.film_slip_length))
    pressure = 3.0 * gas.film_viscosity * case.body.radius * speed * slip / thinnest**2
    if gas.pressure is not None and pressure > _COMPRESSED * gas.pressure:
        out.append(
            f"the pressure in the gas film may reach {pressure:.2g} Pa (impact speed at closest "
            f"approach), above {_COMPRESSED:g} of the gas's {gas.pressure:.3g} Pa: it is "
            "compressed then, and this film is not"
        )
    if not float(motion.impacts.apex[0]) > float(motion.impacts.deepest[0]):
        out.append("the gas film damps the fall so strongly that the body creeps to rest")
    return out


def _far(case: Case) -> list[str]:
    """A film so thick that the sphere is not close to the wall."""
    release, radius = case.impact.release_gap, case.body.radius
    if release is None or release <= _CLOSE * radius:
        return []
    return [
        f"the body is released at {release / radius:.2g} of its radius: the gas film is that of a "
        f"sphere close to the wall, 1 % off at {_CLOSE:g}, and Stokes's drag far from it is left "
        "out"
    ]


def _two_temperatures(case: Case) -> list[str]:
    gas, liquid = case.gas, case.capillary.temperature
    if gas is None or gas.temperature is None or case.liquid is None or liquid is None:
        return []
    if abs(gas.temperature - liquid) <= 1.0:
        return []
    return [
        f"gas.temperature is {gas.temperature:.4g} K and capillary.temperature {liquid:.4g} K: the "
        "vapour of the menisci is part of the gas"
    ]


def _film_stops(case: Case) -> float:
    """Separation below which the film does not thin [m]."""
    assert case.gas is not None
    if case.gas.closest_gap is not None:
        return case.gas.closest_gap
    assert case.roughness is not None
    return case.roughness.rms_height


def slow_menisci(problem: Problem, series: Series) -> list[str]:
    """A line where menisci take longer to form than the first contact lasts.

    Parameters
    ----------
    problem
        What was built from a case.
    series
        Its motion in time.
    """
    if problem.late is None:
        return []
    force = np.abs(series.rows[:, FORCE])
    held = np.flatnonzero((series.phase < 2) & (force > APART * np.max(force)))
    lasts = float(series.time[held[-1]] - series.time[held[0]])
    takes = float(problem.late.time)
    if takes <= lasts:
        return []
    return [
        f"menisci take {takes:.3g} s to form and the first contact lasts {lasts:.3g} s: few form, "
        "and more energy may go into those few than if all had formed at once"
    ]


def _shape(case: Case, motion: Motion) -> list[str]:
    depth = -float(motion.impacts.deepest[0])
    if depth <= 0.02 * case.body.radius:
        return []
    return [
        f"the body sinks in by {100 * depth / case.body.radius:.0f} % of its radius: paraboloid "
        "and half-space are approximations for small indentations"
    ]


def _ledger(motion: Motion) -> list[str]:
    rows = motion.impacts
    off = float(np.max(np.where(rows.made, rows.closure, 0.0)) / rows.fastest[0])
    if off <= CLOSED:
        return []
    return [
        f"the energy ledger closes to {off:.1g} of the impact energy only, not to {CLOSED:.0e}: "
        "the way between the branches is not resolved"
    ]
