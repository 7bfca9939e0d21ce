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
    Channel,
    CutOff,
    Degree,
    Direction,
    Folder,
    Force,
    ForceFile,
    Heights,
    Hurst,
    Json,
    Kurtosis,
    Long,
    MadeFile,
    MadeSize,
    Missing,
    Points,
    Quiet,
    Refit,
    Remove,
    RmsHeight,
    RmsSlope,
    RollOff,
    Seed,
    Short,
    Size,
    Skewness,
    SurfaceFiles,
    Tables,
    TwoSurfaces,
    Unit,
)
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


def _print_version(wanted: bool) -> None:
    if wanted:
        from importlib.metadata import version

        typer.echo(f"asperity {version('asperity')}")
        raise typer.Exit


@app.callback()
def asperity(
    version: Annotated[
        bool,
        typer.Option(
            "--version", callback=_print_version, is_eager=True, help="Print the version."
        ),
    ] = False,
) -> None:
    """Impact of a small body on a rough surface: bounce or stick, and where the energy goes."""


@app.command()
def run(
    case: CaseName,
    output: Folder = None,
    force: Force = False,
    as_json: Json = False,
    quiet: Quiet = False,
) -> None:
    """Compute a motion: bounce or stick.

    Writes record.nc, pictures and summary.txt to DIR, ./NAME-out unless given.
    """
    _compute("solve", case, output=output, force=force, as_json=as_json, quiet=quiet)


@app.command()
def curve(
    case: CaseName,
    output: Folder = None,
    force: Force = False,
    as_json: Json = False,
    quiet: Quiet = False,
) -> None:
    """Compute force against separation.

    In and out, without motion. Writes curve.nc, a picture and curve.txt to DIR, ./NAME-out unless
    given.
    """
    _compute("curve", case, output=output, force=force, as_json=as_json, quiet=quiet)


def _compute(what: str, case: str, **options: Any) -> None:
    from asperity.cli.computing import compute

    compute(what, case, **options)


@app.command()
def regime(
    case: CaseName,
    as_json: Annotated[bool, typer.Option("--json", help="Print one JSON object, in SI.")] = False,
) -> None:
    """Say which models hold in a case.

    Dimensionless numbers with a verdict on each, at the depth of the first impact. Writes nothing.
    """
    from asperity.cli.regimes import tell_regime

    tell_regime(case, as_json=as_json)


@app.command()
def adhesion_map(
    cases: Annotated[
        list[str], typer.Argument(metavar="CASE...", help="As for run.", show_default=False)
    ],
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
) -> None:
    """Draw the adhesion map with cases on it.

    Writes FILE.png, FILE.svg, and the boundaries and the cases' places as FILE.csv.
    """
    from asperity.cli.regimes import draw_map

    draw_map(cases, output=output, force=force, as_json=as_json)


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
) -> None:
    """Describe a measured surface, or two as one.

    With two files the options hold for both. Writes a one-page picture, surface.txt and
    surface.json to DIR, ./NAME-out unless given.
    """
    from asperity.cli.surfaces import describe

    describe(
        files, output=output, force=force, as_json=as_json, quiet=quiet,
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
    quiet: Quiet = False,
) -> None:
    """Make a self-affine random surface.

    Periodic, with Gaussian heights unless another distribution is asked for. An existing file is
    not overwritten unless --force is given.
    """
    from asperity.cli.generating import generate as make

    make(
        file, force=force, quiet=quiet, size=size, points=points, hurst=hurst, roll_off=roll_off,
        cut_off=cut_off, rms_height=rms_height, rms_slope=rms_slope, seed=seed,
        skewness=skewness, kurtosis=kurtosis, heights=heights,
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
) -> None:
    """Compute the seed publication's tables and figures, and audit it.

    Writes its figures with their data, both tables side by side and the audit to DIR,
    ./reproduce-out unless given.
    """
    from asperity.cli.reproducing import compute

    compute(
        output=output, force=force, refit=refit, tables=tables, as_json=as_json, quiet=quiet,
        surfaces=surfaces, size=size, unit=unit, missing=missing,
    )  # fmt: skip


@app.command()
def init(
    file: Annotated[str, typer.Argument(help="File to write.")] = "case.toml",
) -> None:
    """Write a commented case file.

    An existing file is never overwritten.
    """
    from asperity.cli.listing import write_template

    write_template(file)


@app.command()
def materials(
    as_json: Annotated[bool, typer.Option("--json", help="Print one JSON object, in SI.")] = False,
) -> None:
    """List solids, liquids and gases with their sources."""
    from asperity.cli.listing import list_materials

    list_materials(as_json=as_json)


@app.command()
def web(
    case: Annotated[
        str,
        typer.Argument(help="Case to begin with: as for run, but no record.", show_default=False),
    ] = "published-exact",
    port: Annotated[int, typer.Option("--port", help="Port; 0 for any free one.")] = 8737,
    host: Annotated[
        str, typer.Option("--host", metavar="ADDRESS", help="Address to listen at.")
    ] = "127.0.0.1",
    names: Annotated[
        list[str] | None,
        typer.Option(
            "--name",
            metavar="NAME",
            help="Another name that the page may be asked for by, with --host; repeatable.",
            show_default=False,
        ),
    ] = None,
    browse: Annotated[bool, typer.Option("--open", help="Open the page in the browser.")] = False,
    as_json: Annotated[
        bool, typer.Option("--json", help="Print the page's address as one JSON object.")
    ] = False,
    quiet: Quiet = False,
) -> None:
    """Show a page with sliders in the browser.

    It listens on this machine alone unless --host says otherwise, until Ctrl-C.
    """
    from asperity.cli.showing import show

    show(case, port=port, host=host, names=names or [], browse=browse, as_json=as_json, quiet=quiet)


add_to(app)


def main() -> None:
    """Run the command line; the program's entry point. Never returns."""
    from typer.main import get_command

    from asperity.cli.terminal import leave, prepare

    prepare()
    leave(get_command(app))
