"""What a user must know before believing a result: regimes outside a model's validity."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from ..dynamics import Motion
from ..dynamics.curve_table import ATTRACTION, CENTRAL, CONTACTING, FORCE, read_row
from ..dynamics.problem import Problem
from ..dynamics.stepped_series import Trajectory
from ..dynamics.time_series import sample
from ..errors import InputError
from ..inputs import Inputs
from . import DMT_BELOW, JKR_ABOVE, LAW_NAMES, Regime, choose_adhesion, tabor_number
from .accuracy import fall_warnings, ledger_warnings, ring_warnings
from .ambient import gas_warnings, liquid_warnings
from .few_asperities import few_warnings
from .model_domain import contact_radius, covered_share, domain_warnings
from .plastic_validity import yielded
from .wave_limits import wave_warnings

APART = 1e-6
"""Share of its value at closest approach below which a contact force counts as none."""

YIELDS_ABOVE = 1.0
"""Plasticity index above which asperities yield (Greenwood and Williamson 1966)."""

CLASSED = 5e-3
"""Relative error of bonds' work from which classes of tip radius are too few."""


class AtDepth(NamedTuple):
    """The contact at closest approach of the first impact.

    Attributes
    ----------
    contacting
        Expected number of contacting asperities.
    elastic
        Elastic part of the force [N].
    central
        Separation of the deformed mean planes at the axis [m].
    """

    contacting: float
    elastic: float
    central: float

    @classmethod
    def of(cls, motion: Motion, trajectory: Trajectory | None = None) -> AtDepth:
        """Read off the curve of first approach, or off a motion that was stepped in time."""
        deepest = float(motion.impacts.closest_approach[0])
        if trajectory is None:
            row = read_row(motion.table, 0, deepest)
        else:
            row = trajectory.rows[np.argmin(np.abs(trajectory.separation - deepest))]
        elastic = row[FORCE] - row[ATTRACTION]
        return cls(float(row[CONTACTING]), float(elastic), float(row[CENTRAL]))


def warnings_of(problem: Problem, regime: Regime, at_depth: AtDepth, motion: Motion) -> list[str]:
    """One line for each way in which a case leaves the validity of its models.

    Parameters
    ----------
    problem
        What was built from a case.
    regime
        Its dimensionless numbers.
    at_depth
        The contact at closest approach.
    motion
        The motion.
    """
    inputs = problem.inputs
    return [
        *_surface(problem),
        *few_warnings(problem, regime, at_depth.central, motion),
        *_covered(inputs, at_depth),
        *_publication(inputs),
        *_adhesion(regime, inputs.border_warnings, inputs.yields),
        *yielded(inputs, at_depth.central),
        *liquid_warnings(inputs, regime),
        *gas_warnings(inputs, at_depth.central, motion),
        *wave_warnings(problem, at_depth.elastic, at_depth.central, motion),
        *domain_warnings(problem, at_depth.elastic, at_depth.central, motion),
        *fall_warnings(problem, motion),
        *ring_warnings(problem, motion),
        *ledger_warnings(problem, motion),
    ]


def _surface(problem: Problem) -> list[str]:
    """What the reading of measured surfaces says, and what classes of radius cost."""
    rough = problem.inputs.asperities
    if rough is None:
        return []
    out = list(rough.warnings)
    off, classes = problem.class_error, problem.inputs.radius_classes
    if abs(off) > CLASSED:
        out.append(
            f"{classes} classes of tip radius make the work of bonds {100 * abs(off):.2g} % too "
            f"{'small' if off < 0.0 else 'large'}: raise `radius_classes`"
        )
    return out + _one_law(problem.inputs)


