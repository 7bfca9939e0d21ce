"""The tables of what meets: [body], [counterface], [materials.NAME]."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, ClassVar, Literal, Self

from pydantic import model_validator

from asperity.config import fields
from asperity.config.base_table import Table
from asperity.config.fields import entry
from asperity.errors import InputError, refuse_all
from asperity.materials import solids as catalogue
from asperity.materials.solids import refuse_softer_than_yield

_ELASTIC = ("youngs_modulus", "poisson", "density")
_STRENGTHS = ("hardness", "yield_strength")
_HARDNESS = "Hardness, for the plasticity index and [plasticity]."
_YIELD_STRENGTH = "Yield strength, for [plasticity]."


class Material(Table):
    """A material of your own, by its name."""

    youngs_modulus: fields.Modulus = entry("Pa", "Young's modulus.", "70 GPa")
    poisson: fields.Poisson = entry("1", "Poisson's ratio, in (-1, 0.5].", 0.22)
    density: fields.Density = entry("kg/m^3", "Density.", "2500 kg/m^3")
    hardness: fields.Modulus | None = entry("Pa", _HARDNESS, "5.5 GPa", default=None)
    yield_strength: fields.Modulus | None = entry("Pa", _YIELD_STRENGTH, "2 GPa", default=None)

    @model_validator(mode="after")
    def _possible(self) -> Self:
        refuse_softer_than_yield(self.hardness, self.yield_strength)
        return self

    def solid(self, name: str) -> catalogue.Solid:
        """The material as a `Solid`."""
        return catalogue.Solid(name=name, source="the case file", **self.model_dump())


class Made(Table):
    """Something made of a material: named, or given by its numbers."""

    needed: ClassVar[tuple[str, ...]] = _ELASTIC

    material: str | None = entry(
        "", "Name from the catalogue or of a [materials.NAME] table.", "soda-lime glass",
        default=None, shown=True, among=catalogue.SOLIDS,
    )  # fmt: skip
    youngs_modulus: fields.Modulus | None = entry(
        "Pa", "Young's modulus, in place of `material`.", "80 GPa", default=None
    )
    poisson: fields.Poisson | None = entry(
        "1", "Poisson's ratio, in (-1, 0.5]; in place of `material`.", 0.25, default=None
    )
    density: fields.Density | None = entry(
        "kg/m^3", "Density, in place of `material`.", "2200 kg/m^3", default=None
    )
    hardness: fields.Modulus | None = entry("Pa", _HARDNESS, "9 GPa", default=None)
    yield_strength: fields.Modulus | None = entry("Pa", _YIELD_STRENGTH, "3.2 GPa", default=None)

    @model_validator(mode="after")
    def _material_or_numbers(self) -> Self:
        given = [key for key in (*_ELASTIC, *_STRENGTHS) if getattr(self, key) is not None]
        if self.material is not None and given:
            raise InputError(
                f"`{given[0]}` and `material` exclude each other: name a material or give its "
                f"numbers; got both",
                key=given[0],
            )
        missing = [key for key in self.needed if getattr(self, key) is None]
        if self.material is None and missing:
            wanted = ", ".join(f"`{key}`" for key in self.needed)
            rule = f"`material`, or all of {wanted}, must be given; got no"
            refuse_all(
                InputError(f"{rule} `{key}`", key=key if given else "material")
                for key in (missing if given else missing[:1])
            )
        refuse_softer_than_yield(self.hardness, self.yield_strength)
        return self

    def solid(self, own: Mapping[str, Material], name: str) -> catalogue.Solid:
        """What it is made of, by its own numbers or from the tables and the catalogue."""
        if self.material is None:
            assert self.youngs_modulus is not None
            assert self.poisson is not None
            return catalogue.Solid(
                name,
                self.youngs_modulus,
                self.poisson,
                self.density,
                self.hardness,
                self.yield_strength,
                "the case file",
            )
        if self.material in own:
            return own[self.material].solid(self.material)
        return catalogue.SOLIDS[self.material]


class Body(Made):
    """The body that falls."""

    shape: Literal["sphere"] = entry("", "Shape of the body.", "sphere", default="sphere")
    radius: fields.Length = entry("m", "Radius of the sphere.", "50 um")


class Counterface(Made):
    """The flat surface that it meets."""

    needed: ClassVar[tuple[str, ...]] = ("youngs_modulus", "poisson")
    loss: ClassVar[str] = "instability"

    material: str | None = entry(
        "", "Name from the catalogue or of a [materials.NAME] table.", "silicon", default=None,
        shown=True, among=catalogue.SOLIDS,
    )  # fmt: skip
    deformation: Literal["half-space", "rigid"] = entry(
        "",
        "Bulk deformation of both bodies: 'half-space' (elastic) or 'rigid' (asperities only).",
        "rigid",
        default="half-space",
    )


def solids_of(case: Any) -> tuple[catalogue.Solid, catalogue.Solid]:
    """The solids of the body and of the counterface of a ``CaseTables``."""
    own = case.materials
    return case.body.solid(own, "body"), case.counterface.solid(own, "counterface")
