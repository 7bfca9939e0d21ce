"""A folder of results: written aside and then renamed, so that no file is ever half there."""

from __future__ import annotations

import contextlib
import os
import secrets
import shutil
from collections.abc import Collection, Iterator, Mapping
from pathlib import Path

from asperity.errors import InputError, OutputError
from asperity.writing import told

RUN_FILES = (
    "record.nc",
    *(f"{name}.{kind}" for name in ("motion", "forces", "energy") for kind in ("png", "svg")),
    "summary.txt",
)
"""Names that a run writes."""

SINGLE_BODY_FILES = tuple(
    f"{name}.{kind}" for name in ("bodies", "summits") for kind in ("png", "svg")
)
"""Names that a run with single bodies writes besides."""

CURVE_FILES = ("curve.nc", "curve.png", "curve.svg", "curve.txt")
"""Names that a curve may write. They stand beside those of a run without touching them."""

RESTITUTION_FILES = tuple(f"restitution.{kind}" for kind in ("csv", "json", "png", "svg", "txt"))
"""Names that restitution against speed may write, beside the others too."""

SURFACE_FILES = (
    *(f"{name}.{kind}" for name in ("surface", "surface-1", "surface-2", "composite")
      for kind in ("png", "svg")),
    "surface.json", "surface.txt",
)  # fmt: skip
"""Names that `asperity surface` may write, beside the others too."""

REPRODUCTION_FILES = (
    *(f"figure-{number}.{kind}" for number in ("1", "2", "3", "4", "5", "6", "7a", "7b", "8", "9")
      for kind in ("png", "svg", "csv")),
    "tables.csv", "table-1.csv", "audit.csv", "reproduction.json", "summary.txt",
)  # fmt: skip
"""Names that `asperity reproduce` may write."""


_TOGETHER = (*RUN_FILES, *SINGLE_BODY_FILES, *CURVE_FILES, *RESTITUTION_FILES, *SURFACE_FILES)


def holds_only_results(directory: str | os.PathLike[str]) -> bool:
    """Whether a folder holds files of a run, a curve, restitution or a surface, and nothing else.

    Parameters
    ----------
    directory : path
        The folder.
    """
    target = Path(directory)
    try:
        return all(entry.name in _TOGETHER and entry.is_file() for entry in target.iterdir())
    except OSError:
        return False


def check_folder(
    directory: str | os.PathLike[str], own: Collection[str], *, force: bool = False
) -> None:
    """See to it, before anything is computed, that results can go into a folder.

    Parameters
    ----------
    directory : path
        The folder; it need not be there.
    own : collection of str
        Names of the files to come.
    force : bool
        Whether files of these names may be replaced.

    Raises
    ------
    InputError
        Where the folder is not empty and ``force`` is not set. The files of a run, of a curve, of
        restitution against speed and of a surface do not count for each other.
    OutputError
        Where nothing can be written there.
    """
    target = Path(directory)
    with told(target):
        _refuse_occupied(target, own, force=force)
        place = target
        while not place.exists() and place != place.parent:
            place = place.parent
        trial = _aside(place)
        trial.rmdir()


def write_folder(
    directory: str | os.PathLike[str],
    files: Mapping[str, bytes],
    own: Collection[str],
    *,
    force: bool = False,
) -> list[Path]:
    """Write files into a folder, all or none.

    Parameters
    ----------
    directory : path
        The folder, made where it is missing.
    files : mapping of str to bytes
        Contents by name.
    own : collection of str
        Names that the same kind of result may have; those not in ``files`` are what an earlier
        result left, and go. No other file is touched.
    force : bool
        Whether files of these names may be replaced.

    Returns
    -------
    list of Path
        The files, in the order of ``own``.

    Raises
    ------
    InputError, OutputError
        As `check_folder`; the folder is then as it was before.
    """
    target = Path(directory)
    with told(target), _parents(target):
        _refuse_occupied(target, own, force=force)
        there = target.is_dir()
        aside = _aside(target if there else target.parent)
        try:
            for name, content in files.items():
                with told(target / name):
                    (aside / name).write_bytes(content)
            if there:
                _move_in(aside, target, files, own)
            else:
                aside.rename(target)
        finally:
            shutil.rmtree(aside, ignore_errors=True)
    return [target / name for name in own if name in files]


def _move_in(aside: Path, target: Path, files: Collection[str], own: Collection[str]) -> None:
    for name in files:
        with told(target / name):
            (aside / name).replace(target / name)
    for name in own:
        if name not in files:
            (target / name).unlink(missing_ok=True)


def _refuse_occupied(target: Path, own: Collection[str], *, force: bool) -> None:
    if not target.exists():
        if target.is_symlink():
            raise OutputError(f"{target}: cannot be written: a link to nowhere", path=str(target))
        return
    found = {entry.name: entry for entry in target.iterdir()}
    if not force:
        results = sorted(set(own) & set(found))
        strange = sorted(set(found) - set(_TOGETHER) - set(own))
        kept = [*strange, *results]
        if kept:
            more = " and others" if len(kept) > 1 else ""
            held = f"{kept[0]}{more}" if strange else f"results of another case ({kept[0]}{more})"
            raise InputError(
                f"{target}: folder must be empty, or --force replaces the results in it and "
                f"leaves the rest; got {held}",
                file=str(target),
            )
    for name in own:
        if name in found and found[name].is_dir() and not found[name].is_symlink():
            raise OutputError(
                f"{found[name]}: cannot be written: Is a directory", path=str(found[name])
            )


def _aside(place: Path) -> Path:
    """A new folder with the usual rights, hidden, on the same file system."""
    aside = place / f".asperity-{secrets.token_hex(6)}"
    aside.mkdir()
    return aside


@contextlib.contextmanager
def _parents(target: Path) -> Iterator[None]:
    """The folders above, made where they are missing, and gone again if the rest fails."""
    missing = []
    place = target.parent
    while not place.exists() and place != place.parent:
        missing.append(place)
        place = place.parent
    try:
        for place in reversed(missing):
            place.mkdir(exist_ok=True)
        yield
    except BaseException:
        for place in missing:
            with contextlib.suppress(OSError):
                place.rmdir()
        raise
