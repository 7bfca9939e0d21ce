"""What the program says and how it ends: one line for an error, an exit code, no traceback."""

from __future__ import annotations

import contextlib
import logging
import os
import signal
import sys
import textwrap
import types
import warnings
from typing import Any, NoReturn

import typer
from typer.core import TyperGroup

from asperity.errors import (
    EXIT_INPUT,
    EXIT_INTERRUPTED,
    EXIT_NUMERICS,
    EXIT_OUTPUT,
    InputError,
    OutputError,
    SimulationError,
    one_line,
)

WIDTH = 80
"""Columns of a terminal."""

FATAL = 128
"""A program that a signal ended has this plus the signal's number as its exit code."""

EXIT_TERMINATED = FATAL + 15
EXIT_NO_READER = FATAL + 13


class Terminated(KeyboardInterrupt):
    """The system asked the program to end (SIGTERM); handled as Ctrl-C is."""


class Commands(TyperGroup):
    """The commands, with the project's errors as one line and an exit code."""

    def invoke(self, ctx: Any) -> Any:
        """Run the command that the arguments name."""
        try:
            return super().invoke(ctx)
        except typer.TyperException as error:
            if (renamed := _renamed(error)) is None:
                raise
            code = _fail(renamed, EXIT_INPUT)
        except InputError as error:
            code = _fail(_with_place(error), EXIT_INPUT)
        except SimulationError as error:
            code = _fail(str(error), EXIT_NUMERICS)
        except OutputError as error:
            code = _fail(str(error), EXIT_OUTPUT)
        except KeyboardInterrupt as stop:
            code = _fail("interrupted; nothing was written", exit_code_of(stop))
        raise typer.Exit(code)


def _renamed(error: typer.TyperException) -> str | None:
    """What is said of an option that has another name now; None where it is none."""
    from asperity.config.old_words import RENAMED  # here: it takes 0.2 s to import

    old, context = str(getattr(error, "option_name", "")), getattr(error, "ctx", None)
    name = RENAMED.get(old.removeprefix("--").replace("-", "_"))
    if name is None or context is None or not old.startswith("--"):
        return None
    new = f"--{name.replace('_', '-')}"
    known = {option for parameter in context.command.params for option in parameter.opts}
    return f"no such option: {old}; it is called {new} now" if new in known else None


def exit_code_of(stop: KeyboardInterrupt) -> int:
    """Exit code of an interruption: by Ctrl-C or by the system."""
    return EXIT_TERMINATED if isinstance(stop, Terminated) else EXIT_INTERRUPTED


def say(text: str, *, whole: bool = False) -> None:
    """A note for a human, on standard error, in lines of 80 columns.

    Parameters
    ----------
    text : str
        The note.
    whole : bool
        Whether each line of it stays one, as an error does.
    """
    if not whole:
        text = "\n".join(line for given in text.split("\n") for line in wrapped(given))
    if sys.stderr is not None:
        with contextlib.suppress(OSError):  # nobody is listening
            sys.stderr.write(text + "\n")
            sys.stderr.flush()


def wrapped(text: str, indent: str = "", hanging: int | None = None) -> list[str]:
    """A line in lines of 80 columns; a word that is longer, such as a path, stays whole.

    Parameters
    ----------
    text : str
        The line.
    indent : str
        What every line begins with.
    hanging : int, optional
        Blanks before the second line and the rest, in place of ``indent``; without either they
        stand two columns further right than the first.
    """
    if len(indent + text) <= WIDTH:
        return [indent + text]
    margin = indent or "  " + " " * (len(text) - len(text.lstrip(" ")))
    return textwrap.wrap(
        text,
        WIDTH,
        initial_indent=indent,
        subsequent_indent=margin if hanging is None else " " * hanging,
        break_long_words=False,
        break_on_hyphens=False,
    )


def tell(text: str) -> None:
    """The program's answer, on standard output.

    Raises
    ------
    OutputError
        Where it cannot be written, e.g. to a full disk.
    typer.Exit
        Where its reader has gone, as ``head`` goes.
    """
    if sys.stdout is None:
        return
    try:
        sys.stdout.write(text + "\n")
        sys.stdout.flush()
    except BrokenPipeError:
        _abandon_stdout()
        raise typer.Exit(EXIT_NO_READER) from None
    except OSError as error:
        _abandon_stdout()
        reason = error.strerror or error
        raise OutputError(f"standard output: cannot be written: {reason}") from None


def prepare() -> None:
    """Set up signals, streams and warnings for a program of its own."""
    signal.signal(signal.SIGTERM, raise_stop)
    for stream in (sys.stdout, sys.stderr):
        if stream is not None and hasattr(stream, "reconfigure"):
            stream.reconfigure(errors="backslashreplace")
    # A full or read-only disk costs the compile cache alone, and the result says the rest.
    warnings.filterwarnings("ignore", message="Error (reading|writing) persistent compilation")
    # Without a cache of fonts pictures come a second later, which is nothing to act on.
    logging.getLogger("matplotlib").setLevel(logging.ERROR)


def leave(command: Any) -> NoReturn:
    """Run the command and end the program with its exit code.

    The program ends without tearing down what it imported, which takes JAX a second, and after an
    interruption without waiting for a compilation in another thread.
    """
    try:
        command.main(prog_name="asperity")
        code = 0
    except SystemExit as end:
        code = end.code if isinstance(end.code, int) else 1
    except KeyboardInterrupt as stop:
        code = exit_code_of(stop)
    except OSError as error:  # typer's own text, such as help, or its script of completion
        where = error.filename or "standard output"
        code = _fail(f"{where}: cannot be written: {error.strerror or error}", EXIT_OUTPUT)
        _abandon_stdout()
    if code in (EXIT_INTERRUPTED, EXIT_TERMINATED):
        os._exit(code)
    try:
        if sys.stdout is not None:
            sys.stdout.flush()
    except OSError:
        code = code or EXIT_NO_READER
    if sys.stderr is not None:
        with contextlib.suppress(OSError):
            sys.stderr.flush()
    os._exit(code)


def raise_stop(number: int, frame: types.FrameType | None = None) -> NoReturn:
    """Raise what a request to end is in Python; a signal handler."""
    raise Terminated if number == signal.SIGTERM else KeyboardInterrupt


def _abandon_stdout() -> None:
    """Send what is left in the buffer nowhere, or Python complains of it at its end."""
    with contextlib.suppress(OSError, ValueError):
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


def _fail(message: str, code: int) -> int:
    say(f"asperity: {one_line(message)}", whole=True)
    return code


def _with_place(error: InputError) -> str:
    """The message, with the file and the key where it does not name them."""
    text = str(error)
    named = text.replace('"', "")  # a study's key has its own quotes: axes."impact.speed"
    parts = [part for part in (error.file, error.key) if part and part not in named]
    return ": ".join([*parts, text])
