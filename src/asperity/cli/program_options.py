"""What is asked of the program itself: its version."""

from __future__ import annotations

import typer

from asperity.errors import InputError


def answer(context: typer.Context, version: bool, as_json: bool) -> None:
    """Answer options that stand before any command; with none of them a command must follow.

    Raises
    ------
    InputError
        Where ``--json`` stands alone.
    typer.Exit
        Where something was answered.
    """
    if version:
        from asperity.cli.stack import tell_versions

        tell_versions(as_json=as_json)
        raise typer.Exit
    if as_json:
        raise InputError("`--json` must go with --version, or after a command; got it alone")
    if context.invoked_subcommand is None:
        context.fail("Missing command.")
