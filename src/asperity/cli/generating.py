"""``asperity generate``: a self-affine random surface to a file."""

from __future__ import annotations

import re
import shlex
from math import sqrt
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from asperity.cli.options import in_options
from asperity.cli.reporter import Reporter
from asperity.cli.terminal import WIDTH
from asperity.cli.working import Progress, completed
from asperity.errors import InputError, one_line
from asperity.results.summary import amount
from asperity.results.surface_report import pixel_in_words, rows
from asperity.surfaces import Topography
from asperity.surfaces.description.describe import Description, describe
from asperity.surfaces.files.arrays import numbers_of_array
from asperity.surfaces.files.content import MOST_PIXELS, content_of, suffix_of
from asperity.surfaces.files.read_surface import read_surface
from asperity.surfaces.files.write_surface import check_target, write_topography
from asperity.surfaces.generation.generate import self_affine
from asperity.surfaces.generation.self_affine import SpectrumError, spectrum_error
from asperity.surfaces.preparation.form_removal import levelled
from asperity.units import lengths, quantity, shown

_POINTS = re.compile(r"([0-9]{1,9})(?:\s*[x×]\s*([0-9]{1,9}))?")
_GAUSSIAN = (0.0, 3.0)


class _Wanted(NamedTuple):
    """What to make: the arguments of `self_affine`, and how the heights are called."""

    points: tuple[int, int]
    pixel_size: tuple[float, float]
    spectrum: dict[str, Any]
    rest: dict[str, Any]
    words: str


class _Made(NamedTuple):
    """What was made."""

    topography: Topography
    description: Description
    error: SpectrumError | None


def generate(reporter: Reporter, file: str, *, force: bool, **options: Any) -> None:
    """Make a surface, write it, and say what it is.

    Parameters
    ----------
    reporter : Reporter
        What says it.
    file : str
        The file.
    force : bool
        Whether it may be replaced.
    options
        ``size``, ``points``, ``roll_off``, ``cut_off``, ``rms_height`` as text; ``hurst``,
        ``rms_slope``, ``seed``, ``skewness``, ``kurtosis`` as numbers; ``heights``, a file; None
        where one is not given.
    """
    check_target(Path(file), force=force)
    distribution = "kurtosis" if options["heights"] is None else "heights"
    with in_options(heights=distribution):
        wanted = _wanted(options, reporter)
        with reporter.watch(compiles=False) as progress:
            made = completed(lambda stop: _make(wanted, progress))
    with reporter.step("file"):
        write_topography(made.topography, file, force=force)
    reporter.answer(
        lambda: "\n".join(_lines(file, wanted, made)), lambda: _object(file, wanted, made)
    )


def _wanted(options: dict[str, Any], reporter: Reporter) -> _Wanted:
    """The options as numbers, checked as far as one alone can be wrong."""
    points = _points(options["points"])
    if options["size"] is None:
        raise InputError("`size` must be given, such as '10 um x 10 um'; got nothing")
    width, length = lengths(options["size"], 2, "size")
    heights, words = _heights(
        options["heights"], options["skewness"], options["kurtosis"], reporter
    )
    measures = {
        name: None if options[name] is None else quantity(options[name], "m", name)
        for name in ("roll_off", "cut_off", "rms_height")
    }
    return _Wanted(
        points,
        (width / points[0], length / points[1]),
        {
            "hurst": options["hurst"],
            "rolloff": measures["roll_off"],
            "cutoff": measures["cut_off"],
        },
        {
            "rms_height": measures["rms_height"],
            "rms_slope": options["rms_slope"],
            "seed": options["seed"],
            "heights": heights,
        },
        words,
    )


def _points(text: str) -> tuple[int, int]:
    """Pixels along x and y."""
    match = _POINTS.fullmatch(text.strip())
    if match is None:
        raise InputError(f"`points` must be N or NxM, such as 512 or 512x256; got {shown(text)}")
    columns, rows = int(match[1]), int(match[2] or match[1])
    if columns * rows > MOST_PIXELS:
        raise InputError(f"`points` must be at most {MOST_PIXELS} in all; got {shown(text)}")
    return columns, rows


def _heights(
    file: str | None, skewness: float | None, kurtosis: float | None, reporter: Reporter
) -> tuple[tuple[float, float] | np.ndarray | None, str]:
    """The distribution of heights, and its name."""
    moments = (skewness, kurtosis)
    if file is None:
        if moments == (None, None):
            return None, "Gaussian"
        pair = tuple(
            usual if one is None else one for one, usual in zip(moments, _GAUSSIAN, strict=True)
        )
        return (pair[0], pair[1]), f"of skewness {pair[0]:g} and kurtosis {pair[1]:g}"
    if moments != (None, None):
        raise InputError("`heights` and `skewness` or `kurtosis` exclude each other; got both")
    name = one_line(Path(file).name)
    if suffix_of(file) == ".npy":
        return (
            numbers_of_array(content_of(file), file).ravel(),
            f"distributed as the numbers of {name}",
        )
    reading = read_surface(file)
    for line in reading.notes:
        reporter.note(f"asperity: warning: {file}: {line}")
    flat, step = levelled(reading.topography, "tilt")
    known = flat.heights[~flat.missing]
    lost = flat.heights.size - known.size
    left_out = f"; {lost} missing pixels left out" if lost else ""
    return known, f"distributed as those of {name} ({step.words}{left_out})"


