"""The command ``asperity doctor``; like `asperity.cli` itself it imports typer alone."""

from __future__ import annotations

from typing import Annotated

import typer

from asperity.cli.arguments import OnlyJson, Quiet, Verbose

EmptyCache = Annotated[
    bool,
    typer.Option("--empty-cache", help="Remove what the compile cache keeps, and test nothing."),
]


def doctor(
    empty_cache: EmptyCache = False,
    as_json: OnlyJson = False,
    quiet: Quiet = False,
    verbose: Verbose = False,
) -> None:
    """Say what is installed and whether it works.

    Versions, processors, the compile cache, a self-test, and how fast motions are here. Writes
    nothing but the compile cache.
    """
    from asperity.cli.doctor import empty, examine

    if empty_cache:
        empty(as_json=as_json, quiet=quiet, verbose=verbose)
    else:
        examine(as_json=as_json, quiet=quiet, verbose=verbose)
