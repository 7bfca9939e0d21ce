"""A case: the tables together, and the rules between them."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Annotated, Any, Literal, Self

from pydantic import BeforeValidator, Field, model_validator

from asperity import materials as catalogue
from asperity.case import problems, writing
from asperity.case.asperities import Asperities, asperities_of
from asperity.case.bodies import Body, Counterface, Material
from asperity.case.domain import refuse_asperities, refuse_outside
from asperity.case.forces import Adhesion, Capillary
from asperity.case.gas import Gas
from asperity.case.plasticity import Plasticity, Yielding, yielding_of
from asperity.case.publication import Publication
from asperity.case.roughness import Roughness
from asperity.case.running import Impact, Numerics, Output
from asperity.case.table import Table
from asperity.case.viscoelasticity import Viscoelasticity
from asperity.case.waves import Waves
from asperity.errors import InputError, Tolerance, check_each, refuse_all
from asperity.units import shown


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

    @model_validator(mode="after")
    def _consistent(self) -> Self:
        check_each(
            lambda: self._known_material("body"), lambda: self._known_material("counterface")
        )
        check_each(
            self._only_what_the_publication_has,
            self._film_between_ends,
            self._elastic_somewhere,
            self._bounded_liquid,
            self._late_liquid,
            self._waves_beside,
            self._creep_beside,
            self._yielding_beside,
            lambda: refuse_outside(self),
        )
        return self

    def _known_material(self, part: str) -> None:
        """Refuse the name of a material that neither the case nor the catalogue has."""
        known = [*self.materials, *catalogue.SOLIDS]
        name = getattr(self, part).material
        if name is not None and name not in known:
            raise InputError(
                "`material` must be a name of the catalogue or of a [materials.NAME] table; "
                f"got {shown(name)}{problems.did_you_mean(name, known)}",
                key=f"{part}.material",
            )

    def _elastic_somewhere(self) -> None:
        """Refuse a smooth body on a bulk that does not deform."""
        if self.roughness is None and self.counterface.deformation == "rigid":
            raise InputError(
                "`deformation` must be 'half-space' without a [roughness] table: a smooth rigid "
                "body has no elasticity at all; got 'rigid'",
                key="counterface.deformation",
            )

    def _waves_beside(self) -> None:
        """Refuse what waves cannot stand beside."""
        if self.waves is not None:
            self.waves.refuse_beside(self.counterface_solid, self.capillary, self.publication)

    def _creep_beside(self) -> None:
        """Refuse what a creeping bulk cannot stand beside."""
        if self.viscoelasticity is not None:
            self.viscoelasticity.refuse_beside(self)

    def _yielding_beside(self) -> None:
        """Refuse what a law of yielding cannot stand beside, and solids that have no strength."""
        table = self.plasticity
        if table is None or table.model == "none":
            return
        check_each(
            lambda: table.refuse_beside(
                self.adhesion, self.capillary, self.roughness, self.publication
            ),
            lambda: table.refuse_under(self.counterface, self.roughness),
            lambda: self.yielding,
        )

    def _late_liquid(self) -> None:
        """Refuse menisci that take time on a rough half-space beside gas."""
        time, rough = self.capillary.formation_time, self.roughness is not None
        if not time or self.capillary.model == "none" or self.publication is not None:
            return
        if rough and self.counterface.deformation != "rigid" and self.gas is not None:
            raise InputError(
                "[gas] must be absent beside `formation_time` on a rough half-space, whose motion "
                "is stepped without a film; take deformation = 'rigid', or no `formation_time`; "
                f"got {time:.6g} s",
                key="capillary.formation_time",
            )

    def _film_between_ends(self) -> None:
        """Refuse a film that has no thinnest or no thickest place."""
        gas, release = self.gas, None if self.impact is None else self.impact.release_gap
        if gas is None or self.impact is None:
            return
        if self.roughness is None and gas.closest_gap is None:
            raise InputError(
                "`closest_gap` must be given for a smooth body: a film between smooth surfaces "
                "that touch would hold them apart for ever; got nothing",
                key="gas.closest_gap",
            )
        if release is None:
            raise InputError(
                "`release_gap` must be given with a [gas] table: the film takes energy at every "
                "separation, and none beyond it is counted; got nothing",
                key="impact.release_gap",
            )
        if gas.closest_gap is not None and gas.closest_gap >= release:
            raise InputError(
                f"`closest_gap` must be smaller than `release_gap` ({release * 1e9:.6g} nm), or "
                f"the film would never thin; got {gas.closest_gap * 1e9:.6g} nm",
                key="gas.closest_gap",
            )

    def _bounded_liquid(self) -> None:
        """Refuse liquid without end, or on a surface that is not described."""
        air = self.capillary
        if air.model == "none" or self.publication is not None:
            return
        if air.humidity == 1.0 and air.film_thickness is None:
            raise InputError(
                "`humidity` must lie in [0, 1) without a `film_thickness` (at 1 the Kelvin radius "
                "is infinite: menisci would reach to any gap, and only the adsorbed film that they "
                "draw from bounds them); got 1",
                key="capillary.humidity",
            )
        if air.model == "kelvin-filling":
            given, table = air.surface_rms_height is not None, self.roughness
            if (table is not None and table.files is None) != given:
                rule = "must be given with a [roughness] table of numbers"
                if table is None:
                    rule = "must not be given for a smooth body, which has none"
                elif table.files is not None:
                    rule = "must not be given beside `roughness.files`, which it is taken from"
                raise InputError(
                    f"`surface_rms_height` {rule}; got {'a value' if given else 'nothing'}",
                    key="capillary.surface_rms_height",
                )

    def _only_what_the_publication_has(self) -> None:
        """Refuse models that a [publication] table leaves no room for."""
        if self.publication is None:
            return
        if self.roughness is None:
            raise InputError(
                "a [roughness] table must be given with [publication]; got none", key="publication"
            )
        if self.roughness.files is not None:
            raise InputError(
                "`files` must be absent with a [publication] table, which knows Gaussian heights "
                "and one radius alone",
                key="roughness.files",
            )
        if self.gas is not None:
            raise InputError(
                "[gas] must not be given with a [publication] table, which leaves the gas out",
                key="gas",
            )
        wanted = (
            ("counterface.deformation", self.counterface.deformation, ("rigid",)),
            ("adhesion.model", self.adhesion.model, ("dmt", "none")),
            ("capillary.model", self.capillary.model, ("equilibrium", "none")),
            ("capillary.formation", self.capillary.formation, ("contact",)),
            ("capillary.formation_time", self.capillary.formation_time, (None,)),
            ("capillary.film_thickness", self.capillary.film_thickness, (None,)),
        )
        refuse_all(
            InputError(
                f"`{key.split('.')[1]}` must be "
                f"{'absent' if allowed == (None,) else ' or '.join(map(repr, allowed))} with a "
                f"[publication] table, which replaces the other models; got {value!r}",
                key=key,
            )
            for key, value, allowed in wanted
            if value not in allowed
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
                "an [impact] table must be given, with a `speed` or a `release_gap`, for a motion "
                "(`asperity curve` takes --load or --depth without one); got none",
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
        film, angle = self.capillary.film_thickness, self.capillary.contact_angle
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
