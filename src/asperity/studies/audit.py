"""The publication's claims beside what the program finds, each number computed."""

from __future__ import annotations

from math import cos, pi, sqrt
from typing import NamedTuple

import numpy as np
from scipy.optimize import brentq
from scipy.special import ndtr

from .. import regimes
from .._jax import jnp
from ..film import AIR_VISCOSITY, gas_decrement
from ..laws.published import EQ_10, EQ_17
from ..materials import contact_modulus, kelvin_radius
from ..special import height_integral
from ..summary import amount
from .evidence import Evidence, first

AGREES = "agrees"
REPRODUCED = "reproduced"
WRONG = "does not hold"
MISSING = "not in the text"
UNEXPLAINED = "not explained"
OUTSIDE = "outside the model"

CONDENSATION = 4e-3
"""Time in which a meniscus condenses at 40 % relative humidity near 20 degC [s]."""

MEAN_FREE_SLIP = 75e-9
"""Slip length of air at ambient pressure on both surfaces [m]."""


class Claim(NamedTuple):
    """One line of the audit.

    Attributes
    ----------
    claim
        What the publication says, and where.
    published
        Its number, or a dash.
    found
        What the program computes.
    verdict
        In two or three words.
    """

    claim: str
    published: str
    found: str
    verdict: str


def claims(evidence: Evidence) -> list[Claim]:
    """The audit, from the choice of the models to the power losses."""
    return [
        *_models(evidence),
        *_polynomials(evidence),
        *_menisci(evidence),
        *_conjunction(evidence),
        *_motion(evidence),
        *_power(evidence),
        *_exact(evidence),
    ]


def _models(evidence: Evidence) -> list[Claim]:
    case, rough = evidence.case, evidence.case.roughness
    assert rough is not None
    assert case.adhesion.work is not None
    assert case.adhesion.range is not None
    modulus = contact_modulus(case.body_solid, case.counterface_solid)
    work, radius = case.adhesion.work, rough.asperity_radius
    tabor = regimes.tabor_number(radius, work, modulus, case.adhesion.range)
    psi = evidence.wet.regime["plasticity_index"]
    hardness = case.body_solid.hardness
    rest = evidence.exact_state(evidence.exact_rest)
    load = regimes.load_parameter(float(rest.elastic), float(rest.touching), work, radius)
    return [
        Claim("The Tabor number (eq. 2)", "0.02", f"{tabor:.4f}", AGREES),
        Claim(
            "The elasticity parameter, 1.16 times that",
            "0.0235",
            f"{regimes.ELASTICITY_PER_TABOR * tabor:.4f}",
            AGREES,
        ),
        Claim(
            "The load parameter places the case in the DMT region (fig. 4, below 100)",
            "< 100",
            f"{load:.2g} at rest: adhesion is negligible there",
            WRONG,
        ),
        Claim(
            "Asperities deform elastically (eq. 16), whatever eq. 3 says",
            "-",
            f"the plasticity index is {psi:.3g} at a hardness of {amount(hardness, 'Pa')}: "
            "they yield",
            OUTSIDE,
        ),
    ]


def _polynomials(evidence: Evidence) -> list[Claim]:
    printed_0, printed_32 = (np.polynomial.Polynomial(c) for c in (EQ_10, EQ_17))
    exact_0 = float(ndtr(-3.0))
    low = brentq(printed_32, 2.5, 3.2)
    high = brentq(printed_32, 4.0, 4.7)
    deepest = np.linspace(low, high, 400)[np.argmin(printed_32(np.linspace(low, high, 400)))]
    ratio = float(printed_32(deepest) / height_integral(1.5, float(deepest)))
    outcome = evidence.printed
    decrement = first(outcome.measures["log_decrement"])
    stays = "sticks at the first impact" if np.isnan(decrement) else f"decrement {decrement:.3g}"
    return [
        Claim(
            "F_0 may be taken from eq. 10",
            f"{printed_0(3.0):.5f} at lambda' = 3",
            f"{exact_0:.5f}: {100.0 * (printed_0(3.0) / exact_0 - 1.0):+.0f} %, the coefficients "
            "are rounded",
            WRONG,
        ),
        Claim(
            "F_3/2 may be taken from eq. 17",
            f"{float(printed_32(deepest)):.1e} at lambda' = {deepest:.2f}",
            f"negative from lambda' = {low:.3f} to {high:.3f}, {ratio:.0f} times the integral at "
            "the worst: contact attracts",
            WRONG,
        ),
        Claim(
            "The motion of fig. 7a follows from eqs. 10 and 17",
            "decrement 0.5194",
            f"with both as printed the sphere {stays}",
            WRONG,
        ),
    ]


