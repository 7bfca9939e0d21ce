"""The commands for measured surfaces: ``surface`` and ``generate``.

Like `asperity.cli` itself this module imports typer alone; what carries a command out is imported
once it is called.
"""

from __future__ import annotations

from typing import Annotated

import typer

from asperity.cli.arguments import (
    Folder,
    Force,
    Json,
    Missing,
    Size,
    Unit,
    argument,
    choice,
    optional,
    reports,
)


@reports("surface_command.describe", json=Json)
def surface(
    files: Annotated[
        list[str],
        argument(
            "A measured surface, or two that face each other: .npy .csv .xyz .nc, or an "
            "instrument's.",
            "FILE [FILE2]",
        ),
    ],
    output: Folder = None,
    size: Size = None,
    unit: Unit = None,
    channel: Annotated[
        str | None, optional("channel", "NAME|N", "Channel of an instrument's file.")
    ] = None,
    missing: Missing = None,
    form_removal: Annotated[
        str | None,
        choice(
            "form-removal", "FORM", "none|mean|tilt|curvature|sphere", "tilt",
            "none", "mean", "tilt", "curvature", "sphere",
        ),
    ] = None,
    line_levelling: Annotated[
        str | None,
        choice(
            "line-levelling", "HOW", "Scan lines: none|median|median-difference|polynomial",
            "none", "none", "median", "median-difference", "polynomial",
        ),
    ] = None,
    direction: Annotated[
        str | None,
        choice("direction", "rows|columns", "What a scan line is.", "rows", "rows", "columns"),
    ] = None,
    degree: Annotated[
        int | None, optional("degree", "N", "Degree of a scan line's polynomial.", "1")
    ] = None,
    s_filter: Annotated[
        str | None, optional("s-filter", "LENGTH", "Cut wavelengths below this, such as '50 nm'.")
    ] = None,
    l_filter: Annotated[
        str | None, optional("l-filter", "LENGTH", "Cut wavelengths above this, such as '5 um'.")
    ] = None,
    force: Force = False,
) -> None:  # fmt: skip
    """Describe a measured surface, or two as one.

    With two files the options hold for both. Writes a one-page picture, surface.txt and
    surface.json to DIR, ./NAME-out unless given.
    """


@reports("generating.generate")
def generate(
    file: Annotated[
        str, argument("File to write: .npy .csv .xyz .nc, each also .gz.", "FILE")
    ],
    size: Annotated[
        str | None, optional("size", "'X x Y'", "Size of the map, such as '10 um x 10 um'.")
    ] = None,
    points: Annotated[
        str, typer.Option("--points", metavar="N|NxM", help="Pixels along x and y.")
    ] = "512",
    hurst: Annotated[
        float, typer.Option("--hurst", metavar="H", help="Hurst exponent.")
    ] = 0.8,
    roll_off: Annotated[
        str | None,
        optional("roll-off", "LENGTH", "Wavelength above which the spectrum is flat.", "none"),
    ] = None,
    cut_off: Annotated[
        str | None, optional("cut-off", "LENGTH", "Shortest wavelength.", "two pixels")
    ] = None,
    rms_height: Annotated[
        str | None, optional("rms-height", "LENGTH", "Rms height; this or --rms-slope.")
    ] = None,
    rms_slope: Annotated[
        float | None, optional("rms-slope", "NUMBER", "Rms of the gradient.")
    ] = None,
    seed: Annotated[
        int, typer.Option("--seed", metavar="N", help="Of the random numbers.")
    ] = 0,
    skewness: Annotated[
        float | None, optional("skewness", "S", "Skewness of the heights.", "0")
    ] = None,
    kurtosis: Annotated[
        float | None, optional("kurtosis", "K", "Kurtosis of the heights.", "3, a Gaussian's")
    ] = None,
    heights: Annotated[
        str | None,
        optional(
            "heights", "FILE",
            "Take the distribution of these heights: an .npy of numbers, or "
            "a surface, whose tilt is removed.",
        ),
    ] = None,
    force: Annotated[bool, typer.Option("--force", help="Replace FILE.")] = False,
) -> None:  # fmt: skip
    """Make a self-affine random surface.

    Periodic, with Gaussian heights unless another distribution is asked for. An existing file is
    not overwritten unless --force is given.
    """
