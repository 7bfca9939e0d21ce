"""Elastic waves that a changing force sends into a half-space."""

from __future__ import annotations

from math import pi
from typing import ClassVar, NamedTuple

import numpy as np

from .._jax import jax, jnp
from ..laws.law import Real, quantity
from .external_forces import Along, Drag

_NEWTON = 12  # steps from 0, far more than double precision needs
_POINTS, _WEIGHTS = np.polynomial.legendre.leggauss(48)
_ANGLES = 0.25 * pi * (_POINTS + 1.0)
_SIN, _COS, _SHARES = np.sin(_ANGLES), np.cos(_ANGLES), 0.25 * pi * _WEIGHTS


class Radiated(NamedTuple):
    """What a normal point force radiates, by kind of wave, as factors of 1/(density c_s^3).

    Attributes
    ----------
    compression, shear
        Waves into the depth [-].
    rayleigh
        Waves along the surface [-].
    """

    compression: jax.Array
    shear: jax.Array
    rayleigh: jax.Array

    @property
    def whole(self) -> jax.Array:
        """All three together [-]."""
        return self.compression + self.shear + self.rayleigh


def shear_speed(modulus: Real, poisson: Real, density: Real) -> jax.Array:
    """Speed of shear waves [m/s]: Young's modulus [Pa], Poisson's ratio, density [kg/m^3]."""
    return jnp.sqrt(jnp.asarray(modulus, float) / (2.0 * (1.0 + poisson) * density))


def rayleigh_ratio(poisson: Real) -> jax.Array:
    """Speed of Rayleigh waves over that of shear waves, Poisson's ratio in (-1, 0.5].

    Rayleigh's cubic in the square of it, by Newton's method from 0: the cubic is concave and
    rises from there to its smallest root. Lamb (1904); Johnson (1985), section 11.3.
    """
    ratio = _speed_ratio(poisson)

    x = jnp.zeros_like(ratio)
    for _ in range(_NEWTON):
        value = ((x - 8.0) * x + 24.0 - 16.0 * ratio) * x - 16.0 * (1.0 - ratio)
        x = x - value / ((3.0 * x - 16.0) * x + 24.0 - 16.0 * ratio)
    return jnp.sqrt(x)


def _speed_ratio(poisson: Real) -> jax.Array:
    """Square of the speed of shear waves over that of compression waves."""
    nu = jnp.asarray(poisson, dtype=jnp.float64)
    return (1.0 - 2.0 * nu) / (2.0 - 2.0 * nu)


def radiated(poisson: Real) -> Radiated:
    """Factors g of what a point force F(t) on a half-space radiates, by kind of wave.

    The energy is (g/(density c_s^3)) times the integral of (dF/dt)^2: the part of the surface's
    velocity that is in phase with the force, from Lamb's integral over the slowness s, in units
    of that of shear waves,

        g = Im of the integral of s alpha / [(2 s^2 - 1)^2 - 4 s^2 alpha beta] ds / (2 pi),

    alpha = sqrt(s^2 - c_s^2/c_p^2), beta = sqrt(s^2 - 1). Below the slowness of compression waves
    both kinds of wave go into the depth, up to 1 shear waves alone, and the pole beyond is the
    Rayleigh wave's. Lamb (1904); Miller and Pursey (1954, 1955).

    Parameters
    ----------
    poisson
        Poisson's ratio of the half-space, in (-1, 0.5].
    """
    least = _speed_ratio(poisson)
    # Steep waves, s = sqrt(least) sin(angle): both kinds.
    s2 = least * _SIN**2
    alpha, beta, bend = jnp.sqrt(least) * _COS, jnp.sqrt(1.0 - s2), (2.0 * s2 - 1.0) ** 2
    common = _SHARES * least * _SIN * _COS * alpha / (bend + 4.0 * s2 * alpha * beta) ** 2
    compression = jnp.sum(common * bend)
    steep = jnp.sum(common * 4.0 * s2 * alpha * beta)
    # Flat waves, s^2 from there to 1: shear waves beside a compression that decays.
    s2 = least + (1.0 - least) * _SIN**2
    a2, beta = (1.0 - least) * _SIN**2, jnp.sqrt(1.0 - least) * _COS
    below = (2.0 * s2 - 1.0) ** 4 + 16.0 * s2**2 * a2 * beta**2
    flat = jnp.sum(_SHARES * (1.0 - least) * _SIN * _COS * 4.0 * s2 * a2 * beta / below)
    rayleigh = _residue(least, rayleigh_ratio(poisson) ** -2.0)
    return Radiated(*(part / (2.0 * pi) for part in (compression, steep + flat, rayleigh)))


