"""The tables of a case, and what follows from them."""

from __future__ import annotations

import functools
import math
from typing import Annotated, Any, Literal

from pydantic import BeforeValidator, Field

from asperity.config.adhesion_tables import Adhesion, Capillary
from asperity.config.asperities import Asperities, asperities_of, refuse_asperities
from asperity.config.base_table import Table
from asperity.config.bodies import Body, Counterface, Material
from asperity.config.gas import Gas
from asperity.config.plasticity import Plasticity, Yielding, yielding_of
from asperity.config.publication import Publication
from asperity.config.roughness import Roughness
from asperity.config.run_tables import Impact, Numerics, Output
from asperity.config.viscoelasticity import Viscoelasticity
from asperity.config.waves import Waves
from asperity.errors import InputError, Tolerance
from asperity.materials import solids as catalogue
from asperity.units import shown

NAME = "case"
"""What a case is called that came from no file."""


def _cosine(angle: Any) -> Any:
    """Cosine of an angle [rad], or of those of many cases."""
    if isinstance(angle, float):
        return math.cos(angle)
    import numpy as np  # here: reading a case needs none of it

    return np.cos(angle)


def _known(version: object) -> object:
    if type(version) is not int or version != 1:
        raise InputError(
            f"`schema` must be 1, the only version that there is; got {shown(version)}"
        )
    return version


class CaseTables(Table):
    """The tables of a case, not yet held against each other: that is a `Case`."""

    schema_version: Annotated[Literal[1], BeforeValidator(_known)] = Field(
        1,
        alias="schema",
        description="Version of the case file's schema.",
        examples=[1],
        json_schema_extra={"unit": "1", "shown": True},
    )
    body: Body
    counterface: Counterface
    roughness: Roughness | None = None
    adhesion: Adhesion = Field(default_factory=lambda: Adhesion(model="none"))
    capillary: Capillary = Field(default_factory=lambda: Capillary(model="none"))
    plasticity: Plasticity | None = Field(None, json_schema_extra={"rare": True})
    gas: Gas | None = Field(None, json_schema_extra={"rare": True})
    waves: Waves | None = Field(None, json_schema_extra={"rare": True})
    viscoelasticity: Viscoelasticity | None = Field(None, json_schema_extra={"rare": True})
    impact: Impact | None = None
    publication: Publication | None = Field(None, json_schema_extra={"rare": True})
    numerics: Numerics = Field(default_factory=Numerics)
    output: Output = Field(default_factory=Output)
    materials: dict[str, Material] = Field(
        default_factory=dict, description="Materials of your own, by name."
    )

    @property
    def body_solid(self) -> catalogue.Solid:
        """What the body is made of."""
        return self.body.solid(self.materials, "body")

    @property
    def counterface_solid(self) -> catalogue.Solid:
        """What the counterface is made of."""
        return self.counterface.solid(self.materials, "counterface")

    @property
    def body_density(self) -> float:
        """Density of the body [kg/m^3]."""
        density = self.body_solid.density
        assert density is not None
        return density

    @property
    def launch(self) -> Impact:
        """How the body is let go.

        Raises
        ------
        InputError
            Where the case has no [impact] table.
        """
        if self.impact is None:
            raise InputError(
                "an [impact] table must be given, with a `speed` or a `release_separation`, for a "
                "motion (`asperity curve` takes --load or --depth without one); got none",
                key="impact",
            )
        return self.impact

    @property
    def plasticity_model(self) -> str:
        """Law of contacts that yield; 'none' without a [plasticity] table."""
        return "none" if self.plasticity is None else self.plasticity.model

    @property
    def has_strength(self) -> bool:
        """Whether it is known at what load something yields."""
        solids = (self.body_solid, self.counterface_solid)
        known = any(solid.hardness or solid.yield_strength for solid in solids)
        return known or self.plasticity_model != "none"

    @property
    def yielding(self) -> Yielding:
        """What yields in a contact: the softer solid, with the [plasticity] table's own values.

        Raises
        ------
        InputError
            Where nothing is known of it; never with a model other than 'none'.
        """
        table = self.plasticity
        if table is None or table.model == "none":
            table = Plasticity(model="none")
        return yielding_of(table, (self.body_solid, self.counterface_solid))

    @property
    def asperities(self) -> Asperities | None:
        """The asperities, read from the files if there are any; None for a smooth body.

        Raises
        ------
        InputError
            If a file cannot be used, or they are as large as the body.
        """
        if self.roughness is None:
            return None
        rough = asperities_of(self.roughness)
        refuse_asperities(self.body.radius, rough)
        return rough

    @property
    def liquid(self) -> catalogue.Liquid | None:
        """The liquid of the menisci at the case's temperature; None without menisci."""
        return None if self.capillary.model == "none" else self.capillary.substance()

    @property
    def kelvin_radius(self) -> float:
        """Kelvin radius [m]; 0 without menisci or in dry air, infinite at a humidity of 1."""
        liquid, air = self.liquid, self.capillary
        if liquid is None or air.humidity is None or air.temperature is None:
            return 0.0
        if air.humidity == 1.0:
            return math.inf
        return catalogue.kelvin_radius(liquid, air.humidity, air.temperature)

    @property
    def liquid_radius(self) -> float:
        """Radius of curvature of the liquid [m]: Kelvin's, or less where its film bounds it."""
        film, angle = self.capillary.adsorbed_film_thickness, self.capillary.contact_angle
        kelvin = self.kelvin_radius
        if film is None or angle is None:
            return kelvin
        return min(kelvin, film / _cosine(angle))

    @property
    def liquid_span(self) -> float:
        """Largest gap that the liquid bridges [m], twice its radius times cos(contact angle)."""
        angle = self.capillary.contact_angle
        return 0.0 if angle is None else 2.0 * self.liquid_radius * _cosine(angle)

    @property
    def tolerance(self) -> Tolerance:
        """The numerics as the solver takes them."""
        n = self.numerics
        limit = math.inf if n.time_limit is None else n.time_limit
        return Tolerance(n.tolerance, n.rest_height_ratio, limit, n.max_impacts, n.rings)

    @functools.cached_property
    def name(self) -> str:
        """Name of the built-in case, or of the file without its suffix; "case" of any other."""
        return NAME
