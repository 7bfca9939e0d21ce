"""The tables of a case."""

from __future__ import annotations

import functools
from typing import Annotated, Literal

from pydantic import BeforeValidator, Field

from asperity.config.adhesion_tables import Adhesion, Capillary
from asperity.config.base_table import Table
from asperity.config.bodies import Body, Counterface, Material
from asperity.config.gas import Gas
from asperity.config.plasticity import Plasticity
from asperity.config.publication import Publication
from asperity.config.roughness import Roughness
from asperity.config.run_tables import Impact, Numerics, Output
from asperity.config.viscoelasticity import Viscoelasticity
from asperity.config.waves import Waves
from asperity.errors import InputError
from asperity.units import shown

NAME = "case"
"""What a case is called that came from no file."""


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

    @functools.cached_property
    def name(self) -> str:
        """Name of the built-in case, or of the file without its suffix; "case" of any other."""
        return NAME
