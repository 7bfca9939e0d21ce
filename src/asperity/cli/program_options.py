"""What is asked of the program itself: its version, and completion in a shell."""

from __future__ import annotations

import typer

from asperity.errors import InputError


def answer(
    context: typer.Context,
    version: bool,
    as_json: bool,
    show_completion: str | None,
    install_completion: str | None,
) -> None:
    """Answer options that stand before any command; with none of them a command must follow.

    Raises
    ------
    InputError
        Where ``--json`` stands alone.
    typer.Exit
        Where something was answered.
    """
    from asperity.cli.shell_completion import install_script, print_script

    if version:
        from asperity.cli.stack import tell_versions

        tell_versions(as_json=as_json)
        raise typer.Exit
    if as_json:
        raise InputError("`--json` must go with --version, or after a command; got it alone")
    if show_completion is not None:
        print_script(context, show_completion)
    if install_completion is not None:
        install_script(context, install_completion)
    if context.invoked_subcommand is None:
        context.fail("Missing command.")
