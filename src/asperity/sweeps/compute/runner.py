"""The loop that fills a store: tasks that are missing, computed by a runner in any order."""

from __future__ import annotations

import contextlib
import os
import re
import sys
import threading
import time
from collections.abc import Callable, Generator, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from asperity.sweeps.store.variables import drawn

if TYPE_CHECKING:
    from asperity.sweeps.compute.batch import Effort
    from asperity.sweeps.compute.study_warnings import Warned
    from asperity.sweeps.store.store import Store
    from asperity.sweeps.study.study import Study

Answer = tuple[int, dict[str, np.ndarray], "Effort"]
"""A task's number, its columns, and what they cost."""

Answers = Generator[Answer, None, None]
"""Of tasks, as they come; closed where no more are wanted."""

Runner = Callable[["Study", Sequence[int], threading.Event], Answers]
"""Computes tasks of a study in any order, until all are done or it is asked to stop."""

_LISTEN = 0.2
"""How often what waits looks for Ctrl-C, which a wait without end may miss as it begins [s]."""

_NUMBER = re.compile(r"[-+]?\d[\d.,]*(?:e[-+]?\d+)?")

_EACH = {
    "XLA_FLAGS": "--xla_cpu_multi_thread_eigen=false",
    "OMP_NUM_THREADS": "1",
    "OPENBLAS_NUM_THREADS": "1",
}

ONE_THREAD = {**_EACH, "NPROC": "1"}
"""Environment in which a process computes with one thread. JAX reads it when it is imported."""


def one_thread(*, at_once: bool = False) -> None:
    """Have this process compute with one thread, where JAX is not imported yet.

    What the environment says already stands.

    Parameters
    ----------
    at_once : bool
        Whether there is one thread for each task, and several tasks at once: XLA is left as many
        as there are cores, or it would run their programs one after the other.
    """
    if "jax" not in sys.modules:
        for name, value in (_EACH if at_once else ONE_THREAD).items():
            os.environ.setdefault(name, value)


@dataclass(frozen=True)
class Tally:
    """What a run has done until now.

    Parameters
    ----------
    tasks, cases : int
        Computed in this run.
    cases_wanted : int
        To be computed in this run.
    useful : float
        Sum over the cases of the useful share of their batch.
    compiled : float
        Time in compiled code, summed over all workers [s].
    busy : float
        Time in tasks, summed over all workers [s].
    wall : float
        Time since the run began [s].
    looked : int
        Cases that were looked at for the validity of their models.
    warned : tuple
        What is to be known of these: numbers of cases, each with a line.
    """

    tasks: int
    cases: int
    cases_wanted: int
    useful: float = 0.0
    compiled: float = 0.0
    busy: float = 0.0
    wall: float = 0.0
    looked: int = 0
    warned: tuple[Warned, ...] = ()

    @property
    def batch_use(self) -> float:
        """Useful share of the batches [-]; 1 before anything is computed."""
        return self.useful / self.cases if self.cases else 1.0

    @property
    def rate(self) -> float:
        """Cases a second [1/s]."""
        return self.cases / self.wall if self.wall > 0.0 else 0.0

    @property
    def outside(self) -> float:
        """Share of the time, summed over all workers, that is not in compiled code [-]."""
        time = max(self.busy, self.wall)
        return max(0.0, 1.0 - self.compiled / time) if time > 0.0 else 0.0

    @property
    def left(self) -> float:
        """Time until the end at this rate [s]; infinite before anything is computed."""
        remaining = self.cases_wanted - self.cases
        return remaining / self.rate if self.rate > 0.0 else float("inf")

    @property
    def warnings(self) -> list[str]:
        """Where the cases looked at leave the validity of their models, a line for each way.

        Lines of which the numbers alone differ count as one way; it is shown of the first case.
        """
        kinds: dict[str, list[Warned]] = {}
        for one in sorted(self.warned):
            kinds.setdefault(_NUMBER.sub("#", one[1]), []).append(one)
        return [
            f"{len({number for number, _ in found})} of {self.looked} cases looked at, such as "
            f"case {found[0][0]}: {found[0][1]}"
            for found in kinds.values()
        ]

    def plus(self, effort: Effort, wall: float) -> Tally:
        """With one task more."""
        return Tally(
            self.tasks + 1,
            self.cases + effort.cases,
            self.cases_wanted,
            self.useful + effort.cases * effort.batch_use,
            self.compiled + effort.compiled,
            self.busy + effort.wall,
            wall,
            self.looked + effort.looked,
            self.warned + effort.warned,
        )


def fill(
    study: Study,
    store: Store,
    runner: Runner,
    *,
    tasks: Sequence[int] | None = None,
    progress: Callable[[int, Effort, Tally], None] | None = None,
    stop: threading.Event | None = None,
) -> Tally:
    """Compute the tasks that a store misses.

    Parameters
    ----------
    study : Study
        The study.
    store : Store
        Its store, open for writing; this process alone writes it. It is closed at the end.
    runner : callable
        What computes; see `in_process` and `cluster.on_cluster`.
    tasks : sequence of int, optional
        Tasks wanted; all unless given. Those that are done are not computed again.
    progress : callable, optional
        Told of each task once it is kept: its number, its effort, and all until now.
    stop : threading.Event, optional
        Ends the run when set; what is finished is kept.

    Raises
    ------
    OutputError
        Where the store cannot be written, or whatever the runner cannot reach.
    SimulationError
        Where a task cannot be computed at all.
    """
    stop = stop or threading.Event()
    wanted = range(study.tasks) if tasks is None else tasks
    missing = [task for task in wanted if task not in store.done]
    tally = Tally(0, 0, sum(len(study.task(task)) for task in missing))
    began = time.monotonic()
    try:
        if missing:
            with contextlib.closing(runner(study, missing, stop)) as answers:
                for task, columns, effort in answers:
                    store.write(task, columns | drawn(study, study.task(task)))
                    tally = tally.plus(effort, time.monotonic() - began)
                    if progress is not None:
                        progress(task, effort, tally)
                    if stop.is_set():
                        break
        store.finish()
    finally:
        store.close()
    return tally


def in_process(study: Study, tasks: Sequence[int], stop: threading.Event) -> Answers:
    """A `Runner` in this process: a thread for each core, since compiled code runs beside Python.

    What is under way when it is asked to stop is given up, within about a second.
    """
    from concurrent.futures import FIRST_COMPLETED, Future, ThreadPoolExecutor, wait

    from asperity.integration.clock import Stopped
    from asperity.sweeps.compute.batch import compute

    remaining = iter(tasks)
    cores = _cores()
    with ThreadPoolExecutor(cores, "asperity") as pool:
        ahead: dict[Future[Any], int] = {}

        def submit() -> None:
            task = next(remaining, None)
            if task is not None and not stop.is_set():
                ahead[pool.submit(compute, study, task, stop)] = task

        try:
            for _ in range(2 * cores):
                submit()
            while ahead:
                for future in wait(ahead, _LISTEN, return_when=FIRST_COMPLETED).done:
                    task = ahead.pop(future)
                    submit()
                    try:
                        columns, effort = future.result()
                    except Stopped:
                        continue
                    yield task, columns, effort
                if stop.is_set():
                    break
        except BaseException:  # Ctrl-C too: leaving the pool waits for what is under way
            stop.set()
            raise
        finally:
            for future in ahead:
                future.cancel()


def _cores() -> int:
    """Cores that this process may use."""
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1
