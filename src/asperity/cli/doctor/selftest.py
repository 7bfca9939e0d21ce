"""A self-test: known values of the physics beside what is computed here."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from math import gamma, inf, log, pi, sqrt

import numpy as np

from asperity._jax import jax, jnp
from asperity.config import Case, builtin
from asperity.config.resolve import resolve
from asperity.dynamics import Motion
from asperity.integration import first_impact
from asperity.laws import Jkr
from asperity.model import build
from asperity.numerics.compilation import AT_ONCE, Program
from asperity.numerics.height_integrals import height_integrals

LOSSLESS = {"capillary.contact_angle": "89.99999999 deg", "adhesion.work": "1e-9 J/m^2"}
"""Menisci and adhesion that hardly pull: nothing is left that takes energy."""

DECREMENT = 0.5194
"""First logarithmic decrement of the case ``published`` in the publication's Table 2."""

_ORDERS = (0.0, 0.5, 1.0, 1.5, 2.0, 2.5)
_RADIUS, _MODULUS, _WORK = 1e-6, 1e10, 0.05  # of a soft sphere: [m], [Pa], [J/m^2]
_CYCLE = 7.092196  # work of a JKR cycle in units of (w^5 R^4/E*^2)^(1/3)


@dataclass(frozen=True)
class Check:
    """A known value beside the computed one.

    Parameters
    ----------
    name : str
        What is known.
    source : str
        Where the known value comes from.
    off : float
        How far the computed value is from it, relative [-].
    limit : float
        How far it may be.
    fault : str or None
        Why nothing could be computed; None where it could.
    """

    name: str
    source: str
    off: float
    limit: float
    fault: str | None = None

    @property
    def ok(self) -> bool:
        """Whether they agree."""
        return self.fault is None and self.off <= self.limit

    @property
    def words(self) -> str:
        """How far they agree."""
        return self.fault or f"off by {self.off:.1e}, {self.limit:.0e} allowed"


def checked(name: str, source: str, limit: float, off: Callable[[], float]) -> Check:
    """A check; one that cannot be computed has the reason as its fault."""
    try:
        return Check(name, source, off(), limit)
    except Exception as error:  # noqa: BLE001 - whatever is broken here is what is looked for
        return Check(name, source, inf, limit, " ".join(f"{type(error).__name__}: {error}".split()))


def checks() -> Iterator[Check]:
    """All checks, one after the other; one that fails or breaks does not end them."""
    yield checked("height integrals", "moments of half a Gaussian", 1e-12, _height_integrals)
    yield checked("JKR pull-off force", "1.5 pi w R: Johnson et al. 1971", 1e-6, _pull_off)
    yield checked("JKR work of a cycle", "fold of the same equations", 1e-6, _cycle)
    yield checked("restitution without losses", "1", 1e-8, _conservative)
    yield checked("energy of an impact", "its conservation", 1e-6, _ledger)
    yield checked("decrement of `published`", f"{DECREMENT}: its Table 2", 0.02, _decrement)


def _known() -> tuple[jax.Array, ...]:
    """Height integrals at 0, the largest pull of a JKR contact, and its energies."""
    law = Jkr(radius=_RADIUS, modulus=_MODULUS, work_of_adhesion=_WORK)
    gaps = jnp.linspace(0.0, law.breaking_gap, 20001)
    return (
        height_integrals(_ORDERS, jnp.zeros((len(_ORDERS), 1)))[:, 0],
        -jnp.min(law.bonded_force(gaps)),
        law.bonded_energy(jnp.stack([jnp.zeros(()), law.breaking_gap])),
    )


_values = Program(_known, AT_ONCE)


def _height_integrals() -> float:
    """At 0 the integral of order n is 2^(n/2) gamma((n+1)/2) / (2 sqrt(pi))."""
    found = np.asarray(_values()[0])
    known = [2.0 ** (n / 2.0) * gamma((n + 1.0) / 2.0) / (2.0 * sqrt(pi)) for n in _ORDERS]
    return float(np.max(np.abs(found / known - 1.0)))


def _pull_off() -> float:
    return abs(float(_values()[1]) / (1.5 * pi * _WORK * _RADIUS) - 1.0)


def _cycle() -> float:
    """What making the bond at gap 0 and breaking it at its fold lose together."""
    made, broken = np.asarray(_values()[2])
    scale = (_WORK**5 * _RADIUS**4 / _MODULUS**2) ** (1.0 / 3.0)
    return abs(float(broken - made) / scale / _CYCLE - 1.0)


def _conservative() -> float:
    """The body returns to its release; the restitution is the root of the heights' ratio."""
    fall, rise = _heights(builtin("published").replace(LOSSLESS))
    return abs(sqrt(rise / fall) - 1.0)


def _decrement() -> float:
    fall, rise = _heights(builtin("published"))
    return abs(log(fall / rise) / DECREMENT - 1.0)


def _heights(case: Case) -> tuple[float, float]:
    """Heights [m] above the static equilibrium, of the release and of the first apex."""
    motion = _motion(case)
    reference = float(motion.reference.equilibrium)
    release = float(build(resolve(case)).body.release)
    return release - reference, float(motion.impacts.apex[0]) - reference


def _ledger() -> float:
    impacts = _motion(builtin("published")).impacts
    return float(impacts.energy_balance_error[0] / impacts.maximum_kinetic[0])


def _motion(case: Case) -> Motion:
    return first_impact(build(resolve(case)))[1]
