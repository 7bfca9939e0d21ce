"""A measured surface, or two that face each other: read, prepared and described."""

from __future__ import annotations

import threading
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from ..errors import one_line
from . import Topography
from .description.convolution import (
    HeightDistribution,
    convolved,
    distribution_against_gaussian,
    independent_sums,
)
from .description.describe import Description, describe
from .description.gaussianity import Gaussianity, independent_summits
from .description.sum_of_maps import added, adding_in_words
from .description.summits import LEAST_SUMMITS
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
    """Two surfaces that face each other, as one rough surface against a flat one; see `pair`.

    Parameters
    ----------
    surfaces
        Either one.
    description
        Of the sum of their maps: densities and curvatures of the composite come from it.
    heights, summits
        The two height distributions convolved, and those of the summits. The latter is the
        publication's distribution of peaks; None with fewer than ten summits on either.
    height_gaussianity, summit_gaussianity
        Those against the Gaussian.
    """

    surfaces: tuple[Surface, Surface]
    description: Description
    heights: HeightDistribution
    height_gaussianity: Gaussianity
    summits: HeightDistribution | None
    summit_gaussianity: Gaussianity | None

    @property
    def name(self) -> str:
        """Names of both files."""
        return " + ".join(surface.name for surface in self.surfaces)

    @property
    def how(self) -> str:
        """How the maps were added, in words."""
        first, second = self.surfaces
        return adding_in_words(first.topography, second.topography)

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
                "how": self.how,
                "verdict": self.height_gaussianity.verdict,
            },
        }

    def _composite(self, added: dict[str, Any]) -> dict[str, Any]:
        """Heights by convolution, which needs no common pixel; the rest of the added maps."""
        heights, peaks = _of_heights(self.height_gaussianity), self.summit_gaussianity
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
    """Two surfaces that face each other, as one against a flat.

    The publication convolves the two distributions; that needs no common pixel, and it holds
    for surfaces that know nothing of each other. Adding the maps is one sample of it, and
    the only source of the composite's densities and curvatures.

    Raises
    ------
    InputError
        If both are flat, or if they share fewer than three pixels a side.
    """
    one, other = first.description, second.description
    whole = added(first.topography, second.topography)
    heights = convolved(first.topography.heights, second.topography.heights)
    enough = min(one.summits.count, other.summits.count) >= LEAST_SUMMITS
    summits = convolved(one.summits.heights, other.summits.heights) if enough else None
    return Pair(
        surfaces=(first, second),
        description=describe(whole),
        heights=heights,
        height_gaussianity=distribution_against_gaussian(
            heights,
            independent_sums(
                (first.topography.rms_height, second.topography.rms_height),
                (one.independent, other.independent),
            ),
            "composite heights",
        ),
        summits=summits,
        summit_gaussianity=_peaks(summits, one, other) if summits is not None else None,
    )


def _peaks(distribution: HeightDistribution, one: Description, other: Description) -> Gaussianity:
    """The convolved summit heights against the Gaussian."""
    independent = independent_sums(
        (one.summits.rms_height, other.summits.rms_height),
        (
            independent_summits(one.summits.count, one.independent),
            independent_summits(other.summits.count, other.independent),
        ),
    )
    return distribution_against_gaussian(distribution, independent, "composite summit heights")


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
