"""The command line: ``asperity run``, ``curve``, ``regime``, ``adhesion-map`` and the rest.

This module imports nothing but typer, so that ``--help`` answers at once; every command imports
what it needs when it is called.
"""

from __future__ import annotations

from typing import Annotated, Any

import typer

from asperity.cli.arguments import (
    Align,
    CaseName,
    Cases,
    Channel,
    CutOff,
    Degree,
    Direction,
    Folder,
    Force,
    ForceFile,
    Heights,
    Hurst,
    InstallCompletion,
    Json,
    Kurtosis,
    Long,
    MadeFile,
    MadeSize,
    Materials,
    Missing,
    OnlyJson,
    Points,
    Quiet,
    Refit,
    Remove,
    RmsHeight,
    RmsSlope,
    RollOff,
    Seed,
    Short,
    ShowCompletion,
    Size,
    Skewness,
    SurfaceFiles,
    Tables,
    TwoSurfaces,
    Unit,
    Verbose,
    Version,
    VersionJson,
)
from asperity.cli.checking import doctor
from asperity.cli.studying import add_to
from asperity.cli.terminal import Commands

app = typer.Typer(
    name="asperity",
    cls=Commands,
    help="Impact of a small body on a rough surface: bounce or stick, and where the energy goes.",
    rich_markup_mode=None,
    pretty_exceptions_enable=False,
    add_completion=False,
    no_args_is_help=True,
)


@app.callback(invoke_without_command=True)
def asperity(
    context: typer.Context,
    version: Version = False,
    as_json: VersionJson = False,
    show_completion: ShowCompletion = None,
    install_completion: InstallCompletion = None,
) -> None:
    """Impact of a small body on a rough surface: bounce or stick, and where the energy goes."""
    from asperity.cli.asking import answer

    answer(context, version, as_json, show_completion, install_completion)


@app.command()
def run(
    case: CaseName,
    output: Folder = None,
    force: Force = False,
    as_json: Json = False,
    quiet: Quiet = False,
    verbose: Verbose = False,
) -> None:
    """Compute a motion: bounce or stick.

    Writes record.nc, pictures and summary.txt to DIR, ./NAME-out unless given.
    """
    _compute(
        "solve", case, output=output, force=force, as_json=as_json, quiet=quiet, verbose=verbose
    )


@app.command()
def curve(
    case: CaseName,
    output: Folder = None,
    force: Force = False,
    as_json: Json = False,
    quiet: Quiet = False,
    verbose: Verbose = False,
) -> None:
    """Compute force against separation.

    In and out, without motion. Writes curve.nc, a picture and curve.txt to DIR, ./NAME-out unless
    given.
    """
    _compute(
        "curve", case, output=output, force=force, as_json=as_json, quiet=quiet, verbose=verbose
    )


def _compute(what: str, case: str, **options: Any) -> None:
    from asperity.cli.computing import compute

    compute(what, case, **options)


@app.command()
def regime(
    case: CaseName,
    as_json: OnlyJson = False,
    quiet: Quiet = False,
    verbose: Verbose = False,
) -> None:
    """Say which models hold in a case.

    Dimensionless numbers with a verdict on each, at the depth of the first impact. Writes nothing.
    """
    from asperity.cli.regimes import tell_regime

    tell_regime(case, as_json=as_json, quiet=quiet, verbose=verbose)


@app.command()
def adhesion_map(
    cases: Cases,
    output: Annotated[
        str | None,
        typer.Option(
            "-o",
            "--output",
            metavar="FILE.png",
            help="Picture to write, ./adhesion-map.png unless given.",
            show_default=False,
        ),
    ] = None,
    force: Annotated[bool, typer.Option("--force", help="Replace an earlier map.")] = False,
    as_json: Json = False,
    quiet: Quiet = False,
    verbose: Verbose = False,
) -> None:
    """Draw the adhesion map with cases on it.

    Writes FILE.png, FILE.svg, and the boundaries and the cases' places as FILE.csv.
    """
    from asperity.cli.regimes import draw_map

    draw_map(
        cases, output=output, force=force, as_json=as_json, quiet=quiet, verbose=verbose
    )  # fmt: skip


@app.command()
def surface(
    files: SurfaceFiles,
    output: Folder = None,
    size: Size = None,
    unit: Unit = None,
    channel: Channel = None,
    missing: Missing = None,
    remove: Remove = None,
    align: Align = None,
    direction: Direction = None,
    degree: Degree = None,
    short: Short = None,
    long: Long = None,
    force: Force = False,
    as_json: Json = False,
    quiet: Quiet = False,
    verbose: Verbose = False,
) -> None:
    """Describe a measured surface, or two as one.

    With two files the options hold for both. Writes a one-page picture, surface.txt and
    surface.json to DIR, ./NAME-out unless given.
    """
    from asperity.cli.surfaces import describe

    describe(
        files, output=output, force=force, as_json=as_json, quiet=quiet, verbose=verbose,
        size=size, unit=unit, channel=channel, missing=missing, remove=remove, align=align,
        direction=direction, degree=degree, short=short, long=long,
    )  # fmt: skip


@app.command()
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


@app.command()
def reproduce(
    output: Folder = None,
    force: Force = False,
    refit: Refit = False,
    tables: Tables = None,
    surfaces: TwoSurfaces = None,
    size: Size = None,
    unit: Unit = None,
    missing: Missing = None,
    as_json: Json = False,
    quiet: Quiet = False,
    verbose: Verbose = False,
) -> None:
    """Compute the seed publication's tables and figures, and audit it.

    Writes its figures with their data, both tables side by side and the audit to DIR,
    ./reproduce-out unless given.
    """
    from asperity.cli.reproducing import compute

    compute(
        output=output, force=force, refit=refit, tables=tables, as_json=as_json, quiet=quiet,
        verbose=verbose, surfaces=surfaces, size=size, unit=unit, missing=missing,
    )  # fmt: skip


@app.command()
def init(
    file: Annotated[str, typer.Argument(help="File to write.")] = "case.toml",
    as_json: OnlyJson = False,
) -> None:
    """Write a commented case file.

    An existing file is never overwritten.
    """
    from asperity.cli.listing import write_template

    write_template(file, as_json=as_json)


@app.command()
def materials(
    names: Materials = None,
    as_json: OnlyJson = False,
) -> None:
    """List solids, liquids and gases with their sources."""
    from asperity.cli.listing import list_materials

    list_materials(names or (), as_json=as_json)


add_to(app)
app.command()(doctor)


def main() -> None:
    """Run the command line; the program's entry point. Never returns."""
    from typer.main import get_command

    from asperity.cli.terminal import leave, prepare

    prepare()
    leave(get_command(app))
