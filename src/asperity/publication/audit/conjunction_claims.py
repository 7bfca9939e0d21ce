"""Claims on the conjunction, eqs. 16-22: what is between the two surfaces and where it ends."""

from __future__ import annotations

from math import pi, sqrt

import numpy as np

from ..._jax import jnp
from ...results.summary import amount
from ..evidence import Evidence
from .claim import AGREES, OUTSIDE, WRONG, Claim


def claims(evidence: Evidence) -> list[Claim]:
    """From the forces at lambda' = 3 to the number of asperities."""
    at_edge = evidence.exact_state(3.0 * evidence.rough.rms_height)
    push, times = float(at_edge.elastic), float(at_edge.elastic) / evidence.weight
    tip, work = evidence.rough.asperity_radius, evidence.inputs.work_of_adhesion
    pull = float(at_edge.contacting) * 2.0 * pi * tip * work  # eq. 9
    return [
        Claim("Dry adhesion matters beside contact (eqs. 9, 16)", "-",
              f"{amount(pull, 'N')} against {amount(push, 'N')} at lambda' = 3",
              AGREES if pull > 0.01 * push else WRONG),
        Claim("The functions virtually diminish at lambda' = 3 (section 3.4)", "0",
              f"by the exact integrals contact carries {amount(push, 'N')} there, {times:.2g} "
              "times the weight",
              AGREES if times < 1.0 else WRONG),
        _pressure(evidence),
        _cylinder(evidence),
        *_deformation(evidence),
        _few(evidence),
    ]  # fmt: skip


def _pressure(evidence: Evidence) -> Claim:
    half = 0.5 * float(evidence.contact.pressure.end)
    found = float(evidence.contact.pressure.contact(jnp.asarray(half)))
    return Claim(
        "Eq. 16 is a force",
        "N",
        f"it lacks the area: it is a pressure, {amount(found, 'Pa')} half-way to the edge",
        WRONG,
    )


def _cylinder(evidence: Evidence) -> Claim:
    """Load of eq. 18's cylinder over that of the sphere, on the square around the conjunction."""
    pressure, radius = evidence.contact.pressure, float(evidence.contact.shape.radius)
    low, width = evidence.closest, evidence.contact_radius
    nodes, weights = np.polynomial.legendre.leggauss(40)
    place = 0.5 * width * (nodes + 1.0)
    carried = np.asarray(pressure.contact(jnp.asarray(low + place**2 / (2.0 * radius))))
    share = 0.5 * width * weights * carried
    ratio = float(4.0 * width * np.sum(share) / (2.0 * pi * np.sum(share * place)))
    return Claim(
        "The profile of the sphere (eq. 18)",
        "x^2/2R",
        f"that is a cylinder: on the square around the conjunction at closest approach it "
        f"carries {ratio:.2f} times what the sphere does",
        AGREES if abs(ratio - 1.0) < 0.01 else WRONG,
    )


def _deformation(evidence: Evidence) -> list[Claim]:
    """Eqs. 19, 20 and 22."""
    depth = float(evidence.contact.pressure.end) - evidence.closest
    middle = float(evidence.conjunction[2][0])
    idle = 1.0 - pi / 4.0
    return [
        Claim(
            "The separation h_0 at the centre (eq. 20) is that of the equation of motion",
            "-",
            f"the motion needs the rigid separation; the pressure of contact moves the surfaces "
            f"by {amount(middle, 'm')} at the axis, {100.0 * middle / depth:.2g} % of the "
            f"{amount(depth, 'm')} past the edge, which the case `published` leaves out",
            AGREES if middle < 0.01 * depth else WRONG,
        ),
        Claim(
            "The pressures have converged when eq. 22 is met",
            "0.1 <= eps <= 0.001",
            "the interval is the wrong way round; the sum divides by pressures that are zero on "
            f"{100.0 * idle:.0f} % and more of the grid; it grows with the number of points, so "
            "that one value means another accuracy on each grid; and it bounds the change in one "
            "step, not the error",
            WRONG,
        ),
    ]


def _few(evidence: Evidence) -> Claim:
    depth = float(evidence.contact.pressure.end) - evidence.closest
    contacting = evidence.wet_touching
    at_rest = float(evidence.exact_state(evidence.exact_rest).contacting)
    return Claim(
        "A mean over asperities describes the impact",
        "-",
        f"{contacting:.2g} asperities of the conjunction touch at closest approach, "
        f"{amount(depth, 'm')} past its edge, and {at_rest:.2g} at rest by the exact model: single "
        f"impacts scatter by {100.0 / sqrt(max(contacting, 1e-12)):.0f} % in that number",
        AGREES if min(contacting, at_rest) > 10.0 else OUTSIDE,
    )
