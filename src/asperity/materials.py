"""Solids and liquids, and a small catalogue of them: every number with its source."""

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

HARDNESS_PER_YIELD_STRENGTH = 2.8
"""Indentation hardness over yield strength [-]. Tabor, The Hardness of Metals (1951)."""


@dataclass(frozen=True)
class Solid:
    """An isotropic elastic solid.

    Parameters
    ----------
    name : str
        What it is called.
    youngs_modulus : float
        Young's modulus [Pa].
    poisson : float
        Poisson's ratio [-], in (-1, 0.5].
    density : float or None
        Density [kg/m^3]; None where it is not known (a counterface needs none).
    hardness : float or None
        Indentation hardness [Pa], at least the yield strength; None where it is not known.
    yield_strength : float or None
        Yield strength in uniaxial tension [Pa]; None where it is not known.
    source : str
        Where the numbers come from.

    Raises
    ------
    InputError
        Where a number lies outside its range.
    """

    name: str
    youngs_modulus: float
    poisson: float
    density: float | None = None
    hardness: float | None = None
    yield_strength: float | None = None
    source: str = ""

    def __post_init__(self) -> None:
        _positive("youngs_modulus", self.youngs_modulus)
        if not -1.0 < self.poisson <= 0.5:
            raise InputError(f"`poisson` must lie in (-1, 0.5]; got {self.poisson!r}")
        for name in ("density", "hardness", "yield_strength"):
            if getattr(self, name) is not None:
                _positive(name, getattr(self, name))
        refuse_softer_than_yield(self.hardness, self.yield_strength)


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
        _positive("tension", self.tension)
        _positive("molar_volume", self.molar_volume)

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


def _positive(name: str, value: float) -> None:
    if not (0.0 < value < math.inf):
        raise InputError(f"`{name}` must be positive and finite; got {value!r}")


def refuse_softer_than_yield(
    hardness: float | None, yield_strength: float | None, *, key: str = "hardness"
) -> None:
    """Raise `InputError` where a hardness is below a yield strength [Pa]; None is not known."""
    if hardness is not None and yield_strength is not None and hardness < yield_strength:
        raise InputError(
            f"`hardness` must be at least the yield strength ({yield_strength / 1e6:.6g} MPa), "
            f"since a dent is made by yielding; got {hardness / 1e6:.6g} MPa",
            key=key,
        )


def contact_modulus(a: Solid, b: Solid) -> float:
    """Contact modulus E* of two solids [Pa]: 1/E* = (1 - nu_a^2)/E_a + (1 - nu_b^2)/E_b.

    Parameters
    ----------
    a, b : Solid
        The two solids; their order does not matter.

    Returns
    -------
    float
        E* [Pa]. Johnson, Contact Mechanics (1985), section 4.2.
    """
    return 1.0 / ((1.0 - a.poisson**2) / a.youngs_modulus + (1.0 - b.poisson**2) / b.youngs_modulus)


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
    _positive("temperature", temperature)
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
_PUBLICATION = '"Effect of Surface Topography upon Micro-Impact Dynamics", Table 1'
_CALLISTER = "Callister, Fundamentals of Materials Science and Engineering, Appendix B"


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


def _solids() -> tuple[Solid, ...]:
    """Name, modulus [Pa], Poisson's ratio, density [kg/m^3], hardness, yield [Pa], source."""
    sample = f"modulus, ratio: {_PUBLICATION}"
    assumed = "density: assumed, as fused silica; hardness: assumed, usual for fused silica"
    dense = "a sample far below the 415 GPa of dense ceramic; density: that of the ceramic"
    crystal = "mean (Voigt-Reuss-Hill) of a crystal: Wachtman et al., J. Res. NBS 64A, 213 (1960)"
    poly = "polycrystal: Hopcroft, Nix, Kenny, J. Microelectromech. Syst. 19, 229 (2010)"
    anstis = "Vickers: Anstis et al., J. Am. Ceram. Soc. 64, 533 (1981)"
    silicone = "Sylgard 184: Johnston et al., J. Micromech. Microeng. 24, 035017 (2014), 1.32 to"
    dowling = "Dowling, Mechanical Behavior of Materials, Table 5.2"
    return (
        Solid("silica", 80e9, 0.25, 2200.0, 9e9, None, f"{sample}; {assumed}"),
        Solid("silicon carbide", 161e9, 0.23, 3160.0, 24e9, None,
              f"{sample}, {dense}, as is the hardness, {anstis} for hot-pressed NC-203; the "
              "sample's own is not known"),
        Solid("fused silica", 73e9, 0.17, 2200.0, 9.2e9, None,
              f"{_CALLISTER}; hardness: middle of 8.6 to 9.8 GPa, micro hardness of quartz glass, "
              "Heraeus, Quartz Glass for Optics, Data and Properties"),
        Solid("soda-lime glass", 69e9, 0.23, 2500.0, 5.5e9, None,
              f"{_CALLISTER}; hardness, {anstis}"),
        Solid("sintered silicon carbide", 415e9, 0.16, 3160.0, 32e9, None,
              "Munro, J. Phys. Chem. Ref. Data 26, 1195 (1997); hardness: Vickers, 5 N"),
        Solid("alumina", 416e9, 0.231, 3984.0, 15e9, None,
              "sintered: Munro, J. Am. Ceram. Soc. 80, 1919 (1997); hardness: Vickers, 5 N"),
        Solid("sapphire", 403e9, 0.233, 3990.0, 22.5e9, None,
              f"{crystal}; density: from its cell, 0.4758 nm by 1.2991 nm; hardness: middle of 22 "
              "to 23 GPa, Sinani et al., Bull. Russ. Acad. Sci. Phys. 73, 1380 (2009)"),
        Solid("silicon", 160e9, 0.22, 2329.0, 12e9, None,
              f"{poly}; density: {_CRC}; hardness: a (100) face, by nanoindentation, Li and "
              "Bhushan, Thin Solid Films 340, 210 (1999)"),
        Solid("silicon nitride", 304e9, 0.30, 3300.0, 18.5e9, None,
              f"hot pressed: {_CALLISTER}; hardness, {anstis} for NC-132"),
        Solid("steel", 207e9, 0.30, 7850.0, None, 295e6,
              f"alloy 1020, yield strength when annealed: {_CALLISTER}"),
        Solid("gold", 77e9, 0.42, 19320.0, None, 205e6,
              f"commercially pure, yield strength when cold worked by 60 %: {_CALLISTER}"),
        Solid("tungsten", 411e9, 0.28, 19300.0, None, 760e6,
              f"{dowling}; density: {_CRC}; yield strength, commercially pure: {_CALLISTER}"),
        Solid("polystyrene", 2.8e9, 0.33, 1050.0, None, 47e6,
              "modulus: middle of 2.28 to 3.28 GPa; yield strength: middle of 25 to 69 MPa; "
              f"{_CALLISTER}"),
        Solid("PDMS", 2e6, 0.5, 1030.0, None, None,
              f"{silicone} 2.97 MPa by curing; ratio: incompressible; density: maker's sheet"),
    )  # fmt: skip


SOLIDS: dict[str, Solid] = {solid.name: solid for solid in _solids()}
"""The solids that a case can name."""
