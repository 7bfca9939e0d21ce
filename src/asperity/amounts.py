"""A value with its unit as people write it: ``45.9 nm``."""

from __future__ import annotations

import math

_PREFIXES = {
    -24: "y", -21: "z", -18: "a", -15: "f", -12: "p", -9: "n", -6: "u", -3: "m",
    0: "", 3: "k", 6: "M", 9: "G", 12: "T",
}  # fmt: skip


_PREFIXED = ("m", "s", "N", "J", "W", "Pa", "m/s", "m/s^2", "J/m^2", "N/m", "Pa s")
"""Units that take a prefix; of others, such as 1/m^2, the number has an exponent instead."""


def scaled(value: float, unit: str, digits: int = 4) -> tuple[float, str]:
    """What to divide by, and the unit with its prefix, to show a value between 1 and 1000.

    Parameters
    ----------
    value : float
        A typical value, in ``unit``.
    unit : str
        SI unit without a prefix.
    digits : int
        How many are shown.

    Returns
    -------
    tuple
        E.g. ``(1e-9, "nm")`` for 4.6e-8 m. ASCII: "u" for micro.
    """
    if unit not in _PREFIXED or not math.isfinite(value) or value == 0.0:
        return 1.0, unit
    # A value that rounds to 1000 takes the next prefix.
    power = 3 * math.floor(math.log10(abs(value) * (1.0 + 0.5 * 0.1**digits)) / 3)
    power = min(max(power, -24), 12)
    return float(f"1e{power}"), _PREFIXES[power] + unit


def amount(value: float | None, unit: str = "", digits: int = 4) -> str:
    """A value with its unit at some digits, e.g. ``45.9 nm``; ``-`` where there is none.

    Plain numbers have the unit ``""`` or ``"1"``; angles are shown in degrees.
    """
    if value is None or not math.isfinite(value):
        return "-"
    if unit == "rad":
        value, unit = math.degrees(value), "deg"
    factor, prefixed = scaled(value, "" if unit == "1" else unit, digits)
    return f"{value / factor + 0.0:.{digits}g} {prefixed}".strip()  # no -0
