"""A computation in a thread of its own, so that Ctrl-C is heard while it compiles."""

from __future__ import annotations

import contextlib
import signal
import sys
import threading
import time
import types
from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING, Generic, TypeVar

import typer

from asperity.cli.terminal import FATAL, raise_stop, say

if TYPE_CHECKING:
    from rich.console import Console
    from rich.progress import Progress as RichProgress

Answer = TypeVar("Answer")
Progress = Callable[[float, str], None]

PATIENCE = 1.2
"""How long an interrupted computation may take to hand over what it has [s]."""

_LISTEN = 0.01
_BAR, _TIME = 40, 7  # columns of the bar at most, of the time at least


class Work(Generic[Answer]):
    """A computation in the background.

    Parameters
    ----------
    task : callable
        Takes an event that asks it to stop.
    """

    def __init__(self, task: Callable[[threading.Event], Answer]) -> None:
        self._task = task
        self._stop = threading.Event()
        self._ended = False
        self._answer: Answer | None = None
        self._error: BaseException | None = None

    def wait(self) -> tuple[Answer | None, int]:
        """The answer, and the exit code: 0, or that of an interruption.

        After an interruption the answer is what was computed until then, None where the task does
        not stop in time. A second interruption is raised.
        """
        with _listening() as heard:
            threading.Thread(target=self._run, name="asperity", daemon=True).start()
            while not (self._ended or heard):
                time.sleep(_LISTEN)
            self._stop.set()
            patient_until = time.monotonic() + PATIENCE
            while not self._ended and time.monotonic() < patient_until:
                time.sleep(_LISTEN)
        code = FATAL + heard[0] if heard else 0
        if self._error is not None and not code:
            raise self._error
        return (self._answer if self._ended else None), code

    def _run(self) -> None:
        try:
            self._answer = self._task(self._stop)
        except BaseException as error:  # noqa: BLE001 - raised again by `wait`
            self._error = error
        finally:
            self._ended = True


def completed(task: Callable[[threading.Event], Answer]) -> Answer:
    """What a task gives as a whole; an interruption ends the program, with nothing written.

    Parameters
    ----------
    task : callable
        As `Work` takes it; gives None where it was stopped.
    """
    found, code = Work(task).wait()
    if code or found is None:
        say("asperity: interrupted; nothing was written", whole=True)
        raise typer.Exit(code)
    return found


@contextlib.contextmanager
def _listening() -> Iterator[list[int]]:
    """A list that takes the first request to end; the second raises.

    The first does not raise: an exception between any two steps would leave the locks of Python's
    own threads and of the progress bar in disorder.
    """
    heard: list[int] = []

    def hear(number: int, frame: types.FrameType | None) -> None:
        if heard:
            raise_stop(number)
        heard.append(number)

    numbers = []
    if threading.current_thread() is threading.main_thread():
        asked = (signal.SIGINT, signal.SIGTERM)
        numbers = [number for number in asked if signal.getsignal(number) != signal.SIG_IGN]
    before = {number: signal.signal(number, hear) for number in numbers}
    try:
        yield heard
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)


@contextlib.contextmanager
def progress_bar(wanted: bool) -> Iterator[Progress | None]:
    """A bar on a terminal's standard error; nothing in a log."""
    if not wanted or sys.stderr is None or not sys.stderr.isatty():
        yield None
        return
    from rich.console import Console

    with _bar_on(Console(stderr=True)) as bar:
        task = bar.add_task("starting", total=1.0)

        def advance(fraction: float, text: str) -> None:
            bar.update(task, completed=min(max(fraction, 0.0), 1.0), description=text)

        yield advance


def _bar_on(console: Console) -> RichProgress:
    """A bar that takes the room that its words and the time leave."""
    from rich.progress import BarColumn, TextColumn, TimeElapsedColumn
    from rich.progress import Progress as RichProgress
    from rich.table import Column

    whole = Column(min_width=_TIME, no_wrap=True)
    columns = (
        TextColumn("{task.description}"),
        BarColumn(bar_width=None, table_column=Column(ratio=1, max_width=_BAR)),
        TimeElapsedColumn(table_column=whole),
    )
    return RichProgress(*columns, console=console, transient=True, expand=True)
