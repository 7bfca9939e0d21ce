"""A case: the tables together, and the rules between them."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Annotated, Literal, Self

from pydantic import BeforeValidator, Field, model_validator

from asperity import materials as catalogue
from asperity.case import problems, writing
from asperity.case.bodies import Body, Counterface, Material, Roughness
from asperity.case.forces import Adhesion, Capillary
from asperity.case.publication import Publication
from asperity.case.running import Impact, Numerics, Output
from asperity.case.table import Table
from asperity.errors import InputError, Tolerance
from asperity.units import shown


def _known(version: object) -> object:
    if type(version) is not int or version != 1:
        raise InputError(
            f"`schema` must be 1, the only version that there is; got {shown(version)}"
        )
    return version


class Case(Table):
    """A case: bodies, surfaces and how they meet. All values are SI floats."""

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
    impact: Impact
    publication: Publication | None = Field(None, json_schema_extra={"rare": True})
    numerics: Numerics = Field(default_factory=Numerics)
    output: Output = Field(default_factory=Output)
    materials: dict[str, Material] = Field(
        default_factory=dict, description="Materials of your own, by name."
    )

    @model_validator(mode="after")
    def _consistent(self) -> Self:
        known = [*self.materials, *catalogue.SOLIDS]
        for part in ("body", "counterface"):
            name = getattr(self, part).material
            if name is not None and name not in known:
                raise InputError(
                    "`material` must be a name of the catalogue or of a [materials.NAME] table; "
                    f"got {shown(name)}{problems.did_you_mean(name, known)}",
                    key=f"{part}.material",
                )
        if self.publication is not None:
            self._only_what_the_publication_has()
        if self.roughness is None and self.counterface.deformation == "rigid":
            raise InputError(
                "`deformation` must be 'half-space' without a [roughness] table: a smooth rigid "
                "body has no elasticity at all; got 'rigid'",
                key="counterface.deformation",
            )
        if (
            self.publication is None
            and self.capillary.humidity == 1.0
            and self.capillary.model != "none"
        ):
            raise InputError(
                "`humidity` must lie in [0, 1) (at 1 the Kelvin radius is infinite: menisci would "
                "reach to any gap); got 1",
                key="capillary.humidity",
            )
        return self

    def _only_what_the_publication_has(self) -> None:
        """Refuse models that a [publication] table leaves no room for."""
        if self.roughness is None:
            raise InputError(
                "a [roughness] table must be given with [publication]; got none", key="publication"
            )
        wanted = (
            ("counterface.deformation", self.counterface.deformation, ("rigid",)),
            ("adhesion.model", self.adhesion.model, ("dmt", "none")),
            ("capillary.formation", self.capillary.formation, ("contact",)),
        )
        for key, value, allowed in wanted:
            if value not in allowed:
                name = key.split(".")[1]
                raise InputError(
                    f"`{name}` must be {' or '.join(map(repr, allowed))} with a [publication] "
                    f"table, which replaces the other models; got {value!r}",
                    key=key,
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
    def tolerance(self) -> Tolerance:
        """The numerics as the solver takes them."""
        n = self.numerics
        limit = math.inf if n.time_limit is None else n.time_limit
        return Tolerance(n.tolerance, n.rest, limit, n.max_impacts, n.rings)

    def toml(self) -> str:
        """The case as TOML with SI units, defaults filled in; `load` reads back an equal case."""
        return writing.toml(self)

    def replace(self, changes: Mapping[str, object]) -> Case:
        """The case with other values, checked anew.

        Parameters
        ----------
        changes : mapping of str to object
            Values as in a file by their dotted key, e.g. ``{"body.radius": "20 um"}``; None takes
            a key or a table away.

        Raises
        ------
        InputError
            Where a key is unknown or a value breaks a rule.
        """
        return problems.check(Case, writing.changed(self.toml(), changes))
