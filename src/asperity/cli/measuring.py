"""The commands for measured surfaces: ``surface`` and ``generate``.

Like `asperity.cli` itself this module imports typer alone; every command imports what it needs.
"""

from __future__ import annotations

import typer

from asperity.cli.arguments import (
    Channel,
    CutOff,
    Degree,
    Direction,
    Folder,
    Force,
    ForceFile,
    FormRemoval,
    Heights,
    Hurst,
    Json,
    Kurtosis,
    LFilter,
    LineLevelling,
    MadeFile,
    MadeSize,
    Missing,
    OnlyJson,
    Points,
    Quiet,
    RmsHeight,
    RmsSlope,
    RollOff,
    Seed,
    SFilter,
    Size,
    Skewness,
    SurfaceFiles,
    Unit,
    Verbose,
)


def add_surfaces_to(app: typer.Typer) -> None:
    """Add the commands to the program."""
    for command in (surface, generate):
        app.command()(command)


def surface(
    files: SurfaceFiles,
    output: Folder = None,
    size: Size = None,
    unit: Unit = None,
    channel: Channel = None,
    missing: Missing = None,
    form_removal: FormRemoval = None,
    line_levelling: LineLevelling = None,
    direction: Direction = None,
    degree: Degree = None,
    s_filter: SFilter = None,
    l_filter: LFilter = None,
    force: Force = False,
    as_json: Json = False,
    quiet: Quiet = False,
    verbose: Verbose = False,
) -> None:
    """Describe a measured surface, or two as one.

    With two files the options hold for both. Writes a one-page picture, surface.txt and
    surface.json to DIR, ./NAME-out unless given.
    """
    from asperity.cli.surface_command import describe

    describe(
        files, output=output, force=force, as_json=as_json, quiet=quiet, verbose=verbose,
        size=size, unit=unit, channel=channel, missing=missing,
        form_removal=form_removal, line_levelling=line_levelling, direction=direction,
        degree=degree, s_filter=s_filter, l_filter=l_filter,
    )  # fmt: skip


def generate(
    file: MadeFile,
    size: MadeSize = None,
    points: Points = "512",
    hurst: Hurst = 0.8,
    roll_off: RollOff = None,
    cut_off: CutOff = None,
    rms_height: RmsHeight = None,
    rms_slope: RmsSlope = None,
    seed: Seed = 0,
    skewness: Skewness = None,
    kurtosis: Kurtosis = None,
    heights: Heights = None,
    force: ForceFile = False,
    as_json: OnlyJson = False,
    quiet: Quiet = False,
    verbose: Verbose = False,
) -> None:
    """Make a self-affine random surface.

    Periodic, with Gaussian heights unless another distribution is asked for. An existing file is
    not overwritten unless --force is given.
    """
    from asperity.cli.generating import generate as make

    make(
        file, force=force, as_json=as_json, quiet=quiet, verbose=verbose, size=size,
        points=points, hurst=hurst, roll_off=roll_off, cut_off=cut_off,
        rms_height=rms_height, rms_slope=rms_slope, seed=seed, skewness=skewness,
        kurtosis=kurtosis, heights=heights,
    )  # fmt: skip
