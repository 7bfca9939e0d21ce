"""``asperity plot STORE``: the results of a study, looked at."""

from __future__ import annotations

import importlib
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

import typer

from asperity.cli.reporter import Reporter, files_of, written_to
from asperity.cli.terminal import WIDTH, say, wrapped
from asperity.cli.working import Work
from asperity.errors import InputError
from asperity.units import shown

if TYPE_CHECKING:
    import xarray

    from asperity.sweeps.analysis.pareto import Front
    from asperity.sweeps.store.dataset import Results

_STORE_FILES = tuple(
    f"{kind}.{ending}"
    for kind in ("lines", "map", "sample", "pareto")
    for ending in ("png", "svg", "csv")
)
_LISTED = 12

Answer = TypeVar("Answer")


def is_store(path: str) -> bool:
    """Whether an argument names the store of a study rather than a record."""
    return Path(path).is_dir() or Path(path).suffix.lower() == ".zarr"


def plot_store(
    store: str,
    *,
    output: str | None,
    force: bool,
    measure: str | None = None,
    x: str | None = None,
    y: str | None = None,
    at: Sequence[str] = (),
    pareto: tuple[str, str] | None = None,
    **manner: bool,
) -> None:
    """Draw the results of a study.

    Parameters
    ----------
    store : str
        The store.
    output : str or None
        Folder for the pictures; without it ``NAME-out`` beside the store, where earlier ones are
        replaced.
    force : bool
        Whether earlier pictures there may be replaced.
    measure, x, y : str or None
        What is drawn over what.
    at : sequence of str
        Axes held fixed, as ``KEY=VALUE``.
    pareto : tuple of str or None
        Two goals such as ``min:time_to_rest``, in place of a picture over axes.
    **manner : bool
        As `Reporter` takes them.
    """
    from asperity.results.records import check_folder, write_folder
    from asperity.sweeps.analysis.pareto import front_of, goal_of
    from asperity.sweeps.analysis.view import at as held_at
    from asperity.sweeps.store.dataset import dataset_of, open_results

    reporter, held = Reporter(**manner), held_axes(at)
    goals = None if pareto is None else (goal_of(pareto[0]), goal_of(pareto[1]))
    folder = Path(output) if output is not None else _beside(store)
    again = force or output is None
    check_folder(folder, _STORE_FILES, force=again)
    found = open_results(store)
    found.refuse_empty()
    wanted = [measure] if measure else [goal.measure for goal in goals or ()]

    def draw() -> tuple[xarray.Dataset, dict[str, bytes]]:
        sweep = importlib.import_module("asperity.plots.study")
        dataset = dataset_of(found, _read_for(found, wanted))
        return dataset, sweep.pictures(dataset, measure=measure, x=x, y=y, held=held, pareto=goals)

    with reporter.step("results and pictures"):
        dataset, files = done(draw)
    written = write_folder(folder, files, tuple(files), force=again)
    _note_missing(dataset, reporter)
    about = {"store": store, **files_of(written)}
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


def _read_for(found: Results, wanted: Sequence[str]) -> list[str]:
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


def done(task: Callable[[], Answer]) -> Answer:
    """What a task gives, in a thread so that Ctrl-C is heard; an interruption ends the program."""
    found, code = Work(lambda stop: task()).wait()
    if code or found is None:
        say("asperity: interrupted; nothing was written", whole=True)
        raise typer.Exit(code)
    return found


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
    from asperity.results.records import plain
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
