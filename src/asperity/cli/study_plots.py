"""``asperity plot``: a record's pictures again, or the results of a study, looked at."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from asperity.cli import shell_completion
from asperity.cli.arguments import At, Folder, argument, optional, reports
from asperity.cli.reporter import Reporter, files_of, written_to
from asperity.cli.terminal import WIDTH, wrapped
from asperity.cli.working import completed
from asperity.errors import InputError
from asperity.units import shown

if TYPE_CHECKING:
    import xarray

    from asperity.sweeps.analysis.pareto import Front, Goal
    from asperity.sweeps.store.store import Store

_STORE_FILES = tuple(
    f"{kind}.{ending}"
    for kind in ("lines", "map", "sample", "pareto")
    for ending in ("png", "svg", "csv")
)
_LISTED = 12


def is_store(path: str) -> bool:
    """Whether an argument names the store of a study rather than a record."""
    return Path(path).is_dir() or Path(path).suffix.lower() == ".zarr"


@reports()
def plot(
    reporter: Reporter,
    record: Annotated[
        str,
        argument(
            "A record.nc, a curve.nc, or a store.", "RECORD|STORE",
            values=shell_completion.record_or_store,
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
        optional("pareto", "SENSE:NAME SENSE:NAME",
                 "Of a store: the front of two measures, each min: or max:."),
    ] = None,
    force: Annotated[bool, typer.Option("--force", help="Replace pictures in DIR.")] = False,
) -> None:  # fmt: skip
    """Draw a record's pictures again, or the results of a study.

    Beside the record, in place of those there, unless DIR is given; of a store to NAME-out.
    """
    if not is_store(record):
        given = {"measure": measure, "x": x, "y": y, "at": at, "pareto": pareto}
        for name, value in given.items():
            if value:
                raise InputError(
                    f"`--{name}` must be given with a store; got a record", file=record
                )
        _redraw(record, output, reporter, force=force)
        return
    from asperity.results.results_folder import check_folder, write_folder
    from asperity.sweeps.analysis.pareto import front_of, goal_of
    from asperity.sweeps.analysis.view import at as held_at
    from asperity.sweeps.store.store import Store

    held = held_axes(at or ())
    goals = None if pareto is None else (goal_of(pareto[0]), goal_of(pareto[1]))
    folder = Path(output) if output is not None else _beside(record)
    again = force or output is None
    check_folder(folder, _STORE_FILES, force=again)
    found = Store.open(record)
    found.refuse_empty()
    with reporter.step("results and pictures"):
        dataset, files = completed(
            lambda stop: _drawn(found, measure=measure, x=x, y=y, held=held, pareto=goals)
        )
    written = write_folder(folder, files, tuple(files), force=again)
    _note_missing(dataset, reporter)
    about = {"store": record, **files_of(written)}
    about |= {name: int(dataset.attrs[name]) for name in ("cases", "computed", "failed")}
    if goals is None:
        reporter.answer(lambda: written_to(written), lambda: about)
        return
    chosen, _ = held_at(dataset, held)
    front = front_of(chosen, goals)
    reporter.answer(
        lambda: "\n".join([*_front_lines(chosen, front), "", written_to(written)]),
        lambda: {**about, "front": _front_object(chosen, front)},
    )


def _redraw(record: str, output: str | None, reporter: Reporter, *, force: bool) -> None:
    """Draw the pictures of a record again; beside it, in place of those there, unless told else."""
    from asperity import plots
    from asperity.results.read_record import read
    from asperity.results.results_folder import write_folder

    with reporter.step("record"):
        result = read(record)
    with reporter.step("pictures"):
        pictures = plots.pictures(result)
    if not pictures:
        raise InputError(
            f"{record}: a record must hold its motion to be drawn; it has none", file=record
        )
    folder = Path(record).parent if output is None else Path(output)
    written = write_folder(folder, pictures, tuple(pictures), force=force or output is None)
    reporter.answer(lambda: written_to(written), lambda: {"record": record, **files_of(written)})


def _drawn(
    found: Store, *, measure: str | None, pareto: tuple[Goal, Goal] | None, **view: Any
) -> tuple[xarray.Dataset, dict[str, bytes]]:
    """The results that a picture needs, and its files; in a thread of its own."""
    from asperity.plots import study
    from asperity.sweeps.store.dataset import dataset_of

    wanted = [measure] if measure else [goal.measure for goal in pareto or ()]
    dataset = dataset_of(found, _read_for(found, wanted))
    return dataset, study.pictures(dataset, measure=measure, pareto=pareto, **view)


def _read_for(found: Store, wanted: Sequence[str]) -> list[str]:
    """Columns that a picture of some measures needs; of no certain ones, all that it can show."""
    drawable = [c.name for c in found.columns.values() if c.along not in ("byte", "turn")]
    needed = {"outcome", "captured", *wanted}
    if not wanted or not set(wanted) <= set(drawable):
        return drawable
    return [name for name in drawable if name in needed]


def held_axes(at: Sequence[str]) -> dict[str, str]:
    """Axes and values of ``KEY=VALUE``.

    Raises
    ------
    InputError
        Where a text is of another form, or a key stands twice.
    """
    held: dict[str, str] = {}
    for text in at:
        key, sign, value = text.partition("=")
        if not (sign and key.strip() and value.strip()) or key.strip() in held:
            raise InputError(
                f"`at` must be KEY=VALUE, such as capillary.humidity=0.4, once for a key; "
                f"got {shown(text)}",
                key="at",
            )
        held[key.strip()] = value.strip()
    return held


def _beside(store: str) -> Path:
    path = Path(store)
    return path.with_name(f"{path.name.removesuffix('.zarr')}-out")


def _note_missing(dataset: xarray.Dataset, reporter: Reporter) -> None:
    """Say how many cases are not computed yet, and how many failed."""
    cases, computed = dataset.attrs["cases"], dataset.attrs["computed"]
    if computed < cases:
        reporter.note(
            f"asperity: {cases - computed} of {cases} cases are not computed yet; "
            "`asperity sweep STUDY --resume` goes on"
        )
    if dataset.attrs["failed"]:
        reporter.note(f"asperity: {dataset.attrs['failed']} of {cases} cases failed")


def _front_object(dataset: xarray.Dataset, front: Front) -> dict[str, Any]:
    """The whole front as plain values: axes and measures of its cases, in SI."""
    from asperity.results.record_layout import plain
    from asperity.sweeps.analysis.pareto import axis_values

    held = axis_values(dataset, front.cases[front.best])
    names = [goal.measure for goal in front.goals]
    measures = dict(zip(names, front.values[:, front.best], strict=True))
    found: dict[str, Any] = plain(
        {
            "goals": [str(goal) for goal in front.goals],
            "of": int(front.cases.size),
            "axes": {key: values.tolist() for key, values in held.items()},
            "measures": {name: values.tolist() for name, values in measures.items()},
        }
    )
    return found


def _front_lines(dataset: xarray.Dataset, front: Front) -> list[str]:
    """The front as a table, its first rows where it is long."""
    from asperity.sweeps.analysis.pareto import axis_values
    from asperity.sweeps.analysis.view import words

    names = [goal.measure for goal in front.goals]
    shown_cases = front.best[:_LISTED]
    held = axis_values(dataset, front.cases[shown_cases])
    columns = {**held, **dict(zip(names, front.values[:, shown_cases], strict=True))}
    table = [
        [name, *(words(v, str(dataset[name].attrs.get("units", "1"))) for v in values.tolist())]
        for name, values in columns.items()
    ]
    goals = ", ".join(map(str, front.goals))
    more = front.best.size - shown_cases.size
    return [
        f"Pareto front of {goals}: {front.best.size} of {front.cases.size} cases",
        "",
        *_rows(table),
        *([f"  and {more} more in pareto.csv"] if more else []),
    ]


def _rows(columns: Sequence[Sequence[str]]) -> list[str]:
    """Columns, each under its name, as a table; where that is too wide, a paragraph a case."""
    widths = [max(map(len, column)) for column in columns]
    table = [
        "  " + "  ".join(f"{cell:<{width}}" for cell, width in zip(row, widths, strict=True))
        for row in zip(*columns, strict=True)
    ]
    if max(map(len, table)) <= WIDTH:
        return [row.rstrip() for row in table]
    heads, *cases = zip(*columns, strict=True)
    texts = [", ".join(map(" ".join, zip(heads, case, strict=True))) for case in cases]
    return [line for text in texts for line in wrapped("  " + text, hanging=4)]
