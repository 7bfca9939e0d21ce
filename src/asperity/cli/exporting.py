"""``asperity export``: the results of a study for other programs."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from asperity.cli import shell_completion
from asperity.cli.arguments import At, Replace, argument, optional, reports
from asperity.cli.reporter import Reporter
from asperity.cli.study_plots import held_axes, is_store
from asperity.cli.working import Progress, completed
from asperity.errors import InputError

if TYPE_CHECKING:
    from asperity.results.result import Curve

Exported = tuple[Path, dict[str, Any]]
"""A file that was written, and what is in it."""


@reports()
def export(
    reporter: Reporter,
    source: Annotated[
        str,
        argument("A store, or a case for --force-table.", "STORE|CASE",
                 values=shell_completion.store_or_case),
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
) -> None:  # fmt: skip
    """Write results for other programs.

    A table of all cases of a store, the restitution over the impact speed, or the force table of
    one case.
    """
    options = {"output": output, "restitution": restitution, "force-table": force_table}
    given = [name for name, file in options.items() if file is not None]
    if len(given) != 1:
        raise InputError(
            f"one of --output, --restitution and --force-table must be given; got "
            f"{' and '.join(f'--{name}' for name in given) or 'none'}"
        )
    if at and restitution is None:
        raise InputError("`at` must go with --restitution; got it without", key="at")
    if force_table is not None:
        written, facts = _export_force(source, force_table, reporter, force=force)
    elif restitution is not None:
        written, facts = _export_restitution(
            source, restitution, held_axes(at or ()), reporter, force=force
        )
    else:
        assert output is not None
        written, facts = _export_table(source, output, reporter, force=force)
    found = {"file": str(written), "bytes": written.stat().st_size, **facts}
    reporter.answer(lambda: f"written to {written}", lambda: found)


def _export_table(source: str, output: str, reporter: Reporter, *, force: bool) -> Exported:
    from asperity.sweeps.analysis.export import export as write
    from asperity.sweeps.store.store import Store

    with reporter.step("table"):
        path: Path = completed(lambda stop: write(source, output, force=force))
    found = Store.open(source)
    columns = [*(axis.key for axis in found.study.axes), *found.columns]
    facts = {"kind": "table", "cases": found.study.size, "done": found.cases_done}
    return path, {**facts, "columns": columns}


def _export_restitution(
    source: str, file: str, held: dict[str, str], reporter: Reporter, *, force: bool
) -> Exported:
    from asperity.sweeps.analysis.restitution_table import (
        COLUMNS,
        restitution_of,
        write_restitution,
    )
    from asperity.sweeps.analysis.view import at
    from asperity.sweeps.store.dataset import dataset_of
    from asperity.sweeps.store.store import Store

    with reporter.step("restitution"):
        found = Store.open(source)
        found.refuse_empty()
        names = [name for name in ("outcome", *COLUMNS) if name in found.columns]
        dataset, taken = at(dataset_of(found, names), held)
        table = restitution_of(dataset, taken)
        path = write_restitution(table, file, force=force)
    speeds, bounces = table.speed.tolist(), table.restitution.tolist()
    return path, {"kind": "restitution", "impact_speed": speeds, "restitution": bounces}


def _export_force(source: str, file: str, reporter: Reporter, *, force: bool) -> Exported:
    from asperity.results.case_source import source_of
    from asperity.sweeps.analysis.force_table import check_force_table, write_force_table

    if is_store(source):
        raise InputError(f"{source}: a table of forces must be of a case; got a store", file=source)
    given = source_of(source)
    check_force_table(Path(file), force=force)

    def task(progress: Progress | None) -> Curve:
        from asperity.solver import curve

        return curve(given.case, progress=progress)

    try:
        with reporter.watch() as progress:
            curve = completed(lambda stop: task(progress))
        path = write_force_table(curve, file, force=force)
    except InputError as error:
        error.file = error.file or given.file
        raise
    for line in curve.warnings:
        reporter.note(f"asperity: warning: {line}")
    return path, {"kind": "force-table", "points": int(curve.rigid_separation.size),
                  "pull_off": curve.pull_off, "loss": curve.loss,
                  "warnings": curve.warnings}  # fmt: skip
