"""The table [gas]: what fills the gap."""

from __future__ import annotations

from typing import Any, ClassVar, Self

from pydantic import model_validator

from asperity.config import fields
from asperity.config.base_table import Table
from asperity.config.fields import entry
from asperity.config.problems import among
from asperity.errors import InputError, refuse_all
from asperity.materials.gases import GASES

_NAMED = ("pressure", "temperature")
_BY_NUMBER = ("viscosity", "slip_length")


class Gas(Table):
    """Gas that is squeezed between the bodies; without this table there is a vacuum."""

    loss: ClassVar[str] = "gas"

    name: str | None = entry(
        "", "Name from the catalogue, with `pressure` and `temperature`.", "air", default=None,
        shown=True, among=GASES,
    )  # fmt: skip
    pressure: fields.Pressure | None = entry(
        "Pa", "Pressure of the gas.", "101.325 kPa", default=None, shown=True
    )
    temperature: fields.Temperature | None = entry(
        "K", "Temperature of the gas.", "20 degC", default=None, shown=True
    )
    viscosity: fields.Viscosity | None = entry(
        "Pa s", "Viscosity, with `slip_length` in place of a name.", "18.2 uPa s", default=None
    )
    slip_length: fields.SlipLength | None = entry(
        "m", "Slip length on both surfaces; 0 for none.", "75 nm", default=None
    )
    cutoff_separation: fields.Length | None = entry(
        "m",
        "Separation below which the film does not thin; the rms height of rough surfaces.",
        "1 nm",
        default=None,
    )

    @model_validator(mode="after")
    def _complete(self) -> Self:
        by_name, by_number = (
            [key for key in keys if getattr(self, key) is not None]
            for keys in (("name", *_NAMED), _BY_NUMBER)
        )
        if by_name and by_number:
            raise InputError(
                f"`{by_number[0]}` must not be given beside `{by_name[0]}`: a gas is given by "
                "name, pressure and temperature, or by viscosity and slip_length",
                key=by_number[0],
            )
        needed = _BY_NUMBER if by_number else ("name", *_NAMED)
        beside = (by_number or by_name or ["[gas]"])[0]
        refuse_all(
            InputError(f"`{key}` must be given with `{beside}`; got nothing", key=key)
            for key in needed
            if getattr(self, key) is None
        )
        if self.name is not None:
            rule = (
                "`name` must be a gas of the catalogue, or be replaced by `viscosity` and "
                "`slip_length`"
            )
            among(self.name, GASES, rule, key="name")
        self.film()
        return self

    def film(self) -> tuple[float, float]:
        """Viscosity [Pa s] and slip length [m], given or of the named gas."""
        if self.name is None:
            assert self.viscosity is not None
            assert self.slip_length is not None
            return self.viscosity, self.slip_length
        assert self.pressure is not None
        assert self.temperature is not None
        gas = GASES[self.name]
        try:
            slip = gas.slip_length(self.pressure, self.temperature)
            return gas.viscosity(self.temperature), slip
        except InputError as error:
            raise InputError(str(error), key="temperature") from error

    def check_beside(self, case: Any) -> None:
        """Refuse a film that has no thinnest or no thickest place."""
        if case.impact is None:
            return
        closest, release = self.cutoff_separation, case.impact.release_separation
        if case.roughness is None and closest is None:
            raise InputError(
                "`cutoff_separation` must be given for a smooth body: a film between smooth "
                "surfaces that touch would hold them apart for ever; got nothing",
                key="gas.cutoff_separation",
            )
        if release is None:
            raise InputError(
                "`release_separation` must be given with a [gas] table: the film takes energy at "
                "every separation, and none beyond it is counted; got nothing",
                key="impact.release_separation",
            )
        if closest is not None and closest >= release:
            raise InputError(
                "`cutoff_separation` must be smaller than `release_separation` "
                f"({release * 1e9:.6g} nm), or the film would never thin; "
                f"got {closest * 1e9:.6g} nm",
                key="gas.cutoff_separation",
            )