def _menisci(evidence: Evidence) -> list[Claim]:
    case, rough, liquid = evidence.case, evidence.case.roughness, evidence.case.liquid
    assert rough is not None
    assert liquid is not None
    assert case.capillary.temperature is not None
    assert case.capillary.contact_angle is not None
    half, damp = (kelvin_radius(liquid, h, case.capillary.temperature) for h in (0.5, 0.99))
    reach = 2.0 * half * cos(case.capillary.contact_angle)
    sigma, spacing = rough.rms_height, rough.asperity_density**-0.5
    closest = float(evidence.wet.events["deepest_separation"][0]) / sigma
    share = float(ndtr(-closest) / (0.5 - ndtr(-closest)))
    contact = _contact_time(evidence)
    return [
        Claim(
            "The Kelvin radius (eq. 11)",
            f"{-half * 1e9:.3f} nm at 50 %, as printed",
            f"{half * 1e9:.3f} nm: the logarithm of a humidity below 1 is negative",
            WRONG,
        ),
        Claim(
            "A meniscus pulls as in eq. 12 at any gap",
            "-",
            f"beyond {reach * 1e9:.3g} nm (at 50 %) it pushes, at twice that with its full force",
            WRONG,
        ),
        Claim(
            "The number of asperities in a band (eq. 14)",
            f"times {1.0 / (sqrt(2.0 * pi) * sigma):.2g} 1/m",
            "F_0 holds that factor already, and with it the number has no right dimension",
            WRONG,
        ),
        Claim(
            "The menisci of all asperities (eq. 15)",
            "those that do not touch",
            f"those that touch are left out: {100.0 * share:.2g} % more at closest approach",
            WRONG,
        ),
        Claim(
            "At 100 % relative humidity menisci are isolated",
            "-",
            f"their Kelvin radius is infinite; at 99 % it is {damp * 1e9:.3g} nm, the asperities "
            f"are {spacing * 1e9:.2g} nm apart: they have coalesced",
            OUTSIDE,
        ),
        Claim(
            "Menisci are in equilibrium throughout",
            "-",
            f"the first contact lasts {amount(contact, 's')}, condensation about "
            f"{amount(CONDENSATION, 's')} (at 40 %)",
            OUTSIDE,
        ),
    ]


def _contact_time(evidence: Evidence) -> float:
    """Duration of the first contact, from and to the edge of the conjunction [s]."""
    motion, gravity = evidence.wet, evidence.case.impact.gravity
    heights = motion.measures["rebound_height"]
    edge = motion.events["apex_separation"][0] - heights[0]
    fall = np.sqrt(2.0 * (motion.separation[0] - edge) / gravity)
    return float(motion.measures["impact_time"][0] - fall - np.sqrt(2.0 * heights[0] / gravity))


