"""Claims on the choice of the models, the height integrals and the menisci."""

from __future__ import annotations

from math import exp, pi, sqrt

import numpy as np
from scipy.integrate import quad
from scipy.optimize import brentq
from scipy.special import ndtr

from ...laws.published_pressures import EQ_10, EQ_17
from ...numerics.height_integrals import height_integral
from ...results.summary import amount
from ..evidence import PRINTED, Evidence, first
from ..parameter_estimation import WITHIN
from .claim import AGREES, OUTSIDE, WRONG, Claim, close

CONDENSATION = 4.2e-3
"""Time in which a water bridge of nanometres nucleates at 40 % relative humidity and 26 degC [s].

Szoszkiewicz and Riedo (2005), Phys. Rev. Lett. 95, 135502.
"""

MONOLAYER = 25e-6
"""Time that the publication gives for a monolayer of water [s] (its introduction)."""

_EXAMPLE = 0.6


def claims(evidence: Evidence) -> list[Claim]:
    """Which models hold, eqs. 2-3, 7-17 and figure 4."""
    return [
        *_models(evidence),
        *_polynomials(evidence),
        _kelvin(evidence),
        _push(evidence),
        _factor_of_bands(evidence),
        _left_out(evidence),
        *_water(evidence),
    ]


def _models(evidence: Evidence) -> list[Claim]:
    tabor, elasticity, psi = (
        float(evidence.wet.regime[name])
        for name in ("tabor_number", "elasticity_parameter", "plasticity_index")
    )
    load = evidence.load_at_rest
    return [
        Claim("The Tabor number (eq. 2)", "0.02", f"{tabor:.4f}",
              AGREES if round(tabor, 2) == 0.02 else WRONG),
        Claim("The elasticity parameter, 1.16 times that", "0.0235", f"{elasticity:.4f}",
              AGREES if close(elasticity, 0.0235, 0.03) else WRONG),
        Claim("The load parameter places the case in the DMT region (fig. 4, below 100)", "< 100",
              f"{load:.2g} at rest, so that adhesion is negligible there",
              AGREES if load < 100.0 else WRONG),
        Claim("Asperities deform elastically (eq. 16), whatever eq. 3 says", "-",
              f"the plasticity index is {psi:.3g} at a hardness of "
              f"{amount(evidence.inputs.body.hardness, 'Pa')}; above 1 they yield",
              AGREES if psi < 1.0 else OUTSIDE),
    ]  # fmt: skip


def _polynomials(evidence: Evidence) -> list[Claim]:
    printed_0, printed_32 = (np.polynomial.Polynomial(c) for c in (EQ_10, EQ_17))
    exact_0, exact_32 = float(ndtr(-3.0)), float(height_integral(1.5, 3.0))
    low, high = brentq(printed_32, 2.5, 3.2), brentq(printed_32, 4.0, 4.7)
    decrement = first(evidence.printed.measures["log_decrement"])
    stays = (
        "sticks at the first impact"
        if np.isnan(decrement)
        else f"has a decrement of {decrement:.3g}"
    )
    edge = evidence.unknowns.conjunction_ends
    worst = evidence.printed_off
    published = evidence.published.values["log_decrement"]
    assert published is not None
    other = ""
    if all(worst[name] <= limit for name, limit in WITHIN.items()):
        other = (
            f". With an end at {PRINTED.conjunction_ends:.4g} and other inputs the printed "
            f"polynomials give the decrements within {100.0 * worst['log_decrement']:.1f} % and "
            f"the stiction times within {100.0 * worst['time_to_rest']:.1f} %: the tables do not "
            "tell which were used"
        )
    return [
        Claim("F_0 may be taken from eq. 10", f"{printed_0(3.0):.5f} at lambda' = 3",
              f"{exact_0:.5f}, {100.0 * (printed_0(3.0) / exact_0 - 1.0):+.0f} % there: the "
              "coefficients are rounded",
              AGREES if close(printed_0(3.0), exact_0, 0.01) else WRONG),
        Claim("F_3/2 may be taken from eq. 17", f"{printed_32(3.0):.2e} at lambda' = 3",
              f"{exact_32:.2e} there; the polynomial is negative from lambda' = {low:.3f} to "
              f"{high:.3f}, where contact attracts",
              AGREES if close(printed_32(3.0), exact_32, 0.01) else WRONG),
        Claim("Eqs. 10 and 17 as printed, with the other inputs in use",
              f"decrement {published}",
              f"with the end of the conjunction at {edge:.3g} the sphere {stays}{other}",
              AGREES if close(decrement, published, WITHIN["log_decrement"]) else WRONG),
    ]  # fmt: skip


