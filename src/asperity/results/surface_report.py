"""A described surface in words and tables, for a terminal and for ``surface.txt``; 80 columns."""

from __future__ import annotations

import json
import platform
import textwrap
from collections.abc import Iterable, Sequence
from importlib.metadata import version
from typing import Any

from ..surfaces import Topography
from ..surfaces.description.describe import Description
from ..surfaces.description.gaussianity import Gaussianity
from ..surfaces.measured_surface import Pair, Surface
from .record_layout import plain
from .summary import WIDTH, amount, listed, underlined, warning_lines

Row = tuple[str, str]

_NAME, _CELL = 22, 17
_TINY = 1e-6


def text(found: Surface | Pair) -> str:
    """What a terminal shows: tables, preparation, effect of the pixel size, verdicts."""
    if isinstance(found, Surface):
        return "\n".join(_of_surface(found))
    blocks = [line for one in found.surfaces for line in (*_of_surface(one), "", "")]
    return "\n".join([*blocks, *_of_pair(found)])


def files(found: Surface | Pair) -> dict[str, bytes]:
    """``surface.txt`` and ``surface.json``, by file name."""
    lines = [text(found), *_provenance(found), ""]
    record = plain({**found.record(), "made_by": _versions()})
    return {
        "surface.txt": "\n".join(lines).encode(),
        "surface.json": json.dumps(record, allow_nan=False, indent=1, ensure_ascii=False).encode(),
    }


def size_in_words(topography: Topography) -> str:
    """Number and size of the pixels, and the size of the map."""
    rows, columns = topography.heights.shape
    width, length = topography.physical_size
    return (
        f"{columns} x {rows} pixels of {pixel_in_words(topography.pixel_size)}, "
        f"{amount(width, 'm')} x {amount(length, 'm')}"
    )


def pixel_in_words(pixel_size: tuple[float, float]) -> str:
    """Size of a pixel; once where it is square."""
    width, length = (amount(step, "m") for step in pixel_size)
    return width if width == length else f"{width} x {length}"


def _of_surface(found: Surface) -> list[str]:
    """All of one surface."""
    reading = found.reading
    channel = f", channel {reading.channel}" if reading.channel else ""
    others = f" of {len(reading.channels)}" if len(reading.channels) > 1 else ""
    count, total = found.prepared.missing_pixels, found.topography.heights.size
    share = f" ({amount(100.0 * count / total)} %)" if count else ""
    return [
        *underlined(found.name),
        *rows(
            [
                ("read as", f"{reading.format}{channel}{others}"),
                ("map", size_in_words(found.topography)),
                ("missing pixels", f"{count} of {total}{share}"),
            ]
        ),
        *listed("Preparation", found.prepared.sentences or ("nothing was done",)),
        *_described(found.description),
        *warning_lines(reading.notes),
    ]


def _of_pair(found: Pair) -> list[str]:
    """The composite of two surfaces."""
    both, peaks = found.height_gaussianity, found.summit_gaussianity
    added = found.description
    tops = added.summits.rms_height if added.summit_heights else None
    cells = [
        ("rms height", amount(both.rms, "m"), amount(added.topography.rms_height, "m")),
        *_shape_cells(both, added.heights),
        ("summit rms height", amount(peaks.rms if peaks else None, "m"), amount(tops, "m")),
    ]
    return [
        *underlined(f"Composite of {found.name}"),
        *_wrapped(f"  Maps {found.how}."),
        *_table("Both ways", ("by convolution", "by adding"), cells),
        *listed("Verdict on the convolution", [both.verdict]),
        *rows([("added maps", size_in_words(added.topography))]),
        *_described(added),
    ]


def _shape_cells(first: Gaussianity, second: Gaussianity | None) -> list[tuple[str, str, str]]:
    """Two distributions side by side."""
    figures = (
        ("skewness", "skewness", amount),
        ("kurtosis", "kurtosis", amount),
        ("Kolmogorov-Smirnov", "statistic", amount),
        ("p-value", "p_value", _chance),
    )
    return [
        (name, show(getattr(first, key)), show(getattr(second, key) if second else None))
        for name, key, show in figures
    ]


def _described(found: Description) -> list[str]:
    """Heights, summits, moments, the effect of the pixel size, verdicts."""
    return [
        *rows(_heights(found), "Heights"),
        *_table("Summits", ("counted", "McCool", "Nayak"), _summits(found)),
        *rows(_moments(found), "Spectral moments of profiles, by finite differences"),
        *_pixels(found),
        *listed("Verdicts", found.verdicts),
    ]


