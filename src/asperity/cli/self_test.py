"""A self-test: known values of the physics beside what is computed here."""

from __future__ import annotations

from collections.abc import Callable
from math import gamma, log, pi, sqrt

import numpy as np

from asperity._jax import jax, jnp
from asperity.config import Case, builtin
from asperity.config.resolve import resolve
from asperity.integration import first_impact
from asperity.laws import Jkr
from asperity.model import build
from asperity.numerics.compilation import AT_ONCE, Program
from asperity.numerics.height_integrals import height_integrals

Check = tuple[str, str, float, Callable[[], float]]
"""What is known, its source, how far off it may be, and how far off it is (both relative)."""

LOSSLESS = {"capillary.contact_angle": "89.99999999 deg", "adhesion.work": "1e-9 J/m^2"}
"""Menisci and adhesion that hardly pull: nothing is left that takes energy."""

DECREMENT = 0.5194
"""First logarithmic decrement of the case ``published`` in the publication's Table 2."""

_ORDERS = (0.0, 0.5, 1.0, 1.5, 2.0, 2.5)
_SOFT = Jkr(radius=1e-6, modulus=1e10, work_of_adhesion=0.05)
_CYCLE = 7.092196  # work of a JKR cycle in units of (w^5 R^4/E*^2)^(1/3)


def _known() -> tuple[jax.Array, ...]:
    """Height integrals at 0, the largest pull of a JKR contact, and the loss of its bond."""
    gaps = jnp.linspace(0.0, _SOFT.breaking_gap, 20001)
    made, broken = _SOFT.bonded_energy(jnp.stack([jnp.zeros(()), _SOFT.breaking_gap]))
    at_0 = height_integrals(_ORDERS, jnp.zeros((len(_ORDERS), 1)))[:, 0]
    return at_0, -jnp.min(_SOFT.bonded_force(gaps)), broken - made


_values = Program(_known, AT_ONCE)


def _height_integrals() -> float:
    """At 0 the integral of order n is 2^(n/2) gamma((n+1)/2) / (2 sqrt(pi))."""
    known = [2.0 ** (n / 2.0) * gamma((n + 1.0) / 2.0) / (2.0 * sqrt(pi)) for n in _ORDERS]
    return float(np.max(np.abs(np.asarray(_values()[0]) / known - 1.0)))


def _pull_off() -> float:
    return abs(float(_values()[1]) / (1.5 * pi * 0.05 * 1e-6) - 1.0)


def _cycle() -> float:
    return abs(float(_values()[2]) / (0.05**5 * 1e-24 / 1e20) ** (1.0 / 3.0) / _CYCLE - 1.0)


def _conservative() -> float:
    """The body returns to its release; the restitution is the root of the heights' ratio."""
    fall, rise, _ = _first_impact(builtin("published").replace(LOSSLESS))
    return abs(sqrt(rise / fall) - 1.0)


def _decrement() -> float:
    fall, rise, _ = _first_impact(builtin("published"))
    return abs(log(fall / rise) / DECREMENT - 1.0)


def _ledger() -> float:
    return _first_impact(builtin("published"))[2]


def _first_impact(case: Case) -> tuple[float, float, float]:
    """Heights of release and first apex above rest [m], and the relative error of the ledger."""
    problem = build(resolve(case))
    _, motion = first_impact(problem)
    rest, impacts = float(motion.reference.equilibrium), motion.impacts
    fall, rise = float(problem.body.release) - rest, float(impacts.apex[0]) - rest
    return fall, rise, float(impacts.energy_balance_error[0] / impacts.maximum_kinetic[0])


CHECKS: tuple[Check, ...] = (
    ("height integrals", "moments of half a Gaussian", 1e-12, _height_integrals),
    ("JKR pull-off force", "1.5 pi w R: Johnson et al. 1971", 1e-6, _pull_off),
    ("JKR work of a cycle", "fold of the same equations", 1e-6, _cycle),
    ("restitution without losses", "1", 1e-8, _conservative),
    ("energy of an impact", "its conservation", 1e-6, _ledger),
    ("decrement of `published`", f"{DECREMENT}: its Table 2", 0.02, _decrement),
)
