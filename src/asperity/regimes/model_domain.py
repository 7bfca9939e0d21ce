"""Sizes and speeds at which the models of contact begin to fail: the warnings.

What no model describes at all is refused sooner, with the case.
"""

from __future__ import annotations

from math import erfc, exp, pi, sqrt

import numpy as np

from ..dynamics import Motion
from ..dynamics.problem import Problem
from ..inputs import Asperities, Inputs
from ..materials.solids import bar_wave_speed, named

LARGE_ASPERITY = 0.1
"""Asperity radius over body radius from which the effective radius, R beta/(R + beta), is 9 % off
the asperity's, which the models take."""

ROUGH = 0.05
"""Rms height over body radius. Asperities 3 rms high then touch as far as 0.55 R from the axis,
where a sphere lies 9 % lower than the paraboloid that stands for it."""

WIDE = 0.2
"""Contact radius over body radius: there a sphere lies 1 % lower than its paraboloid."""

DEEP = 0.02
"""Depth over body radius: the cap that deep has a contact radius of 0.2 body radii."""

OVERLAP = 0.1
"""Mean overlap of contacting asperities over tip radius: the contact radius is then 0.32 of it."""

FAST = 0.02
"""Impact speed over the speed of waves in a bar: 10 % of the energy then goes into waves."""

HUNTER = 1.04, 0.6
"""Factor and power of the speed ratio in the share of energy that goes into waves. Hunter (1957),
as in Johnson, Contact Mechanics (1985), ch. 11."""

_EDGE = 3.0  # rms heights: how far out asperities touch


def domain_warnings(problem: Problem, elastic: float, central: float, motion: Motion) -> list[str]:
    """One line for each size or speed at which the models of a case begin to fail.

    Parameters
    ----------
    problem
        What was built from a case.
    elastic, central
        Elastic force [N], and separation [m] of the deformed mean planes at the axis, at closest
        approach.
    motion
        The motion.
    """
    inputs = problem.inputs
    moves, rough = inputs.release is not None, inputs.asperities
    speed = sqrt(2.0 * float(motion.impacts.maximum_kinetic[0]) / float(problem.body.mass))
    return [
        *([] if rough is None else _asperities(inputs, rough, central)),
        *_shape(inputs, contact_radius(problem, elastic, central), motion),
        *(_waves(inputs, speed) if moves else []),
        *_yields(inputs, elastic, speed if moves else None),
    ]


def contact_radius(
    problem: Problem, elastic: float, central: float, highest: float | None = None
) -> float:
    """Radius [m] of the whole contact: of Hertz's, or of where the highest asperities touch.

    Parameters
    ----------
    problem, elastic, central
        As for :func:`domain_warnings`.
    highest
        Height [m] of the highest asperity; without it 3 rms heights above their mean.
    """
    inputs = problem.inputs
    radius, rough = inputs.radius, inputs.asperities
    relaxed = 1.0 if problem.relaxation is None else float(problem.relaxation.ratio)
    hertz = float(np.cbrt(0.75 * max(elastic, 0.0) * radius / (relaxed * inputs.modulus)))
    if rough is None:
        return hertz
    if highest is None:
        highest = rough.mean_height + _EDGE * rough.rms_height
    rise = max(highest - central, 0.0)
    bulk = 0.0 if inputs.structure.deformation == "rigid" else hertz
    return max(sqrt(2.0 * radius * rise), bulk)


def covered_share(rough: Asperities, separation: float) -> float:
    """Share of the area that contacting asperities cover at a separation [m].

    Density times pi radius times the mean overlap: of the summits where they are in use, else of
    Gaussian heights.
    """
    if rough.summits is not None and rough.facts is not None and rough.facts["source"] == "summits":
        overlap = (rough.summits.heights - separation).clip(0.0)
        return rough.asperity_density * pi * float((overlap * rough.summits.radii).mean())
    return rough.asperity_density * pi * rough.asperity_radius * tails(rough, separation)[1]


def mean_overlap(rough: Asperities, separation: float) -> float:
    """Mean overlap [m] of the asperities that touch at a separation [m]; 0 where none does."""
    if rough.summits is not None and rough.facts is not None and rough.facts["source"] == "summits":
        heights = rough.summits.heights
        over = heights[heights > separation] - separation
        return float(over.mean()) if over.size else 0.0
    share, overlap, _ = tails(rough, separation)
    return overlap / share if share > 0.0 else 0.0


def tails(rough: Asperities, separation: float) -> tuple[float, float, float]:
    """Repeated tail integrals of Gaussian heights at a separation [m], as `Heights.tail` has them.

    Returns
    -------
    tuple
        T_1, the share that touches at one place; T_2 [m], the mean of all overlaps there, or the
        number that touches under a whole rigid paraboloid; T_3 [m^2], the overlaps under it.
    """
    rms = rough.rms_height
    reduced = (separation - rough.mean_height) / rms
    first = 0.5 * erfc(reduced / sqrt(2.0))
    second = max(exp(-0.5 * reduced**2) / sqrt(2.0 * pi) - reduced * first, 0.0)
    return first, rms * second, 0.5 * rms**2 * (first - reduced * second)