def _heights(found: Description) -> list[Row]:
    shape = found.heights
    rows = [
        ("rms height Sq", amount(found.topography.rms_height, "m")),
        ("peak to valley", amount(found.topography.peak_to_valley, "m")),
    ]
    if shape is None:
        return rows
    worth = f"{amount(shape.statistic)}, p-value {_chance(shape.p_value)}"
    return [
        *rows,
        ("skewness", amount(shape.skewness)),
        ("kurtosis", f"{amount(shape.kurtosis)} (Gaussian 3)"),
        ("Kolmogorov-Smirnov", worth),
    ]


def _summits(found: Description) -> list[tuple[str, ...]]:
    """The counted summits beside those of a Gaussian surface of the same moments."""
    tops, models = found.summits, (found.mccool, found.nayak)
    shape = found.summit_heights

    def modelled(name: str, unit: str) -> list[str]:
        values = [getattr(model, name, None) if model else None for model in models]
        return [amount(value, unit) for value in values]

    rms = tops.rms_height if shape else None
    return [
        ("number", str(tops.count), "-", "-"),
        ("density", amount(tops.density, "1/m^2"), *modelled("density", "1/m^2")),
        ("radius", amount(tops.radius, "m"), *modelled("radius", "m")),
        ("mean radius", amount(tops.mean_radius, "m"), "-", "-"),
        ("median radius", amount(tops.median_radius, "m"), "-", "-"),
        ("mean height", amount(tops.mean_height, "m"), *modelled("mean_height", "m")),
        ("rms height", amount(rms, "m"), *modelled("rms_height", "m")),
        ("skewness", amount(shape.skewness if shape else None, ""), *modelled("skewness", "")),
        ("kurtosis", amount(shape.kurtosis if shape else None, ""), *modelled("kurtosis", "")),
    ]


def _moments(found: Description) -> list[Row]:
    moments = found.spectral
    along, across = moments.slopes
    return [
        ("m0", amount(moments.m0, "m^2")),
        ("m2", amount(moments.m2, "")),
        ("m4", amount(moments.m4, "1/m^2")),
        ("bandwidth m0 m4/m2^2", amount(moments.bandwidth, "")),
        ("rms slope", f"{amount(along)} along x, {amount(across)} along y"),
    ]


def _pixels(found: Description) -> list[str]:
    """The map at every second, fourth, eighth pixel."""
    head = ("pixel", "summits", "density", "radius", "slope", "bandwidth")
    lines = ["", "Effect of the pixel size", _line("every", head, 7, 12)]
    for effect in found.effects:
        cells = (
            pixel_in_words(effect.pixel_size).split(" x ")[0],
            str(effect.count),
            amount(effect.density) if effect.density < 1e3 else f"{effect.density:.3e}",
            amount(effect.radius, "m"),
            amount(effect.rms_slope),
            amount(effect.bandwidth),
        )
        lines.append(_line(str(effect.every), cells, 7, 12))
    return lines


def _chance(value: float | None) -> str:
    """A p-value; a tiny one is extrapolated, and its digits say nothing."""
    return "below 1e-06" if value is not None and value < _TINY else amount(value)


def rows(named: Sequence[Row], title: str = "") -> list[str]:
    """Lines of names and values, under a title where there is one."""
    lines = ["", title] if title else []
    for name, words in named:
        lines += textwrap.wrap(
            words, WIDTH, initial_indent=f"  {name:<{_NAME}}", subsequent_indent=" " * (_NAME + 2)
        )
    return lines


def _table(title: str, columns: Sequence[str], rows: Iterable[Sequence[str]]) -> list[str]:
    """A table with the columns' names beside its title."""
    head = f"{title:<{_NAME + 2}}" + "".join(f"{name:<{_CELL}}" for name in columns)
    body = [
        f"  {name:<{_NAME}}" + "".join(f"{cell:<{_CELL}}" for cell in cells)
        for name, *cells in rows
    ]
    return ["", *(line.rstrip() for line in (head, *body))]


def _line(first: str, cells: Sequence[str], narrow: int, wide: int) -> str:
    return f"{first:>{narrow}}" + "".join(f"{cell:>{wide}}" for cell in cells)


def _wrapped(words: str) -> list[str]:
    return textwrap.wrap(words, WIDTH, initial_indent="", subsequent_indent="  ")


def _provenance(found: Surface | Pair) -> list[str]:
    made = ", ".join(f"{name} {number}" for name, number in _versions().items())
    inputs = found.surfaces if isinstance(found, Pair) else (found,)
    return ["", "Made by", f"  {made}", *(f"  input {one.input_sha256}" for one in inputs)]


def _versions() -> dict[str, Any]:
    names = ("asperity", "numpy", "scipy")
    return {name: version(name) for name in names} | {"python": platform.python_version()}
