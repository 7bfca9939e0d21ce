"""A study on dask workers: the same bytes as in one process, whoever dies."""

from __future__ import annotations

import json
import os
import signal
import socket
import subprocess
import sys
import threading
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import dask
import pytest

import fake_study
from asperity.errors import OutputError, SimulationError
from asperity.sweeps.compute.clients import _settings, connected, local
from asperity.sweeps.compute.cluster import on_cluster
from asperity.sweeps.compute.runner import Tally, fill
from asperity.sweeps.store.store import Store
from fake_study import FakeStudy, in_order
from store_files import contents

STUDY = FakeStudy(size=200, pause=0.02)


@pytest.fixture(name="client", scope="module")
def _client() -> Iterator[Any]:
    with local(3) as client:
        yield client


@pytest.fixture(name="undisturbed", scope="module")
def _undisturbed(tmp_path_factory: pytest.TempPathFactory) -> dict[str, bytes]:
    path = tmp_path_factory.mktemp("undisturbed") / "study.zarr"
    fill(STUDY, Store.create(path, STUDY), in_order)
    return contents(path)


def deadly(text: str, task: int) -> Any:
    """A task that ends its worker, whoever computes it."""
    if task == 2:
        os.kill(os.getpid(), signal.SIGKILL)
    return fake_study.compute_task(text, task)


def test_a_second_cluster_may_stand_beside_the_first(client: Any):
    with local(1) as other:
        assert other.scheduler.address != client.scheduler.address
        assert other.cluster.scheduler.http_server is not None
        ports = other.cluster.scheduler.http_server._sockets.values()
        assert {each.getsockname()[0] for each in ports} == {"127.0.0.1"}


def test_workers_have_one_thread_keep_their_memory_and_are_not_sampled(client: Any):
    assert set(client.nthreads().values()) == {1}
    for environment in client.run(lambda: dict(os.environ)).values():
        assert environment["NPROC"] == environment["OMP_NUM_THREADS"] == "1"
        assert "--xla_cpu_multi_thread_eigen=false" in environment["XLA_FLAGS"]
        assert environment["MALLOC_TRIM_THRESHOLD_"] == "33554432"
        assert environment["MALLOC_MMAP_THRESHOLD_"] == "33554432"
    profiled = client.run(dask.config.get, "distributed.worker.profile.enabled")
    assert set(profiled.values()) == {False}


def test_thresholds_of_a_users_own_are_kept():
    own = {"MALLOC_TRIM_THRESHOLD_": 1000, "MALLOC_MMAP_THRESHOLD_": 65536}
    with dask.config.set({"distributed.nanny.pre-spawn-environ": own}):
        given = _settings(dask.config)["distributed.nanny.pre-spawn-environ"]
    assert given["MALLOC_TRIM_THRESHOLD_"] == 1000
    assert given["MALLOC_MMAP_THRESHOLD_"] == "33554432"


def test_three_workers_of_which_one_is_killed_give_the_bytes_of_one_process(
    tmp_path: Path, client: Any, undisturbed: dict[str, bytes]
):
    before = set(client.run(os.getpid).values())

    def kill(task: int, effort: Any, tally: Tally) -> None:
        if tally.tasks == 5:
            os.kill(min(before), signal.SIGKILL)

    path = tmp_path / "study.zarr"
    runner = on_cluster(client, fake_study.compute_task)
    tally = fill(STUDY, Store.create(path, STUDY), runner, progress=kill)
    assert tally.cases == STUDY.size
    assert contents(path) == undisturbed
    client.wait_for_workers(3, timeout=30)
    assert min(before) not in client.run(os.getpid).values()


def test_a_run_on_workers_that_is_stopped_goes_on(
    tmp_path: Path, client: Any, undisturbed: dict[str, bytes]
):
    path, stop = tmp_path / "study.zarr", threading.Event()

    def halt(task: int, effort: Any, tally: Tally) -> None:
        if tally.tasks == 3:
            stop.set()

    runner = on_cluster(client, fake_study.compute_task)
    assert fill(STUDY, Store.create(path, STUDY), runner, progress=halt, stop=stop).tasks == 3
    store = Store.open(path, STUDY, writable=True)
    assert len(store.done) == 3
    fill(STUDY, store, runner)
    assert contents(path) == undisturbed


def test_a_task_that_ends_every_worker_is_named(
    tmp_path: Path, client: Any, monkeypatch: pytest.MonkeyPatch
):
    client.run_on_scheduler(lambda dask_scheduler: setattr(dask_scheduler, "allowed_failures", 0))
    path = tmp_path / "study.zarr"
    store = Store.create(path, STUDY)
    with pytest.raises(SimulationError, match="task 2: every worker that computed it died"):
        fill(STUDY, store, on_cluster(client, deadly), tasks=[0, 2])
    assert 2 not in Store.open(path, STUDY).done
    client.wait_for_workers(3, timeout=30)


def test_a_scheduler_that_cannot_be_reached_is_told(monkeypatch: pytest.MonkeyPatch):
    """What is no address, a server that is no scheduler, and a port where nothing answers."""
    monkeypatch.setattr("asperity.sweeps.compute.clients.PATIENCE", 0.3)
    with socket.create_server(("127.0.0.1", 0)) as server:
        other = f"tcp://127.0.0.1:{server.getsockname()[1]}"
        for address in ("nonsense", "foo://127.0.0.1:1", other):
            with pytest.raises(OutputError, match=f"^{address}: the scheduler cannot be reached"):
                connected(address).__enter__()
    with pytest.raises(OutputError, match="the scheduler cannot be reached: Timed out"):
        connected(other).__enter__()


@pytest.fixture(name="cluster")
def _cluster(tmp_path: Path) -> Iterator[tuple[str, subprocess.Popen[bytes]]]:
    """A scheduler and a worker as programs of their own: the address, and the scheduler."""
    env = {**os.environ, "PYTHONPATH": str(Path(__file__).parents[1])}
    file = tmp_path / "scheduler.json"

    def program(name: str, *arguments: str) -> subprocess.Popen[bytes]:
        code = f"from distributed.cli.dask_{name} import main; main()"
        command = [sys.executable, "-c", code, "--scheduler-file", str(file), "--no-dashboard"]
        return subprocess.Popen([*command, *arguments], env=env, stderr=subprocess.DEVNULL)

    scheduler = program("scheduler", "--host", "127.0.0.1", "--port", "0")
    worker = program("worker", "--nthreads", "1", "--no-nanny")  # waits for the file
    try:
        give_up = time.monotonic() + 60.0
        while not file.exists() and time.monotonic() < give_up:
            time.sleep(0.05)
        yield json.loads(file.read_text())["address"], scheduler
    finally:
        for process in (worker, scheduler):
            process.kill()
            process.wait()


def test_a_scheduler_that_dies_costs_what_is_in_flight_alone(
    tmp_path: Path, cluster: tuple[str, subprocess.Popen[bytes]], undisturbed: dict[str, bytes]
):
    address, scheduler = cluster

    def kill(task: int, effort: Any, tally: Tally) -> None:
        if tally.tasks == 5:
            scheduler.kill()

    path = tmp_path / "study.zarr"
    store = Store.create(path, STUDY)
    with connected(address) as client:
        runner = on_cluster(client, fake_study.compute_task)
        with pytest.raises(OutputError, match="the scheduler was lost"):
            fill(STUDY, store, runner, progress=kill)
    store = Store.open(path, STUDY, writable=True)
    assert len(store.done) >= 5
    fill(STUDY, store, in_order)
    assert contents(path) == undisturbed