def _asperities(inputs: Inputs, rough: Asperities, central: float) -> list[str]:
    """Asperities that are large or high beside the body, or pressed deep beside their tips."""
    radius, tip, height = inputs.radius, rough.asperity_radius, rough.rms_height
    out = []
    if tip > LARGE_ASPERITY * radius:
        out.append(
            f"the asperities' radius is {tip / radius:.2g} of the body's: the effective radius of "
            f"one that touches is {100.0 * tip / (tip + radius):.0f} % smaller than its own, which "
            "is taken"
        )
    if height > ROUGH * radius:
        out.append(
            f"the rms height is {height / radius:.2g} of the body's radius: above {ROUGH:g} the "
            "paraboloid that stands for the sphere is off where asperities touch"
        )
    overlap = mean_overlap(rough, central)
    told = inputs.yields and overlap > tip  # with the plastic laws' limits
    if overlap > OVERLAP * tip and not told:
        out.append(
            f"the mean overlap of contacting asperities is {overlap / tip:.2g} of their tip radius "
            f"and their contact radius {sqrt(overlap / tip):.2g} of it: their laws hold for "
            f"overlaps below {OVERLAP:g}"
        )
    return out


def _shape(inputs: Inputs, width: float, motion: Motion) -> list[str]:
    """A contact that is not small beside the body."""
    radius, depth = inputs.radius, -float(motion.impacts.closest_approach[0])
    if depth <= DEEP * radius and width <= WIDE * radius:
        return []
    sinks = f"the body sinks in by {100.0 * depth / radius:.0f} % of its radius and "
    return [
        f"{sinks * (depth > 0.0)}the contact radius is {width / radius:.2g} of it: paraboloid and "
        f"half-space are approximations for small indentations (below {100.0 * DEEP:g} % and "
        f"{WIDE:g})"
    ]


def _waves(inputs: Inputs, speed: float) -> list[str]:
    """Impacts too fast for a contact that is quasi-static."""
    slowest, solid = bar_wave_speed((inputs.body, inputs.counterface))
    ratio = speed / slowest
    if ratio <= FAST:
        return []
    factor, power = HUNTER
    share = factor * ratio**power
    cost = f"about {100.0 * share:.0f} % of its energy goes into elastic waves (Hunter 1957)"
    if share >= 1.0:
        cost = "the contact is not quasi-static"
    left_out = (
        "" if inputs.structure.waves or share >= 1.0 else ", which are left out without [waves]"
    )
    return [
        f"the body comes in at {speed:.3g} m/s, {ratio:.2g} of the speed of waves in a bar of "
        f"{named(solid)} ({slowest:.3g} m/s): {cost}{left_out}"
    ]


def first_yield_speed(pressure: float, modulus: float, density: float) -> float:
    """Impact speed [m/s] at which a smooth sphere first yields.

    Hertz's energy at the peak pressure of first yield,
    (8/15) (pi p/2)^5 R^3/E*^4, is that of the motion. With p = 1.6 Y this is
    V^2 = 26 (Y/E*)^4 Y/rho, Johnson, Contact Mechanics (1985), ch. 11.

    Parameters
    ----------
    pressure
        Peak pressure of first yield [Pa].
    modulus
        Contact modulus E* [Pa].
    density
        Of the sphere [kg/m^3].
    """
    return sqrt(0.8 / pi * (0.5 * pi * pressure) ** 5 / (modulus**4 * density))


def first_yield_load(pressure: float, modulus: float, radius: float) -> float:
    """Load [N] at which a smooth sphere first yields: pi^3 p^3 R^2/(6 E*^2), Johnson eq. 6.10.

    Parameters
    ----------
    pressure
        Peak pressure of first yield [Pa].
    modulus
        Contact modulus E* [Pa].
    radius
        Of the sphere [m].
    """
    return pi**3 * pressure**3 * radius**2 / (6.0 * modulus**2)


def _yields(inputs: Inputs, elastic: float, speed: float | None) -> list[str]:
    """A smooth body that would yield in an elastic model: by its speed, or at rest by its load."""
    if inputs.asperities is not None or inputs.yields or inputs.yielding is None:
        return []
    pressure, modulus = inputs.yielding.yield_pressure, inputs.modulus
    if speed is None:
        found, what, unit, told = elastic, "load", "N", "the elastic force is"
        first = first_yield_load(pressure, modulus, inputs.radius)
    else:
        assert inputs.body.density is not None
        found, what, unit, told = speed, "speed", "m/s", "the body comes in at"
        first = first_yield_speed(pressure, modulus, inputs.body.density)
    if found <= first:
        return []
    return [
        f"{told} {found:.3g} {unit}, {found / first:.3g} times the {what} at which a smooth body "
        f"first yields ({first:.3g} {unit}), and this model is elastic: [plasticity] lets it yield"
    ]
