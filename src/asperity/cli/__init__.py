"""The command line: ``asperity run``, ``curve``, ``regime``, ``adhesion-map`` and the rest.

Nothing but typer is imported with it, so that ``--help`` answers at once. What a command needs, or
what carries it out where its body is empty, is imported when it is called.
"""

from __future__ import annotations

from typing import Annotated

import typer

from asperity.cli import shell_completion
from asperity.cli.arguments import (
    CaseName,
    Cases,
    Depth,
    Folder,
    Force,
    Json,
    Load,
    Materials,
    Missing,
    OnlyJson,
    Published,
    Quiet,
    Refit,
    Size,
    SpeedPoints,
    Speeds,
    Tables,
    TwoSurfaces,
    Unit,
    Version,
    VersionJson,
    argument,
    optional,
    reports,
)
from asperity.cli.attributing import sensitivity
from asperity.cli.doctor import doctor
from asperity.cli.exporting import export
from asperity.cli.measuring import generate, surface
from asperity.cli.merging import merge
from asperity.cli.study_plots import plot
from asperity.cli.sweeping import sweep
from asperity.cli.terminal import Commands
from asperity.errors import InputError

app = typer.Typer(
    name="asperity",
    cls=Commands,
    help="Impact of a small body on a rough surface: bounce or stick, and where the energy goes.",
    rich_markup_mode=None,
    pretty_exceptions_enable=False,
    no_args_is_help=True,
)


@app.callback(invoke_without_command=True)
def asperity(
    context: typer.Context,
    version: Version = False,
    as_json: VersionJson = False,
) -> None:
    """Impact of a small body on a rough surface: bounce or stick, and where the energy goes."""
    if version:
        from asperity.cli.stack import tell_versions

        tell_versions(as_json=as_json)
        raise typer.Exit
    if as_json:
        raise InputError("`--json` must go with --version, or after a command; got it alone")
    if context.invoked_subcommand is None:
        context.fail("Missing command.")


@reports("computing.run", json=Json)
def run(
    case: CaseName,
    output: Folder = None,
    force: Force = False,
    publication: Published = False,
) -> None:
    """Compute a motion: bounce or stick.

    Writes record.nc, pictures and summary.txt to DIR, ./NAME-out unless given.
    """


@reports("computing.curve", json=Json)
def curve(
    case: CaseName,
    output: Folder = None,
    load: Load = None,
    depth: Depth = None,
    force: Force = False,
) -> None:
    """Compute force against separation.

    Loading and unloading, without motion: to the depth of the case's first impact, or to --load or
    --depth, for which a case needs no [impact] table. Writes curve.nc, a picture and curve.txt to
    DIR, ./NAME-out unless given.
    """


@reports("computing.restitution", json=Json)
def restitution(
    case: CaseName,
    output: Folder = None,
    speeds: Speeds = None,
    points: SpeedPoints = None,
    force: Force = False,
) -> None:
    """Compute restitution against speed, and the critical velocity.

    Of the first impact, over decades of speed. Writes restitution.csv, restitution.json,
    restitution.txt and a picture as PNG and SVG to DIR, ./NAME-out unless given.
    """


@reports("regimes.tell_regime")
def regime(case: CaseName) -> None:
    """Say which models hold in a case.

    Dimensionless numbers with a verdict on each, at the depth of the first impact. Writes nothing.
    """


@reports("regimes.draw_map", json=Json)
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
) -> None:
    """Draw the adhesion map with cases on it.

    Writes FILE.png, FILE.svg, and the boundaries and the cases' places as FILE.csv.
    """


@reports("reproducing.compute", json=Json)
def reproduce(
    output: Folder = None,
    force: Force = False,
    refit: Refit = False,
    tables: Tables = None,
    surfaces: TwoSurfaces = None,
    size: Size = None,
    unit: Unit = None,
    missing: Missing = None,
) -> None:
    """Compute the seed publication's tables and figures, and audit it.

    Writes its figures with their data, both tables side by side and the audit to DIR,
    ./reproduce-out unless given.
    """


def init(
    file: Annotated[str, typer.Argument(help="File to write.")] = "case.toml",
    as_json: OnlyJson = False,
) -> None:
    """Write a commented case file.

    An existing file is never overwritten.
    """
    from asperity.cli.starting import write_template

    write_template(file, as_json=as_json)


def materials(
    names: Materials = None,
    as_json: OnlyJson = False,
) -> None:
    """List solids, liquids, gases and works of adhesion; of those named, their sources."""
    from asperity.cli.starting import list_materials

    list_materials(names or (), as_json=as_json)


def web(
    case: Annotated[
        str | None,
        argument("Case to begin with: as for run, but no record.", values=shell_completion.case),
    ] = None,
    port: Annotated[int, typer.Option("--port", help="Port; 0 for any free one.")] = 8737,
    host: Annotated[
        str, typer.Option("--host", metavar="ADDRESS", help="Address to listen at.")
    ] = "127.0.0.1",
    names: Annotated[
        list[str] | None,
        optional(
            "name",
            "NAME",
            "Another name that the page may be asked for by, with --host; repeatable.",
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
    from asperity.cli.page import show

    show(case, port=port, host=host, names=names or [], browse=browse, as_json=as_json, quiet=quiet)


for command in (
    run, curve, restitution, regime, adhesion_map, surface, generate, reproduce, init, materials,
    web, plot, sweep, merge, export, sensitivity, doctor,
):  # fmt: skip
    app.command()(command)


def main() -> None:
    """Run the command line; the program's entry point. Never returns."""
    from typer.main import get_command

    from asperity.cli.terminal import leave, prepare

    prepare()
    leave(get_command(app))
