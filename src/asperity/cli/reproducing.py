"""``asperity reproduce``: the seed publication again, with its figures and the audit."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import typer

from asperity.cli.reporter import Reporter
from asperity.cli.terminal import say
from asperity.cli.working import Work
from asperity.errors import InputError, Outcome, SimulationError
from asperity.publication import report
from asperity.publication.published_tables import read_tables
from asperity.publication.reproduce import Reproduction, reproduce
from asperity.results.results_folder import REPRODUCTION_FILES, check_folder, write_folder
from asperity.results.summary import amount

if TYPE_CHECKING:
    from asperity.surfaces.measured_surface import Pair

FOLDER = "reproduce-out"
"""Folder of the files unless another is named."""


def compute(
    reporter: Reporter,
    *,
    output: str | None,
    force: bool,
    refit: bool,
    tables: str | None,
    surfaces: tuple[str, str] | None,
    **options: Any,
) -> None:
    """Compute, keep the result, and say what came out.

    Parameters
    ----------
    reporter : Reporter
        What says it.
    output : str or None
        Folder for the files.
    tables : str or None
        CSV of tables to compare with.
    refit, force : bool
        The options of these names.
    surfaces : tuple of str or None
        Files of the two surfaces of Figures 2 and 3.
    options
        ``size``, ``unit`` and ``missing`` of these files, None where not given.
    """
    read_tables(tables)  # before anything is computed
    _refuse_loose(surfaces, options)
    folder = None
    if output is not None or not reporter.as_json:
        folder = Path(output or FOLDER)
        check_folder(folder, REPRODUCTION_FILES, force=force)
    done, code = _computed(
        tables, refit, None if surfaces is None else (surfaces, options), reporter
    )
    if done is None:
        say("asperity: interrupted before there was anything to keep", whole=True)
        raise typer.Exit(code)
    with reporter.step("figures as pictures, and files"):
        written, code = _keep(done, folder, code, force=force)
    if code:
        say(f"asperity: {Outcome.INTERRUPTED.message}", whole=True)
    reporter.answer(
        lambda: "\n".join([report.brief(done), *_about_surfaces(done)]), done.json_object
    )
    if written:
        reporter.below(_written(written, done))
    if code:
        raise typer.Exit(code)
    if done.problems:
        raise SimulationError("; ".join(done.problems), done)


def _refuse_loose(surfaces: tuple[str, str] | None, options: dict[str, Any]) -> None:
    """Refuse options of measured surfaces where there are none."""
    given = [name for name, value in options.items() if value is not None]
    if given and surfaces is None:
        raise InputError(f"`--{given[0]}` must go with `--surfaces`, whose files it is for")


def _computed(
    tables: str | None,
    refit: bool,
    measured: tuple[tuple[str, str], dict[str, Any]] | None,
    reporter: Reporter,
) -> tuple[Reproduction | None, int]:
    """The reproduction, or what there is of it, and the exit code of an interruption."""
    kept: list[Reproduction] = []
    with reporter.watch() as progress:
        done, code = Work(
            lambda stop: reproduce(
                tables=tables,
                refitted=refit,
                measured=None if measured is None else _pair(*measured),
                progress=progress,
                stop=stop,
                keep=kept.append,
            )
        ).wait()
    return done or (kept[-1] if kept else None), code


def _pair(surfaces: tuple[str, str], options: dict[str, Any]) -> Pair:
    """The measured surfaces, read before anything is computed."""
    from asperity.cli.surface_command import pair_of, treatment

    return pair_of(surfaces, treatment(options))


def _about_surfaces(done: Reproduction) -> list[str]:
    """The composite of the measured surfaces of Figures 2 and 3, where there are any."""
    if done.surfaces is None:
        return []
    both = done.surfaces["composite"]
    shape = f"skewness {amount(both['skewness'])}, kurtosis {amount(both['kurtosis'])}"
    return ["", f"Figures 2 and 3: composite rms height {amount(both['rms_height'], 'm')}, {shape}"]


def _keep(
    done: Reproduction, folder: Path | None, code: int, *, force: bool
) -> tuple[list[Path], int]:
    """Write the files; without figures, which take seconds, where time presses."""
    if folder is None:
        return [], code
    contents = report.files(done)
    if done.drawings and not code:
        # In a thread, where no interruption can be lost in a callback of somebody else's.
        drawn, code = Work(lambda stop: _figures(done)).wait()
        contents |= drawn or {}
    return write_folder(folder, contents, REPRODUCTION_FILES, force=force), code


def _figures(done: Reproduction) -> dict[str, bytes]:
    from asperity.plots import published_figures

    return published_figures.files(done.drawings)


def _written(paths: list[Path], done: Reproduction) -> str:
    """Where the pictures and the rest are."""
    folder = paths[0].parent
    if not any(path.suffix == ".png" for path in paths):
        return f"tables written to {folder}, no figures"
    figures = ", ".join(name.removeprefix("figure-") for name in done.drawings)
    return (
        f"written to {folder}:\n"
        f"  Figures {figures} as figure-N.png and figure-N.svg, their data as figure-N.csv\n"
        "  tables.csv table-1.csv audit.csv reproduction.json summary.txt"
    )