def _conjunction(evidence: Evidence) -> list[Claim]:
    sigma, adhesion = evidence.rms_height, _dry_adhesion(evidence)
    at_edge = evidence.exact_state(3.0 * sigma)
    push = float(at_edge.elastic)
    pressure = float(evidence.contact.pressure.contact(jnp.asarray(2.9 * sigma)))
    closest = float(evidence.wet.events["deepest_separation"][0])
    edge = float(evidence.contact.pressure.end)
    return [
        Claim(
            "Dry adhesion matters beside contact (eqs. 9, 16)",
            "-",
            f"{amount(adhesion, 'N')} against {amount(push, 'N')} at lambda' = 3",
            WRONG,
        ),
        Claim(
            "The functions virtually diminish at lambda' = 3 (section 3.4)",
            "0",
            f"by the exact integrals contact carries {amount(push, 'N')} there, "
            f"{push / evidence.weight:.2g} times the weight",
            WRONG,
        ),
        Claim(
            "Eq. 16 is a force",
            "N",
            f"it lacks the area: it is a pressure, {amount(pressure, 'Pa')} at lambda' = 2.9",
            WRONG,
        ),
        Claim(
            "The profile of the sphere (eq. 18)",
            "x^2/2R",
            f"that is a cylinder: on a square around the conjunction at closest approach it "
            f"carries {_cylinder_over_sphere(evidence):.2f} times what the sphere does",
            WRONG,
        ),
        Claim(
            "The deformation has converged when eq. 22 is met",
            "0.1 to 0.001",
            f"it divides by pressures that are zero on {100.0 * (1.0 - pi / 4.0):.0f} % and more "
            "of the grid, and 0.1 is no tolerance for a force",
            WRONG,
        ),
        Claim(
            "A mean over asperities describes the impact",
            "-",
            f"{evidence.wet_touching:.2g} asperities of the conjunction touch at closest "
            f"approach, {amount(edge - closest, 'm')} past its edge, and "
            f"{float(evidence.exact_state(evidence.exact_rest).touching):.2g} at rest by the "
            "exact model",
            OUTSIDE,
        ),
    ]


def _dry_adhesion(evidence: Evidence) -> float:
    """Pull of all touching asperities at lambda' = 3 by the exact model [N], eq. 9."""
    case, rough = evidence.case, evidence.case.roughness
    assert rough is not None
    assert case.adhesion.work is not None
    touching = float(evidence.exact_state(3.0 * rough.rms_height).touching)
    return touching * 2.0 * pi * rough.asperity_radius * case.adhesion.work


def _cylinder_over_sphere(evidence: Evidence) -> float:
    """Load of eq. 18's cylinder over that of the sphere, on the square around the conjunction."""
    pressure, radius = evidence.contact.pressure, float(evidence.contact.shape.radius)
    low, end = float(evidence.wet.events["deepest_separation"][0]), float(pressure.end)
    width = sqrt(2.0 * radius * (end - low))
    nodes, weights = np.polynomial.legendre.leggauss(40)
    place = 0.5 * width * (nodes + 1.0)
    carried = np.asarray(pressure.contact(jnp.asarray(low + place**2 / (2.0 * radius))))
    share = 0.5 * width * weights * carried
    return float(4.0 * width * np.sum(share) / (2.0 * pi * np.sum(share * place)))


def _motion(evidence: Evidence) -> list[Claim]:
    case = evidence.case
    assert case.publication is not None
    wet, dry = (first(m.measures["log_decrement"]) for m in (evidence.wet, evidence.dry))
    conservative = first(evidence.both_ways.measures["restitution"])
    density = case.body_density
    mass = density * 4.0 / 3.0 * pi * case.body.radius**3
    release = case.impact.release_gap
    assert release is not None
    air = (case.body.radius, AIR_VISCOSITY, MEAN_FREE_SLIP)
    drop = (release, case.publication.conjunction_ends * evidence.rms_height)
    gas, _ = gas_decrement(drop, mass, case.impact.gravity, air)
    factor = case.publication.capillary_factor
    return [
        Claim(
            "Adhesion and menisci damp the motion (eqs. 9, 15, 21)",
            "decrement 0.5194",
            f"forces of position alone: restitution {conservative:.8f}. With the pulls only while "
            f"parting, which no equation says, the decrement is {wet:.4f}",
            UNEXPLAINED,
        ),
        Claim(
            "Release gap, speed, density, humidity steps, grid",
            "-",
            f"released at rest from {amount(release, 'm')}, {density:g} kg/m^3, 100 % relative "
            "humidity: found or assumed",
            MISSING,
        ),
        Claim(
            "The force of the menisci (eq. 15)",
            "1",
            f"times {factor:.4g}, which nothing in the text gives; an end of the conjunction "
            "farther out would need less (see --refit)",
            UNEXPLAINED,
        ),
        *(_tables(evidence)),
        Claim(
            "The decrement is 200 times larger wet than dry",
            "200",
            f"{wet / dry:.0f} times ({wet:.4f} and {dry:.2e})",
            WRONG,
        ),
        Claim(
            "Nothing else damps the motion",
            "-",
            f"the gas film alone, which is left out, gives a decrement of {gas:.2g} in air "
            f"(slip length {amount(MEAN_FREE_SLIP, 'm')})",
            WRONG,
        ),
    ]


