"""What a mean says of single bodies, where few asperities carry them or capture is near."""

from __future__ import annotations

import numpy as np

from ..dynamics import Motion
from ..dynamics.problem import Problem
from ..inputs import Inputs
from .dimensionless_numbers import Regime
from .error_of_mean import losses_of_bodies, mean_is_enough
from .loaded_asperities import LOADED_FOR_A_MEAN, clustering
from .verdicts import CARRIED


def few_warnings(problem: Problem, regime: Regime, central: float, motion: Motion) -> list[str]:
    """A line where a mean stands alone that says too little of single bodies.

    Parameters
    ----------
    problem, regime, motion
        As for :func:`asperity.regimes.validity.warnings_of`.
    central
        Separation of the deformed mean planes at the axis, at closest approach [m].
    """
    inputs = problem.inputs
    if inputs.placement is not None or not bodies_differ(problem, regime, central, motion):
        return []
    advice = "" if inputs.beside is None else "; `asperity run` has single bodies beside it"
    return [_few(regime.contacting_asperities or 0.0, regime.loaded_asperities or 0.0) + advice]


def bodies_differ(problem: Problem, regime: Regime, central: float, motion: Motion) -> bool:
    """Whether a mean over asperities says too little of single bodies.

    Parameters
    ----------
    problem, regime, central, motion
        As for :func:`few_warnings`.
    """
    loaded, impacts, inputs = regime.loaded_asperities, motion.impacts, problem.inputs
    if not loaded:
        return False  # without asperities, or where gas or a spring keeps bodies away from them
    energy = float(impacts.maximum_kinetic[0])
    lost = np.asarray(impacts.lost[0])[: len(names := problem.contact.mechanisms)]
    filled = inputs.structure.liquid == "kelvin-filling"  # no asperity bears that liquid
    bonds = float(np.sum(lost, where=[not (filled and name == "capillary") for name in names]))
    closest = float(impacts.closest_approach[0])
    potential = problem.body.plain.load.potential(closest)
    left = float(impacts.leaving[0]) - float(potential)
    left = left if np.isfinite(left) else energy - bonds
    if inputs.published is not None or not bonds > 0.0:
        # Without laws of one asperity, or with nothing that scatters.
        return loaded < LOADED_FOR_A_MEAN
    # Where few carry the load too: then no case that a slider moves to compiles it.
    losses = losses_of_bodies(inputs, central, regime.contacting_asperities or 0.0)
    differ = not mean_is_enough(loaded, losses, left / energy, bonds / energy)
    placed = inputs.with_bodies().placement
    if differ or inputs.structure.deformation != "rigid" or placed is None or not placed.measured:
        return differ
    assert inputs.asperities is not None
    share = clustering(inputs.asperities, inputs.radius, closest)
    losses = losses.fewer(share)
    return not mean_is_enough(share * loaded, losses, left / energy, bonds / energy)


def _few(contacting: float, loaded: float) -> str:
    """What such a mean means."""
    if contacting < 1.0:
        return (
            f"only {contacting:.2g} asperities are expected to touch at closest approach, but "
            f"{CARRIED}: the numbers are means over many bodies, which none of them shows"
        )
    return (
        f"{contacting:.2g} asperities are expected to touch at closest approach, and {loaded:.2g} "
        "of them carry the load, effectively: the result is a mean over many places, and single "
        "bodies differ from it"
    )


def pull_warnings(inputs: Inputs, pull_off: float, held: float) -> list[str]:
    """A line where fewer than one asperity is expected to hold at pull-off.

    Parameters
    ----------
    inputs
        The quantities of a case.
    pull_off
        Pull-off force [N].
    held
        Expected number of asperities that touch or are bonded there.
    """
    if inputs.asperities is None or not pull_off > 0.0 or held >= 1.0 or inputs.placement:
        return []
    if inputs.structure.liquid == "kelvin-filling":
        return []  # liquid between the mean planes holds the body, and no bond of an asperity
    return [
        f"at pull-off {held:.2g} asperities are expected to hold the body: pull-off force and work "
        "of separation are means over many bodies, most of which nothing holds"
    ]