def _kelvin(evidence: Evidence) -> Claim:
    half = evidence.kelvin_radius(0.5)
    return Claim(
        "The Kelvin radius (eq. 11)",
        f"{-half * 1e9:.3f} nm at 50 %, as printed",
        f"{half * 1e9:.3f} nm: the logarithm of a humidity below 1 is negative",
        WRONG,
    )


def _push(evidence: Evidence) -> Claim:
    end = evidence.interaction_range(0.5)
    return Claim(
        "A meniscus pulls as in eq. 12 at any gap",
        "-",
        f"beyond {end * 1e9:.3g} nm (at 50 %) it pushes, at twice that with its full force",
        WRONG,
    )


def _factor_of_bands(evidence: Evidence) -> Claim:
    """Eq. 14 summed over all heights must give N; as printed it gives this many times N."""
    factor = 1.0 / (sqrt(2.0 * pi) * evidence.rough.rms_height)
    return Claim(
        "The number of asperities in a band (eq. 14)",
        f"{factor:.2g} 1/m times the difference of F_0",
        "F_0 holds that factor already; with it all bands together would hold "
        f"{factor:.2g} 1/m times the asperities there are",
        WRONG,
    )


def _left_out(evidence: Evidence) -> Claim:
    """What the sum of eq. 15 omits: asperities that touch, and those below the mean plane."""
    sigma, at = evidence.rough.rms_height, 3.0
    interaction_range = evidence.interaction_range(_EXAMPLE) / sigma
    inside = min(interaction_range, at)

    def waiting(gap: float) -> float:
        return (1.0 - gap / interaction_range) * exp(-0.5 * (at - gap) ** 2) / sqrt(2.0 * pi)

    summed = quad(waiting, 0.0, inside)[0]
    contacting = float(ndtr(-at))
    everywhere = 1.0 / (0.5 - contacting)
    return Claim(
        "The menisci of all asperities (eq. 15)",
        "those between the flat and the mean plane",
        f"at lambda' = 3 those that touch, which are left out, carry {contacting / summed:.2g} "
        f"times what the sum holds within the reach of a meniscus at {100.0 * _EXAMPLE:g} % "
        "(beyond it the terms push, as printed); at 100 % also all below the mean plane are "
        f"left out, and the whole is {everywhere:.3g} times the sum",
        WRONG,
    )


def _water(evidence: Evidence) -> list[Claim]:
    spacing = evidence.rough.spacing
    damp = evidence.kelvin_radius(0.99)
    contact = evidence.contact_time
    return [
        Claim(
            "At 100 % relative humidity menisci are isolated",
            "-",
            f"their Kelvin radius is infinite; at 99 % it is {damp * 1e9:.3g} nm, the asperities "
            f"are {spacing * 1e9:.2g} nm apart: they have coalesced",
            AGREES if damp < spacing else OUTSIDE,
        ),
        Claim(
            "Menisci are in equilibrium throughout (eq. 11)",
            f"{amount(MONOLAYER, 's')} for a monolayer",
            f"the first contact lasts {amount(contact, 's')}, less than that, and a bridge "
            f"nucleates in some {amount(CONDENSATION, 's')} (at 40 %)",
            AGREES if contact > CONDENSATION else OUTSIDE,
        ),
    ]
