"""How Python shows an object: in notebooks a small HTML table, escaped, without scripts."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from html import escape

Row = Sequence[str]
"""Cells of a row; the first says what the others are."""

_CODE = re.compile(r"`([^`]+)`")
_CELL = "text-align:left;padding:0.1em 0.8em"
_WARNING = "border-left:3px solid #D55E00;margin:0.4em 0;padding:0 0.8em"


def card(
    title: str,
    sentence: str = "",
    sections: Iterable[tuple[str, Sequence[Row]]] = (),
    warnings: Sequence[str] = (),
) -> str:
    """An object as HTML: title, sentence, warnings, and a table with a heading for each section.

    Parameters
    ----------
    title, sentence : str
        What it is, and what is to be said of it.
    sections : iterable of tuple
        Heading and rows of each; sections without rows are left out.
    warnings : sequence of str
        What to know before the numbers are used; they stand above the table.
    """
    filled = [(heading, rows) for heading, rows in sections if rows]
    wide = max((len(row) for _, rows in filled for row in rows), default=2)
    lines = [line for heading, rows in filled for line in _section(heading, rows, wide)]
    return "\n".join(
        [
            f"<div><strong>{escape(title)}</strong>",
            *([f"<p>{_prose(sentence)}</p>"] if sentence else []),
            *_warnings(warnings),
            *(["<table>", *lines, "</table>"] if lines else []),
            "</div>",
        ]
    )


def _prose(text: str) -> str:
    """A sentence with its keys, which stand in backquotes, as code."""
    return _CODE.sub(r"<code>\1</code>", escape(text))


def counted(number: int, word: str) -> str:
    """A number of things in words: ``no warnings``, ``1 warning``, ``2 warnings``."""
    return f"{f'{number:,}' if number else 'no'} {word}{'s' * (number != 1)}"


def _section(heading: str, rows: Sequence[Row], wide: int) -> list[str]:
    head = f'<tr><th colspan="{wide}" style="{_CELL}">{escape(heading)}</th></tr>'
    return [*([head] if heading else []), *map(_row, rows)]


def _row(cells: Row) -> str:
    inside = "".join(f'<td style="{_CELL}">{escape(cell)}</td>' for cell in cells)
    return f"<tr>{inside}</tr>"


def _warnings(warnings: Sequence[str]) -> list[str]:
    if not warnings:
        return []
    lines = [f"<li>{_prose(warning)}</li>" for warning in warnings]
    return [f'<div style="{_WARNING}"><strong>Warnings</strong>', "<ul>", *lines, "</ul></div>"]
