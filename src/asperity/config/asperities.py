"""What the roughness of a case is made of: its numbers, or what its files were found to be."""

from __future__ import annotations

import functools
import json
from math import sqrt
from pathlib import Path
from typing import TYPE_CHECKING, Any

from asperity.config.roughness import Roughness
from asperity.errors import InputError
from asperity.inputs import Asperities

if TYPE_CHECKING:
    import numpy as np

    from asperity.surfaces.description.summits import Summits
    from asperity.surfaces.files.reading import Reading
    from asperity.surfaces.preparation.prepare import Prepared
    from asperity.surfaces.topography import Topography

LARGEST_ASPERITY = 1.0
"""Asperity radius over body radius: what is larger than the body is no bump on it."""

ROUGHEST = 0.5
"""Rms height over body radius: 1 in 44 asperities is then as high as the body's radius."""


def asperities_of(rough: Roughness) -> Asperities:
    """The asperities that a table describes; its files are read once for each state of theirs.

    Raises
    ------
    InputError
        If a file cannot be used; the message names file, rule and remedy.
    """
    if rough.files is None:
        assert rough.asperity_density is not None
        assert rough.asperity_radius is not None
        assert rough.rms_height is not None
        return Asperities(rough.asperity_density, rough.asperity_radius, rough.rms_height)
    return _measured(rough.model_dump_json(), tuple(_state(file) for file in rough.files))


def refuse_asperities(radius: float, rough: Asperities) -> None:
    """Refuse asperities larger than the body, or nearly as high.

    Parameters
    ----------
    radius
        Radius of the body [m].
    rough
        Its asperities.

    Raises
    ------
    InputError
        With the rule and its number.
    """
    tip, height = rough.asperity_radius, rough.rms_height
    measured = rough.facts is not None
    if tip > LARGEST_ASPERITY * radius:
        raise InputError(
            f"`asperity_radius` must be at most the body's radius ({radius * 1e6:.6g} um): an "
            f"asperity larger than the body is not a bump on it; got {tip * 1e6:.6g} um",
            key="roughness.files" if measured else "roughness.asperity_radius",
        )
    if height >= ROUGHEST * radius:
        raise InputError(
            f"`rms_height` must be smaller than {ROUGHEST:g} of the body's radius "
            f"({radius * 1e6:.6g} um): 1 in 44 asperities would be as high as that radius; got "
            f"{height * 1e6:.6g} um",
            key="roughness.files" if measured else "roughness.rms_height",
        )


def _state(file: str) -> tuple[int, int]:
    """What changes with a file; of none, nothing: reading it will say so."""
    try:
        status = Path(file).stat()
    except (OSError, ValueError):
        return 0, 0
    return status.st_size, status.st_mtime_ns


@functools.lru_cache(maxsize=4)
def _measured(table: str, states: tuple[tuple[int, int], ...]) -> Asperities:
    """The asperities of the files of a table, as JSON, while the files are as they are."""
    # Here, since few cases have files, and what reads them takes 0.3 s to import.
    from asperity.surfaces.description.sum_of_maps import added, adding_in_words
    from asperity.surfaces.description.summits import find_summits
    from asperity.surfaces.files.read_surface import read_surface
    from asperity.surfaces.preparation.prepare import prepared

    rough = Roughness.model_construct(**json.loads(table))
    assert rough.files is not None
    maps, facts, warnings = [], [], []
    for file in rough.files:
        reading = read_surface(file, size=rough.map_size, unit=rough.unit, channel=rough.channel)
        done = prepared(reading.topography, rough.preparation)
        maps.append(done.topography)
        facts.append(_facts_of(file, reading.channel, done))
        warnings += _said(file, reading, done, rough)
    whole, how = maps[0], None
    if len(maps) == 2:
        whole, how = added(*maps), adding_in_words(*maps)
        if not how.endswith("centres"):  # cropped, or taken at other pixels
            warnings.append(f"the two maps were {how}")
    found = find_summits(whole).at_least()
    values = _found(found, whole)
    summary = {"source": rough.source or "gaussian", "files": facts, "added": how, **values}
    return Asperities(
        values["asperity_density"], found.radius, found.rms_height, found.mean_height, whole,
        found, summary, (*warnings, *_doubts(found, rough)),
    )  # fmt: skip


def _said(file: str, reading: Reading, done: Prepared, rough: Roughness) -> list[str]:
    """What the reading and the preparation of a file leave to be said."""
    out = [f"{file}: {note}" for note in reading.notes]
    if rough.channel is None and len(reading.channels) > 1:
        out.append(f"{file}: channel {reading.channel} was read, of {', '.join(reading.channels)}")
    if done.missing_pixels:
        out.append(
            f"{file}: {done.missing_pixels} of {done.topography.heights.size} pixels are missing "
            f"(missing = '{rough.preparation.missing}')"
        )
    return out


def _found(found: Summits, whole: Topography) -> dict[str, Any]:
    """What was found on a surface; its density is that of the part where pixels were measured."""
    return {
        "asperity_density": found.density / (found.searched or 1.0),
        "asperity_radius": found.radius,
        "rms_height": found.rms_height,
        "mean_height": found.mean_height,
        "surface_rms_height": whole.rms_height,
        "summits": found.count,
        "skewness": _skewness(found.heights),
        "pixel_size": list(whole.pixel_size),
        "physical_size": list(whole.physical_size),
    }


def _facts_of(file: str, channel: str, done: Prepared) -> dict[str, Any]:
    from asperity.surfaces.files.content import digest

    return {
        "file": file,
        "sha256": digest(file),
        "channel": channel or None,
        "prepared": list(done.sentences),
        "missing_pixels": done.missing_pixels,
        "rms_height": done.topography.rms_height,
    }


def _skewness(heights: np.ndarray) -> float:
    deviation = heights - heights.mean()
    return float((deviation**3).mean() / (deviation**2).mean() ** 1.5)


_SKEWED = 5.0
"""Standard errors of the skewness from which summits are called skewed."""


def _doubts(found: Summits, rough: Roughness) -> list[str]:
    """What a fit by Gaussian heights and one radius leaves out."""
    if rough.source == "summits":
        return []
    skewness, count = _skewness(found.heights), found.count
    out = []
    if abs(skewness) > _SKEWED * sqrt(6.0 / count):
        out.append(
            f"the summits' heights are skewed ({skewness:+.2g}) and source = 'gaussian' takes them "
            "as Gaussian: take source = 'summits'"
        )
    return out
