"""A measured surface, or two that face each other: read, prepared and described."""

from __future__ import annotations

import threading
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from ..errors import one_line
from . import Topography
from .description.composite import Composite, composite
from .description.describe import Description, describe
from .description.gaussianity import Gaussianity
from .files.content import digest
from .files.read_surface import read_surface
from .files.reading import Reading
from .preparation.prepare import Preparation, Prepared, prepared

Report = Callable[[float, str], None]

KEYS = (
    "rms_height", "skewness", "kurtosis", "summit_density", "summit_radius", "summit_rms_height",
    "bandwidth", "moments", "gaussian", "missing_pixels", "pixel_size", "physical_size",
)  # fmt: skip
"""What ``--json`` prints of a surface, in SI units."""


@dataclass(frozen=True)
class Treatment:
    """What is said of files beside what they say themselves, and how they are prepared.

    Parameters
    ----------
    size
        Size (x, y) [m] of the maps that do not state it.
    unit
        Unit of the heights that do not state it.
    channel
        Number or name of the channel.
    preparation
        How the maps are prepared.
    """

    size: tuple[float, float] | None = None
    unit: str | None = None
    channel: str | int | None = None
    preparation: Preparation = field(default_factory=Preparation)


@dataclass(frozen=True, eq=False)
class Surface:
    """A surface from a file, with its description.

    Parameters
    ----------
    reading
        The map as it was read.
    prepared
        The map as it was described, and the steps to it.
    description
        What it says.
    input_sha256
        Hash of the file, unpacked where it was packed.
    """

    reading: Reading
    prepared: Prepared
    description: Description
    input_sha256: str

    @property
    def name(self) -> str:
        """Name of the file without its folder, on one line."""
        return one_line(Path(self.reading.topography.source).name)

    @property
    def topography(self) -> Topography:
        """The prepared map."""
        return self.prepared.topography

    def json_object(self) -> dict[str, Any]:
        """What ``--json`` prints; missing pixels are those of the file."""
        found = _chosen(self.description)
        return found | {"missing_pixels": self.prepared.missing_pixels}

    def record(self) -> dict[str, Any]:
        """All figures and how they came about, for ``surface.json``."""
        return {
            **self.description.as_json(),
            "missing_pixels": self.prepared.missing_pixels,
            "format": self.reading.format,
            "channel": self.reading.channel,
            "notes": list(self.reading.notes),
            "preparation": self.prepared.to_json(),
            "input_sha256": self.input_sha256,
        }


@dataclass(frozen=True, eq=False)
class Pair:
    """Two surfaces that face each other.

    Parameters
    ----------
    surfaces
        Either one.
    composite
        Both as one rough surface against a flat.
    description
        Of the sum of their maps.
    """

    surfaces: tuple[Surface, Surface]
    composite: Composite
    description: Description

    @property
    def name(self) -> str:
        """Names of both files."""
        return " + ".join(surface.name for surface in self.surfaces)

    def json_object(self) -> dict[str, Any]:
        """What ``--json`` prints."""
        return {
            "surfaces": [surface.json_object() for surface in self.surfaces],
            "composite": self._composite(_chosen(self.description)),
        }

    def record(self) -> dict[str, Any]:
        """All figures, for ``surface.json``."""
        return {
            "surfaces": [surface.record() for surface in self.surfaces],
            "composite": {
                **self._composite(self.description.as_json()),
                "how": self.composite.how,
                "verdict": self.composite.height_gaussianity.verdict,
            },
        }

    def _composite(self, added: dict[str, Any]) -> dict[str, Any]:
        """Heights by convolution, which needs no common pixel; the rest of the added maps."""
        both, peaks = self.composite.height_gaussianity, self.composite.summit_gaussianity
        heights = _of_heights(both)
        return {
            **added,
            **heights,
            "by_convolution": heights | {"summit_rms_height": peaks and peaks.rms},
            "by_adding": {name: added[name] for name in (*heights, "summit_rms_height")},
        }


def surface(file: str, treatment: Treatment) -> Surface:
    """A surface from a file, prepared and described.

    Raises
    ------
    InputError
        Where the file cannot be read, or a step of the preparation refuses it.
    """
    reading = read_surface(
        file, size=treatment.size, unit=treatment.unit, channel=treatment.channel
    )
    made = prepared(reading.topography, treatment.preparation)
    return Surface(reading, made, describe(made.topography), digest(file))


def pair(first: Surface, second: Surface) -> Pair:
    """Two surfaces and their composite.

    Raises
    ------
    InputError
        If both are flat, or if they share fewer than three pixels a side.
    """
    both = composite(first.topography, second.topography)
    return Pair((first, second), both, describe(both.added))


def surfaces(
    files: tuple[str, ...],
    treatment: Treatment,
    progress: Report | None = None,
    stop: threading.Event | None = None,
) -> Surface | Pair | None:
    """One surface, or two with their composite; None where it was stopped.

    Parameters
    ----------
    files
        One or two.
    treatment
        What holds for each of them.
    progress, stop
        As for :func:`asperity.solve`.

    Raises
    ------
    InputError
        As `surface` and `pair`.
    """
    found: list[Surface] = []
    for number, file in enumerate(files):
        if progress is not None:
            progress(number / 3.0, f"describing {one_line(Path(file).name)}")
        found.append(surface(file, treatment))
        if stop is not None and stop.is_set():
            return None
    if len(found) == 1:
        return found[0]
    if progress is not None:
        progress(2.0 / 3.0, "composite")
    return pair(*found)


def _chosen(description: Description) -> dict[str, Any]:
    """The figures that ``--json`` prints."""
    record = description.as_json()
    found = {key: record[key] for key in KEYS}
    found["gaussian"] = {key: record["gaussian"][key] for key in ("statistic", "p_value")}
    return found


def _of_heights(shape: Gaussianity) -> dict[str, Any]:
    """What a distribution of heights alone can say."""
    return {
        "rms_height": shape.rms,
        "skewness": shape.skewness,
        "kurtosis": shape.kurtosis,
        "gaussian": {"statistic": shape.statistic, "p_value": shape.p_value},
    }
