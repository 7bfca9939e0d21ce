"""Which models hold in a case, by the depth of its first impact."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, NamedTuple

from .. import regimes
from ..dynamics import Motion
from ..dynamics.problem import Problem
from ..regimes.few_asperities import pull_warnings
from ..regimes.liquid_regime import liquid_state
from ..regimes.validity import (
    AtDepth,
    check_surface,
    release_warnings,
    slow_menisci,
    warnings_of,
)


class Assessment(NamedTuple):
    """Which models hold in a case, at the deepest point of its first impact.

    Attributes
    ----------
    name
        What the case is called.
    regime
        Its dimensionless numbers.
    verdicts
        What each number says, by the number's name.
    warnings
        What to know before the case is believed.
    """

    name: str
    regime: regimes.Regime
    verdicts: dict[str, regimes.Verdict]
    warnings: list[str]


def assessment_of(name: str, problem: Problem, motion: Motion) -> Assessment:
    """What a case's numbers say, from a motion of one impact.

    Parameters
    ----------
    name
        What to call it.
    problem
        What was built from a case, with the contact that it was integrated with.
    motion
        The motion.
    """
    at_depth = AtDepth.of(motion)
    check_surface(problem, at_depth)
    regime = regime_of(problem, at_depth)
    said = regimes.verdicts(problem.inputs, regime, at_depth.contacting)
    warnings = warnings_of(problem, regime, at_depth, motion)
    warnings += slow_menisci(problem, motion)
    return Assessment(name, regime, said, warnings)


def measured_warnings(
    problem: Problem,
    regime: regimes.Regime,
    at_depth: AtDepth,
    motion: Motion,
    measures: Mapping[str, Any],
) -> list[str]:
    """One line for each way in which a motion that was measured leaves the validity of its models.

    Parameters
    ----------
    problem, regime, at_depth, motion
        The case, its numbers, its contact at closest approach and its motion.
    measures
        Its :class:`~asperity.results.measures.Measures`, by name.
    """
    pull_off, held, contact_end = (
        float(measures[name]) for name in ("pull_off", "held_at_pull_off", "contact_end")
    )
    return [
        *warnings_of(problem, regime, at_depth, motion),
        *pull_warnings(problem.inputs, pull_off, held),
        *(release_warnings(contact_end) if measures["touched"] else ()),
    ]


def regime_of(problem: Problem, at_depth: AtDepth) -> regimes.Regime:
    """The dimensionless numbers of a case, by its contact at closest approach."""
    inputs = problem.inputs
    rough, soft, tip = inputs.asperities, inputs.yielding, inputs.tip_radius
    work, spacing = inputs.work_of_adhesion, inputs.equilibrium_spacing
    tabor = plasticity = load = None
    if work and spacing:
        tabor = regimes.tabor_number(tip, work, inputs.modulus, spacing)
    if rough is not None and soft is not None:
        plasticity = regimes.plasticity_index(
            inputs.modulus, soft.hardness, rough.rms_height, rough.asperity_radius
        )
    contacting = max(at_depth.contacting, 0.0)  # far apart, a polynomial may say a little less
    if work and contacting > 0.0:
        load = regimes.load_parameter(at_depth.elastic, contacting, work, tip)
    elasticity = None if tabor is None else regimes.ELASTICITY_PER_TABOR * tabor
    return regimes.Regime(
        tabor, elasticity, plasticity, load, inputs.structure.adhesion, inputs.adhesion_reason,
        *liquid_state(inputs, at_depth.central), None if rough is None else contacting,
        None if rough is None else regimes.loaded_asperities(
            rough, contacting, at_depth.central, measured=inputs.structure.heights == "summits"
        ),
    )  # fmt: skip