def _residue(least: jax.Array, s2: jax.Array) -> jax.Array:
    """Pi times the residue at the pole, where s^2 is ``s2``; s cancels against the slope's."""
    alpha, beta = jnp.sqrt(s2 - least), jnp.sqrt(s2 - 1.0)
    slope = 8.0 * (2.0 * s2 - 1.0) - 8.0 * alpha * beta - 4.0 * s2 * (beta / alpha + alpha / beta)
    return pi * alpha / jnp.abs(slope)


class WaveRadiation(Drag):
    """Waves that a contact sends into the half-space below it: a drag on the body.

    Parameters
    ----------
    coefficient
        Energy over the integral of (dF/dt)^2 [J s/N^2].

    Notes
    -----
    First order in the frequency: the contact is small beside the wave length, and the force is
    that of the contact without waves. Along a branch F = F(d), so that dF/dt is the stiffness
    times the speed and the loss that of a drag. Hunter (1957).
    """

    coefficient: Real = quantity()

    name: ClassVar[str] = "waves"
    acts_apart: ClassVar[bool] = False

    @classmethod
    def into(cls, modulus: Real, poisson: Real, density: Real) -> WaveRadiation:
        """Into a half-space: Young's modulus [Pa], Poisson's ratio, density [kg/m^3]."""
        speed = shear_speed(modulus, poisson, density)
        return cls(radiated(poisson).whole / (density * speed**3))

    def resistance(self, along: Along) -> jax.Array:
        return self.drag(along.stiffness, along.bend, along.speed)

    def drag(self, stiffness: jax.Array, bend: jax.Array, speed: jax.Array) -> jax.Array:
        """Force over speed [N s/m], any shape.

        Parameters
        ----------
        stiffness, bend
            First [N/m] and second [N/m^2] derivative of the force with the separation.
        speed
            About how fast the body is [m/s].

        Notes
        -----
        The coefficient times the stiffness is the time in which waves cross the contact, 0.8 of
        its radius over c_s. Where the stiffness changes within that time, next to the snap of a
        bond, the low-frequency limit is none, and the drag is cut off.
        """
        quick = self.coefficient * bend * speed
        return self.coefficient * stiffness**2 / (1.0 + quick**2)


def hertz_share(
    radiation: WaveRadiation, modulus: float, radius: float, mass: float, speed: float
) -> float:
    """Share of the kinetic energy that a Hertz impact radiates, to first order [-].

    Parameters
    ----------
    radiation
        The half-space that it goes to.
    modulus
        Contact modulus E* [Pa].
    radius, mass
        Of the sphere [m], [kg].
    speed
        Impact speed [m/s].

    Notes
    -----
    8 E*^2 R V d^2 (2/5) B(4/5, 3/2) is the integral of (dF/dt)^2, with the largest approach
    d = (15 m V^2/(16 E* sqrt(R)))^(2/5). It grows as V^(3/5). Hunter (1957) with the force of
    Hertz's theory in place of a sine.
    """
    from scipy.special import beta

    deepest = (15.0 * mass * speed**2 / (16.0 * modulus * radius**0.5)) ** 0.4
    rates = 8.0 * modulus**2 * radius * speed * deepest**2 * 0.4 * float(beta(0.8, 1.5))
    return float(radiation.coefficient) * rates / (0.5 * mass * speed**2)
