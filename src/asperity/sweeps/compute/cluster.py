"""Tasks on dask workers: local processes, or a cluster that is there already.

A worker is sent the study's text and a task's number, and sends the columns back; the process that
called writes the store. A worker that dies costs its tasks in flight, which others compute again.
"""

from __future__ import annotations

import contextlib
import functools
import queue
import threading
import time
from collections.abc import Callable, Iterator, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from asperity.errors import InputError, OutputError, SimulationError
from asperity.sweeps.compute.runner import Answer, Answers, Runner, one_thread

if TYPE_CHECKING:
    from asperity.sweeps.compute.batch import Effort
    from asperity.sweeps.study.study import Study

IN_FLIGHT = 3
"""Tasks that a worker's thread has at once: one it computes, the others on their way."""

_LISTEN = 0.1
_COUNT = 2.0


@functools.lru_cache(maxsize=4)
def _study(text: str) -> Study:
    one_thread()
    from asperity.sweeps.study.study import parse

    study = parse(text)
    if study.canonical != text:
        raise InputError(
            "the workers must have the same asperity as this process; they read the study otherwise"
        )
    return study


def compute_task(text: str, task: int) -> tuple[dict[str, np.ndarray], Effort]:
    """Columns and effort of a task, for a worker.

    Parameters
    ----------
    text : str
        The study, as its canonical text.
    task : int
        The task's number.

    Raises
    ------
    InputError
        Where this worker reads the study in another way than the process that wrote the text.
    """
    study = _study(text)
    from asperity.sweeps.compute.batch import compute

    return compute(study, task)


def on_cluster(client: Any, function: Callable[[str, int], Any] = compute_task) -> Runner:
    """A `Runner` that has a cluster's workers compute.

    Parameters
    ----------
    client : distributed.Client
        The cluster.
    function : callable
        What a worker calls with the study's text and a task's number.

    Raises
    ------
    OutputError
        When run: where the scheduler is lost, or the workers lack this program.
    SimulationError
        When run: where a task ends every worker that computes it.
    """

    def run(study: Study, tasks: Sequence[int], stop: threading.Event) -> Answers:
        flight = _Flight(client, functools.partial(client.submit, function, study.canonical))
        waiting = iter(tasks)
        try:
            while not stop.is_set():
                flight.fill(waiting)
                if not flight.tasks:
                    return
                with contextlib.suppress(queue.Empty):
                    yield flight.land()
        finally:
            flight.abandon()

    return run


class _Flight:
    """The tasks that are with the workers."""

    def __init__(self, client: Any, submit: Callable[..., Any]) -> None:
        self.tasks: dict[Any, tuple[int, Any]] = {}
        self._client = client
        self._submit = submit
        self._landed: queue.SimpleQueue[Any] = queue.SimpleQueue()
        self._room = 0
        self._counted = -np.inf

    def fill(self, waiting: Iterator[int]) -> None:
        """Send tasks until the workers have enough."""
        if time.monotonic() - self._counted > _COUNT:
            with _scheduler_told():
                threads = sum(self._client.nthreads().values())
            self._room = IN_FLIGHT * max(threads, 1)
            self._counted = time.monotonic()
        while len(self.tasks) < self._room:
            task = next(waiting, None)
            if task is None:
                return
            future = self._submit(task, pure=False)
            self.tasks[future.key] = task, future
            future.add_done_callback(self._landed.put)

    def land(self) -> Answer:
        """The next task that is computed.

        Raises
        ------
        queue.Empty
            Where none is yet.
        """
        landed = self._landed.get(timeout=_LISTEN)
        task, future = self.tasks.pop(landed.key)
        with _task_told(task), _scheduler_told():
            columns, effort = future.result()
        return task, columns, effort

    def abandon(self) -> None:
        """Call back what is still with the workers."""
        with contextlib.suppress(Exception):
            self._client.cancel([future for _, future in self.tasks.values()])


@contextlib.contextmanager
def _task_told(task: int) -> Iterator[None]:
    """Failures of a task as one line."""
    from distributed.scheduler import KilledWorker

    try:
        yield
    except KilledWorker as error:
        raise SimulationError(
            f"task {task}: every worker that computed it died, the last at "
            f"{error.last_worker.address}; what was finished is kept, `--resume` goes on"
        ) from error
    except (ImportError, RuntimeError) as error:
        if isinstance(error, RuntimeError) and "deserialization" not in str(error):
            raise
        raise OutputError(
            "the scheduler and its workers must have the same asperity as this process; "
            f"they cannot load a task: {error}"
        ) from error


@contextlib.contextmanager
def _scheduler_told() -> Iterator[None]:
    """A scheduler that is gone, as one line."""
    from concurrent.futures import CancelledError

    try:
        yield
    except (CancelledError, OSError) as error:
        reason = getattr(error, "reason", None) or str(error) or type(error).__name__
        raise OutputError(
            f"the scheduler was lost: {reason}; what was finished is kept, `--resume` goes on"
        ) from error
