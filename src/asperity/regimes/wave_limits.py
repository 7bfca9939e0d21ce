"""Waves that a contact radiates, outside the validity of their model: the warnings."""

from __future__ import annotations

from math import sqrt

from ..contact import SmoothContact, SmoothPlasticContact
from ..dynamics import Motion
from ..dynamics.problem import Problem
from ..dynamics.wave_radiation import shear_speed
from ..errors import InputError
from ..inputs import Inputs
from .model_domain import contact_radius

SMALL = 0.1
"""Share of the impact energy, and relative error, up to which the first order is enough."""

SPHERE_MODE = 2.64
"""Lowest spheroidal mode of a sphere [c_s/R] at a Poisson's ratio of 0.25. Lamb (1882)."""

MOST = 0.5
"""Share of a body's largest kinetic energy in waves, above which one that fails is refused."""

_QUASI_STATIC = 0.25  # of that mode: a sphere that is shaken more slowly hardly rings


def wave_warnings(problem: Problem, elastic: float, central: float, motion: Motion) -> list[str]:
    """One line for each way in which radiated waves leave the validity of their model.

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
    if not problem.inputs.structure.waves or not elastic > 0.0:
        return []
    mass, energy = float(problem.body.mass), float(motion.impacts.maximum_kinetic[0])
    # Of a pulse of this force that turns the body back; half a period of it is the contact time.
    rate = elastic / (mass * sqrt(2.0 * energy / mass))
    return [
        *_strong(problem, motion, energy),
        *_wide(problem, elastic, central, rate),
        *_ringing(problem.inputs, rate),
        *_snaps(problem, motion),
    ]


def _strong(problem: Problem, motion: Motion, energy: float) -> list[str]:
    """Waves that change the motion by more than the first order tells."""
    share = _radiated(problem, motion) / energy
    if share <= SMALL:
        return []
    return [
        f"the first impact radiates {100 * share:.2g} % of its energy: waves are computed to first "
        "order, which is off by about as much of itself"
    ]


def _radiated(problem: Problem, motion: Motion) -> float:
    """Energy that the first impact radiates [J]."""
    place = len(problem.contact.mechanisms) + problem.body.mechanisms.index("waves")
    return float(motion.impacts.lost[0, place])


def refuse_stopped(problem: Problem, motion: Motion) -> None:
    """Refuse a body that could not be followed, and that waves take most of the energy of.

    Parameters
    ----------
    problem
        What was built from a case.
    motion
        The motion, which failed.

    Raises
    ------
    InputError
        If its waves are not to be computed to first order.
    """
    if not problem.inputs.structure.waves:
        return
    energy, radiated = float(motion.impacts.maximum_kinetic[0]), _radiated(problem, motion)
    if radiated > MOST * energy:
        raise InputError(
            "[waves] must be absent where waves stop a body that attraction draws on: they take "
            f"{radiated:.3g} J of one that has {energy:.3g} J at most, and are computed to first "
            "order, for bodies that lose little to them",
            key="waves.model",
        )


def _wide(problem: Problem, elastic: float, central: float, rate: float) -> list[str]:
    """A contact that is not small beside the waves."""
    solid = problem.inputs.counterface
    assert solid.density is not None
    speed = float(shear_speed(solid.youngs_modulus, solid.poisson, solid.density))
    half = contact_radius(problem, elastic, central)
    # Waves from a Hertz pressure: 1 - (k a)^2/5 of those from its point force.
    error = (rate * half / speed) ** 2 / 5.0
    if error <= SMALL:
        return []
    return [
        f"shear waves cross the contact's radius ({half * 1e6:.3g} um) in {half / speed:.2g} s and "
        f"the force changes within {1.0 / rate:.2g} s: waves are those of a point force, and "
        f"radiate less by about {100 * min(error, 1.0):.0f} %"
    ]


def _ringing(inputs: Inputs, rate: float) -> list[str]:
    """A sphere that is struck too quickly to stay quasi-static."""
    solid, radius = inputs.body, inputs.radius
    assert solid.density is not None
    speed = float(shear_speed(solid.youngs_modulus, solid.poisson, solid.density))
    if rate <= _QUASI_STATIC * SPHERE_MODE * speed / radius:
        return []
    return [
        f"the force changes within {1.0 / rate:.2g} s and shear waves cross the sphere in "
        f"{2.0 * radius / speed:.2g} s: it is left ringing, and the energy in that is left out"
    ]


def _snaps(problem: Problem, motion: Motion) -> list[str]:
    """Bonds of a smooth body, at which the force jumps."""
    lost = zip(problem.contact.mechanisms, motion.impacts.lost[0], strict=False)
    names = dict.fromkeys(name for name, energy in lost if energy > 0.0 and name != "plastic")
    if not isinstance(problem.contact, SmoothContact | SmoothPlasticContact) or not names:
        return []
    return [
        "the force jumps where a bond forms or breaks: what that radiates is part of the energy "
        f"lost to {' and '.join(names)}, and not counted as waves"
    ]
