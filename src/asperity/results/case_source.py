"""What stands for a case: a built-in case, a case file, or a record."""

from __future__ import annotations

import hashlib
import itertools
import os
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from asperity.config import BUILTINS, Case, builtin, load_file
from asperity.config.case_file import builtin_text
from asperity.config.problems import nearest
from asperity.config.replacing import named
from asperity.errors import InputError
from asperity.units import shown

CaseLike = Case | str | os.PathLike[str]
"""A case, or the name or path of one."""

_RECORDS = (".nc", ".nc4", ".cdf")
_LISTED = 10_000  # files of a folder among which a near name is sought


@dataclass(frozen=True)
class Source:
    """A named case, the hash of the text that it was read from, and where that is.

    Attributes
    ----------
    file
        As it was given; None for a built-in case.
    case_file
        Whole path of the case's file, or which built-in case it is; of a record what it says.
    """

    case: Case
    input_sha256: str
    file: str | None
    case_file: str | None


def case_of(given: CaseLike) -> Case:
    """The case itself, or the one that a name or a path stands for.

    Raises
    ------
    InputError
        Where it is none of these, there is no such case, or it cannot be used.
    """
    if isinstance(given, Case):
        return given
    if not isinstance(given, str | os.PathLike):
        raise _no_source("a case, or the name or path of one", given)
    return source_of(given).case


def source_of(given: str | os.PathLike[str]) -> Source:
    """The case that a name or a path stands for.

    Text without a suffix or a folder is the name of a built-in case; anything else is a file.

    Raises
    ------
    InputError
        Where there is no such case, or it cannot be used.
    """
    name = os.fspath(given) if isinstance(given, str | os.PathLike) else given
    if not isinstance(name, str):
        raise _no_source("the name or path of a case", given)
    path = Path(name)
    if isinstance(given, str) and not path.suffix and path.name == name and name not in ("", ".."):
        return _builtin(name)
    if path.suffix.lower() in _RECORDS:
        from asperity.results.read_record import read

        record = read(name)
        assert record.input_sha256 is not None
        _check_surfaces(name, record.surface)
        case = named(record.case, record.name)
        return Source(case, record.input_sha256, name, record.case_file)
    try:
        case = load_file(name)
        text = path.read_bytes()
    except InputError as error:
        hint = "" if _is_there(path) else _meant(path)
        if not hint:
            raise
        raise InputError(f"{error}{hint}", file=error.file, key=error.key) from None
    except OSError as error:
        reason = error.strerror or error
        raise InputError(f"{name}: cannot be read: {reason}", file=name) from None
    return Source(case, hashlib.sha256(text).hexdigest(), name, str(path.resolve()))


def _no_source(wanted: str, given: object) -> InputError:
    kind = type(given).__name__
    return InputError(f"`case` must be {wanted}; got {shown(given)} ({kind})", key="case")


def _check_surfaces(record: str, found: dict[str, Any] | None) -> None:
    """Refuse a record whose surface files are no longer those that it was made from."""
    if found is None:
        return
    from asperity.surfaces.files.content import digest

    for each in found["files"]:
        try:
            changed = digest(each["file"]) != each["sha256"]
        except InputError as error:
            raise InputError(f"{record}: made from {error}", file=record) from None
        if changed:
            raise InputError(
                f"{record}: made from {each['file']}, which has changed since; run a case to use "
                "the file as it is now",
                file=record,
            )


def _builtin(name: str) -> Source:
    try:
        case = builtin(name)
    except InputError as error:
        raise InputError(f"{error}{_file_of(name)}", key=error.key) from None
    digest = hashlib.sha256(builtin_text(name).encode()).hexdigest()
    return Source(case, digest, None, f"built-in case {name}")


def _file_of(name: str) -> str:
    """Which file here is meant by the name of no built-in case; nothing where none is near."""
    if _is_there(Path(name)):
        return f"; for the file here write ./{name}"
    near = Path(f"{name}.toml")
    found = near if _is_there(near) else _near_file(near)
    return "" if found is None else f"; there is a file {found} here"


def _is_there(path: Path) -> bool:
    try:
        return path.exists()
    except (OSError, ValueError):  # no name that a file can have
        return False


def _meant(path: Path) -> str:
    """Which case a missing file may stand for: one near by name, or a built-in one."""
    near = _near_file(path)
    if near is not None:
        return f" - did you mean '{near}'?"
    return f"; the built-in case is {path.stem}" if path.stem in BUILTINS else ""


def _near_file(path: Path) -> Path | None:
    """The case file or record beside a missing one whose name is close to its own."""
    try:
        beside = list(itertools.islice(path.parent.iterdir(), _LISTED))
    except (OSError, ValueError):
        return None
    names = {each.stem: each for each in beside if each.suffix.lower() in (".toml", *_RECORDS)}
    near = nearest(path.stem, names)
    return None if near is None else names[near]
