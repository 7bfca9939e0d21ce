"""The commands for studies of many cases: ``sweep``, ``merge``, ``export``, ``sensitivity``.

Like `asperity.cli` itself this module imports typer alone; every command imports what it needs.
"""

from __future__ import annotations

from typing import Annotated

import typer

from asperity.cli import shell_completion
from asperity.cli.arguments import Folder, Json, OnlyJson, Quiet, Verbose, optional

StudyFile = Annotated[
    str,
    typer.Argument(
        metavar="STUDY.toml", help="The study.", show_default=False,
        autocompletion=shell_completion.study,
    ),
]  # fmt: skip
StoreName = Annotated[
    str | None,
    typer.Option(
        "-o", "--output", metavar="NAME.zarr", help="The store.  [default: ./STUDY.zarr]",
        show_default=False,
    ),
]  # fmt: skip
Replace = Annotated[bool, typer.Option("--force", help="Replace what is there.")]
At = Annotated[
    list[str] | None,
    typer.Option(
        "--at", metavar="KEY=VALUE", help="Take an axis' nearest value; may be repeated.",
        show_default=False,
    ),
]  # fmt: skip


def add_to(app: typer.Typer) -> None:
    """Add the commands to the program."""
    for command in (plot, sweep, merge, export, sensitivity):
        app.command()(command)


def sweep(
    study: StudyFile,
    output: StoreName = None,
    resume: Annotated[
        bool, typer.Option("--resume", help="Go on with a store that is there.")
    ] = False,
    repair: Annotated[
        bool, typer.Option("--repair", help="Look through a store; compute damaged tasks again.")
    ] = False,
    shard: Annotated[
        str | None, optional("shard", "i/N", "Compute the i-th of N parts, for a job array.")
    ] = None,
    workers: Annotated[
        int | None,
        typer.Option(
            "--workers", metavar="N", help="Worker processes of a local dask cluster.",
            show_default=False,
        ),
    ] = None,
    scheduler: Annotated[
        str | None, optional("scheduler", "ADDRESS", "A dask scheduler whose workers compute.")
    ] = None,
    yes: Annotated[bool, typer.Option("--yes", help="Compute a very large study.")] = False,
    force: Replace = False,
    as_json: OnlyJson = False,
    quiet: Quiet = False,
    verbose: Verbose = False,
) -> None:  # fmt: skip
    """Compute all cases of a study.

    Writes the store NAME.zarr and, beside it, its manifest and a log. What was finished before an
    interruption is kept.
    """
    from asperity.cli.sweeping import sweep as compute

    compute(
        study, output=output, resume=resume, repair=repair, shard=shard, workers=workers,
        scheduler=scheduler, yes=yes, force=force, as_json=as_json, quiet=quiet,
        verbose=verbose,
    )  # fmt: skip


def merge(
    stores: Annotated[
        list[str],
        typer.Argument(
            metavar="STORE...",
            help="Stores of shards.",
            show_default=False,
            autocompletion=shell_completion.store,
        ),
    ],
    output: StoreName = None,
    force: Replace = False,
    as_json: OnlyJson = False,
    quiet: Quiet = False,
    verbose: Verbose = False,
) -> None:
    """Make one store of those of a study's shards."""
    from asperity.cli.merging import merge as join

    join(
        stores, output=output, force=force, as_json=as_json, quiet=quiet, verbose=verbose
    )  # fmt: skip


def plot(
    record: Annotated[
        str,
        typer.Argument(
            metavar="RECORD|STORE", help="A record.nc, a curve.nc, or a store.",
            autocompletion=shell_completion.record_or_store,
        ),
    ],
    output: Folder = None,
    measure: Annotated[
        str | None,
        optional(
            "measure", "NAME", "Of a store: what to draw.", values=shell_completion.column
        ),
    ] = None,
    x: Annotated[str | None, optional("x", "KEY", "Of a store: the axis to the right.")] = None,
    y: Annotated[str | None, optional("y", "KEY", "Of a store: the axis upwards.")] = None,
    at: At = None,
    pareto: Annotated[
        tuple[str, str] | None,
        typer.Option(
            "--pareto", metavar="SENSE:NAME SENSE:NAME",
            help="Of a store: the front of two measures, each min: or max:.", show_default=False,
        ),
    ] = None,
    force: Annotated[bool, typer.Option("--force", help="Replace pictures in DIR.")] = False,
    as_json: OnlyJson = False,
    quiet: Quiet = False,
    verbose: Verbose = False,
) -> None:  # fmt: skip
    """Draw a record's pictures again, or the results of a study.

    Beside the record, in place of those there, unless DIR is given; of a store to NAME-out.
    """
    from asperity.cli.study_plots import is_store, plot_store

    if is_store(record):
        plot_store(
            record, output=output, force=force, measure=measure, x=x, y=y, at=at or (),
            pareto=pareto, as_json=as_json, quiet=quiet, verbose=verbose,
        )  # fmt: skip
        return
    from asperity.cli.computing import redraw
    from asperity.errors import InputError

    given = {"measure": measure, "x": x, "y": y, "at": at, "pareto": pareto}
    for name, value in given.items():
        if value:
            raise InputError(f"`--{name}` must be given with a store; got a record", file=record)
    redraw(record, output, force=force, as_json=as_json, quiet=quiet, verbose=verbose)


def export(
    source: Annotated[
        str,
        typer.Argument(metavar="STORE|CASE", help="A store, or a case for --force-table.",
                       show_default=False, autocompletion=shell_completion.store_or_case),
    ],
    output: Annotated[
        str | None,
        typer.Option("-o", "--output", metavar="FILE", help="A table: .csv .parquet .nc.",
                     show_default=False),
    ] = None,
    restitution: Annotated[
        str | None,
        optional("restitution", "FILE", "Restitution over speed: .csv .txt .foam .h .dat."),
    ] = None,
    force_table: Annotated[
        str | None, optional("force-table", "FILE", "Force over separation of a case, for LAMMPS.")
    ] = None,
    at: At = None,
    force: Replace = False,
    as_json: OnlyJson = False,
    quiet: Quiet = False,
    verbose: Verbose = False,
) -> None:  # fmt: skip
    """Write results for other programs.

    A table of all cases of a store, the restitution over the impact speed, or the force table of
    one case.
    """
    from asperity.cli.exporting import export as write

    write(
        source, output=output, restitution=restitution, force_table=force_table, at=at or (),
        force=force, as_json=as_json, quiet=quiet, verbose=verbose,
    )  # fmt: skip


def sensitivity(
    study: StudyFile,
    measure: Annotated[
        str, typer.Option("--measure", metavar="NAME", help="The measure.", show_default=False)
    ],
    output: Folder = None,
    force: Replace = False,
    as_json: Json = False,
    quiet: Quiet = False,
    verbose: Verbose = False,
) -> None:
    """Say which axes of a study a measure depends on.

    Sobol indices of first order and in total, with their confidence. Writes a picture and a table
    to DIR, ./STUDY-sensitivity unless given.
    """
    from asperity.cli.attributing import sensitivity as attribute

    attribute(
        study, measure=measure, output=output, force=force, as_json=as_json, quiet=quiet,
        verbose=verbose,
    )  # fmt: skip
