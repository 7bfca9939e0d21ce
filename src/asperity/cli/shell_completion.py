"""Completion in a shell: its script, and what can stand where a value is typed.

Imports the standard library and typer alone: a shell asks at every press of the key.
"""

from __future__ import annotations

import os
import re
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path

import typer

from asperity.errors import InputError, OutputError

SHELLS = ("bash", "zsh", "fish")
"""Shells that have a script."""

SHOW, INSTALL = "--show-completion", "--install-completion"

ASKED = "_ASPERITY_COMPLETE"
"""Variable of the environment in which a shell asks for completions."""

RECORDS = (".nc", ".nc4", ".cdf")
STORE = ".zarr"

_DETECT = ""  # stands for the shell that the command runs in
_PLAIN = re.compile(r"[\w./+,@%-]+")  # a shell would split or expand any other name
_CASES = Path(__file__).parents[1] / "config" / "cases"

Complete = Callable[[str], list[str]]
"""What can follow the beginning of a word."""


def with_shell(arguments: Sequence[str]) -> list[str]:
    """Arguments in which an option for completion always has a value.

    The shell's name may be left out, which the parser of options cannot express.
    """
    given: list[str] = []
    for position, argument in enumerate(arguments):
        given.append(argument)
        following = arguments[position + 1 : position + 2]
        if argument in (SHOW, INSTALL) and (not following or following[0].startswith("-")):
            given.append(_DETECT)
    return given


def print_script(context: typer.Context, shell: str) -> None:
    """Print what makes a shell complete the program's arguments, and end.

    Raises
    ------
    InputError
        Where there is no script for this shell.
    """
    from typer.completion import show_callback

    show_callback(context, None, _known(shell, SHOW))  # type: ignore[arg-type]


def install_script(context: typer.Context, shell: str) -> None:
    """Put the script where the shell reads it, and end.

    Raises
    ------
    InputError
        Where there is no script for this shell.
    OutputError
        Where it cannot be written.
    """
    from typer.completion import install_callback

    name = _known(shell, INSTALL)
    try:
        install_callback(context, None, name)  # type: ignore[arg-type]
    except OSError as error:
        where = f"{error.filename}: " if error.filename else ""
        raise OutputError(f"{where}cannot be written: {error.strerror or error}") from None


def _known(shell: str, option: str) -> str:
    """The name of a shell that has a script; the one in use where none is given."""
    name = _used(option) if shell == _DETECT else shell
    if name not in SHELLS:
        *rest, last = SHELLS
        raise InputError(f"`{option}` must be {', '.join(rest)} or {last}; got {name!r}")
    return name


def _used(option: str) -> str:
    import shellingham  # a requirement of typer, without types

    try:
        name: str = shellingham.detect_shell()[0]
    except (shellingham.ShellDetectionFailure, OSError):
        raise InputError(
            f"`{option}` must name the shell, {' '.join(SHELLS)}, where it cannot be told; "
            "got nothing"
        ) from None
    return name


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
    from asperity.materials.solids import LIQUIDS, SOLIDS

    return [name for name in (*SOLIDS, *LIQUIDS, *GASES) if _PLAIN.fullmatch(name)]


def column(ctx: typer.Context) -> list[str]:
    """Columns of the store that the command line names before."""
    # With an option that still waits for its value the parser leaves the rest as it is.
    folder = Path(str(ctx.params.get("record") or next(iter(ctx.args), "")))
    if folder.suffix != STORE or not folder.is_dir():
        return []
    return sorted(entry.parent.name for entry in folder.glob("*/zarr.json"))


def one_of(*words: str) -> Complete:
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
