"""Case files and built-in cases -> `Case`."""

from __future__ import annotations

import importlib.resources
import os
import re
import stat
import tomllib
from pathlib import Path
from typing import Any

from asperity.config import case_text, problems
from asperity.config.replacing import named
from asperity.config.schema import Case
from asperity.errors import InputError

SIZE_LIMIT = 1 << 20
"""Largest size of a case [bytes]: 1 MiB."""

LINE_LIMIT = 1000
"""Longest line of a case [characters]."""

_CASES = importlib.resources.files("asperity.config") / "cases"

BUILTINS: tuple[str, ...] = tuple(
    sorted(entry.name.removesuffix(".toml") for entry in _CASES.iterdir()
           if entry.name.endswith(".toml"))
)  # fmt: skip
"""Names of the built-in cases."""

FIRST = "glass-bead"
"""Name of the built-in case that the page opens on."""

_PLACE = re.compile(r"\s*\(at (?:line (\d+), column (\d+)|end of document)\)$")


def load(text: str, *, file: str | None = None) -> Case:
    """A case from TOML text.

    Parameters
    ----------
    text : str
        The text.
    file : str, optional
        Name of its file, for messages.

    Raises
    ------
    InputError
        One line that names file, key, line, rule and value.
    """
    return problems.check(Case, tables(text, file), source=text, file=file)


def tables(text: str, file: str | None, what: str = "a case") -> dict[str, Any]:
    """The tables of a TOML text, which is ``what``.

    Raises
    ------
    InputError
        Where it is too long, empty, binary or no TOML, with the line.
    """
    _refuse_length(text, file, what)
    if "\0" in text:
        raise _unusable(file, f"{what} must be text; got a binary file")
    if not text.strip():
        raise _unusable(file, f"{what} must have tables; got an empty file")
    _refuse_lines(text, file)
    try:
        return tomllib.loads(text)
    except RecursionError:
        raise _unusable(file, "not TOML: values nested too deeply") from None
    except tomllib.TOMLDecodeError as error:
        raise _unusable(file, _syntax(str(error), text)) from None
    except ValueError:  # Python reads no whole number of thousands of digits
        raise _unusable(file, "not TOML: a number of too many digits") from None


def refuse_size(text: str, file: str | None, what: str = "a case") -> None:
    """Refuse a text that is too long, or has too long a line.

    Raises
    ------
    InputError
        With the limit.
    """
    _refuse_length(text, file, what)
    _refuse_lines(text, file)


def _refuse_length(text: str, file: str | None, what: str) -> None:
    if len(text) > SIZE_LIMIT or len(text.encode(errors="replace")) > SIZE_LIMIT:
        raise _unusable(file, f"{what} must be at most 1 MiB; got {len(text)} characters")


def _refuse_lines(text: str, file: str | None) -> None:
    longest = max(len(line) for line in text.split("\n"))
    if longest > LINE_LIMIT:  # the parser's time grows with the square of a dotted key's length
        rule = f"a line must be at most {LINE_LIMIT} characters (a list can have several lines)"
        raise _unusable(file, f"{rule}; got one of {longest}")


def load_file(path: str | os.PathLike[str]) -> Case:
    """A case from a TOML file, which is never read beyond 1 MiB; its name is the file's stem.

    Raises
    ------
    InputError
        Where the file cannot be read or is no case.
    """
    name = os.fspath(path)
    case = named(load(read_text(name), file=name), Path(name).stem)
    return beside(case, Path(name).parent)


def beside(case: Case, folder: Path) -> Case:
    """The case with its surface files looked for in a folder."""
    rough = case.roughness
    if rough is None or rough.files is None:
        return case
    # Whole paths, so that a record can be run again from any folder.
    files = [os.fspath((folder / file).resolve()) for file in rough.files]
    return case.model_copy(update={"roughness": rough.model_copy(update={"files": files})})


def read_text(name: str, what: str = "a case") -> str:
    """Text of a regular file of at most 1 MiB, which is ``what``; never read beyond that.

    Raises
    ------
    InputError
        Where it cannot be read, or is no text.
    """
    try:
        status = Path(name).stat()
    except OSError as error:
        raise _unusable(name, f"cannot be read: {error.strerror}") from None
    except ValueError:  # a null character
        raise _unusable(name, "cannot be read: no path of a file") from None
    if stat.S_ISDIR(status.st_mode):
        raise _unusable(name, f"{what} must be a file; got a folder")
    if not stat.S_ISREG(status.st_mode):
        raise _unusable(name, f"{what} must be a regular file; got a device, pipe or socket")
    if status.st_size > SIZE_LIMIT:
        raise _unusable(name, f"{what} must be at most 1 MiB; got {status.st_size} bytes")
    try:
        with Path(name).open("rb") as stream:
            return stream.read(SIZE_LIMIT + 1).decode("utf-8-sig")
    except OSError as error:
        raise _unusable(name, f"cannot be read: {error.strerror}") from None
    except UnicodeDecodeError as error:
        rule = f"{what} must be UTF-8 text; got a binary file (byte {error.start + 1})"
        raise _unusable(name, rule) from None


def builtin(name: str) -> Case:
    """A built-in case by its name, one of `BUILTINS`.

    Raises
    ------
    InputError
        Where there is none of this name.
    """
    rule = f"case must be one of {', '.join(BUILTINS)}, or a file as in `asperity run FILE.toml`"
    problems.among(name, BUILTINS, rule, key="case")
    return named(load(builtin_text(name), file=f"{name}.toml"), name)


def builtin_text(name: str) -> str:
    """Text of a built-in case, one of `BUILTINS`."""
    return (_CASES / f"{name}.toml").read_text(encoding="utf-8")


def template() -> str:
    """The commented case that `asperity init` writes: every key, with its unit and meaning."""
    return case_text.commented(
        Case,
        "A glass bead of 0.1 mm falls 1 um onto a silicon wafer at 60 % humidity. Will it stick?\n"
        "Every value with a dimension is text with a unit; keys behind a # are optional.",
    )


def _unusable(file: str | None, rule: str) -> InputError:
    return InputError(f"{file}: {rule}" if file else rule, file=file)


def _syntax(message: str, source: str) -> str:
    """The parser's message with the line in front."""
    place = _PLACE.search(message)
    rule = _PLACE.sub("", message)
    if place is None:
        return f"not TOML: {rule}"
    line = int(place.group(1)) if place.group(1) else source.count("\n") + 1
    column = f", column {place.group(2)}" if place.group(2) else ""
    return f"not TOML (line {line}{column}): {rule}"
