"""Liquids that condense into menisci, and a small catalogue of them."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

from asperity.errors import InputError

GAS_CONSTANT = 8.31446261815324
"""Molar gas constant [J/(mol K)]; exact in the SI of 2019."""

AVOGADRO = 6.02214076e23
"""Avogadro constant [1/mol]; exact in the SI of 2019."""

ROOM_TEMPERATURE = 293.15
"""Temperature of the catalogue's values [K]: 20 degC."""


@dataclass(frozen=True)
class Liquid:
    """A liquid that condenses into menisci, at one temperature.

    Parameters
    ----------
    name : str
        What it is called.
    tension : float
        Surface tension against its vapour [N/m].
    molar_volume : float
        Molar volume [m^3/mol].
    density : float or None
        Density [kg/m^3]; None where it is not known.
    source : str
        Where the numbers come from.
    molecule_size : float
        Size of a molecule [m]: a Kelvin radius below it has no meaning.
    tension_law : callable, optional
        Surface tension [N/m] as a function of the temperature [K].
    density_law : callable, optional
        Density [kg/m^3] as a function of the temperature [K].
    temperatures : tuple of float
        Temperatures between which the liquid may be used [K].

    Raises
    ------
    InputError
        Where a number is not positive.
    """

    name: str
    tension: float
    molar_volume: float
    density: float | None = None
    source: str = ""
    molecule_size: float = 0.0
    tension_law: Callable[[float], float] | None = None
    density_law: Callable[[float], float] | None = None
    temperatures: tuple[float, float] = (0.0, math.inf)

    def __post_init__(self) -> None:
        refuse_not_positive("tension", self.tension)
        refuse_not_positive("molar_volume", self.molar_volume)

    def at(self, temperature: float) -> Liquid:
        """The liquid at a temperature [K], as far as its laws reach.

        Raises
        ------
        InputError
            Where the temperature lies outside ``temperatures``.
        """
        low, high = self.temperatures
        if not low <= temperature <= high:
            raise InputError(
                f"`temperature` must lie in [{low:g} K, {high:g} K], where the surface tension of "
                f"{self.name} is known; got {temperature!r} K"
            )
        tension = self.tension_law(temperature) if self.tension_law else self.tension
        if self.density_law is None or self.density is None:
            return replace(self, tension=tension)
        density = self.density_law(temperature)
        volume = self.molar_volume * self.density / density
        return replace(self, tension=tension, density=density, molar_volume=volume)


def refuse_not_positive(name: str, value: float) -> None:
    """Raise `InputError` where a value is not positive and finite."""
    if not (0.0 < value < math.inf):
        raise InputError(f"`{name}` must be positive and finite; got {value!r}")


def kelvin_radius(liquid: Liquid, humidity: float, temperature: float) -> float:
    """Kelvin radius of a liquid in equilibrium with its vapour [m].

    r_k = gamma V_m / (R T ln(1/RH)), positive; eq. 11 of the publication, whose printed sign is
    negative. The tension gamma and the molar volume V_m are those of ``liquid`` as it is: take
    ``liquid.at(temperature)`` for their values at a temperature.

    Parameters
    ----------
    liquid : Liquid
        The liquid that condenses.
    humidity : float
        Vapour pressure over saturated vapour pressure [-], in [0, 1).
    temperature : float
        Temperature [K], above 0.

    Returns
    -------
    float
        Kelvin radius [m]; 0 at a humidity of 0.

    Raises
    ------
    InputError
        Where the humidity lies outside [0, 1) or the temperature is not positive.
    """
    if not 0.0 <= humidity < 1.0:
        raise InputError(f"`humidity` must lie in [0, 1); got {humidity!r}")
    refuse_not_positive("temperature", temperature)
    if humidity == 0.0:
        return 0.0
    energy = GAS_CONSTANT * temperature * -_logarithm(humidity)
    return liquid.tension * liquid.molar_volume / energy


def _logarithm(humidity: Any) -> Any:
    """Logarithm of a humidity, or of those of many cases."""
    if isinstance(humidity, float):
        return math.log(humidity)
    import numpy as np  # here: reading a case needs none of it

    return np.log(humidity)


def water_tension(temperature: float) -> float:
    """Surface tension of water [N/m] at a temperature [K]. IAPWS R1-76(2014), eq. 1."""
    reduced = 1.0 - temperature / 647.096
    return 235.8e-3 * reduced**1.256 * (1.0 - 0.625 * reduced)


def water_density(temperature: float) -> float:
    """Density of water at 101.325 kPa [kg/m^3] at a temperature [K].

    Kell, J. Chem. Eng. Data 20, 97 (1975), for 0 to 150 degC.
    """
    t = temperature - 273.15
    polynomial = 105.56302e-9 + t * -280.54253e-12
    for coefficient in (-46.170461e-6, -7.9870401e-3, 16.945176, 999.83952):
        polynomial = coefficient + t * polynomial
    return polynomial / (1.0 + 16.879850e-3 * t)


_WATER_MOLAR_MASS = 18.015268e-3
_JASPER = "tension: Jasper, J. Phys. Chem. Ref. Data 1, 841 (1972), linear in the temperature"
_CRC = "CRC Handbook of Chemistry and Physics"


def _water() -> Liquid:
    density = water_density(ROOM_TEMPERATURE)
    return Liquid(
        "water",
        tension=water_tension(ROOM_TEMPERATURE),
        molar_volume=_WATER_MOLAR_MASS / density,
        density=density,
        source=(
            "tension: IAPWS R1-76(2014); density: Kell, J. Chem. Eng. Data 20, 97 (1975); "
            "values at 20 degC, and at a case's own temperature in its run"
        ),
        molecule_size=0.28e-9,
        tension_law=water_tension,
        density_law=water_density,
        temperatures=(273.15, 373.15),
    )


def _organic(name: str, at_zero: float, slope: float, mass: float, density: float) -> Liquid:
    """A liquid by Jasper's line: tension [mN/m] at 0 degC, its slope [mN/(m K)]; mass [g/mol]."""

    def tension(temperature: float) -> float:
        return (at_zero - slope * (temperature - 273.15)) * 1e-3

    volume = mass * 1e-3 / density
    return Liquid(
        name,
        tension=tension(ROOM_TEMPERATURE),
        molar_volume=volume,
        density=density,
        source=f"{_JASPER}; density at 20 degC: {_CRC}; molecule: cube root of its volume",
        molecule_size=(volume / AVOGADRO) ** (1.0 / 3.0),
        tension_law=tension,
        temperatures=(293.15, 333.15),
    )


LIQUIDS: dict[str, Liquid] = {
    liquid.name: liquid
    for liquid in (
        _water(),
        _organic("ethanol", 24.05, 0.0832, 46.068, 789.3),
        _organic("n-octane", 23.52, 0.09509, 114.229, 702.5),
        _organic("n-hexadecane", 29.18, 0.0854, 226.441, 773.3),
        _organic("toluene", 30.90, 0.1189, 92.139, 866.8),
    )
}
"""The liquids that a case can name."""
