"""The table [roughness]: a few numbers, or files of measured surfaces."""

from __future__ import annotations

import dataclasses
from typing import TYPE_CHECKING, Annotated, Any, ClassVar, Literal, Self

from pydantic import Field, model_validator

from asperity.config import fields
from asperity.config.base_table import Table
from asperity.config.fields import Number, entry
from asperity.errors import InputError, refuse_all
from asperity.units import lengths

if TYPE_CHECKING:
    from asperity.surfaces.preparation.prepare import Preparation

REALISATIONS = 1000
"""Single bodies where a case with ``placement = "random"`` names no number."""

BESIDE = 256
"""Single bodies beside a mean of few asperities, where a case leaves `placement` open."""

_NO_OTHER = "they are not solved with it"

NUMBERS = ("asperity_density", "asperity_radius", "rms_height")


class Roughness(Table):
    """Composite roughness of both surfaces; without this table the body is smooth.

    Either three numbers, or `files` of one or two measured surfaces to take them from.
    """

    asperity_density: fields.AreaDensity | None = entry(
        "1/m^2", "Asperities per area.", "6.3e13 1/m^2", default=None, shown=True
    )
    asperity_radius: fields.Length | None = entry(
        "m", "Radius of the asperities' tips.", "450 nm", default=None, shown=True
    )
    rms_height: fields.Length | None = entry(
        "m", "Standard deviation of the asperities' heights, Gaussian.", "1.64 nm",
        default=None, shown=True,
    )  # fmt: skip
    files: Annotated[list[str], Field(min_length=1, max_length=2)] | None = entry(
        "", "One or two measured surfaces, in place of the numbers; from the case's folder.",
        ["surface.csv"], default=None,
    )  # fmt: skip
    source: Literal["gaussian", "summits"] | None = entry(
        "", "With `files`: 'gaussian', fitted to the summits (default), or the 'summits' "
        "themselves, each with its height and radius.", "gaussian", default=None,
    )  # fmt: skip
    size: str | None = entry(
        "", "Size of the maps along x and y, where the files do not say it.", "10 um x 10 um",
        default=None,
    )  # fmt: skip
    unit: str | None = entry(
        "", "Unit of the heights, where the files do not say it.", "nm", default=None
    )
    channel: str | int | None = entry(
        "", "Channel of an instrument's file, by name or number.", "ZSensor", default=None
    )
    missing: Literal["refuse", "keep", "fill"] | None = entry(
        "", "Missing pixels: 'refuse' (default), 'keep' or 'fill'.", "fill", default=None
    )
    form_removal: Literal["none", "mean", "tilt", "curvature", "sphere"] | None = entry(
        "", "Form that is removed: 'tilt' (default), 'none', 'mean', 'curvature' or 'sphere'.",
        "tilt", default=None,
    )  # fmt: skip
    line_levelling: Literal["none", "median", "median-difference", "polynomial"] | None = entry(
        "", "Scan lines: 'none' (default), 'median', 'median-difference' or 'polynomial'.",
        "none", default=None,
    )  # fmt: skip
    direction: Literal["rows", "columns"] | None = entry(
        "", "What a scan line is: 'rows' (default) or 'columns'.", "rows", default=None
    )
    degree: Annotated[int, Number("[0, 5]", whole=True)] | None = entry(
        "1", "Degree of a scan line's polynomial; 1.", 1, default=None
    )
    s_filter: fields.Length | None = entry(
        "m", "Wavelength below which waves are cut.", "10 nm", default=None
    )
    l_filter: fields.Length | None = entry(
        "m", "Wavelength above which waves are cut.", "5 um", default=None
    )
    radius_classes: Annotated[int, Number("[1, 64]", whole=True)] | None = entry(
        "1", "With 'summits': classes of tip radius of the laws that need them; 6.", 6,
        default=None,
    )  # fmt: skip

    placement: Literal["mean", "random", "measured"] | None = entry(
        "", "Summits: their 'mean' over all bodies alone, or beside it single bodies, each on "
        "summits at 'random' places, or put down at a random place of a 'measured' map. Without "
        "it, 256 at random places where that mean is not enough.", "random",
        default=None,
    )  # fmt: skip
    realisations: Annotated[int, Number("[1, 1000000]", whole=True)] | None = entry(
        "1", "With a placement but 'mean': single bodies; 1000.", 1000, default=None
    )
    seed: Annotated[int, Number("[0, 4294967295]", whole=True)] | None = entry(
        "1", "With a placement but 'mean': seed of the places; 0.", 0, default=None
    )

    excludes: ClassVar[dict[str, str]] = dict.fromkeys(
        ("viscoelasticity", "publication"), _NO_OTHER
    )
    of_files: ClassVar[tuple[str, ...]] = (
        "source", "size", "unit", "channel", "missing", "form_removal", "line_levelling",
        "direction", "degree", "s_filter", "l_filter", "radius_classes",
    )  # fmt: skip

    @model_validator(mode="after")
    def _numbers_or_files(self) -> Self:
        numbers = [key for key in NUMBERS if getattr(self, key) is not None]
        if self.files is None:
            self._without_files()
        elif numbers:
            raise InputError(
                f"`{numbers[0]}` and `files` exclude each other: the numbers are taken from the "
                "files; got both",
                key=numbers[0],
            )
        if self.radius_classes is not None and self.source != "summits":
            raise InputError(
                "`radius_classes` must be absent without source = 'summits'; got "
                f"{self.radius_classes}",
                key="radius_classes",
            )
        if not self.single_bodies:
            refuse_all(
                InputError(
                    f"`{key}` must be absent without placement = 'random' or 'measured', which it "
                    f"is for; got {getattr(self, key)}",
                    key=key,
                )
                for key in ("realisations", "seed")
                if getattr(self, key) is not None
            )
        if self.placement == "measured" and self.files is None:
            raise InputError(
                "`placement` must be 'random' without `files`, whose summits have places; got "
                "'measured'",
                key="placement",
            )
        if self.size is not None:
            lengths(self.size, 2, "size")
        if self.files is not None:
            _ = self.preparation  # which refuses what it cannot do
        return self

    def _without_files(self) -> None:
        missing = [key for key in NUMBERS if getattr(self, key) is None]
        beside = [key for key in self.of_files if getattr(self, key) is not None]
        rule = "is missing; give it, or `files` of measured surfaces"
        only = "must be absent without `files`, which it is for"
        refuse_all(
            [
                *(InputError(f"`{key}` {rule}", key=key) for key in missing),
                *(InputError(f"`{k}` {only}; got {getattr(self, k)!r}", key=k) for k in beside),
            ]
        )

    @property
    def single_bodies(self) -> bool:
        """Whether single bodies are asked for beside the mean."""
        return self.placement in ("random", "measured")

    @property
    def preparation(self) -> Preparation:
        """What is done to the files' maps."""
        # Here, since few cases have files, and SciPy's filters take 0.2 s to import.
        from asperity.surfaces.preparation.prepare import Preparation

        given = {field.name: getattr(self, field.name) for field in dataclasses.fields(Preparation)}
        return Preparation(**{key: value for key, value in given.items() if value is not None})

    @property
    def map_size(self) -> tuple[float, float] | None:
        """Size (x, y) of the maps [m], where the case gives it."""
        if self.size is None:
            return None
        width, length = lengths(self.size, 2, "size")
        return width, length

    def check_beside(self, case: Any) -> None:
        if not self.single_bodies:
            return
        found = [*self._excluded(case, "single bodies (`placement`)")]
        if case.capillary.model == "kelvin-filling":
            rule = "must not be 'kelvin-filling' with single bodies (`placement`)"
            found.append(InputError(f"`model` {rule}: {_NO_OTHER}", key="capillary.model"))
        time, rule = case.capillary.formation_time, "with single bodies (`placement`) on a"
        if time and case.counterface.deformation == "half-space":
            found.append(
                InputError(
                    f"`formation_time` must be absent {rule} half-space: {_NO_OTHER}; take "
                    f"deformation = 'rigid', or no `formation_time`; got {time:.6g} s",
                    key="capillary.formation_time",
                )
            )
        refuse_all(found)
