"""``asperity sweep`` and ``asperity merge``: what they say, write and refuse."""

from __future__ import annotations

import errno
import json
import os
import resource
import signal
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

import pytest
from typer.testing import CliRunner

import fake_study
from asperity.cli import app
from asperity.errors import ENDS
from asperity.sweeps.compute import batch
from asperity.sweeps.compute.runner import fill
from asperity.sweeps.store.store import Store
from asperity.sweeps.store.whole_files import beside
from asperity.sweeps.study import study as studies
from fake_study import FakeStudy, expected, in_order
from store_files import contents, flip

PROGRAM = Path(__file__).parents[1] / "fake_sweep.py"
STUDY = FakeStudy()


@pytest.fixture(name="place", autouse=True)
def _place(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder with a study of numbers that cost nothing, which the commands compute."""
    monkeypatch.setattr(studies, "read", fake_study.read)
    monkeypatch.setattr(batch, "compute", fake_study.compute)
    monkeypatch.chdir(tmp_path)
    Path("study.toml").write_text(STUDY.canonical)
    return tmp_path


@pytest.fixture(name="undisturbed", scope="module")
def _undisturbed(tmp_path_factory: pytest.TempPathFactory) -> dict[str, bytes]:
    path = tmp_path_factory.mktemp("undisturbed") / "study.zarr"
    fill(STUDY, Store.create(path, STUDY), in_order)
    return contents(path)


def call(*arguments: str) -> Any:
    return CliRunner().invoke(app, list(arguments))


def program(*arguments: str, **options: Any) -> subprocess.CompletedProcess[str]:
    """The whole program in a process of its own."""
    command = [sys.executable, str(PROGRAM), *arguments]
    options = {"capture_output": True, "text": True, "timeout": 60, **options}
    return subprocess.run(command, check=False, **options)


def assert_one_line(text: str, *parts: str) -> None:
    assert text.count("\n") == 1, text
    assert "Traceback" not in text
    for part in parts:
        assert part in text


def test_a_sweep_says_what_came_out(place: Path, undisturbed: dict[str, bytes]):
    ran = program("sweep", "study.toml")
    assert (ran.returncode, ran.stderr) == (0, "")
    assert ran.stdout.startswith("study.zarr: 50 of 50 cases\n")
    assert "case 3 is the first that failed: case 3 fails" in ran.stdout
    assert contents(place / "study.zarr") == undisturbed
    log = (place / "study.zarr.log").read_text()
    assert log.count(" task ") == STUDY.tasks


def test_json_is_one_object_with_the_counts():
    ran = call("sweep", "study.toml", "--json")
    (line,) = ran.stdout.splitlines()
    said = json.loads(line)
    codes = list(expected(STUDY, range(STUDY.size))["outcome"])
    found = {outcome.value: codes.count(code) for code, outcome in enumerate(ENDS)}
    assert said["outcomes"] == found
    assert said["failed"] == found["failed"]
    assert (said["store"], said["cases"], said["done"]) == ("study.zarr", 50, 50)
    assert said["computed"] == 50
    assert said["cases_per_second"] == pytest.approx(50 / said["wall"])
    assert said["batch_use"] == pytest.approx(0.5)
    assert 0.0 <= said["overhead_share"] <= 1.0


def test_quiet_is_quiet():
    ran = call("sweep", "study.toml", "--quiet")
    assert (ran.exit_code, ran.stdout, ran.stderr) == (0, "", "")


def test_a_store_that_is_there_is_refused_resumed_or_replaced(
    place: Path, undisturbed: dict[str, bytes]
):
    fill(STUDY, Store.create("study.zarr", STUDY), in_order, tasks=[2])
    ran = call("sweep", "study.toml")
    assert ran.exit_code == 2
    assert_one_line(ran.stderr, "study.zarr", "--resume", "--force")
    ran = call("sweep", "study.toml", "--resume", "--json")
    assert json.loads(ran.stdout)["computed"] == 50 - 8
    assert contents(place / "study.zarr") == undisturbed
    ran = call("sweep", "study.toml", "--force", "--json")
    assert json.loads(ran.stdout)["computed"] == 50
    assert contents(place / "study.zarr") == undisturbed


def test_the_store_of_another_study_is_exit_2(place: Path):
    other = FakeStudy(salt=1)
    fill(other, Store.create("study.zarr", other), in_order, tasks=[])
    for option in ("--resume", "--repair"):
        ran = call("sweep", "study.toml", option)
        assert ran.exit_code == 2
        assert_one_line(ran.stderr, "study.zarr: must be the store of this study")


def test_repair_names_corrupt_chunks_and_computes_them_again(
    place: Path, undisturbed: dict[str, bytes]
):
    path = place / "study.zarr"
    fill(STUDY, Store.create(path, STUDY), in_order)
    flip(path / "energy_balance_error" / "c.3")
    (path / "impacts" / "c.5").unlink()
    (path / "impacts" / "zarr.json").write_text("{")
    ran = call("sweep", "study.toml", "--resume")
    assert ran.exit_code == 2
    assert_one_line(ran.stderr, "impacts/zarr.json", "--repair")
    ran = call("sweep", "study.toml", "--repair", "--json")
    assert ran.exit_code == 0
    assert json.loads(ran.stdout)["computed"] == 16
    written, *corrupt = ran.stderr.splitlines()
    assert "impacts/zarr.json: written again" in written
    told = " ".join(" ".join(corrupt).split())
    assert told.index("energy_balance_error, task 3") < told.index("impacts, task 5")
    assert contents(path) == undisturbed


def test_options_that_exclude_each_other_are_exit_2(place: Path):
    for one, other in (
        (("--force",), ("--resume",)),
        (("--force",), ("--repair",)),
        (("--workers", "2"), ("--scheduler", "tcp://127.0.0.1:1")),
    ):
        ran = call("sweep", "study.toml", *one, *other)
        assert ran.exit_code == 2
        assert_one_line(ran.stderr, one[0], other[0])
    for options in (("--workers", "0"), ("--shard", "3/2")):
        ran = call("sweep", "study.toml", *options)
        assert ran.exit_code == 2
        assert_one_line(ran.stderr, *options)
    assert [path.name for path in place.iterdir()] == ["study.toml"]


def test_a_billion_cases_by_mistake_need_yes(place: Path):
    Path("study.toml").write_text(FakeStudy(size=10**9, task_size=8192).canonical)
    ran = call("sweep", "study.toml")
    assert ran.exit_code == 2
    assert_one_line(ran.stderr, "--yes", "1,000,000,000 cases")
    assert [path.name for path in place.iterdir()] == ["study.toml"]


def test_a_scheduler_that_cannot_be_reached_is_exit_4(place: Path):
    ran = program("sweep", "study.toml", "--scheduler", "tcp://127.0.0.1:1")
    assert ran.returncode == 4
    assert_one_line(ran.stderr, "tcp://127.0.0.1:1: the scheduler cannot be reached")
    ran = call("sweep", "study.toml")
    assert (ran.exit_code, ran.stderr) == (0, "")


def test_shards_are_merged_into_the_store_of_one_run(place: Path, undisturbed: dict[str, bytes]):
    for number in (1, 2, 3):
        assert call("sweep", "study.toml", "--shard", f"{number}/3", "-q").exit_code == 0
    stores = [f"study.{number}-of-3.zarr" for number in (1, 2, 3)]
    ran = call("merge", *stores[:2])
    assert ran.exit_code == 0
    assert "tasks 2, 5 are missing" in ran.stderr
    ran = call("merge", *stores)
    assert ran.exit_code == 2
    assert_one_line(ran.stderr, "study.zarr", "--force")
    ran = call("merge", *stores, "--force", "--json")
    assert (ran.exit_code, ran.stderr) == (0, "")
    assert json.loads(ran.stdout)["done"] == 50
    assert contents(place / "study.zarr") == undisturbed
    ran = call("merge", *stores, "-o", stores[0], "--force")
    assert ran.exit_code == 2
    assert_one_line(ran.stderr, "--output", stores[0])


def limit(size: int) -> Any:
    """A disk that takes no file larger than so many bytes."""
    return lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (size, size))


@pytest.mark.parametrize("size", [1024, 10_000], ids=["at once", "in the middle"])
def test_a_full_disk_is_exit_4_and_the_store_goes_on(place: Path, size: int):
    """The largest file is the manifest, a line a task."""
    study = FakeStudy(size=200)
    fill(study, Store.create(place / "whole" / "study.zarr", study), in_order)
    Path("study.toml").write_text(study.canonical)
    ran = program("sweep", "study.toml", preexec_fn=limit(size))
    assert ran.returncode == 4
    assert_one_line(ran.stderr, os.strerror(errno.EFBIG), "--resume")
    if size > 1024:
        store = Store.open("study.zarr", study)
        assert 0 < len(store.done) < study.tasks
        assert store.check() == []
    assert call("sweep", "study.toml", "--resume", "--quiet").exit_code == 0
    assert contents(place / "study.zarr") == contents(place / "whole" / "study.zarr")


def test_a_place_that_cannot_be_written_is_exit_4(place: Path):
    ran = call("sweep", "study.toml", "-o", "study.toml/study.zarr")
    assert ran.exit_code == 4
    assert_one_line(ran.stderr, "study.toml/study.zarr", os.strerror(errno.ENOTDIR))


def test_an_interrupted_sweep_is_exit_130_and_says_how_to_go_on(place: Path):
    Path("study.toml").write_text(FakeStudy(pause=0.2).canonical)
    command = [sys.executable, str(PROGRAM), "sweep", "study.toml"]
    log = beside(place / "study.zarr", ".log")
    with subprocess.Popen(command, stderr=subprocess.PIPE, text=True) as run:
        while run.poll() is None and not (log.exists() and "task 1" in log.read_text()):
            time.sleep(0.01)
        run.send_signal(signal.SIGINT)
        _, said = run.communicate(timeout=60)
    assert run.returncode == 130
    assert_one_line(said, "interrupted", "of 50 cases are kept in study.zarr", "--resume")
    assert {0, 1} <= Store.open("study.zarr").done
