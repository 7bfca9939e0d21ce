"""Liquid and gas between the bodies, outside their models' validity: the warnings."""

from __future__ import annotations

from math import pi

import numpy as np

from ..dynamics import Motion
from ..dynamics.gas_film import slip_factor
from ..inputs import Gas, Inputs
from ..laws.liquid.constant_volume import EDGE_ANGLE, EDGE_HOLDS
from ..materials.liquids import Liquid
from . import Regime

SLIP_HOLDS = 0.1
"""Knudsen number below which first-order slip holds."""

_COMPRESSED = 0.1  # of the gas's own pressure
_CLOSE = 0.004  # of the radius: a gap at which the film is 1 % off (Brenner 1961)


def liquid_warnings(inputs: Inputs, regime: Regime) -> list[str]:
    """One line for each way in which menisci leave the validity of their models.

    Parameters
    ----------
    inputs
        The quantities of a case.
    regime
        Its dimensionless numbers.
    """
    liquid = inputs.liquid
    if liquid is None:
        return []
    out = _below_a_molecule(inputs, liquid)
    smooth = inputs.asperities is None
    on_asperities = inputs.structure.liquid != "kelvin-filling" and not smooth
    if np.isinf(inputs.liquid_span):
        out.append(
            "the Kelvin radius is infinite: menisci of any height, which would have coalesced long "
            "before, are kept isolated"
        )
    elif on_asperities and regime.liquid_regime in ("coalesced", "flooded"):
        out.append(
            f"{regime.liquid_regime}: {regime.liquid_regime_reason}: menisci merge, and this model "
            "keeps them isolated ('kelvin-filling' is meant for this)"
        )
    elif regime.liquid_regime == "flooded":
        out.append(
            f"flooded: {regime.liquid_regime_reason}: the drag of the liquid itself is left out"
        )
    return out + _wide(inputs)


def _below_a_molecule(inputs: Inputs, liquid: Liquid) -> list[str]:
    """Menisci, or gaps that they span, smaller than a molecule."""
    molecule = f"less than a molecule of {liquid.name} ({liquid.molecule_size * 1e9:.2g} nm)"
    if inputs.liquid_radius < liquid.molecule_size:
        whose = (
            "Kelvin radius" if inputs.liquid_radius == inputs.kelvin_radius else "liquid's radius"
        )
        return [
            f"the {whose} is {inputs.liquid_radius * 1e9:.2g} nm, {molecule}: no meniscus of "
            "continuum liquid"
        ]
    if inputs.liquid_span < liquid.molecule_size:
        return [
            f"menisci span gaps up to {inputs.liquid_span * 1e9:.2g} nm, {molecule}: no meniscus "
            "of continuum liquid"
        ]
    return []


def _wide(inputs: Inputs) -> list[str]:
    """Menisci that see more than the cap of their asperity."""
    rough, span, tip = inputs.asperities, inputs.liquid_span, inputs.tip_radius
    filled = inputs.structure.liquid == "kelvin-filling" and rough is not None
    if filled or np.isinf(span):
        return []
    what = "asperity" if rough is not None else "body"
    out = []
    if span > 0.5 * tip:
        out.append(
            f"menisci are wider than their {what}: the gap at their edge is {span * 1e9:.3g} nm, "
            f"and only up to {0.5 * tip * 1e9:.3g} nm, half its radius, does the edge lie on it"
        )
    if inputs.structure.liquid == "constant-volume":
        out += _thick(inputs.contact_angle, pi * (span / tip) ** 2)
    return out


def _thick(angle: float, volume: float) -> list[str]:
    """Menisci of constant volume beyond the angle [rad] and volume [radius^3] of their tests."""
    out = []
    if angle > EDGE_ANGLE:
        out.append(
            f"the contact angle is {np.degrees(angle):.4g} deg: menisci of constant volume are "
            f"tested up to {np.degrees(EDGE_ANGLE):.0f} deg, and taken for thin beyond that"
        )
    if volume > EDGE_HOLDS:
        out.append(
            f"the volume of a meniscus is {volume:.3g} radius^3: its law is tested up to "
            f"{EDGE_HOLDS:g} radius^3, and takes it for thin beyond that"
        )
    return out


def gas_warnings(inputs: Inputs, central: float, motion: Motion) -> list[str]:
    """One line for each way in which a gas film leaves the validity of its model.

    Parameters
    ----------
    inputs
        The quantities of a case.
    central
        Separation [m] of the deformed mean planes at the axis at closest approach.
    motion
        The motion.
    """
    gas = inputs.gas
    if gas is None:
        return []
    thinnest = max(central, gas.cutoff_separation)
    out = [
        *_far(inputs),
        *_two_temperatures(inputs, gas),
        *_slip(gas, thinnest),
        *_compressed(inputs, gas, thinnest, motion),
    ]
    if not float(motion.impacts.apex[0]) > float(motion.impacts.closest_approach[0]):
        falls = inputs.release is not None and inputs.release.gravity > 0.0
        held = falls or inputs.suspension is not None
        end = "creeps to rest" if held else "never touches"
        out.append(f"the gas film damps the fall so strongly that the body {end}")
    return out


def _far(inputs: Inputs) -> list[str]:
    """A film so thick that the sphere is not close to the wall."""
    radius, release = inputs.radius, None if inputs.release is None else inputs.release.separation
    if release is None or release <= _CLOSE * radius:
        return []
    return [
        f"the body is released at {release / radius:.2g} of its radius: the gas film is that of a "
        f"sphere close to the wall, 1 % off at {_CLOSE:g}, and Stokes's drag far from it is left "
        "out"
    ]


def _two_temperatures(inputs: Inputs, gas: Gas) -> list[str]:
    liquid = inputs.liquid_temperature
    if gas.temperature is None or liquid is None:
        return []
    if abs(gas.temperature - liquid) <= 1.0:
        return []
    return [
        f"gas.temperature is {gas.temperature:.4g} K and capillary.temperature {liquid:.4g} K: the "
        "vapour of the menisci is part of the gas"
    ]


def _slip(gas: Gas, thinnest: float) -> list[str]:
    """A film outside first-order slip."""
    knudsen = gas.free_path / thinnest
    if knudsen == 0.0:
        return [
            "the gas film has no slip (`slip_length` is 0): it holds where the gap is more than "
            "ten mean free paths, which in air at ambient pressure is 0.65 um"
        ]
    if knudsen > SLIP_HOLDS:
        return [
            f"the Knudsen number of the gas film is {knudsen:.2g} at closest approach: first-order "
            f"slip holds below {SLIP_HOLDS:g}"
        ]
    return []


def _compressed(inputs: Inputs, gas: Gas, thinnest: float, motion: Motion) -> list[str]:
    """A film whose gas is compressed."""
    speed = np.sqrt(2.0 * float(motion.impacts.maximum_kinetic[0]) / inputs.mass)
    slip = float(slip_factor(thinnest, gas.slip_length))
    pressure = 3.0 * gas.viscosity * inputs.radius * speed * slip / thinnest**2
    if gas.pressure is None or not pressure > _COMPRESSED * gas.pressure:
        return []
    return [
        f"the pressure in the gas film may reach {pressure:.2g} Pa (impact speed at closest "
        f"approach), above {_COMPRESSED:g} of the gas's {gas.pressure:.3g} Pa: it is "
        "compressed then, and this film is not"
    ]
