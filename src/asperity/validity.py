"""What a user must know before believing a result: regimes outside a model's validity."""

from __future__ import annotations

from math import pi
from typing import NamedTuple

import numpy as np
from scipy.special import ndtr

from .case import Case, Roughness
from .case.build import Problem
from .contact import Contact
from .impact import Motion
from .impact.table import CENTRAL, FORCE, PULL, TOUCHING, read_row
from .regimes import Regime

CLOSED = 1e-6
"""Share of the impact energy to which a ledger that can be trusted closes."""

FEW = 10.0
"""Touching asperities below which a mean over asperities says little of one impact."""


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
        *_adhesion(regime),
        *_menisci(case),
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


def _adhesion(regime: Regime) -> list[str]:
    out = []
    psi, mu = regime.plasticity_index, regime.tabor_number
    if psi is not None and psi > 1.0:
        out.append(
            f"the plasticity index is {psi:.3g}: above 1 the asperities yield, and this model "
            "keeps them elastic"
        )
    law = regime.adhesion_law
    if mu is not None and law in ("dmt", "bradley") and mu > 0.1:
        out.append(
            f"the Tabor number is {mu:.3g}: the {law.upper()} law holds below 0.1"
            + (", JKR above 5" if mu <= 5 else "; JKR is meant for this")
        )
    if mu is not None and law == "jkr" and mu < 5.0:
        out.append(f"the Tabor number is {mu:.3g}: the JKR law holds above 5, DMT below 0.1")
    return out


def _menisci(case: Case) -> list[str]:
    liquid, kelvin_radius = case.liquid, case.kelvin_radius
    if liquid is None or kelvin_radius == 0.0:
        return []
    out = []
    if kelvin_radius < liquid.molecule_size:
        out.append(
            f"the Kelvin radius is {kelvin_radius * 1e9:.2g} nm, less than a molecule of "
            f"{liquid.name} ({liquid.molecule_size * 1e9:.2g} nm): no meniscus of continuum liquid"
        )
    rough = case.roughness
    if np.isinf(kelvin_radius):
        out.append(
            "the Kelvin radius is infinite: menisci of any height, which would have coalesced long "
            "before, are kept isolated"
        )
    elif rough is not None and kelvin_radius > rough.asperity_density**-0.5:
        out.append(
            f"the Kelvin radius is {kelvin_radius * 1e9:.3g} nm, above the asperity spacing of "
            f"{rough.asperity_density**-0.5 * 1e9:.3g} nm: menisci coalesce, and this model "
            "keeps them isolated"
        )
    return out


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
