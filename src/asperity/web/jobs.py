"""Computations for the page: a few at a time, and of one asker only the newest."""

from __future__ import annotations

import asyncio
import contextlib
import logging
import math
import threading
import time
from collections import deque
from collections.abc import AsyncIterator, Callable
from typing import Any, NamedTuple

from asperity.errors import InputError, SimulationError

Report = Callable[[float, str], None]
Task = Callable[[Report, threading.Event], Any]

OFTEN = 0.1
"""Time between two tellings of the same kind of progress, such as of impacts [s]."""

_LOG = logging.getLogger(__name__)


class Busy(RuntimeError):
    """More waits already than may wait."""


class Stopped(Exception):
    """The answer is no longer wanted."""


class Event(NamedTuple):
    """Something to tell the asker: "progress", "answer", "error" or "replaced"."""

    kind: str
    value: Any

    @property
    def last(self) -> bool:
        """Whether nothing follows it."""
        return self.kind != "progress"


class Job:
    """A computation that was asked for.

    Parameters
    ----------
    task
        Takes a report of progress and an event that asks it to stop.

    Attributes
    ----------
    begun, stop, over
        Whether it was begun, whether it is to stop, and whether it has ended.
    """

    def __init__(self, task: Task) -> None:
        self._task = task
        self._loop = asyncio.get_running_loop()
        self._events: asyncio.Queue[Event] = asyncio.Queue()
        self._told = "", -math.inf
        self.begun, self.stop, self.over = (threading.Event() for _ in range(3))

    def run(self) -> None:
        """Compute, in the thread that calls; whatever happens is told to the asker."""
        self.begun.set()
        if self.stop.is_set():
            self.over.set()
            return
        try:
            self.tell(Event("answer", self._task(self._progress, self.stop)))
        except Stopped:
            pass
        except (InputError, SimulationError) as error:
            self.tell(Event("error", error))
        except Exception as error:  # noqa: BLE001 - told to the asker, and to the log
            _LOG.exception("a computation failed")
            self.tell(Event("error", error))
        finally:
            self.over.set()

    def _progress(self, fraction: float, text: str) -> None:
        if self.stop.is_set():
            raise Stopped
        kind, last = self._told
        words, now = text.partition(" ")[0], time.monotonic()
        if words == kind and now - last < OFTEN:
            return
        self._told = words, now
        self.tell(Event("progress", (fraction, text)))

    @property
    def busy(self) -> bool:
        """Whether it is being computed, or still will be."""
        return not (self.over.is_set() or (self.stop.is_set() and not self.begun.is_set()))

    def drop(self) -> None:
        """Stop it, and tell its asker that its answer is no longer wanted."""
        self.stop.set()
        self.tell(Event("replaced", None))

    def tell(self, event: Event) -> None:
        """Tell the asker, from any thread."""
        with contextlib.suppress(RuntimeError):  # the server has ended
            self._loop.call_soon_threadsafe(self._events.put_nowait, event)

    async def events(self, patience: float) -> AsyncIterator[Event]:
        """What happens, to the last; an asker who leaves stops the computation.

        Parameters
        ----------
        patience
            How long to wait for the last event [s].
        """
        until = time.monotonic() + patience
        try:
            while True:
                try:
                    left = until - time.monotonic()
                    event = await asyncio.wait_for(self._events.get(), max(left, 0.0))
                except TimeoutError:
                    late = SimulationError(f"no answer within {patience:.0f} s; it was given up")
                    event = Event("error", late)
                yield event
                if event.last:
                    return
        finally:
            self.stop.set()


class Desk:
    """Takes computations and has them done in threads.

    Parameters
    ----------
    threads
        How many at a time.
    room
        How many may wait.
    """

    def __init__(self, threads: int = 3, room: int = 12) -> None:
        self._room = room
        self._waiting: deque[Job] = deque()
        self._newest: dict[str, Job] = {}
        self._spare: Job | None = None
        self._changed = threading.Condition()
        for number in range(threads):
            threading.Thread(target=self._work, name=f"page-{number}", daemon=True).start()

    def ask(self, asker: str, task: Task) -> Job:
        """Have something computed; what the same asker wanted before is dropped.

        Raises
        ------
        Busy
            Where too much waits already.
        """
        job = Job(task)
        with self._changed:
            if self._spare is not None:
                self._spare.stop.set()
            older = self._newest.get(asker)
            if older is not None:
                older.drop()
                with contextlib.suppress(ValueError):
                    self._waiting.remove(older)
            self._waiting = deque(one for one in self._waiting if not one.stop.is_set())
            if len(self._waiting) >= self._room:
                raise Busy
            self._newest[asker] = job
            self._waiting.append(job)
            self._changed.notify()
        return job

    def spare(self, task: Task) -> Job | None:
        """Have something done that nobody waits for, one at a time; the next question stops it.

        None where something waits, or where an earlier one has not ended yet.
        """
        with self._changed:
            if self._waiting or (self._spare is not None and self._spare.busy):
                return None
            self._spare = job = Job(task)
            self._waiting.append(job)
            self._changed.notify()
        return job

    def close(self) -> None:
        """Stop what nobody waits for."""
        with self._changed:
            if self._spare is not None:
                self._spare.stop.set()

    def forget(self, asker: str, job: Job) -> None:
        """Nobody waits for this job any more."""
        with self._changed:
            if self._newest.get(asker) is job:
                del self._newest[asker]

    def _work(self) -> None:
        while True:
            with self._changed:
                while not self._waiting:
                    self._changed.wait()
                job = self._waiting.popleft()
            job.run()
