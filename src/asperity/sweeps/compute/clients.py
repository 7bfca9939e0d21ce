"""Dask clients: of workers on this machine, or of a cluster that is there already."""

from __future__ import annotations

import asyncio
import contextlib
import logging
import os
import signal
from collections.abc import Iterator
from importlib.metadata import version
from multiprocessing import resource_tracker
from typing import Any

from asperity.errors import InputError, OutputError
from asperity.sweeps.compute.runner import ONE_THREAD

PATIENCE = 8.0
"""How long a scheduler may take to answer [s]."""

_DEATHS = 10
"""Workers of a local cluster that a task may outlive."""

_MEMORY = {"MALLOC_TRIM_THRESHOLD_": "33554432", "MALLOC_MMAP_THRESHOLD_": "33554432"}
"""Of glibc [bytes], whose largest these are: by itself dask has workers give back each 64 kB, which
our arrays then ask for again, at half as much time again for a task."""

_BY_ITSELF = "65536"

_UNWATCHED = {
    "distributed.worker.profile.enabled": False,
    "distributed.admin.tick.interval": "1s",
}
"""Of dask: no samples of what a worker does, which nobody looks at, nor of its event loop."""


@contextlib.contextmanager
def local(workers: int) -> Iterator[Any]:
    """A cluster of processes on this machine, of one thread each.

    Parameters
    ----------
    workers : int
        Number of processes.

    Raises
    ------
    OutputError
        Where they cannot be started.
    """
    import dask
    from distributed import Client, LocalCluster

    _silence()
    with dask.config.set(_settings(dask.config)), contextlib.ExitStack() as stack:
        try:
            with _deaf():
                cluster = LocalCluster(  # type: ignore[no-untyped-call]
                    n_workers=workers,
                    threads_per_worker=1,
                    processes=True,
                    host="127.0.0.1",
                    scheduler_kwargs={"dashboard": False, "dashboard_address": "127.0.0.1:0"},
                    memory_limit=0,
                    silence_logs=logging.CRITICAL,
                )
            stack.enter_context(cluster)
            client = Client(cluster, set_as_default=False)  # type: ignore[no-untyped-call]
            stack.enter_context(client)
        except (OSError, RuntimeError) as error:
            raise OutputError(f"{workers} local workers cannot be started: {error}") from error
        yield client


def _settings(config: Any) -> dict[str, Any]:
    """Of dask: workers of one thread, which say nothing and of which many may die."""
    spawning = "distributed.nanny.pre-spawn-environ"
    before = config.get(spawning, {})
    memory = {k: v for k, v in _MEMORY.items() if str(before.get(k, _BY_ITSELF)) == _BY_ITSELF}
    silence = {"DASK_LOGGING__DISTRIBUTED": "critical"}
    return {
        **_UNWATCHED,
        "distributed.scheduler.allowed-failures": _DEATHS,
        spawning: {**before, **ONE_THREAD, **memory, **silence},
    }


@contextlib.contextmanager
def _deaf() -> Iterator[None]:
    """Threads and processes started within do not hear Ctrl-C, which is for this process alone."""
    if not hasattr(signal, "pthread_sigmask"):
        yield
        return
    _track()  # started later, the tracker would lift what is set here
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


def _track() -> None:
    """Start Python's own tracker of semaphores; silent where this program is ended."""
    before = os.environ.get("PYTHONWARNINGS")
    os.environ["PYTHONWARNINGS"] = "ignore"
    try:
        resource_tracker.ensure_running()
    finally:
        if before is None:
            del os.environ["PYTHONWARNINGS"]
        else:
            os.environ["PYTHONWARNINGS"] = before


@contextlib.contextmanager
def connected(address: str) -> Iterator[Any]:
    """A cluster that is there already.

    Parameters
    ----------
    address : str
        Of its scheduler, such as "tcp://10.0.0.1:8786".

    Raises
    ------
    InputError
        Where the workers have another version of this program.
    OutputError
        Where the scheduler cannot be reached.
    """
    from distributed import Client

    _silence()
    try:
        asyncio.run(_greet(address))
        client = Client(address, timeout=PATIENCE, set_as_default=False)  # type: ignore[no-untyped-call]
    except (OSError, ValueError, MemoryError, RuntimeError) as error:
        reason = str(error) or type(error).__name__
        raise OutputError(f"{address}: the scheduler cannot be reached: {reason}") from error
    with client:
        mine = version("asperity")
        for worker, theirs in client.run(_version, on_error="return").items():
            if theirs != mine:
                raise InputError(f"{worker}: this worker must have asperity {mine}; got {theirs}")
        yield client


def _silence() -> None:
    """Leave what goes wrong to this program's own messages."""
    for name in list(logging.root.manager.loggerDict):
        if name.split(".")[0] == "distributed":
            logging.getLogger(name).setLevel(logging.CRITICAL)


async def _greet(address: str) -> None:
    """See that a scheduler answers; a client that fails complains again when it is collected."""
    from distributed.comm.core import connect
    from distributed.security import Security

    arguments = Security().get_connection_args("client")  # type: ignore[no-untyped-call]
    async with asyncio.timeout(PATIENCE + 1.0):  # what is no scheduler may never greet
        comm = await connect(address, timeout=PATIENCE, **arguments)  # type: ignore[no-untyped-call]
        await comm.close()


def _version() -> str:
    return version("asperity")
