"""``asperity web``: the page with sliders."""

from __future__ import annotations

import json
from pathlib import Path

import typer

from asperity.cli.terminal import exit_code_of, say, tell
from asperity.config import BUILTINS, FIRST, load
from asperity.config.case_file import builtin, builtin_text, read_text
from asperity.errors import InputError
from asperity.web.serving import serve


def show(
    case: str | None,
    *,
    port: int,
    host: str,
    names: list[str],
    browse: bool,
    as_json: bool,
    quiet: bool,
) -> None:
    """Serve the page until Ctrl-C.

    Parameters
    ----------
    case : str, optional
        As the user named it: a built-in case or a TOML file; without it `FIRST`.
    port, host, names
        As :func:`asperity.web.serving.serve` takes them.
    browse : bool
        Whether to open the page in the browser.
    as_json, quiet : bool
        The options of these names.
    """
    first = _first(case or FIRST)

    def ready(address: str) -> None:
        if as_json:
            tell(json.dumps({"address": address, "case": first[0]}))
        elif not quiet:
            tell(f"{address}  (Ctrl-C ends)")
        if browse:
            typer.launch(address)

    try:
        serve(host, port, names, first, ready)
    except KeyboardInterrupt as stop:
        if not quiet:
            say("asperity: the page is closed")
        raise typer.Exit(exit_code_of(stop)) from None


def _first(case: str) -> tuple[str, str]:
    """Name and text of the case to begin with, which must be one."""
    path = Path(case)
    if not path.suffix and path.name == case:
        builtin(case)
        return case, builtin_text(case)
    if path.suffix.lower() == ".nc":
        raise InputError(
            f"{case}: a page begins with a case, not with a record; take the TOML file, or one of "
            f"{', '.join(BUILTINS)}",
            file=case,
        )
    text = read_text(case)
    found = load(text, file=case)
    if found.roughness is not None and found.roughness.files is not None:
        raise InputError(
            f"{case}: a page reads only files that are dropped into it; begin with a case of "
            "numbers, and drop the surface files in",
            file=case,
            key="roughness.files",
        )
    return path.stem[:100], text
