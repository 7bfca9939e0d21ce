"""Gases: viscosity, mean free path and slip, with a small catalogue."""

from __future__ import annotations

import math
from dataclasses import dataclass

from asperity.errors import InputError
from asperity.materials.liquids import GAS_CONSTANT

ATMOSPHERE = 101325.0
"""Standard atmosphere [Pa]."""

SLIP_PER_FREE_PATH = 1.1466
"""First-order slip length per mean free path where molecules leave a wall in all directions.

Albertoni, Cercignani and Gotusso (1963), with the mean free path that follows from the viscosity.
"""

_REFERENCE = 273.15


@dataclass(frozen=True)
class Gas:
    """A dilute gas.

    Parameters
    ----------
    name : str
        What it is called.
    molar_mass : float
        Molar mass [kg/mol].
    viscosity_at_freezing : float
        Viscosity at 273.15 K [Pa s]; it does not depend on the pressure.
    sutherland : float
        Sutherland's constant [K], by which the viscosity grows with the temperature.
    temperatures : tuple of float
        Temperatures between which that holds [K].
    source : str
        Where the numbers come from.
    """

    name: str
    molar_mass: float
    viscosity_at_freezing: float
    sutherland: float
    temperatures: tuple[float, float]
    source: str

    def viscosity(self, temperature: float) -> float:
        """Viscosity [Pa s] at a temperature [K], by Sutherland's formula.

        Raises
        ------
        InputError
            Where the temperature lies outside ``temperatures``.
        """
        low, high = self.temperatures
        if not low <= temperature <= high:
            raise InputError(
                f"`temperature` must lie in [{low:g} K, {high:g} K], where the viscosity of "
                f"{self.name} is known; got {temperature!r} K"
            )
        ratio = temperature / _REFERENCE
        growth = (_REFERENCE + self.sutherland) / (temperature + self.sutherland)
        return self.viscosity_at_freezing * ratio**1.5 * growth

    def free_path(self, pressure: float, temperature: float) -> float:
        """Mean free path [m] at a pressure [Pa] and a temperature [K].

        viscosity/(0.499 density speed) with the density of an ideal gas and the mean speed of its
        molecules (Chapman and Cowling 1970).
        """
        per_kilogram = GAS_CONSTANT / self.molar_mass * temperature
        speed = (8.0 / math.pi * per_kilogram) ** 0.5
        return self.viscosity(temperature) * per_kilogram / (0.499 * pressure * speed)

    def slip_length(self, pressure: float, temperature: float) -> float:
        """First-order slip length [m] at a pressure [Pa] and a temperature [K]."""
        return SLIP_PER_FREE_PATH * self.free_path(pressure, temperature)


_WHITE = (
    "viscosity: White, Viscous Fluid Flow (2006), table 1-2, within 2-3 %; "
    "molar mass: CRC Handbook of Chemistry and Physics"
)

GASES = {
    gas.name: gas
    for gas in (
        Gas("air", 0.028965, 1.716e-5, 110.6, (170.0, 1900.0), _WHITE),
        Gas("nitrogen", 0.028013, 1.663e-5, 106.7, (100.0, 1500.0), _WHITE),
        Gas("argon", 0.039948, 2.125e-5, 144.4, (120.0, 1500.0), _WHITE),
        Gas("carbon dioxide", 0.044010, 1.370e-5, 222.2, (190.0, 1700.0), _WHITE),
    )
}
"""Gases by name."""
