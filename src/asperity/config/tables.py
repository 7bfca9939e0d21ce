"""The tables of a case."""

from __future__ import annotations

import functools
import math
from typing import Annotated, Any, ClassVar, Literal

from pydantic import BeforeValidator, Field

from asperity.config.adhesion_tables import Adhesion, Capillary
from asperity.config.base_table import Table
from asperity.config.bodies import Body, Counterface, Material
from asperity.config.fields import Quantity, entry
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


class Suspension(Table):
    """A spring and a dashpot between the body and a base at rest; without this table it is free."""

    loss: ClassVar[str] = "damping"
    excludes: ClassVar[dict[str, str]] = {
        "capillary.formation_time": "a motion with menisci that take time knows no spring"
    }

    stiffness: Annotated[float, Quantity("N/m", 1e-9, 1e9)] = entry(
        "N/m", "Stiffness of the spring.", "1 N/m"
    )
    damping: Annotated[float, Quantity("N s/m", 1e-18, 1e3, zero=True)] = entry(
        "N s/m", "Force of the dashpot over the speed; 0 for none.", "1 nN s/m",
        default="0 N s/m",
    )  # fmt: skip
    rest_gap: Annotated[float, Quantity("m", -1.0, 1.0, rule="must lie in [-1, 1] m")] = entry(
        "m",
        "Rigid separation at which the spring is relaxed; below 0 it presses on the surface.",
        "100 nm",
    )

    @property
    def model(self) -> str:
        """The mechanism: a "spring" alone, or one that is "damped"."""
        return "damped" if self.damping > 0.0 else "spring"

    def check_beside(self, case: Any) -> None:
        super().check_beside(case)
        if case.impact is not None:
            self._check_release(case, case.impact)

    def _check_release(self, case: CaseTables, impact: Impact) -> None:
        """Refuse a release from nowhere, and one at rest where nothing moves the body."""
        release = impact.release_separation
        if release is None:
            raise InputError(
                "`release_separation` must be given with a [suspension] table, since the spring's "
                "force depends on it; got nothing",
                key="impact.release_separation",
            )
        density = case.body.solid(case.materials, "body").density
        if density is None or impact.speed is not None:
            return
        weight = density * 4.0 / 3.0 * math.pi * case.body.radius**3 * impact.gravity
        still = self.rest_gap - weight / self.stiffness
        if abs(release - still) <= 1e-9 * abs(release):
            raise InputError(
                f"`release_separation` must differ from {still * 1e9:.6g} nm where there is no "
                "`speed`: there spring and weight hold the body at rest; "
                f"got {release * 1e9:.6g} nm",
                key="impact.release_separation",
            )


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
    suspension: Suspension | None = Field(None, json_schema_extra={"rare": True})
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
