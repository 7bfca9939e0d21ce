"""The tables of the motion and its numerics: [impact], [numerics], [output]."""

from __future__ import annotations

from typing import Annotated, Self

from pydantic import BeforeValidator, model_validator

from asperity.config import fields
from asperity.config.base_table import Table
from asperity.config.fields import Number, entry
from asperity.errors import InputError, Tolerance
from asperity.units import shown

_NUMERICS = Tolerance()


class Impact(Table):
    """How the body is let go."""

    release_separation: fields.Length | None = entry(
        "m",
        "Rigid separation at the release; the solver chooses it where only `speed` is given.",
        "1 um",
        default=None,
        shown=True,
    )
    speed: fields.Speed | None = entry(
        "m/s", "Speed towards the surface at the release; without it, from rest.", "0.1 m/s",
        default=None,
    )  # fmt: skip
    gravity: fields.Acceleration = entry(
        "m/s^2", "Acceleration towards the surface; may be zero.", "9.81 m/s^2",
        default="9.81 m/s^2",
    )  # fmt: skip

    @model_validator(mode="after")
    def _moves(self) -> Self:
        if self.release_separation is None and self.speed is None:
            raise InputError(
                "`release_separation` or `speed` must be given; got neither",
                key="release_separation",
            )
        return self


class Numerics(Table):
    """How closely to solve and when to stop."""

    tolerance: Annotated[float, Number("[1e-12, 1e-3]")] = entry(
        "1", "Relative error allowed to the force curves.", 1e-8, default=_NUMERICS.relative
    )
    rest_height_ratio: Annotated[float, Number("(0, 1)")] = entry(
        "1", "At rest below this fraction of the first rebound.", 1e-3, default=_NUMERICS.rest
    )
    time_limit: fields.Time | None = entry(
        "s", "Longest simulated time; without it, none.", "10 ms", default=None
    )
    max_impacts: Annotated[int, Number("[1, 100000]", whole=True)] = entry(
        "1", "Largest number of impacts.", 200, default=_NUMERICS.max_impacts
    )
    rings: Annotated[int, Number("[16, 400]", whole=True)] = entry(
        "1",
        "Rings that resolve the conjunction; the next multiple of 8 is taken.",
        80,
        default=_NUMERICS.rings,
    )


def _path(value: object) -> object:
    if isinstance(value, str) and (not value.strip() or "\0" in value):
        raise InputError(f"`directory` must be a folder's path; got {shown(value)}")
    return value


class Output(Table):
    """What a run writes."""

    directory: Annotated[str | None, BeforeValidator(_path)] = entry(
        "", "Folder for the files; without it ./NAME-out.", "drop-out", default=None
    )
    motion: bool = entry(
        "", "Whether the record keeps the arrays of the motion, not its measures alone.", True,
        default=True,
    )  # fmt: skip
    pictures: bool = entry("", "Whether pictures are drawn.", True, default=True)
