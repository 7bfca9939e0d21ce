"""Kinds of value in a case file: quantities with a unit, plain numbers, whole numbers."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Annotated, Any

from pydantic import Field, GetCoreSchemaHandler, ValidationInfo
from pydantic_core import CoreSchema, core_schema

from asperity.errors import InputError
from asperity.units import quantity, shown


@dataclass(frozen=True)
class Quantity:
    """A value with a unit: text in the file, an SI float afterwards.

    Parameters
    ----------
    unit : str
        SI unit of the float.
    low, high : float
        Smallest and largest value, both allowed: wide enough for any case, narrow enough that
        no product of them overflows.
    zero : bool
        Whether 0 is allowed besides.
    rule : str
        What to say of a value beyond the limits; without it, the limits themselves.
    """

    unit: str
    low: float
    high: float
    zero: bool = False
    rule: str = ""

    def read(self, value: object, info: ValidationInfo) -> float:
        """The text's value in SI; raises `InputError` with the rule that it breaks."""
        name = info.field_name or "value"
        result = quantity(value, self.unit, name)
        if result == 0.0 and self.zero:
            return 0.0
        if self.low <= result <= self.high:
            return result
        rule = f"must lie in [{self.low:g}, {self.high:g}] {self.unit}"
        if result <= 0.0:
            rule = "must not be negative" if self.zero else "must be positive"
        raise InputError(f"`{name}` {self.rule or rule}; got {shown(value)}")

    def __get_pydantic_core_schema__(
        self, source: Any, handler: GetCoreSchemaHandler
    ) -> CoreSchema:
        return core_schema.with_info_plain_validator_function(self.read)


@dataclass(frozen=True)
class Number:
    """A plain number in an interval: no unit, no text.

    Parameters
    ----------
    interval : str
        The interval in words of mathematics, e.g. ``"(-1, 0.5]"``.
    whole : bool
        Whether it must be a whole number.
    """

    interval: str
    whole: bool = False

    @property
    def bounds(self) -> tuple[float, float]:
        """Lower and upper end of the interval."""
        low, high = self.interval[1:-1].split(",")
        return float(low), float(high)

    def holds(self, value: float) -> bool:
        """Whether the interval contains a value."""
        low, high = self.bounds
        above = low <= value if self.interval.startswith("[") else low < value
        below = value <= high if self.interval.endswith("]") else value < high
        return above and below

    def read(self, value: object, info: ValidationInfo) -> float | int:
        """The number; raises `InputError` with the rule that it breaks."""
        name = info.field_name or "value"
        kind = "a whole number" if self.whole else "a number"
        allowed = int if self.whole else (int, float)
        if isinstance(value, bool) or not isinstance(value, allowed):
            raise InputError(f"`{name}` must be {kind} in {self.interval}; got {shown(value)}")
        if isinstance(value, float) and not math.isfinite(value):
            raise InputError(f"`{name}` must be finite; got {shown(value)}")
        if not self.holds(value):
            raise InputError(f"`{name}` must lie in {self.interval}; got {shown(value)}")
        return value if self.whole else float(value)

    def __get_pydantic_core_schema__(
        self, source: Any, handler: GetCoreSchemaHandler
    ) -> CoreSchema:
        return core_schema.with_info_plain_validator_function(self.read)


def entry(
    unit: str,
    description: str,
    example: object,
    *,
    default: Any = ...,
    shown: bool = False,
    among: Iterable[str] = (),
) -> Any:
    """A field of a table, with all that a form or a commented file needs.

    Parameters
    ----------
    unit : str
        SI unit of the stored value; ``"1"`` for plain numbers, ``""`` for text and switches.
    description : str
        What it is, in a sentence.
    example : object
        A value as it stands in a file.
    default : object
        Value where the file has none; without it the key is required.
    shown : bool
        Whether the template sets it although it is not required.
    among : iterable of str
        Names to offer where others are allowed besides.
    """
    return Field(
        default,
        description=description,
        examples=[example],
        json_schema_extra={"unit": unit, "shown": shown, "among": list(among)},
    )


Length = Annotated[float, Quantity("m", 1e-15, 1.0)]
Density = Annotated[float, Quantity("kg/m^3", 1e-3, 1e6)]
Modulus = Annotated[float, Quantity("Pa", 1.0, 1e14)]
AreaDensity = Annotated[float, Quantity("1/m^2", 1.0, 1e24)]
SurfaceEnergy = Annotated[float, Quantity("J/m^2", 1e-9, 1e3)]
Tension = Annotated[float, Quantity("N/m", 1e-6, 10.0)]
MolarVolume = Annotated[float, Quantity("m^3/mol", 1e-7, 1.0)]
Temperature = Annotated[float, Quantity("K", 1.0, 1e4, rule="must lie in [1, 10000] K")]
Angle = Annotated[float, Quantity("rad", 1e-9, math.pi, True, "must lie in [0, 180] deg")]
Pressure = Annotated[float, Quantity("Pa", 1e-6, 1e9)]
Viscosity = Annotated[float, Quantity("Pa s", 1e-9, 1e3)]
SlipLength = Annotated[float, Quantity("m", 1e-15, 1.0, zero=True)]
Speed = Annotated[float, Quantity("m/s", 1e-9, 1e4)]
Acceleration = Annotated[float, Quantity("m/s^2", 1e-9, 1e9, zero=True)]
Time = Annotated[float, Quantity("s", 1e-12, 1e9)]
Poisson = Annotated[float, Number("(-1, 0.5]")]
Humidity = Annotated[float, Number("[0, 1]")]