def _one_law(inputs: Inputs) -> list[str]:
    """A line where the law chosen for the mean tip radius would not be chosen for all tips."""
    rough, used = inputs.asperities, inputs.structure
    chosen = inputs.adhesion_reason is not None
    if not chosen or rough is None or rough.summits is None or used.heights != "summits":
        return []
    work, spacing = inputs.work_of_adhesion, inputs.equilibrium_spacing
    ends = np.quantile(rough.summits.radii, (0.05, 0.95))
    laws = [choose_adhesion(tabor_number(tip, work, inputs.modulus, spacing)).law for tip in ends]
    if laws == [used.adhesion] * 2:
        return []
    names = " and ".join(LAW_NAMES[law] for law in dict.fromkeys(laws))
    return [
        f"the {LAW_NAMES[used.adhesion]} law was chosen for the mean tip radius: between "
        f"radii of {ends[0] * 1e9:.3g} and {ends[1] * 1e9:.3g} nm (5 to 95 % of the "
        f"summits) it would be {names}"
    ]


def check_surface(problem: Problem, at_depth: AtDepth) -> None:
    """Refuse a measured surface that is smaller than the contact.

    The contact is as wide as where the highest summit still touches at closest approach, or as
    Hertz's.

    Raises
    ------
    InputError
        If it is.
    """
    rough = problem.inputs.asperities
    if rough is None or rough.surface is None or rough.summits is None:
        return
    highest = float(rough.summits.heights.max())
    width = 2.0 * contact_radius(problem, at_depth.elastic, at_depth.central, highest)
    side = min(rough.surface.physical_size)
    if width > side:
        raise InputError(
            "`files` must hold surfaces larger than the contact, which is "
            f"{width * 1e6:.3g} um wide at closest approach, or what is rough on its scale was "
            f"not measured; got {side * 1e6:.3g} um ({rough.surface.source})",
            key="roughness.files",
        )


def _covered(inputs: Inputs, at_depth: AtDepth) -> list[str]:
    rough = inputs.asperities
    share = 0.0 if rough is None else covered_share(rough, at_depth.central)
    if share <= 0.1:
        return []
    return [
        f"contacting asperities cover {100 * share:.0f} % of the area at the axis at closest "
        "approach: neighbours interact, which the sum over single asperities leaves out"
    ]


def release_warnings(contact_end: float) -> list[str]:
    """A line where a body is released within the end of contact [m], which is NaN then."""
    if np.isfinite(contact_end):
        return []
    return [
        "the body is released within the end of contact, where the force is 1e-6 of its peak: "
        "restitution and capture are judged from the static equilibrium"
    ]


def _publication(inputs: Inputs) -> list[str]:
    assumed = inputs.published
    if assumed is None:
        return []
    pulls = "adhesion and menisci pull only while the bodies part, " * (
        assumed.attraction_during_retraction_only
    )
    factor = assumed.capillary_factor
    menisci = f", and menisci pull {factor:g} times as much as their equation says" * (
        inputs.liquid is not None and factor != 1.0
    )
    return [
        f"[publication] follows a paper, not physics: {pulls}nothing acts beyond "
        f"{assumed.conjunction_ends:g} rms heights{menisci}"
    ]


def _adhesion(regime: Regime, border_warnings: Sequence[str], yields: bool) -> list[str]:
    out = list(border_warnings)
    psi, mu = regime.plasticity_index, regime.tabor_number
    if psi is not None and psi > YIELDS_ABOVE and not yields:
        out.append(
            f"the plasticity index is {psi:.3g}: above {YIELDS_ABOVE:g} the asperities yield, and "
            "this model keeps them elastic"
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


def slow_menisci(
    problem: Problem, motion: Motion, trajectory: Trajectory | None = None
) -> list[str]:
    """A line where menisci take longer to form than the first contact lasts.

    Parameters
    ----------
    problem
        What was built from a case.
    motion
        Its motion.
    trajectory
        The same in time; without it all menisci formed at once.
    """
    if problem.delayed is None:
        return []
    time = float(problem.delayed.time)
    if trajectory is None:
        series = sample(problem.body, motion.table, motion.impacts)
    else:
        series = trajectory
    force = np.abs(series.rows[:, FORCE])
    there = force > APART * np.abs(motion.impacts.force[0])
    held = series.time[(series.phase < 2) & there]
    if held.size == 0 or time <= held[-1] - held[0]:
        return []
    return [
        f"menisci take {time:.3g} s to form and the first contact lasts {held[-1] - held[0]:.3g} "
        "s: few form, and more energy may go into those few than if all had formed at once"
    ]