def _tables(evidence: Evidence) -> list[Claim]:
    out = []
    for quantity, name in (("log_decrement", "decrements"), ("stiction_time", "stiction times")):
        off = [
            abs(row["relative_difference"])
            for row in evidence.rows
            if row["quantity"] == quantity and row["relative_difference"] is not None
        ]
        if off:
            verdict = REPRODUCED if max(off) < 0.05 else WRONG
            found = f"all within {100.0 * max(off):.1f} % with one set of inputs"
            out.append(Claim(f"The {name} of Tables 2 and 3", "five", found, verdict))
    return out


def _power(evidence: Evidence) -> list[Claim]:
    def spread(name: str) -> str:
        found = [row[name] for row in evidence.power]
        known = [value for value in found if value is not None]
        return f"{min(known):.2f} to {max(known):.2f}" if known else "-"

    exact = evidence.exact.measures
    one_way, lost = first(exact["power_loss_published"]), first(exact["power_loss"])
    return [
        Claim(
            "The power loss is the work of the pulls over the impact time (eq. 23)",
            "2.0554e-13 W",
            f"published over that of the first impact: {spread('over_first_impact')}; over the "
            f"energy of the whole drop by the time to rest: {spread('over_whole_drop')}; over the "
            f"mean of eq. 23 over all impacts: {spread('over_mean_of_impacts')}, which may be "
            "what was meant",
            UNEXPLAINED,
        ),
        Claim(
            "The work of the pulls on the way out is lost (eq. 23)",
            "all of it",
            f"most comes back on the way in: by the exact model eq. 23 says {one_way / lost:.0f} "
            "times what is lost",
            WRONG,
        ),
        Claim(
            "The heading of the power loss in Table 3",
            "1e-8 nW",
            "1e-4 nW: the row that both tables hold differs by 10 000 otherwise",
            WRONG,
        ),
    ]


def _exact(evidence: Evidence) -> list[Claim]:
    rest, exact = evidence.exact_rest, evidence.exact.measures
    release = evidence.case.impact.release_gap
    assert release is not None
    push = float(evidence.exact_state(release).force) / evidence.weight
    return [
        Claim(
            "The sphere rests at the edge of the conjunction",
            "lambda' = 3",
            f"by the exact model at lambda' = {rest / evidence.rms_height:.2f} "
            f"({rest * 1e9:.1f} nm), beyond the release at {release * 1e9:.4g} nm, where contact "
            f"pushes with {push:.2g} times the weight",
            WRONG,
        ),
        Claim(
            "The same case by the exact model (60 % relative humidity, released at 60 nm)",
            "decrement 0.5194",
            f"decrement {first(exact['log_decrement']):.2g}: menisci of {amount(_lost(evidence))} "
            "of the impact energy, and the sphere does not stick",
            WRONG,
        ),
    ]


def _lost(evidence: Evidence) -> float:
    """Share of the impact energy that the first impact loses by the exact model."""
    restitution = first(evidence.exact.measures["restitution"])
    return 1.0 - restitution**2
