"""What CASE stands for: a built-in case, a case file, or a record."""

from __future__ import annotations

import hashlib
import importlib.resources
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from asperity.case import Case, builtin, load_file
from asperity.errors import InputError

_RECORDS = (".nc", ".nc4", ".cdf")


@dataclass(frozen=True)
class Source:
    """A case with its name, and the hash of the text that it was read from."""

    case: Case
    name: str
    input_sha256: str
    file: str | None = None


def source(argument: str) -> Source:
    """The case that a command's argument names.

    A word without a suffix or a folder is the name of a built-in case; anything else is a file.

    Raises
    ------
    InputError
        Where there is no such case, or it cannot be used.
    """
    path = Path(argument)
    if not path.suffix and path.name == argument and argument not in ("", ".", ".."):
        return _builtin(argument)
    if path.suffix.lower() in _RECORDS:
        from asperity.records import read

        record = read(argument)
        assert record.input_sha256 is not None
        _check_surfaces(argument, getattr(record, "surface", None))
        return Source(record.case, record.name, record.input_sha256, argument)
    case = load_file(argument)
    try:
        text = path.read_bytes()
    except OSError as error:
        reason = error.strerror or error
        raise InputError(f"{argument}: cannot be read: {reason}", file=argument) from None
    return Source(case, path.stem, hashlib.sha256(text).hexdigest(), argument)


def _check_surfaces(record: str, found: dict[str, Any] | None) -> None:
    """Refuse a record whose surface files are no longer those that it was made from."""
    if found is None:
        return
    from asperity.topography.files.content import digest

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
        hint = f"; for the file here write ./{name}" if Path(name).is_file() else ""
        raise InputError(f"{error}{hint}", key=error.key) from None
    file = importlib.resources.files("asperity") / "cases" / f"{name}.toml"
    return Source(case, name, hashlib.sha256(file.read_bytes()).hexdigest())
