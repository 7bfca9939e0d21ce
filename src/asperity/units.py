"""Text with a unit -> SI float: ``"50 um"`` -> ``5e-05``. The only room that knows pint."""

from __future__ import annotations

import decimal
import functools
import math
import re
import reprlib
from typing import Any

from asperity.errors import InputError

# Plain decimal notation only: pint itself would read "1,5 m" as 15 m and "5 um 3" as 15 um.
_NUMBER = re.compile(
    r"([+-]?(?:[0-9]{1,40}(?:\.[0-9]{0,40})?|\.[0-9]{1,40})(?:[eE][+-]?[0-9]{1,3})?)(.*)"
)
_UNIT = re.compile(r"[A-Za-zµμÅΩ°%_0-9 ^*/·()⁻⁰¹²³⁴⁵⁶⁷⁸⁹+-]{1,60}")
_LONG_DIGITS = re.compile(r"[0-9]{3}")
_NOT_A_NUMBER = re.compile(r"\s*[+-]?(nan|inf|infinity)\b", re.IGNORECASE)

_KINDS = {
    "m": ("a length", "50 um"),
    "1/m^2": ("a number per area", "1.69e16 1/m^2"),
    "Pa": ("a pressure", "80 GPa"),
    "kg/m^3": ("a density", "2200 kg/m^3"),
    "J/m^2": ("an energy per area", "30 mJ/m^2"),
    "N/m": ("a force per length", "75 mN/m"),
    "m^3/mol": ("a molar volume", "18.05 cm^3/mol"),
    "K": ("a temperature", "20 degC"),
    "rad": ("an angle", "73 deg"),
    "m/s": ("a speed", "0.1 m/s"),
    "m/s^2": ("an acceleration", "9.81 m/s^2"),
    "s": ("a time", "10 ms"),
}

# Value of one unit, and of its zero, in the spellings that most cases use. Whatever is written
# otherwise is read by pint, which takes a second to start; tests hold these to what it says.
_COMMON = {
    "m": {
        "m": "1", "cm": "1e-2", "mm": "1e-3", "um": "1e-6", "µm": "1e-6", "μm": "1e-6",
        "nm": "1e-9", "pm": "1e-12",
    },
    "1/m^2": {"1/m^2": "1", "1/mm^2": "1e6", "1/um^2": "1e12", "1/nm^2": "1e18"},
    "Pa": {
        "Pa": "1", "hPa": "1e2", "kPa": "1e3", "MPa": "1e6", "GPa": "1e9", "bar": "1e5",
        "mbar": "1e2",
    },
    "kg/m^3": {"kg/m^3": "1", "g/cm^3": "1e3"},
    "J/m^2": {"J/m^2": "1", "mJ/m^2": "1e-3"},
    "N/m": {"N/m": "1", "mN/m": "1e-3"},
    "m^3/mol": {"m^3/mol": "1", "cm^3/mol": "1e-6"},
    "K": {"K": "1", "degC": "1"},
    "rad": {"rad": "1", "deg": "0.017453292519943295769236907684886127134428718885417"},
    "m/s": {"m/s": "1", "cm/s": "1e-2", "mm/s": "1e-3", "um/s": "1e-6"},
    "m/s^2": {"m/s^2": "1"},
    "s": {"s": "1", "ms": "1e-3", "us": "1e-6", "ns": "1e-9", "min": "60", "h": "3600"},
    "Pa s": {"Pa s": "1", "mPa s": "1e-3", "uPa s": "1e-6"},
    "N s/m": {"N s/m": "1", "mN s/m": "1e-3", "uN s/m": "1e-6", "nN s/m": "1e-9"},
}  # fmt: skip
_ZERO = {"degC": "273.15"}

_shown = reprlib.Repr()
_shown.maxstring = _shown.maxother = _shown.maxlong = 60
_shown.maxlevel = 2


def shown(value: object) -> str:
    """A value as it appears in a message: its ``repr``, shortened."""
    try:
        return _shown.repr(value)
    except (ValueError, RecursionError):  # Python refuses to print integers of many digits
        return "a value too long to show"


def example(unit: str) -> str:
    """A value in the kind of quantity that ``unit`` measures, e.g. ``"50 um"`` for ``"m"``."""
    return _KINDS[unit][1] if unit in _KINDS else f"1 {unit}"


