"""The command line: ``asperity run``, ``curve``, ``regime``, ``adhesion-map`` and the rest.

This module imports nothing but typer, so that ``--help`` answers at once; every command imports
what it needs when it is called.
"""

from __future__ import annotations

from typing import Annotated, Any

import typer

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

CaseName = Annotated[
    str,
    typer.Argument(
        help="Name of a built-in case (published-exact), a FILE.toml, or a record.nc to repeat.",
        show_default=False,
    ),
]
Folder = Annotated[
    str | None,
    typer.Option("-o", "--output", metavar="DIR", help="Folder for the files.", show_default=False),
]
Force = Annotated[
    bool, typer.Option("--force", help="Replace earlier results in DIR; other files stay.")
]
Json = Annotated[
    bool,
    typer.Option(
        "--json", help="Print one JSON object, in SI units; write files only if -o is given."
    ),
]
Quiet = Annotated[bool, typer.Option("-q", "--quiet", help="Print nothing but errors.")]


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
def reproduce(
    output: Folder = None,
    force: Force = False,
    refit: Annotated[
        bool, typer.Option("--refit", help="Find the unknown inputs again from the tables.")
    ] = False,
    tables: Annotated[
        str | None,
        typer.Option(
            "--tables",
            metavar="FILE.csv",
            help="Tables to compare with, in place of the publication's.",
            show_default=False,
        ),
    ] = None,
    as_json: Json = False,
    quiet: Quiet = False,
) -> None:
    """Compute the seed publication's tables and figures, and audit it.

    Writes its figures with their data, both tables side by side and the audit to DIR,
    ./reproduce-out unless given.
    """
    from asperity.cli.reproducing import compute

    compute(output=output, force=force, refit=refit, tables=tables, as_json=as_json, quiet=quiet)


@app.command()
def plot(
    record: Annotated[str, typer.Argument(help="A record.nc or curve.nc.")],
    output: Folder = None,
    force: Force = False,
) -> None:
    """Draw a record's pictures again.

    Beside the record, in place of those there, unless DIR is given.
    """
    from asperity.cli.computing import redraw

    redraw(record, output, force=force)


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


def main() -> None:
    """Run the command line; the program's entry point. Never returns."""
    from typer.main import get_command

    from asperity.cli.terminal import leave, prepare

    prepare()
    leave(get_command(app))