def _make(wanted: _Wanted, progress: Progress | None) -> _Made:
    """The surface and what it is; in a thread of its own."""
    if progress is not None:
        progress(0.1, "waves")
    made = self_affine(wanted.points, wanted.pixel_size, **wanted.spectrum, **wanted.rest)
    if progress is not None:
        progress(0.7, "description")
    shaped = wanted.rest["heights"] is not None
    error = spectrum_error(made, **wanted.spectrum) if shaped else None
    return _Made(made, describe(made), error)


def _lines(file: str, wanted: _Wanted, made: _Made) -> list[str]:
    """What was made, and how to describe it."""
    surface, found = made.topography, made.description
    across, down = wanted.points
    width, length = surface.physical_size
    roll_off, cut_off = wanted.spectrum["rolloff"], wanted.spectrum["cutoff"]
    shape = found.heights
    table = [
        ("map", f"{across} x {down} pixels of {pixel_in_words(wanted.pixel_size)}, "
                f"{amount(width, 'm')} x {amount(length, 'm')}"),
        ("Hurst exponent", amount(wanted.spectrum["hurst"])),
        ("roll-off", "none" if roll_off is None else amount(roll_off, "m")),
        ("cut-off", amount(cut_off or 2.0 * max(wanted.pixel_size), "m")),
        ("seed", str(wanted.rest["seed"])),
        ("heights", wanted.words),
        ("rms height", amount(surface.rms_height, "m")),
        ("rms slope", _slope(wanted.rest["rms_slope"], found)),
        ("skewness, kurtosis", f"{amount(shape.skewness if shape else None)}, "
                               f"{amount(shape.kurtosis if shape else None)}"),
        ("m0, m2, m4", f"{amount(found.spectral.m0)} m^2, {amount(found.spectral.m2)}, "
                       f"{amount(found.spectral.m4)} 1/m^2"),
    ]  # fmt: skip
    return [
        f"{file}: a self-affine surface",
        *rows([*table, *_of_error(made.error)]),
        "describe it with:",
        *_command(file, surface),
    ]


def _object(file: str, wanted: _Wanted, made: _Made) -> dict[str, Any]:
    """What was made as plain values, in SI."""
    surface, found, shape = made.topography, made.description, made.description.heights
    spectrum = wanted.spectrum
    return {
        "file": file,
        "points": list(wanted.points),
        "pixel_size": list(wanted.pixel_size),
        "physical_size": list(surface.physical_size),
        "hurst": spectrum["hurst"],
        "roll_off": spectrum["rolloff"],
        "cut_off": spectrum["cutoff"] or 2.0 * max(wanted.pixel_size),
        "seed": wanted.rest["seed"],
        "rms_height": surface.rms_height,
        "rms_slope": sqrt(2.0 * found.spectral.m2),
        "skewness": shape.skewness if shape else None,
        "kurtosis": shape.kurtosis if shape else None,
        "moments": [found.spectral.m0, found.spectral.m2, found.spectral.m4],
        "spectrum_error": None if made.error is None else made.error._asdict(),
    }


def _slope(asked: float | None, found: Description) -> str:
    """The rms slope that was asked for, and that which a description will find."""
    over = f"{amount(sqrt(2.0 * found.spectral.m2))} over neighbouring pixels"
    return over if asked is None else f"{amount(asked)} of the Fourier series, {over}"


def _of_error(error: SpectrumError | None) -> list[tuple[str, str]]:
    """How far the spectrum is from the one asked for, where the heights are imposed."""
    if error is None:
        return []
    return [
        ("spectrum's rms error", f"{error.rms:.2g} of its power within the cut-off"),
        ("beyond the cut-off", f"{error.beyond:.2g} of the mean square height, "
                               f"{error.curvature_beyond:.2g} of the mean square curvature"),
    ]  # fmt: skip


def _command(file: str, surface: Topography) -> list[str]:
    """The command that reads the file back, as a shell takes it; an .npy holds heights alone."""
    command = f"  asperity surface {shlex.quote(file)}"
    if suffix_of(file) != ".npy":
        return [command]
    width, length = surface.physical_size
    options = f'--size "{width!r} m x {length!r} m" --unit m'
    if len(command) + 1 + len(options) <= WIDTH:
        return [f"{command} {options}"]
    return [f"{command} \\", f"    {options}"]
