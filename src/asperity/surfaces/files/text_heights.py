"""Heights from text: a matrix, one row a line, or three columns of points."""

from __future__ import annotations

import io
import re
import warnings
from dataclasses import dataclass

import numpy as np

from ...errors import InputError
from ...units import shown
from .content import MOST_PIXELS, cut_short, refusal
from .header import Stated, stated_in, told_by

_REMARK = re.compile(rb"^[ \t]*#(.*)$", re.MULTILINE)
_FORM = "write decimal points, `nan` for a missing height and # before a comment"


@dataclass(frozen=True)
class Text:
    """A text file, split.

    Parameters
    ----------
    file
        Its name.
    stated
        What its comments state.
    first
        Number of the first line of ``body``.
    body
        From the first number to the last, lines ended by a line feed.
    ended
        Whether its last line has an end.
    """

    file: str
    stated: Stated
    first: int
    body: bytes
    ended: bool


def split(content: bytes, file: str) -> Text:
    """Header and numbers of a text file, apart.

    Raises
    ------
    InputError
        Where it is no text, holds no numbers, or has header lines after the first number.
    """
    if b"\0" in content:
        raise refusal(file, "must be plain text; got binary data; check the ending of its name")
    lines = content.removeprefix(b"\xef\xbb\xbf")
    if b"\r" in lines:
        lines = lines.replace(b"\r\n", b"\n").replace(b"\r", b"\n")
    head: list[tuple[int, str]] = []
    place, number = 0, 1
    while place < len(lines):
        end = lines.find(b"\n", place)
        line = lines[place : end if end >= 0 else len(lines)].strip()
        if line and not line.startswith(b"#"):
            break
        head.append((number, _decoded(line[1:])))
        place = end + 1 if end >= 0 else len(lines)
        number += 1
    body = lines[place:].rstrip(b" \n")
    if not body:
        raise cut_short(file, "a text without numbers")
    _refuse_second_header(body, number, file)
    return Text(file, stated_in(head, file), number, body, lines.endswith(b"\n"))


def numbers(text: Text, columns: int | None = None) -> np.ndarray:
    """The numbers of a text, shape (lines, numbers a line); NaN where a cell is empty.

    Parameters
    ----------
    text
        The file.
    columns
        How many numbers a line must have; None where as many as the first.

    Raises
    ------
    InputError
        Where a cell is no finite number, or a line is longer or shorter than the first.
    """
    delimiter = _delimiter(text.body)
    wide = columns or len(text.body.split(b"\n", 1)[0].split(delimiter))
    if wide * (text.body.count(b"\n") + 1) > 3 * MOST_PIXELS:
        raise refusal(text.file, f"must have at most {MOST_PIXELS} pixels; got more")
    try:
        found = _parsed(text.body, delimiter)
    except (ValueError, UserWarning):
        found = _parsed_with_gaps(text, delimiter, columns)
    if columns is not None and found.shape[1] != columns:
        raise _diagnosis(text, text.body, delimiter, columns)
    if np.isinf(found).any():
        row = int(np.nonzero(np.isinf(found).any(axis=1))[0][0])
        raise refusal(
            text.file,
            f"line {_line_of(text, row)}: heights must be finite; got inf; "
            "write nan for a missing height",
        )
    return found


def _parsed(body: bytes, delimiter: bytes | None) -> np.ndarray:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        return np.loadtxt(
            io.BytesIO(body),
            delimiter=delimiter.decode() if delimiter else None,
            ndmin=2,
            encoding="latin1",
        )


def _parsed_with_gaps(text: Text, delimiter: bytes | None, columns: int | None) -> np.ndarray:
    """The numbers where cells are empty; what still cannot be read is diagnosed line by line."""
    body = text.body
    if delimiter is not None:
        rows = [line for line in body.split(b"\n") if not line.lstrip().startswith(b"#")]
        if all(row.rstrip(b" ").endswith(delimiter) for row in rows):
            body = re.sub(rb"%b *$" % delimiter, b"", body, flags=re.MULTILINE)
        if all(row.lstrip(b" ").startswith(delimiter) for row in rows):
            body = re.sub(rb"^ *%b" % delimiter, b"", body, flags=re.MULTILINE)
        body = re.sub(rb"(^|%b) *(?=%b|$)" % (delimiter, delimiter), rb"\1nan", body, flags=re.M)
    try:
        return _parsed(body, delimiter)
    except (ValueError, UserWarning):
        raise _diagnosis(text, body, delimiter, columns) from None


def _diagnosis(text: Text, body: bytes, delimiter: bytes | None, columns: int | None) -> InputError:
    """Why the numbers cannot be read: the first line at fault."""
    told = f"every line must have {columns} numbers"
    for number, line in enumerate(body.split(b"\n"), text.first):
        cells = line.split(b"#")[0].strip(b" ").split(delimiter)
        if not b"".join(cells).strip():
            continue
        for cell in cells:
            if not _is_number(cell):
                got = shown(_decoded(cell).strip())
                return refusal(
                    text.file, f"line {number}: must hold numbers alone; got {got}; {_FORM}"
                )
        if columns is not None and len(cells) != columns:
            return refusal(
                text.file,
                f"line {number}: {told}; got {len(cells)}; a file cut short must be copied again",
            )
        if columns is None:
            columns, told = len(cells), f"every line must have {len(cells)} numbers, as the first"
    return refusal(text.file, f"must hold numbers alone; got something else; {_FORM}")


def _is_number(cell: bytes) -> bool:
    try:
        float(cell)
    except ValueError:
        return False
    return b"_" not in cell


def _delimiter(body: bytes) -> bytes | None:
    """What stands between numbers: the first of ``; , tab`` in the first line, else blanks."""
    first = body.split(b"\n", 1)[0].split(b"#")[0].strip(b" ")
    return next((mark for mark in (b";", b",", b"\t") if mark in first), None)


def _line_of(text: Text, row: int) -> int:
    """Number of the line that holds a row of numbers."""
    lines = enumerate(text.body.split(b"\n"), text.first)
    kept = [number for number, line in lines if line.split(b"#")[0].strip()]
    return kept[row] if row < len(kept) else text.first


def _refuse_second_header(body: bytes, first: int, file: str) -> None:
    """Refuse a file of several maps one after the other, each with its header."""
    if b"#" not in body:
        return
    for match in _REMARK.finditer(body):
        try:
            header = bool(told_by(_decoded(match[1])))
        except InputError:
            header = True
        if header:
            number = first + body.count(b"\n", 0, match.start())
            raise refusal(
                file,
                f"line {number}: header lines must stand before the first number; got one after; "
                "keep one map a file",
            )


def _decoded(text: bytes) -> str:
    """Text in UTF-8, or in the older code page in which instruments write a micro sign."""
    try:
        return text.decode()
    except UnicodeDecodeError:
        return text.decode("latin-1")
