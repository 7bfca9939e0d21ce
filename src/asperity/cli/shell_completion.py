"""Completion in a shell: what can stand where a value is typed.

Imports the standard library and typer alone: a shell asks at every press of the key.
"""

from __future__ import annotations

import os
import re
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path

import typer

RECORDS = (".nc", ".nc4", ".cdf")
STORE = ".zarr"

_PLAIN = re.compile(r"[\w./+,@%-]+")  # a shell would split or expand any other name
_CASES = Path(__file__).parents[1] / "config" / "cases"


def case(incomplete: str) -> list[str]:
    """Built-in cases, case files and records."""
    names = sorted(file.stem for file in _CASES.glob("*.toml"))
    return [*names, *_paths(incomplete, (".toml", *RECORDS))]


def study(incomplete: str) -> list[str]:
    """Study files."""
    return _paths(incomplete, (".toml",))


def store(incomplete: str) -> list[str]:
    """Stores of studies."""
    return _paths(incomplete, (STORE,))


def record_or_store(incomplete: str) -> list[str]:
    """Records and stores."""
    return _paths(incomplete, (*RECORDS, STORE))


def store_or_case(incomplete: str) -> list[str]:
    """Stores, and what a case can be."""
    return [*store(incomplete), *case(incomplete)]


def material(incomplete: str) -> list[str]:
    """Names of the catalogue; those of several words are quoted by hand."""
    from asperity.materials.gases import GASES
    from asperity.materials.liquids import LIQUIDS
    from asperity.materials.solids import SOLIDS

    return [name for name in (*SOLIDS, *LIQUIDS, *GASES) if _PLAIN.fullmatch(name)]


def column(ctx: typer.Context) -> list[str]:
    """Columns of the store that the command line names before."""
    # With an option that still waits for its value the parser leaves the rest as it is.
    folder = Path(str(ctx.params.get("record") or next(iter(ctx.args), "")))
    if folder.suffix != STORE or not folder.is_dir():
        return []
    return sorted(entry.parent.name for entry in folder.glob("*/zarr.json"))


def one_of(*words: str) -> Callable[[str], list[str]]:
    """Completion of an option that takes one of some words."""
    return lambda incomplete: list(words)


def _paths(incomplete: str, endings: Sequence[str]) -> list[str]:
    """Files, stores and folders whose paths begin so; of one folder alone, what is in it."""
    found, folders = [], []
    for path, is_folder in _entries(incomplete):
        if Path(path).suffix.lower() in endings:
            found.append(path)
        elif is_folder:
            folders.append(f"{path}/")
    if not found and len(folders) == 1 and incomplete != folders[0]:
        return _paths(folders[0], endings) or folders
    return sorted(found) + sorted(folders)


def _entries(incomplete: str) -> Iterator[tuple[str, bool]]:
    """Paths that begin so, each with whether it is a folder; hidden ones only when asked for."""
    head, slash, begun = incomplete.rpartition("/")
    try:
        with os.scandir(head + slash or ".") as entries:
            for entry in entries:
                hidden = entry.name.startswith(".") and not begun.startswith(".")
                if entry.name.startswith(begun) and not hidden:
                    path = f"{head}{slash}{entry.name}"
                    if _PLAIN.fullmatch(path):
                        yield path, entry.is_dir()
    except OSError:
        return  # no such folder, or one that cannot be read: nothing to offer
