"""``asperity plot STORE`` and ``asperity export``: the results of a study, looked at."""

from __future__ import annotations

import importlib
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, TypeVar

import typer

from asperity.cli.terminal import say, tell
from asperity.cli.working import Work
from asperity.errors import InputError
from asperity.units import shown

if TYPE_CHECKING:
    import xarray

    from asperity.result import Curve
    from asperity.studies.sweep.dataset import Results
    from asperity.studies.sweep.pareto import Front

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
        Two goals such as ``min:stiction_time``, in place of a picture over axes.
    """
    from asperity.records import check_folder, write_folder
    from asperity.studies.sweep.dataset import dataset_of, open_results
    from asperity.studies.sweep.pareto import front_of, goal_of
    from asperity.studies.sweep.view import at as held_at

    held = _held(at)
    goals = None if pareto is None else (goal_of(pareto[0]), goal_of(pareto[1]))
    folder = Path(output) if output is not None else _beside(store)
    again = force or output is None
    check_folder(folder, _STORE_FILES, force=again)
    found = open_results(store)
    found.refuse_empty()
    wanted = [measure] if measure else [goal.measure for goal in goals or ()]

    def draw() -> tuple[xarray.Dataset, dict[str, bytes]]:
        sweep = importlib.import_module("asperity.plots.sweep")
        dataset = dataset_of(found, _read_for(found, wanted))
        return dataset, sweep.pictures(dataset, measure=measure, x=x, y=y, held=held, pareto=goals)

    dataset, files = done(draw)
    written = write_folder(folder, files, tuple(files), force=again)
    _tell_missing(dataset)
    if goals is not None:
        chosen, _ = held_at(dataset, held)
        tell("\n".join([*_front_lines(chosen, front_of(chosen, goals)), ""]))
    tell(written_to(written))


def export(
    source: str,
    *,
    output: str | None = None,
    restitution: str | None = None,
    force_table: str | None = None,
    at: Sequence[str] = (),
    force: bool = False,
) -> None:
    """Write a study's results, or what a particle code reads of a study or a case.

    Parameters
    ----------
    source : str
        A store; a case for ``force_table``.
    output : str or None
        File for all results: ``.csv``, ``.parquet`` or ``.nc``.
    restitution : str or None
        File for restitution against impact speed.
    force_table : str or None
        File for force against distance.
    at : sequence of str
        Axes held fixed for ``restitution``, as ``KEY=VALUE``.
    force : bool
        Whether files may be replaced.
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
        written = _export_force(source, force_table, force=force)
    elif restitution is not None:
        written = _export_restitution(source, restitution, _held(at), force=force)
    else:
        assert output is not None
        written = _export_table(source, output, force=force)
    tell(f"written to {written}")


def _read_for(found: Results, wanted: Sequence[str]) -> list[str]:
    """Columns that a picture of some measures needs; of no certain ones, all that it can show."""
    drawable = [c.name for c in found.columns.values() if c.along not in ("byte", "turn")]
    needed = {"outcome", "captured", *wanted}
    if not wanted or not set(wanted) <= set(drawable):
        return drawable
    return [name for name in drawable if name in needed]


def _held(at: Sequence[str]) -> dict[str, str]:
    """Axes and values of ``KEY=VALUE``."""
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
        say("asperity: interrupted; nothing was written")
        raise typer.Exit(code)
    return found


def _tell_missing(dataset: xarray.Dataset) -> None:
    """Say how many cases are not computed yet, and how many failed."""
    cases, computed = dataset.attrs["cases"], dataset.attrs["computed"]
    if computed < cases:
        say(
            f"asperity: {cases - computed} of {cases} cases are not computed yet; "
            "`asperity sweep STUDY --resume` goes on"
        )
    if dataset.attrs["failed"]:
        say(f"asperity: {dataset.attrs['failed']} of {cases} cases failed")


def _front_lines(dataset: xarray.Dataset, front: Front) -> list[str]:
    """The front as a table, its first rows where it is long."""
    from asperity.studies.sweep.pareto import axis_values
    from asperity.studies.sweep.view import words

    names = [goal.measure for goal in front.goals]
    shown_cases = front.best[:_LISTED]
    held = axis_values(dataset, front.cases[shown_cases])
    columns = {**held, **dict(zip(names, front.values[:, shown_cases], strict=True))}
    table = [
        [name, *(words(v, str(dataset[name].attrs.get("units", "1"))) for v in values.tolist())]
        for name, values in columns.items()
    ]
    widths = [max(map(len, column)) for column in table]
    rows = [
        "  ".join(f"{cell:<{width}}" for cell, width in zip(row, widths, strict=True)).rstrip()
        for row in zip(*table, strict=True)
    ]
    goals = ", ".join(map(str, front.goals))
    more = front.best.size - shown_cases.size
    return [
        f"Pareto front of {goals}: {front.best.size} of {front.cases.size} cases",
        "",
        *(f"  {row}" for row in rows),
        *([f"  and {more} more in pareto.csv"] if more else []),
    ]


def _export_table(source: str, output: str, *, force: bool) -> Path:
    from asperity.studies.sweep.export import export as write

    path: Path = done(lambda: write(source, output, force=force))
    return path


def _export_restitution(source: str, file: str, held: dict[str, str], *, force: bool) -> Path:
    from asperity.studies.sweep.dataset import dataset_of, open_results
    from asperity.studies.sweep.restitution_table import restitution_of, write_restitution
    from asperity.studies.sweep.view import at

    found = open_results(source)
    found.refuse_empty()
    names = [n for n in ("outcome", "impact_speed", "restitution") if n in found.columns]
    dataset, taken = at(dataset_of(found, names), held)
    return write_restitution(restitution_of(dataset, taken), file, force=force)


def _export_force(source: str, file: str, *, force: bool) -> Path:
    from asperity.cli.sources import source as case_of
    from asperity.studies.sweep.force_table import check_force_table, write_force_table

    if is_store(source):
        raise InputError(f"{source}: a table of forces must be of a case; got a store", file=source)
    given = case_of(source)
    check_force_table(Path(file), force=force)

    def task() -> Curve:
        curve: Curve = importlib.import_module("asperity.solver").curve(given.case, name=given.name)
        return curve

    try:
        return write_force_table(done(task), file, force=force)
    except InputError as error:
        error.file = error.file or given.file
        raise


def written_to(paths: Sequence[Path]) -> str:
    """What was written, and where, in words."""
    return f"written to {paths[0].parent}:\n  {' '.join(path.name for path in paths)}"
