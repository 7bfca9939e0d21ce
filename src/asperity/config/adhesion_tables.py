"""The tables of what pulls: [adhesion] and [capillary]."""

from __future__ import annotations

import dataclasses
import math
from typing import Annotated, ClassVar, Literal, Self

from pydantic import BeforeValidator, model_validator

from asperity.config import fields
from asperity.config.base_table import Table, need
from asperity.config.fields import entry
from asperity.config.problems import among
from asperity.errors import InputError
from asperity.materials import liquids as catalogue
from asperity.units import shown


def _one_model(value: object) -> object:
    """Refuse what would count a force twice; leave the rest to the list of models."""
    several = isinstance(value, list) or (isinstance(value, str) and "+" in value)
    if several:
        raise InputError(
            "`model` must be one model, since 'bradley', 'dmt', 'jkr', 'lennard-jones' and "
            f"'maugis' are the same adhesion and together would count it twice; got {shown(value)}"
        )
    if isinstance(value, str) and value.strip().lower() == "hertz":
        raise InputError(
            "`model` is the adhesion alone, since elastic contact (Hertz) is always there and "
            f"would count twice: take 'none'; got {shown(value)}"
        )
    return value


class Adhesion(Table):
    """Dry adhesion; without this table there is none."""

    loss: ClassVar[str] = "adhesion"

    model: Annotated[
        Literal["none", "auto", "bradley", "dmt", "maugis", "jkr", "lennard-jones"],
        BeforeValidator(_one_model),
    ] = entry(
        "",
        "Law of one asperity: 'none', 'bradley', 'dmt', 'maugis', 'jkr' or 'lennard-jones'; "
        "'auto' chooses.",
        "auto",
    )
    work: fields.SurfaceEnergy | None = entry(
        "J/m^2", "Work of adhesion.", "60 mJ/m^2", default=None, shown=True
    )
    equilibrium_spacing: fields.Length | None = entry(
        "m",
        "Equilibrium spacing of the atoms, the range of the adhesion ('jkr' needs none).",
        "0.2 nm",
        default=None,
        shown=True,
    )

    @model_validator(mode="after")
    def _complete(self) -> Self:
        needed = {"none": (), "jkr": ("work",)}.get(self.model, ("work", "equilibrium_spacing"))
        return need(self, needed)


class Capillary(Table):
    """Menisci of condensed vapour; without this table there are none."""

    loss: ClassVar[str] = "capillary"

    model: Literal["none", "equilibrium", "constant-volume", "kelvin-filling"] = entry(
        "",
        "'none', 'equilibrium' (constant Kelvin radius), 'constant-volume', or 'kelvin-filling'.",
        "equilibrium",
    )
    formation: Literal["on-contact", "capillary-condensation"] = entry(
        "",
        "'on-contact': forms when touched, holds to the Kelvin gap (a loss); "
        "'capillary-condensation': forms at it (no loss).",
        "on-contact",
        default="on-contact",
    )
    liquid: str | None = entry(
        "",
        "Name from the catalogue; any name where `tension` and `molar_volume` are given.",
        "water",
        default=None,
        shown=True,
        among=catalogue.LIQUIDS,
    )
    humidity: fields.Humidity | None = entry(
        "1",
        "Vapour pressure over saturated vapour pressure; 1 needs `adsorbed_film_thickness`.",
        0.6,
        default=None,
        shown=True,
    )
    temperature: fields.Temperature | None = entry(
        "K", "Temperature of liquid and vapour.", "20 degC", default=None, shown=True
    )
    contact_angle: fields.Angle | None = entry(
        "rad", "Contact angle of the liquid, in [0, 90) deg.", "30 deg", default=None, shown=True
    )
    tension: fields.Tension | None = entry(
        "N/m", "Surface tension, in place of the catalogue's.", "75 mN/m", default=None
    )
    molar_volume: fields.MolarVolume | None = entry(
        "m^3/mol", "Molar volume, in place of the catalogue's.", "18.05 cm^3/mol", default=None
    )
    adsorbed_film_thickness: fields.Length | None = entry(
        "m",
        "Adsorbed film on each surface, from which menisci draw: they span no gap wider than both.",
        "0.5 nm",
        default=None,
    )
    surface_rms_height: fields.Length | None = entry(
        "m",
        "Rms height of the surface (not of its summits), for 'kelvin-filling' of rough bodies.",
        "11 nm",
        default=None,
    )
    formation_time: Annotated[float, fields.Quantity("s", 1e-12, 1e9, zero=True)] | None = entry(
        "s",
        "Time that menisci take to form; without it, or at 0, they form at once.",
        "1 us",
        default=None,
    )

    @model_validator(mode="after")
    def _complete(self) -> Self:
        if self.model == "none":
            return self
        need(self, ("liquid", "humidity", "temperature", "contact_angle"))
        if self.surface_rms_height is not None and self.model != "kelvin-filling":
            raise InputError(
                "`surface_rms_height` must be given with model = 'kelvin-filling' alone, which has "
                f"no asperities; got model = '{self.model}'",
                key="surface_rms_height",
            )
        if self.formation_time and self.formation == "capillary-condensation":
            raise InputError(
                "`formation_time` must be absent with formation = 'capillary-condensation', whose "
                "menisci are in equilibrium with the vapour at every gap and have no delay; take "
                "'on-contact'; got "
                f"{self.formation_time:.6g} s",
                key="formation_time",
            )
        assert self.contact_angle is not None
        if self.contact_angle >= math.pi / 2:
            raise InputError(
                "`contact_angle` must lie in [0, 90) deg with menisci: beyond it the liquid does "
                f"not condense in a gap; got {math.degrees(self.contact_angle):.6g} deg",
                key="contact_angle",
            )
        self.substance()
        return self

    def substance(self) -> catalogue.Liquid:
        """The liquid at the case's temperature, with the case's own numbers where it has any."""
        assert self.liquid is not None
        assert self.temperature is not None
        own = {
            key: getattr(self, key)
            for key in ("tension", "molar_volume")
            if getattr(self, key) is not None
        }
        known = catalogue.LIQUIDS.get(self.liquid)
        if len(own) == 2:
            size = (own["molar_volume"] / catalogue.AVOGADRO) ** (1.0 / 3.0)
            size = known.molecule_size if known else size
            return catalogue.Liquid(self.liquid, **own, source="the case file", molecule_size=size)
        rule = "`liquid` must be a name of the catalogue, or come with `tension` and `molar_volume`"
        among(self.liquid, catalogue.LIQUIDS, rule, key="liquid")
        try:
            return dataclasses.replace(catalogue.LIQUIDS[self.liquid].at(self.temperature), **own)
        except InputError as error:
            raise InputError(str(error), key="temperature") from error