def quantity(text: object, unit: str, name: str = "value") -> float:
    """Value of a text in a unit.

    The conversion is done in decimal arithmetic and rounded once, so that ``"50 um"``,
    ``"0.05 mm"`` and ``"5e-05 m"`` are the same float.

    Parameters
    ----------
    text : str
        A number and a unit, e.g. ``"50 um"``, ``"1.69e16 1/m^2"``, ``"20 degC"`` (absolute).
    unit : str
        Unit wanted, e.g. ``"m"``; pint's notation.
    name : str
        What to call the value in messages.

    Returns
    -------
    float
        The value in ``unit``.

    Raises
    ------
    InputError
        Where the text is no number with a unit, the unit is unknown or of another dimension, or
        the value is not finite in ``unit``.
    """
    sample = example(unit)
    if not isinstance(text, str):
        raise _refusal(name, f"must be text with a number and a unit, such as '{sample}'", text)
    number, unit_text = _split(text, name, sample)
    factor = _COMMON.get(unit, {}).get(unit_text)
    if factor is not None:
        with decimal.localcontext(_CONTEXT):
            zero = decimal.Decimal(_ZERO.get(unit_text, 0))
            result = float(decimal.Decimal(number) * decimal.Decimal(factor) + zero)
    else:
        result = _by_pint(number, unit_text, text, unit, name)
    if not math.isfinite(result) or (result == 0.0 and decimal.Decimal(number) != 0):
        raise _refusal(name, "must be a number that a float can hold", text)
    return result


def lengths(text: object, count: int, name: str = "value") -> tuple[float, ...]:
    """Positive lengths [m] of a text such as ``"10 um x 5 um"``.

    Parameters
    ----------
    text : str
        The lengths, with an ``x`` between them.
    count : int
        How many there must be.
    name : str
        What to call the value in messages.

    Raises
    ------
    InputError
        Where the text is something else.
    """
    sample = " x ".join(["10 um"] * count)
    parts = re.split(r"\s+[x×]\s+", text.strip()) if isinstance(text, str) else []
    if len(parts) != count:
        raise _refusal(name, f"must be {count} lengths, such as '{sample}'", text)
    values = tuple(quantity(part, "m", name) for part in parts)
    if not all(value > 0.0 for value in values):
        raise _refusal(name, "must be positive", text)
    return values


_CONTEXT = decimal.Context(prec=50)


def _split(text: str, name: str, sample: str) -> tuple[str, str]:
    """Number and unit of a text, apart."""
    if _NOT_A_NUMBER.match(text):
        raise _refusal(name, "must be finite", text)
    match = _NUMBER.fullmatch(text.strip())
    if match is None:
        raise _refusal(name, f"must be a number with a unit, such as '{sample}'", text)
    number, unit_text = match.group(1), match.group(2).strip()
    if not unit_text:
        raise _refusal(name, f"must have a unit, such as '{sample}'", text)
    return number, unit_text


def _by_pint(number: str, unit_text: str, text: str, unit: str, name: str) -> float:
    """Value in a unit of a number and any unit that pint reads."""
    kind, sample = _KINDS.get(unit, (f"a value in {unit}", f"1 {unit}"))
    value = _measure(number, unit_text, text, name, f"{kind}, such as '{sample}'")
    wanted = _registry().Quantity(decimal.Decimal(1), unit)
    with decimal.localcontext(_CONTEXT):
        # Root units, not dimensions: a percentage is as dimensionless as an angle, and is none.
        if value.to_root_units().units != wanted.to_root_units().units:
            raise _refusal(name, f"must be {kind}, such as '{sample}'", text)
        return float(value.m_as(wanted.units))


def _measure(number: str, unit_text: str, text: str, name: str, kind: str) -> Any:
    """The pint quantity of a number and a unit."""
    readable = _UNIT.fullmatch(unit_text) and not _LONG_DIGITS.search(unit_text)
    # A difference of temperatures would pass for an absolute one.
    if not readable or "delta" in unit_text:
        raise _refusal(name, f"must be {kind}, in a known unit", text)
    try:
        with decimal.localcontext(_CONTEXT):
            units = _registry().parse_units(unit_text)
            value = _registry().Quantity(decimal.Decimal(number), units)
            value.to_root_units()
    except Exception as error:  # pint's parser raises more than its own errors on odd text
        raise _refusal(name, f"must be {kind}, in a known unit", text) from error
    return value


def _refusal(name: str, rule: str, value: object) -> InputError:
    return InputError(f"`{name}` {rule}; got {shown(value)}")


@functools.cache
def _registry() -> Any:
    """The registry of units, read at the first uncommon spelling."""
    import pint

    return pint.UnitRegistry(non_int_type=decimal.Decimal)
