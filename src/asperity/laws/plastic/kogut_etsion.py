"""Yielding sphere by power laws fitted to finite elements."""

from __future__ import annotations

from math import log, pi

from ..._jax import jax, jnp
from ..law import Real, quantity
from .plastic_contact import EtsionUnloading, power

_CORNER, _LAST = 6.0, 110.0  # over the critical overlap: change of fit, end of the published range
_UPPER, _UPPER_EXPONENT = 1.40, 1.263
_LOWER_EXPONENT = log(_UPPER * _CORNER**_UPPER_EXPONENT) / log(_CORNER)  # 1.4508
_PRESSED = _UPPER * _LAST ** (_UPPER_EXPONENT - 1.0)  # force over overlap beyond the range


def _integrals() -> list[tuple[float, float, float]]:
    """Coefficient, exponent and constant of the work on each branch, each where one ends."""
    branches = ((0.0, 1.0, 1.5), (1.0, 1.0, _LOWER_EXPONENT), (_CORNER, _UPPER, _UPPER_EXPONENT),
                (_LAST, _PRESSED, 1.0))  # fmt: skip
    rows: list[tuple[float, float, float]] = []
    for start, coefficient, exponent in branches:
        order = exponent + 1.0
        before = rows[-1][0] * start ** rows[-1][1] + rows[-1][2] if rows else 0.0
        rows.append((coefficient / order, order, before - coefficient / order * start**order))
    return rows


_WORK = _integrals()


class KogutEtsion(EtsionUnloading):
    """Kogut and Etsion's contact of an elastic, perfectly plastic sphere and a rigid plane.

    Parameters
    ----------
    radius
        Radius at the tip [m].
    modulus
        Contact modulus E* [Pa].
    hardness
        Hardness H of the body that yields [Pa], 2.8 times its yield strength.
    poisson
        Poisson ratio of that body.

    Notes
    -----
    With K = 0.454 + 0.41 poisson, the critical overlap d = (pi K H/(2 E*))^2 radius, and x
    the overlap over d, the force is (2/3) pi K H radius d times x^1.5 up to 1, 1.03 x^1.425
    from 1 to 6, 1.40 x^1.263 from 6 to 110. Kogut and Etsion (2002).

    Those constants jump by 3.0 % at 1 and by 1.7 % at 6. Here the force is continuous: from
    1 to 6 it is x^1.4508, which meets both neighbours and departs from the published branch
    by at most 3.0 %, at 1. Beyond 110 the force grows like the overlap: 4.82 x. The hardness
    times the truncated area 2 pi radius overlap, the limit of full plasticity, is 3 x/K: for
    a Poisson ratio of 0.3 the law lies 7.3 % below it, for 0.5 it lies 5.9 % above.
    """

    hardness: Real = quantity()
    poisson: Real = quantity()

    @property
    def pressure_coefficient(self) -> jax.Array:
        """K: the largest Hertz pressure when yield begins, over the hardness."""
        return 0.454 + 0.41 * self.poisson

    @property
    def yield_overlap(self) -> jax.Array:
        strain = pi * self.pressure_coefficient * self.hardness / (2.0 * self.modulus)
        return strain**2 * self.radius

    @property
    def kinks(self) -> tuple[jax.Array, ...]:
        critical = self.yield_overlap
        return critical, _CORNER * critical, _LAST * critical

    def loading_force(self, overlap: jax.Array) -> jax.Array:
        x = overlap / self.yield_overlap
        beyond = [x <= 1.0, x <= _CORNER, x <= _LAST]
        coefficient = jnp.select(beyond, [1.0, 1.0, _UPPER], _PRESSED)
        exponent = jnp.select(beyond, [1.5, _LOWER_EXPONENT, _UPPER_EXPONENT], 1.0)
        return self._critical_force * coefficient * power(x, exponent)

    def loading_work(self, overlap: jax.Array) -> jax.Array:
        x = overlap / self.yield_overlap
        below = [x <= 1.0, x <= _CORNER, x <= _LAST]
        coefficient, order, rest = (
            jnp.select(below, list(row[:-1]), row[-1]) for row in zip(*_WORK, strict=True)
        )
        work = coefficient * power(x, order) + rest
        return self._critical_force * self.yield_overlap * work

    def published_force(self, overlap: jax.Array) -> jax.Array:
        """First loading [N] with the published constants, which jump; beyond 110 as here."""
        x = overlap / self.yield_overlap
        between = 1.03 * self._critical_force * power(x, 1.425)
        return jnp.where((x > 1.0) & (x <= _CORNER), between, self.loading_force(overlap))

    @property
    def _critical_force(self) -> jax.Array:
        return self._stiffness * self.yield_overlap**1.5
