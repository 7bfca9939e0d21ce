"""``asperity surface``: a measured surface, or two as one, described."""

from __future__ import annotations

import threading
from collections.abc import Mapping
from dataclasses import fields
from pathlib import Path
from typing import Any

import typer

from asperity.cli.options import in_options
from asperity.cli.reporter import Reporter
from asperity.cli.terminal import say
from asperity.cli.working import Progress, Work, completed
from asperity.errors import InputError
from asperity.results import surface_report
from asperity.results.record_layout import plain
from asperity.results.results_folder import SURFACE_FILES, check_folder, write_folder
from asperity.surfaces.measured_surface import Pair, Surface, Treatment, pair, surface, surfaces
from asperity.surfaces.preparation.prepare import Preparation
from asperity.units import lengths, quantity

_MOST_FILES = 2
_PACKED = ".gz"
_PREPARATION = tuple(field.name for field in fields(Preparation))


def describe(
    reporter: Reporter, files: list[str], *, output: str | None, force: bool, **options: Any
) -> None:
    """Describe one surface or two, keep the answer, and say it.

    Parameters
    ----------
    reporter : Reporter
        What says it.
    files : list of str
        One or two files.
    output : str or None
        Folder for the files.
    force : bool
        Whether earlier results may be replaced.
    options
        As `treatment`.
    """
    if len(files) > _MOST_FILES:
        raise InputError(f"one or two files must be given; got {len(files)}; name two at most")
    asked = treatment(options)
    folder = None
    if output is not None or not reporter.as_json:
        folder = Path(output or "-".join([*map(_stem, files), "out"]))
        check_folder(folder, SURFACE_FILES, force=force)
    with reporter.watch(compiles=False) as progress:
        found = completed(lambda stop: _found(files, asked, progress, stop))
    assert found is not None  # or the program has ended
    for one in found.surfaces if isinstance(found, Pair) else (found,):
        with in_options():
            one.description.summits.at_least()
    _deliver(found, folder, reporter, force=force)


def treatment(options: Mapping[str, Any]) -> Treatment:
    """What the options say of files and of their preparation.

    Parameters
    ----------
    options : mapping
        By name: ``size``, ``unit``, ``channel``, and those of `Preparation`; lengths as text; an
        option that is None or missing is not given.

    Raises
    ------
    InputError
        Where one cannot be used; the message names the option.
    """
    given = {name: value for name, value in options.items() if value is not None}
    with in_options():
        channel = given.pop("channel", None)
        size = given.pop("size", None)
        unit = given.pop("unit", None)
        for name in ("s_filter", "l_filter"):
            if name in given:
                given[name] = quantity(given[name], "m", name)
        width, length = lengths(size, 2, "size") if size is not None else (0.0, 0.0)
        return Treatment(
            None if size is None else (width, length),
            unit,
            int(channel) if channel is not None and channel.isdecimal() else channel,
            Preparation(**given),
        )


def pair_of(files: tuple[str, str], asked: Treatment) -> Pair:
    """Two surfaces and their composite.

    Raises
    ------
    InputError
        Where one cannot be used.
    """
    with in_options(*_PREPARATION):
        return pair(*(surface(file, asked) for file in files))


def _found(
    files: list[str], asked: Treatment, progress: Progress | None, stop: threading.Event
) -> Surface | Pair | None:
    """The description; None where it was stopped."""
    with in_options(*_PREPARATION):
        return surfaces(tuple(files), asked, progress, stop)


def _deliver(
    found: Surface | Pair, folder: Path | None, reporter: Reporter, *, force: bool
) -> None:
    """Write the files and print the answer."""
    with reporter.step("pictures and files"):
        written, code = ([], 0) if folder is None else _keep(found, folder, force=force)
    if code:
        say("asperity: interrupted while drawing; the rest is kept", whole=True)
    reporter.answer(lambda: surface_report.text(found), lambda: plain(found.json_object()))
    reporter.written(written)
    if code:
        raise typer.Exit(code)


def _keep(found: Surface | Pair, folder: Path, *, force: bool) -> tuple[list[Path], int]:
    """Write the files; without pictures, which take seconds, where time presses."""
    # In a thread, where no interruption can be lost in a callback of somebody else's.
    drawn, code = Work(lambda stop: _pictures(found)).wait()
    contents = {**({} if code else drawn or {}), **surface_report.files(found)}
    return write_folder(folder, contents, SURFACE_FILES, force=force), code


def _pictures(found: Surface | Pair) -> dict[str, bytes]:
    from asperity.plots import surface

    return surface.files(found)


def _stem(file: str) -> str:
    """Name of a file without its folder and endings."""
    name = Path(file).name
    if name.lower().endswith(_PACKED):
        name = name[: -len(_PACKED)]
    return name.removesuffix(Path(name).suffix) or "surface"
